//! The text of a scene: read from a file, changed by overrides, every byte still knowing where it came from.

use super::fault::{Fault, FaultKind, Place, SceneFaults};
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

/// Largest scene file, bytes. A scene by hand has thousands; this bounds memory against a wrong file.
const LARGEST: u64 = 4 * 1024 * 1024;

/// A scene's text with the origin of its bytes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Source {
    file: String,
    original: String,
    text: String,
    /// Consecutive pieces of `text`.
    pieces: Vec<Piece>,
    overrides: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    length: usize,
    origin: Origin,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Origin {
    /// Bytes of the original text from this offset on.
    File(usize),
    /// Text that an override put in.
    Override(usize),
}

impl Piece {
    /// The piece without its first `count` bytes.
    fn skip(self, count: usize) -> Self {
        let origin = match self.origin {
            Origin::File(start) => Origin::File(start + count),
            set @ Origin::Override(_) => set,
        };
        Self { length: self.length - count, origin }
    }
}

impl Source {
    /// Takes a text as it is, without a byte order mark.
    pub(super) fn new(text: &str, file: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text).to_owned();
        let pieces = vec![Piece { length: text.len(), origin: Origin::File(0) }];
        Self { file: file.to_owned(), original: text.clone(), text, pieces, overrides: Vec::new() }
    }

    /// Reads a file.
    pub(super) fn read(path: &Path) -> Result<Self, SceneFaults> {
        let name = path.display().to_string();
        let fault =
            |kind| SceneFaults::from(Fault { place: Place::File(name.clone()), path: String::new(), kind });
        let unreadable = |error: std::io::Error| fault(FaultKind::Unreadable(error.to_string()));
        let file = File::open(path).map_err(unreadable)?;
        let size = file.metadata().map_err(unreadable)?.len();
        let mut bytes = Vec::new();
        file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        let bytes_read = bytes.len() as u64;
        if bytes_read > LARGEST {
            return Err(fault(FaultKind::TooLarge { bytes: size.max(bytes_read), limit: LARGEST }));
        }
        let text = String::from_utf8(bytes).map_err(|_| fault(FaultKind::NotText))?;
        Ok(Self::new(&text, &name))
    }

    /// The text with all overrides in it.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Replaces `range` of the text by what an override says; `set` is the override as typed.
    pub(super) fn splice(&mut self, range: Range<usize>, replacement: &str, set: &str) {
        let origin = Origin::Override(self.overrides.len());
        self.overrides.push(set.to_owned());
        self.text.replace_range(range.clone(), replacement);
        let mut pieces = Vec::new();
        let mut start = 0;
        for piece in &self.pieces {
            let end = start + piece.length;
            if start < range.start {
                pieces.push(Piece { length: end.min(range.start) - start, ..*piece });
            }
            if start <= range.start && range.start < end {
                pieces.push(Piece { length: replacement.len(), origin });
            }
            if end > range.end {
                pieces.push(piece.skip(range.end.saturating_sub(start)));
            }
            start = end;
        }
        self.pieces = pieces;
    }

    /// Where a byte of the text came from. The end of the text counts as its last piece.
    pub(super) fn place(&self, at: usize) -> Place {
        let mut start = 0;
        let mut origin = Origin::File(0);
        for piece in &self.pieces {
            origin = piece.skip((at - start).min(piece.length)).origin;
            start += piece.length;
            if at < start {
                break;
            }
        }
        match origin {
            Origin::Override(index) => Place::Override(self.overrides[index].clone()),
            Origin::File(offset) => {
                let before = &self.original[..offset];
                let line = before.matches('\n').count() + 1;
                let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
                Place::Text { file: self.file.clone(), line, column }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(line: usize, column: usize) -> Place {
        Place::Text { file: "f".to_owned(), line, column }
    }

    #[test]
    fn bytes_know_their_place_after_overrides() {
        let mut source = Source::new("\u{feff}(a: 1,\r\n b: 22)", "f");
        assert_eq!(source.place(12), text(2, 5));
        source.splice(4..5, "one", "a=one");
        source.splice(14..16, "(c: 3)", "b=(c: 3)");
        assert_eq!(source.text(), "(a: one,\r\n b: (c: 3))");
        assert_eq!(source.place(1), text(1, 2));
        assert_eq!(source.place(5), Place::Override("a=one".to_owned()));
        assert_eq!(source.place(11), text(2, 2));
        assert_eq!(source.place(15), Place::Override("b=(c: 3)".to_owned()));
        assert_eq!(source.place(20), text(2, 7));
        source.splice(1..7, "z: 0", "z=0");
        assert_eq!(source.place(2), Place::Override("z=0".to_owned()));
        assert_eq!(source.place(9), text(2, 2));
    }
}

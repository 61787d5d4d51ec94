//! Where everything stands in a scene's text: a light scan of RON that knows brackets, names, strings and comments.
//!
//! `ron` reads the values; the outline says at which bytes the value of `batches[1].count` is, so that a fault found
//! later, or a value set on the command line, has its place. It also finds repeated keys, which `ron` cannot locate.

use std::ops::Range;

/// Deepest nesting of brackets, well beyond any scene and well within the stack and `ron`'s own limit of 128.
const DEEPEST: usize = 32;

/// A value in the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    /// Its bytes.
    pub(super) span: Range<usize>,
    /// What it holds.
    pub(super) kind: Kind,
}

/// What a value holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// A number, string, or name without brackets.
    Leaf,
    /// A struct, a map, or a variant with named fields.
    Fields {
        /// The fields in the order of the text.
        entries: Vec<Entry>,
        /// Offset of the closing bracket.
        close: usize,
        /// Whether it is a map, whose keys are quoted.
        map: bool,
    },
    /// A list, a tuple, or a variant with unnamed fields such as `Mm(3)`.
    Items(Vec<Node>),
}

/// A named value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    /// Field name, or the key of a map without its quotes.
    pub(super) name: String,
    /// Bytes of the key.
    pub(super) key: Range<usize>,
    /// The value.
    pub(super) value: Node,
    /// Offset of the comma behind it, if there is one.
    pub(super) comma: Option<usize>,
}

/// A place at which the text is not RON.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SyntaxFault {
    /// Byte offset.
    pub(super) at: usize,
    /// What is wrong there.
    pub(super) what: Syntax,
}

/// What can be wrong with the text as RON.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Syntax {
    /// Something else stands where a value should.
    #[error("expected a value")]
    Value,
    /// A value is followed by something else than a comma or the closing bracket.
    #[error("expected `,` or `{0}`")]
    Separator(char),
    /// A field name or map key is not followed by a colon.
    #[error("expected `:` after the name")]
    Colon,
    /// A field has no name.
    #[error("expected a field name")]
    Name,
    /// A string is not closed.
    #[error("this string has no end")]
    OpenString,
    /// A block comment is not closed.
    #[error("this comment has no end")]
    OpenComment,
    /// Brackets within brackets, too many.
    #[error("brackets are nested deeper than {DEEPEST}")]
    Depth,
    /// More text after the scene.
    #[error("expected the end of the text")]
    Trailing,
}

impl Node {
    /// The fields; none for other values.
    pub(super) fn entries(&self) -> &[Entry] {
        match &self.kind {
            Kind::Fields { entries, .. } => entries,
            _ => &[],
        }
    }

    /// The value of a field, the last one if the field is repeated.
    pub(super) fn field(&self, name: &str) -> Option<&Entry> {
        self.entries().iter().rfind(|entry| entry.name == name)
    }

    /// The item of a list.
    pub(super) fn item(&self, index: usize) -> Option<&Node> {
        match &self.kind {
            Kind::Items(items) => items.get(index),
            _ => None,
        }
    }
}

/// Scans a whole scene, or any one value.
pub(super) fn outline(text: &str) -> Result<Node, SyntaxFault> {
    let mut scanner = Scanner { text, at: 0, depth: 0 };
    scanner.space()?;
    while scanner.text[scanner.at..].starts_with("#!") {
        match scanner.text[scanner.at..].find(']') {
            Some(end) => scanner.at += end + 1,
            None => return Err(scanner.fault(Syntax::Value)),
        }
        scanner.space()?;
    }
    let node = scanner.value()?;
    scanner.space()?;
    if scanner.at < text.len() { Err(scanner.fault(Syntax::Trailing)) } else { Ok(node) }
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Scanner<'_> {
    fn fault(&self, what: Syntax) -> SyntaxFault {
        SyntaxFault { at: self.at, what }
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn eat(&mut self, token: char) -> bool {
        let found = self.rest().starts_with(token);
        self.at += if found { token.len_utf8() } else { 0 };
        found
    }

    /// Skips white space and comments; block comments nest.
    fn space(&mut self) -> Result<(), SyntaxFault> {
        loop {
            let rest = self.rest();
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.block_comment()?;
            } else {
                let trimmed = rest.trim_start();
                if trimmed.len() == rest.len() {
                    return Ok(());
                }
                self.at += rest.len() - trimmed.len();
            }
        }
    }

    fn block_comment(&mut self) -> Result<(), SyntaxFault> {
        let start = self.at;
        let mut open = 0;
        loop {
            let rest = self.rest();
            if rest.starts_with("/*") {
                open += 1;
                self.at += 2;
            } else if rest.starts_with("*/") {
                open -= 1;
                self.at += 2;
                if open == 0 {
                    return Ok(());
                }
            } else if let Some(c) = rest.chars().next() {
                self.at += c.len_utf8();
            } else {
                return Err(SyntaxFault { at: start, what: Syntax::OpenComment });
            }
        }
    }

    fn value(&mut self) -> Result<Node, SyntaxFault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault(Syntax::Depth));
        }
        let start = self.at;
        let kind = if self.string()? {
            Kind::Leaf
        } else if self.eat('(') {
            self.parenthesis()?
        } else if self.eat('[') {
            self.items(']')?
        } else if self.eat('{') {
            self.fields('}')?
        } else {
            let word = self.word();
            if word.is_empty() {
                return Err(self.fault(Syntax::Value));
            }
            let (end, optional) = (self.at, &self.text[word] == "Some");
            self.space()?;
            if self.eat('(') {
                match self.parenthesis()? {
                    // `Some(x)` and `x` are the same value in a scene.
                    Kind::Items(mut one) if optional && one.len() == 1 => one.remove(0).kind,
                    kind => kind,
                }
            } else {
                self.at = end;
                Kind::Leaf
            }
        };
        self.depth -= 1;
        Ok(Node { span: start..self.at, kind })
    }

    /// Skips a string, byte string, raw string or character; false if there is none.
    fn string(&mut self) -> Result<bool, SyntaxFault> {
        let start = self.at;
        let open = Err(SyntaxFault { at: start, what: Syntax::OpenString });
        let rest = self.rest();
        let quoted = rest.strip_prefix('b').unwrap_or(rest);
        if let Some(raw) = quoted.strip_prefix('r') {
            let hashes = raw.len() - raw.trim_start_matches('#').len();
            if let Some(content) = raw[hashes..].strip_prefix('"') {
                let closing = format!("\"{}", "#".repeat(hashes));
                let Some(end) = content.find(&closing) else { return open };
                self.at = self.text.len() - content.len() + end + closing.len();
                return Ok(true);
            }
        }
        let Some(quote) = quoted.chars().next().filter(|&c| c == '"' || c == '\'') else { return Ok(false) };
        let content = &quoted[1..];
        let mut escaped = false;
        for (i, c) in content.char_indices() {
            if c == quote && !escaped {
                self.at = self.text.len() - content.len() + i + 1;
                return Ok(true);
            }
            escaped = c == '\\' && !escaped;
        }
        open
    }

    /// Skips a name or number; empty if there is none.
    fn word(&mut self) -> Range<usize> {
        let start = self.at;
        let rest = self.rest();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || "_+-.#".contains(c))).unwrap_or(rest.len());
        self.at += end;
        start..self.at
    }

    /// What is inside `(` .. `)`: fields if the first thing is a name with a colon.
    fn parenthesis(&mut self) -> Result<Kind, SyntaxFault> {
        self.space()?;
        let start = self.at;
        let empty = self.rest().starts_with(')');
        let named = !self.word().is_empty() && {
            self.space()?;
            self.rest().starts_with(':')
        };
        self.at = start;
        if empty || named { self.fields(')') } else { self.items(')') }
    }

    fn items(&mut self, close: char) -> Result<Kind, SyntaxFault> {
        let mut items = Vec::new();
        while !self.closed(close)? {
            items.push(self.value()?);
            self.separator(close)?;
        }
        Ok(Kind::Items(items))
    }

    fn fields(&mut self, close: char) -> Result<Kind, SyntaxFault> {
        let mut entries = Vec::new();
        while !self.closed(close)? {
            let start = self.at;
            let key = if close == '}' {
                self.value()?.span
            } else {
                let word = self.word();
                if !self.text[word.clone()].starts_with(|c: char| c.is_alphabetic() || c == '_') {
                    return Err(SyntaxFault { at: start, what: Syntax::Name });
                }
                word
            };
            self.space()?;
            if !self.eat(':') {
                return Err(self.fault(Syntax::Colon));
            }
            self.space()?;
            let value = self.value()?;
            let comma = self.separator(close)?;
            let written = &self.text[key.clone()];
            let name = ron::from_str::<String>(written).unwrap_or_else(|_| written.to_owned());
            entries.push(Entry { name, key, value, comma });
        }
        Ok(Kind::Fields { entries, close: self.at - 1, map: close == '}' })
    }

    /// Steps over the closing bracket if it is next.
    fn closed(&mut self, close: char) -> Result<bool, SyntaxFault> {
        self.space()?;
        Ok(self.eat(close))
    }

    /// Steps over a comma and says where it was; without one the closing bracket must be next.
    fn separator(&mut self, close: char) -> Result<Option<usize>, SyntaxFault> {
        self.space()?;
        let at = self.at;
        if self.eat(',') {
            Ok(Some(at))
        } else if self.rest().starts_with(close) {
            Ok(None)
        } else {
            Err(self.fault(Syntax::Separator(close)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_of<'a>(text: &'a str, node: &Node) -> &'a str {
        &text[node.span.clone()]
    }

    #[test]
    fn finds_fields_items_and_map_entries() {
        let text = "#![enable(implicit_some)]\n// a: 1\n(a: Mm(1, 2), /* b /* : */ */ b: {\"x, \\\"y\": [3, (c: r#\"\"}\"#)]},)";
        let root = outline(text).expect("is RON");
        let a = &root.field("a").expect("has a").value;
        assert_eq!(text_of(text, a), "Mm(1, 2)");
        assert_eq!(text_of(text, a.item(1).expect("has two")), "2");
        let map = &root.field("b").expect("has b").value;
        let list = &map.field("x, \"y").expect("key without quotes").value;
        let raw = &list.item(1).expect("has two").field("c").expect("has c").value;
        assert_eq!(text_of(text, raw), "r#\"\"}\"#");
    }

    #[test]
    fn some_is_transparent() {
        let root = outline("(a: Some((b: 1)))").expect("is RON");
        let b = root.field("a").and_then(|a| a.value.field("b"));
        assert_eq!(b.map(|b| b.value.span.clone()), Some(13..14));
    }

    #[test]
    fn says_where_text_is_not_ron() {
        for (text, at, what) in [
            ("", 0, Syntax::Value),
            ("(a: 1", 5, Syntax::Separator(')')),
            ("(a: 1 b: 2)", 6, Syntax::Separator(')')),
            ("(a: 1, b)", 8, Syntax::Colon),
            ("(a: 1,5)", 6, Syntax::Name),
            ("(a: 1, \"b\": 2)", 7, Syntax::Name),
            ("(a: \"x)", 4, Syntax::OpenString),
            ("(/* a: 1)", 1, Syntax::OpenComment),
            ("(a: )", 4, Syntax::Value),
            ("(a: 1) 2", 7, Syntax::Trailing),
        ] {
            assert_eq!(outline(text), Err(SyntaxFault { at, what }), "{text}");
        }
        assert_eq!(outline(&"(".repeat(100_000)).map_err(|f| f.what), Err(Syntax::Depth));
    }
}

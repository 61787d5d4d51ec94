//! Tables line by line, where a line is no longer than that of any table.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Longest line, bytes: a thousand columns of numbers take a fiftieth of it.
const LONGEST: usize = 1 << 20;

/// Reads on while lines are short, so that a file that is no table is not taken into memory as one cell.
#[derive(Debug)]
pub struct ShortLines<R> {
    inner: R,
    /// Line that is being read, from 1, and its length so far.
    line: u64,
    length: usize,
}

impl ShortLines<File> {
    /// Opens a file.
    ///
    /// # Errors
    /// What the system says.
    pub fn open(path: &Path) -> io::Result<Self> {
        Ok(Self { inner: File::open(path)?, line: 1, length: 0 })
    }
}

impl<R: Read> Read for ShortLines<R> {
    /// # Errors
    /// [`io::ErrorKind::InvalidData`] with the number of a line that is too long.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        for (k, piece) in buffer[..count].split(|&byte| byte == b'\n').enumerate() {
            if k > 0 {
                (self.line, self.length) = (self.line + 1, 0);
            }
            self.length += piece.len();
            if self.length > LONGEST {
                let what = format!("line {} is longer than {LONGEST} bytes", self.line);
                return Err(io::Error::new(io::ErrorKind::InvalidData, what));
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_end_it() {
        let read = |text: &[u8]| {
            let mut kept = Vec::new();
            ShortLines { inner: text, line: 1, length: 0 }.read_to_end(&mut kept).map(|_| kept)
        };
        let longest = [b"a\n", &vec![b'b'; LONGEST][..], b"\n"].concat();
        assert_eq!(read(&longest.repeat(2)).unwrap(), longest.repeat(2));
        let long = [&longest[..], b"c\n", &vec![b'd'; LONGEST + 1][..]].concat();
        assert_eq!(read(&long).unwrap_err().to_string(), "line 4 is longer than 1048576 bytes");
    }
}

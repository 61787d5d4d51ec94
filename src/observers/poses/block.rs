//! Blocks of a recording: a length, bytes and their checksum.

use std::io::{self, Read, Write};

/// Bytes of a checksum.
const CHECKSUM: usize = 8;
/// Longer blocks are not ours.
const LONGEST: usize = 1 << 30;

/// Writes a block.
pub(super) fn write(to: &mut impl Write, content: &[u8]) -> io::Result<()> {
    to.write_all(&(content.len() as u64).to_le_bytes())?;
    to.write_all(content)?;
    to.write_all(&checksum(content))
}

/// Reads a block; `None` where no whole and sound one follows.
pub(super) fn read(from: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut length = [0; 8];
    if !fill(from, &mut length)? {
        return Ok(None);
    }
    let Some(length) = usize::try_from(u64::from_le_bytes(length)).ok().filter(|&length| length <= LONGEST)
    else {
        return Ok(None);
    };
    let mut content = vec![0; length];
    let mut sum = [0; CHECKSUM];
    Ok((fill(from, &mut content)? && fill(from, &mut sum)? && sum == checksum(&content)).then_some(content))
}

/// Bytes that a block of `content` bytes takes.
pub(super) fn size(content: usize) -> u64 {
    (8 + content + CHECKSUM) as u64
}

/// Reads until `buffer` is full; false where the file ends before.
fn fill(from: &mut impl Read, buffer: &mut [u8]) -> io::Result<bool> {
    match from.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

fn checksum(content: &[u8]) -> [u8; CHECKSUM] {
    let mut sum = [0; CHECKSUM];
    sum.copy_from_slice(&blake3::hash(content).as_bytes()[..CHECKSUM]);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_and_sound_blocks_are_read() {
        let mut bytes = Vec::new();
        write(&mut bytes, b"poses").unwrap();
        assert_eq!(bytes.len() as u64, size(5));
        assert_eq!(read(&mut &bytes[..]).unwrap().as_deref(), Some(&b"poses"[..]));
        for cut in 0..bytes.len() {
            assert_eq!(read(&mut &bytes[..cut]).unwrap(), None);
        }
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1;
            assert_eq!(read(&mut &damaged[..]).unwrap(), None, "byte {at}");
        }
    }
}

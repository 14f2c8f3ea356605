//! A check sum over a whole Parquet file, which has none of its own: between its groups and its end, where readers look for nothing.

use crc::{Crc, Digest, Table, CRC_32_ISO_HDLC};
use std::io::{self, Read, Seek, SeekFrom};

/// Before the check sum.
const MARK: &[u8; 8] = b"endatcrc";
const SUM_BYTES: u64 = 4;
/// Length of what is before them, and the mark of the form: the end of every Parquet file.
const TAIL_BYTES: u64 = 8;

static CRC: Crc<u32, Table<16>> = Crc::<u32, Table<16>>::new(&CRC_32_ISO_HDLC);

/// The sum of what has been written.
pub type Sum = Digest<'static, u32, Table<16>>;

/// Of nothing.
pub fn sum() -> Sum {
    CRC.digest()
}

/// What stands before the end of a file: the sum of groups and end.
pub fn seal(mut groups: Sum, end: &[u8]) -> Vec<u8> {
    groups.update(end);
    let mut bytes = MARK.to_vec();
    bytes.extend_from_slice(&groups.finalize().to_le_bytes());
    bytes.extend_from_slice(end);
    bytes
}

/// Reads so many bytes into a sum.
fn add(file: &mut impl Read, count: u64, sum: &mut Sum) -> io::Result<()> {
    let mut limited = file.take(count);
    let mut buffer = vec![0; 1 << 16];
    loop {
        match limited.read(&mut buffer)? {
            0 => return Ok(()),
            count => sum.update(&buffer[..count]),
        }
    }
}

/// Whether a file is as it was written.
pub fn is_whole(file: &mut (impl Read + Seek)) -> io::Result<bool> {
    let length = file.seek(SeekFrom::End(0))?;
    let mut tail = [0; TAIL_BYTES as usize];
    if length < TAIL_BYTES {
        return Ok(false);
    }
    file.seek(SeekFrom::Start(length - TAIL_BYTES))?;
    file.read_exact(&mut tail)?;
    let [a, b, c, d, ..] = tail;
    let end = u64::from(u32::from_le_bytes([a, b, c, d])) + TAIL_BYTES;
    let mark_bytes = MARK.len() as u64;
    let Some(groups) = length.checked_sub(end + SUM_BYTES + mark_bytes) else {
        return Ok(false);
    };
    let (mut mark, mut wanted) = ([0; MARK.len()], [0; SUM_BYTES as usize]);
    file.seek(SeekFrom::Start(groups))?;
    file.read_exact(&mut mark)?;
    file.read_exact(&mut wanted)?;
    let mut sum = sum();
    file.rewind()?;
    add(file, groups, &mut sum)?;
    file.seek(SeekFrom::Start(length - end))?;
    add(file, end, &mut sum)?;
    file.rewind()?;
    Ok(&mark == MARK && sum.finalize().to_le_bytes() == wanted)
}

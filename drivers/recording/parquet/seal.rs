//! A check sum over a whole Parquet file, which has none of its own: between its groups and its end, where readers look for nothing.

use crc::{Crc, Digest, Table, CRC_32_ISO_HDLC};
use std::io::{self, Read, Seek, SeekFrom};

/// Before the check sum.
const MARK: &[u8; 8] = b"endatcrc";
/// The mark, where the groups end, and the sum.
const SEAL_BYTES: u64 = MARK.len() as u64 + 8 + 4;
/// The mark of the form, at the very end.
const FORM: &[u8; 4] = b"PAR1";
/// Length of what is before them, and the mark of the form: the end of every Parquet file.
const TAIL_BYTES: u64 = 8;

static CRC: Crc<u32, Table<16>> = Crc::<u32, Table<16>>::new(&CRC_32_ISO_HDLC);

/// The sum of what has been written.
pub type Sum = Digest<'static, u32, Table<16>>;

/// Of nothing.
pub fn sum() -> Sum {
    CRC.digest()
}

/// What stands before the end of a file: where the groups end, and the sum of groups and end.
pub fn seal(mut sum: Sum, groups: u64, end: &[u8]) -> Vec<u8> {
    sum.update(end);
    let mut bytes = MARK.to_vec();
    bytes.extend_from_slice(&groups.to_le_bytes());
    bytes.extend_from_slice(&sum.finalize().to_le_bytes());
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

/// What has become of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is as it was written.
    Whole,
    /// It has no end: a copy of it was not finished, or what wrote it is none of this program.
    NoEnd,
    /// Some bit of it is another one.
    Damaged,
}

/// What has become of a file. Between groups and end there may be what a program that was killed has left of the next group.
pub fn state(file: &mut (impl Read + Seek)) -> io::Result<State> {
    let length = file.seek(SeekFrom::End(0))?;
    let mut tail = [0; TAIL_BYTES as usize];
    if length < TAIL_BYTES {
        return Ok(State::NoEnd);
    }
    file.seek(SeekFrom::Start(length - TAIL_BYTES))?;
    file.read_exact(&mut tail)?;
    let [a, b, c, d, form @ ..] = tail;
    if &form != FORM {
        return Ok(State::NoEnd);
    }
    let end = u64::from(u32::from_le_bytes([a, b, c, d])) + TAIL_BYTES;
    let Some(place) = length.checked_sub(end + SEAL_BYTES) else {
        return Ok(State::Damaged);
    };
    let (mut mark, mut groups, mut wanted) = ([0; MARK.len()], [0; 8], [0; 4]);
    file.seek(SeekFrom::Start(place))?;
    file.read_exact(&mut mark)?;
    file.read_exact(&mut groups)?;
    file.read_exact(&mut wanted)?;
    let groups = u64::from_le_bytes(groups);
    if &mark != MARK || groups > place {
        return Ok(State::Damaged);
    }
    let mut sum = sum();
    file.rewind()?;
    add(file, groups, &mut sum)?;
    file.seek(SeekFrom::Start(length - end))?;
    add(file, end, &mut sum)?;
    file.rewind()?;
    Ok(match sum.finalize().to_le_bytes() == wanted {
        true => State::Whole,
        false => State::Damaged,
    })
}

//! Text that goes into a file line by line.

use std::fs::File;
use std::io::{self, Write};

/// Collected until so much has come, or until it is flushed.
const CHUNK_BYTES: usize = 1 << 16;

/// Gives whole lines to a file: on a full disk it is cut behind the last one that got in.
pub struct Lines<W> {
    out: W,
    buffer: Vec<u8>,
    written: u64,
    cut: fn(&mut W, u64) -> io::Result<()>,
}

impl Lines<Box<dyn Write + Send>> {
    /// Whatever takes bytes, where what has been written cannot be taken back.
    pub fn to(out: Box<dyn Write + Send>) -> Self {
        Self::new(out, |_, _| Ok(()))
    }
}

impl Lines<File> {
    /// A new file.
    pub fn file(file: File) -> Self {
        Self::new(file, |file, bytes| file.set_len(bytes))
    }
}

impl<W: Write> Lines<W> {
    fn new(out: W, cut: fn(&mut W, u64) -> io::Result<()>) -> Self {
        Self {
            out,
            buffer: Vec::new(),
            written: 0,
            cut,
        }
    }

    /// Bytes that have come, in the file or on the way there.
    pub fn bytes(&self) -> u64 {
        self.written + self.buffer.len() as u64
    }

    /// How many bytes of `all` got in, and why not more.
    fn give(&mut self, all: &[u8]) -> (usize, io::Result<()>) {
        let mut done = 0;
        while done < all.len() {
            match self.out.write(&all[done..]) {
                Ok(0) => return (done, Err(io::ErrorKind::WriteZero.into())),
                Ok(count) => done += count,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return (done, Err(e)),
            }
        }
        (done, Ok(()))
    }
}

impl<W: Write> Write for Lines<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= CHUNK_BYTES && bytes.ends_with(b"\n") {
            self.flush()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        // What could not be written is not tried again: a row may never stand twice.
        let all = std::mem::take(&mut self.buffer);
        let (done, result) = self.give(&all);
        if let Err(error) = result {
            let whole = all[..done]
                .iter()
                .rposition(|b| *b == b'\n')
                .map_or(0, |at| at + 1);
            self.written += whole as u64;
            // A device has no length; the first error is the one to tell.
            let _ = (self.cut)(&mut self.out, self.written);
            return Err(error);
        }
        self.written += done as u64;
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for so many bytes.
    struct Disk(Vec<u8>, usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let room = bytes.len().min(self.1 - self.0.len());
            self.0.extend_from_slice(&bytes[..room]);
            match room {
                0 => Err(io::ErrorKind::StorageFull.into()),
                room => Ok(room),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_keeps_whole_lines() {
        for room in 0..14 {
            let mut lines = Lines::new(Disk(Vec::new(), room), |disk, bytes| {
                disk.0.truncate(bytes as usize);
                Ok(())
            });
            lines.write_all(b"1,2\n").unwrap();
            let first = lines.flush();
            lines.write_all(b"34,56\n7,8\n").unwrap();
            let kind = lines.flush().map_err(|e| e.kind());
            assert_eq!(kind, Err(io::ErrorKind::StorageFull), "{room}");
            let wanted: &[u8] = match room {
                0..4 => b"",
                4..10 => b"1,2\n",
                _ => b"1,2\n34,56\n",
            };
            // After an error nothing more is written: the program ends.
            if first.is_ok() {
                assert_eq!(lines.out.0, wanted, "{room}");
            }
        }
    }
}

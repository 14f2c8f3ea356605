//! Forms: TOML files that people fill in, read as a whole, with every complaint at its line.

pub mod asked;
pub mod document;
mod free;
pub mod key;
mod quantity;
pub mod reader;
mod strays;

use endat_console::artifact::read_regular;
use endat_console::error::{CommandError, Diagnostic};
use std::io::{self, Read as _};
use std::path::Path;

/// Largest file; a larger one is no form.
const FILE_BYTES_MAX: u64 = 1 << 20;

/// In the place of a file's name: what comes on standard input.
const STDIN: &str = "-";

/// What becomes of the text of a file; `remedy` is told when it cannot be read.
pub fn with_text<T>(
    path: &Path,
    remedy: &str,
    parse: impl Fn(&str, &str) -> Result<T, CommandError>,
) -> Result<T, CommandError> {
    let fail = |e: io::Error| CommandError::io("read", path, &e, remedy);
    if path == Path::new(STDIN) {
        let bytes = read_all(io::stdin().lock()).map_err(fail)?;
        return parse("stdin", text_of("stdin", &bytes)?);
    }
    let bytes = read_regular(path, FILE_BYTES_MAX).map_err(fail)?;
    let file = path.display().to_string();
    parse(&file, text_of(&file, &bytes)?)
}

/// Everything that comes, as much as a file may have.
fn read_all(from: impl io::Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(FILE_BYTES_MAX + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > FILE_BYTES_MAX {
        false => Ok(bytes),
        true => Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("has more than {FILE_BYTES_MAX} bytes"),
        )),
    }
}

/// The text in the bytes of a file.
fn text_of<'b>(file: &str, bytes: &'b [u8]) -> Result<&'b str, Vec<Diagnostic>> {
    let fail = |line, text: String| {
        Err(vec![Diagnostic {
            file: file.into(),
            line,
            text,
        }])
    };
    let line_of = |byte: usize| bytes[..byte].iter().filter(|b| **b == b'\n').count() + 1;
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
        return fail(0, "is UTF-16 text; save it as UTF-8".into());
    }
    if let Some(byte) = bytes.iter().position(|b| *b == 0) {
        return fail(
            line_of(byte),
            "has a zero byte: this is binary, not text; give a TOML file".into(),
        );
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text),
        Err(e) => fail(
            line_of(e.valid_up_to()),
            "is not UTF-8 text; save it as UTF-8".into(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_not_text_are_refused_with_their_line() {
        let line = |bytes: &[u8]| text_of("f", bytes).unwrap_err()[0].to_string();
        assert_eq!(
            line(b"a = 1\n\xFF"),
            "f:2: is not UTF-8 text; save it as UTF-8"
        );
        assert!(line(b"a\n\n\0").starts_with("f:3: has a zero byte"));
        assert!(line(b"\xFF\xFEa").contains("UTF-16"));
        assert_eq!(text_of("f", b"\xEF\xBB\xBFa"), Ok("a"));
    }
}

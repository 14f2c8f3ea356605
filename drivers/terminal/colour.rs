//! Colour, said once. What is painted here is plain again where colour is not wanted: in a file, with `NO_COLOR`, on a dumb terminal.

use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use std::fmt::Display;
use std::io::{self, Write};

fn painted(text: impl Display, style: Style) -> String {
    format!("{style}{text}{style:#}")
}

fn of(colour: AnsiColor) -> Style {
    Style::new().fg_color(Some(colour.into()))
}

/// All is well.
pub fn good(text: impl Display) -> String {
    painted(text, of(AnsiColor::Green))
}

/// Something is missing, or to be looked at.
pub fn doubtful(text: impl Display) -> String {
    painted(text, of(AnsiColor::Yellow))
}

/// Something is wrong.
pub fn bad(text: impl Display) -> String {
    painted(text, of(AnsiColor::Red))
}

/// A text in which these words say that all is well, and those that something is wrong.
pub fn verdicts(text: &str, all_is_well: &[&str], is_wrong: &[&str]) -> String {
    let well = all_is_well.iter().map(|word| (word, good(word)));
    let wrong = is_wrong.iter().map(|word| (word, bad(word)));
    well.chain(wrong)
        .fold(text.to_owned(), |text, (word, told)| {
            text.replace(word, &told)
        })
}

/// The same text without colour.
pub fn plain(text: &str) -> String {
    match text.contains('\x1b') {
        true => anstream::adapter::strip_str(text).to_string(),
        false => text.to_owned(),
    }
}

/// Whether colour is wanted on stdout.
pub fn is_wanted() -> bool {
    AutoStream::choice(&io::stdout()) != ColorChoice::Never
}

fn write(to: &mut impl Write, text: &str, is_wanted: bool) -> io::Result<()> {
    match is_wanted {
        true => to.write_all(text.as_bytes()),
        false => to.write_all(plain(text).as_bytes()),
    }
}

/// Writes a result.
pub fn to_stdout(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout();
    write(&mut stdout, text, is_wanted())?;
    stdout.flush()
}

/// Writes a message of this program; what ends it with an error is red.
pub fn to_stderr(program: &str, message: &str, is_error: bool) {
    let mut stderr = io::stderr();
    let is_wanted = AutoStream::choice(&stderr) != ColorChoice::Never;
    let style = match is_error {
        true => of(AnsiColor::Red).bold(),
        false => Style::new().bold(),
    };
    let name = painted(format_args!("{program}:"), style);
    // Nobody is left to be told.
    let _ = write(&mut stderr, &format!("{name} {message}\n"), is_wanted);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_painted_is_the_same_text_where_colour_is_not_wanted() {
        let text = verdicts("holds, fails\n", &["holds"], &["fails"]);
        assert_eq!(text, "\x1b[32mholds\x1b[0m, \x1b[31mfails\x1b[0m\n");
        for (is_wanted, seen) in [(true, text.as_str()), (false, "holds, fails\n")] {
            let mut out = Vec::new();
            write(&mut out, &text, is_wanted).unwrap();
            assert_eq!(out, seen.as_bytes());
        }
    }
}

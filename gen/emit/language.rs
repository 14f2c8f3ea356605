//! The languages that a core is written in.

use endat_console::error::{shown, CommandError};

/// A language of hardware.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// Verilog-2005.
    #[default]
    Verilog,
    /// VHDL-93 and VHDL-2008 at once.
    Vhdl,
}

impl Language {
    /// Both, and what they are called.
    pub const ALL: [(&'static str, Self); 2] = [("verilog", Self::Verilog), ("vhdl", Self::Vhdl)];

    /// The one that `--language` names, in small or capital letters.
    pub fn named(word: &str) -> Result<Self, CommandError> {
        let known = Self::ALL.into_iter();
        let found = known
            .clone()
            .find(|(name, _)| name.eq_ignore_ascii_case(word));
        let found = found.map(|(_, language)| language);
        found.ok_or_else(|| {
            let names: Vec<&str> = known.map(|(name, _)| name).collect();
            CommandError::input(format!(
                "--language = {}: is none that is emitted; give {}",
                shown(word),
                names.join(" or ")
            ))
        })
    }

    /// End of the names of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Verilog => ".v",
            Self::Vhdl => ".vhd",
        }
    }
}

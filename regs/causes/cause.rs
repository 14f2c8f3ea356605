//! A row of a table of causes.

use crate::named::named;
use crate::Named;

/// One cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cause {
    /// Its number.
    pub code: u64,
    /// Name, as counters and files have it.
    pub name: &'static str,
    /// Register that counts its frames, in the service of an EnDat channel.
    pub counter: &'static str,
    /// The same in words.
    pub meaning: &'static str,
    /// What it means for a user, and what to do; none for one that another protocol shares with EnDat.
    pub advice: Option<[&'static str; 2]>,
}

impl Cause {
    /// The cause under a number.
    pub(crate) const fn at(&self, number: u8) -> Named {
        named(self.name, number as u32, self.meaning)
    }
}

/// The row of a code.
pub(crate) const fn row(all: &'static [Cause], code: u64) -> &'static Cause {
    let mut at = 0;
    while all[at].code != code {
        at += 1;
    }
    &all[at]
}

/// Constants and list of the causes of a protocol: `CONSTANT = code, "name", "meaning"; "what it means", "what to do";`, or `same;`
/// instead of the last two.
macro_rules! causes {
    (@advice same) => { None };
    (@advice $means:literal, $helps:literal) => { Some([$means, $helps]) };
    ($($constant:ident = $code:literal, $name:literal, $meaning:literal; $($advice:tt),+;)*) => {
        $(
            #[doc = concat!("Code of `", $name, "`: ", $meaning, ".")]
            pub const $constant: u64 = $code;
        )*
        /// All of them.
        pub const ALL: &[$crate::causes::Cause] = &[
            $($crate::causes::Cause {
                code: $code,
                name: $name,
                counter: concat!("frames_", $name),
                meaning: $meaning,
                advice: $crate::causes::cause::causes!(@advice $($advice),+),
            }),*
        ];
        /// Words for a code.
        pub const fn name(code: u64) -> &'static str {
            match code {
                $($constant => $meaning,)*
                _ => "unknown",
            }
        }
    };
}
pub(crate) use causes;

/// Codes of a protocol that a result has room for.
pub const CODES: u8 = 32;

/// The causes of a protocol under its codes, those below `N`.
pub(crate) const fn coded<const N: usize>(all: &[Cause]) -> [Named; N] {
    let mut coded = [named("", 0, ""); N];
    let mut row = 0;
    while row < N {
        coded[row] = all[row].at(all[row].code as u8);
        row += 1;
    }
    coded
}

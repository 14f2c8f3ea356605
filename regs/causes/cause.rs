//! A row of a table of causes.

use crate::named::named;
use crate::Named;

/// One cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cause {
    /// Code in the result.
    pub code: u64,
    /// Name in counters and files.
    pub name: &'static str,
    /// Counter register in the service of an EnDat channel.
    pub counter: &'static str,
    /// Short description.
    pub meaning: &'static str,
    /// Explanation and remedy; `None` if EnDat has the same cause.
    pub advice: Option<[&'static str; 2]>,
}

impl Cause {
    /// The cause with this number.
    pub(crate) const fn at(&self, number: u8) -> Named {
        named(self.name, number as u32, self.meaning)
    }
}

/// The row with this code.
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
        /// All causes, by code.
        pub const ALL: &[$crate::causes::Cause] = &[
            $($crate::causes::Cause {
                code: $code,
                name: $name,
                counter: concat!("frames_", $name),
                meaning: $meaning,
                advice: $crate::causes::cause::causes!(@advice $($advice),+),
            }),*
        ];
        /// Short description of a code.
        pub const fn name(code: u64) -> &'static str {
            match code {
                $($constant => $meaning,)*
                _ => "unknown",
            }
        }
    };
}
pub(crate) use causes;

/// Number of codes that fit into a result.
pub const CODES: u8 = 32;

/// The causes below code `N`, by code.
pub(crate) const fn coded<const N: usize>(all: &[Cause]) -> [Named; N] {
    let mut coded = [named("", 0, ""); N];
    let mut row = 0;
    while row < N {
        coded[row] = all[row].at(all[row].code as u8);
        row += 1;
    }
    coded
}

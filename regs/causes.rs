//! Causes: why a frame or an exchange gave no position, or what there is to say about it. One row has all that is known of a cause.
//!
//! The host reads which protocol the channel speaks. In the result of a card both have one list: what T-format shares with EnDat has
//! EnDat's number there, its own causes stand behind EnDat's ([`t_format::of_card`]).

pub mod endat;
pub mod t_format;

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
    /// What it means for a user, and what to do; none for one that T-format shares with EnDat.
    pub advice: Option<[&'static str; 2]>,
}

impl Cause {
    /// The cause under its number in the result of a card.
    const fn at(&self, code: u64) -> Named {
        named(self.name, code as u32, self.meaning)
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
                advice: $crate::causes::causes!(@advice $($advice),+),
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
use causes;

/// Codes that the result of a card has room for.
const CARD_CODES: usize = 32;

/// Primary causes of both protocols, as the result of a card has them.
pub const CARD: &[Named] = &{
    let mut all = [named("", 0, ""); CARD_CODES];
    let mut row = 0;
    while row < t_format::ALL.len() {
        let code = t_format::of_card(t_format::ALL[row].code);
        all[code as usize] = t_format::ALL[row].at(code);
        row += 1;
    }
    row = 0;
    while row < endat::ALL.len() {
        let code = endat::ALL[row].code;
        all[code as usize] = endat::ALL[row].at(code);
        row += 1;
    }
    all
};

/// T-format's causes, as an exchange of the host has them: those before the trigger overrun.
pub const EXCHANGE: &[Named] = &{
    let mut all = [named("", 0, ""); t_format::TRIGGER_OVERRUN as usize];
    let mut row = 0;
    while row < all.len() {
        all[row] = t_format::ALL[row].at(t_format::ALL[row].code);
        row += 1;
    }
    all
};

/// What the cause of that name means for a user, and what to do about it.
pub fn advice(name: &str) -> Option<[&'static str; 2]> {
    let mut all = endat::ALL.iter().chain(t_format::ALL);
    all.find(|cause| cause.name == name)?.advice
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a hole in the card's numbers, a row out of its order, a shared cause without EnDat's row.
    #[test]
    fn every_code_of_a_result_has_a_name_and_advice() {
        for (code, cause) in (0..).zip(CARD) {
            assert_eq!(cause.number, code);
            assert!(advice(cause.name).is_some(), "{code}: {}", cause.name);
        }
        for (code, cause) in (0..).zip(t_format::ALL) {
            assert_eq!(cause.code, code);
            let shared = endat::ALL.iter().find(|c| c.name == cause.name);
            assert_eq!(shared.is_some(), cause.advice.is_none(), "{}", cause.name);
            let on_card = &CARD[t_format::of_card(code) as usize];
            assert_eq!(on_card.name, cause.name);
        }
        assert_eq!(endat::name(endat::COUNT), "unknown");
        assert_eq!(t_format::name(t_format::COUNT), "unknown");
        assert_eq!(advice("frames_crc"), None);
    }
}

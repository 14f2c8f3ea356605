//! Causes: why a frame or an exchange gave no position, or what there is to say about it. One row has all that is known of a cause.
//!
//! Each protocol has codes of its own, in 5 bits of a result: a new cause is a row, and renumbers none of the other protocol. Who reads them knows
//! which protocol the channel speaks (`card.protocols`). Programs take them as numbers of one list ([`number`]): EnDat's codes, then T-format's own.

pub mod endat;
pub mod t_format;

use crate::named::named;
use crate::register::is_same;
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
    /// The cause under a number.
    const fn at(&self, number: u8) -> Named {
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

/// Codes of a protocol that a result has room for.
pub const CODES: u8 = 32;

/// The causes of a protocol under its codes, those below `N`.
const fn coded<const N: usize>(all: &[Cause]) -> [Named; N] {
    let mut coded = [named("", 0, ""); N];
    let mut row = 0;
    while row < N {
        coded[row] = all[row].at(all[row].code as u8);
        row += 1;
    }
    coded
}

/// Causes of EnDat, under the codes of a result.
pub const ENDAT: &[Named] = &coded::<{ endat::ALL.len() }>(endat::ALL);
/// Causes of T-format, under the codes of a result.
pub const T_FORMAT: &[Named] = &coded::<{ t_format::ALL.len() }>(t_format::ALL);
/// T-format's causes, as an exchange of the host has them: those before the trigger overrun.
pub const EXCHANGE: &[Named] = &coded::<{ t_format::TRIGGER_OVERRUN as usize }>(t_format::ALL);

/// Number of each cause of T-format, at its code: what it shares with EnDat has EnDat's code, its own stand behind EnDat's.
const NUMBERS: [u8; t_format::ALL.len()] = {
    let mut numbers = [0; t_format::ALL.len()];
    let mut row = 0;
    while row < numbers.len() {
        let cause = &t_format::ALL[row];
        numbers[row] = match cause.advice {
            Some(_) => CODES + cause.code as u8,
            None => code_in_endat(cause.name),
        };
        row += 1;
    }
    numbers
};

/// EnDat's code of a cause that both have; without one it does not compile.
const fn code_in_endat(name: &str) -> u8 {
    let mut row = 0;
    while !is_same(endat::ALL[row].name, name) {
        row += 1;
    }
    endat::ALL[row].code as u8
}

/// Number of a cause in the list of both protocols.
pub const fn number(code: u8, is_t_format: bool) -> u8 {
    match is_t_format {
        false => code,
        true if (code as usize) < NUMBERS.len() => NUMBERS[code as usize],
        true => CODES + code,
    }
}

/// Causes that T-format does not share with EnDat.
const OWN: usize = {
    let (mut own, mut row) = (0, 0);
    while row < NUMBERS.len() {
        own += (NUMBERS[row] >= CODES) as usize;
        row += 1;
    }
    own
};

/// Causes of both protocols, each once, under the numbers of [`number`].
pub const ALL: &[Named] = &{
    let mut all = [named("", 0, ""); endat::ALL.len() + OWN];
    let (mut row, mut next) = (0, endat::ALL.len());
    while row < next {
        all[row] = ENDAT[row];
        row += 1;
    }
    row = 0;
    while row < t_format::ALL.len() {
        if NUMBERS[row] >= CODES {
            all[next] = t_format::ALL[row].at(NUMBERS[row]);
            next += 1;
        }
        row += 1;
    }
    all
};

/// The cause under a number of [`ALL`].
pub fn of(number: u8) -> Option<&'static Named> {
    ALL.iter().find(|cause| cause.number == number.into())
}

/// What the cause of that name means for a user, and what to do about it.
pub fn advice(name: &str) -> Option<[&'static str; 2]> {
    let mut all = endat::ALL.iter().chain(t_format::ALL);
    all.find(|cause| cause.name == name)?.advice
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a row out of its order, a code that does not fit a result, a shared cause without EnDat's row.
    #[test]
    fn every_code_of_a_result_has_a_name_and_advice() {
        for (all, coded, is_t_format) in
            [(endat::ALL, ENDAT, false), (t_format::ALL, T_FORMAT, true)]
        {
            for (cause, named) in all.iter().zip(coded) {
                assert!(cause.code < CODES.into(), "{}", cause.name);
                assert_eq!(u64::from(named.number), cause.code);
                let found = of(number(cause.code as u8, is_t_format)).unwrap();
                assert_eq!(found.name, cause.name);
                assert!(advice(found.name).is_some(), "{}", cause.name);
            }
        }
        for (code, cause) in (0..).zip(t_format::ALL) {
            assert_eq!(cause.code, code);
            let shared = endat::ALL.iter().find(|c| c.name == cause.name);
            assert_eq!(shared.is_some(), cause.advice.is_none(), "{}", cause.name);
        }
        assert_eq!(of(CODES - 2), None);
        assert_eq!(endat::name(endat::COUNT), "unknown");
        assert_eq!(t_format::name(t_format::COUNT), "unknown");
        assert_eq!(advice("frames_crc"), None);
    }
}

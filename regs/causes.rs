//! Causes: why a frame or an exchange gave no position, or which remark it has. Each row describes one cause.
//!
//! Each protocol has its own codes, in 5 bits of a result, so a new cause adds a row and does not renumber those of another protocol.
//! The host learns the protocol of a channel from `card.protocols`. Programs use the numbers of one list ([`number`]): EnDat's codes,
//! then the additional causes of each other protocol.

pub(crate) mod cause;
pub mod endat;

pub use cause::{Cause, CODES};

use crate::named::named;
use crate::protocols::Protocol;
use crate::register::is_same;
use crate::Named;

/// Causes of EnDat, under the codes of a result.
pub const ENDAT: &[Named] = endat::CODED;

/// EnDat's code of a shared cause; compilation fails if EnDat has no such cause.
const fn code_in_endat(name: &str) -> u8 {
    let mut row = 0;
    while !is_same(endat::ALL[row].name, name) {
        row += 1;
    }
    endat::ALL[row].code as u8
}

/// Number of a protocol's code in the list of all protocols. Shared causes have EnDat's code; the others follow those of the
/// protocols before it.
pub const fn number(code: u8, protocol: Protocol) -> u8 {
    let causes = protocol.row().causes;
    // Each protocol's rows are in the order of their codes.
    if (code as usize) < causes.len() && causes[code as usize].advice.is_none() {
        return code_in_endat(causes[code as usize].name);
    }
    CODES * protocol as u8 + code
}

/// Causes of all protocols, each once.
const COUNT: usize = {
    let (mut count, mut at) = (0, 0);
    while at < Protocol::ALL.len() {
        let causes = Protocol::ALL[at].row().causes;
        let mut row = 0;
        while row < causes.len() {
            count += causes[row].advice.is_some() as usize;
            row += 1;
        }
        at += 1;
    }
    count
};

/// Causes of all protocols, each once, under the numbers of [`number`].
pub const ALL: &[Named] = &{
    let mut all = [named("", 0, ""); COUNT];
    let (mut next, mut at) = (0, 0);
    while at < Protocol::ALL.len() {
        let causes = Protocol::ALL[at].row().causes;
        let mut row = 0;
        while row < causes.len() {
            if causes[row].advice.is_some() {
                all[next] = causes[row].at(number(causes[row].code as u8, Protocol::ALL[at]));
                next += 1;
            }
            row += 1;
        }
        at += 1;
    }
    all
};

/// The cause under a number of [`ALL`].
pub fn of(number: u8) -> Option<&'static Named> {
    ALL.iter().find(|cause| cause.number == number.into())
}

/// Meaning and remedy of the cause with this name.
pub fn advice(name: &str) -> Option<[&'static str; 2]> {
    let mut all = Protocol::ALL.iter().flat_map(|p| p.row().causes);
    all.find(|cause| cause.name == name && cause.advice.is_some())?
        .advice
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a row in the wrong place, a code that does not fit into a result, and a shared cause without a row in EnDat.
    #[test]
    fn every_code_of_a_result_has_a_name_and_advice() {
        for protocol in Protocol::ALL {
            let row = protocol.row();
            assert_eq!(row.causes.len(), row.coded.len());
            for (code, (cause, named)) in (0..).zip(row.causes.iter().zip(row.coded)) {
                assert!(cause.code < CODES.into(), "{}", cause.name);
                assert_eq!(u64::from(named.number), cause.code);
                let found = of(number(cause.code as u8, *protocol)).unwrap();
                assert_eq!(found.name, cause.name);
                assert!(advice(found.name).is_some(), "{}", cause.name);
                if *protocol != Protocol::Endat {
                    assert_eq!(cause.code, code);
                    let shared = endat::ALL.iter().find(|c| c.name == cause.name);
                    assert_eq!(shared.is_some(), cause.advice.is_none(), "{}", cause.name);
                }
            }
        }
        assert_eq!(of(CODES - 2), None);
        assert_eq!(endat::name(endat::COUNT), "unknown");
        assert_eq!(advice("frames_crc"), None);
    }
}

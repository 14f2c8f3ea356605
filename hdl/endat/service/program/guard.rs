//! Guard of the words that control frames and are rarely rewritten: each is stored together with its complement.
//!
//! ```text
//! host writes a word --> WRITTEN --> the program guards its words anew
//! main loop: word + complement = -1?  no, and not WRITTEN --> restart of the program, `starts` counts
//! ```
//!
//! [`own`] marks the words of the host.

use super::{own, ServiceTimes};
use crate::endat::sequencer::assembler::Assembler;

/// The guarded words of the host, in this build.
pub(super) fn settings(times: &ServiceTimes) -> impl Iterator<Item = (u8, u8)> {
    let all = [
        (true, own::SET_FORCE),
        (times.diagnosis, own::SET_WATCHDOG),
        (times.diagnosis, own::SET_RECOVERY),
        (times.continuous, own::SET_CONTINUOUS),
        (times.error_test_ms > 0, own::SET_ERROR_TEST),
    ];
    let there = all.into_iter().filter(|(is_there, _)| *is_there);
    there.map(|(_, setting)| setting)
}

/// All guarded words with their complements.
pub(super) fn guarded(times: &ServiceTimes) -> impl Iterator<Item = (u8, u8)> {
    own::KEPT.into_iter().chain(settings(times))
}

/// Stores the complement of a word.
pub(super) fn guard(a: &mut Assembler, (word, inverse): (u8, u8)) {
    a.ld(word).xori(u16::MAX).st(inverse);
}

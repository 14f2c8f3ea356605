//! Words that decide about frames as long as nobody writes them again: each has its complement beside it.
//!
//! ```text
//! host writes a word --> WRITTEN --> the program guards its words anew
//! main loop: word + complement = -1?  no, and not WRITTEN --> everything begins anew, `starts` counts
//! ```
//!
//! Which of the words are the host's is in [`own`].

use super::{own, ServiceTimes};
use crate::endat::sequencer::assembler::Assembler;

/// The words of the host that are guarded, of what there is.
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

/// All words that are guarded by their complement.
pub(super) fn guarded(times: &ServiceTimes) -> impl Iterator<Item = (u8, u8)> {
    own::KEPT.into_iter().chain(settings(times))
}

/// Guards a word as it is.
pub(super) fn guard(a: &mut Assembler, (word, inverse): (u8, u8)) {
    a.ld(word).xori(u16::MAX).st(inverse);
}

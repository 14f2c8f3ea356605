//! The protocols besides EnDat that the program knows.

use crate::other_protocol::Other;
use crate::t_format::protocol::TFormat;
use endat_regs::Protocol;

/// All of them.
pub const OTHERS: &[&dyn Other] = &[&TFormat];

/// What there is to know of a protocol; none of EnDat.
pub fn other(protocol: Protocol) -> Option<&'static dyn Other> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

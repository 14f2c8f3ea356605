//! The protocols besides EnDat that the program knows.

pub mod ssi;
pub mod t_format;

use crate::other_protocol::Other;
use endat_hdl::config::CardConfig;
use endat_regs::Protocol;

/// All of them.
pub(crate) const OTHERS: &[&dyn Other] = &[&t_format::protocol::TFormat, &ssi::protocol::Ssi];

/// Those that channels of a card speak.
pub(crate) fn others_on(card: &CardConfig) -> impl Iterator<Item = &'static dyn Other> + '_ {
    let all = OTHERS.iter().copied();
    all.filter(|other| card.speaks(other.protocol()))
}

/// All protocols that channels of a card speak.
pub(crate) fn spoken(card: &CardConfig) -> impl Iterator<Item = Protocol> + '_ {
    let all = Protocol::ALL.iter().copied();
    all.filter(|protocol| card.speaks(*protocol))
}

/// What there is to know of a protocol; none of EnDat.
pub(crate) fn other(protocol: Protocol) -> Option<&'static dyn Other> {
    let mut all = OTHERS.iter().copied();
    all.find(|other| other.protocol() == protocol)
}

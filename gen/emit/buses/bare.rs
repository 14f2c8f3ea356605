//! No bus: one encoder port with its signals.

use crate::front::{design_of, Front};
use endat_hdl::card::bare_port;

/// What there is to know of it.
pub(super) const FRONT: Front = Front {
    design: |card, name, _, _| design_of(bare_port(card), name),
    bench_host: None,
    controller: None,
    interface: None,
};

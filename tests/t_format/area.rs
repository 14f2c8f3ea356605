//! The receiver is smaller than the published one of the same function.

use crate::tools;
use crate::verilog::area::require;
use endat_gen::area::{subjects, synthesise, ECP5, ICE40};

/// LUTs of four inputs and flip-flops of Microchip's T-Format interface.
const PEER: (u64, u64) = (248, 256);

#[test]
fn the_receiver_is_smaller_than_the_published_one() {
    if !require("area of the T-format receiver") {
        return;
    }
    let subjects = subjects().unwrap();
    let receiver = subjects.iter().find(|s| s.name == "t_format").unwrap();
    for family in [ICE40, ECP5] {
        let folder = tools::folder(&format!("t_format-{}", family.name));
        let found = synthesise(&folder, &receiver.files(), receiver.name, &family).unwrap();
        let usage = found.usage;
        assert!(
            usage.lut < PEER.0 && usage.ff < PEER.1,
            "{}: {usage:?}, {:?}",
            family.name,
            found.cells
        );
    }
}

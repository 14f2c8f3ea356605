//! Faulty frames of real encoders.

use super::rig::*;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand;
use endat_sim::encoder::{Defect, PositionSource};

/// An EQI 1331 at 200 kHz, read from an oscilloscope, start bit first: its CRC should be 0x19.
#[test]
fn a_frame_of_an_eqi_1331_with_a_wrong_crc_is_a_crc_error() {
    const READ_OFF: u64 = 0x31_A69C_1D24;
    const BITS: u32 = 31;
    let answer_bits = BITS + 7;
    let bit = |i: u32| READ_OFF >> (answer_bits - 1 - i) & 1;
    let position = (0..BITS).fold(0, |word, i| word | bit(2 + i) << i);
    assert_eq!((bit(0), position), (1, 0x4B83_9658));
    let rates = (100_000_000, 200_000);
    let mut setup = Setup::new(rates, ModeCommand::SendPosition, BITS, 1.0);
    setup.encoder.position = PositionSource::Fixed(position);
    let f1 = bit(1) == 1;
    let setup = setup
        .defect(1, Defect::ErrorBits { f1, f2: true })
        .defect(1, Defect::CrcXor(0x19 ^ (READ_OFF & 31) as u8));
    let mut rig = setup.ready();
    let good = good_frame(&mut rig);
    settle(&mut rig);
    let read = any_frame(&mut rig);
    let sent = &rig.frames(0)[1].answer;
    let sent = sent.iter().fold(0, |word, bit| word << 1 | u64::from(bit));
    assert_eq!(sent, READ_OFF);
    assert_eq!((read.crc_received, read.crc_computed), (0x04, 0x19));
    assert_eq!((read.cause, read.fresh), (cause::CRC, false), "{read:?}");
    assert_eq!(
        read.position, good.position,
        "the last good position remains"
    );
    settle(&mut rig);
    assert_eq!((rig.violations(0), rig.conflicts(0)), (&[][..], vec![]));
}

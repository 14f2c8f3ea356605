//! Errors in additional data, and a record that resynchronises.

use super::rig::Rig;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    encoder::{Defect, EncoderConfig},
    MS,
};

const SYSTEM_HZ: u64 = 64_000_000;

fn rig(encoder: EncoderConfig) -> Rig {
    let mut rig = Rig::new(SYSTEM_HZ, 8_000_000, encoder, 50.0);
    rig.good_position();
    rig
}

fn select(rig: &mut Rig, codes: &[u8]) {
    for code in codes {
        rig.good(PositionSelectMemory, *code, 0);
    }
}

#[test]
fn an_error_in_one_block_of_additional_data_spoils_neither_the_position_nor_the_other_one() {
    for (info, good) in [(1, 0b10), (2, 0b01)] {
        let defect = Defect::InfoCrcXor { info, xor: 0b10 };
        let mut rig = rig(EncoderConfig::endat22(29).defect(4, defect));
        select(&mut rig, &[0x4C, 0x5B]);
        let over = rig.position();
        assert_eq!((over.cause, over.flags), (cause::NONE, 0));
        assert_eq!(rig.bench.get("info_came"), 0b11);
        assert_eq!(rig.bench.get("info_good"), good);
        assert!(rig.bench.results().last().unwrap().fresh);
        rig.good_position();
    }
}

/// The encoder is replaced between two frames: its additional data are off, and the card has no information about it.
#[test]
fn additional_data_that_are_gone_are_forgotten_with_the_first_frame() {
    for codes in [&[0x4C][..], &[0x5B], &[0x4C, 0x5B]] {
        let mut encoder = EncoderConfig::endat22(29);
        encoder.unplugged.push(10 * MS..11 * MS);
        let mut rig = rig(encoder);
        select(&mut rig, codes);
        rig.good_position();
        rig.bench.run_until(12 * MS);
        let over = rig.position();
        assert_eq!(cause::name(over.cause), "additional data missing");
        let result = rig.bench.results().last().unwrap().clone();
        assert!(
            !result.fresh,
            "the frame has another length than it should have"
        );
        assert_eq!(rig.good_position().infos.len(), 0);
        rig.good_position();
    }
}

/// The core is reset, the encoder is not: it sends unexpected additional data.
#[test]
fn additional_data_that_nobody_expects_are_found_out() {
    for (codes, frames) in [(&[0x4C][..], 2), (&[0x5B], 2), (&[0x4C, 0x5B], 1)] {
        let mut rig = rig(EncoderConfig::endat22(29));
        select(&mut rig, codes);
        rig.good_position();
        rig.bench.reset();
        assert!(rig.bench.run_until_done(MS, |b| b.get("busy") == 0));
        for _ in 0..frames {
            let over = rig.position();
            assert_ne!(over.cause, cause::NONE);
        }
        assert_eq!(rig.good_position().infos.len(), codes.len());
        let active = codes.iter().fold(0, |a, c| a | 1 << u32::from(*c >= 0x50));
        assert_eq!(rig.bench.get("info_active"), active);
        rig.good_position();
    }
}

#[test]
fn switching_off_and_the_reset_end_them() {
    let mut encoder = EncoderConfig::endat22(29);
    encoder.reset_time = 0;
    let mut rig = rig(encoder);
    select(&mut rig, &[0x4C, 0x5B, 0x4F]);
    assert_eq!(rig.good_position().infos.len(), 1);
    assert_eq!(rig.bench.get("info_active"), 0b10);
    select(&mut rig, &[0x4D]);
    rig.good(ReceiveReset, 0, 0);
    assert_eq!(rig.good_position().infos.len(), 0);
    rig.assert_clean();
}

/// A supplement that is not sent selects nothing.
#[test]
fn a_frame_that_is_given_up_selects_nothing() {
    let mut rig = rig(EncoderConfig::endat22(29).defect(2, Defect::NoStartBit));
    let over = rig.ride(PositionSelectMemory, 0x4C, 0);
    assert_eq!(over.cause, cause::NO_START_BIT);
    assert_eq!(rig.bench.get("info_active"), 0);
    // A frame that measures the delay again carries no request; the frame after it does.
    let over = rig.ride(PositionSelectMemory, 0x4C, 0);
    assert_eq!((over.cause, over.is_request), (cause::NONE, false));
    assert_eq!(rig.last_frame().command, Some(PositionSelectMemory.code()));
    assert_eq!(rig.good_position().infos.len(), 1);
}

//! The plug is pulled in a frame with additional data 1 and 2 and a supplement, and plugged in again: some of the times of `plug`.

use super::rig::{hasty, Make, Rig, ENDAT_HZ, SYSTEM_HZ};
use endat_hdl::endat::service::map::{request_state, state, word};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{
    bench::{Bench, ChannelSettings, Link, PinNames},
    encoder::EncoderConfig,
    line::LineConfig,
    Time, MS, US,
};
use rtl_design::engine::Compiled;
use std::ops::Range;
use std::sync::OnceLock;

/// Start of the frame in which the plug is pulled.
const FRAME: Time = 5 * MS;
const POSITION_BITS: u32 = 13;
/// An open line is detected after 5 ms.
const LONG: Time = 8 * MS;

fn make(initialise: bool) -> Make {
    Make {
        initialise,
        ..Make::hasty()
    }
}

fn encoder() -> EncoderConfig {
    hasty(EncoderConfig::endat22(POSITION_BITS))
}

/// A running port; its encoder is initialised if `initialise`.
fn ready(initialise: bool) -> Compiled {
    static MADE: [OnceLock<Compiled>; 2] = [const { OnceLock::new() }; 2];
    let made = || {
        let mut rig = Rig::with(make(initialise), ENDAT_HZ, encoder(), POSITION_BITS);
        if initialise {
            assert_eq!(rig.initialised(), 0);
        }
        rig.good_position();
        rig.bench.run_for(MS);
        rig.bench.engine().clone()
    };
    MADE[usize::from(initialise)].get_or_init(made).clone()
}

/// Pulls the plug this long after the trigger, and again within the spans after it is plugged in. Everything works again afterwards.
fn pull(initialise: bool, after: Time, length: Time, bounces: &[Range<Time>]) {
    let mut encoder = encoder();
    let back = FRAME + after + length;
    encoder.unplugged.push(FRAME + after..back);
    let bounces = bounces.iter().map(|b| back + b.start..back + b.end);
    encoder.unplugged.extend(bounces);
    let stays = encoder.unplugged.last().map_or(0, |u| u.end);
    let link = Link::new(LineConfig::cable(20.0), encoder);
    let links = vec![(PinNames::channel(), link)];
    let mut bench = Bench::new(ready(initialise), SYSTEM_HZ, links);
    bench.configure(&ChannelSettings::new(
        SYSTEM_HZ,
        ENDAT_HZ,
        SendPositionAddInfo,
        POSITION_BITS,
    ));
    let mut rig = Rig { bench };
    rig.good(PositionSelectMemory, 0x4C, 0);
    rig.good(PositionSelectMemory, 0x5B, 0);
    assert!(rig.bench.now() < FRAME - 100 * US);
    rig.bench.run_until(FRAME - 60 * US);
    rig.write(
        word::REQUEST,
        u32::from(PositionSelectMemory.code()) << 24 | 0x4D << 16,
    );
    rig.bench.run_until(FRAME);
    while rig.bench.now() < stays + MS {
        rig.frames(1);
    }
    if initialise && length >= LONG {
        assert_eq!(rig.state() & state::INITIALISED, 0, "known as lost");
        rig.wait_for(word::STATE, |s| s as u16 & state::INITIALISED != 0);
    }
    rig.frames(12);
    // Every fresh position is one that the encoder sent.
    let mut sent = rig.bench.frames(0).iter().map(|f| f.position);
    for result in rig.bench.results().iter().filter(|r| r.fresh) {
        assert!(
            sent.any(|position| position == result.position),
            "{result:?}"
        );
    }
    rig.good_position();
    // The request under way has ended.
    assert_eq!(
        rig.read(word::REQUEST_STATE) as u16 & request_state::BUSY,
        0
    );
    rig.good(PositionSelectMemory, 0xA1, 0);
    assert_eq!(rig.good(PositionSelectMemory, 0x47, 0) & 0xFFFF, 0xA100);
    rig.good_position();
}

/// In the mode command, in the position, in the additional data, in the recovery time.
const PLACES: [Time; 4] = [3_250 * US / 1_000, 14 * US, 40 * US, 75 * US];

#[test]
fn without_initialisation_an_unplugged_encoder_is_found_again() {
    for (after, length) in PLACES.into_iter().zip([3 * US, 150 * US, 23 * US, LONG]) {
        pull(false, after, length, &[]);
    }
}

#[test]
fn an_encoder_unplugged_for_a_moment_is_found_again() {
    for (after, length) in PLACES
        .into_iter()
        .zip([600 * US, 23 * US, 3 * US, 150 * US])
    {
        pull(true, after, length, &[]);
    }
}

#[test]
fn an_encoder_unplugged_for_long_is_initialised_afresh() {
    for after in [14 * US, 40 * US] {
        pull(true, after, LONG, &[]);
    }
}

/// In the power-up sequence, and in a step of the initialisation.
#[test]
fn an_encoder_whose_plug_bounces_is_initialised_at_last() {
    for (after, length) in [(400 * US, 30 * US), (9 * MS, 2_500 * US)] {
        let again = after + length + 50 * US;
        let bounces = [after..after + length, again..again + 30 * US];
        pull(true, 40 * US, LONG, &bounces);
    }
}

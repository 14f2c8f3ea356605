//! A line that breaks in the middle of a frame, and an encoder with a recovery time above the limit.

use super::run::{Run, Settings, SYSTEM_MHZ};
use endat_hdl::protocols::ssi::cause;
use endat_sim::ssi::EncoderConfig;
use endat_sim::US;

const PERIOD: u64 = 20;
const WIDTH: u32 = 25;
const POSITION: u64 = 0x1DB_6DB7;
const RECOVERY_MAX_US: u64 = 20;

fn start(tm_us: u64) -> Run {
    let encoder = EncoderConfig {
        position_bits: WIDTH,
        position: POSITION,
        repeats: false,
        tm: tm_us * US,
        ..EncoderConfig::default()
    };
    let settings = Settings {
        frame: 4,
        period_cycles: PERIOD,
        recovery_limit_cycles: RECOVERY_MAX_US * SYSTEM_MHZ + 10,
    };
    Run::new(settings, encoder)
}

/// DATA goes LOW permanently at every half period of a frame: until the end of the recovery time the frame may look good.
#[test]
fn port_withdraws_a_position_when_data_stays_low() {
    let start = start(18);
    let (mut withdrawn, mut refused) = (0, 0);
    for moment in 0..u64::from(WIDTH + 1) * 2 {
        let mut run = start.clone();
        run.trigger();
        run.cycles(moment * PERIOD / 2);
        run.broken = Some(false);
        run.cycles((u64::from(WIDTH) + 4) * PERIOD);
        withdrawn += u64::from(run.fresh().is_some_and(|at| at != POSITION));
        refused += u64::from(run.fresh().is_none());
        assert!(run.ends());
        run.cycles(5);
        assert_eq!(run.fresh(), None, "{moment}");
        assert_eq!(run.get("position_valid"), 0, "{moment}");
        let told = [cause::DATA_NOT_HIGH, cause::RECOVERY_TOO_LONG].map(u128::from);
        assert!(told.contains(&run.get("cause")), "{moment}");
        assert_eq!(run.get("sequence"), 1, "no other result");
        // The line is repaired.
        run.broken = None;
        run.cycles(RECOVERY_MAX_US * SYSTEM_MHZ);
        run.trigger();
        assert!(run.ends());
        assert_eq!(run.fresh(), Some(POSITION), "{moment}");
    }
    assert!(withdrawn > 20 && refused > 0, "{withdrawn} {refused}");
}

/// An encoder with a longer recovery time than configured looks the same: its position is withdrawn, and the next result reports it, too.
#[test]
fn port_withdraws_the_position_of_an_encoder_that_recovers_too_late() {
    let mut run = start(30);
    for _ in 0..2 {
        run.trigger();
        run.cycles((u64::from(WIDTH) + 4) * PERIOD);
        assert_eq!(run.fresh(), Some(POSITION));
        assert!(run.ends());
        run.cycles(5);
        assert_eq!(run.fresh(), None);
        assert_eq!(run.get("cause"), u128::from(cause::RECOVERY_TOO_LONG));
        let flag = u128::from(cause::flag(cause::RECOVERY_TOO_LONG));
        assert_eq!(run.get("flags"), flag);
        run.cycles(20 * SYSTEM_MHZ);
    }
    run.encoder.config.tm = 15 * US;
    run.trigger();
    run.cycles((u64::from(WIDTH) + 4) * PERIOD);
    assert_eq!(run.get("cause"), u128::from(cause::RECOVERY_TOO_LONG));
    assert_eq!(run.fresh(), Some(POSITION), "that of this frame is good");
    assert!(run.ends());
    assert!(run.is_good());
}

//! Everything that the sweep holds still: jitter, distortion, cable, encoder times, filter, window.

use super::rig::*;
use endat_hdl::timing;
use endat_sim::{line::Jitter, Time, NS, US};
use proptest::prelude::*;

/// What a run is made of, as parts of what the rate allows.
#[derive(Clone, Debug)]
struct Story {
    rates: usize,
    f2: bool,
    position_bits: u32,
    cable_m: f64,
    ns_per_m: f64,
    transceivers: Time,
    clock_to_data: Time,
    tcal: Time,
    tcal_jitter: Time,
    jitter: f64,
    distortion: f64,
    filter: f64,
    window: f64,
    seed: u64,
}

fn stories() -> impl Strategy<Value = Story> {
    let line = (0.0..100.0, 4.5..7.0, 0..60 * NS, 0..200 * NS);
    let times = (0..12 * US, 0..3 * US);
    let parts = (0.0..1.0, -1.0..1.0, 0.0..1.0, 0.0..1.0);
    let kind = (0..RATES.len(), any::<bool>(), 1..=48u32, any::<u64>());
    (kind, line, times, parts).prop_map(|(kind, line, times, parts)| Story {
        rates: kind.0,
        f2: kind.1,
        position_bits: kind.2,
        seed: kind.3,
        cable_m: line.0,
        ns_per_m: line.1,
        transceivers: line.2,
        clock_to_data: line.3,
        tcal: times.0,
        tcal_jitter: times.1,
        jitter: parts.0,
        distortion: parts.1,
        filter: parts.2,
        window: parts.3,
    })
}

impl Story {
    fn setup(&self) -> Setup {
        let rates = RATES[self.rates];
        let command = COMMANDS[usize::from(self.f2)];
        let mut setup = Setup::new(rates, command, self.position_bits, self.cable_m);
        let cycle = 1_000_000 * US / rates.0;
        let period = setup.settings.period_cycles;
        let half = period / 2;
        // The frame that measures the delay has a period of its own.
        let shortest = period.min(timing::period_cycles(timing::CALIBRATION_HZ, rates.0));
        // A bit is sampled in the middle, to a cycle and a half: tracking, synchroniser, odd period. The rest of half a bit
        // is for distortion, jitter of two edges, and jitter of the period that the encoder compares with, as far as it takes
        // pulses: a tenth of a period.
        let room = (shortest / 2 * cycle - 3 * cycle / 2).min(shortest * cycle / 10);
        let jitter = (self.jitter * 0.2 * room as f64) as Time;
        let distortion = (self.distortion * 0.35 * room as f64) as i64;
        setup.line.ns_per_m = self.ns_per_m;
        for path in [
            &mut setup.line.clock,
            &mut setup.line.data_in,
            &mut setup.line.data_out,
        ] {
            path.transceivers = self.transceivers + distortion.unsigned_abs();
            path.jitter = Jitter::Uniform(jitter);
            path.fall_later = distortion;
        }
        setup.line.seed = self.seed;
        setup.encoder.seed = self.seed;
        setup.encoder.clock_to_data = self.clock_to_data;
        setup.encoder.tcal = self.tcal;
        setup.encoder.tcal_jitter = self.tcal_jitter;
        // A filter must let the shortest bit through.
        let longest = (half.saturating_sub(3)).min(15);
        setup.settings.filter_cycles = (self.filter * (longest + 1) as f64) as u64;
        // The window has room for the jitter of two edges, twice, and for two cycles.
        let least = 2 + (4 * jitter).div_ceil(cycle);
        let most = (half - 1).min(63);
        setup.settings.start_window_cycles =
            (least + (self.window * most.saturating_sub(least) as f64) as u64).min(most);
        setup
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, max_shrink_iters: 40, ..ProptestConfig::default() })]

    #[test]
    fn lines_and_encoders_within_their_limits_give_good_frames(story in stories()) {
        let setup = story.setup();
        let mut rig = setup.fresh();
        for _ in 0..4 {
            good_frame(&mut rig);
        }
        settle(&mut rig);
        assert_sound(&setup, &rig);
    }
}

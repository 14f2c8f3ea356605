//! The named campaigns.

use super::Case;
use crate::{
    bench::ChannelSettings,
    encoder::EncoderConfig,
    line::{Jitter, LineConfig},
    rng::Rng,
    Time, NS, US,
};
use endat_hdl::endat::{channel::Features, timing};
use endat_hdl::protocol::{ModeCommand, POSITION_BITS};

/// System clock and EnDat clock in hertz, for every width and cable.
pub const RATES: [(u64, u64); 10] = [
    (100_000_000, 100_000),
    (100_000_000, 200_000),
    (100_000_000, 1_000_000),
    (100_000_000, 2_000_000),
    (100_000_000, 3_125_000),
    (100_000_000, 4_000_000),
    (100_000_000, 6_250_000),
    (100_000_000, 8_333_333),
    (100_000_000, 12_500_000),
    (128_000_000, 16_000_000),
];
/// Cables for every width and rate, in metres.
pub const CABLES_M: [f64; 4] = [0.0, 1.0, 20.0, 100.0];
/// Quiet time after an aborted frame: longer than the encoder's time-out, short enough for simulation.
pub const ABORT_US: u64 = 50;

impl Case {
    /// A good encoder on a good cable, with suitable settings. The recovery time is short, if allowed.
    pub fn new(
        (system_hz, endat_hz): (u64, u64),
        command: ModeCommand,
        position_bits: u32,
        cable_m: f64,
    ) -> Self {
        let mut encoder =
            EncoderConfig::endat22(position_bits).seed(u64::from(position_bits) + endat_hz);
        encoder.tm = if command.has_f2() && endat_hz > 1_000_000 {
            1_250 * NS..=3_750 * NS
        } else {
            10 * US..=12 * US
        };
        let settings = ChannelSettings {
            abort_us: ABORT_US,
            ..ChannelSettings::new(system_hz, endat_hz, command, position_bits)
        };
        Self {
            title: format!(
                "{:06b}, {position_bits} bits, {:.3} MHz, {cable_m:.0} m",
                command.code(),
                endat_hz as f64 / 1e6
            ),
            system_hz,
            features: Features::CARD,
            settings,
            encoder,
            line: LineConfig::cable(cable_m),
            frames: 2,
        }
    }
}

/// Every width, command, rate and cable: 3840 cases.
pub fn sweep() -> Vec<Case> {
    let mut cases = vec![];
    for rates in RATES {
        for cable_m in CABLES_M {
            for command in ModeCommand::POSITION {
                cases.extend(POSITION_BITS.map(|bits| Case::new(rates, command, bits, cable_m)));
            }
        }
    }
    cases
}

/// Random cases within the limits of line, encoder and core.
pub fn random(count: usize, seed: u64) -> Vec<Case> {
    let mut rng = Rng::new(seed);
    (0..count).map(|_| Story::random(&mut rng).case()).collect()
}

/// A random case, with values relative to the range of its rate. Every story is within the limits of line, encoder
/// and core, and must give good frames.
#[derive(Clone, Copy, Debug)]
pub struct Story {
    /// Index in [`RATES`].
    pub rates: usize,
    /// EnDat 2.2, with F2.
    pub f2: bool,
    /// Width of the position.
    pub position_bits: u32,
    /// Cable in metres.
    pub cable_m: f64,
    /// Delay of the cable.
    pub ns_per_m: f64,
    /// Delay of driver and receiver.
    pub transceivers: Time,
    /// Clock edge to DATA edge at the encoder.
    pub clock_to_data: Time,
    /// Calculation time.
    pub tcal: Time,
    /// Largest random addition to it in a frame.
    pub tcal_jitter: Time,
    /// Jitter of every edge, 0 to 1.
    pub jitter: f64,
    /// Delay of falling edges against rising ones, -1 to 1.
    pub distortion: f64,
    /// Input filter, 0 to 1.
    pub filter: f64,
    /// Window of the start bit, 0 to 1.
    pub window: f64,
    /// Seed of encoder and line.
    pub seed: u64,
}

impl Story {
    fn random(rng: &mut Rng) -> Self {
        // A fraction between 0 and 1.
        let part = |rng: &mut Rng| (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        Self {
            rates: rng.in_range(0, RATES.len() as u64 - 1) as usize,
            f2: rng.in_range(0, 1) == 1,
            position_bits: rng.in_range(1, 48) as u32,
            cable_m: 100.0 * part(rng),
            ns_per_m: 4.5 + 2.5 * part(rng),
            transceivers: rng.in_range(0, 60 * NS),
            clock_to_data: rng.in_range(0, 200 * NS),
            tcal: rng.in_range(0, 12 * US),
            tcal_jitter: rng.in_range(0, 3 * US),
            jitter: part(rng),
            distortion: 2.0 * part(rng) - 1.0,
            filter: part(rng),
            window: part(rng),
            seed: rng.next_u64(),
        }
    }

    /// Makes the case.
    pub fn case(&self) -> Case {
        let rates = RATES[self.rates];
        let command = ModeCommand::POSITION[usize::from(self.f2)];
        let mut case = Case::new(rates, command, self.position_bits, self.cable_m);
        case.title += ", random line and encoder";
        case.frames = 5;
        let cycle = 1_000_000 * US / rates.0;
        let period = case.settings.period_cycles;
        let half = period / 2;
        // The frame that measures the delay has another period.
        let shortest = period.min(timing::period_cycles(timing::CALIBRATION_HZ, rates.0));
        // A bit is sampled in the middle, to a cycle and a half: tracking, synchroniser, odd period. The rest of half a bit
        // is for distortion, jitter of two edges, and period jitter. The encoder tolerates pulses within a tenth of a period,
        // of which an odd period uses half a cycle.
        let pulses = shortest * cycle / 10 - period % 2 * cycle / 2;
        let room = (shortest / 2 * cycle - 3 * cycle / 2).min(pulses);
        let jitter = (self.jitter * 0.2 * room as f64) as Time;
        let distortion = (self.distortion * 0.3 * room as f64) as i64;
        case.line.ns_per_m = self.ns_per_m;
        for path in [
            &mut case.line.clock,
            &mut case.line.data_in,
            &mut case.line.data_out,
        ] {
            path.transceivers = self.transceivers + distortion.unsigned_abs();
            path.jitter = Jitter::Uniform(jitter);
            path.fall_later = distortion;
        }
        case.line.seed = self.seed;
        case.encoder.seed = self.seed;
        case.encoder.clock_to_data = self.clock_to_data;
        case.encoder.tcal = self.tcal;
        case.encoder.tcal_jitter = self.tcal_jitter;
        // A filter must let the shortest bit through.
        let longest = half.saturating_sub(3).min(15);
        case.settings.filter_cycles = (self.filter * (longest + 1) as f64) as u64;
        // The window has room for the jitter of two edges, twice, and for two cycles.
        let least = 2 + (4 * jitter).div_ceil(cycle);
        let most = (half - 1).min(63);
        let span = most.saturating_sub(least) as f64;
        case.settings.start_window_cycles = (least + (self.window * span) as u64).min(most);
        case
    }
}

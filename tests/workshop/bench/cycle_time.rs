//! How long an encoder takes to be read: the channel in simulation, triggered as soon as it is idle, beside the protocol's limits.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (times). Published systems: Kim et al., "Implementation of EnDat Interface Master Using Configurable
//! Logic Block in MCU", Electronics 2024, 13, 1101; Liu et al., "Angle encoder data acquisition system based on FPGA", 2024;
//! TI motor-control SDK, `endat_diagnostic.c`; an FPGA receiver for EnDat 2.2, scholarmate.com/S/Nlp49a.

mod behind;

use super::fault;
use behind::Behind;
use endat_console::error::CommandError;
use endat_hdl::endat::timing::{
    cycles_at_least, READY_LOW_NS, RECOVERY_MIN_NS, TST_FROM_HZ, TST_USUAL_NS,
};
use endat_hdl::protocol::{
    ModeCommand::{self, SendPosition, SendPositionAddInfo},
    LEAD_PULSES,
};
use endat_sim::campaign::{Case, Traces};
use endat_sim::encoder::FrameLog;
use endat_sim::{Time, NS, US};
use rtl_design::engine::Compiled;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// What is the same in all rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct CycleTimeOptions {
    /// Width of the position; none = the usual ones.
    pub position_bits: Option<u32>,
    /// Cable.
    pub cable_m: u64,
    /// Calculation time of the encoder.
    pub tcal_ns: u64,
    /// Recovery time of the encoder, where the protocol allows it.
    pub tm_ns: u64,
}

/// EnDat clock and the system clock that divides to it.
type Rate = (u64, u64);

const MHZ: u64 = 1_000_000;
/// Rates up to the last one that 000111 is used at.
const RATES_2_1: [Rate; 4] = [
    (MHZ / 10, 128 * MHZ),
    (MHZ / 5, 128 * MHZ),
    (MHZ, 128 * MHZ),
    (2 * MHZ, 128 * MHZ),
];
/// Rates above, for 111000 only.
const RATES_2_2: [Rate; 6] = [
    (3_125_000, 100 * MHZ),
    (4 * MHZ, 128 * MHZ),
    (8 * MHZ, 128 * MHZ),
    (10 * MHZ, 100 * MHZ),
    (12_500_000, 100 * MHZ),
    (16 * MHZ, 128 * MHZ),
];
const USUAL_BITS: [u32; 2] = [25, 37];
/// Cycles that are measured; the frame before them measures the delay.
const CYCLES: usize = 4;
/// A cycle may be this much longer than the limit.
const OVER_MAX: Time = US;

/// A time that somebody has published.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Published {
    /// Who.
    pub who: &'static str,
    /// Their time.
    pub us: f64,
    /// It is that of the running clock; else the one from position to position.
    pub is_frame: bool,
}

impl Published {
    fn text(self) -> String {
        let what = if self.is_frame { "frame" } else { "cycle" };
        format!("{what} {} us, {}", self.us, self.who)
    }
}

/// What is measured in a row.
#[derive(Clone, Copy, Debug)]
struct Subject {
    command: ModeCommand,
    behind: Behind,
    position_bits: u32,
    rate: Rate,
    published: Option<Published>,
}

/// The systems that others have published, with our core in their place.
const PUBLISHED: [Subject; 4] = [
    Subject {
        command: SendPosition,
        behind: Behind::NOTHING,
        position_bits: 36,
        rate: (2 * MHZ, 100 * MHZ),
        published: Some(Published {
            who: "Kim et al.",
            us: 35.0,
            is_frame: true,
        }),
    },
    Subject {
        command: SendPositionAddInfo,
        behind: Behind::NOTHING,
        position_bits: 29,
        rate: (3_125_000, 100 * MHZ),
        published: Some(Published {
            who: "Liu et al.",
            us: 100.0,
            is_frame: false,
        }),
    },
    Subject {
        command: SendPositionAddInfo,
        behind: Behind::NOTHING,
        position_bits: 37,
        rate: (8 * MHZ, 128 * MHZ),
        published: Some(Published {
            who: "TI",
            us: 62.5,
            is_frame: false,
        }),
    },
    // Neither width nor clock is told.
    Subject {
        command: SendPositionAddInfo,
        behind: Behind::NOTHING,
        position_bits: 25,
        rate: (2 * MHZ, 128 * MHZ),
        published: Some(Published {
            who: "receiver with GUI",
            us: 40.0,
            is_frame: false,
        }),
    },
];

/// Pulses and times, in picoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Figures {
    pulses: u64,
    /// First falling to last rising clock edge.
    frame: Time,
    /// From one first falling edge to the next.
    cycle: Time,
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CycleTime {
    /// Mode command, six binary digits.
    pub command: String,
    /// Additional data behind the position.
    pub infos: u32,
    /// Width of the position.
    pub position_bits: u32,
    /// EnDat clock.
    pub clock_hz: u64,
    /// System clock.
    pub system_hz: u64,
    /// Recovery time of the encoder.
    pub tm_us: f64,
    /// Rising clock edges at the encoder in each frame.
    pub pulses: u64,
    /// `max(10, (tcal - t_low1) / T) + L + 1`, rounded up; with a supplement 35 instead of 1.
    pub pulses_limit: u64,
    /// First falling to last rising clock edge, at the encoder.
    pub frame_us: f64,
    /// `t_low1 + (P - 1) T`; with a supplement also the time for which the clock is parked.
    pub frame_limit_us: f64,
    /// The longest of the measured cycles.
    pub cycle_us: f64,
    /// Frame, recovery time, and tR or the delay of the line.
    pub cycle_limit_us: f64,
    /// Cycles per second.
    pub cycles_per_s: f64,
    /// A published system of the same kind.
    pub published: Option<Published>,
    /// What is wrong.
    pub failure: Option<String>,
}

/// The table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CycleTimes {
    /// What is the same in all rows.
    pub options: CycleTimeOptions,
    /// Delay of the line, there and back.
    pub round_trip_us: f64,
    /// The rows.
    pub rows: Vec<CycleTime>,
}

fn us(time: Time) -> f64 {
    time as f64 / US as f64
}

impl Subject {
    fn all(position_bits: Option<u32>) -> Vec<Self> {
        let widths = position_bits.map_or(USUAL_BITS.to_vec(), |bits| vec![bits]);
        let rates = |command: ModeCommand| match command.has_f2() {
            true => [&RATES_2_1[..], &RATES_2_2].concat(),
            false => RATES_2_1.to_vec(),
        };
        let mut all = vec![];
        for command in [SendPosition, SendPositionAddInfo] {
            for position_bits in &widths {
                all.extend(rates(command).into_iter().map(|rate| Self {
                    command,
                    behind: Behind::NOTHING,
                    position_bits: *position_bits,
                    rate,
                    published: None,
                }));
            }
        }
        all.extend(PUBLISHED);
        all.extend(Behind::subjects(widths[0]));
        all
    }

    /// The recovery time: below 10 us only with an EnDat 2.2 command above 1 MHz.
    fn tm_ns(&self, options: &CycleTimeOptions) -> u64 {
        match self.command.has_f2() && self.rate.0 > TST_FROM_HZ {
            true => options.tm_ns,
            false => options.tm_ns.max(RECOVERY_MIN_NS),
        }
    }

    fn case(&self, options: &CycleTimeOptions) -> Case {
        let (clock_hz, system_hz) = self.rate;
        let cable_m = options.cable_m as f64;
        let rates = (system_hz, clock_hz);
        let mut case = Case::new(rates, self.command, self.position_bits, cable_m);
        // tST goes with delay compensation (PWM 20): EnDat 2.2, and lines longer than half a period.
        let is_long = case.line.round_trip() * 2 * clock_hz > 1_000_000 * US;
        let has_tst = clock_hz >= TST_FROM_HZ && (self.command.has_f2() || is_long);
        let tst_ns = if has_tst { TST_USUAL_NS } else { 0 };
        case.settings = case.settings.start_time_ns(tst_ns, system_hz);
        case.settings.start_timeout_us += options.tcal_ns / 1_000;
        case.encoder.tcal = options.tcal_ns * NS;
        let tm = self.tm_ns(options) * NS;
        case.encoder.tm = tm..=tm;
        case.frames = CYCLES + 2;
        case
    }

    /// What the protocol needs at least, with these settings of the clock.
    fn limit(&self, case: &Case, options: &CycleTimeOptions) -> Figures {
        let (settings, hz) = (&case.settings, case.system_hz);
        let time = |cycles: u64| {
            (u128::from(cycles) * u128::from(1_000_000 * US)).div_ceil(hz.into()) as Time
        };
        let period = settings.period_cycles;
        let first_low = period / 2 + settings.first_low_extra_cycles;
        // The start bit comes with the first rising edge that is not before tcal.
        let wait = cycles_at_least(options.tcal_ns, hz).saturating_sub(first_low);
        let lead = wait.div_ceil(period).max(LEAD_PULSES.into());
        let answer = lead + self.behind.answer_bits(self.command, self.position_bits);
        let pulses = answer + self.behind.pulses();
        let frame = time(first_low + (pulses - 1) * period) + self.behind.pause(case);
        // DATA must have been LOW for tR at the encoder, and its fall must have come back before the next frame can begin.
        let low = (READY_LOW_NS * NS).max(case.line.round_trip());
        Figures {
            pulses,
            frame,
            cycle: frame + self.tm_ns(options) * NS + low,
        }
    }
}

/// The figures of frames that came back to back.
fn figures(frames: &[FrameLog]) -> Option<Figures> {
    let frame = |f: &FrameLog| f.last_rise - f.first_fall;
    let cycles = frames.windows(2).map(|w| w[1].first_fall - w[0].first_fall);
    Some(Figures {
        pulses: frames.iter().map(|f| f.rising_edges).max()?.into(),
        frame: frames.iter().map(frame).max()?,
        cycle: cycles.max()?,
    })
}

/// What is wrong with a row whose frames are good, if anything is.
fn verdict(measured: Figures, limit: Figures) -> Option<String> {
    let us = |time: Time| format!("{:.3} us", us(time));
    if measured.cycle > limit.cycle + OVER_MAX {
        let over = us(measured.cycle - limit.cycle);
        return Some(format!("{over} over the limit, at most {}", us(OVER_MAX)));
    }
    if measured.pulses != limit.pulses {
        let (seen, needed) = (measured.pulses, limit.pulses);
        return Some(format!("{seen} pulses instead of {needed}"));
    }
    // Edges are rounded to the picosecond.
    if measured.frame + NS < limit.frame || measured.cycle + NS < limit.cycle {
        return Some("shorter than the protocol allows".into());
    }
    None
}

fn measure(
    subject: &Subject,
    options: &CycleTimeOptions,
    engines: &mut BTreeMap<(u64, bool), Compiled>,
) -> Result<CycleTime, CommandError> {
    let case = subject.case(options);
    let key = (case.system_hz, subject.behind != Behind::NOTHING);
    let engine = match engines.get(&key) {
        Some(engine) => engine.clone(),
        None => {
            let design = subject.behind.design(&case).map_err(|e| fault(&e))?;
            let engine = Compiled::new(&design).map_err(|e| fault(&e))?;
            engines.insert(key, engine.clone());
            engine
        }
    };
    let bench = subject.behind.run(&case, engine);
    let traces = Traces::of(&bench);
    let first = subject.behind.first_frame();
    let frames = traces.frames.get(first..).unwrap_or_default();
    let limit = subject.limit(&case, options);
    let measured = figures(frames);
    let failure = match (subject.behind.check(&case, &traces), measured) {
        (Err(what), _) => Some(what),
        (Ok(()), Some(measured)) => verdict(measured, limit),
        (Ok(()), None) => Some("no frames".into()),
    };
    let measured = measured.unwrap_or(Figures {
        pulses: 0,
        frame: 0,
        cycle: 0,
    });
    Ok(CycleTime {
        command: format!("{:06b}", subject.command.code()),
        infos: subject.behind.infos,
        position_bits: subject.position_bits,
        clock_hz: subject.rate.0,
        system_hz: case.system_hz,
        tm_us: subject.tm_ns(options) as f64 / 1e3,
        pulses: measured.pulses,
        pulses_limit: limit.pulses,
        frame_us: us(measured.frame),
        frame_limit_us: us(limit.frame),
        cycle_us: us(measured.cycle),
        cycle_limit_us: us(limit.cycle),
        cycles_per_s: if measured.cycle > 0 {
            1e6 / us(measured.cycle)
        } else {
            0.0
        },
        published: subject.published,
        failure,
    })
}

/// Measures every row.
pub fn cycle_times(options: CycleTimeOptions) -> Result<CycleTimes, CommandError> {
    let subjects = Subject::all(options.position_bits);
    let line = subjects[0].case(&options).line;
    let mut engines = BTreeMap::new();
    let rows = subjects
        .iter()
        .map(|subject| measure(subject, &options, &mut engines))
        .collect::<Result<_, _>>()?;
    Ok(CycleTimes {
        options,
        round_trip_us: us(line.round_trip()),
        rows,
    })
}

impl CycleTime {
    /// Command and additional data.
    pub fn kind(&self) -> String {
        match self.infos {
            0 => self.command.clone(),
            infos => format!("{}+{infos}", self.command),
        }
    }
}

impl CycleTimes {
    /// Whether no row is marked.
    pub fn is_good(&self) -> bool {
        self.rows.iter().all(|row| row.failure.is_none())
    }
}

impl fmt::Display for CycleTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "frames back to back, {} m of cable ({:.2} us there and back), tcal {:.3} us; in brackets the protocol's limit",
            self.options.cable_m,
            self.round_trip_us,
            self.options.tcal_ns as f64 / 1e3,
        )?;
        writeln!(
            f,
            "command  bits    MHz       pulses              frame us    tm us            cycle us   over us  cycles/s  published"
        )?;
        for row in &self.rows {
            let published = row.published.map_or(String::new(), |p| p.text());
            let text = format!(
                "{:<8} {:>4} {:>6.3} {:>4} {:>7} {:>9.3} {:>11} {:>7.3} {:>9.3} {:>11} {:>8.3} {:>9.0}  {published}",
                row.kind(),
                row.position_bits,
                row.clock_hz as f64 / 1e6,
                row.pulses,
                format!("({})", row.pulses_limit),
                row.frame_us,
                format!("({:.3})", row.frame_limit_us),
                row.tm_us,
                row.cycle_us,
                format!("({:.3})", row.cycle_limit_us),
                row.cycle_us - row.cycle_limit_us,
                row.cycles_per_s,
            );
            writeln!(f, "{}", text.trim_end())?;
            if let Some(failure) = &row.failure {
                writeln!(f, "       ^ WRONG: {failure}")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;

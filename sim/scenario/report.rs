//! What happened in a scenario, frame by frame, and what was wrong with it.

use super::Scenario;
use crate::{
    bench::{Bench, ChannelResult},
    encoder::{FrameEnd, FrameLog, Violation},
    engine::Engine,
    line::Conflict,
    Time,
};
use endat_hdl::{timing, transaction::cause};
use std::fmt;

/// One frame, or a trigger that led to none.
#[derive(Clone, Debug)]
pub struct FrameReport {
    /// The trigger's time.
    pub trigger: Option<Time>,
    /// What the core delivered (block `Channel` only).
    pub result: Option<ChannelResult>,
    /// What the encoder saw.
    pub frame: Option<FrameLog>,
}

/// The samples that the core took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleSummary {
    /// How many.
    pub count: usize,
    /// How many where DATA was not driven by the encoder alone.
    pub undefined: usize,
    /// Smallest distance of an undisturbed one from a change of DATA.
    pub narrowest: Time,
}

/// One port.
#[derive(Clone, Debug)]
pub struct ChannelReport {
    /// Its number in the scenario.
    pub index: usize,
    /// Its frames in order of time.
    pub frames: Vec<FrameReport>,
    /// What the encoder complained about.
    pub violations: Vec<(Time, Violation)>,
    /// Moments when DATA was driven from both ends.
    pub conflicts: Vec<Conflict>,
    /// The samples, if the core shows them.
    pub samples: SampleSummary,
}

/// What happened.
#[derive(Clone, Debug)]
pub struct Report {
    scenario: Scenario,
    /// The ports that were run.
    pub channels: Vec<ChannelReport>,
    has_results: bool,
}

impl Report {
    pub(super) fn new<E: Engine>(scenario: &Scenario, bench: &Bench<E>, ports: &[usize]) -> Self {
        let has_results = !bench.results().is_empty();
        let channels = ports.iter().enumerate().map(|(link, index)| {
            let frames = if has_results {
                by_result(scenario, bench.results(), bench.frames(link))
            } else {
                by_frame(scenario, bench.frames(link))
            };
            ChannelReport {
                index: *index,
                frames,
                violations: bench.violations(link).to_vec(),
                conflicts: bench.conflicts(link),
                samples: summarise(bench.samples(link)),
            }
        });
        Self {
            scenario: scenario.clone(),
            channels: channels.collect(),
            has_results,
        }
    }

    /// Everything that a sound core would not have done; empty if all is well.
    pub fn complaints(&self) -> Vec<String> {
        let mut out = Vec::new();
        for c in &self.channels {
            let mut say = |text: String| out.push(format!("channel {}: {text}", c.index));
            if self.has_results {
                self.compare_causes(c, &mut say);
            }
            for (n, f) in c.frames.iter().enumerate() {
                complain_about_frame(n, f, &mut say);
            }
            for (time, v) in &c.violations {
                if !(self.scenario.may_stop && is_stop(v)) {
                    say(format!("at {:.3} us: {v}", us(*time)));
                }
            }
            for conflict in &c.conflicts {
                say(format!("at {:.3} us: {conflict}", us(conflict.from)));
            }
            if c.samples.undefined > 0 {
                say(format!(
                    "{} of {} samples taken while DATA was undefined",
                    c.samples.undefined, c.samples.count
                ));
            }
        }
        out
    }

    fn compare_causes(&self, c: &ChannelReport, say: &mut impl FnMut(String)) {
        let results = c.frames.iter().filter_map(|f| f.result.as_ref());
        let got: Vec<u64> = results.map(ChannelResult::last_cause).collect();
        if got != self.scenario.causes {
            let names = |codes: &[u64]| {
                let names: Vec<&str> = codes.iter().map(|c| cause::name(*c)).collect();
                names.join(", ")
            };
            say(format!(
                "causes [{}], expected [{}]",
                names(&got),
                names(self.scenario.causes)
            ));
        }
    }
}

fn is_stop(v: &Violation) -> bool {
    matches!(
        v,
        Violation::StoppedBeforeAnswer { .. } | Violation::TooFewPulses { .. }
    )
}

fn complain_about_frame(number: usize, f: &FrameReport, say: &mut impl FnMut(String)) {
    let (Some(frame), result) = (&f.frame, &f.result) else {
        return;
    };
    if let Some(expected) = frame.expected_rising_edges() {
        if frame.end == FrameEnd::Complete && frame.rising_edges != expected {
            say(format!(
                "frame {number}: {} rising edges, expected {expected}",
                frame.rising_edges
            ));
        }
    }
    if let Some(r) = result.as_ref().filter(|r| r.fresh) {
        if r.position != frame.position {
            say(format!(
                "frame {number}: position {:#X}, the encoder sent {:#X}",
                r.position, frame.position
            ));
        }
    }
}

/// Each result with the last frame that began since the result before.
fn by_result(
    scenario: &Scenario,
    results: &[ChannelResult],
    frames: &[FrameLog],
) -> Vec<FrameReport> {
    let mut since = 0;
    results
        .iter()
        .map(|r| {
            let mine = frames
                .iter()
                .rfind(|f| f.first_fall <= r.time && f.first_fall > since);
            since = r.time;
            let begin = mine.map_or(r.time, |f| f.first_fall);
            FrameReport {
                trigger: scenario.trigger_times().filter(|t| *t <= begin).last(),
                result: Some(r.clone()),
                frame: mine.cloned(),
            }
        })
        .collect()
}

fn by_frame(scenario: &Scenario, frames: &[FrameLog]) -> Vec<FrameReport> {
    let report = |f: &FrameLog| FrameReport {
        trigger: scenario
            .trigger_times()
            .filter(|t| *t <= f.first_fall)
            .last(),
        result: None,
        frame: Some(f.clone()),
    };
    frames.iter().map(report).collect()
}

fn summarise(samples: &[crate::line::Sample]) -> SampleSummary {
    let margin = |s: &crate::line::Sample| s.since.min(s.until.unwrap_or(Time::MAX));
    let defined = samples.iter().filter(|s| s.is_defined(0));
    SampleSummary {
        count: samples.len(),
        undefined: samples.iter().filter(|s| !s.is_encoders()).count(),
        narrowest: defined.map(margin).min().unwrap_or(0),
    }
}

fn us(time: Time) -> f64 {
    time as f64 / 1e6
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.scenario;
        writeln!(f, "{}: {}", s.name, s.summary)?;
        for c in &self.channels {
            let (settings, line) = (&s.channels[c.index].settings, &s.channels[c.index].line);
            let actual = s.system_hz as f64 / settings.period_cycles as f64;
            writeln!(f)?;
            writeln!(
                f,
                "channel {}: command {:06b}, {} position bits, {:.3} MHz from {} MHz ({} cycles, {:+.0} ppm), {} m of cable",
                c.index,
                settings.command,
                settings.position_bits,
                actual / 1e6,
                s.system_hz as f64 / 1e6,
                settings.period_cycles,
                timing::deviation_ppm(actual, s.endat_hz as f64),
                line.cable_m,
            )?;
            let widest = c.frames.iter().map(|r| result(r).len()).max();
            let width = widest.unwrap_or(0).max(RESULT_MIN);
            writeln!(
                f,
                "  {:>11}  {:<width$} {:>14} {:>14}  {:>7}  {:>5} {:>8} {:>8} {:>8}",
                "trigger us",
                "result",
                "position",
                "encoder's",
                "pulses",
                "start",
                "S at us",
                "frame us",
                "tm us"
            )?;
            c.frames.iter().try_for_each(|r| row(f, r, width))?;
            if c.samples.count > 0 {
                writeln!(
                    f,
                    "  {} samples, narrowest margin {:.1} ns",
                    c.samples.count,
                    c.samples.narrowest as f64 / 1e3
                )?;
            }
        }
        writeln!(f)?;
        match self.complaints().as_slice() {
            [] => writeln!(f, "all as it should be"),
            all => all.iter().try_for_each(|c| writeln!(f, "WRONG: {c}")),
        }
    }
}

/// Narrowest column of results.
const RESULT_MIN: usize = 27;

/// The verdict of the core in words.
fn result(r: &FrameReport) -> String {
    let words = |r: &ChannelResult| match (r.last_cause(), r.fresh, r.position_valid) {
        (0, true, _) => "good".into(),
        (_, true, _) => format!("good, {}", r.cause_name()),
        (_, false, true) => format!("held: {}", r.cause_name()),
        (_, false, false) => format!("none: {}", r.cause_name()),
    };
    r.result.as_ref().map_or_else(|| "-".into(), words)
}

fn row(f: &mut fmt::Formatter<'_>, r: &FrameReport, width: usize) -> fmt::Result {
    let dash = || "-".to_owned();
    let position = r
        .result
        .as_ref()
        .filter(|r| r.position_valid)
        .map_or_else(dash, |r| format!("{:#X}", r.position));
    let frame = r.frame.as_ref();
    let text = |value: Option<String>| value.unwrap_or_else(dash);
    let answered = frame.filter(|l| l.start_edge.is_some());
    writeln!(
        f,
        "  {:>11}  {:<width$} {:>14} {:>14}  {:>7}  {:>5} {:>8} {:>8} {:>8}",
        text(r.trigger.map(|t| format!("{:.3}", us(t)))),
        result(r),
        position,
        text(frame.map(|l| format!("{:#X}", l.position))),
        text(frame.map(|l| match l.expected_rising_edges() {
            Some(n) => format!("{}/{n}", l.rising_edges),
            None => format!("{}/-", l.rising_edges),
        })),
        text(
            answered
                .and_then(|l| l.start_edge)
                .map(|s| format!("R#{s}"))
        ),
        text(answered.map(|l| format!("{:.3}", us(l.start_time - l.first_fall)))),
        text(frame.map(|l| format!("{:.3}", us(l.last_rise - l.first_fall)))),
        text(frame.and_then(|l| l.data_fall.map(|t| format!("{:.3}", us(t - l.last_rise))))),
    )
}

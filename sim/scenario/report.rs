//! Report of a scenario, frame by frame, with the faults.

use super::{Request, Scenario};
use crate::{
    bench::{Bench, ChannelResult},
    encoder::{AnswerKind, FrameEnd, FrameLog, Violation},
    line::Conflict,
    Time,
};
use endat_hdl::endat::{timing, transaction::cause};
use rtl_design::engine::Engine;
use std::fmt;

/// Answer to a separate request frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Time.
    pub time: Time,
    /// The six bits of the request.
    pub command: u8,
    /// Cause code of its frame, 0 = none.
    pub cause: u64,
    /// The answer: 8 and 16 bits, or a position or test values.
    pub word: u64,
    /// The CRC is right.
    pub crc_good: bool,
}

impl Answer {
    pub(super) fn of<E: Engine>(request: &Request, bench: &mut Bench<E>) -> Self {
        Self {
            time: bench.now(),
            command: request.command.code(),
            cause: bench.get("over_cause") as u64,
            word: bench.get("reply") as u64,
            crc_good: bench.get("reply_good") == 1,
        }
    }
}

/// One frame, or a trigger without one.
#[derive(Clone, Debug)]
pub struct FrameReport {
    /// The trigger's time.
    pub trigger: Option<Time>,
    /// Result of the core (block `Channel` only).
    pub result: Option<ChannelResult>,
    /// Answer of the core to a separate request frame.
    pub answer: Option<Answer>,
    /// Frame, as seen by the encoder.
    pub frame: Option<FrameLog>,
}

/// The samples of the core.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleSummary {
    /// Number of samples.
    pub count: usize,
    /// Number of samples while DATA was not driven by the encoder alone.
    pub undefined: usize,
    /// Smallest distance of an undisturbed sample from a change of DATA.
    pub narrowest: Time,
}

/// One port.
#[derive(Clone, Debug)]
pub struct ChannelReport {
    /// Number in the scenario.
    pub index: usize,
    /// Frames in order of time.
    pub frames: Vec<FrameReport>,
    /// Violations noted by the encoder.
    pub violations: Vec<(Time, Violation)>,
    /// Times when both ends drove DATA.
    pub conflicts: Vec<Conflict>,
    /// The samples, if the core has the outputs for them.
    pub samples: SampleSummary,
}

/// Report of a run.
#[derive(Clone, Debug)]
pub struct Report {
    scenario: Scenario,
    /// Reports of the ports.
    pub channels: Vec<ChannelReport>,
    has_results: bool,
}

impl Report {
    pub(super) fn new<E: Engine>(
        scenario: &Scenario,
        bench: &Bench<E>,
        ports: &[usize],
        answers: &[Answer],
    ) -> Self {
        let has_results = !bench.results().is_empty();
        let channels = ports.iter().enumerate().map(|(link, index)| {
            let frames = if has_results {
                by_result(scenario, bench.results(), answers, bench.frames(link))
            } else {
                bench
                    .frames(link)
                    .iter()
                    .map(|f| by_frame(scenario, &[], f))
                    .collect()
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

    /// All faults; empty for a good run.
    pub fn complaints(&self) -> Vec<String> {
        let mut out = Vec::new();
        for c in &self.channels {
            let mut say = |text: String| out.push(format!("channel {}: {text}", c.index));
            if self.has_results {
                self.compare_causes(c, &mut say);
                self.count_answers(c, &mut say);
            }
            for (n, f) in c.frames.iter().enumerate() {
                complain_about_frame(n, f, &mut say);
            }
            for (time, v) in &c.violations {
                if !(self.scenario.may_stop && is_stop(v, c)) {
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

    fn count_answers(&self, c: &ChannelReport, say: &mut impl FnMut(String)) {
        let requests = self.scenario.requests.iter();
        let wanted = requests.filter(|r| !r.command.has_f2()).count();
        let got = c.frames.iter().filter(|f| f.answer.is_some()).count();
        if got != wanted {
            say(format!("{got} requests have ended, expected {wanted}"));
        }
    }
}

/// The encoder's answer to a separate request frame.
fn answered(frame: &FrameLog) -> Option<u64> {
    match frame.kind {
        AnswerKind::Parameter => frame.reply.map(|r| r.word().into()),
        AnswerKind::TestValues => None,
        _ => Some(frame.position),
    }
}

/// True for a frame that stops; this may shorten its last LOW.
fn is_stop(v: &Violation, c: &ChannelReport) -> bool {
    let is_last = |edge: u32| {
        let mut frames = c.frames.iter().filter_map(|f| f.frame.as_ref());
        frames.any(|f| f.end == FrameEnd::Stopped && f.rising_edges == edge)
    };
    match v {
        Violation::StoppedBeforeAnswer { .. } | Violation::TooFewPulses { .. } => true,
        Violation::PulseWidth {
            high: false, edge, ..
        } => is_last(*edge),
        _ => false,
    }
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
    if let Some(a) = &f.answer {
        if a.cause != cause::NONE || !a.crc_good || Some(a.word) != answered(frame) {
            say(format!(
                "frame {number}: {}, {:#X}, the encoder sent {:#X?}",
                answer_words(a),
                a.word,
                answered(frame)
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

/// Each result with the last frame that began since the previous result. Frames without a result, for requests and for the
/// initialisation, are in their places.
fn by_result(
    scenario: &Scenario,
    results: &[ChannelResult],
    answers: &[Answer],
    frames: &[FrameLog],
) -> Vec<FrameReport> {
    let mut rest = frames.iter().peekable();
    let mut rows: Vec<FrameReport> = Vec::new();
    for r in results {
        let before = rows.len();
        while let Some(frame) = rest.next_if(|f| f.first_fall <= r.time) {
            rows.push(by_frame(scenario, answers, frame));
        }
        // A trigger may have led to no frame.
        let is_triggered = |f: &FrameReport| f.answer.is_none() && f.trigger.is_some();
        match rows[before..].last_mut().filter(|f| is_triggered(f)) {
            Some(mine) => mine.result = Some(r.clone()),
            None => rows.push(FrameReport {
                trigger: last_trigger(scenario, r.time),
                result: Some(r.clone()),
                answer: None,
                frame: None,
            }),
        }
    }
    rows.extend(rest.map(|f| by_frame(scenario, answers, f)));
    rows
}

fn by_frame(scenario: &Scenario, answers: &[Answer], f: &FrameLog) -> FrameReport {
    let is_mine = |a: &&Answer| a.time > f.first_fall && Some(a.command) == f.command;
    FrameReport {
        trigger: last_trigger(scenario, f.first_fall),
        result: None,
        answer: answers.iter().find(is_mine).cloned(),
        frame: Some(f.clone()),
    }
}

fn last_trigger(scenario: &Scenario, time: Time) -> Option<Time> {
    scenario.trigger_times().filter(|t| *t <= time).last()
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
                "  {:>11}  {:<7}  {:<width$} {:>14} {:>14}  {:>7}  {:>5} {:>8} {:>8} {:>8}",
                "trigger us",
                "command",
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

/// The verdict of the core as text.
fn result(r: &FrameReport) -> String {
    let words = |r: &ChannelResult| match (r.last_cause(), r.fresh, r.position_valid) {
        (0, true, _) => "good".into(),
        (_, true, _) => format!("good, {}", r.cause_name()),
        (_, false, true) => format!("held: {}", r.cause_name()),
        (_, false, false) => format!("none: {}", r.cause_name()),
    };
    match (&r.result, &r.answer) {
        (Some(result), _) => words(result),
        (None, Some(answer)) => answer_words(answer).into(),
        (None, None) => "-".into(),
    }
}

fn answer_words(a: &Answer) -> &'static str {
    match (a.cause, a.crc_good) {
        (cause::NONE, true) => "answered",
        (cause::NONE, false) => "answered, wrong CRC",
        (code, _) => cause::name(code),
    }
}

fn row(f: &mut fmt::Formatter<'_>, r: &FrameReport, width: usize) -> fmt::Result {
    let dash = || "-".to_owned();
    let position = r.result.as_ref().filter(|r| r.position_valid);
    let position = position.map(|r| r.position);
    let word = position.or(r.answer.as_ref().map(|a| a.word));
    let frame = r.frame.as_ref();
    let text = |value: Option<String>| value.unwrap_or_else(dash);
    let number = |value: Option<u64>| text(value.map(|n| format!("{n:#X}")));
    let replied = frame.filter(|l| l.start_edge.is_some());
    writeln!(
        f,
        "  {:>11}  {:<7}  {:<width$} {:>14} {:>14}  {:>7}  {:>5} {:>8} {:>8} {:>8}",
        text(r.trigger.map(|t| format!("{:.3}", us(t)))),
        text(frame.and_then(|l| l.command).map(|c| format!("{c:06b}"))),
        result(r),
        number(word),
        number(frame.and_then(answered)),
        text(frame.map(|l| match l.expected_rising_edges() {
            Some(n) => format!("{}/{n}", l.rising_edges),
            None => format!("{}/-", l.rising_edges),
        })),
        text(replied.and_then(|l| l.start_edge).map(|s| format!("R#{s}"))),
        text(replied.map(|l| format!("{:.3}", us(l.start_time - l.first_fall)))),
        text(frame.map(|l| format!("{:.3}", us(l.last_rise - l.first_fall)))),
        text(frame.and_then(|l| l.data_fall.map(|t| format!("{:.3}", us(t - l.last_rise))))),
    )
}

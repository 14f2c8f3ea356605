//! Named scenarios: a configuration, encoders, lines and triggers, and the expected causes. Tests and the program share them.

mod list;
mod report;
pub mod t_format;
#[cfg(test)]
mod tests;

pub use list::{all, named};
pub use report::{Answer, ChannelReport, FrameReport, Report, SampleSummary};

use crate::{
    bench::{Bench, ChannelSettings, Link, PinNames},
    encoder::EncoderConfig,
    line::LineConfig,
    Time, MS, US,
};
use endat_hdl::endat::channel::Features;
use endat_hdl::protocol::ModeCommand;
use rtl_design::engine::Engine;

/// One EnDat port of a scenario.
#[derive(Clone, Debug)]
pub struct ChannelScenario {
    /// Configuration of the channel. Some scenarios need its short `abort_us`, which is fixed in the design.
    pub settings: ChannelSettings,
    /// The encoder.
    pub encoder: EncoderConfig,
    /// The line to the encoder.
    pub line: LineConfig,
}

/// A named scenario.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Name on the command line.
    pub name: &'static str,
    /// One-sentence summary.
    pub summary: &'static str,
    /// System clock in hertz.
    pub system_hz: u64,
    /// Requested EnDat clock in hertz.
    pub endat_hz: u64,
    /// The ports.
    pub channels: Vec<ChannelScenario>,
    /// Time between triggers.
    pub trigger_period: Time,
    /// Number of triggers after the first one, which starts the frame that measures the delay.
    pub triggers: u64,
    /// Requests, in order of the triggers.
    pub requests: &'static [Request],
    /// Duration of the initialisation of the encoder; 0 = none.
    pub initialisation: Time,
    /// Expected cause codes of all results, in order.
    pub causes: &'static [u64],
    /// The scenario makes a frame stop, so this is not a violation by the receiver.
    pub may_stop: bool,
}

/// A request. EnDat 2.2 commands are attached to the frame of their trigger; other commands have a separate frame instead of that
/// trigger's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Number of the trigger, 0 = first.
    pub trigger: usize,
    /// Mode command.
    pub command: ModeCommand,
    /// MRS code, address or port.
    pub address: u8,
    /// Data.
    pub data: u16,
}

/// Time of the first trigger.
const FIRST_TRIGGER: Time = 20 * US;
/// Longest frame of a request, including time-out and pause.
const REQUEST_LIMIT: Time = 100 * MS;
/// Time from the first trigger to the others: more than the frame that measures the delay.
const WARM_UP: Time = 600 * US;

/// Options of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOptions {
    /// Record everything for waveforms and drawings.
    pub record: bool,
    /// Latency from the pin to the sampling register, in system clock cycles.
    pub sample_latency_cycles: u64,
}

/// Ports of the block `Channel` that a waveform shows.
pub(crate) const WATCHED: [&str; 9] = [
    "trigger",
    "trigger_i",
    "busy",
    "sample_strobe",
    "result_strobe",
    "fresh",
    "cause",
    "delay_cycles",
    "position",
];

impl Scenario {
    /// Runs one port of the scenario on a block `Channel`.
    pub fn run_channel<E: Engine>(
        &self,
        index: usize,
        engine: E,
        options: RunOptions,
    ) -> (Bench<E>, Report) {
        let mut bench = Bench::new(
            engine,
            self.system_hz,
            vec![(PinNames::channel(), self.link(index))],
        );
        bench.configure(&self.channels[index].settings);
        let answers = self.run(&mut bench, options);
        let report = Report::new(self, &bench, &[index], &answers);
        (bench, report)
    }

    /// Runs the whole scenario on a configured card.
    pub fn run_card<E: Engine>(&self, engine: E, options: RunOptions) -> (Bench<E>, Report) {
        let all: Vec<usize> = (0..self.channels.len()).collect();
        let links = all.iter().map(|i| (PinNames::card(*i), self.link(*i)));
        let links = links.collect();
        let mut bench = Bench::new(engine, self.system_hz, links);
        let answers = self.run(&mut bench, options);
        let report = Report::new(self, &bench, &all, &answers);
        (bench, report)
    }

    /// Required features of the channel.
    pub fn features(&self) -> Features {
        Features {
            requests: !self.requests.is_empty(),
            ..Features::CARD
        }
    }

    /// The line and encoder of a port.
    pub fn link(&self, index: usize) -> Link {
        let channel = &self.channels[index];
        Link::new(channel.line.clone(), channel.encoder.clone())
    }

    /// Times of the triggers.
    pub fn trigger_times(&self) -> impl Iterator<Item = Time> + '_ {
        let first = self.initialisation + FIRST_TRIGGER;
        let later = (0..self.triggers).map(move |i| first + WARM_UP + i * self.trigger_period);
        std::iter::once(first).chain(later)
    }

    /// Runs the triggers and requests; returns the answers to separate request frames.
    fn run<E: Engine>(&self, bench: &mut Bench<E>, options: RunOptions) -> Vec<Answer> {
        bench.set_sample_latency(options.sample_latency_cycles);
        if options.record {
            bench.record_links();
            for name in WATCHED {
                if bench.has_port(name) {
                    bench.watch(name);
                }
            }
        }
        bench.power_up();
        let mut answers = Vec::new();
        for (number, time) in self.trigger_times().enumerate() {
            match self.requests.iter().find(|r| r.trigger == number) {
                Some(request) if !request.command.has_f2() => {
                    bench.run_until(time);
                    request.put(bench, "request_own");
                    let is_over = |b: &mut Bench<E>| b.get("over") & b.get("over_request") == 1;
                    if bench.run_until_done(REQUEST_LIMIT, is_over) {
                        answers.push(Answer::of(request, bench));
                    }
                    continue;
                }
                Some(request) => {
                    bench.run_until(time - US);
                    request.put(bench, "request_ride");
                }
                None => {}
            }
            bench.run_until(time);
            bench.trigger();
        }
        bench.run_for(SETTLE);
        if bench.has_port("busy") {
            bench.run_until_done(MS, |b| b.get("busy") == 0);
        }
        answers
    }
}

impl Request {
    fn put<E: Engine>(&self, bench: &mut Bench<E>, strobe: &str) {
        let word = u128::from(self.address) << 16 | u128::from(self.data);
        bench.set("request_command", self.command.code().into());
        bench.set("request_parameter", word);
        bench.set(strobe, 1);
        bench.run_cycles(1);
        bench.set(strobe, 0);
    }
}

/// After the last trigger: more than any frame at the full clock with its recovery time.
const SETTLE: Time = 100 * US;

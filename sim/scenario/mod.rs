//! Named stories: a configuration, encoders, lines and triggers, and what a sound core makes of them. Tests and the program share them.

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
    /// Configuration of the channel. Some stories need its short `abort_us`, which the core fixes when it is made.
    pub settings: ChannelSettings,
    /// The encoder.
    pub encoder: EncoderConfig,
    /// The line to it.
    pub line: LineConfig,
}

/// A named story.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// What it is called on the command line.
    pub name: &'static str,
    /// What it shows, in a sentence.
    pub summary: &'static str,
    /// System clock in hertz.
    pub system_hz: u64,
    /// EnDat clock in hertz, as asked for.
    pub endat_hz: u64,
    /// The ports.
    pub channels: Vec<ChannelScenario>,
    /// Time between triggers.
    pub trigger_period: Time,
    /// Number of triggers after the first one, which starts the frame that measures the delay.
    pub triggers: u64,
    /// Requests, in order of the triggers.
    pub requests: &'static [Request],
    /// The port initialises its encoder, which takes this long; 0 = it does not.
    pub initialisation: Time,
    /// Cause code of every result that a sound core delivers, in order.
    pub causes: &'static [u64],
    /// The receiver is not to blame if an encoder sees a frame that stops: the story makes it stop.
    pub may_stop: bool,
}

/// A request: with an EnDat 2.2 command it rides on the frame of its trigger, with any other it has a frame of its own in that
/// trigger's place.
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

/// When the first trigger comes.
const FIRST_TRIGGER: Time = 20 * US;
/// Longest frame of a request: time-out and pause included.
const REQUEST_LIMIT: Time = 100 * MS;
/// From the first trigger to the others: the frame that measures the delay takes less.
const WARM_UP: Time = 600 * US;

/// How a scenario is run.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOptions {
    /// Keep everything for waveforms and drawings.
    pub record: bool,
    /// From the pin to the register that takes the sample, in system clock cycles.
    pub sample_latency_cycles: u64,
}

/// Ports of the block `Channel` that are worth a place in a waveform.
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

    /// Runs the whole scenario on a card, which has its configuration already.
    pub fn run_card<E: Engine>(&self, engine: E, options: RunOptions) -> (Bench<E>, Report) {
        let all: Vec<usize> = (0..self.channels.len()).collect();
        let links = all.iter().map(|i| (PinNames::card(*i), self.link(*i)));
        let links = links.collect();
        let mut bench = Bench::new(engine, self.system_hz, links);
        let answers = self.run(&mut bench, options);
        let report = Report::new(self, &bench, &all, &answers);
        (bench, report)
    }

    /// What the channel must be able to do.
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

    /// When the triggers come.
    pub fn trigger_times(&self) -> impl Iterator<Item = Time> + '_ {
        let first = self.initialisation + FIRST_TRIGGER;
        let later = (0..self.triggers).map(move |i| first + WARM_UP + i * self.trigger_period);
        std::iter::once(first).chain(later)
    }

    /// What came back to the requests that had a frame of their own.
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

/// After the last trigger: longer than any frame at the full clock with its recovery time.
const SETTLE: Time = 100 * US;

//! Named stories: a configuration, encoders, lines and triggers, and what a sound core makes of them. Tests and the program share them.

mod list;
mod report;
#[cfg(test)]
mod tests;

pub use list::{all, named};
pub use report::{ChannelReport, FrameReport, Report, SampleSummary};

use crate::{
    bench::{Bench, ChannelSettings, Link, PinNames},
    encoder::EncoderConfig,
    engine::Engine,
    line::LineConfig,
    Time, MS, US,
};
use endat_hdl::{channel::Features, protocol::ModeCommand};

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
    /// Requests that ride on triggered frames, in order of the triggers.
    pub requests: &'static [Ride],
    /// Cause code of every result that a sound core delivers, in order.
    pub causes: &'static [u64],
    /// The receiver is not to blame if an encoder sees a frame that stops: the story makes it stop.
    pub may_stop: bool,
}

/// A request that rides on a triggered frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ride {
    /// Number of the trigger, 0 = first.
    pub trigger: usize,
    /// Mode command with a supplement.
    pub command: ModeCommand,
    /// MRS code, address or port.
    pub address: u8,
    /// Data.
    pub data: u16,
}

/// When the first trigger comes.
const FIRST_TRIGGER: Time = 20 * US;
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
        self.run(&mut bench, options);
        let report = Report::new(self, &bench, &[index]);
        (bench, report)
    }

    /// Runs the whole scenario on a card, which has its configuration already.
    pub fn run_card<E: Engine>(&self, engine: E, options: RunOptions) -> (Bench<E>, Report) {
        let all: Vec<usize> = (0..self.channels.len()).collect();
        let links = all.iter().map(|i| (PinNames::card(*i), self.link(*i)));
        let links = links.collect();
        let mut bench = Bench::new(engine, self.system_hz, links);
        self.run(&mut bench, options);
        let report = Report::new(self, &bench, &all);
        (bench, report)
    }

    /// What the channel must be able to do.
    pub fn features(&self) -> Features {
        Features {
            requests: !self.requests.is_empty(),
            ..Features::default()
        }
    }

    /// The line and encoder of a port.
    pub fn link(&self, index: usize) -> Link {
        let channel = &self.channels[index];
        Link::new(channel.line.clone(), channel.encoder.clone())
    }

    /// When the triggers come.
    pub fn trigger_times(&self) -> impl Iterator<Item = Time> + '_ {
        let later = (0..self.triggers).map(|i| FIRST_TRIGGER + WARM_UP + i * self.trigger_period);
        std::iter::once(FIRST_TRIGGER).chain(later)
    }

    fn run<E: Engine>(&self, bench: &mut Bench<E>, options: RunOptions) {
        bench.set_sample_latency(options.sample_latency_cycles);
        if options.record {
            bench.record_links();
            for name in WATCHED {
                if bench.has_port(name) {
                    bench.watch(name);
                }
            }
        }
        bench.reset();
        for (number, time) in self.trigger_times().enumerate() {
            for ride in self.requests.iter().filter(|r| r.trigger == number) {
                bench.run_until(time - US);
                bench.set("request_command", ride.command.code().into());
                let word = u128::from(ride.address) << 16 | u128::from(ride.data);
                bench.set("request_parameter", word);
                bench.set("request_ride", 1);
                bench.run_cycles(1);
                bench.set("request_ride", 0);
            }
            bench.run_until(time);
            bench.trigger();
        }
        bench.run_for(SETTLE);
        if bench.has_port("busy") {
            bench.run_until_done(MS, |b| b.get("busy") == 0);
        }
    }
}

/// After the last trigger: longer than any frame at the full clock with its recovery time.
const SETTLE: Time = 100 * US;

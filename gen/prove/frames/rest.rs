//! The state of a channel at rest, found by running it with the encoder model: registers that are the same before every frame, and
//! those that are not. Nothing leans on how it was found: the proof starts from it and has to come back to it.

use super::{Case, Settings};
use crate::error::GenError;
use crate::verilog::emitted_name;
use endat_hdl::elaborate::Design;
use endat_hdl::transaction::cause::TRIGGER_OVERRUN;
use endat_sim::bench::{Bench, Link, PinNames};
use endat_sim::encoder::EncoderConfig;
use endat_sim::engine::{Compiled, Keep};
use endat_sim::line::{LineConfig, PathConfig};
use endat_sim::{Time, MS};

/// Frames that are run; the states before each but the first, which measures the delay, are compared.
const FRAMES: usize = 32;
/// Cycles between rest and a trigger.
const PAUSES: [u64; 7] = [0, 1, 61, 2, 3, 0, 97];
/// From a trigger to one that is lost.
const LOST_AFTER_CYCLES: u64 = 20;
/// Registers that hold data, though these runs show one value only. The proof would find out by itself, one at a time.
const DATA: [&str; 4] = ["parallel_equal", "echo", "age_full", "lost_now"];
/// Longest wait for a frame.
const SPAN: Time = 40 * MS;

/// A register, by its name in the flattened Verilog.
#[derive(Clone, Debug)]
pub(super) struct Register {
    pub name: String,
    pub width_bits: usize,
    /// What it holds at rest; none: anything.
    pub value: Option<u128>,
}

/// Registers at rest, and how long a frame is from one rest to the next.
pub(super) struct Rest {
    pub registers: Vec<Register>,
    pub frame_cycles: u64,
}

/// Runs a channel; `channel` is a design whose top it is.
pub(super) fn find(channel: &Design, case: &Case, settings: &Settings) -> Result<Rest, GenError> {
    let engine = Compiled::keeping(channel, Keep::Registers)
        .map_err(|e| GenError::input(format!("{}: {e}", channel.top().name)))?;
    let cycle = |count: f64| (count * 1e12 / case.system_hz as f64) as Time;
    // Twice the way is between the edges where the encoder of the proof is.
    let path = PathConfig {
        transceivers: cycle(f64::from(case.times.delay_cycles) + 0.75),
        ..PathConfig::default()
    };
    let mut encoder = EncoderConfig::endat22(case.position_bits);
    encoder.clock_to_data = 0;
    encoder.tcal = cycle(case.times.tcal_cycles.into());
    encoder.tm = cycle(case.times.tm_cycles.into())..=cycle(case.times.tm_cycles.into());
    let line = LineConfig {
        ns_per_m: 0.0,
        clock: path,
        data_out: path,
        data_in: path,
        ..LineConfig::cable(0.0)
    };
    let links = vec![(PinNames::channel(), Link::new(line, encoder))];
    let mut bench = Bench::new(engine, case.system_hz, links);
    for (name, value) in settings {
        bench.set(name, *value);
    }
    let nets: Vec<usize> = bench.engine().registers().collect();
    let mut states: Vec<Vec<u128>> = vec![];
    let mut frame_cycles = 0;
    for frame in 0..FRAMES {
        let mut is_ready = bench.run_until_done(SPAN, |b| b.get("busy") == 0);
        // Another pause before each, none among them, so that nothing is the same by chance.
        bench.run_cycles(PAUSES[frame % PAUSES.len()]);
        if frame > 0 {
            let engine = bench.engine();
            let state = nets.iter().map(|&net| engine.peek(net).unwrap_or(0));
            states.push(state.collect());
        }
        let begin = bench.cycle();
        bench.trigger();
        bench.tick();
        if frame % 4 == 1 {
            // One that is lost.
            bench.run_cycles(LOST_AFTER_CYCLES);
            bench.trigger();
        }
        is_ready &= bench.run_until_done(SPAN, |b| b.results().len() > frame);
        if frame % 4 == 2 {
            // One that is lost behind the result, and is told with the next.
            bench.trigger();
        }
        is_ready &= bench.run_until_done(SPAN, |b| b.get("busy") == 0);
        frame_cycles = frame_cycles.max(bench.cycle() - begin);
        if frame == 0 {
            frame_cycles = 0;
        }
        let cause = bench.results().last().map(|r| r.last_cause());
        let is_good = cause.is_some_and(|c| c == 0 || c == TRIGGER_OVERRUN);
        if !is_ready || !is_good {
            return Err(GenError::input(format!(
                "{}: no good frame with tcal {}, tm {}, delay {} cycles: cause {cause:?}; what is proved begins at a channel that works",
                case.name, case.times.tcal_cycles, case.times.tm_cycles, case.times.delay_cycles
            )));
        }
    }
    let engine = bench.engine();
    let names: Vec<String> = engine.nets().map(flattened).collect();
    let registers = nets.iter().enumerate().map(|(index, &net)| {
        let mut values = states.iter().map(|s| s[index]);
        let first = values.next().filter(|_| !is_data(&names[net]));
        Register {
            name: names[net].clone(),
            width_bits: engine.width_bits(net),
            value: first.filter(|_| values.all(|v| Some(v) == first)),
        }
    });
    Ok(Rest {
        registers: registers.collect(),
        frame_cycles,
    })
}

fn is_data(name: &str) -> bool {
    DATA.iter().any(|d| name.rsplit('.').next() == Some(d))
}

/// The name that a net has in the emitted Verilog when it is flattened.
fn flattened(name: &str) -> String {
    let parts: Vec<&str> = name.split('.').collect();
    let (net, instances) = parts.split_last().unwrap_or((&"", &[]));
    let instances: String = instances.iter().map(|i| format!("u_{i}.")).collect();
    format!("u.{instances}{}", emitted_name(net))
}

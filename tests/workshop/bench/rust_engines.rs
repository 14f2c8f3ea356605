//! The engines of this project on the stimulus.

use super::design::CardDesign;
use super::stimulus::{encoder, line, links, Digest, Stimulus, INPUTS, OUTPUTS, RESET_CYCLES};
use super::{fault, Measured};
use endat_console::error::CommandError;
use endat_hdl::card::Card;
use endat_sim::bench::{Bench, LaneBench, Link, PinNames};
use rtl_design::engine::{
    Compiled, Engine, Interpreter, Keep, KernelEngine, LaneWords, Lanes, PortId,
};
use rtl_design::kernel_engine;
use std::thread;
use std::time::Instant;

/// Plays the first rows of the stimulus to an engine.
fn play(engine: &mut dyn Engine, rows: &[u8]) -> Digest {
    let inputs = INPUTS.map(|name| engine.port(name));
    let outputs = OUTPUTS.map(|name| engine.port(name));
    let mut digest = Digest::START;
    let mut before = None;
    for row in rows {
        if before != Some(*row) {
            before = Some(*row);
            for (place, id) in inputs.iter().enumerate() {
                engine.set(*id, (row >> place & 1).into());
            }
        }
        engine.tick();
        let bit = |engine: &mut dyn Engine, id: &PortId| engine.get(*id) as u64;
        let word = outputs
            .iter()
            .enumerate()
            .fold(0, |word, (place, id)| word | bit(engine, id) << place);
        digest.add(word);
    }
    digest
}

fn played(
    name: &'static str,
    rows: &[u8],
    make: impl FnOnce() -> Result<Box<dyn Engine>, CommandError>,
) -> Result<Measured, CommandError> {
    let start = Instant::now();
    let mut engine = make()?;
    let ready_s = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let digest = play(engine.as_mut(), rows);
    Ok(Measured {
        name,
        cycles: rows.len() as u64,
        seconds: start.elapsed().as_secs_f64(),
        ready_s,
        digest: Some(digest),
        compared_cycles: rows.len() as u64,
        ..Measured::default()
    })
}

/// The card as rust-hdl's own kernels run it.
pub fn card_kernels(card: Card) -> KernelEngine<Card> {
    kernel_engine!(card; clk_i; in rst_i, trigger_i, uart_rx_i; out uart_tx_o, led_status_o)
        .input("endat_data0_i", |b| &mut b.endat_data_i[0])
        .input("endat_data1_i", |b| &mut b.endat_data_i[1])
        .output("endat_clk0_o", |b| &mut b.endat_clk_o[0])
        .output("endat_clk1_o", |b| &mut b.endat_clk_o[1])
        .output("endat_data0_o", |b| &mut b.endat_data_o[0])
        .output("endat_data1_o", |b| &mut b.endat_data_o[1])
        .output("endat_data0_oe", |b| &mut b.endat_data_oe[0])
        .output("endat_data1_oe", |b| &mut b.endat_data_oe[1])
        .output("led_channel0_o", |b| &mut b.led_channel_o[0])
        .output("led_channel1_o", |b| &mut b.led_channel_o[1])
}

/// rust-hdl's own kernels.
pub fn kernels(stimulus: &Stimulus, cycles: usize) -> Result<Measured, CommandError> {
    played("rust-hdl kernels", &stimulus.rows[..cycles], || {
        Ok(Box::new(card_kernels(CardDesign::block()?)))
    })
}

/// The plain engine.
pub fn plain(
    card: &CardDesign,
    stimulus: &Stimulus,
    cycles: usize,
) -> Result<Measured, CommandError> {
    played("plain engine", &stimulus.rows[..cycles], || {
        Ok(Box::new(
            Interpreter::new(&card.design).map_err(|e| fault(&e))?,
        ))
    })
}

/// The compiled engine.
pub fn compiled(
    card: &CardDesign,
    stimulus: &Stimulus,
    cycles: usize,
) -> Result<Measured, CommandError> {
    played("compiled engine", &stimulus.rows[..cycles], || {
        Ok(Box::new(
            Compiled::new(&card.design).map_err(|e| fault(&e))?,
        ))
    })
}

/// The compiled engine with encoders and lines.
pub fn compiled_with_models(card: &CardDesign, cycles: usize) -> Result<Measured, CommandError> {
    let start = Instant::now();
    let engine = Compiled::new(&card.design).map_err(|e| fault(&e))?;
    let ready_s = start.elapsed().as_secs_f64();
    let mut bench = Bench::new(engine, card.system_hz, links());
    let outputs = OUTPUTS.map(|name| bench.engine().port(name));
    bench.set("uart_rx_i", 1);
    // A reset would be followed by 30 ms of quiet.
    bench.set("rst_i", 0);
    let mut digest = Digest::START;
    let start = Instant::now();
    for cycle in 0..cycles as u64 {
        if cycle == RESET_CYCLES {
            bench.set("rst_i", 0);
        }
        bench.tick();
        let engine = bench.engine();
        let word = outputs.iter().enumerate();
        digest.add(word.fold(0, |word, (place, id)| {
            word | (engine.get(*id) as u64) << place
        }));
    }
    let seconds = start.elapsed().as_secs_f64();
    Ok(Measured {
        name: "compiled engine",
        cycles: cycles as u64,
        seconds,
        ready_s,
        frames: (bench.frames(0).len() + bench.frames(1).len()) as u64,
        digest: Some(digest),
        compared_cycles: cycles as u64,
        ..Measured::default()
    })
}

/// The lane engine with an encoder and a line for each channel of each lane, a bench on every processor. The digest is of lane 0.
pub fn lanes(card: &CardDesign, words: LaneWords, cycles: usize) -> Result<Measured, CommandError> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    lanes_on(card, words, cycles, threads)
}

/// The same with so many benches.
pub fn lanes_on(
    card: &CardDesign,
    words: LaneWords,
    cycles: usize,
    threads: usize,
) -> Result<Measured, CommandError> {
    let start = Instant::now();
    let engine = Lanes::new(&card.design, Keep::Outputs, words).map_err(|e| fault(&e))?;
    let ready_s = start.elapsed().as_secs_f64();
    let state_bytes = engine.state_bytes() as u64 / engine.lanes() as u64;
    let run = |number: usize| {
        let engine = engine.clone();
        let lanes = engine.lanes();
        let port = |n: usize| {
            let link = |lane: usize| {
                let mut line = line(n);
                // Lane 0 of the first bench is the case of the other engines; the others have other cables.
                line.cable_m += (number * lanes + lane) as f64 / 16.0;
                Link::new(line, encoder(n))
            };
            (PinNames::card(n), (0..lanes).map(link).collect())
        };
        let mut bench = LaneBench::new(engine, card.system_hz, vec![port(0), port(1)]);
        let outputs = OUTPUTS.map(|name| bench.engine().port(name));
        bench.set_all("uart_rx_i", 1);
        bench.set_all("rst_i", 0);
        let mut digest = Digest::START;
        for cycle in 0..cycles as u64 {
            if cycle == RESET_CYCLES {
                bench.set_all("rst_i", 0);
            }
            bench.tick();
            let engine = bench.engine();
            let word = outputs.iter().enumerate();
            digest.add(word.fold(0, |word, (place, id)| {
                word | (engine.word(*id, 0, 0) & 1) << place
            }));
        }
        let frames: usize = (0..lanes)
            .map(|lane| {
                let count = |port| bench.link(port, lane).encoder().frames().len();
                count(0) + count(1)
            })
            .sum();
        (digest, frames as u64)
    };
    let start = Instant::now();
    let found: Vec<(Digest, u64)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|number| scope.spawn(move || run(number)))
            .collect();
        workers
            .into_iter()
            .map(|w| w.join().unwrap_or_else(|e| std::panic::resume_unwind(e)))
            .collect()
    });
    let copies = (threads * engine.lanes()) as u64;
    Ok(Measured {
        name: match words {
            LaneWords::One => "lanes, 64 in a word",
            LaneWords::Two => "lanes, 128 in a vector",
        },
        cycles: cycles as u64 * copies,
        seconds: start.elapsed().as_secs_f64(),
        ready_s,
        frames: found.iter().map(|(_, frames)| frames).sum(),
        digest: found.first().map(|(digest, _)| *digest),
        compared_cycles: cycles as u64,
        state_bytes: Some(state_bytes),
    })
}

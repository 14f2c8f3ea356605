//! SSI: the port with its encoder.

mod broken;
mod line;
mod reset;
mod run;
mod special;
mod three_ways;
mod upsets;
mod width;

use endat_hdl::encoder_port::EncoderPort;
use endat_hdl::protocols::{Spoken, SsiSpec};
use endat_sim::bench::{Bench, PinNames};
use endat_sim::ssi::{EncoderConfig, SsiLink};
use endat_sim::Time;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::sync::Arc;

/// A port as in a card with this request.
fn block(asked: &SsiSpec) -> EncoderPort {
    let mut block = EncoderPort::asked(&Spoken::Ssi(*asked), true, false);
    block.connect_all();
    block
}

fn design() -> Design {
    elaborate(&block(&SsiSpec::default()), "encoder_port").unwrap()
}

/// A position that is hard to match by chance.
fn shaft(time: Time) -> u64 {
    (time / 1_000).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 8
}

/// A port with an encoder at the line delay `delay`.
fn bench(design: &Design, system_hz: u64, config: EncoderConfig, delay: Time) -> Bench<Compiled> {
    let mut bench = Bench::new(Compiled::new(design).unwrap(), system_hz, vec![]);
    let mut link = SsiLink::new(config, delay);
    link.set_motion(Arc::new(shaft));
    bench.add_other(&PinNames::channel(), Box::new(link));
    bench
}

/// From power-up until a trigger is accepted: the encoder may be in the middle of a frame.
fn power_up(bench: &mut Bench<Compiled>) {
    bench.power_up();
    while bench.get("busy") != 0 {
        bench.run_cycles(10);
    }
}

/// The encoder of the bench.
fn link(bench: &mut Bench<Compiled>) -> &mut SsiLink {
    bench.others_as_mut().next().expect("an SSI encoder")
}

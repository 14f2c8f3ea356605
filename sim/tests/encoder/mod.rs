//! The encoder of hdl: next to the simulation's encoder model, at receivers, proved and synthesised.

mod frame;
mod mutants;
mod outside;
mod receiver;
mod three_ways;
mod twin;

use endat_hdl::endat::encoder::{Encoder, EncoderMake};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::sync::LazyLock;

/// Longest CLOCK LOW of [`DESIGN`], in microseconds: that of an LC linear encoder, so that tests need not wait for 50 ms.
const CLOCK_LOW_MAX_US: u64 = 30;

fn block(errors: bool) -> Encoder {
    let mut block = Encoder::new(EncoderMake {
        clock_low_max_us: CLOCK_LOW_MAX_US,
        errors,
    });
    block.connect_all();
    block
}

static DESIGN: LazyLock<Design> = LazyLock::new(|| elaborate(&block(false), "encoder").unwrap());

static BLOCK: LazyLock<Compiled> = LazyLock::new(|| Compiled::new(&DESIGN).unwrap());

/// The encoder with errors on command.
static WRONG_DESIGN: LazyLock<Design> =
    LazyLock::new(|| elaborate(&block(true), "encoder").unwrap());

static WRONG_BLOCK: LazyLock<Compiled> = LazyLock::new(|| Compiled::new(&WRONG_DESIGN).unwrap());

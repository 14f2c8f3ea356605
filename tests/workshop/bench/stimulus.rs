//! What the card meets: two encoders on their cables, and a host that reads.

use super::design::CardDesign;
use endat_console::error::CommandError;
use endat_hdl::card::uart::bit_cycles;
use endat_sim::bench::{Bench, Link, PinNames};
use endat_sim::encoder::{EncoderConfig, PositionSource};
use endat_sim::line::LineConfig;
use endat_sim::{NS, US};
use rtl_design::engine::{Compiled, Engine};

/// Cables of the two channels, in metres.
pub const CABLES_M: [f64; 2] = [5.0, 20.0];
/// Inputs of the card, from bit 0 of a row on.
pub const INPUTS: [&str; 5] = [
    "rst_i",
    "trigger_i",
    "uart_rx_i",
    "endat_data0_i",
    "endat_data1_i",
];
/// Outputs of the card, from bit 0 of a row on.
pub const OUTPUTS: [&str; 10] = [
    "uart_tx_o",
    "led_status_o",
    "endat_clk0_o",
    "endat_data0_o",
    "endat_data0_oe",
    "led_channel0_o",
    "endat_clk1_o",
    "endat_data1_o",
    "endat_data1_oe",
    "led_channel1_o",
];
/// Cycles in reset at the beginning.
pub const RESET_CYCLES: u64 = 8;
/// What the host sends, again and again: read 14 words of results.
const COMMAND: [u8; 6] = [0x02, 14, 0, 0, 0x01, 0x80];
/// Cycles between two commands: shorter than a sampling period, and no multiple of it.
const COMMAND_CYCLES: u64 = 61_003;

/// The encoder of a channel, as a C++ model can be made of it: nothing random.
pub fn encoder(channel: usize) -> EncoderConfig {
    let mut config = EncoderConfig::endat22(29);
    config.position = PositionSource::Ramp {
        start: 1_000_003 * (channel as u64 + 1),
        step: 7919,
    };
    config.tcal = 5 * US;
    config.tm = 12 * US..=12 * US;
    config.clock_to_data = 50 * NS;
    config.release = 100 * NS;
    config
}

/// The line of a channel.
pub fn line(channel: usize) -> LineConfig {
    LineConfig::cable(CABLES_M[channel])
}

/// The two links of a card.
pub fn links() -> Vec<(PinNames, Link)> {
    (0..2)
        .map(|n| (PinNames::card(n), Link::new(line(n), encoder(n))))
        .collect()
}

/// Input values of the card, a row for each cycle.
pub struct Stimulus {
    /// Rows; the bits are [`INPUTS`].
    pub rows: Vec<u8>,
}

/// The level of the host's line in a cycle.
fn host_level(cycle: u64, bit_cycles: u64) -> bool {
    let since = cycle % COMMAND_CYCLES;
    let bit = since / bit_cycles;
    let (byte, place) = ((bit / 10) as usize, bit % 10);
    match (COMMAND.get(byte), place) {
        (None, _) => true,
        (Some(_), 0) => false,
        (Some(byte), 1..=8) => byte >> (place - 1) & 1 == 1,
        _ => true,
    }
}

impl Stimulus {
    /// Records what happens at the pins of the card.
    pub fn record(card: &CardDesign, cycles: usize) -> Result<Self, CommandError> {
        let engine = Compiled::new(&card.design).map_err(|e| super::fault(&e))?;
        let bit = bit_cycles(card.system_hz, card.baud);
        let mut bench = Bench::new(engine, card.system_hz, links());
        let inputs = INPUTS.map(|name| bench.engine().port(name));
        let mut rows = Vec::with_capacity(cycles);
        for cycle in 0..cycles as u64 {
            let engine = bench.engine();
            engine.set(inputs[0], 0);
            engine.set(inputs[2], u128::from(host_level(cycle, bit)));
            bench.tick();
            // Inputs stay as they are until the next tick.
            let level = |id: &rtl_design::engine::PortId| bench.engine().get(*id) as u8;
            rows.push(0);
            let row = inputs.iter().map(level).enumerate();
            let row = row.fold(0, |row, (place, level)| row | level << place);
            if let Some(last) = rows.last_mut() {
                *last = row;
            }
        }
        Ok(Self { rows })
    }
}

/// A number that is different if any output is different in any cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Digest {
    /// Of no cycles.
    pub const START: Self = Self(0xCBF2_9CE4_8422_2325);
    /// The factor of one step; FNV-1a's.
    pub const FACTOR: u64 = 0x0100_0000_01B3;

    /// With the outputs of one more cycle; the bits are [`OUTPUTS`].
    pub fn add(&mut self, outputs: u64) {
        self.0 = (self.0 ^ outputs).wrapping_mul(Self::FACTOR);
    }
}

//! The bench's host: how it sits at the card's bus, and the tasks `host_idle`, `write_word`, `read_words` with the function `word`.

use super::{clock_ns, real};
use crate::buses::front;
use endat_config::template;
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::config_ring::RING_BYTES;
use endat_hdl::card::stream::buffer::frame_bytes;
use endat_hdl::config::CardConfig;
use minijinja::context;
use serde::Serialize;

/// A port of the card and what it is connected to.
#[derive(Serialize)]
pub struct Connection {
    port: &'static str,
    net: &'static str,
}

/// The host at one kind of bus.
pub struct Host {
    /// Declarations and tasks.
    pub text: String,
    /// The bus at the card.
    pub connections: Vec<Connection>,
    /// A written word acts after this, in ns.
    pub settle_ns: f64,
}

/// Bit times of a UART that a written word is waited for.
pub const UART_SETTLE_BITS: f64 = 20.0;
/// Half an SPI clock period, in system clock cycles: a quarter more than the shortest one, and no multiple of a cycle.
pub const SCK_HALF_CYCLES: f64 = 5.1;

/// What an access takes at most besides a turn of the configuration ring, in system clock cycles.
const ACCESS_CYCLES: usize = 100;

/// Longest access of a bus, in system clock cycles.
pub fn access_cycles_max(card: &CardConfig) -> usize {
    RING_BYTES * (card.channels.len() + 1) + ACCESS_CYCLES
}

/// Tasks of every host, for what the bus of each does in `bus_write` and `bus_read`.
const ACCESS: &str = include_str!("../templates/bench_host/access.v");
/// What both are for hosts that move one word at a time.
const WORDS: &str = include_str!("../templates/bench_host/words.v");

/// Whether frames of the stream go out over the UART from the start.
pub fn pushes(bus: HostBus, card: &CardConfig) -> bool {
    bus == HostBus::Uart && card.stream.start.pushes()
}

/// Twice the longest frame of a stream, in bits of the UART.
pub fn stream_bits(card: &CardConfig) -> u64 {
    2 * 10 * frame_bytes(card.channels.len(), card.stream.additional_data)
}

/// The host of a card with this bus; none for a port without a bus.
pub fn host(bus: HostBus, card: &CardConfig) -> Result<Option<Host>, CommandError> {
    let Some(host) = &front(bus).bench_host else {
        return Ok(None);
    };
    let words = if host.moves_words { WORDS } else { "" };
    let clk_ns = clock_ns(card.system_hz);
    let settle_ns = match bus {
        HostBus::Uart => UART_SETTLE_BITS * 1e9 / card.baud as f64,
        _ => access_cycles_max(card) as f64 * clk_ns,
    };
    let context = context! {
        uart_bit_ns => real(1e9 / card.baud as f64),
        pushes => pushes(bus, card),
        frame_bits => real(stream_bits(card) as f64),
        sck_half_ns => real(SCK_HALF_CYCLES * clk_ns),
        access_cycles_max => access_cycles_max(card),
    };
    // Names stand before they are used.
    let text = format!("{ACCESS}{words}{}", host.text);
    Ok(Some(Host {
        text: template::render("bench_host", &text, &context)?,
        connections: (host.connections.iter())
            .map(|(port, net)| Connection { port, net })
            .collect(),
        settle_ns,
    }))
}

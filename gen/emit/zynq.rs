//! A block design for Zynq-7000: which board it is made for, and where the lines of the encoders are there.

use endat_config::board::Board;
use endat_console::error::CommandError;
use endat_hdl::card::bus::HostBus;
use serde::Serialize;
use std::ops::Range;

/// End of the file's name, and its template.
pub const SCRIPT: (&str, &str) = (
    "_zynq.tcl",
    include_str!("templates/integration/zynq.tcl.jinja"),
);

/// The board of the example.
const BOARD: &str = "zybo_z7_10";
/// Its files in Vivado, any version, with DDR and MIO of the processor. Ref: Digilent, vivado-boards.
const BOARD_PART: &str = "digilentinc.com:zybo-z7-10:*";
/// What the processor's M_AXI_GP0 reaches. Ref: UG585, system-level address map.
const REACH: Range<u32> = 0x4000_0000..0x8000_0000;
/// Where Vivado puts the first peripheral there.
const USUAL_BASE: u32 = 0x43C0_0000;
/// Ports for logic of one's own in the device.
const WITHIN: &str = "direct_";

/// What the template is told.
#[derive(Serialize)]
pub struct Zynq {
    board: String,
    part: String,
    board_part: &'static str,
    base_address: String,
    pins: Vec<Pin>,
}

/// A port of the core that is one of the device.
#[derive(Serialize)]
struct Pin {
    port: String,
    /// Empty where the board has no place for it.
    pin: String,
    iostandard: String,
}

/// Where the processor has the registers of a card with this bus and base address (0: nobody has said so); `None` where it cannot.
pub fn base(bus: HostBus, base_address: u32) -> Option<u32> {
    match base_address {
        _ if bus != HostBus::AxiLite => None,
        0 => Some(USUAL_BASE),
        given => REACH.contains(&given).then_some(given),
    }
}

/// The block design of a core with its registers there, and these ports besides bus, clock, reset and interrupt.
pub fn of<'p>(
    ports: impl Iterator<Item = &'p str>,
    base_address: u32,
) -> Result<Zynq, CommandError> {
    let board = Board::named(BOARD).map_err(|error| CommandError::fault(BOARD, &error))?;
    let outside = ports.filter(|port| !port.starts_with(WITHIN));
    let pins = outside.map(|port| {
        let pin = match board.usual_place(port) {
            Some(place) => board
                .pin(place)
                .map_err(|error| CommandError::fault(BOARD, &error))?,
            None => String::new(),
        };
        Ok(Pin {
            port: port.to_owned(),
            iostandard: board.iostandard_of(&pin).to_owned(),
            pin,
        })
    });
    Ok(Zynq {
        pins: pins.collect::<Result<_, CommandError>>()?,
        base_address: format!("0x{base_address:08X}"),
        part: board.part,
        board: board.title,
        board_part: BOARD_PART,
    })
}

//! The wiring of a card on its board, drawn.

use endat_config::board::{Assignment, Board, Kind};
use endat_config::Project;
use endat_draw::{wiring_svg, WiredChannel, WiredPort};

/// The drawing of a card's pins, as SVG.
pub fn drawing(project: &Project, board: &Board) -> String {
    let protocols = project.card.protocols();
    let has_clock = |n: usize| protocols.of(n).row().has_clock;
    let port = |pin: &Assignment| WiredPort {
        signal: pin.signal.clone(),
        place: pin.place(),
        meaning: pin.meaning(protocols),
    };
    let named = |name: String| project.pins.iter().find(|pin| pin.signal == name).map(port);
    let channels = (0..project.card.channels.len()).filter_map(|n| {
        Some(WiredChannel {
            number: n,
            clock: named(format!("endat_clk{n}_o")).filter(|_| has_clock(n)),
            data: named(format!("endat_data{n}_o"))?,
            enable: named(format!("endat_data{n}_oe"))?,
            answer: named(format!("endat_data{n}_i"))?,
        })
    });
    // A clock that a channel does not have stays open.
    let open = (0..project.card.channels.len()).filter(|n| !has_clock(*n));
    let open: Vec<String> = open.map(|n| format!("endat_clk{n}_o")).collect();
    let others = project.pins.iter().filter(|pin| {
        open.contains(&pin.signal) || !matches!(pin.kind, Kind::Transceiver | Kind::EncoderData)
    });
    let title = format!("Wiring of {} on {}", project.name, board.title);
    let subtitle = format!(
        "{}; blue: connector and position, from 0 (pin of the device)",
        board.part
    );
    let (channels, others): (Vec<_>, Vec<_>) = (channels.collect(), others.map(port).collect());
    wiring_svg(&channels, &others, &title, &subtitle)
}

//! Words that stand for something in a configuration.

use crate::form::key::Choice;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::{PhaseSource, StreamStart};
use endat_hdl::protocol::ModeCommand;
use endat_regs::Part;

/// Bus that makes a configuration one of a receiver.
pub const RECEIVER_BUS: &str = "dsp";
/// What a trigger comes from.
pub const SOURCES: [(&str, &str); 3] = [
    ("pin", "rising edge of the trigger pin"),
    ("timer", "timer of the card"),
    ("register", "strobe that the host writes"),
];

/// Parts of `[service]`; every other one takes the first.
pub const SERVICE: [Part; 4] = [
    Part::Requests,
    Part::Diagnosis,
    Part::Continuous,
    Part::Initialise,
];
/// Parts of `[line]`; every other one takes the first.
pub const LINE: [Part; 3] = [Part::Alignment, Part::Margin, Part::DoubleEdge];
/// Parts of `[safety]`.
pub const SAFETY: [Part; 4] = [
    Part::RecoveryCounter,
    Part::SecondInterface,
    Part::SecondReceiver,
    Part::ErrorTest,
];

/// Where the phase comes from after reset.
const PHASES: [(&str, PhaseSource, &str); 3] = [
    ("tracked", PhaseSource::Tracked, "the mean over many edges"),
    ("frame", PhaseSource::Frame, "the start bit of each frame"),
    ("fixed", PhaseSource::Fixed, "`line.fixed_delay_ns`"),
];
/// What a stream does after reset.
const STARTS: [(&str, StreamStart, &str); 3] = [
    ("off", StreamStart::Off, "nothing"),
    (
        "collect",
        StreamStart::Collect,
        "sets wait for the host, which reads `stream_data`",
    ),
    ("push", StreamStart::Push, "sets go out over the UART"),
];

/// Where the phase comes from, by its word.
pub fn phase(word: &str) -> Option<PhaseSource> {
    let found = PHASES.iter().find(|(name, ..)| *name == word);
    found.map(|(_, phase, _)| *phase)
}

/// The source of the phase after reset, as it is written.
pub fn phase_name(phase: PhaseSource) -> &'static str {
    let found = PHASES.iter().find(|(_, p, _)| *p == phase);
    found.map_or("", |(name, ..)| name)
}

/// What a stream does after reset, by its word.
pub fn start(word: &str) -> Option<StreamStart> {
    let found = STARTS.iter().find(|(name, ..)| *name == word);
    found.map(|(_, start, _)| *start)
}

/// What a stream does after reset, as it is written.
pub fn start_name(start: StreamStart) -> &'static str {
    let found = STARTS.iter().find(|(_, s, _)| *s == start);
    found.map_or("", |(name, ..)| name)
}

/// All phases.
pub fn phases() -> Vec<Choice> {
    PHASES
        .map(|(word, _, means)| Choice::new(word, means))
        .into()
}

/// All starts of a stream.
pub fn starts() -> Vec<Choice> {
    STARTS
        .map(|(word, _, means)| Choice::new(word, means))
        .into()
}

/// Parts as the register table names them.
pub fn parts(parts: &[Part]) -> Vec<Choice> {
    let choice = |part: &Part| Choice::new(part.named().name, part.named().meaning);
    parts.iter().map(choice).collect()
}

/// All buses of cards, and that of a receiver.
pub fn buses() -> Vec<Choice> {
    let cards = HostBus::ALL.map(|bus| Choice::new(bus.name(), bus.row().means));
    let receiver = Choice::new(RECEIVER_BUS, "a T-format receiver instead of a card");
    cards.into_iter().chain([receiver]).collect()
}

/// Mode commands of a trigger.
pub fn commands() -> Vec<Choice> {
    let meaning = |command| match command {
        ModeCommand::SendPosition => "EnDat 2.1 position",
        _ => "EnDat 2.2 position",
    };
    let choice = |c: ModeCommand| Choice::new(format_args!("{:06b}", c.code()), meaning(c));
    ModeCommand::POSITION.map(choice).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a part of the register table that no configuration can ask for.
    #[test]
    fn every_part_with_a_list_is_in_it() {
        for (switch, list) in [
            ("[service] parts", &SERVICE[..]),
            ("[line] parts", &LINE),
            ("[safety] parts", &SAFETY),
        ] {
            let found = Part::ALL.iter().filter(|p| p.switch() == switch);
            assert!(found.clone().all(|p| list.contains(p)), "{switch}");
            assert_eq!(found.count(), list.len(), "{switch}");
        }
    }
}

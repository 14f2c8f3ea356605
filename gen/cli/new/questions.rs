//! What `new` asks: keys of a configuration, in an order in which each answer stands on those before it.

use endat_config::board::Board;
use endat_config::form::key::Kind;
use endat_config::json_schema::plain;
use endat_config::keys::{self, Key, TABLES};
use endat_config::protocols::t_format::keys::BIT_RATE;
use endat_config::words::RECEIVER_BUS;
use endat_console::number::number;
use endat_hdl::card::bus::HostBus;
use endat_hdl::endat::timing::{cycles_to_ns, period_cycles};
use endat_regs::Protocol;
use std::collections::BTreeMap;

/// Answers by the name of their question, as they were typed.
pub type Answers = BTreeMap<&'static str, String>;

/// What is asked for.
#[derive(Clone, Copy)]
pub enum Of {
    /// A key, in this table.
    Key(&'static Key, &'static str),
    /// How many channels.
    Channels,
}

/// A question.
pub struct Question {
    /// Its option.
    pub name: &'static str,
    /// What it is about.
    pub of: Of,
    /// Whether it is asked beside these answers.
    pub is_asked: fn(&Answers) -> bool,
    /// What is usual beside these answers; where the first does not go with them, one of the others may.
    pub usual: fn(&Answers) -> Vec<String>,
}

/// In the place of a board: a card that others put into a chip.
pub const NO_BOARD: &str = "none";
/// In the place of the words of a list: there are none.
pub const NOTHING: &str = "none";
/// Encoder ports unless a board has no room for them.
const CHANNELS: [usize; 2] = [2, 1];
/// From here on a clock suits nearly everything.
const SYSTEM_HZ: [u64; 8] = [
    100_000_000,
    50_000_000,
    48_000_000,
    60_000_000,
    30_000_000,
    25_000_000,
    20_000_000,
    12_000_000,
];
const CLOCK_HZ: [u64; 8] = [
    3_125_000, 4_000_000, 2_500_000, 3_000_000, 2_000_000, 1_000_000, 500_000, 250_000,
];
const SAMPLE_HZ: [u64; 5] = [10_000, 5_000, 2_000, 1_000, 100];
const BAUD: [u64; 5] = [3_000_000, 2_000_000, 1_000_000, 500_000, 115_200];
const READ_HZ: [u64; 4] = [1_000, 500, 100, 10];

fn is(answers: &Answers, name: &str, word: &str) -> bool {
    answers.get(name).is_some_and(|told| told == word)
}

pub fn is_receiver(answers: &Answers) -> bool {
    is(answers, "bus", RECEIVER_BUS)
}

/// Which keys there are: those of a receiver, or of a channel that speaks what was answered.
pub fn form_of(answers: &Answers) -> u8 {
    let spoken = |p: &&Protocol| is(answers, "protocol", p.row().word);
    match Protocol::ALL.iter().find(spoken) {
        _ if is_receiver(answers) => keys::RECEIVER_FORM,
        Some(protocol) => keys::form(*protocol),
        None => keys::ENDAT_FORM,
    }
}

/// Where a key of this table stands: other protocols have no table for all channels.
pub fn place_of(table: &'static str, answers: &Answers) -> &'static str {
    match table == keys::COMMON && form_of(answers) != keys::ENDAT_FORM {
        true => keys::CHANNELS,
        false => table,
    }
}

/// A channel that speaks what was answered has this key.
fn is_of_form(key: &Key, answers: &Answers) -> bool {
    key.forms & form_of(answers) != 0
}

/// An EnDat channel of a card.
fn is_endat(answers: &Answers) -> bool {
    form_of(answers) == keys::ENDAT_FORM
}

/// Unused bits may be between the angle and what counts turns, so that one does not follow from the other.
pub fn has_turns_apart(answers: &Answers) -> bool {
    let is_it = |p: &Protocol| p.row().turns_at.is_some() && form_of(answers) == keys::form(*p);
    Protocol::ALL.iter().any(is_it)
}

fn is_card(answers: &Answers) -> bool {
    !is_receiver(answers)
}

pub fn has_uart(answers: &Answers) -> bool {
    is(answers, "bus", HostBus::Uart.name())
}

/// Buses of cards that are a whole device.
pub fn buses_of_boards() -> Vec<&'static str> {
    let buses = HostBus::ALL.iter().filter(|bus| !bus.is_internal());
    let of_devices = buses.filter(|bus| **bus != HostBus::Bare);
    of_devices.map(|bus| bus.name()).collect()
}

/// The card can be a whole device.
fn may_have_board(answers: &Answers) -> bool {
    let buses = buses_of_boards();
    buses.into_iter().any(|bus| is(answers, "bus", bus))
}

pub fn has_board(answers: &Answers) -> bool {
    may_have_board(answers) && !is(answers, "board", NO_BOARD)
}

/// What suits the board comes first.
fn of_board(
    answers: &Answers,
    own: fn(&endat_config::board::Start) -> u64,
    usual: &[u64],
) -> Vec<String> {
    let named = answers.get("board").filter(|_| has_board(answers));
    let board = named.and_then(|name| Board::named(name).ok());
    let own = board.and_then(|board| board.start.map(|start| own(&start)));
    let all = own.into_iter().chain(usual.iter().copied());
    all.map(|n| n.to_string()).collect()
}

/// The answer as a number, if it is one.
fn value(told: &str) -> Option<u64> {
    number("", told, 0..=u64::MAX).ok()
}

/// How long a recovery time must be, so that the end of a frame is seen: one and a half periods of the clock, in ns. An encoder with a
/// shorter one cannot be read at that clock.
fn lasting_ns(answers: &Answers) -> u64 {
    let hz = |name: &str| answers.get(name).and_then(|told| value(told));
    let (Some(system_hz @ 1..), Some(clock_hz @ 1..)) = (hz("system-hz"), hz("clock-hz")) else {
        return 0;
    };
    let period = period_cycles(clock_hz, system_hz);
    cycles_to_ns(period / 2 + period, system_hz)
}

fn numbers(all: &[u64]) -> Vec<String> {
    all.iter().map(u64::to_string).collect()
}

/// What a key must be, for example, without its quotes.
fn example(key: &Key) -> String {
    key.example().trim_matches('"').replace('_', "")
}

/// All of them.
pub static QUESTIONS: &[Question] = &[
    Question {
        name: "protocol",
        of: Of::Key(&keys::PROTOCOL, keys::CHANNELS),
        is_asked: |_| true,
        usual: |_| Protocol::ALL.iter().map(|p| p.row().word.into()).collect(),
    },
    Question {
        name: "bus",
        of: Of::Key(&keys::BUS, "host"),
        is_asked: |_| true,
        usual: |_| vec![HostBus::Uart.name().into()],
    },
    Question {
        name: "board",
        of: Of::Key(&keys::BOARD_NAME, "board"),
        is_asked: may_have_board,
        usual: |answers| match has_uart(answers) {
            true => vec![keys::BOARD_NAME.example().trim_matches('"').into()],
            false => vec![NO_BOARD.into()],
        },
    },
    Question {
        name: "name",
        of: Of::Key(&keys::NAME, ""),
        is_asked: |_| true,
        usual: |_| vec![keys::NAME.example().trim_matches('"').into()],
    },
    Question {
        name: "system-hz",
        of: Of::Key(&keys::SYSTEM_HZ, "clock"),
        is_asked: is_card,
        usual: |answers| of_board(answers, |start| start.system_hz, &SYSTEM_HZ),
    },
    Question {
        name: "channels",
        of: Of::Channels,
        is_asked: is_card,
        usual: |answers| {
            let all = CHANNELS.map(|n| n as u64);
            of_board(answers, |start| start.channels as u64, &all)
        },
    },
    Question {
        name: "encoder",
        of: Of::Key(&keys::ENCODER, keys::CHANNELS),
        is_asked: |_| true,
        usual: |_| vec![String::new()],
    },
    Question {
        name: "position-bits",
        of: Of::Key(&keys::POSITION_BITS, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::POSITION_BITS, answers),
        usual: |_| vec![example(&keys::POSITION_BITS)],
    },
    Question {
        name: "single-turn-bits",
        of: Of::Key(&keys::SINGLE_TURN_BITS, keys::CHANNELS),
        is_asked: is_card,
        usual: |_| vec![String::new()],
    },
    Question {
        name: "multi-turn-bits",
        of: Of::Key(&keys::MULTI_TURN_BITS, keys::CHANNELS),
        is_asked: |answers| {
            let single = answers.get("single-turn-bits");
            let has_single = single.is_some_and(|told| !told.is_empty());
            is_card(answers) && (has_single || !has_turns_apart(answers))
        },
        usual: |answers| {
            let number = |name: &str| answers.get(name).and_then(|told| value(told));
            let (width, single) = (number("position-bits"), number("single-turn-bits"));
            // The bits that the angle leaves count turns.
            let rest = width.and_then(|width| width.checked_sub(single?));
            let rest = rest.filter(|rest| *rest > 0 && !has_turns_apart(answers));
            vec![rest.map_or(String::new(), |rest| rest.to_string())]
        },
    },
    Question {
        name: "command",
        of: Of::Key(&keys::COMMAND, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::COMMAND, answers),
        usual: |_| vec![example(&keys::COMMAND)],
    },
    Question {
        name: "clock-hz",
        of: Of::Key(&keys::CLOCK_HZ, keys::COMMON),
        is_asked: |answers| is_of_form(&keys::CLOCK_HZ, answers),
        usual: |answers| match is_endat(answers) {
            true => of_board(answers, |start| start.clock_hz, &CLOCK_HZ),
            // Every encoder takes it.
            false => numbers(&[500_000, 250_000]),
        },
    },
    Question {
        name: "cable-m",
        of: Of::Key(&keys::CABLE, keys::COMMON),
        is_asked: |answers| is_of_form(&keys::CABLE, answers),
        usual: |_| numbers(&[keys::CABLE.usual_number(), 10, 0]),
    },
    Question {
        name: "recovery-min-ns",
        of: Of::Key(&keys::RECOVERY_MIN, keys::COMMON),
        is_asked: |answers| is_of_form(&keys::BIT_DELAY, answers),
        usual: |answers| {
            let least = keys::RECOVERY_MIN.usual_number();
            numbers(&[least.max(lasting_ns(answers)), least])
        },
    },
    Question {
        name: "recovery-max-ns",
        of: Of::Key(&keys::RECOVERY_MAX, keys::COMMON),
        is_asked: |answers| is_of_form(&keys::BIT_DELAY, answers),
        usual: |answers| {
            let most = keys::RECOVERY_MAX.usual_number();
            let least = answers.get("recovery-min-ns").and_then(|told| value(told));
            numbers(&[most.max(least.unwrap_or(0)), most])
        },
    },
    Question {
        name: "bit-delay-ns",
        of: Of::Key(&keys::BIT_DELAY, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::BIT_DELAY, answers),
        usual: |_| numbers(&[keys::BIT_DELAY.usual_number()]),
    },
    Question {
        name: "code",
        of: Of::Key(&keys::CODE, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::CODE, answers),
        usual: |_| keys::CODE.words(),
    },
    Question {
        name: "parity",
        of: Of::Key(&keys::PARITY, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::PARITY, answers),
        usual: |_| keys::PARITY.words(),
    },
    Question {
        name: "bits-before",
        of: Of::Key(&keys::BITS_BEFORE, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::BITS_BEFORE, answers),
        usual: |_| vec![NOTHING.into()],
    },
    Question {
        name: "bits-after",
        of: Of::Key(&keys::BITS_AFTER, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::BITS_AFTER, answers),
        usual: |_| vec![NOTHING.into()],
    },
    Question {
        name: "twice",
        of: Of::Key(&keys::TWICE, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::TWICE, answers),
        usual: |_| vec!["false".into()],
    },
    Question {
        name: "end-low",
        of: Of::Key(&keys::END_LOW, keys::CHANNELS),
        is_asked: |answers| is_of_form(&keys::END_LOW, answers),
        usual: |_| vec!["true".into()],
    },
    Question {
        name: "bit-hz",
        of: Of::Key(&BIT_RATE, keys::CHANNELS),
        is_asked: |answers| is_of_form(&BIT_RATE, answers),
        usual: |_| numbers(&[BIT_RATE.usual_number()]),
    },
    Question {
        name: "sample-hz",
        of: Of::Key(&keys::SAMPLE_HZ, "trigger"),
        is_asked: is_card,
        usual: |_| numbers(&SAMPLE_HZ),
    },
    Question {
        name: "trigger-sources",
        of: Of::Key(&keys::TRIGGER_SOURCES, "trigger"),
        is_asked: is_card,
        usual: |_| vec![keys::TRIGGER_SOURCES.words().join(", ")],
    },
    Question {
        name: "service-parts",
        of: Of::Key(&keys::SERVICE_PARTS, "service"),
        is_asked: is_endat,
        usual: |_| vec![NOTHING.into()],
    },
    Question {
        name: "baud",
        of: Of::Key(&keys::BAUD, "link"),
        is_asked: has_uart,
        usual: |_| numbers(&BAUD),
    },
    Question {
        name: "read-hz",
        of: Of::Key(&keys::READ_HZ, "link"),
        is_asked: has_uart,
        usual: |_| numbers(&READ_HZ),
    },
];

impl Question {
    /// True if a key of `[endat]` fits the protocol that was answered.
    pub fn fits(&self, answers: &Answers) -> bool {
        match self.of {
            Of::Key(key, table) => table == keys::COMMON && is_of_form(key, answers),
            Of::Channels => false,
        }
    }

    /// Whether no answer is one: the key is left out, or is a list of nothing.
    pub fn may_be_empty(&self) -> bool {
        let is_list = matches!(self.of, Of::Key(key, _) if key.kind == Kind::Texts);
        is_list || (self.usual)(&Answers::new()).contains(&String::new())
    }

    /// What it is, as the table of keys says it.
    pub fn meaning(&self) -> &'static str {
        match self.of {
            Of::Key(key, _) => key.meaning,
            Of::Channels => {
                let channels = TABLES.iter().find(|(table, _)| *table == keys::CHANNELS);
                channels.map_or("", |(_, meaning)| meaning)
            }
        }
    }

    /// What may be answered.
    pub fn may_be(&self) -> String {
        let all = match self.of {
            Of::Key(key, _) if key.kind == Kind::Texts => {
                let all = key.may_be("").replace(", or []", "");
                format!("{all}; several with commas, or {NOTHING}")
            }
            Of::Key(key, _) => key.may_be(""),
            // Their table says it.
            Of::Channels => String::new(),
        };
        match self.name {
            "board" => format!("{all}, or {NO_BOARD}"),
            _ => all,
        }
    }

    /// Both in a line.
    pub fn about(&self) -> String {
        let (meaning, may_be) = (self.meaning(), self.may_be());
        let colon = if may_be.is_empty() { "" } else { ": " };
        plain(&format!("{meaning}{colon}{may_be}"))
    }

    /// Words that mean more than they say.
    pub fn words(&self) -> Vec<(String, String)> {
        let choices = match self.of {
            Of::Key(key, _) => key.choices(),
            Of::Channels => Vec::new(),
        };
        let choices = choices.into_iter().filter(|c| !c.meaning.is_empty());
        choices.map(|c| (c.word, plain(c.meaning))).collect()
    }

    /// What a complaint about its answer alone begins with.
    pub fn option(&self, answers: &Answers) -> String {
        match self.of {
            Of::Key(..) => self.path(answers),
            Of::Channels => self.name.to_owned(),
        }
    }

    /// What the reader's complaint about it begins with.
    pub fn path(&self, answers: &Answers) -> String {
        match self.of {
            Of::Key(key, table) => key.path_in(place_of(table, answers)),
            Of::Channels => keys::CHANNELS.to_owned(),
        }
    }
}

//! Groups of neighbouring bits, with their texts and colours.

use crate::{
    encoder::{AnswerKind, FrameLog},
    frame::{Field, Info},
    segments::{By, Meaning, Segment},
    Time,
};

/// Senders of 8 and 16 bits.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// First part of an answer.
    Answer,
    /// A block of additional data, 0 = first sent.
    Info(usize),
    /// After the mode command.
    Parameter,
    /// After the answer.
    Supplement,
}

impl Part {
    /// The expected CRC, and the received one. Parts from the receiver have none.
    fn crcs(self, frame: &FrameLog) -> (u8, u8) {
        match self {
            Self::Answer => frame.crcs(0),
            Self::Info(n) => frame.crcs(frame.head_len() + n as u32 * Info::BITS),
            Self::Parameter | Self::Supplement => (0, 0),
        }
    }
}

/// Kinds of DATA pieces under one bracket.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Idle,
    LeadIn,
    Command,
    Turnaround,
    Wait,
    Start(Part),
    Errors,
    Position,
    Address(Part),
    Data(Part),
    Block,
    Crc(Part),
    Pause,
    Zeros,
    LeadOut,
    Recovery,
    Other,
}

/// A bracket.
pub(super) struct Group {
    pub(super) kind: Kind,
    pub(super) from: Time,
    pub(super) until: Time,
    /// Levels of its bits, in the order of sending.
    bits: Vec<bool>,
}

/// The brackets over these pieces.
pub(super) fn groups(segments: &[Segment], frame: &FrameLog) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut before = None;
    for s in segments {
        let kind = kind_of(s, frame);
        if s.meaning == Meaning::Glitch {
            continue; // belongs to what it disturbs
        }
        let bit = match s.meaning {
            Meaning::Answer(i, _) => frame.answer.get(i),
            _ => s.level == crate::segments::Level::High,
        };
        let is_new = before.replace(s.meaning) != Some(s.meaning);
        match groups.last_mut() {
            Some(last) if last.kind == kind => {
                last.until = s.until;
                last.bits.extend(is_new.then_some(bit));
            }
            _ => groups.push(Group {
                kind,
                from: s.from,
                until: s.until,
                bits: vec![bit],
            }),
        }
    }
    groups
}

fn kind_of(s: &Segment, frame: &FrameLog) -> Kind {
    let part = |index: u32| match index.checked_sub(frame.head_len()) {
        Some(beyond) => Part::Info((beyond / Info::BITS) as usize),
        None => Part::Answer,
    };
    let fields = |part, field| match field {
        Field::Start => Kind::Start(part),
        Field::F1 | Field::F2 => Kind::Errors,
        Field::Position(_) => Kind::Position,
        Field::Crc(_) => Kind::Crc(part),
        Field::Data(_) => Kind::Data(part),
        Field::Block(_) => Kind::Block,
        Field::Address(_)
        | Field::InfoLow
        | Field::Warning
        | Field::Reference
        | Field::Busy
        | Field::Code(_) => Kind::Address(part),
        Field::None => Kind::Other,
    };
    match s.meaning {
        Meaning::Idle => Kind::Idle,
        Meaning::LeadIn => Kind::LeadIn,
        Meaning::Command(_) => Kind::Command,
        Meaning::Turnaround => Kind::Turnaround,
        Meaning::Wait => Kind::Wait,
        Meaning::Answer(i, field) => fields(part(i), field),
        Meaning::Parameter(field) => fields(Part::Parameter, field),
        Meaning::Supplement(field) => fields(Part::Supplement, field),
        Meaning::Pause => Kind::Pause,
        Meaning::SupplementZero(_) => Kind::Zeros,
        Meaning::LeadOut => Kind::LeadOut,
        Meaning::Recovery => Kind::Recovery,
        Meaning::Absent | Meaning::Glitch => Kind::Other,
    }
}

/// Name of a command.
pub(super) fn command_name(command: u8) -> &'static str {
    match command {
        0b000_111 | 0b111_000 => "send position",
        0b001_110 => "select memory area",
        0b011_100 => "receive parameter",
        0b100_011 => "send parameter",
        0b101_010 => "reset",
        0b010_101 => "send test values",
        0b110_001 => "test command",
        0b010_010 => "communication command",
        _ => "position + supplement",
    }
}

/// Meaning of the 8 bits of a command.
fn address_name(command: Option<u8>) -> &'static str {
    match command {
        Some(0b001_110 | 0b001_001) => "MRS code",
        Some(0b011_100 | 0b100_011 | 0b011_011 | 0b100_100) => "address",
        Some(0b110_001 | 0b010_010 | 0b110_110) => "port",
        _ => "8 bits",
    }
}

impl Group {
    /// The bits as a number, MSB first.
    fn value(&self) -> u64 {
        self.bits.iter().fold(0, |n, b| n << 1 | u64::from(*b))
    }

    /// Texts for it, the longest first.
    pub(super) fn texts(&self, f: &FrameLog) -> Vec<String> {
        let texts = |list: &[&str]| list.iter().map(|t| (*t).to_owned()).collect();
        let value = self.value();
        match self.kind {
            Kind::Idle => texts(&["idle", ""]),
            Kind::LeadIn => texts(&["lead-in"]),
            Kind::Command => {
                let code = f.command.map_or(String::new(), |c| format!(" {c:06b}"));
                vec![
                    format!("mode command{code}"),
                    "mode command".into(),
                    "command".into(),
                ]
            }
            Kind::Turnaround => texts(&["nobody drives", "released", "off"]),
            Kind::Wait if f.start_edge.is_none() => {
                texts(&["LOW: no start bit comes", "no start bit", "wait"])
            }
            // Memory commands wait for their access time.
            Kind::Wait if f.parameter.is_some() => {
                texts(&["LOW until tac has passed", "LOW until tac", "wait"])
            }
            Kind::Wait => texts(&["LOW until tcal has passed", "LOW until tcal", "wait"]),
            Kind::Start(_) => texts(&["S"]),
            Kind::Errors if f.has_f2 => texts(&["F1, F2", "F"]),
            Kind::Errors => texts(&["F1", "F"]),
            Kind::Position => self.position_texts(f),
            Kind::Address(Part::Info(n)) => {
                let number = f.infos.get(n).map_or(0, |(info, _)| number(info));
                let code = value & 0x1F;
                vec![
                    format!("additional data {number}, code 0x{code:02X}"),
                    format!("additional data {number}"),
                    format!("info {number}"),
                ]
            }
            Kind::Address(_) => {
                let name = address_name(f.command);
                vec![format!("{name} 0x{value:02X}"), name.into()]
            }
            Kind::Data(Part::Info(_)) => {
                vec![format!("content 0x{value:04X}"), "content".into()]
            }
            Kind::Data(_) => vec![format!("parameter 0x{value:04X}"), "parameter".into()],
            Kind::Block => vec![format!("block address 0x{value:02X}"), "block".into()],
            Kind::Crc(part) => {
                let (fits, came) = part.crcs(f);
                let whole = format!("CRC 0x{value:02X}");
                match fits == came {
                    true => vec![whole, "CRC".into()],
                    false => vec![
                        format!("{whole}: wrong, 0x{fits:02X} fits"),
                        format!("{whole}: wrong"),
                    ],
                }
            }
            Kind::Pause => texts(&["pause: CLOCK stays LOW", "pause"]),
            Kind::Zeros => vec![format!("{} zeros", self.bits.len()), "zeros".into()],
            Kind::LeadOut => texts(&["LOW"]),
            Kind::Recovery => texts(&["HIGH for the recovery time", "recovery time", "tm"]),
            Kind::Other => Vec::new(),
        }
    }

    fn position_texts(&self, f: &FrameLog) -> Vec<String> {
        let bits = self.bits.iter().enumerate();
        let value = bits.fold(0u64, |p, (i, b)| p | u64::from(*b) << i);
        let (name, short) = match f.kind {
            AnswerKind::TestValues => ("test values", "T"),
            _ => ("position", "D"),
        };
        vec![
            format!("{name} {value:#X}, {} bits, LSB first", self.bits.len()),
            format!("{name} {value:#X}"),
            name.into(),
            short.into(),
        ]
    }
}

/// Number of the additional data, 1 or 2; their codes differ.
fn number(info: &Info) -> u32 {
    match info.code {
        0..0x50 => 1,
        _ => 2,
    }
}

/// The class for the pieces of a driver.
pub(super) fn fill(by: By) -> &'static str {
    match by {
        By::Receiver => "f-receiver",
        By::Encoder => "f-encoder",
        By::Nobody => "f-nobody",
        By::Both => "f-both",
    }
}

/// True if a piece is a wrong bit.
pub(super) fn is_wrong(s: &Segment, frame: &FrameLog) -> bool {
    matches!(s.meaning, Meaning::Answer(index, _) if frame.is_wrong_bit(index))
}

/// The class for a piece.
pub(super) fn segment_fill(s: &Segment) -> &'static str {
    match (s.by, s.meaning) {
        (By::Encoder, Meaning::Idle | Meaning::Wait | Meaning::LeadOut | Meaning::Recovery) => {
            "f-idle"
        }
        (By::Encoder, Meaning::Answer(_, Field::Start)) => "f-start",
        (By::Encoder, Meaning::Answer(_, Field::Crc(_))) => "f-crc",
        (By::Encoder, Meaning::Answer(_, Field::Address(_))) => "f-address",
        (By::Encoder, Meaning::Answer(_, Field::Data(_))) => "f-data",
        (
            By::Encoder,
            Meaning::Answer(
                _,
                Field::InfoLow | Field::Warning | Field::Reference | Field::Busy | Field::Code(_),
            ),
        ) => "f-info",
        (By::Receiver, Meaning::LeadIn | Meaning::SupplementZero(_)) => "f-sent-zero",
        (By::Receiver, Meaning::Supplement(Field::Start)) => "f-sent-start",
        (By::Receiver, Meaning::Parameter(field) | Meaning::Supplement(field)) => match field {
            Field::Data(_) => "f-sent-data",
            _ => "f-sent-address",
        },
        (by, _) => fill(by),
    }
}

/// The class for a driver's line.
pub(super) fn stroke(by: By) -> &'static str {
    match by {
        By::Receiver => "receiver",
        By::Encoder => "encoder",
        By::Nobody => "nobody",
        By::Both => "both",
    }
}

/// Name of a bit, for pieces of one bit.
pub(super) fn bit_name(meaning: Meaning) -> Option<String> {
    match meaning {
        Meaning::Answer(..)
        | Meaning::Command(_)
        | Meaning::Parameter(_)
        | Meaning::Supplement(_)
        | Meaning::SupplementZero(_) => Some(meaning.to_string()),
        _ => None,
    }
}

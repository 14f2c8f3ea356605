//! What the host tells the judge, and what it is told to do.

use super::{CHANNELS, CONFIG_WORDS, SERVICE_WORDS};
use endat_driver::Reading;
use endat_host::stream::{Decoder, SampleSet};

/// What is going on when the flip comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Between two triggers.
    Idle,
    /// A trigger, the frames of both channels, their set.
    Frame,
    /// Results, and the set from its register.
    Read,
    /// Configuration words are written and read back.
    Write,
    /// A trigger; its set is pushed, results are read between.
    Stream,
    /// A parameter is asked for.
    Request,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Idle,
        Self::Frame,
        Self::Read,
        Self::Write,
        Self::Stream,
        Self::Request,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Frame => "frame",
            Self::Read => "read",
            Self::Write => "write",
            Self::Stream => "stream",
            Self::Request => "request",
        }
    }
}

/// What the host knows of its card before the flip.
#[derive(Clone, Default)]
pub struct Known {
    /// What it wrote.
    pub words: Vec<[u32; CONFIG_WORDS]>,
    /// Settings of the services, as they stood at the beginning.
    pub services: [[u32; SERVICE_WORDS.len()]; CHANNELS],
    pub pushes: bool,
    pub decoder: Decoder,
    /// Answers to its requests.
    pub answers: [u64; CHANNELS],
}

/// What it has seen since the last time.
#[derive(Default)]
pub struct Seen {
    /// What kind of thing.
    pub what: What,
    /// Something was wrong on the link, or refused, and the host knows.
    pub is_told: bool,
}

/// Of what it tells.
#[derive(Default)]
pub enum What {
    /// Everything is ready for the flip.
    Ready(Box<Known>),
    /// What goes on when the flip comes begins.
    Begun,
    /// It has ended; results that came with it.
    Acted(Option<Round>),
    /// A trigger, and what came of it.
    Round(Round),
    /// The answer to a request is another one than before.
    WrongAnswer,
    /// Something else.
    #[default]
    Note,
    /// The connection has been opened anew.
    Reopened,
    /// One that takes longer than any that was meant is waited for.
    Slow,
    /// No request is fulfilled any more.
    Stuck,
    /// The end: whether the configuration is what was written.
    End(bool),
}

/// What came of a trigger.
#[derive(Default)]
pub struct Round {
    /// Results of the registers; none if there was no answer.
    pub results: Option<Vec<Reading>>,
    /// Sets of the stream.
    pub sets: Vec<SampleSet>,
}

/// What to do next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The same again.
    Again,
    /// Opens the connection anew.
    Reopen,
    /// Leaves the card alone for as long as a command with a parameter may take.
    Rest,
    /// All is well: asks for the last things.
    End,
    /// Gives up.
    GiveUp,
}

//! What can become of a call.

use crate::answer::Answer;
use core::fmt;
use endat_regs::service::STEPS;
use endat_regs::{causes, Part};

/// Why a call did not do what it should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error<E> {
    /// An argument is outside of what the card takes.
    Argument,
    /// The bus refused the access, or did not answer.
    Link(E),
    /// A check sum was wrong, also when it was tried again.
    CheckSum,
    /// What answers is no card.
    NoCard,
    /// The card has another major version of the register map.
    Version {
        /// The one that it has.
        found: u8,
    },
    /// The card was made from another configuration than the one expected.
    Configuration {
        /// First 8 digits of the hash of its own.
        found: u32,
    },
    /// The card does not have the part that this takes.
    Part(Part),
    /// The channel speaks another protocol, which does not have this.
    Protocol,
    /// It did not end in time.
    Timeout,
    /// It is still under way: ask again.
    Busy,
    /// The card or its service has begun anew, or another master has asked: what became of the request is not known.
    Restarted,
    /// A setting reads back as another one than was written.
    ReadBack,
    /// DATA is HIGH: no encoder, no supply, or an open line.
    Unplugged,
    /// The encoder could not be initialised.
    Initialisation {
        /// The step that failed.
        step: u8,
    },
    /// The encoder did not fulfil the request; the answer's refusal tells why.
    Refused(Answer),
    /// The exchange with a T-format encoder failed.
    Exchange {
        /// Why, a number of `endat_regs::causes::ALL`.
        cause: u8,
    },
    /// The source "register" is not enabled: a trigger from here does nothing.
    TriggerOff,
    /// A set of the stream was damaged; the next one is a good one again.
    Set,
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument => f.write_str(
                "argument outside of what the card takes: see the register map, and Card::facts() for what this card has",
            ),
            Self::Link(error) => write!(
                f,
                "the bus refused the access or did not answer ({error:?}): check base address, clock and reset of the card"
            ),
            Self::CheckSum => f.write_str(
                "check sum wrong, also when tried again: check the lines, lower the serial clock",
            ),
            Self::NoCard => {
                f.write_str("no card answers: check base address, byte order and, on SPI, the mode")
            }
            Self::Version { found } => write!(
                f,
                "the card has version {found} of the register map, not {}: take the driver that came with the card",
                endat_regs::VERSION[0]
            ),
            Self::Configuration { found } => write!(
                f,
                "the card was made from another configuration ({found:08x}): load the bitstream that belongs to this program"
            ),
            Self::Part(part) => write!(
                f,
                "the card does not have the part {}: emit one that has it",
                part.named().name
            ),
            Self::Protocol => f.write_str(
                "the channel speaks another protocol, which does not have this: Card::facts() tells which",
            ),
            Self::Timeout => {
                f.write_str("not ended in time: is a trigger enabled, is the encoder plugged in?")
            }
            Self::Busy => f.write_str("still under way: ask again"),
            Self::Restarted => f.write_str(
                "the card or its service has begun anew, or another master has asked: ask again, write alarms and additional data again",
            ),
            Self::ReadBack => f.write_str(
                "the setting reads back as another one: is another master writing, is the link disturbed?",
            ),
            Self::Unplugged => f.write_str(
                "no encoder: check plug, supply and both lines of DATA; the card goes on by itself",
            ),
            Self::Initialisation { step } => write!(
                f,
                "the encoder could not be initialised, it failed in step {step} ({}): look at the cause of the last result",
                STEPS.get(usize::from(*step)).map_or("unknown", |s| s.meaning)
            ),
            Self::Refused(answer) => write!(
                f,
                "the encoder did not fulfil the request: {}",
                answer.refusal_meaning()
            ),
            Self::Exchange { cause } => write!(
                f,
                "the exchange with the T-format encoder failed ({}): {}",
                causes::of(*cause).map_or("unknown", |cause| cause.name),
                causes::of(*cause)
                    .and_then(|cause| causes::advice(cause.name))
                    .map_or("the driver does not know why", |[_, remedy]| remedy),
            ),
            Self::TriggerOff => f.write_str(
                "the trigger source \"register\" is not enabled: Card::set_triggers()",
            ),
            Self::Set => f.write_str(
                "a set of the stream was damaged: the link is disturbed, or another reader takes from it",
            ),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

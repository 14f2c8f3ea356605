//! Errors of the calls.

use crate::answer::Answer;
use core::fmt;
use endat_regs::service::STEPS;
use endat_regs::{causes, Part};

/// Error of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error<E> {
    /// An argument is outside the supported range.
    Argument,
    /// The bus rejected the access, or did not answer.
    Link(E),
    /// The check sum was wrong in all tries.
    CheckSum,
    /// The answer does not come from a card.
    NoCard,
    /// The card has another major version of the register map.
    Version {
        /// Version of the card.
        found: u8,
    },
    /// The card has another configuration than expected.
    Configuration {
        /// First 8 digits of its hash.
        found: u32,
    },
    /// The card does not have the required part.
    Part(Part),
    /// The channel has another protocol, which does not support this.
    Protocol,
    /// The limit has passed.
    Timeout,
    /// The operation is still under way: ask again.
    Busy,
    /// The card or its service has restarted, or another master has sent a request: the outcome of the request is unknown.
    Restarted,
    /// A setting reads back with another value than written.
    ReadBack,
    /// DATA is HIGH: no encoder, no supply, or an open line.
    Unplugged,
    /// The encoder could not be initialised.
    Initialisation {
        /// Failed step.
        step: u8,
    },
    /// The encoder rejected the request; the answer's refusal has the reason.
    Refused(Answer),
    /// The exchange with a T-format encoder failed.
    Exchange {
        /// Cause, a number of `endat_regs::causes::ALL`.
        cause: u8,
    },
    /// The source "register" is not enabled, so this trigger has no effect.
    TriggerOff,
    /// A set of the stream was damaged; the next one is good again.
    Set,
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument => f.write_str(
                "argument outside the supported range: see the register map, and Card::facts() for the parts of this card",
            ),
            Self::Link(error) => write!(
                f,
                "the bus rejected the access or did not answer ({error:?}): check base address, clock and reset of the card"
            ),
            Self::CheckSum => f.write_str(
                "check sum wrong in all tries: check the lines, lower the serial clock",
            ),
            Self::NoCard => {
                f.write_str("no card answers: check base address, byte order and, on SPI, the mode")
            }
            Self::Version { found } => write!(
                f,
                "the card has version {found} of the register map, not {}: use the driver that was generated with the card",
                endat_regs::VERSION[0]
            ),
            Self::Configuration { found } => write!(
                f,
                "the card has another configuration ({found:08x}): load the bitstream that belongs to this program"
            ),
            Self::Part(part) => write!(
                f,
                "the card does not have the part {}: generate a card with it",
                part.named().name
            ),
            Self::Protocol => f.write_str(
                "the channel has another protocol, which does not support this: see Card::facts()",
            ),
            Self::Timeout => {
                f.write_str("timeout: check that a trigger is enabled and the encoder is plugged in")
            }
            Self::Busy => f.write_str("still under way: ask again"),
            Self::Restarted => f.write_str(
                "the card or its service has restarted, or another master has sent a request: send it again, write alarms and additional data again",
            ),
            Self::ReadBack => f.write_str(
                "the setting reads back with another value: check for a second master and a disturbed link",
            ),
            Self::Unplugged => f.write_str(
                "no encoder: check plug, supply and both lines of DATA; the card recovers automatically",
            ),
            Self::Initialisation { step } => write!(
                f,
                "the encoder could not be initialised, it failed in step {step} ({}): check the cause of the last result",
                STEPS.get(usize::from(*step)).map_or("unknown", |s| s.meaning)
            ),
            Self::Refused(answer) => write!(
                f,
                "the encoder rejected the request: {}",
                answer.refusal_meaning()
            ),
            Self::Exchange { cause } => write!(
                f,
                "the exchange with the T-format encoder failed ({}): {}",
                causes::of(*cause).map_or("unknown", |cause| cause.name),
                causes::of(*cause)
                    .and_then(|cause| causes::advice(cause.name))
                    .map_or("unknown to this driver", |[_, remedy]| remedy),
            ),
            Self::TriggerOff => f.write_str(
                "the trigger source \"register\" is not enabled: Card::set_triggers()",
            ),
            Self::Set => f.write_str(
                "a set of the stream was damaged: the link is disturbed, or another program reads it",
            ),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

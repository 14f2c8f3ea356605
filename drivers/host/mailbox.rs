//! Requests: mode commands with a parameter, sent through the card's request word.

use crate::card::Card;
use crate::registers::{Place, Values};
use crate::transport::Transport;
use crate::HostError;
use std::time::{Duration, Instant};

/// EnDat 2.1 mode commands of `param`.
pub mod command {
    /// 001110 selection of memory area.
    pub const SELECT_MEMORY: u8 = 0b001110;
    /// 011100 receive parameter (a write, from the host's side).
    pub const RECEIVE_PARAMETER: u8 = 0b011100;
    /// 100011 send parameter (a read).
    pub const SEND_PARAMETER: u8 = 0b100011;
}

/// Longest wait for an initialisation that is under way; simulated cards are slow.
pub const INITIALISATION: Duration = Duration::from_secs(60);
/// Bit `cancel` of the control word.
const CANCEL: u32 = 1 << 2;
/// Data of 001110 for areas without blocks.
const NO_BLOCK: u16 = 0;

/// A request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Mode command.
    pub command: u8,
    /// MRS code, address or port.
    pub address: u8,
    /// Data.
    pub data: u16,
}

/// Answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Echo of MRS code or address, or the status byte of additional data 1.
    pub address: u8,
    /// Data.
    pub data: u16,
    /// The whole answer: address and data, or the 48 bits of a longer one.
    pub bits: u64,
    /// Duration of the request.
    pub duration: Duration,
}

impl<T: Transport> Card<T> {
    /// Sends a request through channel `channel`, and waits for the answer.
    pub fn request(&mut self, channel: usize, request: Request) -> Result<Answer, HostError> {
        self.needs_endat("mode commands", channel)?;
        self.needs_requests("requests to the encoder")?;
        let at = |register| Place::at("service", register, channel);
        self.wait_for_initialisation(channel)?;
        let finished = |state: u32| state >> 16;
        // Wait for the end of an earlier request of another program.
        let busy = Place::field_at("service", "request_state", "busy", channel);
        let end = Instant::now() + self.patience();
        while self.read(&busy)? == 1 {
            if Instant::now() > end {
                return Err(HostError::Refused(format!(
                    "channel {channel}: an earlier request is still under way after {} s; try again later, or cancel it (`param cancel`)",
                    self.patience().as_secs()
                )));
            }
        }
        let before = self.read(&at("request_state"))?;
        let word = u32::from(request.command) << 24
            | u32::from(request.address) << 16
            | u32::from(request.data);
        self.write(&at("request"), word)?;
        let end = Instant::now() + self.patience();
        let state = loop {
            let state = self.read(&at("request_state"))?;
            if finished(state) != finished(before) && state & 1 == 0 {
                break state;
            }
            if Instant::now() > end {
                self.write(&at("control"), CANCEL)?;
                return Err(HostError::Refused(format!(
                    "request {:06b} of channel {channel}: not finished after {} s; is the encoder plugged in, and for EnDat 2.2 commands, which ride on positions: is a trigger enabled?",
                    request.command,
                    self.patience().as_secs()
                )));
            }
        };
        let error = Place::field_at("service", "request_state", "error", channel);
        let code = error.of(state);
        if code != 0 {
            let meaning = match error.field.map(|f| f.values) {
                Some(Values::Codes(codes)) => codes.iter().find(|c| c.number == code),
                _ => None,
            };
            return Err(HostError::Refused(format!(
                "request {:06b}, address 0x{:02X}, of channel {channel}: {}",
                request.command,
                request.address,
                meaning.map_or("unknown error", |m| m.meaning)
            )));
        }
        let answer = self.read(&at("answer"))?;
        let more = self.read(&at("answer_more"))?;
        let duration = self.read(&at("duration"))?;
        let (us, ms) = (u64::from(duration & 0xFFFF), u64::from(duration >> 16));
        let duration = if ms < 60 {
            Duration::from_micros(us)
        } else {
            Duration::from_millis(ms)
        };
        Ok(Answer {
            address: (answer >> 16) as u8,
            data: answer as u16,
            bits: u64::from(more & 0xFFFF) << 32 | u64::from(answer),
            duration,
        })
    }

    /// Cancels the request that waits for a trigger in channel `channel`; true if there was one.
    pub fn cancel_request(&mut self, channel: usize) -> Result<bool, HostError> {
        self.needs_endat("mode commands", channel)?;
        self.needs_requests("requests to the encoder")?;
        let busy = Place::field_at("service", "request_state", "busy", channel);
        if self.read(&busy)? == 0 {
            return Ok(false);
        }
        // Write the whole word, so that earlier strobes are not repeated.
        self.write(&Place::at("service", "control", channel), CANCEL)?;
        let end = Instant::now() + self.patience();
        while self.read(&busy)? == 1 {
            if Instant::now() > end {
                return Err(HostError::Refused(format!(
                    "channel {channel}: the request is still under way {} s after it was cancelled; check that the card still answers",
                    self.patience().as_secs()
                )));
            }
        }
        Ok(true)
    }

    /// Waits until the card has initialised the encoder; until then it accepts no request and no trigger.
    pub fn wait_for_initialisation(&mut self, channel: usize) -> Result<(), HostError> {
        let running = Place::field_at("service", "state", "initialising", channel);
        let end = Instant::now() + INITIALISATION;
        while self.read(&running)? == 1 {
            if Instant::now() > end {
                return Err(HostError::Refused(format!(
                    "channel {channel}: the initialisation of the encoder has not ended within {} s; `id` shows its step",
                    INITIALISATION.as_secs()
                )));
            }
        }
        Ok(())
    }

    /// Selects a memory area of the encoder.
    pub fn select_memory(&mut self, channel: usize, mrs: u8) -> Result<(), HostError> {
        let request = Request {
            command: command::SELECT_MEMORY,
            address: mrs,
            data: NO_BLOCK,
        };
        self.request(channel, request).map(|_| ())
    }

    /// Reads a word of the encoder's memory.
    pub fn read_parameter(
        &mut self,
        channel: usize,
        mrs: u8,
        address: u8,
    ) -> Result<Answer, HostError> {
        self.select_memory(channel, mrs)?;
        let request = Request {
            command: command::SEND_PARAMETER,
            address,
            data: 0,
        };
        self.request(channel, request)
    }

    /// Writes a word of the encoder's memory.
    pub fn write_parameter(
        &mut self,
        channel: usize,
        mrs: u8,
        address: u8,
        data: u16,
    ) -> Result<Answer, HostError> {
        self.select_memory(channel, mrs)?;
        let request = Request {
            command: command::RECEIVE_PARAMETER,
            address,
            data,
        };
        self.request(channel, request)
    }
}

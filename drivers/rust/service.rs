//! The service of a channel: plug, initialisation, name plate, requests, additional data.

use crate::answer::Answer;
use crate::card::{Card, Wait};
use crate::error::Error;
use crate::link::Link;
use crate::map::{field, word};
use embedded_hal::delay::DelayNs;
use endat_regs::causes::endat;
use endat_regs::protocol::ModeCommand;
use endat_regs::service::word as at;
use endat_regs::{Part, Protocol, SERVICE};

/// Pause between two polls of an initialisation, and of a request.
const STATE_PAUSE_US: u32 = 500;
pub(crate) const REQUEST_PAUSE_US: u32 = 50;
/// A channel ignores triggers for this time after an aborted frame.
const ABORT_PAUSE_US: u32 = 30_000;
/// From this number of milliseconds on the microseconds of a duration may have wrapped.
const WRAPS_MS: u32 = 60;
/// MRS codes that select additional data have these bits 7..5.
const SELECTS: u8 = 0x40;
/// With these bits they deselect them.
const SELECTS_NONE: u8 = 0x0F;

/// State of a channel's service; all 0 on a card without requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// The name plate is valid.
    pub initialised: bool,
    /// Too many bad frames; latched.
    pub alarm: bool,
    /// Position 2 was too far from position 1; latched.
    pub position_2: bool,
    /// The encoder supports EnDat 2.2.
    pub endat22: bool,
    /// The encoder has another width than configured, which the card uses.
    pub other_width: bool,
    /// The encoder supports only a slower clock than configured, which the card uses.
    pub slower: bool,
    /// DATA has been HIGH for long.
    pub unplugged: bool,
    /// An initialisation is under way; triggers are lost.
    pub initialising: bool,
    /// A forced error was not reported; latched.
    pub error_test: bool,
    /// Number of starts of the service: if it has changed, write its settings again.
    pub starts: u16,
}

/// A request under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    channel: usize,
    /// Number of ended requests when it was sent.
    finished: u16,
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Reads the state of a channel.
    pub fn read_state(&mut self, channel: usize) -> Result<State, Error<L::Error>> {
        self.needs_endat(channel)?;
        if !self.facts().has(Part::Requests) {
            return Ok(State::default());
        }
        let word = self.link.read(word!(SERVICE.state, channel))?;
        Ok(State {
            initialised: field!(SERVICE.state.initialised).of(word) != 0,
            alarm: field!(SERVICE.state.alarm).of(word) != 0,
            position_2: field!(SERVICE.state.position_2).of(word) != 0,
            endat22: field!(SERVICE.state.endat22).of(word) != 0,
            other_width: field!(SERVICE.state.other_width).of(word) != 0,
            slower: field!(SERVICE.state.slower).of(word) != 0,
            unplugged: field!(SERVICE.state.unplugged).of(word) != 0,
            initialising: field!(SERVICE.state.initialising).of(word) != 0,
            error_test: field!(SERVICE.state.error_test).of(word) != 0,
            starts: field!(SERVICE.state.starts).of(word) as u16,
        })
    }

    /// State of a channel: [`Error::Unplugged`], [`Error::Busy`] (initialisation under way) or [`Error::Initialisation`] if it accepts no
    /// triggers. On a card without requests it is derived from the last result.
    pub fn status(&mut self, channel: usize) -> Result<(), Error<L::Error>> {
        self.needs_endat(channel)?;
        if !self.facts().has(Part::Requests) {
            let status = self.link.read(word!(RESULT.status, channel))?;
            return match u64::from(field!(RESULT.status.cause).of(status)) {
                endat::DATA_NOT_LOW | endat::NO_ENCODER => Err(Error::Unplugged),
                _ => Ok(()),
            };
        }
        let state = self.read_state(channel)?;
        // In this order: without an encoder "initialising" may be set, too.
        if state.unplugged {
            return Err(Error::Unplugged);
        }
        if state.initialising || state.starts == 0 {
            return Err(Error::Busy);
        }
        if !state.initialised && self.facts().has(Part::Initialise) {
            let progress = self.link.read(word!(SERVICE.progress, channel))?;
            return match field!(SERVICE.progress.failed).of(progress) as u8 {
                // No step has failed yet: the initialisation is about to begin.
                0 => Err(Error::Busy),
                step => Err(Error::Initialisation { step }),
            };
        }
        Ok(())
    }

    /// Waits until a channel accepts triggers: after power-up, and after its encoder was plugged in again, which the card detects.
    /// An initialisation takes some two seconds, twice that if a step fails. At the limit: [`Error::Unplugged`] or
    /// [`Error::Timeout`].
    pub fn wait_ready(&mut self, channel: usize, limit_ms: u32) -> Result<(), Error<L::Error>> {
        let mut wait = Wait::of_ms(limit_ms);
        let (mut was_away, mut is_in_time) = (false, true);
        loop {
            let status = self.status(channel);
            was_away |= matches!(status, Err(Error::Unplugged));
            match status {
                // The last poll comes after the last pause.
                Err(Error::Busy | Error::Unplugged) if is_in_time => {
                    is_in_time = self.pause(&mut wait, STATE_PAUSE_US);
                }
                Err(Error::Busy) => return Err(Error::Timeout),
                Err(error) => return Err(error),
                Ok(()) => break,
            }
        }
        if was_away && !self.facts().has(Part::Initialise) {
            // An initialisation takes longer than the pause; without one there is no flag for lost triggers.
            self.pause(&mut Wait::of_us(ABORT_PAUSE_US), ABORT_PAUSE_US);
        }
        Ok(())
    }

    /// Writes the whole word control, so that earlier actions are not repeated.
    fn control(&mut self, channel: usize, bits: u32) -> Result<(), Error<L::Error>> {
        self.needs_service(channel)?;
        self.link.write(word!(SERVICE.control, channel), bits)
    }

    /// Initialises the encoder again.
    pub fn initialise(&mut self, channel: usize) -> Result<(), Error<L::Error>> {
        self.needs_endat(channel)?;
        self.needs(Part::Initialise)?;
        self.control(channel, field!(SERVICE.control.initialise).mask())
    }

    /// Clears counters, alarm and other latched state.
    pub fn clear(&mut self, channel: usize) -> Result<(), Error<L::Error>> {
        self.control(channel, field!(SERVICE.control.clear).mask())
    }

    /// Raises the alarm when n of the last m frames were bad; n = 0: never.
    pub fn set_alarm(&mut self, channel: usize, n: u32, m: u32) -> Result<(), Error<L::Error>> {
        self.needs_service(channel)?;
        let (field_n, field_m) = (field!(SERVICE.threshold.n), field!(SERVICE.threshold.m));
        if !field_m.allows(m, Protocol::Endat) || n > m {
            return Err(Error::Argument);
        }
        let word = field_n.put(0, n).and_then(|word| field_m.put(word, m));
        let word = word.ok_or(Error::Argument)?;
        self.write_checked(word!(SERVICE.threshold, channel), word)
    }

    /// A word of the name plate, as the initialisation read it (`endat_regs::service::NAME_PLATE` has the names); `None` if it has not been read.
    pub fn read_plate(
        &mut self,
        channel: usize,
        name: &str,
    ) -> Result<Option<u16>, Error<L::Error>> {
        self.needs_endat(channel)?;
        self.needs(Part::Initialise)?;
        let register = SERVICE.register(name).ok_or(Error::Argument)?;
        let is_plate =
            register.offset >= at::NAME_PLATE.into() && register.offset < at::PRIVATE.into();
        if !is_plate {
            return Err(Error::Argument);
        }
        let address = SERVICE.address(register, channel);
        let word = self.link.read(address.into())?;
        let is_read = field!(SERVICE.alarms.is_read).of(word) != 0;
        Ok(is_read.then_some(field!(SERVICE.alarms.value).of(word) as u16))
    }

    /// Sends a mode command with its parameter, and does not wait. The next trigger sends EnDat 2.2
    /// commands. [`Error::Busy`] while an initialisation or another request is under way: nothing was sent.
    pub fn request(
        &mut self,
        channel: usize,
        command: ModeCommand,
        address: u8,
        data: u16,
    ) -> Result<Request, Error<L::Error>> {
        self.needs_service(channel)?;
        let word = field!(SERVICE.request.command).put(0, command.code().into());
        let word = word.and_then(|word| field!(SERVICE.request.address).put(word, address.into()));
        let word = word.and_then(|word| field!(SERVICE.request.data).put(word, data.into()));
        let word = word.ok_or(Error::Argument)?;
        let state = self.read_state(channel)?;
        let request = self.link.read(word!(SERVICE.request_state, channel))?;
        if state.unplugged {
            return Err(Error::Unplugged);
        }
        let is_busy = field!(SERVICE.request_state.busy).of(request) != 0;
        if state.initialising || state.starts == 0 || is_busy {
            return Err(Error::Busy);
        }
        self.link.write(word!(SERVICE.request, channel), word)?;
        Ok(Request {
            channel,
            finished: field!(SERVICE.request_state.finished).of(request) as u16,
        })
    }

    /// State of a request: [`Error::Busy`] until it has ended, [`Error::Refused`] if the encoder rejected it.
    pub fn poll(&mut self, request: &Request) -> Result<Answer, Error<L::Error>> {
        let channel = request.channel;
        let state = self.link.read(word!(SERVICE.request_state, channel))?;
        // "busy" may still be 0 in the first reads; only the number is reliable.
        let finished = field!(SERVICE.request_state.finished).of(state) as u16;
        match finished.wrapping_sub(request.finished) {
            0 => return Err(Error::Busy),
            1 if field!(SERVICE.request_state.busy).of(state) != 0 => return Err(Error::Busy),
            1 => {}
            _ => return Err(Error::Restarted),
        }
        let low = self.link.read(word!(SERVICE.answer, channel))?;
        let more = self.link.read(word!(SERVICE.answer_more, channel))?;
        let duration = self.link.read(word!(SERVICE.duration, channel))?;
        let more = field!(SERVICE.answer_more.value).of(more);
        let answer = Answer {
            refusal: field!(SERVICE.request_state.error).of(state) as u8,
            address: field!(SERVICE.answer.address).of(low) as u8,
            data: field!(SERVICE.answer.data).of(low) as u16,
            bits: u64::from(more) << 32 | u64::from(low),
            time_us: match field!(SERVICE.duration.ms).of(duration) {
                ms if ms < WRAPS_MS => field!(SERVICE.duration.us).of(duration),
                ms => ms * 1_000,
            },
        };
        match answer.refusal {
            0 => Ok(answer),
            _ => Err(Error::Refused(answer)),
        }
    }

    /// Cancels the request that waits for a trigger; one on the wire is finished.
    pub fn cancel(&mut self, channel: usize) -> Result<(), Error<L::Error>> {
        self.control(channel, field!(SERVICE.control.cancel).mask())
    }

    /// Sends a mode command, and waits for the answer; cancels it at the limit.
    pub fn send(
        &mut self,
        channel: usize,
        command: ModeCommand,
        address: u8,
        data: u16,
        limit_ms: u32,
    ) -> Result<Answer, Error<L::Error>> {
        let mut wait = Wait::of_ms(limit_ms);
        let (mut sent, mut is_in_time) = (None, true);
        loop {
            let became = match &sent {
                Some(request) => self.poll(request),
                None => self
                    .request(channel, command, address, data)
                    .and_then(|request| {
                        sent = Some(request);
                        Err(Error::Busy)
                    }),
            };
            match became {
                Err(Error::Busy) if is_in_time => {
                    is_in_time = self.pause(&mut wait, REQUEST_PAUSE_US);
                }
                Err(Error::Busy) => break,
                became => return became,
            }
        }
        if sent.is_some() {
            // Ignore its result: the call returns the time-out in any case.
            let _ = self.cancel(channel);
        }
        Err(Error::Timeout)
    }

    /// Selects a memory area; the block applies to areas with several blocks (0xBF), else 0.
    pub fn select_memory(
        &mut self,
        channel: usize,
        mrs: u8,
        block: u16,
        limit_ms: u32,
    ) -> Result<Answer, Error<L::Error>> {
        self.send(channel, ModeCommand::SelectMemory, mrs, block, limit_ms)
    }

    /// Reads a word of the encoder's memory; the limit applies to each of the two requests. Triggers during its frames are lost,
    /// and reported as lost.
    pub fn read_parameter(
        &mut self,
        channel: usize,
        mrs: u8,
        address: u8,
        limit_ms: u32,
    ) -> Result<Answer, Error<L::Error>> {
        self.select_memory(channel, mrs, 0, limit_ms)?;
        self.send(channel, ModeCommand::SendParameter, address, 0, limit_ms)
    }

    /// Writes a word of the encoder's memory; the limit applies to each of the two requests.
    pub fn write_parameter(
        &mut self,
        channel: usize,
        mrs: u8,
        address: u8,
        data: u16,
        limit_ms: u32,
    ) -> Result<Answer, Error<L::Error>> {
        self.select_memory(channel, mrs, 0, limit_ms)?;
        self.send(
            channel,
            ModeCommand::ReceiveParameter,
            address,
            data,
            limit_ms,
        )
    }

    /// Selects additional data in turn, one in each triggered frame: MRS codes 0x40..0x4E and 0x50..0x5E, at most 8. With an
    /// empty list nothing more is selected, and the present selection remains until a request with 0x4F or 0x5F.
    pub fn select_additional_data(
        &mut self,
        channel: usize,
        mrs: &[u8],
    ) -> Result<(), Error<L::Error>> {
        self.needs_service(channel)?;
        let is_one = |code: &u8| code & 0xE0 == SELECTS && code & SELECTS_NONE != SELECTS_NONE;
        if mrs.len() > usize::from(at::LIST_MAX) || !mrs.iter().all(is_one) {
            return Err(Error::Argument);
        }
        // The list is inactive while it is being written.
        self.write_checked(word!(SERVICE.list_length, channel), 0)?;
        for (address, code) in (word!(SERVICE.list_0, channel)..).zip(mrs) {
            self.write_checked(address, u32::from(*code))?;
        }
        match mrs.len() {
            0 => Ok(()),
            length => self.write_checked(word!(SERVICE.list_length, channel), length as u32),
        }
    }

    /// Last content of the n-th code of the list, and the number of the result that brought it: the difference to the result's `sequence`
    /// is its age in frames.
    pub fn read_additional_data(
        &mut self,
        channel: usize,
        index: usize,
    ) -> Result<(u16, u16), Error<L::Error>> {
        self.needs_service(channel)?;
        if index >= usize::from(at::LIST_MAX) {
            return Err(Error::Argument);
        }
        let word = self
            .link
            .read(word!(SERVICE.slot_0, channel) + index as u32)?;
        let content = field!(SERVICE.slot_0.value).of(word) as u16;
        Ok((content, field!(SERVICE.slot_0.sequence).of(word) as u16))
    }
}

// The words of a list are consecutive.
const _: () = {
    let last = at::LIST_MAX as u16 - 1;
    assert!(SERVICE.word("list_7").offset - SERVICE.word("list_0").offset == last);
    assert!(SERVICE.word("slot_7").offset - SERVICE.word("slot_0").offset == last);
};

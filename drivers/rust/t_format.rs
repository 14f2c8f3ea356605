//! The port of a T-format encoder: requests beside the triggers, the encoder's EEPROM, settings.

use crate::card::{Card, Wait};
use crate::error::Error;
use crate::link::Link;
use crate::map::{field, word};
use crate::service::REQUEST_PAUSE_US;
use crate::settings::{put_at, values_at, Place};
use embedded_hal::delay::DelayNs;
use endat_regs::causes;
use endat_regs::protocols::t_format::{self, request, RESETS_IN_A_ROW};
use endat_regs::{Field, Protocol};

/// An exchange is over after so long, whatever comes: the longest pauses that can be set, and all fields at the slowest bit.
const EXCHANGE_US: u32 = 2_000;

/// What came back of a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// An alarm that the encoder told in it, a number of [`causes::ALL`]: counting error, or multi-turn or battery; 0 = none.
    pub alarm: u8,
    /// ID that it repeats.
    pub id: u8,
    /// EEPROM data as they came last.
    pub data: u8,
}

/// Fields of the last reply, of a trigger or of a request, and which parts of the position there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fields {
    /// Status field (SF); 0 if none came.
    pub status: u8,
    /// Kind of encoder (ENID) as it came last.
    pub encoder_id: u8,
    /// Alarm field (ALMC) as it came last.
    pub alarm: u8,
    /// CRC as received.
    pub crc: u8,
    /// A single-turn position has come since reset: bits 23..0 of a position.
    pub has_single_turn: bool,
    /// A multi-turn position has come since reset: bits 47..24.
    pub has_multi_turn: bool,
}

/// Settings of a T-format channel, as the register map explains them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TFormatSettings {
    /// A bit: [`Card::period_cycles`].
    pub bit_cycles: u32,
    /// Request ID of a trigger, 0 to 3: `endat_regs::protocols::t_format::request`.
    pub request_id: u32,
    /// Pulses up to this length are ignored.
    pub filter_cycles: u32,
    /// Longest pause before the reply.
    pub reply_gap_us: u32,
    /// Longest pause between two fields.
    pub field_gap_us: u32,
}

/// Where each setting stands.
fn places() -> [Place; 5] {
    [
        (0, field!(CHANNEL_CONFIG.frame.period_cycles)),
        (1, field!(CHANNEL_CONFIG.timing.request_id)),
        (1, field!(CHANNEL_CONFIG.timing.filter_cycles)),
        (2, field!(CHANNEL_CONFIG.limits.start_timeout_us)),
        (2, field!(CHANNEL_CONFIG.limits.field_gap_us)),
    ]
}

impl TFormatSettings {
    fn of(words: [u32; 3]) -> Self {
        let [bit_cycles, request_id, filter_cycles, reply_gap_us, field_gap_us] =
            values_at(places(), words);
        Self {
            bit_cycles,
            request_id,
            filter_cycles,
            reply_gap_us,
            field_gap_us,
        }
    }

    fn values(&self) -> [u32; 5] {
        [
            self.bit_cycles,
            self.request_id,
            self.filter_cycles,
            self.reply_gap_us,
            self.field_gap_us,
        ]
    }
}

/// These clear something.
const RESETS: [u8; 3] = [
    request::CLEAR_ERRORS,
    request::CLEAR_SINGLE_TURN,
    request::CLEAR_MULTI_TURN,
];
/// What a trigger may ask for: neither the EEPROM, nor to clear something.
const OF_TRIGGERS: [u8; 4] = [
    request::SINGLE_TURN,
    request::MULTI_TURN,
    request::ENCODER_ID,
    request::EVERYTHING,
];
/// These come with a good reply.
const ALARMS: [u8; 2] = [
    causes::number(t_format::causes::COUNTING_ERROR as u8, Protocol::TFormat),
    causes::number(t_format::causes::MULTI_TURN_ALARM as u8, Protocol::TFormat),
];
const BUSY: &Field = field!(T_FORMAT.answer.busy);
const DONE: &Field = field!(T_FORMAT.answer.done);

/// The ID that the reply repeats.
fn repeats(answer: u32) -> u8 {
    field!(T_FORMAT.answer.id).of(answer) as u8
}

/// A request as it is written; none if it does not fit.
fn request_word([id, address, data]: [u8; 3]) -> Option<u32> {
    let word = field!(T_FORMAT.send.id).put(0, id.into())?;
    let word = field!(T_FORMAT.send.address).put(word, address.into())?;
    field!(T_FORMAT.send.data).put(word, data.into())
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Sends a request of its own, at once or behind the exchange under way, and waits for the reply. The address and the data are those
    /// of the EEPROM's requests. A trigger that falls into it is not taken, and the next result says so. The limit is for what is under
    /// way before it; the exchange itself takes less than 2 ms, and is waited for.
    ///
    /// [`Error::Exchange`] if it failed; a request that did not reach the card goes out again, and is [`Error::Timeout`] at the limit.
    pub fn exchange(
        &mut self,
        channel: usize,
        id: u8,
        address: u8,
        data: u8,
        limit_ms: u32,
    ) -> Result<Reply, Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        self.exchange_within(channel, [id, address, data], &mut Wait::of_ms(limit_ms))
    }

    fn exchange_within(
        &mut self,
        channel: usize,
        request: [u8; 3],
        wait: &mut Wait,
    ) -> Result<Reply, Error<L::Error>> {
        let word = request_word(request).ok_or(Error::Argument)?;
        let id = request[0];
        let before = self.answer_when(channel, wait, |answer| BUSY.of(answer) == 0)?;
        // A write that is lost leaves the answer of before: another ID between tells. Resets count in a row only.
        if DONE.of(before) != 0 && repeats(before) == id && !RESETS.contains(&id) {
            let other = match id {
                request::ENCODER_ID => request::SINGLE_TURN,
                _ => request::ENCODER_ID,
            };
            let word = request_word([other, 0, 0]).ok_or(Error::Argument)?;
            self.exchange_once(channel, word)?;
        }
        let mut is_in_time = true;
        loop {
            let answer = self.exchange_once(channel, word)?;
            let cause = field!(T_FORMAT.answer.cause).of(answer) as u8;
            let cause = causes::number(cause, Protocol::TFormat);
            if cause != 0 && !ALARMS.contains(&cause) {
                return Err(Error::Exchange { cause });
            }
            if repeats(answer) == id {
                return Ok(Reply {
                    alarm: cause,
                    id,
                    data: field!(T_FORMAT.answer.data).of(answer) as u8,
                });
            }
            // It is the answer of before.
            if !is_in_time {
                return Err(Error::Timeout);
            }
            is_in_time = self.pause(wait, REQUEST_PAUSE_US);
        }
    }

    /// Sends a request that nobody is before, and waits for the end of the exchange; the answer.
    fn exchange_once(&mut self, channel: usize, word: u32) -> Result<u32, Error<L::Error>> {
        self.link.write(word!(T_FORMAT.send, channel), word)?;
        let mut wait = Wait::of_us(EXCHANGE_US);
        self.answer_when(channel, &mut wait, |answer| DONE.of(answer) != 0)
    }

    fn answer_when(
        &mut self,
        channel: usize,
        wait: &mut Wait,
        is_so: impl Fn(u32) -> bool,
    ) -> Result<u32, Error<L::Error>> {
        let mut is_in_time = true;
        loop {
            let answer = self.link.read(word!(T_FORMAT.answer, channel))?;
            match is_so(answer) {
                true => return Ok(answer),
                // The last look comes behind the last pause.
                false if is_in_time => is_in_time = self.pause(wait, REQUEST_PAUSE_US),
                false => return Err(Error::Timeout),
            }
        }
    }

    /// An exchange with the EEPROM, when it is no longer busy with what was written before.
    fn eeprom(
        &mut self,
        channel: usize,
        request: [u8; 3],
        wait: &mut Wait,
    ) -> Result<u8, Error<L::Error>> {
        let busy = causes::number(t_format::causes::EEPROM_BUSY as u8, Protocol::TFormat);
        let mut is_in_time = true;
        loop {
            match self.exchange_within(channel, request, wait) {
                Err(Error::Exchange { cause }) if cause == busy && is_in_time => {
                    is_in_time = self.pause(wait, REQUEST_PAUSE_US);
                }
                Err(Error::Exchange { cause }) if cause == busy => return Err(Error::Busy),
                came => return Ok(came?.data),
            }
        }
    }

    /// Reads a byte of the EEPROM; address 127 is the page register. [`Error::Busy`] if it is still writing at the limit.
    pub fn read_eeprom(
        &mut self,
        channel: usize,
        address: u8,
        limit_ms: u32,
    ) -> Result<u8, Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        let request = [request::READ_EEPROM, address, 0];
        self.eeprom(channel, request, &mut Wait::of_ms(limit_ms))
    }

    /// Writes a byte of the EEPROM, and reads it back when it is there; address 127 is the page register. [`Error::Busy`]: it was still
    /// writing at the limit, and what it reads as then is not known; [`Error::ReadBack`]: it has another byte.
    pub fn write_eeprom(
        &mut self,
        channel: usize,
        address: u8,
        data: u8,
        limit_ms: u32,
    ) -> Result<(), Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        let mut wait = Wait::of_ms(limit_ms);
        self.eeprom(channel, [request::WRITE_EEPROM, address, data], &mut wait)?;
        match self.eeprom(channel, [request::READ_EEPROM, address, 0], &mut wait)? {
            read if read == data => Ok(()),
            _ => Err(Error::ReadBack),
        }
    }

    /// Clears errors, angle or turns of the encoder: one of the requests that count only several times in a row, so no source triggers
    /// meanwhile. [`Error::Exchange`] if one of them failed, or an alarm is still there behind them. What it has done is seen in the next
    /// position: a link without a check may have lost one of them.
    pub fn reset_encoder(
        &mut self,
        channel: usize,
        id: u8,
        limit_ms: u32,
    ) -> Result<(), Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        if !RESETS.contains(&id) {
            return Err(Error::Argument);
        }
        self.without_triggers(|card| {
            for _ in 0..RESETS_IN_A_ROW {
                card.exchange(channel, id, 0, 0, limit_ms)?;
            }
            match card.exchange(channel, request::EVERYTHING, 0, 0, limit_ms)? {
                Reply { alarm: 0, .. } => Ok(()),
                Reply { alarm: cause, .. } => Err(Error::Exchange { cause }),
            }
        })
    }

    /// Fields of the last reply, and which parts of the position there are.
    pub fn read_fields(&mut self, channel: usize) -> Result<Fields, Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        let word = self.link.read(word!(T_FORMAT.fields, channel))?;
        let parts = self.link.read(word!(T_FORMAT.parts, channel))?;
        Ok(Fields {
            status: field!(T_FORMAT.fields.status).of(word) as u8,
            encoder_id: field!(T_FORMAT.fields.encoder_id).of(word) as u8,
            alarm: field!(T_FORMAT.fields.alarm).of(word) as u8,
            crc: field!(T_FORMAT.fields.crc).of(word) as u8,
            has_single_turn: field!(T_FORMAT.parts.single_valid).of(parts) != 0,
            has_multi_turn: field!(T_FORMAT.parts.multi_valid).of(parts) != 0,
        })
    }

    /// Reads the settings of a T-format channel.
    pub fn read_t_format_settings(
        &mut self,
        channel: usize,
    ) -> Result<TFormatSettings, Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        Ok(TFormatSettings::of(self.settings_words(channel)?))
    }

    /// Writes them, while no source triggers, and reads them back. What the map does not allow is refused, and nothing written; so are
    /// requests of a trigger that bring no position or kind, and a filter of half a bit or more.
    pub fn write_t_format_settings(
        &mut self,
        channel: usize,
        settings: &TFormatSettings,
    ) -> Result<(), Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        let is_request = OF_TRIGGERS
            .iter()
            .any(|id| u32::from(*id) == settings.request_id);
        // A filter of half a bit leaves nothing of it.
        let is_short = 2 * u64::from(settings.filter_cycles) < settings.bit_cycles.into();
        if !(is_request && is_short) {
            return Err(Error::Argument);
        }
        let words = self.settings_words(channel)?;
        let words =
            put_at(places(), settings.values(), words, Protocol::TFormat).ok_or(Error::Argument)?;
        self.without_triggers(|card| card.write_settings_words(channel, words))
    }
}

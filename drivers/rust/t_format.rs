//! The port of a T-format encoder: requests in addition to triggers, the encoder's EEPROM, settings.

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

/// Upper limit of an exchange: the longest configurable pauses, and all fields at the slowest bit rate.
const EXCHANGE_US: u32 = 2_000;

/// Reply to a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// Alarm reported in the reply, a number of [`causes::ALL`]: counting error, or multi-turn or battery; 0 = none.
    pub alarm: u8,
    /// ID echoed in the reply.
    pub id: u8,
    /// EEPROM data, last received.
    pub data: u8,
}

/// Fields of the last reply, to a trigger or a request, and the received parts of the position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fields {
    /// Status field (SF); 0 if none was received.
    pub status: u8,
    /// Kind of encoder (ENID), last received.
    pub encoder_id: u8,
    /// Alarm field (ALMC), last received.
    pub alarm: u8,
    /// CRC as received.
    pub crc: u8,
    /// A single-turn position was received since reset: bits 23..0 of a position.
    pub has_single_turn: bool,
    /// A multi-turn position was received since reset: bits 47..24.
    pub has_multi_turn: bool,
}

/// Settings of a T-format channel; see the register map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TFormatSettings {
    /// Bit length: [`Card::period_cycles`].
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

/// Place of each setting.
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

/// Requests that clear something.
const RESETS: [u8; 3] = [
    request::CLEAR_ERRORS,
    request::CLEAR_SINGLE_TURN,
    request::CLEAR_MULTI_TURN,
];
/// Requests of a trigger: without EEPROM access, and without clearing.
const OF_TRIGGERS: [u8; 4] = [
    request::SINGLE_TURN,
    request::MULTI_TURN,
    request::ENCODER_ID,
    request::EVERYTHING,
];
/// Causes that come with a good reply.
const ALARMS: [u8; 2] = [
    causes::number(t_format::causes::COUNTING_ERROR as u8, Protocol::TFormat),
    causes::number(t_format::causes::MULTI_TURN_ALARM as u8, Protocol::TFormat),
];
const BUSY: &Field = field!(T_FORMAT.answer.busy);
const DONE: &Field = field!(T_FORMAT.answer.done);

/// ID echoed in the reply.
fn repeats(answer: u32) -> u8 {
    field!(T_FORMAT.answer.id).of(answer) as u8
}

/// A request word; `None` if a value does not fit.
fn request_word([id, address, data]: [u8; 3]) -> Option<u32> {
    let word = field!(T_FORMAT.send.id).put(0, id.into())?;
    let word = field!(T_FORMAT.send.address).put(word, address.into())?;
    field!(T_FORMAT.send.data).put(word, data.into())
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Sends a request in a separate exchange, at once or after the exchange under way, and waits for the reply. Address and data apply to
    /// EEPROM requests. A trigger during the exchange is lost, and the next result reports it. The limit applies to an exchange under
    /// way before it; the exchange itself takes less than 2 ms, which is always waited for.
    ///
    /// [`Error::Exchange`] if it failed. A request that did not reach the card is sent again; at the limit [`Error::Timeout`].
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
        // After a lost write the previous answer remains; another ID in between distinguishes it. Resets must be consecutive.
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
            // The answer belongs to the previous request.
            if !is_in_time {
                return Err(Error::Timeout);
            }
            is_in_time = self.pause(wait, REQUEST_PAUSE_US);
        }
    }

    /// Sends a request when none is pending, and waits for the end of the exchange; returns the answer.
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
                // The last poll comes after the last pause.
                false if is_in_time => is_in_time = self.pause(wait, REQUEST_PAUSE_US),
                false => return Err(Error::Timeout),
            }
        }
    }

    /// An exchange with the EEPROM, after the end of an earlier write.
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

    /// Reads a byte of the EEPROM; address 127 is the page register. [`Error::Busy`] if the EEPROM is still writing at the limit.
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

    /// Writes a byte of the EEPROM, and reads it back after the write; address 127 is the page register. [`Error::Busy`]: the EEPROM was still
    /// writing at the limit, and its content is undefined; [`Error::ReadBack`]: it holds another byte.
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

    /// Clears errors, angle or turns of the encoder. The encoder needs several such requests in a row, so all trigger sources are disabled
    /// meanwhile. [`Error::Exchange`] if a request failed, or an alarm remains after them. Check the effect in the next
    /// position: a link without check sum may have lost a request.
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

    /// Reads the fields of the last reply, and the received parts of the position.
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

    /// Writes the settings while all trigger sources are disabled, and reads them back. Values that the map does not allow are rejected before writing; so are
    /// trigger requests without position or kind, and a filter of half a bit or more.
    pub fn write_t_format_settings(
        &mut self,
        channel: usize,
        settings: &TFormatSettings,
    ) -> Result<(), Error<L::Error>> {
        self.needs_protocol(channel, Protocol::TFormat)?;
        let is_request = OF_TRIGGERS
            .iter()
            .any(|id| u32::from(*id) == settings.request_id);
        // A filter of half a bit removes all bits.
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

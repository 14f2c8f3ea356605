//! The port of a T-format encoder: requests beside the triggers, the encoder's EEPROM, settings.

use crate::card::{Card, Wait};
use crate::error::Error;
use crate::link::Link;
use crate::map::{field, word};
use crate::service::REQUEST_PAUSE_US;
use embedded_hal::delay::DelayNs;
use endat_regs::causes;
use endat_regs::t_format::{request, RESETS_IN_A_ROW};
use endat_regs::Field;

/// What came back of a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// Why the exchange failed, a number of [`causes::ALL`]; 0 = it did not.
    pub cause: u8,
    /// ID that the reply repeats.
    pub id: u8,
    /// EEPROM data as they came last.
    pub data: u8,
}

/// Fields of the last reply, of a trigger or of a request.
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
}

/// Settings of a T-format channel, as the register map explains them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TFormatSettings {
    /// A bit: [`Card::period_cycles`].
    pub bit_cycles: u32,
    /// Request ID of a trigger: `endat_regs::t_format::request`.
    pub request_id: u32,
    /// Pulses up to this length are ignored.
    pub filter_cycles: u32,
    /// Longest pause before the reply.
    pub reply_gap_us: u32,
    /// Longest pause between two fields.
    pub field_gap_us: u32,
}

/// The word of a channel that each setting stands in, and its field.
fn places() -> [(usize, &'static Field); 5] {
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
        let values = places().map(|(word, field)| field.of(words[word]));
        let [bit_cycles, request_id, filter_cycles, reply_gap_us, field_gap_us] = values;
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

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Sends a request of its own, at once or behind the exchange under way, and waits for the reply. The address and the data are those
    /// of the EEPROM's requests. A trigger that falls into it is not taken, and the next result says so.
    /// [`Error::Exchange`] if it failed.
    pub fn exchange(
        &mut self,
        channel: usize,
        id: u8,
        address: u8,
        data: u8,
        limit_ms: u32,
    ) -> Result<Reply, Error<L::Error>> {
        self.needs_t_format(channel)?;
        self.exchange_within(channel, [id, address, data], &mut Wait::of_ms(limit_ms))
    }

    fn exchange_within(
        &mut self,
        channel: usize,
        [id, address, data]: [u8; 3],
        wait: &mut Wait,
    ) -> Result<Reply, Error<L::Error>> {
        let word = field!(T_FORMAT.send.id).put(0, id.into());
        let word = word.and_then(|word| field!(T_FORMAT.send.address).put(word, address.into()));
        let word = word.and_then(|word| field!(T_FORMAT.send.data).put(word, data.into()));
        let word = word.ok_or(Error::Argument)?;
        let (busy, done) = (
            field!(T_FORMAT.answer.busy),
            field!(T_FORMAT.answer.done),
        );
        // One that somebody has asked for before comes first.
        self.answer_when(channel, wait, |answer| busy.of(answer) == 0)?;
        self.link.write(word!(T_FORMAT.send, channel), word)?;
        let answer = self.answer_when(channel, wait, |answer| done.of(answer) != 0)?;
        let cause = field!(T_FORMAT.answer.cause).of(answer) as u8;
        let reply = Reply {
            cause: causes::number(cause, true),
            id: field!(T_FORMAT.answer.id).of(answer) as u8,
            data: field!(T_FORMAT.answer.data).of(answer) as u8,
        };
        match reply.cause {
            0 => Ok(reply),
            cause => Err(Error::Exchange { cause }),
        }
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
                false if is_in_time => is_in_time = self.pause(wait, REQUEST_PAUSE_US),
                false => return Err(Error::Timeout),
            }
        }
    }

    /// An exchange with the EEPROM, when it is no longer busy with what was written before.
    fn eeprom(
        &mut self,
        channel: usize,
        words: [u8; 3],
        wait: &mut Wait,
    ) -> Result<u8, Error<L::Error>> {
        let busy = causes::number(causes::t_format::EEPROM_BUSY as u8, true);
        let mut is_in_time = true;
        loop {
            match self.exchange_within(channel, words, wait) {
                // The last look comes behind the last pause.
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
        self.needs_t_format(channel)?;
        let words = [request::READ_EEPROM, address, 0];
        self.eeprom(channel, words, &mut Wait::of_ms(limit_ms))
    }

    /// Writes a byte of the EEPROM, and reads it back when it is there; address 127 is the page register.
    pub fn write_eeprom(
        &mut self,
        channel: usize,
        address: u8,
        data: u8,
        limit_ms: u32,
    ) -> Result<(), Error<L::Error>> {
        self.needs_t_format(channel)?;
        let mut wait = Wait::of_ms(limit_ms);
        self.eeprom(channel, [request::WRITE_EEPROM, address, data], &mut wait)?;
        match self.eeprom(channel, [request::READ_EEPROM, address, 0], &mut wait)? {
            read if read == data => Ok(()),
            _ => Err(Error::ReadBack),
        }
    }

    /// Clears errors, angle or turns of the encoder: one of the requests that count only several times in a row, so no source triggers
    /// meanwhile. The limit is that of each exchange; [`Error::Exchange`] if an alarm is still there behind them.
    pub fn reset_encoder(
        &mut self,
        channel: usize,
        id: u8,
        limit_ms: u32,
    ) -> Result<(), Error<L::Error>> {
        use causes::t_format::{COUNTING_ERROR, MULTI_TURN_ALARM};
        use request::{CLEAR_ERRORS, CLEAR_MULTI_TURN, CLEAR_SINGLE_TURN, EVERYTHING};
        self.needs_t_format(channel)?;
        if ![CLEAR_ERRORS, CLEAR_SINGLE_TURN, CLEAR_MULTI_TURN].contains(&id) {
            return Err(Error::Argument);
        }
        // The replies tell what is to be cleared, until it is.
        let alarms = [COUNTING_ERROR, MULTI_TURN_ALARM].map(|code| causes::number(code as u8, true));
        self.without_triggers(|card| {
            for _ in 0..RESETS_IN_A_ROW {
                match card.exchange(channel, id, 0, 0, limit_ms) {
                    Err(Error::Exchange { cause }) if alarms.contains(&cause) => {}
                    came => drop(came?),
                }
            }
            card.exchange(channel, EVERYTHING, 0, 0, limit_ms).map(drop)
        })
    }

    /// Fields of the last reply.
    pub fn read_fields(&mut self, channel: usize) -> Result<Fields, Error<L::Error>> {
        self.needs_t_format(channel)?;
        let word = self.link.read(word!(T_FORMAT.fields, channel))?;
        Ok(Fields {
            status: field!(T_FORMAT.fields.status).of(word) as u8,
            encoder_id: field!(T_FORMAT.fields.encoder_id).of(word) as u8,
            alarm: field!(T_FORMAT.fields.alarm).of(word) as u8,
            crc: field!(T_FORMAT.fields.crc).of(word) as u8,
        })
    }

    /// Reads the settings of a T-format channel.
    pub fn read_t_format_settings(
        &mut self,
        channel: usize,
    ) -> Result<TFormatSettings, Error<L::Error>> {
        self.needs_t_format(channel)?;
        Ok(TFormatSettings::of(self.settings_words(channel)?))
    }

    /// Writes them, while no source triggers, and reads them back. What the map does not allow is refused, and nothing written.
    pub fn write_t_format_settings(
        &mut self,
        channel: usize,
        settings: &TFormatSettings,
    ) -> Result<(), Error<L::Error>> {
        self.needs_t_format(channel)?;
        let mut words = self.settings_words(channel)?;
        for ((word, field), value) in places().into_iter().zip(settings.values()) {
            if !field.allows(value, true) {
                return Err(Error::Argument);
            }
            words[word] = field.put(words[word], value).ok_or(Error::Argument)?;
        }
        self.without_triggers(|card| card.write_settings_words(channel, words))
    }
}

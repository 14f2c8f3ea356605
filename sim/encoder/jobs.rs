//! Effects of the commands inside the encoder: selecting, reading, writing, restarting.

use super::{
    command::Command,
    infos::is_info_code,
    memory::{area, status_word, Place},
    Encoder, ErrorSource, Registers, SHORT_RECOVERY,
};
use crate::{frame::Parameter, Time};
use std::ops::RangeInclusive;

/// A job with a duration; until its end an EnDat 2.2 encoder reports Busy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    Select(u8, u8),
    Read(Place),
    /// The word is stored at the end: a loss of supply before that keeps the old one.
    Write(Place, u16),
    Test(Parameter),
}

/// Outcome of a command with a parameter.
pub(super) struct Reply {
    pub fields: Parameter,
    /// Earliest time of the answer.
    pub ready: Time,
}

impl Encoder {
    /// Updates alarms and jobs.
    pub(super) fn settle(&mut self, time: Time) {
        if let Some((done, work)) = self.job.filter(|j| j.0 <= time) {
            self.job = None;
            self.status.look(done, &self.config);
            self.finish(work);
        }
        self.status.look(time, &self.config);
    }

    fn finish(&mut self, work: Work) {
        match work {
            Work::Select(mrs, block) => {
                self.memory.selected = Some((mrs, block));
                self.registers.mrs = (mrs, block);
            }
            Work::Read(place) => {
                self.registers.memory = Parameter {
                    address: place.address,
                    data: self.read(place),
                }
            }
            Work::Write(place, data) => {
                self.store(place, data);
                let address = place.address;
                self.registers.memory = Parameter { address, data };
            }
            Work::Test(fields) => self.registers.test = fields,
        }
    }

    /// An EnDat 2.1 command with its parameter is complete.
    pub(super) fn take_parameter(
        &mut self,
        time: Time,
        command: Command,
        fields: Parameter,
    ) -> Result<Reply, ErrorSource> {
        self.settle(time);
        let memory = matches!(
            command,
            Command::SelectMemory | Command::ReceiveParameter | Command::SendParameter
        );
        if !memory {
            return Ok(Reply {
                fields,
                ready: time,
            });
        }
        if self.job.is_some() {
            return Err(ErrorSource::Address);
        }
        let ready = time + self.draw(self.config.tac.clone());
        let address = fields.address;
        let mut reply = fields;
        match command {
            Command::SelectMemory => {
                // Block 0 by default; the place of the block in this command is an assumption.
                let block = if address == area::SECTION_2 {
                    fields.data as u8
                } else {
                    0
                };
                if is_info_code(address) {
                    return Err(ErrorSource::MrsNotAllowed);
                }
                self.memory.check_area(address, block)?;
                self.memory.selected = Some((address, block));
                self.registers.mrs = (address, block);
            }
            Command::SendParameter => reply.data = self.read(self.memory.place(address)?),
            _ => {
                let place = self.memory.place(address)?;
                match self.memory.check_write(place, fields.data) {
                    Ok(()) => self.start_write(time, place, fields.data),
                    // The receiver detects from the echo that the word differs.
                    Err(source) => {
                        self.refuse(source);
                        reply.data = self.read(place);
                    }
                }
            }
        }
        Ok(Reply {
            fields: reply,
            ready,
        })
    }

    /// A supplement is complete.
    pub(super) fn take_supplement(
        &mut self,
        time: Time,
        command: Command,
        fields: Parameter,
        block: u8,
    ) {
        self.settle(time);
        match self.act_on_supplement(time, command, fields, block) {
            Ok(()) => {}
            Err(source) => self.refuse(source),
        }
    }

    fn act_on_supplement(
        &mut self,
        time: Time,
        command: Command,
        fields: Parameter,
        block: u8,
    ) -> Result<(), ErrorSource> {
        let address = fields.address;
        match command {
            Command::PositionSelectMemory if is_info_code(address) => {
                let selected = self.selection.select(address, &self.config);
                return selected.map_err(|()| ErrorSource::InfoNotSupported);
            }
            Command::PositionErrorReset => {
                self.status.clear(time);
                self.memory.selected = None;
                if self.config.error_reset_stops_infos {
                    self.selection = Default::default();
                }
                return Ok(());
            }
            _ if self.job.is_some() => return Err(ErrorSource::Address),
            Command::PositionReceiveParameter => {
                let place = self.memory.place(address)?;
                if let Err(source) = self.memory.check_write(place, fields.data) {
                    self.begin_job(time, self.config.tac.clone(), Work::Read(place));
                    return Err(source);
                }
                self.start_write(time, place, fields.data);
                return Ok(());
            }
            _ => {}
        }
        let work = match command {
            Command::PositionSelectMemory => {
                self.memory.check_area(address, block)?;
                Work::Select(address, block)
            }
            Command::PositionSendParameter => Work::Read(self.memory.place(address)?),
            _ => Work::Test(fields),
        };
        self.begin_job(time, self.config.tac.clone(), work);
        Ok(())
    }

    /// Notes the reason of a refusal.
    pub(super) fn refuse(&mut self, source: ErrorSource) {
        self.status.sources |= source.bit();
        if let Some(frame) = self.frames.last_mut() {
            frame.refused = Some(source);
        }
    }

    /// State as after power-up, except for the stored memory.
    pub(super) fn restart(&mut self, time: Time) {
        self.job = None;
        self.selection = Default::default();
        self.registers = Registers::default();
        self.memory.restart(&self.config);
        self.status.clear(time);
    }

    /// True if the short recovery time is selected and supported.
    pub(super) fn short_recovery(&self) -> bool {
        let word = self
            .memory
            .word(area::OPERATING_STATUS, status_word::FUNCTION);
        self.config.tm_short.is_some() && word & 0b11 == SHORT_RECOVERY
    }

    fn start_write(&mut self, time: Time, place: Place, data: u16) {
        let span = self.config.write_time.clone();
        self.begin_job(time, span, Work::Write(place, data));
    }

    fn begin_job(&mut self, time: Time, span: RangeInclusive<Time>, work: Work) {
        self.job = Some((time + self.draw(span), work));
    }

    fn draw(&mut self, span: RangeInclusive<Time>) -> Time {
        self.rng.in_range(*span.start(), *span.end())
    }

    fn read(&self, place: Place) -> u16 {
        self.memory.get(place, &self.status)
    }

    fn store(&mut self, place: Place, data: u16) {
        match (place.mrs, place.address) {
            (area::OPERATING_STATUS, status_word::ALARMS) => self.status.alarms = 0,
            (area::OPERATING_STATUS, status_word::WARNINGS) => self.status.warnings = 0,
            _ => self.memory.set(place, data),
        }
    }
}

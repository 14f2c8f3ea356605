//! T-format encoders: requests in addition to those of the triggers.

use crate::card::Card;
use crate::name_plate::Told;
use crate::registers::Place;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::Protocol;
use std::time::Instant;

/// Request whose reply has all fields.
const EVERYTHING: u32 = 3;

/// Description of a T-format encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TFormatState {
    /// Kind of encoder (ENID).
    pub encoder_id: u32,
    /// Status field (SF).
    pub status: u32,
    /// Alarm field (ALMC).
    pub alarm: u32,
}

impl TFormatState {
    pub(crate) fn told(self) -> Told {
        let [id, status, alarm] = [self.encoder_id, self.status, self.alarm];
        Told {
            lines: vec![
                ("kind", format!("0x{id:02X} (ENID)")),
                ("status, alarm", format!("0x{status:02X}, 0x{alarm:02X}")),
            ],
            fields: vec![("encoder_id", id), ("status", status), ("alarm", alarm)],
        }
    }
}

impl<T: Transport> Card<T> {
    /// Asks the T-format encoder of channel `channel`; the inner error is the reason for a missing reply.
    pub fn t_format_state(
        &mut self,
        channel: usize,
    ) -> Result<Result<TFormatState, String>, HostError> {
        let at = |register| Place::at("t_format", register, channel);
        let (answer, fields) = (at("answer"), at("fields"));
        let of = |place: &Place, name: &str, word| {
            let field = place.register.field(name);
            field.map_or(0, |field| field.of(word))
        };
        let send = Place::field_at("t_format", "send", "id", channel);
        let end = Instant::now() + self.patience();
        let mut is_sent = false;
        let word = loop {
            let word = self.read(&answer)?;
            if of(&answer, "busy", word) == 0 {
                if is_sent {
                    break word;
                }
                self.write(&send, EVERYTHING)?;
                is_sent = true;
            }
            if Instant::now() > end {
                break word;
            }
        };
        if of(&answer, "done", word) == 0 || of(&answer, "cause", word) != 0 {
            let cause = answer.register.field("cause");
            let why = cause.and_then(|field| field.told(word, Protocol::TFormat));
            return Ok(Err(why.unwrap_or_else(|| "the request did not end".into())));
        }
        let word = self.read(&fields)?;
        Ok(Ok(TFormatState {
            encoder_id: of(&fields, "encoder_id", word),
            status: of(&fields, "status", word),
            alarm: of(&fields, "alarm", word),
        }))
    }
}

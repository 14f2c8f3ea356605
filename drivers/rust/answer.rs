//! Answers of an encoder.

/// Answer to a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// Reason of a rejected request, 0 = accepted: see `endat_regs::service::request_state`.
    pub refusal: u8,
    /// Echo of MRS code or address, or WRN, RM, Busy, I4..I0 of additional data 1.
    pub address: u8,
    /// Data.
    pub data: u16,
    /// Complete answer.
    pub bits: u64,
    /// Duration of the request; whole milliseconds from 60 ms on.
    pub time_us: u32,
}

impl Answer {
    /// Meaning of the refusal.
    pub fn refusal_meaning(&self) -> &'static str {
        endat_regs::service::request_state::name(self.refusal.into())
    }
}

//! What an encoder answers.

/// What came back of a request.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// Why it was not fulfilled, 0 = it was: see `endat_regs::service::request_state`.
    pub refusal: u8,
    /// Echo of MRS code or address, or WRN, RM, Busy, I4..I0 of additional data 1.
    pub address: u8,
    /// Data.
    pub data: u16,
    /// The whole answer.
    pub bits: u64,
    /// How long it took; whole milliseconds from 60 ms on.
    pub time_us: u32,
}

impl Answer {
    /// What the refusal means.
    pub fn refusal_meaning(&self) -> &'static str {
        endat_regs::service::request_state::name(self.refusal.into())
    }
}

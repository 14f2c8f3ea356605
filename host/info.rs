//! Additional data, as they stand in a result or in a set of the stream.

/// A block of additional data of the frame that brought a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Info {
    /// The frame brought it.
    pub came: bool,
    /// Its CRC is right; content and status are 0 otherwise.
    pub good: bool,
    /// The frame was not over when its set was closed: it may have come since. Never in a result.
    pub due: bool,
    /// WRN, RM, Busy, I4..I0.
    pub status: u8,
    /// What it says.
    pub content: u16,
}

impl Info {
    /// Out of 24 bits: status, content.
    pub fn new(word: u32, came: bool, good: bool, due: bool) -> Self {
        Self {
            came,
            good,
            due,
            status: (word >> 16) as u8,
            content: word as u16,
        }
    }

    /// What it says, if it can be believed.
    pub fn good(self) -> Option<Self> {
        self.good.then_some(self)
    }

    /// Which one it is: I4..I0, the low bits of the code that selects it.
    pub fn number(self) -> u8 {
        self.status & 0x1F
    }
}

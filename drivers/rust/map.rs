//! Places of the register table, by name; an unknown name fails compilation.

/// Word address of a register, with the channel for a register of a channel.
macro_rules! word {
    ($block:ident.$register:ident) => {
        word!($block.$register, 0)
    };
    ($block:ident.$register:ident, $channel:expr) => {{
        const REGISTER: &endat_regs::Register = endat_regs::$block.word(stringify!($register));
        u32::from(endat_regs::$block.address(REGISTER, $channel))
    }};
}

/// A field.
macro_rules! field {
    ($block:ident.$register:ident.$field:ident) => {{
        const FIELD: &endat_regs::Field =
            endat_regs::$block.field(stringify!($register), stringify!($field));
        FIELD
    }};
}

pub(crate) use {field, word};

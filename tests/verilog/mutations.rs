//! Ways to break the emitted card: one text in one file becomes another.

/// One change of the emitted Verilog.
#[derive(Debug)]
pub struct Mutation {
    /// What it breaks.
    pub name: &'static str,
    /// Block; none is the card's own module.
    pub block: &'static str,
    /// Text that stands there exactly once.
    pub from: &'static str,
    /// What it becomes.
    pub to: &'static str,
}

/// A change.
pub const fn mutation(
    name: &'static str,
    block: &'static str,
    from: &'static str,
    to: &'static str,
) -> Mutation {
    Mutation {
        name,
        block,
        from,
        to,
    }
}

impl Mutation {
    /// The text of its block, broken.
    pub fn applied(&self, text: &str) -> Result<String, String> {
        match text.matches(self.from).count() {
            1 => Ok(text.replace(self.from, self.to)),
            count => Err(format!(
                "{}: {:?} stands {count} times in {}",
                self.name, self.from, self.block
            )),
        }
    }
}

/// All of them.
pub const MUTATIONS: &[Mutation] = &[
    mutation(
        "parallel CRC: wrong constant for 31 bits",
        "crc5_word",
        "CONSTANT_1 = 5'd10;",
        "CONSTANT_1 = 5'd11;",
    ),
    mutation(
        "CRC: its first bit not compared",
        "receiver",
        "crc_fits = crc_bits == crc_calc;",
        "crc_fits = crc_bits[3:0] == crc_calc[3:0];",
    ),
    mutation(
        "one clock pulse fewer",
        "receiver",
        "all_sent = !(|to_send)",
        "all_sent = to_send == 7'd1",
    ),
    mutation(
        "clock pulses on the cable not counted",
        "receiver",
        "to_send_next = to_send - 7'd1",
        "to_send_next = to_send",
    ),
    mutation(
        "driver never released",
        "command_sender",
        "fall & (|cells_left)",
        "fall & (|cells_left[3:1])",
    ),
    mutation(
        "driver on one period too early",
        "command_sender",
        "oe = |cell_now",
        "oe = |cells_left",
    ),
    mutation(
        "mode command shifted by one bit",
        "command_sender",
        "{1'b0, command, 1'b0}",
        "{command, 2'd0}",
    ),
    mutation(
        "sample half a bit off",
        "line_delay",
        "half_tick & !second_half & cells_run",
        "half_tick & second_half & cells_run",
    ),
    mutation(
        "line delay measured too long",
        "line_delay",
        "delay <= since_rise;",
        "delay <= since_rise + 10'd20;",
    ),
    mutation(
        "F2 ignored",
        "verdict",
        "answer_bad = crc_bad | f1 | !f2;",
        "answer_bad = crc_bad | f1;",
    ),
    mutation(
        "wrong cause for a missing start bit",
        "transaction",
        "found = NO_START_BIT;",
        "found = START_WINDOW;",
    ),
    mutation(
        "a bad frame replaces the last good position",
        "snapshot",
        "take_good = publish & good;",
        "take_good = publish;",
    ),
    mutation(
        "hold has no effect",
        "register_bank",
        "blocked_now = reading | hold;",
        "blocked_now = reading;",
    ),
    mutation(
        "channel 1 is not triggered",
        "card_core",
        ".trigger(trigger_of_1),\n        .calibrate(bank_calibrate[1]),",
        ".trigger(1'b0),\n        .calibrate(bank_calibrate[1]),",
    ),
    mutation(
        "words of the position exchanged",
        "channel_registers",
        "word_1 = position[31:0];",
        "word_1 = {16'd0, position[47:32]};",
    ),
    mutation(
        "trigger count at another word",
        "register_bank",
        "TRIGGER_COUNT_AT = 9'd8;",
        "TRIGGER_COUNT_AT = 9'd9;",
    ),
    mutation(
        "trigger overrun not told",
        "verdict",
        "overrun <= 1'b1;",
        "overrun <= 1'b0;",
    ),
];

//! Registers of one channel: the result for the host, and the configuration.
//!
//! ```text
//! channel's result --(load)--> held words, their age counts on --> byte of each word, of the selected word only --> OR --> read_out
//! ring block of the channel --(ring at rest, channel not busy, no trigger)--> configuration of the channel
//! ```
//!
//! One signal loads the held words of all channels, so they belong together; [`crate::card::register_bank`] controls it. Words that are held for longer
//! than a trigger show it: the age counts on, and `stale` reports a later trigger. A byte that is not selected
//! is 0 in its register. So the read path is an OR, and the selection needs only the registers' reset.

use crate::card::config_ring::ConfigRing;
use crate::config::CardConfig;
use crate::ports::{FrameResultIn, PortSettingsOut};
use crate::regs::config_words;
use crate::replicate::each;
use endat_macros::kernel;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

/// Words of a result.
pub const RESULT_WORDS: usize = 6;

/// Host side of one channel.
#[derive(LogicBlock, Block)]
#[properties("../properties/channel_registers.sv")]
pub struct ChannelRegisters {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// The channel's trigger.
    pub trigger: Signal<In, Bit>,
    /// Strobe: a channel takes a trigger; the card no longer waits for results of an earlier trigger.
    pub new_set: Signal<In, Bit>,
    /// A trigger would be lost; the configuration must not change.
    pub busy: Signal<In, Bit>,
    /// Result of a trigger.
    #[bundle]
    pub result: FrameResultIn,
    /// Recovery time, in system clock cycles.
    pub recovery_cycles: Signal<In, Bits<13>>,
    /// Tracked line delay, in system clock cycles.
    pub delay_cycles: Signal<In, Bits<11>>,
    /// The channel takes the trigger.
    pub taken: Signal<Out, Bit>,
    /// The channel took the trigger of the last `new_set`, and its result is still missing.
    pub owes: Signal<Out, Bit>,
    /// Strobe: this result is the missing one.
    pub brought: Signal<Out, Bit>,
    /// The held words follow the result.
    pub load: Signal<In, Bit>,
    /// No read is under way: age and `stale` of the held words are updated.
    pub show: Signal<In, Bit>,
    /// Result words that are not read, one bit per word.
    pub word_skip: Signal<In, Bits<6>>,
    /// Byte of the word, 0 = most significant.
    pub lane: Signal<In, Bits<2>>,
    /// This channel's result is not read.
    pub skip: Signal<In, Bit>,
    /// Read byte of the channels before this one.
    pub read_in: Signal<In, Bits<8>>,
    /// `read_in`, or this channel's byte; 2 cycles after `word_skip`.
    pub read_out: Signal<Out, Bits<8>>,
    /// The configuration ring advances by one byte.
    pub ring_turn: Signal<In, Bit>,
    /// The configuration ring is at rest, its words are in place.
    pub ring_home: Signal<In, Bit>,
    /// Byte from the following ring block, its parity in bit 8.
    pub ring_in: Signal<In, Bits<9>>,
    /// Byte to the previous ring block.
    pub ring_out: Signal<Out, Bits<9>>,
    /// The card's settings differ from the written ones.
    pub card_damaged: Signal<In, Bit>,
    /// Triggers to skip after each accepted one; this and the next output come directly from the ring.
    pub trigger_skip: Signal<Out, Bits<5>>,
    /// Trigger sources that this channel ignores.
    pub ignored_sources: Signal<Out, Bits<3>>,
    /// Settings of one channel, as the host has written them.
    #[bundle]
    pub settings: PortSettingsOut,
    /// T-format: request ID of a trigger.
    pub request_id: Signal<Out, Bits<4>>,
    /// T-format: longest pause between two fields, in microseconds.
    pub field_gap_us: Signal<Out, Bits<3>>,
    /// Current words of the result, for the second interface; none without one.
    pub live: Vec<Signal<Out, Bits<32>>>,
    /// High from a trigger that the channel takes until the result of that trigger.
    waiting: Reg<Bit>,
    /// High if a trigger has come since the last result.
    newer_trigger: Reg<Bit>,
    /// `newer_trigger`, with the trigger or result of this cycle.
    newer_trigger_now: Signal<Local, Bit>,
    /// High if a trigger has come since the trigger of the held result.
    stale: Reg<Bit>,
    /// `stale`, with the trigger or load of this cycle.
    stale_now: Signal<Local, Bit>,
    /// `stale` as the host reads it; frozen while a word is read.
    stale_shown: Reg<Bit>,
    /// Age of the held position in microseconds, up to 65535; loaded with the held words.
    age: Reg<Bits<16>>,
    /// High if the age has its largest value.
    age_full: Reg<Bit>,
    /// High if the age rises by one in this cycle.
    age_tick: Signal<Local, Bit>,
    /// Age with the tick or load of this cycle.
    age_now: Signal<Local, Bits<16>>,
    /// Age as the host reads it; frozen while a word is read.
    age_shown: Reg<Bits<16>>,
    /// Words of the result that the host reads; loaded together for all channels.
    held: Vec<Reg<Bits<32>>>,
    /// Current words of the result of the channel.
    word: Vec<Signal<Local, Bits<32>>>,
    /// Held words, with age and `stale`.
    shown: Vec<Signal<Local, Bits<32>>>,
    /// Selected byte of each held word; 0 for words that are not read.
    byte: Vec<Reg<Bits<8>>>,
    /// OR of these bytes; 0 while this channel is not read.
    read_byte: Reg<Bits<8>>,
    ring: ConfigRing,
    /// Configuration word 0 in use: clock and frame; copied from the ring while the channel is idle.
    #[given]
    config0: Reg<Bits<32>>,
    /// Configuration word 1 in use: timing; copied from the ring while the channel is idle.
    #[given]
    config1: Reg<Bits<32>>,
    /// Configuration word 2 in use: limits; copied from the ring while the channel is idle.
    #[given]
    config2: Reg<Bits<32>>,
    _words: usize,
    _lives: usize,
    _live_ends: usize,
}

impl ChannelRegisters {
    /// The registers of channel `channel` of a card.
    pub fn new(config: &CardConfig, channel: usize) -> Self {
        let words = config_words(config, Some(channel));
        let active = |i: usize| Reg::new(u64::from(words[i]).into());
        let lives = RESULT_WORDS * usize::from(config.safety.second_interface);
        Self::from_parts(ChannelRegistersParts {
            held: each(RESULT_WORDS),
            word: each(RESULT_WORDS),
            shown: each(RESULT_WORDS),
            byte: each(RESULT_WORDS),
            ring: ConfigRing::new(words, config.safety.upset_guards),
            config0: active(0),
            config1: active(1),
            config2: active(2),
            live: each(lives),
            _words: RESULT_WORDS,
            _lives: lives.saturating_sub(1),
            _live_ends: lives,
        })
    }
}

#[kernel]
impl Logic for ChannelRegisters {
    fn update(&mut self) {
        clock!(self, clock, ring);
        self.ring.reset.next = self.reset.val();

        // A trigger that is lost has no separate result.
        if self.result.result_strobe.val() {
            self.waiting.d.next = false;
        }
        self.taken.next = self.trigger.val() & !self.busy.val();
        if self.new_set.val() {
            self.waiting.d.next = self.trigger.val() & !self.busy.val();
        }
        self.owes.next = self.waiting.q.val() & !self.result.result_strobe.val();
        self.brought.next = self.waiting.q.val() & self.result.result_strobe.val();

        // A trigger in the cycle of a result is newer than the result.
        self.newer_trigger_now.next =
            self.trigger.val() | (self.newer_trigger.q.val() & !self.result.result_strobe.val());
        self.newer_trigger.d.next = self.newer_trigger_now.val();
        self.stale_now.next = self.stale.q.val() | self.trigger.val();
        self.age_tick.next = self.tick_us.val() & !self.age_full.q.val();
        self.age_full.d.next = self.age.q.val().get_bits::<15>(1).all()
            & (self.age.q.val().get_bit(0) | self.age_tick.val());
        self.age_now.next = self.age.q.val() + bit_cast::<16, 1>(self.age_tick.val().into());
        // After the adder, because `load` arrives late in the cycle.
        if self.load.val() {
            self.stale_now.next = self.newer_trigger_now.val();
            self.age_now.next = self.result.age_us.val();
            self.age_full.d.next = self.result.age_us.val().all();
        }
        self.stale.d.next = self.stale_now.val();
        self.age.d.next = self.age_now.val();
        if self.show.val() {
            self.stale_shown.d.next = self.stale_now.val();
            self.age_shown.d.next = self.age_now.val();
        }

        self.word[0].next = place!(self.result.sequence.val(), result.status.sequence)
            | place!(self.result.cause.val(), result.status.cause)
            | place!(self.result.position_valid.val(), result.status.valid)
            | place!(self.result.fresh.val(), result.status.fresh)
            | place!(
                self.result.flags.val().get_bits::<8>(12),
                result.status.line
            );
        self.word[1].next = self.result.position.val().get_bits::<32>(0);
        // A good position has F1 = 0 and, in EnDat 2.2, F2 = 1: one bit for the presence of F2 is enough.
        self.word[2].next = place!(
            self.result.position.val().get_bits::<16>(32),
            result.position_high.value
        ) | place!(self.result.position_crc.val(), result.position_high.crc)
            | place!(self.result.position_has_f2.val(), result.position_high.f2)
            | place!(self.result.position_width.val(), result.position_high.width);
        self.word[3].next = self.result.first_fall_timestamp.val();
        self.word[4].next = place!(self.result.crc_received.val(), result.evidence.crc_received)
            | place!(self.result.crc_computed.val(), result.evidence.crc_computed)
            | place!(
                self.delay_cycles.val().get_bits::<10>(0),
                result.evidence.delay_cycles
            )
            | place!(
                self.result.flags.val().get_bits::<12>(0),
                result.evidence.flags
            );
        self.word[5].next = place!(
            self.recovery_cycles.val(),
            result.age_recovery.recovery_cycles
        ) | place!(
            self.delay_cycles.val().get_bit(10),
            result.age_recovery.delay_high
        );
        for i in 0..self._lives {
            self.live[i].next = self.word[i].val();
        }
        for i in self._lives..self._live_ends {
            self.live[i].next = self.word[i].val()
                | place!(self.result.age_us.val(), result.age_recovery.age_us)
                | place!(self.newer_trigger_now.val(), result.age_recovery.stale);
        }
        for i in 0..self._words {
            connect!(self.held[i] <= self; clock, reset);
            self.held[i].d.next = self.held[i].q.val();
            if self.load.val() {
                self.held[i].d.next = self.word[i].val();
            }
            self.shown[i].next = self.held[i].q.val();
        }
        self.shown[5].next = self.held[5].q.val()
            | place!(self.age_shown.q.val(), result.age_recovery.age_us)
            | place!(self.stale_shown.q.val(), result.age_recovery.stale);
        for i in 0..self._words {
            self.byte[i].clock.next = self.clock.val();
            // A reset by deselection alone takes no logic; content that only a card reset would clear is never shown.
            self.byte[i].reset.next = self.word_skip.val().get_bit(i);
            match self.lane.val().index() {
                0 => {
                    self.byte[i].d.next = self.shown[i].val().get_bits::<8>(24);
                }
                1 => {
                    self.byte[i].d.next = self.shown[i].val().get_bits::<8>(16);
                }
                2 => {
                    self.byte[i].d.next = self.shown[i].val().get_bits::<8>(8);
                }
                _ => {
                    self.byte[i].d.next = self.shown[i].val().get_bits::<8>(0);
                }
            }
        }
        self.read_byte.reset.next = self.skip.val();
        self.read_byte.d.next = self.byte[0].q.val()
            | self.byte[1].q.val()
            | self.byte[2].q.val()
            | self.byte[3].q.val()
            | self.byte[4].q.val()
            | self.byte[5].q.val();
        self.read_out.next = self.read_in.val() | self.read_byte.q.val();

        connect!(self.ring <= self; turn = ring_turn, byte_in = ring_in);
        self.ring_out.next = self.ring.byte_out.val();
        // Not in the cycle of a trigger either: its frame uses the settings that were checked with it.
        if self.ring_home.val() & !self.busy.val() & !self.trigger.val() {
            self.config0.d.next = self.ring.word0.val();
            self.config1.d.next = self.ring.word1.val();
            self.config2.d.next = self.ring.word2.val();
        }
        self.trigger_skip.next = field!(self.ring.word0.val(), config.frame.skip);
        self.ignored_sources.next =
            bit_cast::<3, 1>(field!(self.ring.word0.val(), config.frame.ignore_pin).into())
                | (bit_cast::<3, 1>(
                    field!(self.ring.word0.val(), config.frame.ignore_timer).into(),
                ) << 1)
                | (bit_cast::<3, 1>(
                    field!(self.ring.word0.val(), config.frame.ignore_register).into(),
                ) << 2);
        self.settings.period_cycles.next = field!(self.config0.q.val(), config.frame.period_cycles);
        self.settings.position_bits.next = field!(self.config0.q.val(), config.frame.position_bits);
        self.settings.first_low_extra_cycles.next =
            field!(self.config1.q.val(), config.timing.first_low_extra_cycles);
        self.settings.start_window_cycles.next =
            field!(self.config1.q.val(), config.timing.start_window_cycles);
        self.settings.filter_cycles.next =
            field!(self.config1.q.val(), config.timing.filter_cycles);
        self.settings.filter_half.next = field!(self.config1.q.val(), config.timing.filter_half);
        self.field_gap_us.next = field!(self.config2.q.val(), config.limits.field_gap_us);
        self.settings.start_timeout_us.next =
            field!(self.config2.q.val(), config.limits.start_timeout_us);
        self.settings.recovery_limit_cycles.next =
            field!(self.config2.q.val(), config.limits.recovery_limit_cycles);

        // A channel with corrupted settings sends no command: these codes are invalid.
        self.settings.command.next = field!(self.config0.q.val(), config.frame.command);
        self.request_id.next = field!(self.config1.q.val(), config.timing.request_id);
        if self.ring.is_damaged.val() | self.card_damaged.val() {
            self.settings.command.next = 0.into();
            self.request_id.next = 15.into();
        }
    }
}

#[cfg(test)]
mod tests;

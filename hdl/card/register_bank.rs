//! Register bank: the card's own words, and the decoder in front of all words.
//!
//! ```text
//! access, word_address, lane --> turning: one turn of the configuration ring; other words: until their byte is there --> done
//!                                   |
//!        constants ---------+       +-- the byte passing the head is read, or replaced by the one to write
//!        trigger count -----+
//!        ring byte ---------OR--> read_byte
//!        results of channels+
//! ```
//!
//! **A front cannot turn the ring by half, nor write elsewhere.** Address and direction of an access are taken with `access` and stand until
//! `done`; an access that comes before is not begun. Only which byte is shown follows the front: whoever changes the address reads something else.
//!
//! Results of all channels are held together. They follow the channels, but not while they are being read or the host holds them, and not from
//! the first to the last result of a trigger: half of it is new, the other half is not.
//!
//! The wait for the last result ends with the next trigger that a channel takes: with channels that are never ready together it would have no
//! end. For a host that reads in step with the triggers, so that there never is a moment between two reads in which the words may follow,
//! they follow as the read begins, if the second trigger has come by then. See `docs/host-link.md`.

use crate::card::config_ring::{ConfigRing, RING_BYTES};
use crate::card::ports::{AccessIn, ServiceWordsOut};
use crate::config::CardConfig;
use crate::regs::{config_words, start, CARD};
use rtl_design::{reg::Reg, Block};
use rust_hdl::prelude::*;

/// Decoder and card registers.
#[derive(LogicBlock, Block)]
#[properties("../properties/register_bank.sv")]
pub struct RegisterBank {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// A front's access to the register bank.
    #[bundle]
    pub front: AccessIn,
    /// One-cycle strobe: the access begins, in the cycle of `access`.
    pub begins: Signal<Out, Bit>,
    /// Word address of the access that begins or is being carried out.
    pub address: Signal<Out, Bits<11>>,
    /// Its `in_range`.
    pub is_inside: Signal<Out, Bit>,
    /// Strobe: a channel takes a trigger.
    pub taken: Signal<In, Bit>,
    /// A channel owes a result of the last trigger that was taken.
    pub owes: Signal<In, Bit>,
    /// Strobe: a channel has brought its result of that trigger.
    pub brought: Signal<In, Bit>,
    /// The held results follow the channels.
    pub load: Signal<Out, Bit>,
    /// Nothing is being read: age and `stale` of the held results go on.
    pub show: Signal<Out, Bit>,
    /// Result words that are not read, one bit per word.
    pub word_skip: Signal<Out, Bits<6>>,
    /// Channels whose results are not read, one bit per channel.
    pub channel_skip: Signal<Out, Bits<8>>,
    /// Result byte of the channels.
    pub channel_byte: Signal<In, Bits<8>>,
    /// The configuration ring moves on by one byte.
    pub ring_turn: Signal<Out, Bit>,
    /// The configuration ring stands still.
    pub ring_home: Signal<Out, Bit>,
    /// Byte from the first channel's ring block, its parity in bit 8.
    pub ring_in: Signal<In, Bits<9>>,
    /// Byte to the last channel's ring block.
    pub ring_out: Signal<Out, Bits<9>>,
    /// The card's own settings are not what was written.
    pub is_damaged: Signal<Out, Bit>,
    /// Words that are not the bank's own.
    #[bundle]
    pub service: ServiceWordsOut,
    /// The word is one of the stream's four.
    pub stream_selected: Signal<Out, Bit>,
    /// Byte that was read from the words of stream, direct outputs and interrupt; 0 if it is none of them.
    pub part_byte: Signal<In, Bits<8>>,
    /// Triggers since reset.
    pub trigger_count: Signal<In, Bits<32>>,
    /// Strobe: trigger now.
    pub trigger_now: Signal<Out, Bit>,
    /// Strobe, one bit per channel: measure the line delay again.
    pub calibrate: Signal<Out, Bits<8>>,
    /// Enabled trigger sources.
    pub sources: Signal<Out, Bits<3>>,
    /// Channels that take no trigger, as they stand on the ring.
    pub disabled: Signal<Out, Bits<8>>,
    /// Strobe: a word with settings of triggers has been written.
    pub restart: Signal<Out, Bit>,
    /// Period of the trigger timer.
    pub period_cycles: Signal<Out, Bits<24>>,
    ring: ConfigRing,
    held_address: Reg<Bits<11>>,
    held_inside: Reg<Bit>,
    line_selected: Reg<Bit>,
    turning: Reg<Bit>,
    byte_at: Reg<Bits<4>>,
    block_at: Reg<Bits<4>>,
    turn: Reg<Bit>,
    passes: Reg<Bit>,
    byte_passes: Reg<Bit>,
    ended: Reg<Bit>,
    done_now: Reg<Bit>,
    write_now: Reg<Bit>,
    config_page: Reg<Bit>,
    #[start(0x3fu64.into())]
    skipped_words: Reg<Bits<6>>,
    #[start(0xffu64.into())]
    skipped_channels: Reg<Bits<8>>,
    #[start(true)]
    rom_skip: Reg<Bit>,
    #[start(true)]
    count_skip: Reg<Bit>,
    rom_byte: Reg<Bits<8>>,
    count_held: Reg<Bits<32>>,
    count_byte: Reg<Bits<8>>,
    ring_byte: Reg<Bits<8>>,
    byte: Reg<Bits<8>>,
    trigger_strobe: Reg<Bit>,
    calibrate_strobe: Reg<Bits<8>>,
    #[given]
    active_sources: Reg<Bits<3>>,
    #[given]
    active_period: Reg<Bits<24>>,
    hold: Reg<Bit>,
    #[start(true)]
    blocked: Reg<Bit>,
    #[start(true)]
    read_before: Reg<Bit>,
    mixed: Reg<Bit>,
    one_gone: Reg<Bit>,
    overdue: Reg<Bit>,
    blocked_now: Signal<Local, Bit>,
    mixed_now: Signal<Local, Bit>,
    load_now: Signal<Local, Bit>,
    #[start(true)]
    service_skip: Reg<Bit>,
    service_byte: Reg<Bits<8>>,
    service_selected: Reg<Bits<8>>,
    service_first: Reg<Bit>,
    busy: Signal<Local, Bit>,
    starts: Signal<Local, Bit>,
    low_page: Signal<Local, Bit>,
    low_address: Signal<Local, Bits<9>>,
    service_page: Signal<Local, Bit>,
    at_end: Signal<Local, Bit>,
    whole_turn: Signal<Local, Bit>,
    at_word: Signal<Local, Bit>,
    block_end: Signal<Local, Bit>,
    card_page: Signal<Local, Bit>,
    strobe: Signal<Local, Bit>,
    result_page: Signal<Local, Bit>,
    written: Signal<Local, Bits<8>>,
    head: Signal<Local, Bits<9>>,
    has_guards: Constant<Bit>,
    rom_word: Signal<Local, Bits<32>>,
    has_service: Constant<Bit>,
    has_line: Constant<Bit>,
    has_others: Constant<Bit>,
    other_channels: Constant<Bits<8>>,
    endat_channels: Constant<Bits<8>>,
    line_page: Signal<Local, Bit>,
    port_page: Signal<Local, Bit>,
    word_page: Signal<Local, Bit>,
    selected: Signal<Local, Bits<8>>,
    protocols: Constant<Bits<32>>,
    service_channel: Signal<Local, Bits<3>>,
    id: Constant<Bits<32>>,
    version: Constant<Bits<32>>,
    capabilities: Constant<Bits<32>>,
    system_hz: Constant<Bits<32>>,
    configuration_hash: Constant<Bits<32>>,
    last_block: Constant<Bits<4>>,
    trigger_count_at: Constant<Bits<9>>,
    trigger_now_at: Constant<Bits<9>>,
    calibrate_at: Constant<Bits<9>>,
}

/// Bytes of the configuration ring of a card with `channels` channels; an access takes that many cycles and a few.
pub const fn ring_bytes(channels: usize) -> usize {
    RING_BYTES * (channels + 1)
}

/// Start value of one of the card's words.
fn card_word(config: &CardConfig, name: &str) -> Constant<Bits<32>> {
    let value = CARD
        .register(name)
        .map_or(0, |r| start(&CARD, r, config, 0));
    Constant::new(u64::from(value).into())
}

/// Address of one of the card's words.
fn card_address(name: &str) -> Constant<Bits<9>> {
    let address = CARD.register(name).map_or(0, |r| CARD.address(r, 0));
    Constant::new(u64::from(address).into())
}

impl RegisterBank {
    /// The bank of a card.
    pub fn new(config: &CardConfig) -> Self {
        let words = config_words(config, None);
        let others = (0..).zip(&config.channels).filter(|(_, c)| !c.is_endat());
        let other_channels = others.fold(0u64, |mask, (n, _)| mask | 1 << n);
        Self::from_parts(RegisterBankParts {
            active_sources: Reg::new(u64::from(words[0] & 7).into()),
            active_period: Reg::new(u64::from(words[1]).into()),
            has_guards: Constant::new(config.safety.upset_guards),
            ring: ConfigRing::new(words, config.safety.upset_guards),
            has_service: Constant::new(config.service.requests),
            has_line: Constant::new(config.line.alignment),
            has_others: Constant::new(other_channels != 0),
            other_channels: Constant::new(other_channels.into()),
            endat_channels: Constant::new((!other_channels & 0xff).into()),
            protocols: card_word(config, "protocols"),
            id: card_word(config, "id"),
            version: card_word(config, "version"),
            capabilities: card_word(config, "capabilities"),
            system_hz: card_word(config, "system_hz"),
            configuration_hash: card_word(config, "configuration_hash"),
            last_block: Constant::new((config.channels.len() as u64).into()),
            trigger_count_at: card_address("trigger_count"),
            trigger_now_at: card_address("trigger_now"),
            calibrate_at: card_address("calibrate"),
        })
    }
}

mod kernel;

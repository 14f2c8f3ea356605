//! Register bank: the card's own words, and the decoder for all words.
//!
//! ```text
//! access, word_address, lane --> turning: one turn of the configuration ring; other words: until their byte is ready --> done
//!                                   |
//!        constants ---------+       +-- the byte passing the head is read, or replaced by the one to write
//!        trigger count -----+
//!        ring byte ---------OR--> read_byte
//!        results of channels+
//! ```
//!
//! **A front cannot stop the ring half way, nor write elsewhere.** Address and direction of an access are latched with `access` and kept until
//! `done`; an earlier access is ignored. Only the selected byte follows the front: a front that changes the address reads another byte.
//!
//! Results of all channels are held together. They follow the channels, except while they are read or the host holds them, and
//! between the first and the last result of a trigger, when only some of them are new.
//!
//! The wait for the last result ends with the next trigger that a channel takes; if the channels are never ready together it would not
//! end. A host that reads in step with the triggers might always block the update between two reads.
//! So the results are updated at the start of a read if the second trigger has come by then. See `docs/host-link.md`.

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
    /// One-cycle strobe: an access begins, in the cycle of `access`.
    pub begins: Signal<Out, Bit>,
    /// Word address of the access that begins or is under way.
    pub address: Signal<Out, Bits<11>>,
    /// `in_range` of the access.
    pub is_inside: Signal<Out, Bit>,
    /// Strobe: a channel takes a trigger.
    pub taken: Signal<In, Bit>,
    /// A result of the last accepted trigger is missing.
    pub owes: Signal<In, Bit>,
    /// Strobe: a channel has delivered its result of that trigger.
    pub brought: Signal<In, Bit>,
    /// The held results follow the channels.
    pub load: Signal<Out, Bit>,
    /// No read is under way: age and `stale` of the held results are updated.
    pub show: Signal<Out, Bit>,
    /// Result words that are not read, one bit per word.
    pub word_skip: Signal<Out, Bits<6>>,
    /// Channels whose results are not read, one bit per channel.
    pub channel_skip: Signal<Out, Bits<8>>,
    /// Result byte of the channels.
    pub channel_byte: Signal<In, Bits<8>>,
    /// The configuration ring advances by one byte.
    pub ring_turn: Signal<Out, Bit>,
    /// The configuration ring is at rest.
    pub ring_home: Signal<Out, Bit>,
    /// Byte from the first channel's ring block, its parity in bit 8.
    pub ring_in: Signal<In, Bits<9>>,
    /// Byte to the last channel's ring block.
    pub ring_out: Signal<Out, Bits<9>>,
    /// The card's settings differ from the written ones.
    pub is_damaged: Signal<Out, Bit>,
    /// Access to words of services, line monitors and ports of other protocols.
    #[bundle]
    pub service: ServiceWordsOut,
    /// The word belongs to the stream.
    pub stream_selected: Signal<Out, Bit>,
    /// Byte read from the words of stream, direct outputs and interrupt; 0 for other words.
    pub part_byte: Signal<In, Bits<8>>,
    /// Triggers since reset.
    pub trigger_count: Signal<In, Bits<32>>,
    /// Strobe: trigger now.
    pub trigger_now: Signal<Out, Bit>,
    /// Strobe, one bit per channel: measure the line delay again.
    pub calibrate: Signal<Out, Bits<8>>,
    /// Enabled trigger sources.
    pub sources: Signal<Out, Bits<3>>,
    /// Channels that ignore triggers, directly from the ring.
    pub disabled: Signal<Out, Bits<8>>,
    /// Strobe: a word with trigger settings has been written.
    pub restart: Signal<Out, Bit>,
    /// Period of the trigger timer.
    pub period_cycles: Signal<Out, Bits<24>>,
    ring: ConfigRing,
    /// Word address of the access under way; follows the front while no access runs.
    held_address: Reg<Bits<11>>,
    /// High if `held_address` is an address of the register map.
    held_inside: Reg<Bit>,
    /// High if the word of the access belongs to a line monitor or a port of another protocol.
    line_selected: Reg<Bit>,
    /// High from the start of an access until its last byte has passed or its byte is ready.
    turning: Reg<Bit>,
    /// Byte of the ring block that is next at the head, 0 to 11; 0 while no access runs.
    byte_at: Reg<Bits<4>>,
    /// Block of the ring that is next at the head: 0 = the card, n + 1 = channel n.
    block_at: Reg<Bits<4>>,
    /// High while the ring turns: one cycle after `turning`, for accesses that need a whole turn.
    turn: Reg<Bit>,
    /// High while a byte of the accessed configuration word is at the head.
    passes: Reg<Bit>,
    /// High while the byte of `passes` is the byte that the front selects.
    byte_passes: Reg<Bit>,
    /// High for one cycle after the last cycle of `turning`.
    ended: Reg<Bit>,
    /// High for one cycle when the access has ended, a cycle after `ended`.
    done_strobe: Reg<Bit>,
    /// High if the access under way is a write; set or cleared when an access starts.
    is_write: Reg<Bit>,
    /// High if the accessed word is a configuration word on the ring.
    config_page: Reg<Bit>,
    /// Result words that are not read, one bit each; low for the selected word only.
    #[start(0x3fu64.into())]
    skipped_words: Reg<Bits<6>>,
    /// Channels whose results are not read, one bit each; low for the selected channel only.
    #[start(0xffu64.into())]
    skipped_channels: Reg<Bits<8>>,
    /// High unless the front's address is one of the card's constant words.
    #[start(true)]
    rom_skip: Reg<Bit>,
    /// High unless the front's address is the word `trigger_count`.
    #[start(true)]
    count_skip: Reg<Bit>,
    /// Selected byte of the constant word; 0 while `rom_skip` is high.
    rom_byte: Reg<Bits<8>>,
    /// Trigger count of the held results; loaded together with them.
    count_held: Reg<Bits<32>>,
    /// Selected byte of `count_held`; 0 while `count_skip` is high.
    count_byte: Reg<Bits<8>>,
    /// Configuration byte that was read; cleared when an access starts.
    ring_byte: Reg<Bits<8>>,
    /// Byte that the front reads: OR of all sources, of which at most one is not 0.
    byte: Reg<Bits<8>>,
    /// High for one cycle after a write of the trigger bit.
    trigger_strobe: Reg<Bit>,
    /// One bit per channel, high for one cycle after a write of the word `calibrate`.
    calibrate_strobe: Reg<Bits<8>>,
    /// Enabled trigger sources; copied from the ring while it is at rest.
    #[given]
    active_sources: Reg<Bits<3>>,
    /// Period of the trigger timer; copied from the ring while it is at rest.
    #[given]
    active_period: Reg<Bits<24>>,
    /// High while the host holds the results; copied from the ring while it is at rest.
    hold: Reg<Bit>,
    /// `blocked_now` of the cycle before: high while the host reads or holds results.
    #[start(true)]
    blocked: Reg<Bit>,
    /// `reading` of the cycle before.
    #[start(true)]
    read_before: Reg<Bit>,
    /// High from the first to the last result of a trigger; cleared by the next trigger.
    mixed: Reg<Bit>,
    /// High if a trigger has been taken since the held results were last loaded.
    one_gone: Reg<Bit>,
    /// High if two triggers have been taken since the held results were last loaded.
    overdue: Reg<Bit>,
    /// High while the host reads or holds results: these must not change.
    blocked_now: Signal<Local, Bit>,
    /// High while some results of the last trigger have come and others are missing.
    mixed_now: Signal<Local, Bit>,
    /// High in each cycle in which the held results follow the channels.
    load_now: Signal<Local, Bit>,
    /// High unless the word belongs to a service, a line monitor or a port of another protocol.
    #[start(true)]
    service_skip: Reg<Bit>,
    /// Selected byte of the service word; 0 while `service_skip` is high.
    service_byte: Reg<Bits<8>>,
    /// Channel of the accessed service word, one bit per channel; 0 if the channel has no such word.
    service_selected: Reg<Bits<8>>,
    /// High in the first cycle after an access has started.
    service_first: Reg<Bit>,
    /// High while an access runs: a new one is ignored.
    busy: Signal<Local, Bit>,
    /// High for one cycle when an access starts.
    starts: Signal<Local, Bit>,
    /// High if the front's address is below 0x200.
    low_page: Signal<Local, Bit>,
    /// Low nine bits of the front's word address.
    low_address: Signal<Local, Bits<9>>,
    /// High if the front's address belongs to a service.
    service_page: Signal<Local, Bit>,
    /// High in the last cycle of `turning`: the turn is complete, or the byte is ready.
    at_end: Signal<Local, Bit>,
    /// High if the access needs a whole turn of the ring, or the time of one.
    whole_turn: Signal<Local, Bit>,
    /// High while the counters are at a byte of the accessed configuration word.
    at_word: Signal<Local, Bit>,
    /// High while `byte_at` is at the last byte of a block.
    block_end: Signal<Local, Bit>,
    /// High if the front's address is one of the card's first 16 words.
    card_page: Signal<Local, Bit>,
    /// High for one cycle when a write to one of the low words starts.
    strobe: Signal<Local, Bit>,
    /// High if the front's address is a word of a channel's result.
    result_page: Signal<Local, Bit>,
    /// Byte of the word to write that is next.
    written: Signal<Local, Bits<8>>,
    /// Byte that goes to the end of the ring: the one from its front, or the written one; parity in bit 8.
    head: Signal<Local, Bits<9>>,
    /// 1 if configuration bytes have parities.
    has_guards: Constant<Bit>,
    /// Constant word that the held address selects; 0 if it selects none.
    rom_word: Signal<Local, Bits<32>>,
    /// 1 if the card has services.
    has_service: Constant<Bit>,
    /// 1 if the card has line monitors.
    has_line: Constant<Bit>,
    /// 1 if a channel has another protocol than EnDat.
    has_others: Constant<Bit>,
    /// Channels with another protocol than EnDat, one bit per channel.
    other_channels: Constant<Bits<8>>,
    /// EnDat channels, one bit per channel.
    endat_channels: Constant<Bits<8>>,
    /// High if the front's address belongs to a line monitor.
    line_page: Signal<Local, Bit>,
    /// High if the front's address belongs to a port of another protocol.
    port_page: Signal<Local, Bit>,
    /// High if the front's address belongs to a service, a line monitor or a port of another protocol.
    word_page: Signal<Local, Bit>,
    /// Channel that the front's address selects in these pages, one bit per channel.
    selected: Signal<Local, Bits<8>>,
    /// Word `protocols`.
    protocols: Constant<Bits<32>>,
    /// Number of the channel that the front's address selects in these pages.
    service_channel: Signal<Local, Bits<3>>,
    /// Word `id`.
    id: Constant<Bits<32>>,
    /// Word `version`.
    version: Constant<Bits<32>>,
    /// Word `capabilities`.
    capabilities: Constant<Bits<32>>,
    /// Word `system_hz`.
    system_hz: Constant<Bits<32>>,
    /// Word `configuration_hash`.
    configuration_hash: Constant<Bits<32>>,
    /// Number of the last block on the ring, that of the last channel.
    last_block: Constant<Bits<4>>,
    /// Address of the word `trigger_count`.
    trigger_count_at: Constant<Bits<9>>,
    /// Address of the word `trigger_now`.
    trigger_now_at: Constant<Bits<9>>,
    /// Address of the word `calibrate`.
    calibrate_at: Constant<Bits<9>>,
}

/// Bytes of the configuration ring of a card with `channels` channels; an access takes slightly more cycles than that.
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

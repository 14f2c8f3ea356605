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
use endat_macros::kernel;
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
    rom_word: Signal<Local, Bits<32>>,
    has_service: Constant<Bit>,
    has_line: Constant<Bit>,
    has_t_format: Constant<Bit>,
    t_format_channels: Constant<Bits<8>>,
    endat_channels: Constant<Bits<8>>,
    line_page: Signal<Local, Bit>,
    t_format_page: Signal<Local, Bit>,
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
        let t_format_channels = config.t_format_channels();
        Self::from_parts(RegisterBankParts {
            active_sources: Reg::new(u64::from(words[0] & 7).into()),
            active_period: Reg::new(u64::from(words[1]).into()),
            ring: ConfigRing::new(words),
            has_service: Constant::new(config.service.requests),
            has_line: Constant::new(config.line.alignment),
            has_t_format: Constant::new(t_format_channels != 0),
            t_format_channels: Constant::new(t_format_channels.into()),
            endat_channels: Constant::new((!t_format_channels & 0xff).into()),
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

impl Logic for RegisterBank {
    #[kernel]
    fn update(&mut self) {
        clock!(self, clock, ring);
        self.ring.reset.next = self.reset.val();
        // A reset by deselection takes no logic.
        self.rom_byte.reset.next = self.rom_skip.q.val();
        self.count_byte.reset.next = self.count_skip.q.val();
        self.service_byte.reset.next = self.service_skip.q.val();

        // What an access is stands from its begin to its end, whatever the front shows.
        self.busy.next = self.turning.q.val() | self.ended.q.val();
        self.starts.next = self.front.access.val() & !self.busy.val();
        if !self.busy.val() {
            self.held_address.d.next = self.front.word_address.val();
            self.held_inside.d.next = self.front.in_range.val();
        }
        self.begins.next = self.starts.val();
        self.address.next = self.held_address.q.val();
        self.is_inside.next = self.held_inside.q.val();

        // One turn for a configuration word. The counters run one cycle ahead of the ring, so that comparing them has a cycle of its own.
        // They also time the halves of a written RAM word; everything else ends as soon as its byte is there.
        self.whole_turn.next =
            self.config_page.q.val() | (self.write_now.q.val() & !self.service_skip.q.val());
        self.block_end.next = self.byte_at.q.val() == 11;
        self.at_end.next = self.block_end.val() & (self.block_at.q.val() == self.last_block.val());
        if !self.whole_turn.val() {
            // The first byte of a RAM word waits for the RAM.
            self.at_end.next = self.service_skip.q.val()
                | self.front.lane.val().any()
                | (self.byte_at.q.val() == 9);
        }
        if self.turning.q.val() {
            self.byte_at.d.next = self.byte_at.q.val() + 1;
            if self.block_end.val() {
                self.byte_at.d.next = 0.into();
                self.block_at.d.next = self.block_at.q.val() + 1;
            }
            if self.at_end.val() {
                self.turning.d.next = false;
            }
        } else {
            self.byte_at.d.next = 0.into();
            self.block_at.d.next = 0.into();
        }
        if self.starts.val() {
            self.turning.d.next = true;
            self.write_now.d.next = self.front.write.val();
        }
        self.turn.d.next = self.turning.q.val() & self.whole_turn.val();
        self.ended.d.next = self.turning.q.val() & self.at_end.val();
        self.done_now.d.next = self.ended.q.val();
        self.ring_turn.next = self.turn.q.val();
        self.ring_home.next = !self.turn.q.val();
        self.front.done.next = self.done_now.q.val();

        self.low_page.next =
            self.front.in_range.val() & !self.front.word_address.val().get_bits::<2>(9).any();
        self.low_address.next = self.front.word_address.val().get_bits::<9>(0);

        // Configuration: the ring carries 3 of the 8 words that a block has room for.
        if !self.busy.val() {
            self.config_page.d.next = self.low_page.val()
                & self.front.word_address.val().get_bit(8)
                & !self.front.word_address.val().get_bit(7)
                & !self.front.word_address.val().get_bit(2);
        }
        self.at_word.next = self.turning.q.val()
            & self.config_page.q.val()
            & (self.block_at.q.val() == self.held_address.q.val().get_bits::<4>(3))
            & (self.byte_at.q.val().get_bits::<2>(2) == self.held_address.q.val().get_bits::<2>(0));
        self.passes.d.next = self.at_word.val();
        self.byte_passes.d.next =
            self.at_word.val() & (self.byte_at.q.val().get_bits::<2>(0) == self.front.lane.val());
        self.written.next = self.front.write_data.val().get_bits::<8>(24);
        self.head.next = self.ring.byte_out.val();
        if self.passes.q.val() & self.write_now.q.val() {
            self.head.next = bit_cast::<9, 8>(self.written.val())
                | (bit_cast::<9, 1>(self.written.val().xor().into()) << 8);
        }
        if self.byte_passes.q.val() {
            self.ring_byte.d.next = self.ring.byte_out.val().get_bits::<8>(0);
        }
        if self.starts.val() {
            self.ring_byte.d.next = 0.into();
        }
        self.front.take_byte.next = self.passes.q.val();
        self.front.passing_byte.next = self.ring.byte_out.val().get_bits::<8>(0);
        self.ring.turn.next = self.turn.q.val();
        self.ring.byte_in.next = self.ring_in.val();
        self.ring_out.next = self.head.val();
        self.is_damaged.next = self.ring.is_damaged.val();

        // The card's own words.
        self.card_page.next =
            self.low_page.val() & !self.front.word_address.val().get_bits::<5>(4).any();
        self.stream_selected.next =
            self.card_page.val() & self.front.word_address.val().get_bits::<2>(2).all();
        self.rom_word.next = 0.into();
        match self.held_address.q.val().get_bits::<3>(0).index() {
            0 => {
                self.rom_word.next = self.id.val();
            }
            1 => {
                self.rom_word.next = self.version.val();
            }
            2 => {
                self.rom_word.next = self.capabilities.val();
            }
            3 => {
                self.rom_word.next = self.system_hz.val();
            }
            4 => {
                self.rom_word.next = self.configuration_hash.val();
            }
            5 => {
                self.rom_word.next = self.protocols.val();
            }
            _ => {}
        }
        match self.front.lane.val().index() {
            0 => {
                self.rom_byte.d.next = self.rom_word.val().get_bits::<8>(24);
                self.count_byte.d.next = self.count_held.q.val().get_bits::<8>(24);
            }
            1 => {
                self.rom_byte.d.next = self.rom_word.val().get_bits::<8>(16);
                self.count_byte.d.next = self.count_held.q.val().get_bits::<8>(16);
            }
            2 => {
                self.rom_byte.d.next = self.rom_word.val().get_bits::<8>(8);
                self.count_byte.d.next = self.count_held.q.val().get_bits::<8>(8);
            }
            _ => {
                self.rom_byte.d.next = self.rom_word.val().get_bits::<8>(0);
                self.count_byte.d.next = self.count_held.q.val().get_bits::<8>(0);
            }
        }
        self.rom_skip.d.next = !self.card_page.val() | self.front.word_address.val().get_bit(3);
        self.count_skip.d.next =
            !self.low_page.val() | (self.low_address.val() != self.trigger_count_at.val());
        self.strobe.next = self.starts.val() & self.front.write.val() & self.low_page.val();
        self.trigger_strobe.d.next = self.strobe.val()
            & (self.low_address.val() == self.trigger_now_at.val())
            & self.front.write_data.val().get_bit(0);
        self.calibrate_strobe.d.next = 0.into();
        if self.strobe.val() & (self.low_address.val() == self.calibrate_at.val()) {
            self.calibrate_strobe.d.next =
                field!(self.front.write_data.val(), card.calibrate.channels);
        }
        self.trigger_now.next = self.trigger_strobe.q.val();
        self.calibrate.next = self.calibrate_strobe.q.val();
        if !self.turn.q.val() {
            self.active_sources.d.next = self.ring.word0.val().get_bits::<3>(0);
            self.active_period.d.next =
                field!(self.ring.word1.val(), card_config.trigger_period.value);
            self.hold.d.next = field!(self.ring.word2.val(), card_config.hold.hold);
        }
        self.sources.next = self.active_sources.q.val();
        self.disabled.next = field!(self.ring.word0.val(), card_config.trigger_sources.disabled);
        // In the cycle in which they are taken over: the first words of card and channels.
        self.restart.next = self.done_now.q.val()
            & self.write_now.q.val()
            & self.config_page.q.val()
            & !self.front.word_address.val().get_bits::<2>(0).any();
        self.period_cycles.next = self.active_period.q.val();

        // Results.
        // Reading blocks a cycle late: the first byte is read later still.
        self.read_before.d.next = self.front.reading.val();
        self.show.next = !self.read_before.q.val();
        self.blocked_now.next = self.front.reading.val() | self.hold.q.val();
        self.blocked.d.next = self.blocked_now.val();
        self.mixed_now.next = self.owes.val() & (self.brought.val() | self.mixed.q.val());
        self.mixed.d.next = self.mixed_now.val() & !self.taken.val();
        self.load_now.next = !self.blocked.q.val()
            & (!self.mixed_now.val() | (self.blocked_now.val() & self.overdue.q.val()));
        if self.load_now.val() {
            self.one_gone.d.next = false;
            self.overdue.d.next = false;
        }
        if self.taken.val() {
            self.one_gone.d.next = true;
            self.overdue.d.next = self.one_gone.q.val() & !self.load_now.val();
        }
        self.load.next = self.load_now.val();
        if self.load_now.val() {
            self.count_held.d.next = self.trigger_count.val();
        }
        self.result_page.next =
            self.low_page.val() & self.front.word_address.val().get_bits::<2>(7).all();
        self.skipped_words.d.next = 63.into();
        match self.front.word_address.val().get_bits::<3>(0).index() {
            0 => {
                self.skipped_words.d.next = 62.into();
            }
            1 => {
                self.skipped_words.d.next = 61.into();
            }
            2 => {
                self.skipped_words.d.next = 59.into();
            }
            3 => {
                self.skipped_words.d.next = 55.into();
            }
            4 => {
                self.skipped_words.d.next = 47.into();
            }
            5 => {
                self.skipped_words.d.next = 31.into();
            }
            _ => {}
        }
        self.skipped_channels.d.next = 255.into();
        if self.result_page.val() {
            match self.front.word_address.val().get_bits::<4>(3).index() {
                0 => {
                    self.skipped_channels.d.next = 254.into();
                }
                1 => {
                    self.skipped_channels.d.next = 253.into();
                }
                2 => {
                    self.skipped_channels.d.next = 251.into();
                }
                3 => {
                    self.skipped_channels.d.next = 247.into();
                }
                4 => {
                    self.skipped_channels.d.next = 239.into();
                }
                5 => {
                    self.skipped_channels.d.next = 223.into();
                }
                6 => {
                    self.skipped_channels.d.next = 191.into();
                }
                7 => {
                    self.skipped_channels.d.next = 127.into();
                }
                _ => {}
            }
        }
        self.word_skip.next = self.skipped_words.q.val();
        self.channel_skip.next = self.skipped_channels.q.val();

        // Services: 128 words each, from 0x400 on. A word is read whole with its first byte, and written in two halves, one
        // block of the ring after the other.
        self.service_page.next = self.has_service.val()
            & self.front.in_range.val()
            & self.front.word_address.val().get_bit(10);
        // Line monitors: 64 words each, from 0x200 on, in the same way.
        self.line_page.next = self.has_line.val()
            & self.front.in_range.val()
            & !self.front.word_address.val().get_bit(10)
            & self.front.word_address.val().get_bit(9);
        // T-format ports: 8 words each, from 0x0C0 on, in the same way.
        self.t_format_page.next = self.has_t_format.val()
            & self.low_page.val()
            & !self.front.word_address.val().get_bit(8)
            & self.front.word_address.val().get_bits::<2>(6).all();
        self.word_page.next =
            self.service_page.val() | self.line_page.val() | self.t_format_page.val();
        self.service.service_line.next = self.line_selected.q.val();
        self.service_channel.next = self.front.word_address.val().get_bits::<3>(7);
        if self.line_page.val() {
            self.service_channel.next = self.front.word_address.val().get_bits::<3>(6);
        }
        if self.t_format_page.val() {
            self.service_channel.next = self.front.word_address.val().get_bits::<3>(3);
        }
        self.selected.next = 0.into();
        if self.word_page.val() {
            match self.service_channel.val().index() {
                0 => {
                    self.selected.next = 1.into();
                }
                1 => {
                    self.selected.next = 2.into();
                }
                2 => {
                    self.selected.next = 4.into();
                }
                3 => {
                    self.selected.next = 8.into();
                }
                4 => {
                    self.selected.next = 16.into();
                }
                5 => {
                    self.selected.next = 32.into();
                }
                6 => {
                    self.selected.next = 64.into();
                }
                _ => {
                    self.selected.next = 128.into();
                }
            }
        }
        if !self.busy.val() {
            self.line_selected.d.next = self.line_page.val() | self.t_format_page.val();
            self.service_skip.d.next = !self.word_page.val();
            // A channel has the words of its own protocol only.
            self.service_selected.d.next = self.selected.val() & self.endat_channels.val();
            if self.t_format_page.val() {
                self.service_selected.d.next = self.selected.val() & self.t_format_channels.val();
            }
        }
        self.service_first.d.next = self.starts.val();
        self.service.service_address.next = self.held_address.q.val().get_bits::<7>(0);
        self.service.service_channels.next = self.service_selected.q.val();
        self.service.service_clear.next = self.service_first.q.val() & !self.front.lane.val().any();
        self.service.service_read.next = 0.into();
        if self.service_first.q.val() & !self.write_now.q.val() & !self.front.lane.val().any() {
            self.service.service_read.next = self.service_selected.q.val();
        }
        self.service.service_write.next = 0.into();
        self.service.service_half.next = !self.block_at.q.val().any();
        if self.write_now.q.val()
            & (self.service_first.q.val()
                | ((self.block_at.q.val() == 1) & !self.byte_at.q.val().any()))
        {
            self.service.service_write.next = self.service_selected.q.val();
        }
        self.service.service_data.next = self.front.write_data.val().get_bits::<16>(0);
        if self.service.service_half.val() {
            self.service.service_data.next = self.front.write_data.val().get_bits::<16>(16);
        }
        match self.front.lane.val().index() {
            0 => {
                self.service_byte.d.next = self.service.service_word.val().get_bits::<8>(24);
            }
            1 => {
                self.service_byte.d.next = self.service.service_word.val().get_bits::<8>(16);
            }
            2 => {
                self.service_byte.d.next = self.service.service_word.val().get_bits::<8>(8);
            }
            _ => {
                self.service_byte.d.next = self.service.service_word.val().get_bits::<8>(0);
            }
        }

        self.byte.d.next = self.rom_byte.q.val()
            | self.count_byte.q.val()
            | self.ring_byte.q.val()
            | self.channel_byte.val()
            | self.service_byte.q.val()
            | self.part_byte.val();
        self.front.read_byte.next = self.byte.q.val();
    }
}

//! Kernel of the register bank.

use super::*;
use endat_macros::kernel;

#[kernel]
impl Logic for RegisterBank {
    fn update(&mut self) {
        clock!(self, clock, ring);
        self.ring.reset.next = self.reset.val();
        // A reset by deselection takes no logic.
        self.rom_byte.reset.next = self.rom_skip.q.val();
        self.count_byte.reset.next = self.count_skip.q.val();
        self.service_byte.reset.next = self.service_skip.q.val();
        self.hold_access();
        self.turn();
        self.wire_ring();
        self.show_card();
        self.obey();
        self.show_results();
        self.choose_page();
        self.reach_service();
        self.answer();
    }

    /// Address and direction of an access are kept from its start to its end, whatever the front does.
    fn hold_access(&mut self) {
        self.busy.next = self.turning.q.val() | self.ended.q.val();
        self.starts.next = self.front.access.val() & !self.busy.val();
        if !self.busy.val() {
            self.held_address.d.next = self.front.word_address.val();
            self.held_inside.d.next = self.front.in_range.val();
        }
        self.begins.next = self.starts.val();
        self.address.next = self.held_address.q.val();
        self.is_inside.next = self.held_inside.q.val();
    }

    /// One turn for a configuration word. The counters run one cycle ahead of the ring, which leaves a full cycle for comparing them.
    /// They also time the halves of a written RAM word; every other access ends when its byte is ready.
    fn turn(&mut self) {
        self.whole_turn.next =
            self.config_page.q.val() | (self.is_write.q.val() & !self.service_skip.q.val());
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
            self.is_write.d.next = self.front.write.val();
        }
        self.turn.d.next = self.turning.q.val() & self.whole_turn.val();
        self.ended.d.next = self.turning.q.val() & self.at_end.val();
        self.done_strobe.d.next = self.ended.q.val();
        self.ring_turn.next = self.turn.q.val();
        self.ring_home.next = !self.turn.q.val();
        self.front.done.next = self.done_strobe.q.val();
    }

    /// Configuration: the ring holds 3 of the 8 words of a block.
    fn wire_ring(&mut self) {
        self.low_page.next =
            self.front.in_range.val() & !self.front.word_address.val().get_bits::<2>(9).any();
        self.low_address.next = self.front.word_address.val().get_bits::<9>(0);

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
        if self.passes.q.val() & self.is_write.q.val() {
            self.head.next = bit_cast::<9, 8>(self.written.val());
            if self.has_guards.val() {
                self.head.next = bit_cast::<9, 8>(self.written.val())
                    | (bit_cast::<9, 1>(self.written.val().xor().into()) << 8);
            }
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
    }

    /// The card's own words.
    fn show_card(&mut self) {
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
    }

    /// Strobes and settings of the card.
    fn obey(&mut self) {
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
        // In the cycle in which they take effect: the first words of card and channels.
        self.restart.next = self.done_strobe.q.val()
            & self.is_write.q.val()
            & self.config_page.q.val()
            & !self.front.word_address.val().get_bits::<2>(0).any();
        self.period_cycles.next = self.active_period.q.val();
    }

    /// Results.
    fn show_results(&mut self) {
        // Reading blocks one cycle late; the first byte is read even later.
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
    }

    /// Services: 128 words each, from 0x400 on. A word is read whole with its first byte, and written in two halves, one
    /// block of the ring after the other.
    fn choose_page(&mut self) {
        self.service_page.next = self.has_service.val()
            & self.front.in_range.val()
            & self.front.word_address.val().get_bit(10);
        // Line monitors: 64 words each, from 0x200 on, accessed likewise.
        self.line_page.next = self.has_line.val()
            & self.front.in_range.val()
            & !self.front.word_address.val().get_bit(10)
            & self.front.word_address.val().get_bit(9);
        // Ports of other protocols than EnDat: 8 words each, from 0x0C0 on, accessed likewise.
        self.port_page.next = self.has_others.val()
            & self.low_page.val()
            & !self.front.word_address.val().get_bit(8)
            & self.front.word_address.val().get_bits::<2>(6).all();
        self.word_page.next = self.service_page.val() | self.line_page.val() | self.port_page.val();
        self.service.service_line.next = self.line_selected.q.val();
        self.service_channel.next = self.front.word_address.val().get_bits::<3>(7);
        if self.line_page.val() {
            self.service_channel.next = self.front.word_address.val().get_bits::<3>(6);
        }
        if self.port_page.val() {
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
    }

    /// The words of services, line monitors and ports.
    fn reach_service(&mut self) {
        if !self.busy.val() {
            self.line_selected.d.next = self.line_page.val() | self.port_page.val();
            self.service_skip.d.next = !self.word_page.val();
            // A channel has only the words of its own protocol.
            self.service_selected.d.next = self.selected.val() & self.endat_channels.val();
            if self.port_page.val() {
                self.service_selected.d.next = self.selected.val() & self.other_channels.val();
            }
        }
        self.service_first.d.next = self.starts.val();
        self.service.service_address.next = self.held_address.q.val().get_bits::<7>(0);
        self.service.service_channels.next = self.service_selected.q.val();
        self.service.service_clear.next = self.service_first.q.val() & !self.front.lane.val().any();
        self.service.service_read.next = 0.into();
        if self.service_first.q.val() & !self.is_write.q.val() & !self.front.lane.val().any() {
            self.service.service_read.next = self.service_selected.q.val();
        }
        self.service.service_write.next = 0.into();
        self.service.service_half.next = !self.block_at.q.val().any();
        if self.is_write.q.val()
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
    }

    /// Selects the byte that is read.
    fn answer(&mut self) {
        self.byte.d.next = self.rom_byte.q.val()
            | self.count_byte.q.val()
            | self.ring_byte.q.val()
            | self.channel_byte.val()
            | self.service_byte.q.val()
            | self.part_byte.val();
        self.front.read_byte.next = self.byte.q.val();
    }
}

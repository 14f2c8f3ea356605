//! Kernel of the core of a card: mostly wiring.

use super::*;
use crate::ports::{AdditionalDataOut, FrameResultOut, PortSettingsOut};
use rtl_design::kernel;

#[kernel]
impl Logic for CardCore {
    fn update(&mut self) {
        clock!(self, clk_i, timebase, trigger, bank);
        self.timebase.reset.next = self.rst_i.val();
        self.trigger.reset.next = self.rst_i.val();
        self.bank.reset.next = self.rst_i.val();
        self.share_trigger();
        self.wire_bank();
        self.wire_channels();
        self.wire_services();
        self.wire_stream();
        self.wire_direct();
        self.wire_additional_data();
        self.wire_second();
        self.wire_runs();
    }

    /// The card's trigger, and the trigger of each channel.
    fn share_trigger(&mut self) {
        self.trigger.pin.next = self.trigger_i.val();
        connect!(self.trigger <= self.bank; register = trigger_now, sources, period_cycles);

        for i in 0..self._own_triggers {
            connect!(self.own_trigger[i] <= self; clock = clk_i, reset = rst_i);
            self.own_trigger[i].hits.next = self.trigger.hits.val();
            self.own_trigger[i].home.next = self.bank.ring_home.val();
            connect!(self.own_trigger[i] <= self.registers[i];
                ignored_sources, skip = trigger_skip
            );
            self.own_trigger[i].off.next = self.bank.disabled.val().get_bit(i);
            self.own_trigger[i].restart.next = self.bank.restart.val();
            self.trigger_of[i].next = self.own_trigger[i].trigger.val();
            self.is_off[i].next = self.own_trigger[i].disabled.val();
        }
        for i in self._own_triggers..self._channels {
            self.trigger_of[i].next = self.trigger.trigger.val();
            self.is_off[i].next = false;
        }
    }

    /// Time, and the front.
    fn wire_bank(&mut self) {
        self.tick_us.next = self.timebase.tick_us.val();
        AccessIn::link(&mut self.front, &mut self.bank.front);
        self.bank.trigger_count.next = self.trigger.trigger_count.val();
    }

    /// From the first channel to the last: read bytes, and the OR of the signals of all channels. The ring runs the other way.
    fn wire_channels(&mut self) {
        self.read_link[0].next = 0.into();
        self.service_link[0].next = 0.into();
        self.taken[0].next = false;
        self.owes[0].next = false;
        self.brought[0].next = false;
        self.faulty[0].next = false;
        self.bank.ring_in.next = self.ring_link[0].val();
        for i in 0..self._channels {
            connect!(self.registers[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.port[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.port[i] <= self.timebase; tick_us, timestamp);
            self.port[i].trigger.next = self.trigger_of[i].val();
            self.port[i].calibrate.next = self.bank.calibrate.val().get_bit(i);

            PortSettingsOut::join(&mut self.registers[i].settings, &mut self.port[i].settings);
            connect!(self.port[i] <= self.registers[i]; request_id, field_gap_us);

            connect!(self.port[i].window <= self.bank.service;
                host_address = service_address, host_line = service_line,
                host_half = service_half, host_data = service_data
            );
            self.port[i].window.host_read.next = self.bank.service.service_read.val().get_bit(i);
            self.port[i].window.host_write.next = self.bank.service.service_write.val().get_bit(i);
            // A word that is not selected is 0.
            self.selected[i].next = 0.into();
            if self.bank.service.service_channels.val().get_bit(i) {
                self.selected[i].next = self.port[i].window.host_word.val();
            }
            self.service_link[i + 1].next = self.service_link[i].val() | self.selected[i].val();

            self.registers[i].tick_us.next = self.timebase.tick_us.val();
            self.registers[i].trigger.next = self.trigger_of[i].val();
            self.registers[i].new_set.next = self.new_set.val();
            FrameResultOut::join(&mut self.port[i].result, &mut self.registers[i].result);
            connect!(self.registers[i] <= self.port[i]; busy, recovery_cycles, delay_cycles);

            connect!(self.registers[i] <= self.bank; load, show, word_skip);
            self.registers[i].lane.next = self.front.lane.val();
            self.registers[i].skip.next = self.bank.channel_skip.val().get_bit(i);
            self.registers[i].read_in.next = self.read_link[i].val();
            self.read_link[i + 1].next = self.registers[i].read_out.val();
            connect!(self.registers[i] <= self.bank;
                ring_turn, ring_home, card_damaged = is_damaged
            );
            self.registers[i].ring_in.next = self.ring_link[i + 1].val();
            self.ring_link[i].next = self.registers[i].ring_out.val();
            self.taken[i + 1].next = self.taken[i].val() | self.registers[i].taken.val();
            self.owes[i + 1].next = self.owes[i].val() | self.registers[i].owes.val();
            self.brought[i + 1].next = self.brought[i].val() | self.registers[i].brought.val();
            self.faulty[i + 1].next = self.faulty[i].val()
                | ((self.port[i].result.cause.val().any() | self.port[i].alarm.val())
                    & !self.is_off[i].val());

            self.port[i].line.data_i.next = self.endat_data_i[i].val();
            self.endat_clk_o[i].next = self.port[i].line.endat_clk.val();
            self.endat_data_o[i].next = self.port[i].line.data_o.val();
            self.endat_data_oe[i].next = self.port[i].line.data_oe.val();
            self.led_channel_o[i].next = self.port[i].result.fresh.val() & !self.is_off[i].val();
        }
        self.now.next = self.timebase.timestamp.val();
        self.led_status_o.next = self.now.val().get_bit(self.slow_bit.val().index());
        for i in self._channels..self._links {
            self.ring_link[i].next = self.bank.ring_out.val();
            self.bank.channel_byte.next = self.read_link[i].val();
            self.word_link[0].next = self.service_link[i].val();
            self.new_set.next = self.taken[i].val();
            self.bank.taken.next = self.taken[i].val();
            self.bank.owes.next = self.owes[i].val();
            self.bank.brought.next = self.brought[i].val();
            if self.faulty[i].val() {
                self.led_status_o.next = self.now.val().get_bit(self.quick_bit.val().index());
            }
        }
    }

    /// Services, each for two channels; the last one may have only one. A word that is not selected is 0.
    fn wire_services(&mut self) {
        self.in_service.next = !self.bank.service.service_line.val();
        for i in 0..self._served {
            self.port[i].io_address[0].next = self.io_address[i].val();
            self.port[i].io_out[0].next = self.io_out[i].val();
            self.port[i].io_write[0].next = self.io_write[i].val();
            self.port[i].io_read[0].next = self.io_read[i].val();
            self.io_in[i].next = self.port[i].io_in[0].val();
        }
        for i in 0..self._services {
            connect!(self.service[i] <= self; clock = clk_i, reset = rst_i);
            self.service[i].tick_us.next = self.timebase.tick_us.val();
            self.io_address[2 * i].next = self.service[i].io_address.val();
            self.io_address[2 * i + 1].next = self.service[i].io_address.val();
            self.io_out[2 * i].next = self.service[i].io_out.val();
            self.io_out[2 * i + 1].next = self.service[i].io_out.val();
            self.service[i].io_in[0].next = self.io_in[2 * i].val();
            self.io_read[2 * i].next = self.service[i].io_read[0].val();
            self.io_write[2 * i].next = self.service[i].io_write[0].val();
            self.service[i].host_address.next = self.bank.service.service_address.val();
            self.service[i].host_second.next =
                self.bank.service.service_channels.val().get_bit(2 * i + 1);
            self.service[i].host_read.next = self.in_service.val()
                & self
                    .bank
                    .service
                    .service_read
                    .val()
                    .get_bits::<2>(2 * i)
                    .any();
            self.service[i].host_clear.next = self.bank.service.service_clear.val();
            self.service[i].host_write.next = self.in_service.val()
                & self
                    .bank
                    .service
                    .service_write
                    .val()
                    .get_bits::<2>(2 * i)
                    .any();
            connect!(self.service[i] <= self.bank.service;
                host_half = service_half, host_data = service_data
            );
            self.word_link[i + 1].next = self.word_link[i].val() | self.service[i].host_word.val();
        }
        for i in self._services..self._service_links {
            self.bank.service.service_word.next = self.word_link[i].val();
        }
        for i in 0..self._pairs {
            self.service[i].io_in[1].next = self.io_in[2 * i + 1].val();
            self.io_read[2 * i + 1].next = self.service[i].io_read[1].val();
            self.io_write[2 * i + 1].next = self.service[i].io_write[1].val();
        }
    }

    /// The stream, and each channel's place in a set.
    fn wire_stream(&mut self) {
        self.part_byte[0].next = 0.into();
        self.pushed.push.next = false;
        self.pushed.in_frame.next = false;
        self.pushed.push_valid.next = false;
        self.pushed.push_byte.next = 0.into();
        for i in 0..self._streams {
            connect!(self.stream[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.stream[i] <= self.trigger; trigger, trigger_count);
            self.stream[i].timestamp.next = self.timebase.timestamp.val();
            self.stream[i].owes.next = self.set_owes[i].val();
            self.stream[i].replaced.next = self.set_replaced[i].val();
            self.stream[i].channel_byte.next = self.set_byte[i].val();
            self.set_taken[i].next = self.stream[i].take_set.val();
            self.set_block[i].next = self.stream[i].block.val();
            self.set_byte_at[i].next = self.stream[i].byte_at.val();
            self.stream[i].selected.next = self.bank.stream_selected.val();
            self.stream[i].word.next = self.bank.address.val().get_bits::<2>(0);
            self.stream[i].lane.next = self.front.lane.val();
            self.stream[i].access.next = self.bank.begins.val();
            self.stream[i].write.next = self.front.write.val();
            self.stream[i].write_data.next = self.front.write_data.val().get_bits::<2>(0);
            self.part_byte[0].next = self.stream[i].read_byte.val();
            PushOut::link(&mut self.pushed, &mut self.stream[i].pushed);
        }
        for i in 0..self._sets {
            connect!(self.set[i] <= self; clock = clk_i, reset = rst_i);
            self.set[i].trigger.next = self.trigger.trigger.val();
            self.set[i].busy.next = self.port[i].busy.val() | !self.trigger_of[i].val();
            connect!(self.set[i] <= self.port[i].result;
                result_strobe, position, position_crc, position_has_f2, position_valid, fresh,
                cause, flags
            );
            self.set[i].take.next = self.set_taken[0].val();
            self.set[i].block.next = self.set_block[0].val();
            self.set[i].byte_at.next = self.set_byte_at[0].val();
            self.set_byte[i].next = self.set_byte[i + 1].val() | self.set[i].set_byte.val();
            self.set_owes[i].next = self.set_owes[i + 1].val() | self.set[i].owes.val();
            self.set_replaced[i].next = self.set_replaced[i + 1].val() | self.set[i].replaced.val();
        }
        for i in self._sets..self._set_links {
            self.set_byte[i].next = 0.into();
            self.set_owes[i].next = false;
            self.set_replaced[i].next = false;
        }
    }

    /// Outputs within the device, interrupts, recovery times.
    fn wire_direct(&mut self) {
        self.part_write.next = self.bank.begins.val() & self.front.write.val();
        for i in 0..self._directs {
            connect!(self.direct[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.direct[i] <= self.port[i].result; result_strobe, position, fresh, cause);
            self.direct[i].alarm.next = self.port[i].alarm.val();
            connect!(self.direct[i] <= self.bank; word_address = address, in_range = is_inside);
            connect!(self.direct[i] <= self.front; lane, write_data);
            self.direct[i].write.next = self.part_write.val();
            self.direct_byte[i].next =
                self.direct_byte[i + 1].val() | self.direct[i].read_byte.val();
        }
        for i in self._directs..self._direct_links {
            self.direct_byte[i].next = 0.into();
        }
        for i in 0..self._direct_ports {
            self.direct_position_o[i].next = self.direct[i].direct_position.val();
            self.direct_valid_o[i].next = self.direct[i].direct_valid.val();
            self.direct_fresh_o[i].next = self.direct[i].direct_fresh.val();
            self.direct_error_o[i].next = self.direct[i].direct_error.val() & !self.is_off[i].val();
        }
        self.part_byte[1].next = 0.into();
        self.irq_o.next = false;
        for i in 0..self._interrupts {
            connect!(self.interrupt[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.interrupt[i] <= self.bank; word_address = address, in_range = is_inside);
            connect!(self.interrupt[i] <= self.front; lane, write_data);
            self.interrupt[i].write.next = self.part_write.val();
            self.part_byte[1].next = self.interrupt[i].read_byte.val();
            self.irq_o.next = self.interrupt[i].irq.val();
        }
        for i in 0..self._interrupt_channels {
            self.interrupt[0].result[i].next = self.port[i].result.result_strobe.val();
            self.interrupt[0].error[i].next =
                self.direct[i].direct_error.val() & !self.is_off[i].val();
            self.interrupt[0].alarm[i].next = self.port[i].alarm.val() & !self.is_off[i].val();
            self.interrupt[0].request[i].next =
                self.port[i].end.over.val() & self.port[i].end.over_request.val();
        }
        for i in 0..self._recoveries {
            connect!(self.recovery[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.recovery[i] <= self.port[i].line; endat_clk, data_oe);
            self.recovery[i].data_i.next = self.endat_data_i[i].val();
            connect!(self.recovery[i] <= self.bank; word_address = address, in_range = is_inside);
            self.recovery[i].lane.next = self.front.lane.val();
            self.recovery_byte[i].next =
                self.recovery_byte[i + 1].val() | self.recovery[i].read_byte.val();
        }
        for i in self._recoveries..self._recovery_links {
            self.recovery_byte[i].next = 0.into();
        }
        self.part_byte[2].next = 0.into();
    }

    /// Channels with requests: the registers receive a result together with its additional data.
    fn wire_additional_data(&mut self) {
        for i in 0..self._infos {
            connect!(self.whole[i] <= self; clock = clk_i, reset = rst_i);
            self.whole[i].tick_us.next = self.timebase.tick_us.val();
            self.whole[i].taken.next = self.registers[i].taken.val();
            FrameResultOut::join(&mut self.port[i].result, &mut self.whole[i].result_in);
            AdditionalDataOut::join(&mut self.port[i].record, &mut self.whole[i].record);
            self.whole[i].over.next = self.port[i].end.over.val();
            connect!(self.whole[i] <= self.port[i];
                recovery_cycles_in = recovery_cycles, delay_cycles_in = delay_cycles
            );
            FrameResultOut::join(&mut self.whole[i].result, &mut self.registers[i].result);
            connect!(self.registers[i] <= self.whole[i]; recovery_cycles, delay_cycles);
            connect!(self.whole[i] <= self.bank;
                load, word_address = address, in_range = is_inside
            );
            self.whole[i].lane.next = self.front.lane.val();
            self.info_byte[i].next = self.info_byte[i + 1].val() | self.whole[i].read_byte.val();
        }
        for i in 0..self._info_interrupts {
            self.interrupt[0].result[i].next = self.whole[i].result.result_strobe.val();
        }
        for i in self._infos..self._info_links {
            self.info_byte[i].next = 0.into();
            self.part_byte[2].next = self.info_byte[0].val();
        }
        self.bank.part_byte.next = (self.part_byte[0].val() | self.part_byte[1].val())
            | (self.part_byte[2].val() | self.direct_byte[0].val() | self.recovery_byte[0].val());
        for i in 0..self._set_infos {
            self.set[i].word_1[0].next = self.whole[i].word_1.val();
            self.set[i].word_2[0].next = self.whole[i].word_2.val();
            self.set_open[i].next = self.set_open[i + 1].val() | self.whole[i].is_open.val();
        }
        for i in self._set_infos..self._set_ends {
            self.set_open[i].next = false;
            self.stream[0].owes.next = self.set_owes[0].val() | self.set_open[0].val();
        }
        for i in self._set_infos..self._plain_sets {
            self.set[i].word_1[0].next = 0.into();
            self.set[i].word_2[0].next = 0.into();
        }
        for i in 0..self._plain_sets {
            self.set[i].second[0].next = self.stream[0].second[0].val();
        }
    }

    /// For the second controller: the current content of the registers.
    fn wire_second(&mut self) {
        for i in 0..self._seconds {
            connect!(self.second[i] <= self; clock = clk_i, reset = rst_i);
            self.second[i].sck.next = self.second_sck_i[i].val();
            self.second[i].cs_n.next = self.second_cs_n_i[i].val();
            self.second[i].word.next = self.record_link[0].val();
            self.second_miso_o[i].next = self.second[i].miso.val();
            self.second_miso_oe[i].next = self.second[i].miso_enable.val();
        }
        for i in 0..self._records {
            connect!(self.record[i] <= self; clock = clk_i, reset = rst_i);
            connect!(self.record[i] <= self.second[0]; take, channel, word_at);
            self.record[i].word_in.next = self.record_link[i + 1].val();
            self.record_link[i].next = self.record[i].word.val();
            self.record[i].live[0].next = self.registers[i].live[0].val();
            self.record[i].live[1].next = self.registers[i].live[1].val();
            self.record[i].live[2].next = self.registers[i].live[2].val();
            self.record[i].live[3].next = self.registers[i].live[3].val();
            self.record[i].live[4].next = self.registers[i].live[4].val();
            self.record[i].live[5].next = self.registers[i].live[5].val();
        }
        for i in 0..self._record_infos {
            self.record[i].live[6].next = self.whole[i].live[0].val();
            self.record[i].live[7].next = self.whole[i].live[1].val();
        }
        for i in self._record_infos..self._records {
            self.record[i].live[6].next = 0.into();
            self.record[i].live[7].next = 0.into();
        }
        for i in self._records..self._record_links {
            self.record_link[i].next = 0.into();
        }
    }

    /// Positions of running clocks.
    fn wire_runs(&mut self) {
        for i in 0..self._runs {
            connect!(self.run[i] <= self; clock = clk_i, reset = rst_i);
            self.run[i].collects.next = self.stream[0].collects[0].val();
            self.run[i].taken.next = self.registers[i].taken.val();
            connect!(self.run[i] <= self.port[i].result;
                result_strobe, sequence, first_fall_timestamp
            );
            self.run[i].turn.next = self.stream[0].run_turn[0].val();
            self.run[i].take.next = self.stream[0].run_take[0].val();
            self.run[i].counted.next =
                self.stream[0].run_counted[0].val() & !self.run_lost[i + 1].val();
            self.set[i].take_run[0].next = self.run[i].take_run.val();
            self.run_ready[i].next = self.run_ready[i + 1].val() | self.run[i].ready.val();
            self.run_sequence[i].next =
                self.run_sequence[i + 1].val() | self.run[i].ready_sequence.val();
            self.run_timestamp[i].next =
                self.run_timestamp[i + 1].val() | self.run[i].ready_timestamp.val();
            self.run_head[i].next = self.run_head[i + 1].val() | self.run[i].ready_head.val();
            self.run_place[i].next = self.run_place[i + 1].val() | self.run[i].ready_place.val();
            self.run_lost[i].next = self.run_lost[i + 1].val() | self.run[i].lost.val();
        }
        for i in self._runs..self._run_links {
            self.run_ready[i].next = false;
            self.run_sequence[i].next = 0.into();
            self.run_timestamp[i].next = 0.into();
            self.run_head[i].next = 0.into();
            self.run_place[i].next = 0.into();
            self.run_lost[i].next = false;
            self.stream[0].run_ready[0].next = self.run_ready[0].val();
            self.stream[0].run_sequence[0].next = self.run_sequence[0].val();
            self.stream[0].run_timestamp[0].next = self.run_timestamp[0].val();
            self.stream[0].run_head[0].next = self.run_head[0].val();
            self.stream[0].run_place[0].next = self.run_place[0].val();
            self.stream[0].run_lost[0].next = self.run_lost[0].val();
        }
        for i in self._runs..self._run_sets {
            self.set[i].take_run[0].next = false;
        }
    }
}

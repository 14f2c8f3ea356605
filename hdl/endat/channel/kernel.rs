//! Kernel of the channel: wiring and multiplexers.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for Channel {
    fn update(&mut self) {
        connect!(
            self.filter, self.clock_gen, self.sender, self.delay, self.receiver, self.transaction,
            self.snapshot, self.add_info <= self; clock, reset
        );
        self.take_settings();
        self.choose_command();
        self.run_clock();
        self.receive();
        self.order_frame();
        self.show_result();
        self.take_words();
        self.drive_line();
        self.tell();
        self.compare();
    }

    /// Settings of the frame, and the clock period that it runs with.
    fn take_settings(&mut self) {
        connect!(self <= self.settings_in;
            command_set = command, width_set = position_bits, filter_set = filter_cycles,
            filter_half_set = filter_half, window_set = start_window_cycles, period = period_cycles
        );
        // If a service sets width and rate, it may change them at any time.
        if self.has_requests.val() {
            self.width_set.next = self.frame_width.q.val();
            self.period.next = self.frame_period.q.val();
        }
        connect!(self.transaction.limits <= self.settings_in;
            first_low_extra_cycles, start_timeout_us, recovery_limit_cycles
        );
        connect!(self.transaction.limits <= self.orders; recovery_min_cycles, watchdog_us);
        self.transaction.settings_upset.next = false;
        for i in 0..self._guards {
            connect!(self.settings[i] <= self; clock, reset);
            self.settings[i].is_at_rest.next = self.transaction.is_at_rest.val();
            self.settings[i].start.next = self.transaction.control.start.val();
            PortSettingsIn::link(&mut self.settings_in, &mut self.settings[i].wanted);
            self.settings[i].frame_command.next = self.command_now.val();
            connect!(self.settings[i] <= self.orders; recovery_min_cycles, watchdog_us);
            connect!(self <= self.settings[i];
                command_set = command_now, width_set = position_bits_now,
                filter_set = filter_cycles_now, filter_half_set = filter_half_now,
                window_set = start_window_cycles_now, period = period_cycles_now
            );
            FrameLimitsOut::join(&mut self.settings[i].limits, &mut self.transaction.limits);
            self.transaction.settings_upset.next = self.settings[i].is_upset.val();
        }
        if self.transaction.cell_control.slow.val() {
            self.period.next = self.calibration_period_cycles.val();
        }
    }

    /// The command of the next frame is fixed before it begins, and stays until the frame has been reported.
    fn choose_command(&mut self) {
        connect!(self <= self; command_now = command_set, payload_bits = width_set);
        if self.has_requests.val() {
            self.command_now.next = self.frame_command.q.val();
            if self.shape.answer.has_parameter.val() {
                self.payload_bits.next = self.parameter_bits.val();
            }
            if self.shape.has_test_values.val() {
                self.payload_bits.next = self.test_value_bits.val();
            }
        }
        self.own_wanted.next = false;
        self.ride_wanted.next = false;
        for i in 0..self._requests {
            connect!(self.own_asked[i] <= self; clock, reset);
            self.own_asked[i].raise.next =
                self.orders.request_own.val() & !self.orders.request_cancel.val();
            self.own_asked[i].clear.next = self.orders.request_cancel.val()
                | (self.transaction.begun.val() & self.frame_own.q.val());
            self.own_wanted.next = self.own_asked[i].is_set.val();
            connect!(self.ride_asked[i] <= self; clock, reset);
            self.ride_asked[i].raise.next =
                self.orders.request_ride.val() & !self.orders.request_cancel.val();
            self.ride_asked[i].clear.next = self.orders.request_cancel.val()
                | (self.transaction.begun.val() & self.frame_ride.q.val());
            self.ride_wanted.next = self.ride_asked[i].is_set.val();
        }
        if !self.transaction.begun.val()
            & self.transaction.is_at_rest.val()
            & self.has_requests.val()
        {
            self.frame_command.d.next = self.settings_in.command.val();
            self.frame_width.d.next = self.settings_in.position_bits.val();
            self.frame_period.d.next = self.settings_in.period_cycles.val();
            self.frame_own.d.next = self.own_wanted.val();
            self.frame_ride.d.next =
                self.ride_wanted.val() & self.transaction.calibrated.val() & !self.own_wanted.val();
            if self.own_wanted.val() | (self.ride_wanted.val() & self.transaction.calibrated.val())
            {
                self.frame_command.d.next = self.orders.request_command.val();
            }
        }
        self.shape.command.next = self.command_now.val();
    }

    /// Line, clock, sent bits, and the places of the answer's cells.
    fn run_clock(&mut self) {
        self.filter.pin.next = self.line.data_i.val();
        connect!(self.filter <= self; filter_cycles = filter_set, filter_half = filter_half_set);
        self.filter.majority.next = self.majority.val();
        self.filter.both_edges.next = self.receiver.progress.started.val();

        connect!(self.clock_gen <= self.transaction; hold_low, stop);
        self.clock_gen.start.next = self.transaction.control.start.val();
        self.clock_gen.period_cycles.next = self.period.val();

        self.sender.fall.next = self.clock_gen.fall.val();
        // Outside of a command nothing is left to send, whatever the sender's registers hold.
        self.sender.aborts.next = self.transaction.control.aborts.val()
            | (!self.receiver.progress.skipping.val()
                & !self.transaction.control.start_supplement.val());
        connect!(self.sender <= self.transaction.control; start, start_supplement);
        self.sender.command.next = self.command_now.val();
        self.sender.parameter_word.next = self.orders.request_parameter.val();
        self.sender.has_parameter.next = self.shape.answer.has_parameter.val();

        CellControlOut::join(&mut self.transaction.cell_control, &mut self.delay.control);
        connect!(self.delay <= self.transaction.control; acquire, going_on);
        connect!(self.delay <= self.clock_gen; will_rise, rise);
        connect!(self.delay <= self.filter; data_edge = edge_strobe, edge_second);
        self.delay.in_answer.next =
            self.receiver.progress.started.val() & !self.receiver.progress.skipping.val();
        connect!(self.delay <= self; mode = phase_mode, fixed_delay, period_cycles = period);
        connect!(self.delay <= self.receiver.progress;
            hunting, follow = start_found, none_under_way
        );
        self.delay.start_window_cycles.next = self.window_set.val();
    }

    /// Receives the answer, cell by cell.
    fn receive(&mut self) {
        ControlOut::join(&mut self.transaction.control, &mut self.receiver.control);
        self.receiver.rise.next = self.clock_gen.rise.val();
        CellsOut::join(&mut self.delay.cells, &mut self.receiver.cells);
        self.receiver.level.next = self.filter.level.val();
        if self.has_double.val() & !self.delay.sample_second.val() {
            self.receiver.level.next = self.filter.level_first.val();
        }
        connect!(self.receiver <= self; payload_bits, command = command_now);
        connect!(self.receiver <= self.snapshot; put = swap);
        connect!(self.receiver <= self.snapshot.result; put_word = position, put_crc = position_crc);
        AnswerShapeOut::join(&mut self.shape.answer, &mut self.receiver.shape);
        connect!(self.receiver <= self.add_info; infos, look);
    }

    /// Starts a frame with its parameters.
    fn order_frame(&mut self) {
        self.transaction.tick_us.next = self.tick_us.val();
        connect!(self.transaction.next_frame <= self; trigger, calibrate);
        connect!(self.transaction.next_frame <= self.orders; hold_off, stop_at_error);
        self.transaction.level.next = self.filter.level.val();
        self.transaction.is_fixed.next = self.phase_mode.val() == self.fixed_mode.val();
        CellsOut::join(&mut self.delay.cells, &mut self.transaction.cells);
        connect!(self.transaction <= self.delay; center, delay_upset = is_upset);
        ProgressOut::join(&mut self.receiver.progress, &mut self.transaction.progress);
        // With fewer than four cycles, additional data or the next answer of a running clock would begin before the position is stored.
        self.wanted_shape.command.next = self.settings_in.command.val();
        if self.has_requests.val() {
            self.wanted_shape.command.next = self.frame_command.q.val();
        }
        // A trigger sends position commands only, with or without a request. Another command brings no position and may change the encoder.
        self.transaction.next_frame.is_known.next = (self.wanted_shape.is_position.val()
            | (self.wanted_shape.is_known.val()
                & (self.frame_own.q.val()
                    | (self.frame_ride.q.val() & self.wanted_shape.answer.has_f2.val()))))
            & (!self.needs_four.val()
                | self.settings_in.period_cycles.val().get_bits::<9>(2).any());
        AnswerShapeOut::join(&mut self.shape.answer, &mut self.transaction.shape);
        self.transaction.is_watched.next = self.shape.is_watched.val();
        self.transaction.next_frame.begin_own.next = self.frame_own.q.val() & self.own_wanted.val();
        self.transaction.next_frame.is_own.next = self.frame_own.q.val();
        self.transaction.next_frame.continuous.next = self.orders.continuous.val()
            & self.shape.answer.has_f1.val()
            & !self.shape.answer.has_f2.val()
            & !self.shape.has_test_values.val();
        self.transaction.next_frame.line_wanted.next =
            self.own_wanted.val() | self.orders.hold_off.val();
        AnswerCheckOut::join(&mut self.receiver.verdict, &mut self.transaction.check);
        self.forced_now.next = self.orders.forced.val().get_bits::<4>(0);
        if self.orders.forced.val().get_bit(4) & !self.frame_own.q.val() {
            self.forced_now.next = 0.into();
        }
        if self.has_requests.val() {
            self.transaction.check.f1.next =
                self.receiver.verdict.f1.val() ^ self.forced_now.val().get_bit(0);
            self.transaction.check.f2.next =
                self.receiver.verdict.f2.val() ^ self.forced_now.val().get_bit(1);
            self.transaction.check.crc_ok.next =
                self.receiver.verdict.crc_ok.val() & !self.forced_now.val().get_bit(2);
        }
        self.transaction.will_rise.next = self.clock_gen.will_rise.val();
    }

    /// Outputs the last good position.
    fn show_result(&mut self) {
        connect!(self.snapshot <= self; tick_us, timestamp, width_in = payload_bits);
        self.snapshot.delay_cycles.next = self.delay.delay_cycles.val();
        self.snapshot.first_fall.next = self.transaction.control.start.val();
        ToldOut::join(&mut self.transaction.told, &mut self.snapshot.told);
        self.snapshot.has_f2_in.next = self.shape.answer.has_f2.val();
        connect!(self.snapshot <= self.receiver;
            position_in = payload, crc_received_in = crc_received, crc_computed_in = crc_computed
        );
        self.snapshot.latched.next = self.receiver.progress.latched.val();
    }

    /// Stores parameters and additional data.
    fn take_words(&mut self) {
        // Words that arrive MSB first are reversed in the payload.
        self.word.next = 0.into();
        for i in 0..24 {
            self.word.next = self
                .word
                .val()
                .replace_bit(23 - i, self.receiver.payload.val().get_bit(i));
        }
        self.crc_ok.next =
            self.receiver.verdict.crc_ok.val() & self.receiver.verdict.stored_ok.val();
        self.info_taken.d.next = self.receiver.progress.info_done.val();
        self.reply_taken.d.next = self.receiver.progress.done.val() & self.frame_own.q.val();
        if self.reply_taken.q.val() {
            self.reply_word.d.next = self.receiver.payload.val();
            self.reply_has_parameter.d.next = self.shape.answer.has_parameter.val();
            self.reply_right.d.next = self.crc_ok.val();
        }
        if self.transaction.control.start.val() {
            self.reply_right.d.next = false;
        }

        self.add_info.start.next = self.transaction.control.start.val();
        self.add_info.sample.next = self.delay.cells.sample.val();
        self.add_info.center.next = self.delay.center.val();
        self.add_info.answer_done.next = self.receiver.progress.done.val();
        connect!(self.add_info <= self.shape.answer; has_f2, has_supplement);
        self.add_info.command.next = self.command_now.val();
        self.add_info.mrs.next = self.orders.request_parameter.val().get_bits::<8>(16);
        self.add_info.info_done.next = self.info_taken.q.val() & self.has_requests.val();
        connect!(self.add_info <= self; crc_ok, word);
        self.add_info.crc.next = self.receiver.crc_received.val();
        self.add_info.over.next = self.transaction.over.val() & self.has_requests.val();
        self.add_info.flags.next = self.transaction.told.flags_told.val().get_bits::<12>(0);
    }

    /// Registers the outputs of the line.
    fn drive_line(&mut self) {
        self.clk_pin.d.next = self.clock_gen.endat_clk.val();
        self.data_pin.d.next = self.sender.data.val();
        self.oe_pin.d.next = self.sender.oe.val();
        if self.transaction.probe.val() {
            self.data_pin.d.next = false;
            self.oe_pin.d.next = true;
        }
        if self.orders.clock_low.val() & self.has_requests.val() {
            self.clk_pin.d.next = false;
        }
        self.line.endat_clk.next = self.clk_pin.q.val();
        self.line.data_o.next = self.data_pin.q.val();
        self.line.data_oe.next = self.oe_pin.q.val();
    }

    /// Reports the outcome of a frame.
    fn tell(&mut self) {
        FrameResultOut::link(&mut self.result, &mut self.snapshot.result);
        connect!(self <= self.delay;
            delay_cycles, phase, edge_measured = measured, edge_offset = offset, sample_second
        );
        self.glitch.next = self.filter.glitch.val();
        self.request_runs.next =
            (self.frame_own.q.val() | self.frame_ride.q.val()) & !self.transaction.is_at_rest.val();
        self.line_high.next = (self.filter.level.val() | self.transaction.is_probed.val())
            & !self.transaction.cell_control.run.val();
        self.end.over_request.next = self.frame_own.q.val() | self.frame_ride.q.val();
        connect!(self <= self.transaction; recovery_cycles, busy, displaced, calibrated);
        self.end.over.next = self.transaction.over.val();
        connect!(self.end <= self.transaction.told; over_cause = cause_told, over_flags = flags_told);
        self.end.answer.next = self.reply_word.q.val();
        self.reply.next = self.reply_word.q.val();
        self.turned.next = 0.into();
        for i in 0..24 {
            self.turned.next = self
                .turned
                .val()
                .replace_bit(23 - i, self.reply_word.q.val().get_bit(i));
        }
        if self.reply_has_parameter.q.val() {
            self.reply.next = bit_cast::<48, 24>(self.turned.val());
        }
        self.end.reply_good.next = self.reply_right.q.val();
        AdditionalDataOut::link(&mut self.record, &mut self.add_info.record);
    }

    /// A difference between the two receivers is an upset.
    fn compare(&mut self) {
        for i in 0..self._seconds {
            ControlOut::join(&mut self.transaction.control, &mut self.second[i].control);
            CellsOut::join(&mut self.delay.cells, &mut self.second[i].cells);
            AnswerShapeOut::join(&mut self.shape.answer, &mut self.second[i].shape);
            ProgressOut::join(&mut self.receiver.progress, &mut self.second[i].progress);
            AnswerCheckOut::join(&mut self.receiver.verdict, &mut self.second[i].check);
            connect!(self.second[i] <= self.receiver; payload, crc_received);
            connect!(self.second[i] <= self.transaction.told;
                good, cause = cause_told, flags = flags_told
            );
            connect!(self.snapshot.told <= self.second[i];
                good = good_told, cause_told, flags_told
            );
            self.second[i].rise.next = self.clock_gen.rise.val();
            connect!(self.second[i] <= self.filter; level);
            connect!(self.second[i] <= self.add_info; infos, look);
            connect!(self.second[i] <= self; clock, reset, payload_bits, command = command_now);
            self.second[i].forced.next = self.forced_now.val().get_bit(3) & self.has_requests.val();
            if self.second[i].differs.val() {
                self.transaction.settings_upset.next = true;
                self.record.info_good.next = 0.into();
                self.end.reply_good.next = false;
            }
        }
        self.sample_strobe.next =
            self.delay.cells.sample.val() & !self.receiver.progress.skipping.val();
    }
}

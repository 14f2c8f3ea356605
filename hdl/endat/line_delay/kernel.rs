//! Kernel of the line delay.

use super::*;
use rtl_design::kernel;

#[kernel]
impl Logic for LineDelay {
    fn update(&mut self) {
        clock!(self, clock, half);
        self.half.reset.next = self.reset.val();
        self.time_delay();
        self.place_cells();
        self.run_halves();
        self.measure_edge();
        self.follow();
        self.end_burst();
        self.tell();
    }

    /// tD from the first rising edge of a burst to the first cell; in an acquiring frame from every rising edge.
    fn time_delay(&mut self) {
        self.first_rise.next = self.rise.val() & (self.acquire.val() | !self.timing_armed.q.val());
        self.since_rise.d.next = self.since_rise.q.val() + 1;
        if self.first_rise.val() {
            self.timing_armed.d.next = true;
            // The comparison with the tracked delay and its result are registered: counting starts two cycles earlier.
            self.since_rise.d.next = 3.into();
            if self.acquire.val() {
                self.since_rise.d.next = 1.into();
            }
        }
        self.places.next = bit_cast::<12, 11>(self.delay.q.val());
        for i in 0..self._trackers {
            self.places.next = self.tracker[i].delay_places.val();
        }
        self.delay_now.next = self.places.val().get_bits::<11>(0);
        if self.has_double.val() {
            self.delay_now.next = self.places.val().get_bits::<11>(1);
        }
        // The delay is kept from frame to frame, so a guard checks it.
        self.moved.d.next = self.follow_now.q.val() | self.acquired.val();
        for i in 0..self._trackers {
            self.moved.d.next = self.tracker[i].moves.val();
        }
        self.parity_now.next = self.places.val().xor();
        if self.moved.q.val() {
            self.parity.d.next = self.parity_now.val();
        } else {
            if self.has_guards.val() & (self.parity_now.val() ^ self.parity.q.val()) {
                self.wrong.d.next = true;
            }
        }
        // A delay from a register is not measured.
        if self.acquired.val()
            | (self.has_alignment.val() & (self.mode.val() == self.fixed_mode.val()))
        {
            self.wrong.d.next = false;
        }
        self.is_upset.next = self.wrong.q.val();
        self.delay_over.d.next =
            self.timing_armed.q.val() & (self.since_rise.q.val() == self.delay_now.val());
    }

    /// Samples and middles of cells, from the first cell on.
    fn place_cells(&mut self) {
        // The middle of a bit with an odd number of places is on a place; with an even number it is between two.
        self.is_later.next = false;
        for i in 0..self._trackers {
            self.is_later.next = self.tracker[i].past_half.val()
                & self.period_cycles.val().get_bit(0)
                & !self.has_double.val();
        }
        self.was_over.d.next = self.delay_over.q.val() & self.has_alignment.val();
        self.due.next = self.delay_over.q.val();
        if self.is_later.val() {
            self.due.next = self.was_over.q.val();
        }

        self.acquired.next = self.acquire.val()
            & self.hunting.val()
            & self.data_edge.val()
            & !self.cells_run.q.val();
        self.first_center.next =
            self.acquired.val() | (self.due.val() & !self.cells_run.q.val() & !self.acquire.val());
        // The half period timer runs one cycle ahead: its ticks are registered before they are used.
        self.sample_strobe.d.next =
            self.half.tick.val() & !self.second_half.q.val() & self.cells_run.q.val();
        self.center_strobe.d.next = (self.half.tick.val() & self.second_half.q.val())
            | (self.first_center.val() & !self.acquired.val());
        // Phase from the start bit: its edge is the middle, wherever the tracked middle is.
        self.is_frame.next = self.has_alignment.val() & (self.mode.val() == self.frame_mode.val());
        self.snap.next = self.is_frame.val()
            & self.hunting.val()
            & self.data_edge.val()
            & !self.edge_seen.q.val()
            & self.cells_run.q.val()
            & !self.acquire.val();
        // With two system clock cycles in a bit, one more cell begins before a burst ends.
        self.sample_now.next = self.sample_strobe.q.val()
            & !self.snap.val()
            & !(self.has_double.val() & self.afresh.q.val());
        self.center_now.next = self.acquired.val() | self.center_strobe.q.val() | self.snap.val();
    }

    /// Times the halves of the cells.
    fn run_halves(&mut self) {
        self.half.period_cycles.next = self.period_cycles.val();
        self.half.second.next = self.second_half.q.val();
        self.half.restart.next =
            !self.cells_run.q.val() | self.control.last_cell.val() | self.snap.val();
        self.half.began.next = self.acquired.val() | self.snap.val();
        // An odd period has halves of a whole number of half cycles: every second one begins in the middle of a cycle.
        if self.has_double.val() {
            self.half.second.next = self.second.q.val();
            if self.half.tick.val() & self.cells_run.q.val() {
                self.second.d.next = self.second.q.val() ^ self.period_cycles.val().get_bit(0);
            }
            if self.first_center.val() {
                self.second.d.next = self.places.val().get_bit(0);
            }
            if self.acquired.val() | self.snap.val() {
                self.second.d.next = self.edge_second.val();
            }
        }
        if self.half.tick.val() & self.cells_run.q.val() {
            self.second_half.d.next = !self.second_half.q.val();
        }
        if self.first_center.val() | self.snap.val() {
            self.cells_run.d.next = true;
            self.second_half.d.next = false;
        }
        if self.snap.val() {
            self.sample_strobe.d.next = false;
            self.center_strobe.d.next = false;
        }
    }

    /// The pulse of a cell, and how far its data edge is from the middle.
    fn measure_edge(&mut self) {
        // Only the edge that launched an acquired start bit counts, not those before it.
        self.pulse_leaves.d.next = self.acquired.val()
            | (self.will_rise.val() & (!self.acquire.val() | self.cells_run.q.val()));
        self.cells.pulse.next = self.pulse_leaves.q.val();
        // With two system clock cycles in a bit there is no time to register it.
        if self.has_double.val() {
            self.cells.pulse.next = self.acquired.val()
                | (self.will_rise.val() & (!self.acquire.val() | self.cells_run.q.val()));
        }

        // Distance between the data edge and the middle of its place. An edge first seen one cycle after the middle is as good as one seen with
        // the middle: both are equally far from the limits of the bit.
        if self.center_now.val() {
            self.center_seen.d.next = true;
        }
        // An edge after the sample of the same cycle belongs to the next cell.
        self.next_cell.next = self.has_double.val()
            & self.sample_now.val()
            & self.edge_second.val()
            & !self.second.q.val();
        self.edge_now.next =
            self.edge_seen.q.val() | (self.data_edge.val() & !self.next_cell.val());
        self.late_now.next = self.edge_late.q.val();
        self.place_now.next = self.edge_place.q.val();
        if !self.edge_seen.q.val() {
            self.late_now.next = self.center_seen.q.val();
            self.place_now.next = self.edge_second.val();
        }
        if self.data_edge.val() {
            self.edge_seen.d.next = true;
            self.edge_late.d.next = self.late_now.val();
            self.edge_place.d.next = self.place_now.val();
            if self.next_cell.val() {
                self.edge_late.d.next = false;
                self.edge_place.d.next = true;
            }
        }
        if (self.center_seen.q.val() & !self.edge_now.val())
            | (self.edge_seen.q.val() & !self.center_seen.q.val())
        {
            self.edge_error.d.next = self.edge_error.q.val() + 1;
            if self.edge_error.q.val() == self.start_window_cycles.val() {
                self.edge_outside.d.next = true;
            }
        }
        // The middle moves onto the edge; the half under way shows how early that is.
        if self.snap.val() & !self.center_seen.q.val() & !self.center_strobe.q.val() {
            self.edge_error.d.next = self.half.left_cycles.val().get_bits::<6>(0);
            if self.half.left_cycles.val() > bit_cast::<10, 6>(self.start_window_cycles.val()) {
                self.edge_outside.d.next = true;
            }
        }
    }

    /// The tracked delay follows the start edge.
    fn follow(&mut self) {
        self.follow_now.d.next = self.follow.val() & self.edge_error.q.val().any();
        self.half.shorten.next = self.shorten.q.val();
        self.half.lengthen.next = self.lengthen.q.val();
        if self.half.tick.val() {
            self.shorten.d.next = false;
            self.lengthen.d.next = false;
        }
        if self.follow_now.q.val() {
            self.delay.d.next = self.delay.q.val() + self.step.val();
            self.shorten.d.next = self.going_on.val() & !self.edge_late.q.val();
            self.lengthen.d.next = self.going_on.val() & self.edge_late.q.val();
        }
        self.step.next = 0x7FF.into();
        if self.edge_late.q.val() {
            self.step.next = 1.into();
        }
        if self.acquired.val() {
            self.delay.d.next = self.since_rise.q.val();
        }
        if self.has_alignment.val() {
            self.delay.d.next = 0.into();
        }

        // Phase from the edge of the cell. In mode `frame` only the start bit sets it.
        self.center_place.next = false;
        self.distance.next = bit_cast::<8, 6>(self.edge_error.q.val());
        if self.has_double.val() {
            self.center_place.next = self.second.q.val() ^ self.period_cycles.val().get_bit(0);
            self.distance.next = (bit_cast::<8, 6>(self.edge_error.q.val()) << 1)
                + bit_cast::<8, 1>(self.center_place.val().into())
                - bit_cast::<8, 1>(self.place_now.val().into());
            if self.late_now.val() {
                self.distance.next = (bit_cast::<8, 6>(self.edge_error.q.val()) << 1)
                    + bit_cast::<8, 1>(self.place_now.val().into())
                    + bit_cast::<8, 1>((!self.center_place.val()).into());
            }
        }
        // Every edge counts until the mean is established.
        self.is_open.next = self.has_alignment.val() & self.control.slow.val();
        self.good_edge.next = self.has_alignment.val()
            & self.sample_now.val()
            & self.edge_now.val()
            & (!self.edge_outside.q.val() | self.is_open.val())
            & (self.follow.val() | (self.in_answer.val() & !self.is_frame.val()));
        self.measured_now.d.next = self.good_edge.val();
        self.offset_now.d.next = self.distance.val();
        if !self.late_now.val() {
            self.offset_now.d.next = !self.distance.val();
        }
        if !self.has_alignment.val() {
            self.offset_now.d.next = 0.into();
            self.edge_place.d.next = false;
        }
        for i in 0..self._trackers {
            connect!(self.tracker[i] <= self; clock, reset, acquired);
            self.tracker[i].measured_places.next = bit_cast::<12, 11>(self.since_rise.q.val());
            if self.has_double.val() {
                self.tracker[i].measured_places.next =
                    (bit_cast::<12, 11>(self.since_rise.q.val()) << 1)
                        | bit_cast::<12, 1>(self.edge_second.val().into());
            }
            connect!(self.tracker[i] <= self; starts = first_center, is_later);
            self.tracker[i].edge_strobe.next = self.measured_now.q.val();
            self.tracker[i].offset.next = self.offset_now.q.val();
            self.tracker[i].acquire.next = self.acquire.val();
            self.tracker[i].quick.next = self.control.slow.val() | self.is_frame.val();
            self.tracker[i].is_fixed.next = self.mode.val() == self.fixed_mode.val();
            self.tracker[i].fixed_delay.next = self.fixed_delay.val();
        }
    }

    /// All cells of a burst have ended: the next rising edge begins a new one.
    fn end_burst(&mut self) {
        self.over.next =
            !self.control.run.val() | (self.control.drain.val() & self.none_under_way.val());
        self.afresh.d.next = self.over.val();
        if self.afresh.q.val() {
            self.cells_run.d.next = false;
            self.second_half.d.next = false;
            self.timing_armed.d.next = false;
            self.delay_over.d.next = false;
            self.was_over.d.next = false;
            self.sample_strobe.d.next = false;
            self.center_strobe.d.next = false;
        }
        self.not_yet.d.next = self.over.val() | (self.acquire.val() & !self.hunting.val());
        if self.sample_now.val() | self.not_yet.q.val() {
            self.center_seen.d.next = false;
            self.edge_seen.d.next =
                self.next_cell.val() & self.data_edge.val() & !self.not_yet.q.val();
            self.edge_error.d.next = 0.into();
            self.edge_outside.d.next = false;
        }
    }

    /// Outputs the places of the cells, and the measurement.
    fn tell(&mut self) {
        self.cells.sample.next = self.sample_now.val();
        self.center.next = self.center_now.val();
        self.cells.edge_in_window.next =
            self.edge_now.val() & (!self.edge_outside.q.val() | self.is_open.val());
        self.sample_second.next = self.second.q.val();
        self.delay_cycles.next = self.delay_now.val();
        self.measured.next = self.measured_now.q.val();
        self.offset.next = self.offset_now.q.val();
        self.phase.next = 0.into();
        for i in 0..self._trackers {
            self.phase.next = self.tracker[i].phase.val();
        }
    }
}

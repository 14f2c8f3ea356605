//! Line monitor: settings of the sampling phase, and timing margin of the samples, for the host.
//!
//! ```text
//! edge_measured, edge_offset --> earliest and latest of the frame --(over)--> of the last frame
//!                            \-> earliest and latest since cleared, alarm
//!                            \-> histogram: read, add one, write (3 cycles)
//! ```
//!
//! Offsets count places (system clock cycles, or half ones with the double edge) from the expected place of an edge: 0 and -1 are
//! nearest to it, and half a bit is between them and the sample.
//!
//! The measurements do not depend on the EnDat clock; the settings take effect between two frames.

use crate::endat::features::Features;
use endat_macros::kernel;
use rtl_design::memory::Memory;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;

pub use endat_regs::line::word;

/// Settings after reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineStart {
    /// Source of the phase: 0 mean of many edges, 1 fixed delay, 2 start bit of each frame.
    pub phase_mode: u64,
    /// Delay in mode `fixed`, in sixteenths of a system clock cycle (15 bits).
    pub fixed_delay: u64,
    /// Majority of three samples.
    pub majority: bool,
    /// Drift that raises the alarm, in sixteenths of a system clock cycle (12 bits); 0 = none.
    pub drift_limit: u64,
    /// Offset that raises the alarm, in places (7 bits); 0 = none.
    pub offset_limit: u64,
    /// The histogram is cleared after reset: its RAM may start with any content.
    pub clears: bool,
}

/// Settings and margin of one channel.
#[derive(LogicBlock, Block)]
pub struct LineMonitor {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// A frame is under way: settings are frozen.
    pub busy: Signal<In, Bit>,
    /// Strobe: an edge of the answer has been measured.
    pub edge_measured: Signal<In, Bit>,
    /// Offset of the edge, in two's complement.
    pub edge_offset: Signal<In, Bits<8>>,
    /// Strobe: a frame has ended.
    pub over: Signal<In, Bit>,
    /// The frame had no good position.
    pub over_bad: Signal<In, Bit>,
    /// Strobe: a glitch has been removed.
    pub glitch: Signal<In, Bit>,
    /// Tracked delay, in sixteenths of a cycle.
    pub phase: Signal<In, Bits<15>>,
    /// The delay is known.
    pub calibrated: Signal<In, Bit>,
    /// Source of the phase.
    pub phase_mode: Signal<Out, Bits<2>>,
    /// Delay in mode `fixed`.
    pub fixed_delay: Signal<Out, Bits<15>>,
    /// Majority of three samples.
    pub majority: Signal<Out, Bit>,
    /// Drift or offset has exceeded its limit since cleared.
    pub alarm: Signal<Out, Bit>,
    /// Word that the host accesses; stable for at least 8 cycles.
    pub host_address: Signal<In, Bits<6>>,
    /// Strobe: read the word.
    pub host_read: Signal<In, Bit>,
    /// The word read.
    pub host_word: Signal<Out, Bits<32>>,
    /// Strobe: write one half of the word.
    pub host_write: Signal<In, Bit>,
    /// Half to write: 1 = high.
    pub host_half: Signal<In, Bit>,
    /// Data to write.
    pub host_data: Signal<In, Bits<16>>,
    /// Source of the phase as the host has written it.
    #[given]
    wanted_mode: Reg<Bits<2>>,
    /// Majority of three samples as the host has written it.
    #[given]
    wanted_majority: Reg<Bit>,
    /// A bin of the histogram is two to this power places wide.
    bin_shift: Reg<Bits<2>>,
    /// Fixed delay as the host has written it.
    #[given]
    wanted_delay: Reg<Bits<15>>,
    /// Drift that raises the alarm, in sixteenths of a system clock cycle; 0 = none.
    #[given]
    drift_limit: Reg<Bits<12>>,
    /// Offset that raises the alarm, in places; 0 = none.
    #[given]
    offset_limit: Reg<Bits<7>>,
    /// Source of the phase in use; copied between two frames.
    #[given]
    mode: Reg<Bits<2>>,
    /// Majority of three samples in use; copied between two frames.
    #[given]
    uses_majority: Reg<Bit>,
    /// Fixed delay in use; copied between two frames.
    #[given]
    delay: Reg<Bits<15>>,
    /// Word read by the host.
    word: Reg<Bits<32>>,
    /// Set when the host reads; cleared when the histogram is not being counted.
    read_wanted: Reg<Bit>,
    /// High for one cycle: the host's word comes from the histogram.
    read_ram: Reg<Bit>,
    /// Earliest edge of the frame; offset with its sign bit inverted, as in the other registers of edges.
    earliest: Reg<Bits<8>>,
    /// Latest edge of the frame.
    latest: Reg<Bits<8>>,
    /// First edge of the frame.
    start: Reg<Bits<8>>,
    /// Set when a frame ends; cleared by its first edge.
    #[start(true)]
    is_first: Reg<Bit>,
    /// Earliest edge of the last frame with any edge.
    told_earliest: Reg<Bits<8>>,
    /// Latest edge of the last frame with any edge.
    told_latest: Reg<Bits<8>>,
    /// First edge of the last frame with any edge.
    told_start: Reg<Bits<8>>,
    /// Earliest edge of all frames since cleared by the host.
    worst_earliest: Reg<Bits<8>>,
    /// Latest edge of all frames since cleared by the host.
    worst_latest: Reg<Bits<8>>,
    /// Set when a frame with an edge ends; cleared by the host.
    has_worst: Reg<Bit>,
    /// Tracked delay when it was measured, or when the host has set the reference.
    drift_reference: Reg<Bits<15>>,
    /// `calibrated` in the cycle before.
    was_calibrated: Reg<Bit>,
    /// Distance of the tracked delay from its reference, in sixteenths of a system clock cycle.
    drift: Reg<Bits<15>>,
    /// Set when the drift exceeds its limit; cleared by the host.
    drift_alarm: Reg<Bit>,
    /// Set when an offset exceeds its limit; cleared by the host.
    offset_alarm: Reg<Bit>,
    /// Pulses that the filter has removed since cleared by the host.
    glitches: Reg<Bits<16>>,
    /// Frames without a good position since cleared by the host.
    bad_frames: Reg<Bits<16>>,
    /// Frames since cleared by the host.
    frames: Reg<Bits<32>>,
    /// High for one cycle: the host clears what was measured.
    clear: Reg<Bit>,
    /// High while the bins of the histogram are cleared, one a cycle.
    #[given]
    clearing: Reg<Bit>,
    /// Bin of the histogram that is counted or cleared.
    bin: Reg<Bits<5>>,
    /// Cycles until the bin is written back; 0 = none is counted.
    step: Reg<Bits<2>>,
    histogram: Vec<Memory<32, 5>>,
    /// Word that the host accesses.
    at: Signal<Local, Bits<6>>,
    /// Value of this word, except for the histogram.
    shown: Signal<Local, Bits<32>>,
    /// Offset of the edge with its sign bit inverted: earlier is smaller.
    biased: Signal<Local, Bits<8>>,
    /// Size of the offset in bins.
    scaled: Signal<Local, Bits<8>>,
    /// Bin of this edge.
    next_bin: Signal<Local, Bits<5>>,
    /// Size of the offset in places; one less if it is negative.
    size: Signal<Local, Bits<8>>,
    has_margin: Constant<Bit>,
    _histograms: usize,
}

impl LineMonitor {
    /// A monitor with these features and settings.
    pub fn new(features: Features, start: LineStart) -> Self {
        let histograms = usize::from(features.margin);
        Self::from_parts(LineMonitorParts {
            wanted_mode: Reg::new(start.phase_mode.into()),
            wanted_majority: Reg::new(start.majority),
            wanted_delay: Reg::new(start.fixed_delay.into()),
            drift_limit: Reg::new(start.drift_limit.into()),
            offset_limit: Reg::new(start.offset_limit.into()),
            mode: Reg::new(start.phase_mode.into()),
            uses_majority: Reg::new(start.majority),
            delay: Reg::new(start.fixed_delay.into()),
            clearing: Reg::new(start.clears & features.margin),
            histogram: (0..histograms).map(|_| Default::default()).collect(),
            has_margin: Constant::new(features.margin),
            _histograms: histograms,
        })
    }
}

#[kernel]
impl Logic for LineMonitor {
    fn update(&mut self) {
        self.take_settings();
        self.watch_edges();
        self.raise_alarms();
        self.count_edges();
        self.answer_host();
    }

    /// Settings: written in halves, take effect between two frames.
    fn take_settings(&mut self) {
        self.at.next = self.host_address.val();
        self.clear.d.next = false;
        if self.host_write.val() & !self.host_half.val() {
            if self.at.val() == offset!(line.alignment) {
                self.wanted_mode.d.next = half!(self.host_data.val(), line.alignment.mode);
                self.wanted_majority.d.next = half!(self.host_data.val(), line.alignment.majority);
                self.bin_shift.d.next = half!(self.host_data.val(), line.alignment.bin_shift);
            }
            if self.at.val() == offset!(line.fixed_delay) {
                self.wanted_delay.d.next = half!(self.host_data.val(), line.fixed_delay.value);
            }
            if self.at.val() == offset!(line.limits) {
                self.drift_limit.d.next = half!(self.host_data.val(), line.limits.drift);
            }
            if self.at.val() == offset!(line.clear) {
                self.clear.d.next = half!(self.host_data.val(), line.clear.clear);
                if half!(self.host_data.val(), line.clear.reference) {
                    self.drift_reference.d.next = self.phase.val();
                }
            }
        }
        if self.host_write.val() & self.host_half.val() & (self.at.val() == offset!(line.limits)) {
            self.offset_limit.d.next = half!(self.host_data.val(), line.limits.offset);
        }
        if !self.busy.val() {
            self.mode.d.next = self.wanted_mode.q.val();
            self.uses_majority.d.next = self.wanted_majority.q.val();
            self.delay.d.next = self.wanted_delay.q.val();
        }
        self.phase_mode.next = self.mode.q.val();
        self.majority.next = self.uses_majority.q.val();
        self.fixed_delay.next = self.delay.q.val();
    }

    /// Earliest and latest edge, of a frame and since clear.
    fn watch_edges(&mut self) {
        // Offsets with inverted sign bit: earlier is smaller.
        self.biased.next = self.edge_offset.val() ^ 0x80;
        if self.edge_measured.val() & self.has_margin.val() {
            if self.is_first.q.val() {
                self.start.d.next = self.biased.val();
            }
            if self.is_first.q.val() | (self.biased.val() < self.earliest.q.val()) {
                self.earliest.d.next = self.biased.val();
            }
            if self.is_first.q.val() | (self.biased.val() > self.latest.q.val()) {
                self.latest.d.next = self.biased.val();
            }
            self.is_first.d.next = false;
        }
        if self.over.val() & self.has_margin.val() {
            self.frames.d.next = self.frames.q.val() + 1;
            if self.over_bad.val() {
                self.bad_frames.d.next = self.bad_frames.q.val() + 1;
            }
            self.is_first.d.next = true;
            if !self.is_first.q.val() {
                self.told_earliest.d.next = self.earliest.q.val();
                self.told_latest.d.next = self.latest.q.val();
                self.told_start.d.next = self.start.q.val();
                self.has_worst.d.next = true;
                if !self.has_worst.q.val() | (self.earliest.q.val() < self.worst_earliest.q.val()) {
                    self.worst_earliest.d.next = self.earliest.q.val();
                }
                if !self.has_worst.q.val() | (self.latest.q.val() > self.worst_latest.q.val()) {
                    self.worst_latest.d.next = self.latest.q.val();
                }
            }
        }
        if self.glitch.val() & self.has_margin.val() {
            self.glitches.d.next = self.glitches.q.val() + 1;
        }
    }

    /// Alarms: the tracked delay has drifted, or an edge was too far from its expected place.
    fn raise_alarms(&mut self) {
        self.was_calibrated.d.next = self.calibrated.val();
        if self.calibrated.val() & !self.was_calibrated.q.val() {
            self.drift_reference.d.next = self.phase.val();
        }
        self.drift.d.next = self.phase.val() - self.drift_reference.q.val();
        if self.phase.val() < self.drift_reference.q.val() {
            self.drift.d.next = self.drift_reference.q.val() - self.phase.val();
        }
        if self.drift_limit.q.val().any()
            & self.was_calibrated.q.val()
            & (self.drift.q.val() > bit_cast::<15, 12>(self.drift_limit.q.val()))
        {
            self.drift_alarm.d.next = true;
        }
        self.size.next = self.edge_offset.val();
        if self.edge_offset.val().get_bit(7) {
            self.size.next = !self.edge_offset.val();
        }
        if self.offset_limit.q.val().any()
            & self.edge_measured.val()
            & (self.size.val() > bit_cast::<8, 7>(self.offset_limit.q.val()))
        {
            self.offset_alarm.d.next = true;
        }
        self.alarm.next = self.drift_alarm.q.val() | self.offset_alarm.q.val();
    }

    /// Histogram: an edge that arrives while the previous one is counted is skipped.
    fn count_edges(&mut self) {
        self.scaled.next = self.size.val() >> self.bin_shift.q.val();
        self.next_bin.next = self.scaled.val().get_bits::<5>(0) | 0x10;
        if self.scaled.val().get_bits::<4>(4).any() {
            self.next_bin.next = 31.into();
        }
        if self.edge_offset.val().get_bit(7) {
            self.next_bin.next = !self.scaled.val().get_bits::<5>(0) & 0x0F;
            if self.scaled.val().get_bits::<4>(4).any() {
                self.next_bin.next = 0.into();
            }
        }
        if self.step.q.val().any() {
            self.step.d.next = self.step.q.val() - 1;
        } else {
            if self.edge_measured.val() & self.has_margin.val() & !self.clearing.q.val() {
                self.bin.d.next = self.next_bin.val();
                self.step.d.next = 3.into();
            }
        }
        if self.clearing.q.val() {
            self.bin.d.next = self.bin.q.val() + 1;
            if self.bin.q.val().all() {
                self.clearing.d.next = false;
            }
        }
        if self.clear.q.val() {
            self.has_worst.d.next = false;
            self.worst_earliest.d.next = 0.into();
            self.worst_latest.d.next = 0.into();
            self.drift_alarm.d.next = false;
            self.offset_alarm.d.next = false;
            self.glitches.d.next = 0.into();
            self.bad_frames.d.next = 0.into();
            self.frames.d.next = 0.into();
            self.clearing.d.next = self.has_margin.val();
            self.bin.d.next = 0.into();
            self.step.d.next = 0.into();
        }
    }

    /// Reading: the RAM is read while no edge is counted.
    fn answer_host(&mut self) {
        self.shown.next = 0.into();
        match self.at.val().index() {
            offset!(line.alignment) => {
                self.shown.next = place!(self.wanted_mode.q.val(), line.alignment.mode)
                    | place!(self.wanted_majority.q.val(), line.alignment.majority)
                    | place!(self.bin_shift.q.val(), line.alignment.bin_shift);
            }
            offset!(line.fixed_delay) => {
                self.shown.next = place!(self.wanted_delay.q.val(), line.fixed_delay.value);
            }
            offset!(line.limits) => {
                self.shown.next = place!(self.drift_limit.q.val(), line.limits.drift)
                    | place!(self.offset_limit.q.val(), line.limits.offset);
            }
            offset!(line.frame) => {
                self.shown.next = place!(self.told_earliest.q.val() ^ 0x80, line.frame.earliest)
                    | place!(self.told_latest.q.val() ^ 0x80, line.frame.latest)
                    | place!(self.told_start.q.val() ^ 0x80, line.frame.start);
            }
            offset!(line.worst) => {
                self.shown.next = place!(self.worst_earliest.q.val() ^ 0x80, line.worst.earliest)
                    | place!(self.worst_latest.q.val() ^ 0x80, line.worst.latest)
                    | place!(self.has_worst.q.val(), line.worst.valid)
                    | place!(self.drift_alarm.q.val(), line.worst.drift_alarm)
                    | place!(self.offset_alarm.q.val(), line.worst.offset_alarm);
            }
            offset!(line.phase) => {
                self.shown.next = place!(self.phase.val(), line.phase.tracked)
                    | place!(self.drift_reference.q.val(), line.phase.reference);
            }
            offset!(line.counts) => {
                self.shown.next = place!(self.glitches.q.val(), line.counts.glitches)
                    | place!(self.bad_frames.q.val(), line.counts.bad_frames);
            }
            offset!(line.frames) => {
                self.shown.next = self.frames.q.val();
            }
            _ => {}
        }
        if self.host_read.val() {
            self.read_wanted.d.next = true;
            self.word.d.next = self.shown.val();
        }
        self.read_ram.d.next = false;
        if self.read_wanted.q.val() & !self.step.q.val().any() {
            self.read_wanted.d.next = false;
            self.read_ram.d.next = !self.at.val().get_bit(5) & self.has_margin.val();
        }
        for i in 0..self._histograms {
            self.histogram[i].clock.next = self.clock.val();
            self.histogram[i].read_address.next = self.bin.q.val();
            if !self.step.q.val().any() {
                self.histogram[i].read_address.next = self.at.val().get_bits::<5>(0);
            }
            self.histogram[i].write_address.next = self.bin.q.val();
            self.histogram[i].write_enable.next = (self.step.q.val() == 1) | self.clearing.q.val();
            self.histogram[i].write_data.next = self.histogram[i].read_data.val() + 1;
            if self.clearing.q.val() {
                self.histogram[i].write_data.next = 0.into();
            }
            if self.read_ram.q.val() {
                self.word.d.next = self.histogram[i].read_data.val();
            }
        }
        self.host_word.next = self.word.q.val();
    }
}

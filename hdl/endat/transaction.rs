//! Transaction: the sequence of a frame, all its time-outs, and its faults.
//!
//! ```text
//! wire      NotReady Ready FirstLow Frame ................ Tail Recovery NotReady Ready
//! endat_clk ~~~~~~~~~~~~~~\________/~\_/~\_ ... _/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
//! data      \_____________? command    0 S F1 .. CRC ~~~~~~~~~~~~~~~\_________________
//! done      _______________________________________________/\_________________________
//! ```
//!
//! With a supplement the clock stays LOW after the last CRC bit (`Park`), and `Frame` continues until its cells are over.
//!
//! A frame that measures the delay brings no position: at the slow clock an encoder of another width can look like a good one. The frame at the full
//! clock follows automatically, and its result is the trigger's. A trigger begins a frame, or `own` does, for a request with a separate
//! frame. The result of a triggered frame is published; `over` reports the outcome of every frame.
//!
//! Every wait has a limit. Whatever ends a frame before its CRC follows the abort rule: clock HIGH, driver
//! off, 30 ms, then data low for longer than tR. So does a reset, which may have come in the middle of a frame. If DATA was HIGH
//! between two frames, an encoder may have been plugged in: the delay is measured again.
//!
//! Ref: HEIDENHAIN PWM 20 user's manual (times); ArtInChip ENDAT-IF, watchdog (abort rule).

pub use endat_regs::causes::endat as cause;
mod kernel;
pub mod last_edge;
pub mod phase;
pub mod primary;
pub mod verdict;

use crate::endat::features::{Features, FixedTimes};
use crate::endat::line_health::LineHealth;
use crate::endat::ports::*;
use crate::endat::timing;
use crate::protected_bit::ProtectedBit;
use crate::replicate::numbered;
use cause::flag;
use last_edge::LastEdge;
use phase::Phase;
use rtl_design::reg::Reg;
use rtl_design::Block;
use rust_hdl::prelude::*;
use verdict::Verdict;

/// Sequence, time-outs and verdict of one channel.
#[derive(LogicBlock, Block)]
#[properties("../properties/transaction.sv")]
pub struct Transaction {
    /// System clock.
    pub clock: Signal<In, Clock>,
    /// Synchronous reset.
    pub reset: Signal<In, Bit>,
    /// One-cycle strobe each microsecond.
    pub tick_us: Signal<In, Bit>,
    /// Start of the next frame, and its parameters.
    #[bundle]
    pub next_frame: NextFrameIn,
    /// The delay comes from a register: no frame measures it.
    pub is_fixed: Signal<In, Bit>,
    /// The data line.
    pub level: Signal<In, Bit>,
    /// Places of the answer's cells.
    #[bundle]
    pub cells: CellsIn,
    /// Strobe: middle of the expected place of a data edge.
    pub center: Signal<In, Bit>,
    /// Progress of a receiver.
    #[bundle]
    pub progress: ProgressIn,
    /// Parts of an answer.
    #[bundle]
    pub shape: AnswerShapeIn,
    /// The watchdog applies to the frame under way.
    pub is_watched: Signal<In, Bit>,
    /// Settings of the frame have changed since its start.
    pub settings_upset: Signal<In, Bit>,
    /// Checks of an answer.
    #[bundle]
    pub check: AnswerCheckIn,
    /// Strobe one cycle before each rising clock edge.
    pub will_rise: Signal<In, Bit>,
    /// The tracked delay differs from the measured one.
    pub delay_upset: Signal<In, Bit>,
    /// Time limits for the parts of a frame.
    #[bundle]
    pub limits: FrameLimitsIn,
    /// Control of a receiver during a frame.
    #[bundle]
    pub control: ControlOut,
    /// Timing control of the cells of a frame.
    #[bundle]
    pub cell_control: CellControlOut,
    /// Keeps the clock low.
    pub hold_low: Signal<Out, Bit>,
    /// Keeps the clock high: no frame, or all its edges have been sent.
    pub stop: Signal<Out, Bit>,
    /// Drives the line LOW to test whether it follows.
    pub probe: Signal<Out, Bit>,
    /// A probe is under way, or has just ended.
    pub is_probed: Signal<Out, Bit>,
    /// A trigger would be lost.
    pub busy: Signal<Out, Bit>,
    /// Outcome of a frame.
    #[bundle]
    pub told: ToldOut,
    /// Strobe, in the same cycle: a frame begins, or is refused.
    pub begun: Signal<Out, Bit>,
    /// No frame is under way, and the last one has been reported completely.
    pub is_at_rest: Signal<Out, Bit>,
    /// Strobe: a frame has ended, normally or not; `cause` and `flags` are valid.
    pub over: Signal<Out, Bit>,
    /// Strobe: a trigger is lost.
    pub displaced: Signal<Out, Bit>,
    /// The propagation delay is known.
    pub calibrated: Signal<Out, Bit>,
    /// Recovery time tm of the last frame, in system clock cycles.
    pub recovery_cycles: Signal<Out, Bits<13>>,
    #[start]
    health: LineHealth,
    last_edge: LastEdge,
    verdict: Verdict,
    has_guards: Constant<Bit>,
    has_all: Constant<Bit>,
    has_diagnosis: Constant<Bit>,
    has_continuous: Constant<Bit>,
    has_alignment: Constant<Bit>,
    /// Time tR that DATA must be LOW before a frame, in system clock cycles.
    ready_low_cycles: Constant<Bits<16>>,
    /// Quiet time after an aborted frame, in microseconds.
    abort_us: Constant<Bits<16>>,
    /// CLOCK LOW between an answer and its supplement, in system clock cycles.
    park_cycles: Constant<Bits<16>>,
    /// Longest wait for the answer to a command with a parameter, in microseconds.
    parameter_timeout_us: Constant<Bits<16>>,
    /// Longest recovery time tm after a request's frame, in system clock cycles.
    own_recovery_limit_cycles: Constant<Bits<16>>,
    /// Bit of the timer that rises only when a wait is longer than any answer.
    frame_us: Constant<Bits<16>>,
    /// Time that DATA is driven LOW to probe the line, in microseconds.
    probe_us: Constant<Bits<16>>,
    /// Time for the line to settle after a probe, in microseconds.
    settle_us: Constant<Bits<16>>,
    /// CLOCK HIGH at the end of a running clock, in microseconds.
    leave_us: Constant<Bits<16>>,
    data_not_low: Constant<Bits<20>>,
    no_encoder: Constant<Bits<20>>,
    stuck_high: Constant<Bits<20>>,
    no_start_bit: Constant<Bits<20>>,
    stuck_low: Constant<Bits<20>>,
    late_start: Constant<Bits<20>>,
    start_window: Constant<Bits<20>>,
    unknown_command: Constant<Bits<20>>,
    info_not_there: Constant<Bits<20>>,
    not_falling: Constant<Bits<20>>,
    too_long: Constant<Bits<20>>,
    tail_low: Constant<Bits<20>>,
    upset: Constant<Bits<20>>,
    /// Phase of the frame, or of the pause between two frames.
    phase: Reg<Phase>,
    /// Time since the present wait began: microseconds in `Frame`, `Tail` and `Abort`, else system clock cycles.
    timer: Reg<Bits<16>>,
    /// `limit`, one cycle later.
    timer_limit: Reg<Bits<16>>,
    /// High when the timer has reached its limit; low again when the next wait begins.
    timer_hit: Reg<Bit>,
    /// High in a cycle in which the timer counts: every cycle, or one for each microsecond.
    timer_step: Reg<Bit>,
    /// High while CLOCK is held LOW: first low phase, wait for the start bit, or pause before the supplement.
    hold: Reg<Bit>,
    /// High for one cycle after `accept`: the frame begins.
    starting: Reg<Bit>,
    /// `running`, one cycle later.
    was_running: Reg<Bit>,
    /// High if the first low phase of a frame is longer than the others.
    extra: Reg<Bit>,
    /// High while CLOCK stays HIGH: no frame runs, or the frame is aborted, or the running clock stops.
    #[start(true)]
    stopping: Reg<Bit>,
    /// Set when the delay is measured; cleared by an abort, two wrong CRCs in a row, `afresh` or a fixed delay.
    is_calibrated: Reg<Bit>,
    /// Set when a frame begins that finds the delay from its start edge; cleared in its tail or by the next frame.
    acquiring: Reg<Bit>,
    /// High if the frame runs at the calibration clock; set or cleared with `accept`, cleared after the tail.
    is_slow: Reg<Bit>,
    /// Measuring frames so far, of four; 0 after an abort, two wrong CRCs in a row or `afresh`.
    passes: Reg<Bits<2>>,
    /// Set when the cell after the answer has been sampled in `Recovery`; cleared when a frame begins.
    tail_sampled: Reg<Bit>,
    /// Recovery time tm of the last frame, in system clock cycles.
    recovery: Reg<Bits<13>>,
    /// Set when the supplement begins; cleared when the next frame begins.
    in_supplement: Reg<Bit>,
    /// High for one cycle: the supplement begins.
    supplement_starts: Reg<Bit>,
    /// Set when the result of the frame is certain; a fault after that is a late one. Cleared with the frame.
    answered: Reg<Bit>,
    /// `hunting` in the cycle before.
    was_hunting: Reg<Bit>,
    /// `center` in the cycle before.
    was_center: Reg<Bit>,
    /// Set when a missing start bit is reported and the clock continues; cleared by an abort or the next frame.
    late: Reg<Bit>,
    /// High while DATA is driven LOW in `Abort` to test whether the line follows.
    probing: Reg<Bit>,
    /// High from the end of a probe until the line has settled.
    settling: Reg<Bit>,
    /// High while the clock continues from one answer to the next.
    runs: Vec<ProtectedBit>,
    /// High while the clock continues from one answer to the next; low without that feature.
    going: Signal<Local, Bit>,
    _runs: usize,
    /// High from the end of a running clock until its quiet time is over; that is shorter than after an abort.
    leaving: Reg<Bit>,
    /// High in the cycle after `timer_clear` or `rise_back`: the timer restarts.
    #[start(true)]
    cleared: Reg<Bit>,
    /// High for one cycle: DATA was HIGH between two frames, so an encoder may have been plugged.
    plugged: Reg<Bit>,
    /// High for one cycle after `rise_back`: the timer restarts with the cycles that have passed since.
    is_back: Reg<Bit>,
    /// High for one cycle after a running clock has stopped.
    left: Reg<Bit>,
    /// High if DATA has been HIGH since the last microsecond tick.
    high_at_tick: Reg<Bit>,
    /// High from the trigger of a frame until its result is published.
    owing: Reg<Bit>,
    /// High if the frame begun last runs at the calibration clock, to measure the delay.
    measuring: Reg<Bit>,
    /// High from the end of a measuring frame until the frame begins that brings the trigger's position.
    once_more: Reg<Bit>,
    /// High from the start of a frame until it ends or is aborted.
    under_way: Reg<Bit>,
    /// Limit of the timer in this phase.
    limit: Signal<Local, Bits<16>>,
    /// High in the phases of a frame in which its cells run.
    running: Signal<Local, Bit>,
    /// High if the timer counts microseconds in this phase, low if it counts system clock cycles.
    in_us: Signal<Local, Bit>,
    timer_clear: Signal<Local, Bit>,
    /// High for one cycle when the last rising edge of CLOCK has come back: the recovery time begins.
    rise_back: Signal<Local, Bit>,
    in_tail: Signal<Local, Bit>,
    in_recovery: Signal<Local, Bit>,
    /// High for one cycle: a frame begins.
    accept: Signal<Local, Bit>,
    /// High if the frame, or the wait for one, ends with the fault in `found`.
    give_up: Signal<Local, Bit>,
    /// High if a trigger in this cycle is not lost: it begins a frame, or reports a fault at once.
    idle: Signal<Local, Bit>,
    /// High if a trigger, an owed position or a request asks for a frame.
    wanted: Signal<Local, Bit>,
    /// `trigger`, unless frames are held off.
    triggered: Signal<Local, Bit>,
    /// High for one cycle: this trigger has a result without a frame.
    refuse: Signal<Local, Bit>,
    /// High for one cycle: the frame has ended without an abort.
    normal_end: Signal<Local, Bit>,
    /// High while CLOCK is LOW between the answer and its supplement.
    parking: Signal<Local, Bit>,
    /// High if the start bit has been received and all pulses of the frame are sent; low before a supplement.
    sent: Signal<Local, Bit>,
    /// High if the frame belongs to a request, not to a trigger.
    own: Signal<Local, Bit>,
    /// Flags of the faults found in this cycle.
    found: Signal<Local, Bits<20>>,
    /// Flags for a line that is HIGH between two frames.
    not_low: Signal<Local, Bits<20>>,
    /// Flags for a missing start bit.
    no_start: Signal<Local, Bits<20>>,
    /// High for one cycle: a missing start bit is reported, and the clock continues to detect a late one.
    announce: Signal<Local, Bit>,
    /// High for one cycle: the answer and its CRC have been received.
    answer_taken: Signal<Local, Bit>,
    /// High for one cycle at the end of a probe: the level of DATA is its result.
    probed: Signal<Local, Bit>,
    /// High if the present wait is longer than any answer: the receiver has lost its place.
    endless: Signal<Local, Bit>,
    /// High in the phases that the watchdog times.
    watched: Signal<Local, Bit>,
    /// High if the propagation delay is measured or fixed.
    known: Signal<Local, Bit>,
    /// High with `give_up` if the frame has its result already.
    found_late: Signal<Local, Bit>,
    /// High for one cycle: the running clock stops.
    leave: Signal<Local, Bit>,
    /// High for one cycle: a trigger is lost.
    lost: Signal<Local, Bit>,
    /// High if the position after a measuring frame asks for a frame.
    owed: Signal<Local, Bit>,
    /// High for one cycle when the bit after the answer shows that the answer has the right length.
    proof: Signal<Local, Bit>,
    /// High if a frame or its result is outstanding; between two frames this means an upset register.
    vanished: Signal<Local, Bit>,
    /// High if the delay must be measured again: on request, after an encoder change or after an upset.
    afresh: Signal<Local, Bit>,
}

impl Transaction {
    /// A transaction with these fixed times and features.
    pub fn new(times: FixedTimes, features: Features) -> Self {
        Self::from_parts(TransactionParts {
            last_edge: LastEdge::new(features),
            verdict: Verdict::new(times, features),
            has_all: Constant::new(features.requests),
            has_diagnosis: Constant::new(features.diagnosis),
            has_continuous: Constant::new(features.continuous),
            has_alignment: Constant::new(features.alignment),
            ready_low_cycles: Constant::new(times.ready_low_cycles.into()),
            abort_us: Constant::new(times.abort_us.into()),
            park_cycles: Constant::new(times.park_cycles.into()),
            parameter_timeout_us: Constant::new(times.parameter_timeout_us.into()),
            own_recovery_limit_cycles: Constant::new(times.own_recovery_limit_cycles.into()),
            frame_us: Constant::new(times.frame_us.into()),
            probe_us: Constant::new(timing::PROBE_US.into()),
            settle_us: Constant::new(timing::SETTLE_US.into()),
            leave_us: Constant::new(timing::LEAVE_US.into()),
            data_not_low: Constant::new(flag(cause::DATA_NOT_LOW).into()),
            no_encoder: Constant::new(flag(cause::NO_ENCODER).into()),
            stuck_high: Constant::new(flag(cause::STUCK_HIGH).into()),
            no_start_bit: Constant::new(flag(cause::NO_START_BIT).into()),
            stuck_low: Constant::new(flag(cause::STUCK_LOW).into()),
            late_start: Constant::new(flag(cause::LATE_START).into()),
            start_window: Constant::new(flag(cause::START_WINDOW).into()),
            unknown_command: Constant::new(flag(cause::UNKNOWN_COMMAND).into()),
            info_not_there: Constant::new(flag(cause::INFO_MISSING).into()),
            not_falling: Constant::new(flag(cause::DATA_NOT_FALLING).into()),
            too_long: Constant::new(flag(cause::WATCHDOG).into()),
            tail_low: Constant::new(flag::TAIL_LOW.into()),
            upset: Constant::new(flag(cause::UPSET).into()),
            runs: numbered(usize::from(features.continuous), |_| {
                ProtectedBit::new(features.upset_guards)
            }),
            has_guards: Constant::new(features.upset_guards),
            _runs: features.continuous.into(),
        })
    }
}

//! Transaction: the order of one frame, all its time-outs, and what went wrong.
//!
//! ```text
//! wire      NotReady Ready FirstLow Frame ................ Tail Recovery NotReady Ready
//! endat_clk ~~~~~~~~~~~~~~\________/~\_/~\_ ... _/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
//! data      \_____________? command    0 S F1 .. CRC ~~~~~~~~~~~~~~~\_________________
//! done      _______________________________________________/\_________________________
//! ```
//!
//! With a supplement the clock stays LOW after the last CRC bit (`Park`), and `Frame` goes on until its cells are over.
//!
//! A frame that measures the delay brings no position: at the slow clock an encoder of another width can look like a good one. The frame at the full
//! clock follows by itself, and its result is the trigger's. A frame is begun by a trigger, or by `own`, for a request that needs the line for
//! itself. What becomes of the first is published; what becomes of either is told with `over`.
//!
//! Nothing waits without a limit. Whatever ends a frame before its CRC follows the abort rule: clock HIGH, driver
//! off, 30 ms, then data low for longer than tR. So does a reset, which may have come in the middle of a frame. DATA that was HIGH
//! between two frames means that something was plugged: the delay is measured again.
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
    /// What begins the next frame, and what it is.
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
    /// How far a receiver is.
    #[bundle]
    pub progress: ProgressIn,
    /// What an answer consists of.
    #[bundle]
    pub shape: AnswerShapeIn,
    /// The watchdog times the frame under way.
    pub is_watched: Signal<In, Bit>,
    /// Settings of the frame are not what they were at its start.
    pub settings_upset: Signal<In, Bit>,
    /// What an answer says of itself.
    #[bundle]
    pub check: AnswerCheckIn,
    /// Strobe one cycle before each rising clock edge.
    pub will_rise: Signal<In, Bit>,
    /// The tracked delay is not what was measured.
    pub delay_upset: Signal<In, Bit>,
    /// How long the parts of a frame may take.
    #[bundle]
    pub limits: FrameLimitsIn,
    /// What a receiver is told of the frame.
    #[bundle]
    pub control: ControlOut,
    /// How the cells of a frame run.
    #[bundle]
    pub cell_control: CellControlOut,
    /// Keeps the clock low.
    pub hold_low: Signal<Out, Bit>,
    /// Keeps the clock high: no frame, or all its edges have been sent.
    pub stop: Signal<Out, Bit>,
    /// Drives the line LOW, to see whether it follows.
    pub probe: Signal<Out, Bit>,
    /// It has just done so, or does.
    pub is_probed: Signal<Out, Bit>,
    /// A trigger would not be taken.
    pub busy: Signal<Out, Bit>,
    /// What has become of a frame.
    #[bundle]
    pub told: ToldOut,
    /// Strobe, in the same cycle: a frame is begun, or refused.
    pub begun: Signal<Out, Bit>,
    /// No frame is under way, and all that there is to tell of the last one has been told.
    pub is_at_rest: Signal<Out, Bit>,
    /// Strobe: a frame has ended in whatever way, `cause` and `flags` are valid.
    pub over: Signal<Out, Bit>,
    /// Strobe: a trigger has been lost.
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
    ready_low_cycles: Constant<Bits<16>>,
    abort_us: Constant<Bits<16>>,
    park_cycles: Constant<Bits<16>>,
    parameter_timeout_us: Constant<Bits<16>>,
    own_recovery_limit_cycles: Constant<Bits<16>>,
    frame_us: Constant<Bits<16>>,
    probe_us: Constant<Bits<16>>,
    settle_us: Constant<Bits<16>>,
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
    phase: Reg<Phase>,
    timer: Reg<Bits<16>>,
    timer_limit: Reg<Bits<16>>,
    timer_hit: Reg<Bit>,
    timer_step: Reg<Bit>,
    hold: Reg<Bit>,
    start_now: Reg<Bit>,
    run_now: Reg<Bit>,
    extra: Reg<Bit>,
    #[start(true)]
    stop_now: Reg<Bit>,
    is_calibrated: Reg<Bit>,
    acquiring: Reg<Bit>,
    slow_now: Reg<Bit>,
    passes: Reg<Bits<2>>,
    tail_sampled: Reg<Bit>,
    recovery: Reg<Bits<13>>,
    in_supplement: Reg<Bit>,
    supplement_now: Reg<Bit>,
    answered: Reg<Bit>,
    was_hunting: Reg<Bit>,
    was_center: Reg<Bit>,
    late: Reg<Bit>,
    probing: Reg<Bit>,
    settling: Reg<Bit>,
    runs: Vec<ProtectedBit>,
    going: Signal<Local, Bit>,
    _runs: usize,
    leaving: Reg<Bit>,
    #[start(true)]
    cleared: Reg<Bit>,
    /// DATA was HIGH between two frames in the cycle before.
    plugged: Reg<Bit>,
    /// The recovery time has begun in the cycle before.
    is_back: Reg<Bit>,
    /// A running clock has been left in the cycle before.
    left: Reg<Bit>,
    high_at_tick: Reg<Bit>,
    owing: Reg<Bit>,
    measuring: Reg<Bit>,
    once_more: Reg<Bit>,
    under_way: Reg<Bit>,
    limit: Signal<Local, Bits<16>>,
    running: Signal<Local, Bit>,
    in_us: Signal<Local, Bit>,
    timer_clear: Signal<Local, Bit>,
    rise_back: Signal<Local, Bit>,
    in_tail: Signal<Local, Bit>,
    in_recovery: Signal<Local, Bit>,
    accept: Signal<Local, Bit>,
    give_up: Signal<Local, Bit>,
    idle: Signal<Local, Bit>,
    wanted: Signal<Local, Bit>,
    triggered: Signal<Local, Bit>,
    refuse: Signal<Local, Bit>,
    normal_end: Signal<Local, Bit>,
    parking: Signal<Local, Bit>,
    sent: Signal<Local, Bit>,
    own: Signal<Local, Bit>,
    found: Signal<Local, Bits<20>>,
    not_low: Signal<Local, Bits<20>>,
    no_start: Signal<Local, Bits<20>>,
    announce: Signal<Local, Bit>,
    answer_taken: Signal<Local, Bit>,
    probed: Signal<Local, Bit>,
    endless: Signal<Local, Bit>,
    watched: Signal<Local, Bit>,
    known: Signal<Local, Bit>,
    found_late: Signal<Local, Bit>,
    leave: Signal<Local, Bit>,
    lost: Signal<Local, Bit>,
    owed: Signal<Local, Bit>,
    proof: Signal<Local, Bit>,
    vanished: Signal<Local, Bit>,
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

//! The registers of a design: one flip-flop block with reset and start value, one for synchroniser stages, and one for those that
//! look at a pin in the middle of the clock cycle.
//!
//! rust-hdl's own `DFF` has no reset; every state bit is one of these blocks, so every register
//! has a synchronous reset and a defined value at power-up, and elaboration knows a register when it sees one
//! (by the name in [`Logic::timing`]).

use rust_hdl::prelude::*;

/// [`TimingInfo`] name by which elaboration recognises [`Reg`].
pub const REG_TIMING: &str = "rtl_design_reg";
/// [`TimingInfo`] name by which elaboration recognises [`SyncReg`].
pub const SYNC_REG_TIMING: &str = "rtl_design_sync_reg";
/// [`TimingInfo`] name by which elaboration recognises [`FallReg`].
pub const FALL_REG_TIMING: &str = "rtl_design_fall_reg";

fn register_timing(name: &str) -> Vec<TimingInfo> {
    vec![TimingInfo {
        name: name.into(),
        clock: "clock".into(),
        inputs: vec!["d".into()],
        outputs: vec!["q".into()],
    }]
}

macro_rules! register_block {
    ($(#[$doc:meta])* $name:ident, $timing:expr, $edge:ident) => {
        $(#[$doc])*
        #[derive(Clone, Debug, LogicBlock)]
        pub struct $name<T: Synth> {
            /// System clock.
            pub clock: Signal<In, Clock>,
            /// Synchronous reset, active high: loads the start value.
            pub reset: Signal<In, Bit>,
            /// Next value.
            pub d: Signal<In, T>,
            /// Present value.
            pub q: Signal<Out, T>,
            start: Constant<T>,
        }

        impl<T: Synth> $name<T> {
            /// A register that powers up at `start` and returns to it on reset.
            pub fn new(start: T) -> Self {
                Self {
                    clock: Signal::default(),
                    reset: Signal::default(),
                    d: Signal::default(),
                    q: Signal::new_with_default(start),
                    start: Constant::new(start),
                }
            }
        }

        impl<T: Synth> Default for $name<T> {
            fn default() -> Self {
                Self::new(T::default())
            }
        }

        impl<T: Synth> Logic for $name<T> {
            fn update(&mut self) {
                if self.clock.$edge() {
                    self.q.next = if self.reset.val() { self.start.val() } else { self.d.val() };
                }
            }
            fn connect(&mut self) {
                self.q.connect();
            }
            fn timing(&self) -> Vec<TimingInfo> {
                register_timing($timing)
            }
        }
    };
}

register_block!(
    /// A register with synchronous reset and start value.
    Reg,
    REG_TIMING,
    pos_edge
);
register_block!(
    /// One stage of a synchroniser: like [`Reg`], but emitted with attributes that keep it a separate flip-flop.
    SyncReg,
    SYNC_REG_TIMING,
    pos_edge
);
register_block!(
    /// A synchroniser stage that samples on the falling edge of the clock. Its input must be a pin of the design,
    /// and its reader a synchroniser: all other logic has whole cycles.
    FallReg,
    FALL_REG_TIMING,
    neg_edge
);

//! Optional parts of a card, as `capabilities.features` and `protocols.features` report them.

use crate::named::named;
use crate::Named;

/// `Variant = bit, "name", "meaning", "configuration table and key";`
macro_rules! parts {
    ($($variant:ident = $bit:literal, $name:literal, $meaning:literal, $switch:literal;)*) => {
        /// Part of a card; the number is its bit.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Part {
            $(
                #[doc = concat!($meaning, ".")]
                $variant = $bit,
            )*
        }

        impl Part {
            /// All parts, lowest bit first.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Table and key that select it in a configuration; empty if every card has it.
            pub const fn switch(self) -> &'static str {
                match self {
                    $(Self::$variant => $switch,)*
                }
            }
        }

        const ALL_FEATURES: &[Named] = &[$(named($name, $bit, $meaning)),*];
    };
}

parts! {
    EnDat22 = 0, "endat22", "EnDat 2.2 position frames (111000)", "[[channel]] protocol";
    LineDelay = 1, "line_delay", "line delay is measured", "[[channel]] protocol";
    TriggerPin = 2, "trigger_pin", "trigger pin", "";
    TriggerTimer = 3, "trigger_timer", "trigger timer", "";
    Requests = 4, "requests", "requests", "[service] parts";
    Initialise = 5, "initialise", "initialisation", "[service] parts";
    Diagnosis = 6, "diagnosis", "diagnosis of the line", "[service] parts";
    Continuous = 7, "continuous", "continuous clock", "[service] parts";
    Alignment = 8, "alignment", "selectable sampling phase, mean of many edges", "[line] parts";
    Margin = 9, "margin", "timing margin of the samples", "[line] parts";
    DoubleEdge = 10, "double_edge", "DATA sampled on both edges of the system clock", "[line] parts";
    Stream = 11, "stream", "stream of sample sets", "[stream]";
    Direct = 12, "direct", "direct outputs", "[outputs] parts";
    Interrupt = 13, "interrupt", "interrupt", "[outputs] parts";
    TFormat = 14, "t_format", "T-format channels", "[[channel]] protocol = \"t_format\"";
    OwnTrigger = 15, "own_trigger", "enable, divider and trigger sources for each channel", "[[channel]] trigger";
    RecoveryCounter = 16, "recovery_counter", "recovery time measured independently", "[safety] parts";
    SecondInterface = 17, "second_interface", "results for a second controller, over a read-only SPI", "[safety] parts";
    SecondReceiver = 18, "second_receiver", "second receiver in lockstep", "[safety] parts";
    ErrorTest = 19, "error_test", "forced errors on a schedule", "[safety] parts";
}

/// Number of parts with a bit in `capabilities.features`; the rest have one in `protocols.features`.
pub const FEATURES_BITS: usize = 16;
/// Bits of `capabilities.features`.
pub const FEATURES: &[Named] = ALL_FEATURES.split_at(FEATURES_BITS).0;
/// Bits of `protocols.features`.
pub const MORE_FEATURES: &[Named] = &more_features();

const fn more_features() -> [Named; ALL_FEATURES.len() - FEATURES_BITS] {
    let mut more = [ALL_FEATURES[0]; ALL_FEATURES.len() - FEATURES_BITS];
    let mut i = 0;
    while i < more.len() {
        let part = ALL_FEATURES[FEATURES_BITS + i];
        more[i] = named(part.name, i as u32, part.meaning);
        i += 1;
    }
    more
}

impl Part {
    /// Name and meaning.
    pub const fn named(self) -> Named {
        ALL_FEATURES[self as usize]
    }
}

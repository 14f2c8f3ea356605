//! Parts that a card may have, as `capabilities.features` tells them.

use crate::named::named;
use crate::Named;

/// `Variant = bit, "name", "meaning", "where a configuration asks for it";`
macro_rules! parts {
    ($($variant:ident = $bit:literal, $name:literal, $meaning:literal, $switch:literal;)*) => {
        /// A part of a card; its number is its bit.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Part {
            $(
                #[doc = concat!($meaning, ".")]
                $variant = $bit,
            )*
        }

        impl Part {
            /// All of them, lowest bit first.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Table and key of a configuration that ask for it; empty if every card has it.
            pub const fn switch(self) -> &'static str {
                match self {
                    $(Self::$variant => $switch,)*
                }
            }
        }

        /// Bits of the features.
        pub const FEATURES: &[Named] = &[$(named($name, $bit, $meaning)),*];
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
    Alignment = 8, "alignment", "phase at the host's choice, mean over many edges", "[line] parts";
    Margin = 9, "margin", "margin of the samples", "[line] parts";
    DoubleEdge = 10, "double_edge", "DATA on both edges of the system clock", "[line] parts";
    Stream = 11, "stream", "stream of sample sets", "[stream]";
    Direct = 12, "direct", "direct outputs", "[outputs] parts";
    Interrupt = 13, "interrupt", "interrupt", "[outputs] parts";
    TFormat = 14, "t_format", "T-format channels", "[[channel]] protocol = \"t_format\"";
    OwnTrigger = 15, "own_trigger", "enable, divider and sources of triggers of each channel", "[[channel]] trigger";
    RecoveryCounter = 16, "recovery_counter", "recovery time measured a second time", "[safety] parts";
}

impl Part {
    /// Its name and its meaning.
    pub const fn named(self) -> Named {
        FEATURES[self as usize]
    }
}

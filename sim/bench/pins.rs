//! The ports of a design that the bench uses.

use super::is_tick_us;
use rtl_design::engine::{Engine, Port, PortId};

/// Names of the pins of one EnDat port in a design.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PinNames {
    /// CLOCK output.
    pub clock: String,
    /// DATA output.
    pub data_o: String,
    /// DATA driver enable.
    pub data_oe: String,
    /// DATA input.
    pub data_i: String,
    /// HIGH in the cycle after which the design samples DATA; optional.
    pub sample_strobe: String,
    /// With that: the sample is at the clock edge, not half a cycle before. Only for designs with double edge.
    pub sample_second: String,
}

impl PinNames {
    /// Pins of the block `Channel`.
    pub fn channel() -> Self {
        Self {
            clock: "endat_clk".into(),
            data_o: "data_o".into(),
            data_oe: "data_oe".into(),
            data_i: "data_i".into(),
            sample_strobe: "sample_strobe".into(),
            sample_second: "sample_second".into(),
        }
    }

    /// Pins of channel `n` of the card.
    pub fn card(n: usize) -> Self {
        Self {
            clock: format!("endat_clk{n}_o"),
            data_o: format!("endat_data{n}_o"),
            data_oe: format!("endat_data{n}_oe"),
            data_i: format!("endat_data{n}_i"),
            sample_strobe: format!("sample_strobe{n}"),
            sample_second: format!("sample_second{n}"),
        }
    }

    /// Pins of a T-format receiver, whose line has no clock.
    pub fn receiver() -> Self {
        Self {
            data_o: "encoder_data_o".into(),
            data_oe: "encoder_data_oe".into(),
            data_i: "encoder_data_i".into(),
            ..Self::default()
        }
    }
}

/// The port called `name`, if the design has it.
pub(super) fn find(ports: &[Port], name: &str) -> Option<PortId> {
    ports.iter().position(|p| p.name == name).map(PortId)
}

/// The DATA pins of a port, according to [`PinNames`].
#[derive(Clone)]
pub(super) struct DataPins {
    pub(super) data_o: PortId,
    pub(super) data_oe: PortId,
    pub(super) data_i: PortId,
}

/// The port called `name`.
///
/// # Panics
/// If the design does not have it: benches, not users, choose these names.
fn pin(ports: &[Port], name: &str) -> PortId {
    find(ports, name).unwrap_or_else(|| panic!("the design has no port {name}"))
}

impl DataPins {
    /// # Panics
    /// If the design lacks one of them.
    pub(super) fn find(names: &PinNames, ports: &[Port]) -> Self {
        Self {
            data_o: pin(ports, &names.data_o),
            data_oe: pin(ports, &names.data_oe),
            data_i: pin(ports, &names.data_i),
        }
    }
}

/// The pins of one EnDat port, according to [`PinNames`].
#[derive(Clone)]
pub(super) struct Pins {
    pub(super) clock: PortId,
    pub(super) data: DataPins,
    pub(super) sample_strobe: Option<PortId>,
    pub(super) sample_second: Option<PortId>,
}

impl Pins {
    /// # Panics
    /// If the design has no clock or DATA.
    pub(super) fn find(names: &PinNames, ports: &[Port]) -> Self {
        Self {
            clock: pin(ports, &names.clock),
            data: DataPins::find(names, ports),
            sample_strobe: find(ports, &names.sample_strobe),
            sample_second: find(ports, &names.sample_second),
        }
    }
}

/// Inputs that the bench drives, if the design has them.
#[derive(Clone)]
pub(super) struct TimeBase {
    pub(super) tick_us: Option<PortId>,
    pub(super) timestamp: Option<PortId>,
    pub(super) trigger: Option<PortId>,
}

impl TimeBase {
    pub(super) fn find(ports: &[Port]) -> Self {
        let find = |name| find(ports, name);
        Self {
            tick_us: find("tick_us"),
            timestamp: find("timestamp"),
            trigger: find("trigger").or(find("trigger_i")),
        }
    }

    /// Drives the inputs that count time in cycle `cycle` of a design.
    pub(super) fn drive<E: Engine>(&self, engine: &mut E, cycle: u64, system_hz: u64) {
        // The value of this cycle: that after the previous edge remains until this one has passed.
        if let Some(id) = self.timestamp {
            engine.set(id, u128::from((cycle - 1) & 0xFFFF_FFFF));
        }
        if let Some(id) = self.tick_us {
            engine.set(id, is_tick_us(cycle, system_hz).into());
        }
    }
}

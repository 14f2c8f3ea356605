//! Recordings of a design's ports.

use super::pins::find;
use crate::Time;
use endat_hdl::endat::transaction::cause;
use rtl_design::engine::{Engine, Port, PortId};

/// A result of the block `Channel`; the fields have the names of its ports.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChannelResult {
    /// Cycle in which the result strobe was HIGH.
    pub cycle: u64,
    /// Time of that cycle.
    pub time: Time,
    /// The last good position.
    pub position: u64,
    /// A good position is available.
    pub position_valid: bool,
    /// The position belongs to this frame.
    pub fresh: bool,
    /// Number of the result.
    pub sequence: u64,
    /// Time stamp of the first falling clock edge of the position's frame.
    pub first_fall_timestamp: u64,
    /// Age of the position.
    pub age_us: u64,
    /// Primary cause, 0 = none.
    pub cause: u64,
    /// The cause that replaced it after the result (DATA that does not fall).
    pub late_cause: Option<u64>,
    /// Raw flags.
    pub flags: u64,
    /// Received CRC.
    pub crc_received: u64,
    /// Computed CRC.
    pub crc_computed: u64,
    /// Measured recovery time.
    pub recovery_cycles: u64,
    /// Tracked signal delay tD.
    pub delay_cycles: u64,
}

impl ChannelResult {
    /// The final cause: the late one, if any.
    pub fn last_cause(&self) -> u64 {
        self.late_cause.unwrap_or(self.cause)
    }

    /// Name of the final cause.
    pub fn cause_name(&self) -> &'static str {
        cause::name(self.last_cause())
    }
}

/// Ports of a result; missing ports read 0.
#[derive(Clone)]
pub(super) struct ResultPorts {
    strobe: PortId,
    cause_bits: usize,
    fields: [Option<PortId>; 12],
}

/// Index of the cause in the list of fields.
const CAUSE: usize = 6;

impl ResultPorts {
    pub(super) fn find(ports: &[Port]) -> Option<Self> {
        let find = |name: &str| find(ports, name);
        let fields = [
            "position",
            "position_valid",
            "fresh",
            "sequence",
            "first_fall_timestamp",
            "age_us",
            "cause",
            "flags",
            "crc_received",
            "crc_computed",
            "recovery_cycles",
            "delay_cycles",
        ]
        .map(find);
        Some(Self {
            strobe: find("result_strobe")?,
            cause_bits: fields[CAUSE].map_or(0, |id| ports[id.0].width_bits),
            fields,
        })
    }

    /// HIGH in the cycle of a result.
    pub(super) fn strobe(&self) -> PortId {
        self.strobe
    }

    /// Port of the cause.
    pub(super) fn cause_port(&self) -> Option<PortId> {
        self.fields[CAUSE]
    }

    /// Width of the cause; 0 if the design has none.
    pub(super) fn cause_bits(&self) -> usize {
        self.cause_bits
    }

    /// The current cause; `get` reads a port.
    pub(super) fn cause(&self, mut get: impl FnMut(PortId) -> u128) -> u64 {
        self.fields[CAUSE].map_or(0, |id| get(id) as u64)
    }

    /// The current result at the ports; `get` reads one.
    pub(super) fn result(
        &self,
        mut get: impl FnMut(PortId) -> u128,
        cycle: u64,
        time: Time,
    ) -> ChannelResult {
        let values = self.fields.map(|id| id.map_or(0, |id| get(id) as u64));
        let [position, position_valid, fresh, sequence, first_fall_timestamp, age_us, cause, flags, crc_received, crc_computed, recovery_cycles, delay_cycles] =
            values;
        ChannelResult {
            cycle,
            time,
            position,
            position_valid: position_valid != 0,
            fresh: fresh != 0,
            sequence,
            first_fall_timestamp,
            age_us,
            cause,
            late_cause: None,
            flags,
            crc_received,
            crc_computed,
            recovery_cycles,
            delay_cycles,
        }
    }
}

/// A port of the design and its changes.
#[derive(Clone, Debug)]
pub struct Watched {
    name: String,
    port: PortId,
    width_bits: u32,
    changes: Vec<(Time, u128)>,
}

impl Watched {
    pub(super) fn new(name: &str, port: PortId, width_bits: u32) -> Self {
        Self {
            name: name.into(),
            port,
            width_bits,
            changes: Vec::new(),
        }
    }

    pub(super) fn port(&self) -> PortId {
        self.port
    }

    pub(super) fn note(&mut self, time: Time, value: u128) {
        if self.changes.last().is_none_or(|c| c.1 != value) {
            self.changes.push((time, value));
        }
    }

    /// Name of the port.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Width in bits.
    pub fn width_bits(&self) -> u32 {
        self.width_bits
    }

    /// Changes; a value holds from the system clock edge at its time.
    pub fn changes(&self) -> &[(Time, u128)] {
        &self.changes
    }
}

/// The settled values of all ports in each cycle, just before the clock edge that ends it.
#[derive(Clone, Debug)]
pub struct Cycles {
    /// The ports, in the order of the values.
    pub ports: Vec<Port>,
    /// One row for each cycle.
    pub rows: Vec<Vec<u128>>,
    /// The values in the middle of each cycle, just before the falling edge; empty if that edge is not used.
    pub middle: Vec<Vec<u128>>,
}

impl Cycles {
    pub(super) fn new(ports: &[Port]) -> Self {
        Self {
            ports: ports.to_vec(),
            rows: Vec::new(),
            middle: Vec::new(),
        }
    }

    pub(super) fn note(&mut self, engine: &mut impl Engine) {
        let row = self.row(engine);
        self.rows.push(row);
    }

    pub(super) fn note_middle(&mut self, engine: &mut impl Engine) {
        let row = self.row(engine);
        self.middle.push(row);
    }

    fn row(&self, engine: &mut impl Engine) -> Vec<u128> {
        let ports = (0..self.ports.len()).map(PortId);
        ports.map(|port| engine.get(port)).collect()
    }
}

//! Encoders of other protocols than EnDat.

use super::pins::{find, DataPins, PinNames};
use super::Bench;
use crate::{encoder::Drive, Time};
use endat_hdl::regs::Protocol;
use rtl_design::engine::{Engine, PortId};
use std::any::Any;

/// An encoder of another protocol than EnDat, with its line.
pub trait OtherEncoder: Any + Send {
    /// Protocol.
    fn protocol(&self) -> Protocol;

    /// The receiver drives the line like this from `time` on.
    fn set_receiver(&mut self, time: Time, drive: Drive);

    /// The receiver's clock has this level from `time` on; unused if the line has no clock.
    fn set_clock(&mut self, _time: Time, _level: bool) {}

    /// Processes all events up to `time`; returns DATA at the receiver's pin.
    fn advance_to(&mut self, time: Time) -> bool;

    /// The line at the encoder's pins: recorded changes with their times.
    fn trace(&self) -> &[(Time, bool)];

    /// Violations by the receiver, as text.
    fn complaints(&self) -> Vec<String>;

    /// Keeps only the last `most` entries of each kind.
    fn keep(&mut self, most: usize);

    /// For a downcast.
    fn as_any(&self) -> &dyn Any;

    /// See [`Self::as_any`].
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

/// An encoder at the pins of a design.
pub(super) struct OtherPort {
    encoder: Box<dyn OtherEncoder>,
    ids: DataPins,
    clock: Option<PortId>,
    data: Option<bool>,
}

impl OtherPort {
    /// Processes all events up to now, and drives DATA into the design.
    pub(super) fn drive_data(&mut self, engine: &mut impl Engine, now: Time) {
        let data = self.encoder.advance_to(now);
        if self.data != Some(data) {
            self.data = Some(data);
            engine.set(self.ids.data_i, u128::from(data));
        }
    }

    /// Applies the design's pins to the line.
    pub(super) fn take_pins(&mut self, engine: &mut impl Engine, now: Time) {
        let drive = match engine.get(self.ids.data_oe) != 0 {
            true => Drive::level(engine.get(self.ids.data_o) != 0),
            false => Drive::Released,
        };
        self.encoder.set_receiver(now, drive);
        if let Some(clock) = self.clock {
            self.encoder.set_clock(now, engine.get(clock) != 0);
        }
    }
}

impl<E: Engine> Bench<E> {
    /// Adds an encoder of another protocol to a set of pins; returns its number among these.
    pub fn add_other(&mut self, names: &PinNames, encoder: Box<dyn OtherEncoder>) -> usize {
        self.others.push(OtherPort {
            encoder,
            ids: DataPins::find(names, self.engine.ports()),
            clock: find(self.engine.ports(), &names.clock),
            data: None,
        });
        self.others.len() - 1
    }

    /// Such an encoder, to disturb it.
    pub fn other_mut(&mut self, number: usize) -> &mut dyn OtherEncoder {
        &mut *self.others[number].encoder
    }

    /// All encoders of other protocols.
    pub fn others(&self) -> impl Iterator<Item = &dyn OtherEncoder> {
        self.others.iter().map(|port| &*port.encoder)
    }

    /// Encoders of one type.
    pub fn others_as<T: OtherEncoder>(&self) -> impl Iterator<Item = &T> {
        self.others()
            .filter_map(|other| other.as_any().downcast_ref())
    }

    /// Encoders of one type, to disturb them.
    pub fn others_as_mut<T: OtherEncoder>(&mut self) -> impl Iterator<Item = &mut T> {
        let all = self.others.iter_mut();
        all.filter_map(|port| port.encoder.as_any_mut().downcast_mut())
    }
}

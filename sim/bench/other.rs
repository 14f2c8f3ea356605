//! Encoders of other protocols than EnDat.

use super::pins::{find, DataPins, PinNames};
use super::Bench;
use crate::{encoder::Drive, Time};
use endat_hdl::regs::Protocol;
use rtl_design::engine::{Engine, PortId};
use std::any::Any;

/// An encoder of another protocol than EnDat, at the end of one line.
pub trait OtherEncoder: Any + Send {
    /// What it speaks.
    fn protocol(&self) -> Protocol;

    /// The receiver does this to the line from `time` on.
    fn set_receiver(&mut self, time: Time, drive: Drive);

    /// The receiver's clock is at this level from `time` on; of no meaning where the line has no clock.
    fn set_clock(&mut self, _time: Time, _level: bool) {}

    /// Lets everything happen that is due by `time`; gives DATA at the receiver's pin.
    fn advance_to(&mut self, time: Time) -> bool;

    /// The line at the encoder's pins: changes with their times, if they are kept.
    fn trace(&self) -> &[(Time, bool)];

    /// What the receiver has done wrong, in words.
    fn complaints(&self) -> Vec<String>;

    /// Notes only so much of each kind, the last entries.
    fn keep(&mut self, most: usize);

    /// Itself, for who knows which it is.
    fn as_any(&self) -> &dyn Any;

    /// See [`Self::as_any`].
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

/// One on the pins of a design.
pub(super) struct OtherPort {
    encoder: Box<dyn OtherEncoder>,
    ids: DataPins,
    clock: Option<PortId>,
    data: Option<bool>,
}

impl OtherPort {
    /// Lets everything happen up to now, and drives DATA into the design.
    pub(super) fn drive_data(&mut self, engine: &mut impl Engine, now: Time) {
        let data = self.encoder.advance_to(now);
        if self.data != Some(data) {
            self.data = Some(data);
            engine.set(self.ids.data_i, u128::from(data));
        }
    }

    /// Takes the design's pins to the line.
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
    /// Puts an encoder of another protocol on a set of pins; gives its number among all of them.
    pub fn add_other(&mut self, names: &PinNames, encoder: Box<dyn OtherEncoder>) -> usize {
        self.others.push(OtherPort {
            encoder,
            ids: DataPins::find(names, self.engine.ports()),
            clock: find(self.engine.ports(), &names.clock),
            data: None,
        });
        self.others.len() - 1
    }

    /// One of them, to make something wrong with it.
    pub fn other_mut(&mut self, number: usize) -> &mut dyn OtherEncoder {
        &mut *self.others[number].encoder
    }

    /// All encoders of other protocols.
    pub fn others(&self) -> impl Iterator<Item = &dyn OtherEncoder> {
        self.others.iter().map(|port| &*port.encoder)
    }

    /// Those of one kind.
    pub fn others_as<T: OtherEncoder>(&self) -> impl Iterator<Item = &T> {
        self.others()
            .filter_map(|other| other.as_any().downcast_ref())
    }

    /// The same, to make something wrong with them.
    pub fn others_as_mut<T: OtherEncoder>(&mut self) -> impl Iterator<Item = &mut T> {
        let all = self.others.iter_mut();
        all.filter_map(|port| port.encoder.as_any_mut().downcast_mut())
    }
}

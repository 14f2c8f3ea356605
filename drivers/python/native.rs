//! The functions of the module.

use crate::columns;
use crate::fault::{Fault, Kind};
use endat_card::{card_at, is_virtual};
use endat_host::causes;
use endat_host::feed::{cause_codes, NO_CAUSES};
use endat_host::mailbox::Request;
use endat_host::name_plate::NamePlate;
use endat_host::owner::{Handle, Owner};
use endat_host::range::{self, Ranges};
use endat_host::units::Scale;
use endat_host::HostError;
use endat_regs::Part;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Opens a port.
#[pyfunction]
pub fn connect(
    py: Python<'_>,
    port: String,
    baud: u32,
    ranges: Vec<String>,
) -> PyResult<NativeCard> {
    if port.is_empty() {
        let text = "port = \"\": is empty; give the card's serial port, tcp:HOST:PORT or virtual";
        return Err(Fault::new(Kind::BadInput, text).into());
    }
    let is_real = !is_virtual(&port);
    let ranges = Ranges::parse(&ranges).map_err(Fault::from)?;
    let find = move || {
        let mut card = card_at(&port, baud)?;
        card.set_ranges(ranges)?;
        Ok(card)
    };
    let handle =
        py.detach(|| Handle::open(find, is_real, look).map(|r| r.map_err(Fault::from)))??;
    Ok(NativeCard(Mutex::new(Some(handle))))
}

/// Names that may replace a cause, with their codes.
#[pyfunction]
pub fn cause_names() -> Vec<(u8, &'static str)> {
    cause_codes().collect()
}

/// Explanation of a cause, with the remedy.
#[pyfunction]
pub fn explain_cause(name: &str) -> Option<String> {
    let other = NO_CAUSES.iter().find(|(known, _)| *known == name);
    let known = || causes::advice(name).map(|[means, then]| format!("{means}; {then}"));
    other.map(|(_, means)| (*means).to_owned()).or_else(known)
}

/// Remedy for an unknown range of a channel.
fn remedy(channel: usize) -> String {
    format!("give connect() ranges={{{channel}: \"SINGLE+MULTI\"}} (bits of the angle and bits that count turns, as in {{{channel}: \"17+16\"}}) or {{{channel}: \"linear\"}}")
}

/// Handles Ctrl-C.
fn look() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// A card; `None` after it has been closed.
#[pyclass(frozen)]
pub struct NativeCard(Mutex<Option<Handle>>);

impl NativeCard {
    fn handle(&self) -> MutexGuard<'_, Option<Handle>> {
        // No operation under the lock can leave it half done.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn call<R: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Owner) -> Result<R, HostError> + Send + 'static,
    ) -> PyResult<R> {
        py.detach(|| {
            let closed = || Fault::new(Kind::Refused, "the card has been closed");
            let jobs = self
                .handle()
                .as_ref()
                .map(Handle::jobs)
                .ok_or_else(closed)?;
            Ok(jobs.call(job, look)?.map_err(Fault::from)?)
        })
    }
}

fn plate<'py>(py: Python<'py>, plate: &NamePlate) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("initialised", plate.initialised)?;
    all.set_item("endat22", plate.endat22)?;
    all.set_item("position_bits", plate.position_bits)?;
    all.set_item("rotary", plate.rotary)?;
    all.set_item("revolutions", plate.revolutions)?;
    all.set_item("steps", plate.steps)?;
    all.set_item("id", plate.id.as_deref())?;
    all.set_item("serial", plate.serial.as_deref())?;
    all.set_item("clock_max_khz", plate.clock_max_khz)?;
    all.set_item("short_recovery", plate.short_recovery)?;
    all.set_item("alarms", plate.alarms)?;
    all.set_item("warnings", plate.warnings)?;
    Ok(all)
}

#[pymethods]
impl NativeCard {
    /// Identity of the card.
    fn identity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let identity = self.call(py, |w| Ok(*w.card.identity()))?;
        let all = PyDict::new(py);
        let [major, minor, patch] = identity.version;
        all.set_item("register_map", format!("{major}.{minor}.{patch}"))?;
        all.set_item("channels", identity.channels)?;
        let channels = 0..identity.channels;
        let protocols: Vec<&str> = channels.map(|n| identity.protocol(n).name()).collect();
        all.set_item("protocols", protocols)?;
        all.set_item("max_position_bits", identity.max_position_bits)?;
        all.set_item("system_hz", identity.system_hz)?;
        all.set_item("configuration_hash", identity.configuration_hash)?;
        let parts: Vec<&str> = identity.parts().map(|part| part.named().name).collect();
        all.set_item("parts", parts)?;
        Ok(all)
    }

    /// Waits until no encoder is being initialised and every channel has a result, or a second has passed.
    fn settle(&self, py: Python<'_>) -> PyResult<()> {
        self.call(py, |w| w.card.settle(|| ()))
    }

    /// Name plates; `None` for a channel whose encoder the card does not read.
    fn name_plates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let plates = self.call(py, |w| w.card.name_plates())?;
        let all = PyList::empty(py);
        for one in &plates {
            all.append(one.as_ref().map(|p| plate(py, p)).transpose()?)?;
        }
        Ok(all)
    }

    /// The scale of each channel.
    fn scales<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let scales = self.call(py, |w| {
            w.scales = w.card.scales()?;
            Ok(w.scales.clone())
        })?;
        let all = PyList::empty(py);
        for (n, scale) in scales.iter().enumerate() {
            let why = || format!("{}; {}", range::unknown(n), remedy(n));
            let one = PyDict::new(py);
            one.set_item("unit", scale.convert(0).unit)?;
            one.set_item("digits", scale.digits())?;
            one.set_item("wraps_at", scale.wraps_at())?;
            one.set_item("turns", scale.turns())?;
            let steps = scale.range().zip(scale.turns());
            one.set_item(
                "steps_per_turn",
                steps.map(|(range, turns)| range / turns.max(1)),
            )?;
            let linear = matches!(scale, Scale::Linear { .. } | Scale::Counted);
            one.set_item("linear", linear)?;
            let unknown = (!scale.is_known()).then(why);
            one.set_item("unknown", unknown)?;
            all.append(one)?;
        }
        Ok(all)
    }

    /// Contradictions between name plates and configuration.
    fn scale_notes(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.call(py, |w| w.card.scale_notes())
    }

    /// Latest results of all channels, from one instant.
    fn read<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let (readings, scales) = self.call(py, |w| {
            if w.scales.is_empty() {
                w.scales = w.card.scales()?;
            }
            Ok((w.card.results()?.channels, w.scales.clone()))
        })?;
        let all = PyList::empty(py);
        for (r, scale) in readings.iter().zip(&scales) {
            let units = r.valid.then(|| scale.convert(r.position));
            let one = PyDict::new(py);
            one.set_item("position", units.map(|u| u.value))?;
            one.set_item("unit", scale.convert(0).unit)?;
            one.set_item("turns", units.and_then(|u| u.turns))?;
            one.set_item("raw", r.valid.then_some(r.position))?;
            one.set_item("fresh", r.fresh)?;
            one.set_item("cause", r.cause_name())?;
            one.set_item("sequence", r.sequence)?;
            one.set_item("cycles", r.timestamp)?;
            one.set_item("age_us", r.age_us)?;
            one.set_item("delay_cycles", r.delay_cycles)?;
            one.set_item("recovery_cycles", r.recovery_cycles)?;
            all.append(one)?;
        }
        Ok(all)
    }

    /// Begins a recording.
    fn begin(&self, py: Python<'_>, polls: bool) -> PyResult<()> {
        self.call(py, move |w| w.begin(polls))
    }

    /// Up to `count` rows as columns; fewer, or none, if no more have arrived.
    fn take<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Bound<'py, PyDict>> {
        let (rows, scales, has_infos) = self.call(py, move |w| {
            let rows = w.take(count)?;
            let identity = w.card.identity();
            let streams = w.recording.as_ref().is_some_and(|r| r.feed.streams());
            let has_infos = match streams {
                true => identity.stream_additional_data,
                false => identity.has(Part::Requests),
            };
            Ok((rows, w.scales.clone(), has_infos))
        })?;
        columns::of(py, &rows, &scales, has_infos)
    }

    /// Frames damaged on the link, and sets dropped by the card, since the recording began.
    fn losses(&self, py: Python<'_>) -> PyResult<(u64, u64)> {
        let losses = self.call(py, |w| Ok(w.losses()))?;
        Ok((losses.damaged, losses.dropped))
    }

    /// Ends the recording, if any.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        self.call(py, Owner::end)
    }

    /// Reads a word or field.
    fn read_register(&self, py: Python<'_>, name: String) -> PyResult<u32> {
        self.call(py, move |w| w.card.read_named(&name))
    }

    /// Writes a word or field; values that the register map forbids are rejected, unless `force`.
    fn write_register(
        &self,
        py: Python<'_>,
        name: String,
        value: u32,
        force: bool,
    ) -> PyResult<()> {
        self.call(py, move |w| {
            let place = w.card.place(&name)?;
            if !force {
                w.card.permits(&place, value)?;
            }
            // The write may have changed the scales.
            w.scales.clear();
            w.card.write(&place, value)
        })
    }

    /// Reads a word of the encoder's memory.
    fn read_parameter(
        &self,
        py: Python<'_>,
        channel: usize,
        area: u8,
        address: u8,
    ) -> PyResult<u16> {
        self.call(py, move |w| {
            is_there(w, channel)?;
            Ok(w.card.read_parameter(channel, area, address)?.data)
        })
    }

    /// Writes a word of the encoder's memory.
    fn write_parameter(
        &self,
        py: Python<'_>,
        channel: usize,
        area: u8,
        address: u8,
        value: u16,
    ) -> PyResult<()> {
        self.call(py, move |w| {
            is_there(w, channel)?;
            let answer = w.card.write_parameter(channel, area, address, value);
            answer.map(|_| ())
        })
    }

    /// Sends a mode command; returns 8 bits, 16 bits and all bits of the answer.
    fn request(
        &self,
        py: Python<'_>,
        channel: usize,
        command: u8,
        address: u8,
        data: u16,
    ) -> PyResult<(u8, u16, u64)> {
        self.call(py, move |w| {
            is_there(w, channel)?;
            let request = Request {
                command,
                address,
                data,
            };
            let answer = w.card.request(channel, request)?;
            Ok((answer.address, answer.data, answer.bits))
        })
    }

    /// Closes the card.
    fn close(&self, py: Python<'_>) {
        py.detach(|| {
            let handle = self.handle().take();
            if let Some(handle) = handle {
                handle.close();
            }
        });
    }
}

fn is_there(worker: &Owner, channel: usize) -> Result<(), HostError> {
    let channels = worker.card.identity().channels;
    match channel < channels {
        true => Ok(()),
        false => Err(HostError::Name(format!(
            "channel = {channel}: the card has {channels}; give 0 to {}",
            channels - 1
        ))),
    }
}

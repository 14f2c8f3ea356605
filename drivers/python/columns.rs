//! Rows of a recording as columns of numbers, for numpy.

use endat_driver::AdditionalData;
use endat_host::feed::{Cell, Row};
use endat_host::units::Scale;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

/// Value of `run` for rows of triggers.
const NO_RUN: i8 = -1;

/// The bytes of consecutive numbers.
macro_rules! bytes {
    ($py:expr, $numbers:expr) => {{
        let all: Vec<u8> = $numbers.flat_map(|n| n.to_ne_bytes()).collect();
        PyBytes::new($py, &all)
    }};
}

/// One channel's columns.
fn channel<'py>(
    py: Python<'py>,
    cells: &[&Cell],
    scale: &Scale,
    has_infos: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let each = || cells.iter();
    let units = |cell: &Cell| cell.position.map(|p| scale.convert(p));
    columns.set_item("raw", bytes!(py, each().map(|c| c.position.unwrap_or(0))))?;
    columns.set_item(
        "valid",
        bytes!(py, each().map(|c| u8::from(c.position.is_some()))),
    )?;
    columns.set_item(
        "position",
        bytes!(py, each().map(|c| units(c).map_or(f64::NAN, |u| u.value))),
    )?;
    let turns = |c: &Cell| units(c).and_then(|u| u.turns).unwrap_or(0);
    columns.set_item("turns", bytes!(py, each().map(|c| turns(c))))?;
    columns.set_item("fresh", bytes!(py, each().map(|c| u8::from(c.fresh))))?;
    columns.set_item("cause", bytes!(py, each().map(|c| c.cause_code())))?;
    if has_infos {
        for n in 0..2 {
            let each = || each().map(|c: &&Cell| c.infos[n]);
            let of =
                |what: fn(AdditionalData) -> u16| bytes!(py, each().map(|i| i.map_or(0, what)));
            let name = |what: &str| format!("additional_{}_{what}", n + 1);
            columns.set_item(
                name("good"),
                bytes!(py, each().map(|i| u8::from(i.is_some()))),
            )?;
            columns.set_item(name("status"), of(|i| i.status.into()))?;
            columns.set_item(name("content"), of(|i| i.content))?;
        }
    }
    Ok(columns)
}

/// All columns of these rows.
pub fn of<'py>(
    py: Python<'py>,
    rows: &[Row],
    scales: &[Scale],
    has_infos: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let each = || rows.iter();
    columns.set_item("trigger", bytes!(py, each().map(|r| r.trigger)))?;
    columns.set_item("cycles", bytes!(py, each().map(|r| r.cycles)))?;
    columns.set_item("missing", bytes!(py, each().map(|r| r.missing)))?;
    let run = |r: &Row| r.run.map_or(NO_RUN, |n| n as i8);
    columns.set_item("run", bytes!(py, each().map(run)))?;
    let channels = PyList::empty(py);
    for (n, scale) in scales.iter().enumerate() {
        let cells: Vec<&Cell> = rows.iter().filter_map(|r| r.cells.get(n)).collect();
        channels.append(channel(py, &cells, scale, has_infos)?)?;
    }
    columns.set_item("channels", channels)?;
    Ok(columns)
}

//! The registers behind the pins of the transceivers go into the cells of these pins, where nextpnr can do so: their delay to the pin is
//! then the same in every build.

use crate::scratch;
use endat_config::board::Kind;
use endat_config::Project;
use endat_console::artifact::{self, Artifact};
use endat_console::error::CommandError;
use serde_json::{json, Value};
use std::path::Path;

/// An attribute as yosys writes it: a number is 32 bits.
fn value(text: &str) -> Value {
    match text.parse::<u32>() {
        Ok(number) => json!(format!("{number:032b}")),
        Err(_) => json!(text),
    }
}

/// Gives the register that alone drives a port, and drives nothing else, these attributes (`name=value`). Returns whether it is there.
fn mark(module: &mut Value, port: &str, attributes: &[String]) -> bool {
    let Some(bit) = module["ports"][port]["bits"][0].as_u64() else {
        return false;
    };
    let Some(cells) = module["cells"].as_object_mut() else {
        return false;
    };
    let mut ends = cells.values_mut().filter_map(|cell| {
        let has = |bits: &Value| {
            bits.as_array()
                .is_some_and(|bits| bits.iter().any(|b| *b == bit))
        };
        let pins = cell["connections"].as_object()?.iter();
        let pin = pins
            .filter(|(_, bits)| has(bits))
            .map(|(pin, _)| pin.clone())
            .next()?;
        Some((pin, cell))
    });
    let (Some((pin, cell)), None) = (ends.next(), ends.next()) else {
        return false;
    };
    if pin != "Q" {
        return false;
    }
    for (name, text) in attributes.iter().filter_map(|one| one.split_once('=')) {
        cell["attributes"][name] = value(text);
    }
    true
}

/// Marks the registers in the netlist of yosys. Returns the outputs that have none of their own.
pub(super) fn mark_all(
    folder: &Path,
    project: &Project,
    attributes: &[String],
) -> Result<Vec<String>, CommandError> {
    if attributes.is_empty() {
        return Ok(vec![]);
    }
    let file = format!("{}.json", project.name);
    let text = scratch::read(&folder.join(&file))?;
    let mut netlist: Value =
        serde_json::from_str(&text).map_err(|e| CommandError::fault("netlist of yosys", &e))?;
    let module = &mut netlist["modules"][format!("{}_top", project.name)];
    let outputs = project
        .pins
        .iter()
        .filter(|pin| pin.kind == Kind::Transceiver);
    let signals = outputs.map(|pin| pin.signal.clone());
    let others = signals
        .filter(|signal| !mark(module, signal, attributes))
        .collect();
    let marked = Artifact::new(file, netlist.to_string());
    artifact::write(folder, &[marked], scratch::REMEDY)?;
    Ok(others)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_register_that_drives_its_pin_alone_is_marked() {
        let cell = |pin: &str, bit: u32| json!({"attributes": {}, "connections": {pin: [bit], "CLK": [9]}});
        let ports =
            json!({"clk_o": {"bits": [1]}, "led_o": {"bits": [2]}, "table_o": {"bits": [3]}});
        let mut module = json!({
            "ports": ports,
            "cells": {"a": cell("Q", 1), "b": cell("Q", 2), "reads_b": cell("I0", 2), "c": cell("F", 3)},
        });
        let attributes = ["syn_useioff=1", "ioff_dir=output"].map(str::to_owned);
        assert!(mark(&mut module, "clk_o", &attributes));
        let marked = json!({"syn_useioff": format!("{:032b}", 1), "ioff_dir": "output"});
        assert_eq!(module["cells"]["a"]["attributes"], marked);
        for port in ["led_o", "table_o", "none_o"] {
            assert!(!mark(&mut module, port, &attributes), "{port}");
        }
        assert_eq!(module["cells"]["b"]["attributes"], json!({}));
    }
}

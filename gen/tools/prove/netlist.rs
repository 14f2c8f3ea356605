//! The gates that a design comes to, as yosys writes them (`write_json` after `simplemap`).

use serde::Deserialize;
use std::collections::BTreeMap;

/// Number of a net. The first ones are constant: LOW, HIGH, and one that is anything.
pub(super) type Net = usize;
pub(super) const LOW: Net = 0;
pub(super) const HIGH: Net = 1;
pub(super) const ANYTHING: Net = 2;
/// What the numbers of yosys, which begin with 2, are moved by.
const MOVED: usize = 1;

/// What a gate does with the nets before its output.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Not,
    And,
    Or,
    Xor,
    /// The second one while the third one is HIGH, the first one otherwise.
    Mux,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    pub kind: Kind,
    /// As many as the kind has; the others are [`LOW`].
    pub inputs: [Net; 3],
    pub output: Net,
}

/// A flip-flop.
#[derive(Clone, Debug)]
pub(super) struct Register {
    pub input: Net,
    pub output: Net,
    /// It takes its input at the falling edge of the system clock.
    pub falls: bool,
    /// Level after configuration, if it has one.
    pub start: Option<bool>,
}

/// A flat design with one clock.
#[derive(Debug)]
pub(super) struct Netlist {
    /// Each behind those that drive its inputs.
    pub gates: Vec<Gate>,
    pub registers: Vec<Register>,
    /// Nets by name, lowest bit first; ports among them.
    pub names: BTreeMap<String, Vec<Net>>,
    pub net_count: usize,
}

#[derive(Deserialize)]
struct File {
    modules: BTreeMap<String, Module>,
}

#[derive(Deserialize)]
struct Module {
    cells: BTreeMap<String, Cell>,
    netnames: BTreeMap<String, Name>,
}

#[derive(Deserialize)]
struct Cell {
    #[serde(rename = "type")]
    kind: String,
    connections: BTreeMap<String, Vec<Bit>>,
}

#[derive(Deserialize)]
struct Name {
    bits: Vec<Bit>,
    attributes: BTreeMap<String, String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Bit {
    Net(usize),
    Level(String),
}

impl Bit {
    fn net(&self) -> Net {
        match self {
            Self::Net(number) => number + MOVED,
            Self::Level(level) => match level.as_str() {
                "0" => LOW,
                "1" => HIGH,
                _ => ANYTHING,
            },
        }
    }
}

impl Netlist {
    /// Reads the module `top`; what is wrong with it, if anything.
    pub fn read(text: &str, top: &str) -> Result<Self, String> {
        let mut file: File = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let module = file.modules.remove(top).ok_or("no such module")?;
        let mut starts: BTreeMap<Net, bool> = BTreeMap::new();
        let mut names = BTreeMap::new();
        for (name, what) in &module.netnames {
            let bits: Vec<Net> = what.bits.iter().map(Bit::net).collect();
            // The first digit is of the highest bit.
            let init = what.attributes.get("init").map_or("", String::as_str);
            for (net, level) in bits.iter().zip(init.trim().bytes().rev()) {
                if matches!(level, b'0' | b'1') {
                    starts.insert(*net, level == b'1');
                }
            }
            names.insert(name.clone(), bits);
        }
        let (mut gates, mut registers) = (vec![], vec![]);
        for (name, cell) in &module.cells {
            let pin = |pin: &str| {
                let bit = cell.connections.get(pin).and_then(|bits| bits.first());
                bit.map(Bit::net)
                    .ok_or_else(|| format!("{name}: no pin {pin}"))
            };
            let kind = match cell.kind.as_str() {
                "$_NOT_" => Kind::Not,
                "$_AND_" => Kind::And,
                "$_OR_" => Kind::Or,
                "$_XOR_" => Kind::Xor,
                "$_MUX_" => Kind::Mux,
                "$_DFF_P_" | "$_DFF_N_" => {
                    let output = pin("Q")?;
                    registers.push(Register {
                        input: pin("D")?,
                        output,
                        falls: cell.kind == "$_DFF_N_",
                        start: starts.get(&output).copied(),
                    });
                    continue;
                }
                other => return Err(format!("{name}: a {other}, which is no simple gate")),
            };
            let inputs = match kind {
                Kind::Not => [pin("A")?, LOW, LOW],
                Kind::Mux => [pin("A")?, pin("B")?, pin("S")?],
                _ => [pin("A")?, pin("B")?, LOW],
            };
            gates.push(Gate {
                kind,
                inputs,
                output: pin("Y")?,
            });
        }
        let all = gates.iter().map(|g| g.output);
        let all = all.chain(names.values().flatten().copied());
        let net_count = all.max().unwrap_or(ANYTHING).max(ANYTHING) + 1;
        let gates = in_order(gates, net_count)?;
        Ok(Self {
            gates,
            registers,
            names,
            net_count,
        })
    }
}

/// Each gate behind those that drive it.
fn in_order(gates: Vec<Gate>, net_count: usize) -> Result<Vec<Gate>, String> {
    let mut driver = vec![None; net_count];
    for (index, gate) in gates.iter().enumerate() {
        driver[gate.output] = Some(index);
    }
    let (mut begun, mut done) = (vec![false; gates.len()], vec![false; gates.len()]);
    let mut order = vec![];
    for first in 0..gates.len() {
        let mut open = vec![first];
        while let Some(&index) = open.last() {
            let before = gates[index].inputs.iter().filter_map(|net| driver[*net]);
            let before: Vec<usize> = before.filter(|d| !done[*d]).collect();
            if done[index] || before.is_empty() {
                open.pop();
                if !std::mem::replace(&mut done[index], true) {
                    order.push(gates[index]);
                }
            } else if std::mem::replace(&mut begun[index], true) {
                return Err("gates that drive each other in a circle".into());
            } else {
                open.extend(before);
            }
        }
    }
    Ok(order)
}

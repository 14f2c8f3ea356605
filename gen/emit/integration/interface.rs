//! The bus of a core as tools know it that connect by interface: its name there, and which port is which of its signals.

use super::Port;
use crate::buses::front;
use crate::front::Unused;
use endat_hdl::card::bus::HostBus;
use serde::Serialize;

/// One signal of an interface.
#[derive(Serialize)]
pub struct Signal {
    /// What the standard calls it.
    logical: String,
    /// The port.
    port: String,
    /// The core drives it.
    is_output: bool,
    /// Where LiteX has it in its record; empty where LiteX has no such bus.
    litex: String,
}

/// A bus interface.
#[derive(Serialize)]
pub struct Interface {
    /// Its name: how its ports begin.
    name: &'static str,
    /// The definition that Vivado has of it; empty where it has none.
    vivado: &'static str,
    /// The attributes by which IP-XACT names its bus, and the abstraction of that; empty where it has no addresses of a system.
    ipxact: String,
    ipxact_rtl: String,
    /// What Platform Designer calls it; empty where it has no such bus.
    pub platform_designer: &'static str,
    /// Inputs that Platform Designer asks for and the core has no use for: a module around it has them.
    pub unused: Vec<Unused>,
    /// The class that LiteX has for it, with its arguments; empty where it has none.
    litex: String,
    /// The module of LiteX with that class.
    litex_module: &'static str,
    /// Its signals, in the order of the ports.
    signals: Vec<Signal>,
    /// Bytes of the address space that it decodes; 0 if it has no addresses of a system.
    size_bytes: u64,
}

impl Interface {
    /// Whether a port of the core is one of its signals.
    pub fn has(&self, port: &str) -> bool {
        self.signals.iter().any(|signal| signal.port == port)
    }
}

/// The interface of a card with this bus; `None` where no tool connects it as one.
pub fn of(bus: HostBus, ports: &[Port]) -> Option<Interface> {
    let known = front(bus).interface.as_ref()?;
    let prefix = format!("{}_", known.name);
    let own = ports.iter().filter_map(|port| {
        let rest = port.name.strip_prefix(&prefix)?;
        Some((port, rest))
    });
    let logical = |rest: &str| {
        let named = known.logical.iter().find(|(own, _)| *own == rest);
        named.map_or(rest.to_ascii_uppercase(), |(_, logical)| (*logical).into())
    };
    let field = known.litex.as_ref().map(|litex| litex.field);
    let signals = own.clone().map(|(port, rest)| Signal {
        logical: logical(rest),
        port: port.name.clone(),
        is_output: port.direction == "out",
        litex: field.map(|of| of(rest, port.width)).unwrap_or_default(),
    });
    let width = |rest: &str| own.clone().find(|(_, r)| *r == rest).map(|(p, _)| p.width);
    let address = match known.address {
        Some((rest, unit)) => Some((width(rest)?, unit)),
        None => None,
    };
    let bits = address.map_or(String::new(), |(bits, _)| bits.to_string());
    let litex = known.litex.as_ref();
    let ipxact = |end: &str| known.ipxact.map_or(String::new(), |name| vlnv(name, end));
    Some(Interface {
        name: known.name,
        vivado: known.vivado,
        ipxact: ipxact(""),
        ipxact_rtl: ipxact("_rtl"),
        platform_designer: known.platform_designer,
        unused: known.unused.into(),
        litex: litex.map_or(String::new(), |litex| litex.class.replace("BITS", &bits)),
        litex_module: litex.map_or("", |litex| litex.module),
        signals: signals.collect(),
        size_bytes: address.map_or(0, |(bits, unit)| unit << bits),
    })
}

/// Vendor, library, name and version as attributes; `end` is that of the name.
fn vlnv([vendor, library, name, version]: [&str; 4], end: &str) -> String {
    format!("vendor=\"{vendor}\" library=\"{library}\" name=\"{name}{end}\" version=\"{version}\"")
}

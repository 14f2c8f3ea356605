//! The bus of a core as tools know it that connect by interface: its name there, and which port is which of its signals.

use super::Port;
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

/// An input that nothing looks at.
#[derive(Serialize)]
pub struct Unused {
    name: &'static str,
    logical: &'static str,
    width: usize,
}

/// AXI4-Lite's inputs of that kind.
const PROTECTION: [Unused; 2] = [
    Unused {
        name: "s_axi_awprot",
        logical: "awprot",
        width: 3,
    },
    Unused {
        name: "s_axi_arprot",
        logical: "arprot",
        width: 3,
    },
];

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
    let (name, vivado, litex_module) = match bus {
        HostBus::Uart => ("uart", "xilinx.com:interface:uart", ""),
        HostBus::Apb => ("s_apb", "xilinx.com:interface:apb", ""),
        HostBus::Wishbone => ("wb", "", "wishbone"),
        HostBus::AxiLite => ("s_axi", "xilinx.com:interface:aximm", "axi"),
        HostBus::AhbLite => ("s_ahb", "xilinx.com:interface:ahblite", ""),
        HostBus::Spi | HostBus::Parallel | HostBus::Bare => return None,
    };
    let prefix = format!("{name}_");
    let own = ports.iter().filter_map(|port| {
        let rest = port.name.strip_prefix(&prefix)?;
        Some((port, rest))
    });
    let signals = own.clone().map(|(port, rest)| Signal {
        logical: match rest {
            "rx_i" => "RxD".into(),
            "tx_o" => "TxD".into(),
            rest => rest.to_ascii_uppercase(),
        },
        port: port.name.clone(),
        is_output: port.direction == "out",
        litex: match bus {
            HostBus::Wishbone => wishbone_field(rest),
            HostBus::AxiLite => axi_field(rest, port.width),
            _ => String::new(),
        },
    });
    let width = |rest: &str| own.clone().find(|(_, r)| *r == rest).map(|(p, _)| p.width);
    let (litex, address_bits) = match bus {
        HostBus::Wishbone => {
            let bits = width("adr_i")?;
            let class =
                format!("wishbone.Interface(data_width=32, adr_width={bits}, addressing=\"word\")");
            // Words of four bytes.
            (class, bits + 2)
        }
        HostBus::AxiLite => {
            let bits = width("awaddr")?;
            // LiteX joins interfaces of the system's width only.
            let class = "axi.AXILiteInterface(data_width=32, address_width=32)".into();
            (class, bits)
        }
        HostBus::Apb => (String::new(), width("paddr")?),
        HostBus::AhbLite => (String::new(), width("haddr")?),
        _ => (String::new(), 0),
    };
    let ipxact = |end: &str| match bus {
        HostBus::Apb => vlnv("amba.com", "AMBA3", "APB", end, "r1p0_0"),
        HostBus::AhbLite => vlnv("amba.com", "AMBA3", "AHBLite", end, "r2p0_0"),
        HostBus::AxiLite => vlnv("amba.com", "AMBA4", "AXI4-Lite", end, "r0p0_0"),
        HostBus::Wishbone => vlnv("opencores.org", "interface", "wishbone", end, "B4"),
        _ => String::new(),
    };
    Some(Interface {
        name,
        vivado,
        ipxact: ipxact(""),
        ipxact_rtl: ipxact("_rtl"),
        platform_designer: match bus {
            HostBus::Apb => "apb",
            HostBus::AxiLite => "axi4lite",
            _ => "",
        },
        unused: match bus {
            HostBus::AxiLite => PROTECTION.into(),
            _ => vec![],
        },
        litex,
        litex_module,
        signals: signals.collect(),
        size_bytes: if address_bits == 0 {
            0
        } else {
            1 << address_bits
        },
    })
}

/// Vendor, library, name and version as attributes; `end` is that of the name.
fn vlnv(vendor: &str, library: &str, name: &str, end: &str, version: &str) -> String {
    format!("vendor=\"{vendor}\" library=\"{library}\" name=\"{name}{end}\" version=\"{version}\"")
}

/// `dat_i` is what the master writes.
fn wishbone_field(rest: &str) -> String {
    match rest {
        "dat_i" => "dat_w".into(),
        "dat_o" => "dat_r".into(),
        rest => rest.trim_end_matches("_i").trim_end_matches("_o").into(),
    }
}

/// `awaddr` is `addr` of the channel `aw`, as many bits as the port has.
fn axi_field(rest: &str, width: usize) -> String {
    let channels = ["aw", "ar", "w", "r", "b"];
    let split = channels.iter().find_map(|channel| {
        let field = rest.strip_prefix(channel)?;
        Some(match field {
            "addr" => format!("{channel}.{field}[:{width}]"),
            _ => format!("{channel}.{field}"),
        })
    });
    split.unwrap_or_default()
}

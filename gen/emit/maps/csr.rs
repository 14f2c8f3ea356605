//! The register map as LiteX writes its own: `csr.csv`, which `litex_cli` and `RemoteClient` take.
//!
//! That form has words and no fields, and a name for each copy of a block. A strobe is `rw`, since `litex_cli --regs` reads whatever is
//! listed; it reads 0.

use super::{Map, WORD_BYTES};
use endat_regs::Access;
use std::fmt::Write;

/// The file; addresses count bytes.
pub fn write(map: &Map, system_hz: u64) -> String {
    let mut bases = String::new();
    let mut words = String::new();
    for block in &map.blocks {
        for copy in 0..block.copies {
            let name = match block.block.per_channel {
                true => format!("{}{copy}", block.block.name),
                false => block.block.name.to_owned(),
            };
            let base = map.base_address + block.base_bytes() + copy * block.stride_bytes();
            // Writing to a String cannot fail.
            let _ = writeln!(bases, "csr_base,{name},0x{base:08x},,");
            for entry in &block.registers {
                let register = entry.register;
                let address = base + u32::from(register.offset) * WORD_BYTES;
                let mode = match register.access {
                    Access::ReadOnly => "ro",
                    Access::ReadWrite | Access::Strobe => "rw",
                };
                let _ = writeln!(
                    words,
                    "csr_register,{name}_{},0x{address:08x},1,{mode}",
                    register.name
                );
            }
        }
    }
    let bits = 8 * WORD_BYTES;
    format!(
        "# {}\n# {}\n{bases}{words}\
         constant,config_clock_frequency,{system_hz},,\n\
         constant,config_csr_data_width,{bits},,\n\
         constant,config_bus_address_width,{bits},,\n",
        map.title(),
        map.origin
    )
}

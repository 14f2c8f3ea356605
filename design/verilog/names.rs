//! The design with the names of the Verilog text.

use crate::elaborate::Design;

pub use crate::elaborate::emitted_name;

/// The design with the names of the text, and otherwise as it is.
pub fn named(design: &Design) -> Design {
    let mut design = design.clone();
    for module in &mut design.modules {
        let nets = module.nets.iter_mut().map(|n| &mut n.name);
        for name in nets.chain(module.memories.iter_mut().map(|m| &mut m.name)) {
            *name = emitted_name(name);
        }
        // A net of a child with the name of an instance would hide that instance.
        for instance in &mut module.instances {
            instance.name = format!("u_{}", instance.name);
        }
    }
    design
}

//! Names that VHDL takes.

use super::package::FUNCTIONS;
use crate::elaborate::Design;
use crate::printing::Names;

/// Words of VHDL-93 and VHDL-2008, PSL's among them, and what the text calls by its name.
const KEYWORDS: &str = "abs access after alias all and architecture array assert assume assume_guarantee attribute begin block body \
    buffer bus case component configuration constant context cover default disconnect downto else elsif end entity exit fairness file \
    for force function generate generic group guarded if impure in inertial inout is label library linkage literal loop map mod nand \
    new next nor not null of on open or others out package parameter port postponed procedure process property protected pure range \
    record register reject release rem report restrict restrict_guarantee return rol ror select sequence severity shared signal sla \
    sll sra srl strong subtype then to transport type unaffected units until use variable vmode vprop vunit wait when while with xnor \
    xor work ieee std rtl boolean integer natural true false";

/// The emitted name of a net, port or instance. VHDL allows no leading, trailing or double underscores; a reserved word
/// gets `_value` appended.
pub fn emitted_name(name: &str) -> String {
    let parts: Vec<&str> = name.split('_').filter(|part| !part.is_empty()).collect();
    let name = match parts.join("_") {
        name if name.starts_with(|c: char| c.is_ascii_alphabetic()) => name,
        name => format!("n{name}"),
    };
    let lower = name.to_lowercase();
    let is_word = KEYWORDS.split_whitespace().any(|word| word == lower);
    match is_word || FUNCTIONS.contains(&lower.as_str()) {
        true => format!("{name}_value"),
        false => name,
    }
}

/// The design with the names of the text, and otherwise as it is: in VHDL all of a module's share one space, without regard to case.
pub fn named(design: &Design) -> Design {
    let mut design = design.clone();
    let mut modules = Names::default();
    for module in &mut design.modules {
        module.name = modules.unique(&emitted_name(&module.name));
        let mut names = Names::default();
        let ports: Vec<usize> = module.ports.iter().map(|p| p.net).collect();
        for port in &ports {
            let net = &mut module.nets[*port];
            net.name = names.unique(&emitted_name(&net.name));
        }
        for (_, net) in (module.nets.iter_mut().enumerate()).filter(|(n, _)| !ports.contains(n)) {
            net.name = names.unique(&emitted_name(&net.name));
        }
        let others = module.parameters.iter_mut().map(|p| &mut p.name);
        for name in others.chain(module.memories.iter_mut().map(|m| &mut m.name)) {
            *name = names.unique(&emitted_name(name));
        }
        for instance in &mut module.instances {
            instance.name = names.unique(&emitted_name(&format!("u_{}", instance.name)));
        }
    }
    design
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_vhdl_and_its_underscores_are_no_names() {
        for (name, emitted) in [
            ("count", "count"),
            ("Signal", "Signal_value"),
            ("range", "range_value"),
            ("to_sl", "to_sl_value"),
            ("_a__b_", "a_b"),
            ("_7", "n7"),
        ] {
            assert_eq!(emitted_name(name), emitted);
        }
    }
}

//! The last steps on a whole design: order of the modules, and their names.

use super::design::{Design, Direction, ModuleId};
use super::names::{problem, snake_case};
use super::tree::BlockNode;
use super::ElaborateError;
use std::collections::BTreeMap;

/// Puts the top first and gives every module its name.
pub(super) fn finish(
    design: &mut Design,
    top: ModuleId,
    name: &str,
    tree: &BlockNode,
) -> Result<(), ElaborateError> {
    order_modules(design, top);
    name_modules(design, name);
    if let Some(problem) = problem(name) {
        return Err(tree.error(
            "",
            format!("module name = {name}: {problem}"),
            "choose another name",
        ));
    }
    Ok(())
}

/// Leaves the top and what is below it, the top first.
pub(super) fn order_modules(design: &mut Design, top: ModuleId) {
    let order = top_down(design, top);
    let mut position = vec![0; design.modules.len()];
    for (new, old) in order.iter().enumerate() {
        position[*old] = new;
    }
    let mut modules: Vec<_> = std::mem::take(&mut design.modules)
        .into_iter()
        .map(Some)
        .collect();
    design.modules = order
        .iter()
        .filter_map(|old| modules[*old].take())
        .collect();
    for module in &mut design.modules {
        for instance in &mut module.instances {
            instance.module = position[instance.module];
        }
    }
}

/// Every module before those that it instantiates, otherwise in the order of the source.
fn top_down(design: &Design, top: ModuleId) -> Vec<ModuleId> {
    fn visit(design: &Design, module: ModuleId, done: &mut Vec<ModuleId>) {
        if done.contains(&module) {
            return;
        }
        for instance in design.modules[module].instances.iter().rev() {
            visit(design, instance.module, done);
        }
        done.push(module);
    }
    let mut done = vec![];
    visit(design, top, &mut done);
    done.reverse();
    done
}

/// The name of a block's module in a design with the top `top`. The top's name comes first, so two designs in one project never have
/// different modules of one name.
pub fn block_name(top: &str, type_name: &str) -> String {
    format!("{top}_{}", snake_case(type_name))
}

fn name_modules(design: &mut Design, top_name: &str) {
    let mut by_type: BTreeMap<String, Vec<ModuleId>> = BTreeMap::new();
    for (id, module) in design.modules.iter().enumerate().skip(1) {
        let name = block_name(top_name, &module.type_name);
        by_type.entry(name).or_default().push(id);
    }
    design.modules[0].name = top_name.into();
    for (name, ids) in by_type {
        let suffixes = suffixes(design, &ids);
        for (id, suffix) in ids.into_iter().zip(suffixes) {
            design.modules[id].name = format!("{name}{suffix}");
        }
    }
}

/// Suffixes that distinguish modules of one block type: the first width or constant that differs in all of them, or else a number.
/// Start values of registers are not part of a name: they may be as long as the register.
fn suffixes(design: &Design, ids: &[ModuleId]) -> Vec<String> {
    if ids.len() == 1 {
        return vec![String::new()];
    }
    let facts: Vec<BTreeMap<String, String>> = ids.iter().map(|id| facts(design, *id)).collect();
    let distinguishing = facts[0].keys().find(|key| {
        let values: Vec<_> = facts.iter().filter_map(|f| f.get(*key)).collect();
        values.len() == ids.len()
            && values
                .iter()
                .enumerate()
                .all(|(i, v)| !values[..i].contains(v))
    });
    match distinguishing {
        Some(key) => facts
            .iter()
            .map(|f| match f[key].as_str() {
                "" => String::new(),
                fact => format!("_{fact}"),
            })
            .collect(),
        None => (1..=ids.len()).map(|number| format!("_{number}")).collect(),
    }
}

/// Widths of the ports and values of the constants, as they are said in a name; widths sort first.
fn facts(design: &Design, id: ModuleId) -> BTreeMap<String, String> {
    let module = &design.modules[id];
    let mut facts = BTreeMap::new();
    for port in &module.ports {
        let net = &module.nets[port.net];
        let kind = if port.direction == Direction::Input {
            "1i"
        } else {
            "0o"
        };
        facts.insert(
            format!("{kind} {}", net.name),
            format!("{}_bits", net.width_bits),
        );
    }
    for parameter in &module.parameters {
        let key = parameter.name.to_lowercase();
        // A feature is named only where it is present.
        let fact = match (parameter.width_bits, parameter.value) {
            (1, 0) => String::new(),
            (1, _) => key.clone(),
            (_, value) => format!("{key}_{value}"),
        };
        facts.insert(format!("2p {key}"), fact);
    }
    facts
}

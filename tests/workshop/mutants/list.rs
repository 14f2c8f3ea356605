//! What yosys does with a module before it is a mutant, and the mutants that it lists.

use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_tools::programs;
use endat_tools::prove::{Subject, YOSYS};
use endat_tools::scratch;
use rtl_design::elaborate::Module;
use rtl_design::verilog::file_name;
use std::collections::BTreeSet;
use std::path::Path;

/// The list that yosys writes.
const LIST: &str = "mutants.txt";
/// Longest piece of source that names a place.
const SOURCE_CHARS: usize = 72;

/// One change of one module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutation {
    /// Options of `mutate` that make it.
    pub options: String,
    /// Where and how, for people.
    pub place: String,
}

/// Modules directly below one, each once, and in a fixed order.
pub fn children<'a>(subject: &'a Subject, module: &Module) -> BTreeSet<&'a str> {
    let below = module.instances.iter().map(|i| i.module);
    below
        .map(|index| subject.design.modules[index].name.as_str())
        .collect()
}

/// Reads a module. Cells are named by the order in which they are made, so all that is done with it begins alike.
pub fn reading(subject: &Subject, module: &Module) -> String {
    let mut script = format!(
        "read_verilog -formal -sv -DFORMAL {}\n",
        file_name(&module.name)
    );
    let below = children(subject, module);
    if !below.is_empty() {
        let files: Vec<String> = below.into_iter().map(file_name).collect();
        script += &format!("read_verilog -lib {}\n", files.join(" "));
    }
    // A table as memory has contents, which nothing can change at run time.
    script + &format!("proc -norom {}\n", module.name)
}

/// The same without its properties.
pub fn reading_bare(subject: &Subject, module: &Module) -> String {
    let name = &module.name;
    reading(subject, module) + &format!("chformal -remove {name}\nopt_clean {name}\n")
}

/// The files that [`reading`] reads.
pub fn files(subject: &Subject, module: &Module) -> Vec<Artifact> {
    let below = children(subject, module);
    let is_read = |file: &&Artifact| {
        let name = file.path.trim_end_matches(".v");
        name == module.name || below.contains(name)
    };
    subject.files.iter().filter(is_read).cloned().collect()
}

/// Runs a script; what yosys said.
pub fn yosys(folder: &Path, name: &str, script: String) -> Result<programs::Ran, CommandError> {
    let file = Artifact::new(format!("{name}.ys"), script);
    endat_console::artifact::write(folder, &[file], scratch::REMEDY)?;
    programs::run(YOSYS, folder, &[&format!("{name}.ys")])
}

/// The same where nothing but success is expected.
pub fn yosys_must(folder: &Path, name: &str, script: String) -> Result<(), CommandError> {
    let ran = yosys(folder, name, script)?;
    if ran.is_good {
        return Ok(());
    }
    Err(CommandError::fault(
        "campaign mutants",
        &format!(
            "{YOSYS}: {name}.ys: {}",
            programs::line_with(&ran.text(), "ERROR")
        ),
    ))
}

/// At most so many mutants of a module.
pub fn mutations(
    subject: &Subject,
    module: &Module,
    count: u64,
    seed: u64,
) -> Result<Vec<Mutation>, CommandError> {
    let folder = scratch::folder()?;
    let files = files(subject, module);
    endat_console::artifact::write(folder.path(), &files, scratch::REMEDY)?;
    let text = files.iter().find(|f| f.path == file_name(&module.name));
    let text = text.map_or("", |f| f.text.as_str());
    let name = &module.name;
    let mut found = vec![];
    // Where contents of a memory crowd the list, it is made again without them.
    for chosen in [name.clone(), format!("{name}/* {name}/t:$meminit* %d")] {
        let script = format!(
            "{}mutate -list {} -seed {seed} -o {LIST} {chosen}\n",
            reading_bare(subject, module),
            2 * count,
        );
        yosys_must(folder.path(), name, script)?;
        let list = scratch::read(&folder.path().join(LIST))?;
        let mutations = list.lines().filter_map(|line| mutation(line, text));
        found = mutations.take(count as usize).collect();
        if found.len() as u64 == count || !list.contains("$meminit") {
            break;
        }
    }
    Ok(found)
}

/// A line of the list; none at the output of a register, which would lose its start value, none of the
/// contents of a memory.
/// As `mutate -mode inv -module m -cell c -port A -portbit 2 -wire w -wirebit 2 -src m.v:32.18-32.22 -src ...`.
fn mutation(line: &str, text: &str) -> Option<Mutation> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let options: Vec<(&str, &str)> = words
        .get(1..)?
        .chunks_exact(2)
        .map(|p| (p[0], p[1]))
        .collect();
    let value = |name: &str| options.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
    let kept = options
        .iter()
        .filter(|(name, _)| !matches!(*name, "-src" | "-wire" | "-wirebit"));
    let kept: Vec<String> = kept
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    let mut sources = options
        .iter()
        .filter(|(name, _)| *name == "-src")
        .map(|(_, v)| *v);
    let wire = value("-wire");
    let first = sources.next();
    // The first one of a mutant with a name is where that is declared.
    let source = wire.and_then(|_| sources.next()).or(first);
    let (port, bit) = (value("-port")?, value("-portbit")?);
    let what = match wire {
        Some(wire) => format!("{wire}[{}] at {port}", value("-wirebit")?),
        None => format!("{port}[{bit}]"),
    };
    if port == "Q" || value("-cell")?.starts_with("$meminit") {
        return None;
    }
    let place = format!("{}: {what}, {}", spot(source, text), value("-mode")?);
    Some(Mutation {
        options: kept.join(" "),
        place,
    })
}

/// A place in the text: number of the line, and the line.
fn spot(source: Option<&str>, text: &str) -> String {
    let place = source.and_then(|s| s.rsplit_once(':'));
    let line = place.and_then(|(_, place)| place.split_once('.')?.0.parse::<usize>().ok());
    let Some(line) = line else {
        return "whole module".into();
    };
    let shown = text.lines().nth(line.saturating_sub(1)).unwrap_or("");
    let shown: String = shown.trim().chars().take(SOURCE_CHARS).collect();
    format!("line {line} `{}`", shown.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "module m;\n    wire [3:0] sum;\n    assign sum = a + b;\nendmodule\n";

    #[test]
    fn a_mutant_is_named_by_what_it_changes_and_where() {
        let line = "mutate -mode inv -module m -cell $add$m.v:3$1 -port Y -portbit 2 -wire sum -wirebit 2 -src m.v:2.16-2.19 -src m.v:3.18-3.23";
        let found = mutation(line, TEXT).unwrap();
        assert_eq!(
            found.place,
            "line 3 `assign sum = a + b;`: sum[2] at Y, inv"
        );
        assert_eq!(
            found.options,
            "-mode inv -module m -cell $add$m.v:3$1 -port Y -portbit 2"
        );
        let line = "mutate -mode cnot0 -module m -cell $add$m.v:3$1 -port A -portbit 1 -ctrlbit 3 -src m.v:3.18-3.23";
        let found = mutation(line, TEXT).unwrap();
        assert_eq!(found.place, "line 3 `assign sum = a + b;`: A[1], cnot0");
        assert!(found.options.ends_with("-ctrlbit 3"));
    }

    #[test]
    fn a_register_keeps_its_start_value_and_a_memory_its_contents() {
        for line in [
            "mutate -mode inv -module m -cell $procdff$9 -port Q -portbit 0 -wire r -wirebit 0 -src m.v:2.1-2.2",
            "mutate -mode inv -module m -cell $meminit$r$m.v:3$1 -port DATA -portbit 0 -src m.v:3.1-3.2",
        ] {
            assert_eq!(mutation(line, TEXT), None, "{line}");
        }
    }
}

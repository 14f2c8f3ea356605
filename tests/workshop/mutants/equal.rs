//! Whether a mutant is one at all: side by side with its module, all inputs alike, no output is ever another one.

use super::list::{children, files, reading_bare, yosys, Mutation};
use endat_console::error::CommandError;
use endat_tools::programs;
use endat_tools::prove::Subject;
use endat_tools::scratch;
use rtl_design::elaborate::Module;
use std::path::Path;
use std::time::Duration;

/// Finds invariants by itself where an induction is too short.
const PDR: &str = "yosys-abc";
/// Its question, and what it is asked of.
const AIGER: &str = "miter.aig";
const PROVED: &str = "Property proved.";

/// Seconds for one question.
const TIMEOUT_S: u32 = 30;
/// Time for signals that are always alike and invariants together: in a large block the first have no end of their own.
const LONGEST: Duration = Duration::from_secs(600);
/// Longest induction, in cycles.
const STEPS_MAX: u32 = 8;
/// Longest induction over signals of both that are always alike, in cycles: longer than a bit of a serial line in a card that is simulated.
const ALIKE_CYCLES: u32 = 40;

/// Ways to prove it, from the quick one to the slow one: what is done with both before they are compared, and the question.
fn ways() -> [(&'static str, String); 3] {
    let ask = format!("sat -prove trigger 0 -timeout {TIMEOUT_S}");
    let induct = format!("{ask} -tempinduct -maxsteps {STEPS_MAX}");
    [
        // Whatever the registers hold: the same outputs, and the same next contents.
        ("expose -evert-dff gold gate\n", ask),
        // From the start values on, with the same contents in every cycle.
        ("expose -dff gold gate\n", induct.clone()),
        // From the start values on, whatever is inside.
        ("", induct),
    ]
}

/// Whether it is proved. What stands below the module is cut off: what goes there counts as an output.
pub fn is_equal(
    subject: &Subject,
    module: &Module,
    mutation: &Mutation,
) -> Result<bool, CommandError> {
    let folder = scratch::folder()?;
    endat_console::artifact::write(folder.path(), &files(subject, module), scratch::REMEDY)?;
    let name = &module.name;
    let mut both = format!(
        "{}copy {name} gold\nmutate {}\nrename {name} gate\n",
        reading_bare(subject, module),
        mutation.options
    );
    for below in children(subject, module) {
        both += &format!("expose -evert t:{below}\n");
    }
    both += "expose -evert t:$mem*\n";
    for (prepared, question) in ways() {
        let script = format!("{both}{prepared}{MITER}{question} miter\n");
        let ran = yosys(folder.path(), "equal", script)?;
        if ran.is_good && ran.stdout.contains("SUCCESS!") {
            return Ok(true);
        }
    }
    by_invariants(folder.path(), &both)
}

const MITER: &str = "miter -equiv -flatten gold gate miter
delete gold gate
opt_merge
opt_expr
opt_clean
";

/// From the start values on: signals that are always alike become one, and of what is left property directed reachability finds invariants.
fn by_invariants(folder: &Path, both: &str) -> Result<bool, CommandError> {
    let script = format!(
        "{both}{MITER}hierarchy -top miter\nmemory_map\nopt\ntechmap\nopt\ndffunmap\nsimplemap\naigmap\n\
         setundef -anyseq\nopt_clean\nwrite_aiger -zinit -miter {AIGER}\n"
    );
    // What is undefined may be anything. A module with registers on both edges of its clock has no such model.
    if !yosys(folder, "invariants", script)?.is_good {
        return Ok(false);
    }
    let question = format!("read_aiger {AIGER}; scorr -q -F {ALIKE_CYCLES}; pdr -T {TIMEOUT_S}");
    let ran = programs::run_within(PDR, folder, &["-q", &question], LONGEST)?;
    Ok(ran.is_some_and(|ran| ran.is_good && ran.text().contains(PROVED)))
}

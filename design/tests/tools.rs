//! Outside tools. Without its tools a test passes, and the test binary lists the missing tools when it exits; in CI (variable `CI` set)
//! the test fails.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{LazyLock, Mutex, MutexGuard, Once, OnceLock, PoisonError};

/// Programs and Python modules that tests need, and the commands that install them.
static INSTALLS: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| {
    let table = include_str!("../../tests/strangers/table.toml");
    let table: toml::Table = table.parse().unwrap();
    let mut installs = BTreeMap::new();
    for row in table["stranger"].as_array().unwrap() {
        let text = |key: &str| row.get(key).and_then(toml::Value::as_str);
        let list = |key: &str| row.get(key).and_then(toml::Value::as_array).into_iter();
        let names = list("programs").chain(list("modules")).flatten();
        let names: Vec<&str> = names.filter_map(toml::Value::as_str).collect();
        let command = match (text("install"), text("pip"), names.first()) {
            (Some(command), ..) => command.to_owned(),
            (_, Some(package), _) => format!("pip install {package}"),
            (.., Some(program)) => format!("apt install {program}"),
            _ => panic!("{row}: has no name that a test needs"),
        };
        installs.extend(names.iter().map(|n| ((*n).to_owned(), command.clone())));
    }
    installs
});

/// The command that installs a program or `Python module NAME`.
pub fn install(what: &str) -> &'static str {
    let name = what.strip_prefix("Python module ").unwrap_or(what);
    INSTALLS
        .get(name)
        .map_or("see CONTRIBUTING.md", String::as_str)
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

/// An empty folder for the files of one test. Concurrent processes have separate folders; the files remain for
/// debugging, and the next process replaces them.
pub fn folder(name: &str) -> PathBuf {
    static HELD: OnceLock<(fs::File, PathBuf)> = OnceLock::new();
    let (_, home) = HELD.get_or_init(|| {
        let places = (0..).map(|n| Path::new(env!("CARGO_TARGET_TMPDIR")).join(n.to_string()));
        let mut held = places.filter_map(|home| {
            fs::create_dir_all(&home).unwrap();
            let lock = fs::File::create(home.join("lock")).unwrap();
            lock.try_lock().is_ok().then_some((lock, home))
        });
        held.next().expect("there is always a next number")
    });
    let path = home.join(name);
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

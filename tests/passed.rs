//! Checks that have passed before. What an outside tool says of a text depends on the text alone, what a simulation says of the core on its
//! sources; both take minutes. Such a check is done again when anything has changed that it sees.
//!
//! `tests/data/passed.toml` has a digest of that for each check; `CI=true UPDATE_EXPECT=1 cargo test NAME` does what is not in it, and
//! writes it down if it passes. All are done with `SUITE_WHOLE=1`; with `SUITE_TURN=N`, as in CI, every eighth is, whatever the table
//! says, another eighth for each N: what a table cannot see, another version of a tool, is found in time.

use crate::tools;
use endat_gen::artifact::{sha256, Artifact};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};

const TABLE: &str = "tests/data/passed.toml";
const HEAD: &str = "# Long checks that have passed, each with a digest of all that it saw (tests/passed.rs). Renew with: CI=true UPDATE_EXPECT=1 cargo test NAME\n";
/// How many runs in a row do every check once.
const TURNS: u64 = 8;

/// What a simulation of the core is made of.
const CORE: [&str; 7] = [
    "regs",
    "hdl",
    "sim",
    "design",
    "gen/config",
    "gen/presets",
    "tests/host.rs",
];
/// Of that, what only channels of other protocols than EnDat are made of; and where else that is.
const OF_OTHERS: [&str; 6] = [
    "regs/protocols",
    "hdl/protocols",
    "sim/t_format",
    "sim/ssi",
    "gen/protocols",
    "gen/other_protocol.rs",
];
/// What stands in tests that have such channels.
const MEANS_OTHERS: [&str; 6] = [
    "t_format",
    "TFormat",
    "Ssi",
    "ssi_",
    "mixed_protocols",
    "PRESETS",
];

/// Of what a simulated card and the host library at it are made besides.
pub const HOST: [&str; 8] = [
    "gen/virtual_card",
    "gen/encoders.rs",
    "gen/buses.rs",
    "gen/buses",
    "gen/front.rs",
    "host",
    "drivers/rust",
    "tests/hosts/desk.rs",
];

/// Begins a test that simulates the core, and ends it if it has passed with just this core, and host; given are other sources that it depends on.
macro_rules! once_for_this_core {
    (with host $(, $more:literal)*) => {
        once_for_this_core!(@ $crate::passed::HOST, [$($more),*])
    };
    ($($more:literal),*) => {
        once_for_this_core!(@ [] as [&str; 0], [$($more),*])
    };
    (@ $host:expr, $more:expr) => {
        fn here() {}
        let name = std::any::type_name_of_val(&here);
        let name = name
            .trim_start_matches("system::")
            .trim_end_matches("::here");
        let check = $crate::passed::Check::of_core(name, file!());
        let check = check.sources(&$host).sources(&$more as &[&str]);
        let Some(_running) = check.begin() else {
            return;
        };
    };
}
pub(crate) use once_for_this_core;

/// A check by its name, and everything that its verdict depends on.
pub struct Check {
    name: String,
    seen: String,
}

impl Check {
    pub fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Check {
            seen: format!("{name}\n"),
            name,
        }
    }

    /// A check by simulation: decided by the core, the models around it, what simulates them, and by the tests of its topic.
    pub fn of_core(name: &str, file: &str) -> Self {
        let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
        let own = if folder == "tests" { file } else { folder };
        let check = Check::new(name).source_but(own, &[]);
        let has_others = MEANS_OTHERS.iter().any(|word| check.seen.contains(word));
        match has_others {
            true => check.sources(&CORE).sources(&OF_OTHERS),
            false => CORE
                .iter()
                .fold(check, |check, path| check.source_but(path, &OF_OTHERS)),
        }
    }

    pub fn text(mut self, text: &str) -> Self {
        self.seen += &format!("{}\n{text}\n", text.len());
        self
    }

    /// The hardware among emitted files; what stands in comments decides nothing.
    pub fn files(self, files: &[Artifact]) -> Self {
        let files = files.iter().filter(|f| is_hardware(&f.path));
        files.fold(self, |check, file| {
            let lines = file.text.lines();
            let lines = lines.filter(|line| !is_comment(line));
            let text: Vec<&str> = lines.collect();
            check.text(&file.path).text(&text.join("\n"))
        })
    }

    /// All files of an emission but those for people, to the letter: for who reads more than hardware.
    pub fn emission(self, files: &[Artifact]) -> Self {
        let for_people = [".md", ".svg"];
        let files = files.iter();
        let files = files.filter(|f| !for_people.iter().any(|end| f.path.ends_with(end)));
        files.fold(self, |check, file| check.text(&file.path).text(&file.text))
    }

    /// What a file of the repository says, or all files of a folder but pages: of those that write scripts, models and benches.
    pub fn source(self, path: &str) -> Self {
        self.source_but(path, &[])
    }

    /// The same without these files and folders.
    fn source_but(self, path: &str, without: &[&str]) -> Self {
        if without.contains(&path) {
            return self;
        }
        let full = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        if full.is_file() {
            return self.text(&read_source(path));
        }
        let entries = fs::read_dir(&full).unwrap_or_else(|e| panic!("{path}: {e}"));
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.retain(|name| !name.ends_with(".md") && name != "__pycache__");
        // Tests of a crate decide nothing here.
        if !path.starts_with("tests") {
            names.retain(|name| !["tests", "tests.rs", "golden"].contains(&name.as_str()));
        }
        names.sort();
        let inside = names.iter().map(|name| format!("{path}/{name}"));
        inside.fold(self, |check, path| check.source_but(&path, without))
    }

    /// All of these, see [`Check::source`].
    pub fn sources(self, paths: &[&str]) -> Self {
        paths.iter().fold(self, |check, path| check.source(path))
    }

    /// Begins the check, unless it has passed with just this. It has passed when this goes and no assertion has failed.
    pub fn begin(self) -> Option<Running> {
        let digest = sha256(self.seen.as_bytes())[..16].to_owned();
        let is_known = read().get(&self.name) == Some(&digest);
        if is_known && !is_wanted(&self.name) {
            eprintln!("{}: has passed with this ({TABLE})", self.name);
            return None;
        }
        // In CI a tool that is missing fails; elsewhere its check passes without having been done.
        let is_set = |name: &str| std::env::var_os(name).is_some();
        let renews = !is_known && is_set("UPDATE_EXPECT") && is_set("CI");
        Some(Running {
            renews,
            name: self.name,
            digest,
        })
    }

    /// Does the check, which panics if it fails.
    pub fn unless_passed(self, check: impl FnOnce()) {
        if let Some(_running) = self.begin() {
            check();
        }
    }

    /// The same of a check that says what is wrong.
    pub fn complaint_unless_passed(self, check: impl FnOnce() -> Option<String>) -> Option<String> {
        let mut running = self.begin()?;
        let complaint = check();
        running.renews &= complaint.is_none();
        complaint
    }
}

/// A check that is being done.
pub struct Running {
    renews: bool,
    name: String,
    digest: String,
}

impl Drop for Running {
    fn drop(&mut self) {
        if self.renews && !std::thread::panicking() {
            write(&self.name, &self.digest);
        }
    }
}

/// What a file says, as far as it decides something; each is read once.
fn read_source(path: &str) -> Arc<str> {
    static READ: Mutex<BTreeMap<String, Arc<str>>> = Mutex::new(BTreeMap::new());
    if let Some(text) = READ.lock().unwrap().get(path) {
        return text.clone();
    }
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    let text: Arc<str> = match path.ends_with(".rs") {
        true => meant(path, &text).into(),
        false => text.into(),
    };
    READ.lock().unwrap().insert(path.into(), text.clone());
    text
}

/// A source without what the compiler does not look at: comments, documentation, how it is laid out.
fn meant(path: &str, text: &str) -> String {
    fn write(tokens: TokenStream, out: &mut String) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            at += 1;
            if is(token, '#') {
                let skips = usize::from(tokens.get(at).is_some_and(|next| is(next, '!')));
                if tokens.get(at + skips).is_some_and(is_doc) {
                    at += skips + 1;
                    continue;
                }
            }
            match token {
                TokenTree::Group(group) => {
                    *out += &format!("{:?} ", group.delimiter());
                    write(group.stream(), out);
                    *out += "end ";
                }
                other => *out += &format!("{other} "),
            }
        }
    }
    fn is(token: &TokenTree, mark: char) -> bool {
        matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
    }
    fn is_doc(token: &TokenTree) -> bool {
        let TokenTree::Group(group) = token else {
            return false;
        };
        let first = group.stream().into_iter().next();
        first.is_some_and(|name| name.to_string() == "doc")
    }
    let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{path}: {e}"));
    let mut out = String::new();
    write(tokens, &mut out);
    out
}

fn is_hardware(path: &str) -> bool {
    [".v", ".vhd", ".vh", ".f", ".txt"]
        .iter()
        .any(|end| path.ends_with(end))
}

fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("//") || line.starts_with("--")
}

/// Whether a check is to be done in this run, even if it has passed with just this.
pub fn is_wanted(name: &str) -> bool {
    tools::is_whole() || is_its_turn(name, turn())
}

fn turn() -> Option<u64> {
    std::env::var("SUITE_TURN").ok()?.parse().ok()
}

fn is_its_turn(name: &str, turn: Option<u64>) -> bool {
    let place = name
        .bytes()
        .fold(0u64, |sum, byte| sum * 31 % 8191 + u64::from(byte));
    turn.is_some_and(|turn| (place + turn) % TURNS == 0)
}

type Table = BTreeMap<String, String>;

fn read() -> Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    let text = fs::read_to_string(path).unwrap_or_default();
    toml::from_str(&text).unwrap_or_else(|e| panic!("{TABLE}: {e}"))
}

/// Another test may write its own row at the same time.
fn write(name: &str, digest: &str) {
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap();
    let mut table = read();
    table.insert(name.to_owned(), digest.to_owned());
    let rows = table
        .iter()
        .map(|(name, digest)| format!("{name:?} = \"{digest}\"\n"));
    let text = HEAD.to_owned() + &rows.collect::<String>();
    fs::write(Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE), text).unwrap();
}

/// Catches a check that is never done again, and one that is done in each run.
#[test]
fn every_check_has_its_turn() {
    for name in read().into_keys() {
        let turns = (0..TURNS).filter(|&turn| is_its_turn(&name, Some(turn)));
        assert_eq!(turns.count(), 1, "{name}");
        assert!(!is_its_turn(&name, None));
    }
}

/// Catches a change that a digest does not see, and one of a comment that it does.
#[test]
fn a_digest_is_of_all_that_decides() {
    let file = |path: &str, text: &str| Artifact {
        path: path.into(),
        text: text.into(),
    };
    let seen = |files: &[Artifact]| Check::new("check").files(files).seen;
    let is = seen(&[
        file("a.v", "module a;\n"),
        file("b.v", "// words\nmodule b;\n"),
    ]);
    assert_eq!(
        is,
        seen(&[
            file("a.v", "module a;\n"),
            file("b.v", "  // others\nmodule b;\n"),
            file("a.svg", "<svg/>")
        ])
    );
    for other in [
        vec![file("a.v", "module a;\n")],
        vec![file("a.v", "module a;\nmodule b;\n")],
        vec![file("a.v", "module a;\n"), file("b.v", "module c;\n")],
        vec![file("a.v", "module a;\n"), file("c.v", "module b;\n")],
    ] {
        assert_ne!(is, seen(&other));
    }
    assert_ne!(is, Check::new("other").text(&is).seen);
    let source = Check::new("check").source("tests/passed.rs").seen;
    assert!(source.contains("fn a_digest_is_of_all_that_decides"));
    let rust = |text: &str| meant("a.rs", text);
    let plain = rust("fn a() { let b = 1; }");
    for same in [
        "//! About.\n/// Does.\nfn a() {\n    // Why.\n    let b = 1;\n}\n",
        "#![doc = \"x\"]\n#[doc(hidden)]\nfn a(){let b=1;}",
    ] {
        assert_eq!(rust(same), plain);
    }
    for other in [
        "fn a() { let b = 2; }",
        "#[test] fn a() { let b = 1; }",
        "fn a() { { let b = 1; } }",
    ] {
        assert_ne!(rust(other), plain);
    }
    // A change of another protocol makes nothing of EnDat due.
    let of = |file| Check::of_core("check", file).seen;
    let is_seen = |seen: &str| seen.contains("TFormatPort");
    assert!(is_seen(&of("tests/t_format/budget.rs")));
    assert!(!of("tests/alignment/tolerance.rs").contains("impl Default for TFormatPort"));
    assert_eq!(
        Check::new("check").source("tests/verilog").seen,
        Check::new("check").source("tests/verilog").seen
    );
}

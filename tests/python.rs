//! The Python package: as a wheel, installed in an environment of its own, its tests, its types.

use crate::program::endat_path;
use crate::tools;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/drivers/python");
const TESTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/drivers/python/tests");

/// What the tests import; plain `pip install endat` takes numpy alone.
const MODULES: [&str; 8] = [
    "pytest",
    "mypy",
    "matplotlib",
    "h5py",
    "pandas",
    "tango",
    "cyclonedds",
    "rosbags",
];

fn done(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let told = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{told}");
    told
}

/// The one wheel in a folder that was empty.
fn wheel_in(folder: &Path) -> PathBuf {
    let mut files = fs::read_dir(folder).unwrap().map(|f| f.unwrap().path());
    let wheel = files.next().expect("a wheel");
    assert!(files.next().is_none(), "more than a wheel");
    wheel
}

/// Builds the package as a wheel and installs it in a separate environment in a folder that it has made; `None` if something is missing.
fn installed(test: &str, check: &str) -> Option<(PathBuf, PathBuf)> {
    let has_all =
        tools::require("maturin", check) && MODULES.iter().all(|m| tools::require_python(m, check));
    if !has_all {
        return None;
    }
    let dir = tools::folder(test);
    let (wheels, environment) = (dir.join("wheels"), dir.join("environment"));
    // In the folder of this build, which has compiled what the wheel shares with the program.
    let target = Path::new(env!("CARGO_BIN_EXE_endat-gen"))
        .ancestors()
        .nth(2);
    done(
        Command::new("maturin")
            .args(["build", "--locked", "--profile", "dev", "--out"])
            .arg(&wheels)
            .env("CARGO_TARGET_DIR", target.unwrap())
            .current_dir(FOLDER),
    );
    let wheel = wheel_in(&wheels);
    let name = wheel.file_name().unwrap().to_str().unwrap();
    let begin = format!("endat-{}-cp310-abi3-", env!("CARGO_PKG_VERSION"));
    assert!(name.starts_with(&begin), "{name}: not {begin}...");
    // Its own pip would take longer than all that is installed.
    done(
        Command::new("python3")
            .args(["-m", "venv", "--system-site-packages", "--without-pip"])
            .arg(&environment),
    );
    let python = environment.join("bin/python");
    done(
        Command::new("python3")
            .args(["-m", "pip", "--python"])
            .arg(&python)
            .args(["install", "--quiet", "--no-deps", "--no-index"])
            .arg(&wheel),
    );
    Some((dir, python))
}

/// The tests of the package with these arguments, from another folder, so that the sources are not what is imported.
fn pytest(dir: &Path, python: &Path, arguments: &[&str]) {
    done(
        Command::new(python)
            .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
            .args(arguments)
            .env("ENDAT", endat_path())
            .env("ENDAT_SERVICE", crate::hosts::quicker_service_file())
            .current_dir(dir),
    );
}

/// The installed types, in the strict reading of somebody who uses them.
fn mypy(dir: &Path, python: &Path) {
    for what in [&[TESTS][..], &["-p", "endat"]] {
        done(
            Command::new(python)
                .args(["-m", "mypy", "--strict", "--cache-dir", "cache"])
                .args(what)
                .current_dir(dir),
        );
    }
}

/// Catches whatever breaks the package: a wheel without a file, a changed library, a promise in the types that is not kept.
#[test]
fn the_python_package_is_built_installed_tested_and_typed() {
    let check = "the Python package is built, installed and tested";
    let Some((dir, python)) = installed("python", check) else {
        return;
    };
    // They wait more than they compute, so they run beside each other: the tests of the card itself take half of the time.
    let card = format!("{TESTS}/test_card.py");
    thread::scope(|scope| {
        scope.spawn(|| pytest(&dir, &python, &[&card]));
        scope.spawn(|| pytest(&dir, &python, &[TESTS, "--ignore", &card]));
        scope.spawn(|| mypy(&dir, &python));
    });
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
#[ignore = "slow: the Python package records an hour, and runs notebook and tutorial as printed"]
fn the_python_package_records_an_hour() {
    if let Some((dir, python)) = installed("python-slow", "slow tests of the Python package") {
        pytest(&dir, &python, &[TESTS, "-m", "slow"]);
        fs::remove_dir_all(&dir).unwrap();
    }
}

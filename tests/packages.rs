//! The crates as others get them: which Rust they need, what they say of themselves, and a program that runs without its sources.

use crate::program::Dir;
use crate::tools;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn cargo(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--offline", "--locked"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

/// The workspace's own packages, as Cargo reads them; needs no crate of others.
pub fn members() -> Value {
    let output = cargo(&["metadata", "--format-version", "1", "--no-deps"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The output of a command that reads all crates that it names. `None` if a crate is not downloaded, as that of a member outside the
/// default members: the check is then skipped, or fails in CI.
fn with_all_crates(arguments: &[&str], check: &str) -> Option<Vec<u8>> {
    let output = cargo(arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    if !output.status.success()
        && told.contains("attempting to make an HTTP request, but --offline was specified")
    {
        tools::lacks(
            "the crates of all members are not downloaded: `cargo fetch`",
            check,
        );
        return None;
    }
    assert!(output.status.success(), "{told}");
    Some(output.stdout)
}

/// What Cargo knows of the workspace and everything that this machine builds for it.
fn metadata(check: &str) -> Option<Value> {
    let rustc = Command::new("rustc").arg("-vV").output().unwrap();
    let told = String::from_utf8(rustc.stdout).unwrap();
    let host = told.lines().find_map(|l| l.strip_prefix("host: ")).unwrap();
    let all = [
        "metadata",
        "--format-version",
        "1",
        "--filter-platform",
        host,
    ];
    let text = with_all_crates(&all, check)?;
    Some(serde_json::from_slice(&text).unwrap())
}

fn is_own(package: &Value) -> bool {
    package["source"].is_null()
}

/// Major, minor, patch; what is left out is 0.
fn version(text: &str) -> [u64; 3] {
    let mut parts = text.split('.').map(|part| part.parse().unwrap());
    [(); 3].map(|()| parts.next().unwrap_or(0))
}

/// What firmware is made of: an older Rust is enough for it.
const FOR_FIRMWARE: [&str; 2] = ["endat-driver", "endat-regs"];

/// Catches a dependency that wants a newer Rust than the workspace says.
#[test]
fn rust_version_is_what_the_dependencies_need() {
    let Some(metadata) = metadata("Rust that the dependencies need") else {
        return;
    };
    let packages = metadata["packages"].as_array().unwrap();
    let greatest_of = |is_meant: &dyn Fn(&str) -> bool| {
        let wanted = packages.iter().filter(|p| !is_own(p)).filter_map(|p| {
            let name = p["name"].as_str().filter(|name| is_meant(name))?;
            Some((version(p["rust_version"].as_str()?), name))
        });
        wanted.max().unwrap_or(([0; 3], "nobody"))
    };
    let of_all = greatest_of(&|_| true);
    for package in packages.iter().filter(|p| is_own(p)) {
        let said = package["rust_version"].as_str().unwrap();
        let is_for_firmware = FOR_FIRMWARE.map(Value::from).contains(&package["name"]);
        let (greatest, name) = match is_for_firmware {
            true => greatest_of(&|name| {
                let needs = package["dependencies"].as_array().unwrap().iter();
                needs
                    .filter(|d| d["kind"].is_null())
                    .any(|d| d["name"] == name)
            }),
            false => of_all,
        };
        assert!(
            version(said) >= greatest,
            "{}: rust-version = {said}: {name} needs {greatest:?}; raise it in Cargo.toml",
            package["name"]
        );
    }
}

/// The driver with the Rust that it asks for, and for processors without an operating system: as far as they are installed, for neither
/// comes from where packages come from. Catches a function that is younger, and one that needs a system.
#[test]
#[ignore = "slow: the driver with an older Rust and for processors without a system"]
fn the_driver_builds_with_an_older_rust_and_for_small_processors() {
    let listed = |arguments: &[&str]| {
        let output = Command::new("rustup").args(arguments).output();
        output.map_or(String::new(), |o| {
            String::from_utf8_lossy(&o.stdout).into_owned()
        })
    };
    let metadata = members();
    let mut packages = metadata["packages"].as_array().unwrap().iter();
    let driver = packages.find(|p| p["name"] == FOR_FIRMWARE[0]).unwrap();
    let oldest = driver["rust_version"].as_str().unwrap();
    let toolchains = listed(&["toolchain", "list"]);
    let is_there = |name: &str| toolchains.lines().any(|line| line.starts_with(name));
    let targets = listed(&["target", "list", "--installed"]);
    let mut builds = vec![];
    if is_there(&format!("{oldest}-")) {
        builds.push((oldest, None));
    }
    let small = targets.lines().filter(|target| target.contains("-none"));
    builds.extend(small.map(|target| ("", Some(target))));
    let folder = tools::folder("driver-for-firmware");
    for (toolchain, target) in &builds {
        let mut command = match toolchain.is_empty() {
            true => Command::new(env!("CARGO")),
            false => {
                let mut command = Command::new("rustup");
                command.args(["run", toolchain, "cargo"]);
                command
            }
        };
        command
            .args([
                "check",
                "-p",
                FOR_FIRMWARE[0],
                "--offline",
                "--locked",
                "--target-dir",
            ])
            .arg(&folder)
            .args(target.map(|target| format!("--target={target}")))
            .current_dir(env!("CARGO_MANIFEST_DIR"));
        let output = command.output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{toolchain} {target:?}: {told}");
    }
    println!("built: {builds:?}");
}

/// Packages of a build and the features they have in it; see [`with_all_crates`].
fn features(arguments: &[&str]) -> Option<BTreeMap<String, String>> {
    let tree = ["tree", "--prefix", "none", "--format", "{p}|{f}"];
    let text = with_all_crates(&[&tree, arguments].concat(), "features of all builds")?;
    let lines = String::from_utf8(text).unwrap();
    let lines = lines.lines().filter_map(|line| line.split_once('|'));
    let cut =
        |(package, features): (&str, &str)| (package.to_owned(), features.replace(" (*)", ""));
    Some(lines.map(cut).collect())
}

/// Catches a dependency that the program, or the wheel, has with other features than the tests: it is then built twice, with all that
/// stands upon it.
#[test]
fn program_tests_and_wheel_are_built_once() {
    let Some(tests) = features(&["--edges", "normal,build,dev"]) else {
        return;
    };
    for build in [&[][..], &["--package", "endat-python"]] {
        let Some(others) = features(&[build, &["--edges", "normal,build"]].concat()) else {
            return;
        };
        assert!(others.len() > 100, "{build:?}: {}", others.len());
        for (package, has) in others {
            let as_tested = tests.get(&package).is_none_or(|tested| *tested == has);
            assert!(
                as_tested,
                "{package}: features = {has:?}, in the tests {:?}: give Cargo.toml the same",
                tests[&package]
            );
        }
    }
}

#[test]
fn every_crate_says_what_it_is_and_may_be_published() {
    let metadata = members();
    let packages = metadata["packages"].as_array().unwrap();
    let own: Vec<&Value> = packages.iter().filter(|p| is_own(p)).collect();
    let members = metadata["workspace_members"].as_array().unwrap();
    assert_eq!(own.len(), members.len());
    for package in own {
        let name = package["name"].as_str().unwrap();
        for key in ["description", "license", "readme", "rust_version"] {
            assert!(
                package[key].as_str().is_some_and(|t| !t.is_empty()),
                "{name}: no {key}"
            );
        }
        // The Python package goes to the registry of Python, the site to a server, the workshop nowhere.
        let stays = ["endat-python", "endat-site", "endat-workshop"].contains(&name);
        assert!(
            package["publish"].is_null() != stays,
            "{name}: publish = {}",
            package["publish"]
        );
        let folder = Path::new(package["manifest_path"].as_str().unwrap())
            .parent()
            .unwrap();
        let readme = fs::read_to_string(folder.join(package["readme"].as_str().unwrap())).unwrap();
        assert!(readme.starts_with(&format!("# {name}\n")), "{name}");
        // A registry takes no dependency without a version.
        let dependencies = package["dependencies"].as_array().unwrap();
        for dependency in dependencies.iter().filter(|d| d["kind"] != "dev") {
            assert_ne!(dependency["req"], "*", "{name}: {}", dependency["name"]);
        }
    }
}

/// The section of the changelog that this version has, released or to be, and the tag that it names.
#[test]
fn the_changelog_has_one_section_for_this_version() {
    let page = include_str!("../CHANGELOG.md");
    let sections: Vec<&str> = page.split("\n## [").skip(1).collect();
    let version = env!("CARGO_PKG_VERSION");
    let own = sections.iter().filter(|section| {
        section.starts_with(&format!("{version}]")) || section.starts_with("Unreleased]")
    });
    let own: Vec<_> = own.collect();
    assert_eq!(own.len(), 1, "sections of {version}");
    assert!(
        own[0].contains(&format!("tag `v{version}`")),
        "{version}: names no tag"
    );
    for heading in ["### Added", "### Changed"] {
        assert!(own[0].matches(heading).count() <= 1, "{heading} twice");
    }
}

/// The program alone in an empty folder gives what it gives here; nothing of it is read from the sources.
#[test]
fn the_program_runs_without_its_sources() {
    let dir = Dir::new("installed");
    let program = dir.0.join("endat-gen");
    fs::copy(env!("CARGO_BIN_EXE_endat-gen"), &program).unwrap();
    let output = Command::new(&program)
        .current_dir(&dir.0)
        .env_clear()
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let ours = Path::new(env!("CARGO_MANIFEST_DIR")).join("out/s6_two_channel");
    let mut count = 0;
    for entry in fs::read_dir(ours).unwrap() {
        let path = entry.unwrap().path();
        let emitted = dir
            .0
            .join("out/s6_two_channel")
            .join(path.file_name().unwrap());
        assert!(
            fs::read(&path).unwrap() == fs::read(emitted).unwrap(),
            "{}",
            path.display()
        );
        count += 1;
    }
    assert!(count > 20);
}

/// What is compiled into the libraries names no folder of the machine that built them. Sources of tests may.
#[test]
fn no_library_knows_its_own_folder() {
    let mut folders = ["design", "drivers", "gen", "hdl", "sim"]
        .map(|f| Path::new(env!("CARGO_MANIFEST_DIR")).join(f))
        .to_vec();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                let library = text.split("#[cfg(test)]\nmod ").next().unwrap();
                assert!(
                    !library.contains("CARGO_MANIFEST_DIR"),
                    "{}",
                    path.display()
                );
            }
        }
    }
}

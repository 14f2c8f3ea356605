//! The files for schedulers that exist, run with them: GNU parallel, and a Slurm of one node.

use crate::tools;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const PARTS: usize = 3;
const CAMPAIGN: [&str; 5] = ["upsets", "--subject", "port", "--cases", "500"];
const PROGRAM: &str = env!("CARGO_BIN_EXE_endat-gen");

fn script(name: &str) -> String {
    format!("{}/campaigns/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn program(folder: &Path, arguments: &[&str]) {
    let output = Command::new(PROGRAM)
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {text}");
}

/// What the parts come to, and what one run comes to.
fn assert_whole(folder: &Path) {
    let files: Vec<String> = (1..=PARTS)
        .map(|part| format!("parts/{part}.csv"))
        .collect();
    let mut merge = vec!["campaign", "merge"];
    merge.extend(files.iter().map(String::as_str));
    merge.extend(["--out", "merged.csv"]);
    program(folder, &merge);
    if !folder.join("one.csv").exists() {
        let one = [&["campaign"], &CAMPAIGN[..], &["--out", "one.csv"]].concat();
        program(folder, &one);
    }
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(read("merged.csv") == read("one.csv"));
}

#[test]
fn gnu_parallel_runs_the_parts_and_only_the_lost_one_again() {
    if !tools::require("parallel", "the campaign with GNU parallel") {
        return;
    }
    let folder = tools::folder("campaign_parallel");
    let parallel = || {
        let output = Command::new("bash")
            .arg(script("parallel.sh"))
            .args([&PARTS.to_string(), ":"])
            .args(CAMPAIGN)
            .env("ENDAT_GEN", PROGRAM)
            .current_dir(&folder)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{text}");
    };
    parallel();
    assert_whole(&folder);
    // A part that failed is run again, the others are not: what is spoilt here stays spoilt.
    let log = fs::read_to_string(folder.join("parts/log")).unwrap();
    let (heading, rows) = log.split_once('\n').unwrap();
    let mut rows: Vec<String> = rows.lines().map(str::to_owned).collect();
    rows.retain(|row| !row.contains("--shard 2/"));
    fs::write(
        folder.join("parts/log"),
        format!("{heading}\n{}\n", rows.join("\n")),
    )
    .unwrap();
    let good = fs::read(folder.join("parts/1.csv")).unwrap();
    fs::write(folder.join("parts/1.csv"), "spoilt").unwrap();
    fs::remove_file(folder.join("parts/2.csv")).unwrap();
    parallel();
    assert_eq!(fs::read(folder.join("parts/1.csv")).unwrap(), b"spoilt");
    fs::write(folder.join("parts/1.csv"), good).unwrap();
    assert_whole(&folder);
}

/// A Slurm of one node on this machine; it ends with the test.
struct Slurm {
    folder: PathBuf,
    daemons: Vec<Child>,
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in self.daemons.iter_mut().rev() {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn said(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output().unwrap();
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

impl Slurm {
    /// None if it does not come up.
    fn start(folder: &Path) -> Option<Self> {
        for name in ["state", "spool"] {
            fs::create_dir(folder.join(name)).unwrap();
        }
        let at = folder.display();
        let (host, user) = (said("hostname", &["-s"]), said("id", &["-un"]));
        // Ports that no test beside this one has.
        let port = 20_000 + std::process::id() % 20_000;
        let config = format!(
            "ClusterName=one\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser={user}\nSlurmdUser={user}\n\
             AuthType=auth/munge\nAuthInfo=socket={at}/munge.socket\nCryptoType=crypto/munge\n\
             MpiDefault=none\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\n\
             StateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\n\
             SlurmctldPidFile={at}/slurmctld.pid\nSlurmdPidFile={at}/slurmd.pid\n\
             SlurmctldPort={port}\nSlurmdPort={}\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=1 State=UNKNOWN\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n",
            port + 1
        );
        fs::write(folder.join("slurm.conf"), config).unwrap();
        let seed: String = (0..64).map(|i| char::from(b'a' + i % 26)).collect();
        let key = folder.join("munge.key");
        fs::write(&key, seed).unwrap();
        assert!(Command::new("chmod")
            .args(["400"])
            .arg(&key)
            .status()
            .unwrap()
            .success());
        let mut slurm = Self {
            folder: folder.to_owned(),
            daemons: vec![],
        };
        let file = |name: &str| format!("{at}/{name}");
        let munge = [
            format!("--key-file={}", file("munge.key")),
            format!("--socket={}", file("munge.socket")),
            format!("--pid-file={}", file("munged.pid")),
            format!("--seed-file={}", file("munge.seed")),
            format!("--log-file={}", file("munged.log")),
        ];
        let mut arguments = vec!["--foreground", "--force"];
        arguments.extend(munge.iter().map(String::as_str));
        slurm.daemon("munged", &arguments);
        let is_there = || folder.join("munge.socket").exists();
        if !until(Duration::from_secs(10), is_there) {
            return None;
        }
        slurm.daemon("slurmctld", &["-D", "-f", &file("slurm.conf")]);
        slurm.daemon("slurmd", &["-D", "-f", &file("slurm.conf")]);
        let is_idle = || {
            let state = slurm.command("sinfo").args(["-h", "-o", "%T"]).output();
            state.is_ok_and(|s| String::from_utf8_lossy(&s.stdout).trim() == "idle")
        };
        until(Duration::from_secs(30), is_idle).then_some(slurm)
    }

    fn daemon(&mut self, name: &str, arguments: &[&str]) {
        let log = fs::File::create(self.folder.join(format!("{name}.out"))).unwrap();
        let mut command = self.command(name);
        command.args(arguments).stdin(Stdio::null());
        command.stdout(log.try_clone().unwrap()).stderr(log);
        self.daemons.extend(command.spawn());
    }

    fn command(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command.env("SLURM_CONF", self.folder.join("slurm.conf"));
        command.current_dir(&self.folder);
        command
    }

    /// Tasks of the array job.
    fn array(&self, tasks: &str) {
        let output = self
            .command("sbatch")
            .args(["--wait", &format!("--array={tasks}"), &script("slurm.sh")])
            .arg(PARTS.to_string())
            .args(CAMPAIGN)
            .env("ENDAT_GEN", PROGRAM)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{text}");
    }
}

fn until(longest: Duration, is_so: impl Fn() -> bool) -> bool {
    let end = Instant::now() + longest;
    while Instant::now() < end {
        if is_so() {
            return true;
        }
        sleep(Duration::from_millis(200));
    }
    false
}

#[test]
fn a_slurm_array_job_runs_the_parts_and_a_lost_one_again() {
    let check = "the campaign with Slurm";
    if !["slurmctld", "slurmd", "sbatch", "munged"]
        .iter()
        .all(|tool| tools::require(tool, check))
    {
        return;
    }
    let folder = tools::folder("campaign_slurm");
    let Some(slurm) = Slurm::start(&folder) else {
        tools::cannot("a Slurm of one node cannot be started here", check);
        return;
    };
    fs::create_dir(folder.join("parts")).unwrap();
    slurm.array("1-3");
    assert_whole(&folder);
    fs::remove_file(folder.join("parts/2.csv")).unwrap();
    slurm.array("2");
    assert_whole(&folder);
}

/// The lines of the matrix, as a shell runs them: for two parts, as if there were no more.
#[test]
fn the_matrix_of_a_ci_has_every_part_and_puts_them_together() {
    runs_the_matrix(2);
}

#[test]
#[ignore = "slow: every part of the matrix of a CI"]
fn the_matrix_of_a_ci_runs_with_all_its_parts() {
    runs_the_matrix(8);
}

fn runs_the_matrix(count: usize) {
    let text = include_str!("../../campaigns/matrix.yml");
    let folder = tools::folder(&format!("campaign_matrix_{count}"));
    let lines: Vec<&str> = text
        .lines()
        .filter_map(|l| l.split_once("- run: "))
        .map(|l| l.1)
        .collect();
    assert_eq!(lines.len(), 2);
    let parts = text
        .split_once("part: [")
        .unwrap()
        .1
        .split_once(']')
        .unwrap()
        .0;
    let parts: Vec<&str> = parts.split(", ").collect();
    assert!(
        lines[0].contains(&format!("/{} ", parts.len())),
        "{}",
        lines[0]
    );
    let shell = |line: &str| {
        let line = line.replace("cargo run --release --", PROGRAM);
        let line = line.replace("upsets --shard", &format!("{} --shard", CAMPAIGN.join(" ")));
        let output = Command::new("bash")
            .args(["-c", &line])
            .current_dir(&folder)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{line}: {text}");
    };
    let part_of = lines[0].replace(&format!("/{} ", parts.len()), &format!("/{count} "));
    for part in &parts[..count] {
        shell(&part_of.replace("${{ matrix.part }}", part));
    }
    shell(lines[1]);
    assert!(folder.join("upsets.csv").exists());
}

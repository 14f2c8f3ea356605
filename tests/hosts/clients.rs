//! Programs that nobody here wrote, at a virtual card.

use super::ports::{slow_card, Served};
use crate::program::endat_path;
use crate::tools;
use endat_card::Door;
use std::process::Command;

/// `pandablocks hdf` records a card's stream, and the client library finds its blocks.
#[test]
fn pandablocks_finds_and_records_the_card() {
    let check = "PandABlocks at the virtual card";
    if !tools::require_python("pandablocks.hdf", check) || !tools::require_python("h5py", check) {
        return;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/panda_client.py");
    let endat = endat_path();
    let folder = tools::folder("panda");
    let has_ioc = tools::require_python("pandablocks_ioc", "EPICS driver at the virtual card");
    let more = has_ioc.then_some("ioc");
    let output = Command::new("python3")
        .args([
            script,
            endat.to_str().unwrap(),
            folder.to_str().unwrap(),
            super::quicker_service_port(),
        ])
        .args(more)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && told.contains("PANDA GOOD"),
        "{told}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// LiteX's own client reads the identification, and writes and reads back words.
#[cfg(unix)]
#[test]
fn litex_reads_and_writes_the_card_over_a_pseudo_terminal() {
    if !tools::require_python("litex.tools.remote.comm_uart", "LiteX at the virtual card") {
        return;
    }
    let project = slow_card();
    let csv = tools::folder("litex_csr").join("csr.csv");
    let maps = endat_emit::maps::artifacts(&project).unwrap();
    let map = maps.iter().find(|m| m.path.ends_with("_csr.csv")).unwrap();
    std::fs::write(&csv, &map.text).unwrap();
    let card = Served::new(project, || Door::terminal().unwrap());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/litex_client.py");
    let output = Command::new("python3")
        .args([script, &card.name, csv.to_str().unwrap()])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && told.contains("LITEX GOOD"),
        "{told}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

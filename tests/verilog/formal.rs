//! Formal equivalence: emitted blocks without registers against references written by hand, for all words.

use super::area::subject;
use crate::tools;
use endat_config::load_preset;
use endat_console::artifact::Artifact;
use endat_hdl::endat::transaction::cause;
use endat_tools::prove::Subject;
use std::fs;

/// The five equations as Liu et al. publish them for 29 position bits (2024): d[30] is F1, d[29] is F2, d[28] the LSB.
const PUBLISHED: &str = "
module reference(input [30:0] d, output [4:0] crc);
    assign crc[0] = d[30]^d[25]^d[24]^d[23]^d[21]^d[20]^d[17]^d[15]^d[10]^d[9]^d[8]^d[6]^d[5]^d[2]^d[0];
    assign crc[1] = d[30]^d[26]^d[23]^d[22]^d[20]^d[18]^d[17]^d[16]^d[15]^d[11]^d[8]^d[7]^d[5]^d[3]^d[2]^d[1]^d[0]^1'b1;
    assign crc[2] = d[27]^d[24]^d[23]^d[21]^d[19]^d[18]^d[17]^d[16]^d[12]^d[9]^d[8]^d[6]^d[4]^d[3]^d[2]^d[1];
    assign crc[3] = d[30]^d[28]^d[23]^d[22]^d[21]^d[19]^d[18]^d[15]^d[13]^d[8]^d[7]^d[6]^d[4]^d[3]^d[0]^1'b1;
    assign crc[4] = d[29]^d[24]^d[23]^d[22]^d[20]^d[19]^d[16]^d[14]^d[9]^d[8]^d[7]^d[5]^d[4]^d[1];
endmodule
";

/// Proves in yosys that `candidate`, made of these files, and the module `reference` have equal outputs; whether they have, and what yosys says.
fn equal(test: &str, files: &[Artifact], wrapper: &str, reference: &str) -> (bool, String) {
    let folder = tools::folder(&format!("formal-{test}"));
    let mut names = vec![];
    for file in files {
        fs::write(folder.join(&file.path), &file.text).unwrap();
        names.push(file.path.as_str());
    }
    fs::write(
        folder.join("reference.v"),
        format!("{wrapper}\n{reference}"),
    )
    .unwrap();
    // ABC's `collapse` makes decision diagrams, in which parities stay small; a solver alone takes hours over 50 bits.
    let script = format!(
        "read_verilog {} reference.v; proc; flatten; opt_clean; miter -equiv -flatten candidate reference both; hierarchy -top both; opt -full; techmap; opt; abc -script +strash;collapse;sop;strash;map; sat -verify -prove trigger 0 both",
        names.join(" ")
    );
    tools::run("yosys", &folder, &["-q", "-p", &script])
}

#[test]
fn published_equations_equal_the_block_for_31_bits() {
    if !tools::require("yosys", "published CRC equations") {
        return;
    }
    let files = subject("crc5_fixed_31").files();
    let wrapper = "module candidate(input [30:0] d, output [4:0] crc); crc5_fixed_31 block(.word(d), .crc(crc)); endmodule";
    let (proved, text) = equal("published", &files, wrapper, PUBLISHED);
    assert!(proved, "{text}");
    // A reference with one term dropped is told apart, so the proof says something.
    let wrong = PUBLISHED.replacen("^d[1];", ";", 1);
    assert_ne!(wrong, PUBLISHED);
    let (proved, text) = equal("published-wrong", &files, wrapper, &wrong);
    assert!(!proved && text.contains("proof did fail"), "{text}");
}

/// What may happen in a frame, by rank, the highest first: bit of the raw flags, and the cause that is told.
const RANKS: [(usize, u64); 19] = [
    (19, cause::UPSET),
    (10, cause::UNKNOWN_COMMAND),
    (13, cause::STUCK_HIGH),
    (12, cause::NO_ENCODER),
    (0, cause::DATA_NOT_LOW),
    (16, cause::WATCHDOG),
    (14, cause::STUCK_LOW),
    (15, cause::LATE_START),
    (1, cause::NO_START_BIT),
    (2, cause::START_WINDOW),
    (17, cause::OWN_ECHO),
    (6, cause::DATA_NOT_FALLING),
    (9, cause::DATA_NOT_FALLING),
    (11, cause::INFO_MISSING),
    (3, cause::CRC),
    (4, cause::F1),
    (5, cause::F2),
    (18, cause::RECOVERY_TOO_SHORT),
    (7, cause::TRIGGER_OVERRUN),
];

/// Whatever happened, all of it at once too, the cause is that of the highest rank. Catches two that have changed places, one that is
/// forgotten, and one that hides others.
#[test]
fn the_cause_is_the_highest_of_what_happened() {
    if !tools::require("yosys", "rank of causes") {
        return;
    }
    let project = load_preset("s6_two_channel_service").unwrap();
    let mut files = Subject::new(&project).unwrap().files;
    let block = format!("{}_primary_cause", project.name);
    files.retain(|file| file.path == format!("{block}.v"));
    let wrapper = format!("module candidate(input [19:0] flags, output [4:0] cause); {block} block(.flags(flags), .cause(cause)); endmodule");
    let reference = |ranks: &[(usize, u64)]| {
        let told = ranks
            .iter()
            .map(|(flag, cause)| format!("flags[{flag}] ? 5'd{cause} : "));
        let told: String = told.collect();
        format!("module reference(input [19:0] flags, output [4:0] cause); assign cause = {told}5'd0; endmodule")
    };
    let (proved, text) = equal("ranks", &files, &wrapper, &reference(&RANKS));
    assert!(proved, "{text}");
    let mut swapped = RANKS;
    swapped.swap(13, 14);
    for wrong in [&swapped[..], &RANKS[..18]] {
        let (proved, text) = equal("ranks-wrong", &files, &wrapper, &reference(wrong));
        assert!(!proved && text.contains("proof did fail"), "{text}");
    }
}

//! Formal equivalence: the emitted CRC blocks against references written by hand, for all words.

use crate::tools;
use endat_gen::area::subjects;
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

/// Proves in yosys that `block` and the module `reference` have equal outputs; whether they have, and what yosys says.
fn equal(test: &str, block: &str, wrapper: &str, reference: &str) -> (bool, String) {
    let folder = tools::folder(&format!("formal-{test}"));
    let subjects = subjects().unwrap();
    let subject = subjects.iter().find(|s| s.name == block).unwrap();
    let mut names = vec![];
    for file in subject.files() {
        fs::write(folder.join(&file.path), &file.text).unwrap();
        names.push(file.path);
    }
    fs::write(folder.join("reference.v"), format!("{wrapper}{reference}")).unwrap();
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
    let wrapper = "module candidate(input [30:0] d, output [4:0] crc); crc5_fixed_31 block(.word(d), .crc(crc)); endmodule";
    let (proved, text) = equal("published", "crc5_fixed_31", wrapper, PUBLISHED);
    assert!(proved, "{text}");
    // A reference with one term dropped is told apart, so the proof says something.
    let wrong = PUBLISHED.replacen("^d[1];", ";", 1);
    assert_ne!(wrong, PUBLISHED);
    let (proved, text) = equal("published-wrong", "crc5_fixed_31", wrapper, &wrong);
    assert!(!proved && text.contains("proof did fail"), "{text}");
}

//! The register map as constants: the C header, and the packages of SystemVerilog and VHDL.

use super::{projects, text_of, Word};
use crate::tools::{self, require};
use endat_config::Project;
use endat_hdl::regs::start;
use endat_regs::{Access, Values, BLOCKS, VERSION};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;

/// A constant that both have to have.
struct Wanted {
    /// Without the card's name.
    name: String,
    /// Of which channel, where it takes one.
    channel: Option<usize>,
    value: u32,
    /// It is what a word may contain, and no place or count.
    is_content: bool,
}

fn wanted(project: &Project) -> Vec<Wanted> {
    let mut all = vec![];
    let mut push = |name: String, channel, value, is_content| {
        all.push(Wanted {
            name,
            channel,
            value,
            is_content,
        });
    };
    for (part, number) in ["MAJOR", "MINOR", "PATCH"].iter().zip(VERSION) {
        push(format!("MAP_{part}"), None, number.into(), false);
    }
    let channels = project.card.channels.len();
    push("CHANNELS".into(), None, channels as u32, false);
    for word in Word::all(&project.card) {
        let name = word_name(&word);
        push(format!("{name}_WORD"), word.channel, word.address(), false);
        push(
            format!("{name}_BYTE"),
            word.channel,
            word.address() * 4,
            false,
        );
        let start_of = |n| start(word.block, word.register, &project.card, n);
        let start = start_of(word.channel.unwrap_or(0));
        let resets: Vec<u32> = (0..channels).map(start_of).collect();
        let is_one = word.channel.is_none() || resets.windows(2).all(|w| w[0] == w[1]);
        match word.channel {
            _ if word.block.name == "service" => {}
            Some(n) if !is_one => push(format!("{name}_RESET_{n}"), None, start, true),
            _ => push(format!("{name}_RESET"), None, start, true),
        }
        for field in word.register.fields {
            let name = format!("{name}_{}", field.name.to_uppercase());
            push(format!("{name}_MASK"), None, field.mask(), true);
            push(format!("{name}_SHIFT"), None, field.lsb, false);
            let (listed, is_bits) = match field.values {
                Values::Plain => continue,
                Values::Codes(listed) => (listed, false),
                Values::Bits(listed) => (listed, true),
            };
            for value in listed {
                let number = match is_bits {
                    true => 1 << value.number,
                    false => value.number,
                };
                let name = format!("{name}_{}", value.name.to_uppercase());
                push(name, None, number, is_bits);
            }
        }
    }
    all
}

fn word_name(word: &Word) -> String {
    let (block, register) = (word.block_name(), word.register.name);
    format!("{block}_{register}").to_uppercase()
}

/// A C program that prints every constant of the header, and what it has to print.
fn program(project: &Project) -> (String, String) {
    let prefix = project.name.to_uppercase();
    let mut code = format!(
        "#include <stdio.h>\n#include \"{}_registers.h\"\n\
         static void show(unsigned long value) {{ printf(\"%lX\\n\", value); }}\nint main(void) {{\n",
        project.name
    );
    let mut output = String::new();
    let mut show = |expression: String, value: u32| {
        writeln!(code, "    show({expression});").unwrap();
        writeln!(output, "{value:X}").unwrap();
    };
    for one in wanted(project) {
        let argument = one
            .channel
            .map_or(String::new(), |n| format!("(1 ? {n} : 9)"));
        show(format!("{prefix}_{}{argument}", one.name), one.value);
    }
    for word in Word::all(&project.card) {
        let block = format!("{prefix}_{}", word.block_name().to_uppercase());
        if let Some(n) = word.channel {
            let offset = u32::from(word.register.offset);
            let sum = |unit: &str, rest: u32| {
                format!("{block}_BASE_{unit} + {n} * {block}_STRIDE_{unit}S + {rest}")
            };
            show(sum("WORD", offset), word.address());
            show(sum("BYTE", 4 * offset), word.address() * 4);
        }
        for field in word.register.fields {
            let name = format!(
                "{prefix}_{}_{}",
                word_name(&word),
                field.name.to_uppercase()
            );
            let get = format!("{prefix}_GET({name}, 0xA5C30096u | 0xF000u)");
            show(get, (0xA5C3_F096 & field.mask()) >> field.lsb);
            let all = u32::MAX >> (32 - field.width);
            show(format!("{prefix}_PUT({name}, 0u | {all}u)"), field.mask());
        }
    }
    code.push_str("    return 0;\n}\n");
    (code, output)
}

/// Catches a line that is not what it should be, and one too many or too few.
fn compare(file: &str, found: &str, wanted: &str) {
    for (line, (found, wanted)) in found.lines().zip(wanted.lines()).enumerate() {
        assert_eq!(found, wanted, "{file}: line {line} of the program's output");
    }
    assert_eq!(found.lines().count(), wanted.lines().count(), "{file}");
}

/// Catches a macro without parentheses or suffix, byte addresses for words, a mask at bit 0, and C that C++ refuses.
#[test]
fn the_header_says_what_the_table_says_in_c_and_in_cpp() {
    for (compiler, standard, file) in [
        ("gcc", "-std=c99", "show.c"),
        ("g++", "-std=c++11", "show.cpp"),
    ] {
        if !require(compiler, "register header") {
            continue;
        }
        for project in projects() {
            let folder = tools::folder(&format!("maps-{compiler}-{}", project.name));
            let (code, output) = program(&project);
            let header = format!("{}_registers.h", project.name);
            fs::write(folder.join(&header), text_of(&project, "_registers.h")).unwrap();
            fs::write(folder.join(file), code).unwrap();
            let flags = [
                standard,
                "-Wall",
                "-Wextra",
                "-pedantic",
                "-Werror",
                "-o",
                "show",
                file,
            ];
            let (is_good, text) = tools::run(compiler, &folder, &flags);
            assert!(is_good && text.is_empty(), "{header}: {text}");
            let show = folder.join("show").display().to_string();
            let (is_good, text) = tools::run(&show, &folder, &[]);
            assert!(is_good);
            compare(&header, &text, &output);
        }
    }
}

/// Catches a constant that the package lacks or has otherwise, a function that forgets the channel, and text that one of two readers refuses.
#[test]
fn the_package_says_what_the_table_says() {
    if !require("iverilog", "register package") {
        return;
    }
    for project in projects() {
        let folder = tools::folder(&format!("maps-package-{}", project.name));
        let package = format!("{}_registers", project.name);
        let (mut code, mut output) = (
            String::from("module show;\n    initial begin\n"),
            String::new(),
        );
        for one in wanted(&project) {
            let argument = one.channel.map_or(String::new(), |n| format!("(32'd{n})"));
            let name = format!("{package}::{}{argument}", one.name);
            writeln!(code, "        $display(\"%0h\", {name});").unwrap();
            writeln!(output, "{:x}", one.value).unwrap();
        }
        code.push_str("    end\nendmodule\n");
        let file = format!("{package}.sv");
        fs::write(folder.join(&file), text_of(&project, "_registers.sv")).unwrap();
        fs::write(folder.join("show.sv"), code).unwrap();
        let flags = ["-g2012", "-Wall", "-o", "show.vvp", &file, "show.sv"];
        let (is_good, text) = tools::run("iverilog", &folder, &flags);
        assert!(is_good, "{file}: {text}");
        let (is_good, text) = tools::run("vvp", &folder, &["-n", "show.vvp"]);
        assert!(is_good, "{text}");
        compare(&file, &text, &output);
        if require("verilator", "register package") {
            let flags = [
                "--lint-only",
                "-Wall",
                "--top-module",
                "show",
                &file,
                "show.sv",
            ];
            let (is_good, text) = tools::run("verilator", &folder, &flags);
            assert!(is_good && text.is_empty(), "{file}: {text}");
        }
    }
}

/// Catches a constant that the package lacks, or has otherwise or of another type, and a function that forgets the channel.
#[test]
fn the_package_of_vhdl_says_what_the_table_says() {
    if !require("ghdl", "register package") {
        return;
    }
    for (project, standard) in projects()
        .iter()
        .zip(["--std=93", "--std=08"].iter().cycle())
    {
        let folder = tools::folder(&format!("maps-vhdl-{}", project.name));
        let package = format!("{}_registers", project.name);
        let mut code = format!(
            "library ieee;\nuse ieee.std_logic_1164.all;\nuse work.{package}.all;\nentity show is\nend entity;\n\
             architecture bench of show is\nbegin\n    process\n    begin\n"
        );
        for one in wanted(project) {
            let (name, value) = (&one.name, one.value);
            let argument = one.channel.map_or(String::new(), |n| format!("({n})"));
            let value = match one.is_content {
                true => format!("word_t'(x\"{value:08X}\")"),
                false => value.to_string(),
            };
            writeln!(code, "        assert {name}{argument} = {value} report \"{name}{argument}\" severity error;").unwrap();
        }
        code.push_str(
            "        report \"all\";\n        wait;\n    end process;\nend architecture;\n",
        );
        let file = format!("{package}.vhd");
        fs::write(folder.join(&file), text_of(project, "_registers.vhd")).unwrap();
        fs::write(folder.join("show.vhd"), code).unwrap();
        let (is_good, text) = tools::run("ghdl", &folder, &["-a", standard, &file, "show.vhd"]);
        assert!(is_good && text.is_empty(), "{file}: {text}");
        let (is_good, text) = tools::run("ghdl", &folder, &["-e", standard, "show"]);
        assert!(is_good, "{text}");
        let (is_good, text) = tools::run("ghdl", &folder, &["-r", standard, "show"]);
        assert!(
            is_good && !text.contains("error") && text.contains("all"),
            "{text}"
        );
    }
}

/// Catches a macro of the page's example that the header does not have.
#[test]
fn the_example_in_the_host_link_page_compiles() {
    let page = include_str!("../../docs/host-link.md");
    let example = page.split_once("```c\n").unwrap().1;
    let (include, body) = example
        .split_once("```")
        .unwrap()
        .0
        .split_once("\n\n")
        .unwrap();
    let code = format!(
        "#include <stdint.h>\n{include}\nuint32_t card_read(uint32_t word);\nvoid example(void);\n\
         void example(void) {{\n{body}}}\n"
    );
    if require("gcc", "example of the host link page") {
        let folder = tools::folder("maps-example");
        let header = text_of(&projects()[0], "_registers.h");
        fs::write(folder.join("s6_two_channel_registers.h"), header).unwrap();
        fs::write(folder.join("example.c"), code).unwrap();
        let flags = [
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-pedantic",
            "-Werror",
            "-c",
            "example.c",
        ];
        let (is_good, text) = tools::run("gcc", &folder, &flags);
        assert!(is_good, "{text}");
    }
}

/// Catches two registers or values that come to one macro, and an access in words that is another register's.
#[test]
fn macros_of_the_header_are_single_and_their_access_is_told() {
    for project in projects() {
        let text = text_of(&project, "_registers.h");
        let mut names = BTreeSet::new();
        for line in text.lines().filter_map(|l| l.strip_prefix("#define ")) {
            let name = line.split([' ', '(']).next().unwrap();
            assert!(names.insert(name), "{name} twice");
        }
        let prefix = project.name.to_uppercase();
        for word in Word::all(&project.card) {
            let access = word.register.access;
            let told = format!(
                "/* {}: {} */\n#define {prefix}_{}_{}_WORD",
                access.short(),
                word.register.meaning,
                word.block_name().to_uppercase(),
                word.register.name.to_uppercase()
            );
            assert!(text.contains(&told), "{told}");
        }
        assert!(BLOCKS[0]
            .registers
            .iter()
            .any(|r| r.access == Access::Strobe));
    }
}

//! The register map as constants: the C header, and the SystemVerilog package.

use super::{projects, text_of, Word};
use crate::tools::{self, require};
use endat_gen::config::Project;
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
}

fn wanted(project: &Project) -> Vec<Wanted> {
    let mut all = vec![];
    let mut want = |name: String, channel, value| {
        all.push(Wanted {
            name,
            channel,
            value,
        });
    };
    for (part, number) in ["MAJOR", "MINOR", "PATCH"].iter().zip(VERSION) {
        want(format!("MAP_{part}"), None, number.into());
    }
    let channels = project.card.channels.len();
    want("CHANNELS".into(), None, channels as u32);
    for word in Word::all(&project.card) {
        let name = word_name(&word);
        want(format!("{name}_WORD"), word.channel, word.address());
        want(format!("{name}_BYTE"), word.channel, word.address() * 4);
        let start_of = |n| start(word.block, word.register, &project.card, n);
        let start = start_of(word.channel.unwrap_or(0));
        let resets: Vec<u32> = (0..channels).map(start_of).collect();
        let is_one = word.channel.is_none() || resets.windows(2).all(|w| w[0] == w[1]);
        match word.channel {
            _ if word.block.name == "service" => {}
            Some(n) if !is_one => want(format!("{name}_RESET_{n}"), None, start),
            _ => want(format!("{name}_RESET"), None, start),
        }
        for field in word.register.fields {
            let name = format!("{name}_{}", field.name.to_uppercase());
            want(format!("{name}_MASK"), None, field.mask());
            want(format!("{name}_SHIFT"), None, field.lsb);
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
                want(
                    format!("{name}_{}", value.name.to_uppercase()),
                    None,
                    number,
                );
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

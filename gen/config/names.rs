//! Names that a generated file may carry: identifiers that no tool of the flow takes for something else.

use rtl_design::{verilog, vhdl};

/// Longest name; file systems and XST both stand more.
pub const NAME_MAX: usize = 40;

/// What a name is like, reserved words aside, as a regular expression.
pub const NAME_PATTERN: &str = "^[A-Za-z](_?[A-Za-z0-9])*$";

/// Words of Verilog-2005 and C that a module, file or macro must not be called; all in lower case. The printers know those of
/// SystemVerilog and VHDL.
const RESERVED: &[&str] = &[
    // Verilog-2005
    "always and assign automatic begin buf bufif0 bufif1 case casex casez cell cmos config deassign default \
     defparam design disable edge else end endcase endconfig endfunction endgenerate endmodule endprimitive \
     endspecify endtable endtask event for force forever fork function generate genvar highz0 highz1 if ifnone \
     incdir include initial inout input instance integer join large liblist library localparam macromodule medium \
     module nand negedge nmos nor noshowcancelled not notif0 notif1 or output parameter pmos posedge primitive \
     pull0 pull1 pulldown pullup pulsestyle_ondetect pulsestyle_onevent rcmos real realtime reg release repeat \
     rnmos rpmos rtran rtranif0 rtranif1 scalared showcancelled signed small specify specparam strong0 strong1 \
     supply0 supply1 table task time tran tranif0 tranif1 tri tri0 tri1 triand trior trireg unsigned use uwire \
     vectored wait wand weak0 weak1 while wire wor xnor xor",
    // C
    "auto break char const continue double enum extern float goto inline int long restrict return short sizeof static struct \
     switch typedef union void volatile main",
    // file names that Windows keeps for devices
    "con prn aux nul com1 com2 com3 com4 lpt1 lpt2 lpt3",
];

fn reserved() -> impl Iterator<Item = &'static str> {
    RESERVED
        .iter()
        .flat_map(|words| words.split_ascii_whitespace())
}

/// Why `name` cannot name a module and its files, with the remedy.
pub fn check_name(name: &str) -> Result<(), String> {
    let rule = "use letters, digits and underscores, a letter first";
    if name.is_empty() {
        return Err(format!("is empty; {rule}"));
    }
    if name.contains(['/', '\\']) || name.contains("..") {
        return Err(format!("is a path, and a name becomes a folder below the output folder; {rule}, and give the folder with --out"));
    }
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Err(format!("does not begin with a letter; {rule}"));
    }
    if let Some(bad) = name
        .chars()
        .find(|c| !c.is_ascii_alphanumeric() && *c != '_')
    {
        return Err(format!("has the character {bad:?}; {rule}"));
    }
    if name.len() > NAME_MAX {
        return Err(format!(
            "has {} characters, at most {NAME_MAX} are allowed; shorten it",
            name.len()
        ));
    }
    if name.contains("__") || name.ends_with('_') {
        return Err(
            "has a double or a trailing underscore, which VHDL does not allow; remove it".into(),
        );
    }
    // The printer would rename such a module, and the files around it would name another one.
    let lower = name.to_lowercase();
    let is_renamed = [verilog::emitted_name(&lower), vhdl::emitted_name(&lower)]
        .iter()
        .any(|emitted| *emitted != lower);
    if is_renamed || reserved().any(|word| word.eq_ignore_ascii_case(name)) {
        return Err("is a reserved word of Verilog, VHDL, C or the file system; add a suffix, for example `_card`".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_are_refused_in_any_case_and_ordinary_names_pass() {
        for good in [
            "s6_two_channel",
            "card",
            "x1",
            "my_endat_card",
            "endat_card",
        ] {
            assert_eq!(check_name(good), Ok(()), "{good}");
        }
        for bad in [
            "module",
            "Entity",
            "SIZEOF",
            "nul",
            "",
            "assert",
            "let",
            "sequence",
            "Sequence",
            "ieee",
            "true",
            "False",
            "slice",
            "std_logic",
            "1a",
            "a b",
            "../x",
            "a/b",
            "a__b",
            "a_",
            "ä",
            "a\0",
            &"a".repeat(41),
        ] {
            assert!(check_name(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_list_is_lower_case_without_doubles() {
        let mut seen = std::collections::BTreeSet::new();
        for word in reserved() {
            assert_eq!(word, word.to_ascii_lowercase());
            assert!(seen.insert(word), "{word} twice");
        }
    }
}

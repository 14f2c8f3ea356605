//! Words of SystemVerilog: the emitted Verilog-2005 avoids them as names, since many tools read every file as SystemVerilog.

use super::properties::words;

/// Words of SystemVerilog (IEEE 1800-2017) that are none of Verilog-2005.
const LATER_KEYWORDS: &[&str] = &[
    "accept_on",
    "alias",
    "always_comb",
    "always_ff",
    "always_latch",
    "assert",
    "assume",
    "before",
    "bind",
    "bins",
    "binsof",
    "bit",
    "break",
    "byte",
    "chandle",
    "checker",
    "class",
    "clocking",
    "const",
    "constraint",
    "context",
    "continue",
    "cover",
    "covergroup",
    "coverpoint",
    "cross",
    "dist",
    "do",
    "endchecker",
    "endclass",
    "endclocking",
    "endgroup",
    "endinterface",
    "endpackage",
    "endprogram",
    "endproperty",
    "endsequence",
    "enum",
    "eventually",
    "expect",
    "export",
    "extends",
    "extern",
    "final",
    "first_match",
    "foreach",
    "forkjoin",
    "global",
    "iff",
    "ignore_bins",
    "illegal_bins",
    "implements",
    "implies",
    "import",
    "inside",
    "int",
    "interconnect",
    "interface",
    "intersect",
    "join_any",
    "join_none",
    "let",
    "local",
    "logic",
    "longint",
    "mailbox",
    "matches",
    "modport",
    "nettype",
    "new",
    "nexttime",
    "null",
    "package",
    "packed",
    "priority",
    "program",
    "property",
    "protected",
    "pure",
    "rand",
    "randc",
    "randcase",
    "randsequence",
    "ref",
    "reject_on",
    "restrict",
    "return",
    "s_always",
    "s_eventually",
    "s_nexttime",
    "s_until",
    "s_until_with",
    "sequence",
    "shortint",
    "shortreal",
    "soft",
    "solve",
    "static",
    "string",
    "strong",
    "struct",
    "super",
    "sync_accept_on",
    "sync_reject_on",
    "tagged",
    "this",
    "throughout",
    "timeprecision",
    "timeunit",
    "type",
    "typedef",
    "union",
    "unique",
    "unique0",
    "until",
    "until_with",
    "untyped",
    "var",
    "virtual",
    "void",
    "wait_order",
    "weak",
    "wildcard",
    "with",
    "within",
];

/// Words of SystemVerilog that properties are made of.
const PROPERTY_KEYWORDS: &[&str] = &["assert", "assume", "cover"];

/// The name that a net, port or memory has in the emitted Verilog: keywords of SystemVerilog get `_value` appended.
pub fn emitted_name(name: &str) -> String {
    match LATER_KEYWORDS.contains(&name) {
        true => format!("{name}_value"),
        false => name.into(),
    }
}

/// A name in the text of properties that is a keyword of SystemVerilog.
pub(super) fn keyword_in_properties(text: &str) -> Option<&str> {
    let code = text.lines().map(|l| l.split("//").next().unwrap_or(l));
    let is_name = |word: &&str| LATER_KEYWORDS.contains(word) && !PROPERTY_KEYWORDS.contains(word);
    code.flat_map(words).find(is_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn emitted_names_avoid_words_of_systemverilog() {
        assert_eq!(emitted_name("sequence"), "sequence_value");
        assert_eq!(emitted_name("sequence_value"), "sequence_value");
        assert_eq!(emitted_name("Sequence"), "Sequence");
    }

    #[test]
    fn properties_name_nothing_by_a_word_of_systemverilog() {
        let good =
            "// before: The byte before.\nalways @* begin\n    before_it: assert (1);\nend\n";
        assert_eq!(keyword_in_properties(good), None);
        let bad = "function f(input [3:0] before);\n    f = ~before; // not it\nendfunction\n";
        assert_eq!(keyword_in_properties(bad), Some("before"));
    }
}

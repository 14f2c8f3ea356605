//! Names: from fields to Verilog.

/// Words that no net may be called.
const KEYWORDS: &[&str] = &[
    "always",
    "and",
    "assign",
    "automatic",
    "begin",
    "buf",
    "bufif0",
    "bufif1",
    "case",
    "casex",
    "casez",
    "cell",
    "cmos",
    "config",
    "deassign",
    "default",
    "defparam",
    "design",
    "disable",
    "edge",
    "else",
    "end",
    "endcase",
    "endconfig",
    "endfunction",
    "endgenerate",
    "endmodule",
    "endprimitive",
    "endspecify",
    "endtable",
    "endtask",
    "event",
    "for",
    "force",
    "forever",
    "fork",
    "function",
    "generate",
    "genvar",
    "highz0",
    "highz1",
    "if",
    "ifnone",
    "incdir",
    "include",
    "initial",
    "inout",
    "input",
    "instance",
    "integer",
    "join",
    "large",
    "liblist",
    "library",
    "localparam",
    "macromodule",
    "medium",
    "module",
    "nand",
    "negedge",
    "nmos",
    "nor",
    "noshowcancelled",
    "not",
    "notif0",
    "notif1",
    "or",
    "output",
    "parameter",
    "pmos",
    "posedge",
    "primitive",
    "pull0",
    "pull1",
    "pulldown",
    "pullup",
    "rcmos",
    "real",
    "realtime",
    "reg",
    "release",
    "repeat",
    "rnmos",
    "rpmos",
    "rtran",
    "rtranif0",
    "rtranif1",
    "scalared",
    "showcancelled",
    "signed",
    "small",
    "specify",
    "specparam",
    "strong0",
    "strong1",
    "supply0",
    "supply1",
    "table",
    "task",
    "time",
    "tran",
    "tranif0",
    "tranif1",
    "tri",
    "tri0",
    "tri1",
    "triand",
    "trior",
    "trireg",
    "unsigned",
    "use",
    "vectored",
    "wait",
    "wand",
    "weak0",
    "weak1",
    "while",
    "wire",
    "wor",
    "xnor",
    "xor",
];

/// Words of C++ and its libraries: Verilator, which makes C++ of a design, warns of nets that are called so.
const CPP_WORDS: &[&str] = &[
    "NULL",
    "abort",
    "alignas",
    "alignof",
    "and_eq",
    "asm",
    "auto",
    "bit_vector",
    "bitand",
    "bitor",
    "bool",
    "catch",
    "cdecl",
    "char",
    "class",
    "compl",
    "complex",
    "concept",
    "const",
    "const_cast",
    "const_iterator",
    "constexpr",
    "continue",
    "decltype",
    "delete",
    "deque",
    "double",
    "dynamic_cast",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "far",
    "float",
    "friend",
    "goto",
    "huge",
    "import",
    "inline",
    "int",
    "interrupt",
    "iterator",
    "list",
    "long",
    "map",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "not_eq",
    "nullptr",
    "operator",
    "or_eq",
    "override",
    "pascal",
    "private",
    "protected",
    "public",
    "queue",
    "reference",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "sc_clock",
    "sc_in",
    "sc_inout",
    "sc_out",
    "sc_signal",
    "sensitive",
    "set",
    "short",
    "sizeof",
    "stack",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "synchronized",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "type_info",
    "typedef",
    "typeid",
    "typename",
    "union",
    "using",
    "vector",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "xor_eq",
];

/// Why a net cannot have a name, if it cannot.
pub(super) fn problem_of_net(name: &str) -> Option<&'static str> {
    let is_cpp = CPP_WORDS.contains(&name);
    problem(name).or(is_cpp.then_some("is a word of C++"))
}

/// Why a name cannot be used in Verilog, if it cannot.
pub(super) fn problem(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    if KEYWORDS.contains(&name) || KEYWORDS.contains(&lower.as_str()) {
        return Some("is a Verilog keyword");
    }
    let is_plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_plain || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Some("is no plain Verilog name");
    }
    None
}

/// The Verilog name of a field path: `data_o$1` is `data1_o`, `bus$data$0` is `bus_data_0`.
pub(super) fn verilog_name(key: &str) -> String {
    let mut name = String::new();
    for part in key.split('$') {
        let is_index = part.chars().all(|c| c.is_ascii_digit());
        let suffix = ["_oe", "_o", "_i"]
            .into_iter()
            .find(|suffix| name.ends_with(suffix));
        match (is_index, suffix) {
            (true, Some(suffix)) => {
                name.truncate(name.len() - suffix.len());
                name.push_str(part);
                name.push_str(suffix);
            }
            _ if name.is_empty() => name.push_str(part),
            _ => {
                name.push('_');
                name.push_str(part);
            }
        }
    }
    name
}

/// The first of some names that is not taken; the last one gets a number if all are.
pub(crate) fn free_name<'a>(
    names: impl IntoIterator<Item = String>,
    taken: impl Iterator<Item = &'a String> + Clone,
) -> String {
    // Verilog is case-sensitive, VHDL is not.
    let is_free = |name: &str| !taken.clone().any(|taken| taken.eq_ignore_ascii_case(name));
    let mut last = String::new();
    for name in names {
        if is_free(&name) {
            return name;
        }
        last = name;
    }
    let mut numbered = (2..).map(|number: usize| format!("{last}_{number}"));
    numbered.find(|name| is_free(name)).unwrap_or_default()
}

/// `ClockGen` becomes `clock_gen`.
pub(super) fn snake_case(name: &str) -> String {
    let mut out = String::new();
    let mut previous_is_lower = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() && previous_is_lower {
            out.push('_');
        }
        previous_is_lower = c.is_ascii_lowercase() || c.is_ascii_digit();
        out.push(c.to_ascii_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_stand_before_the_direction_suffix() {
        assert_eq!(verilog_name("bus_data_oe$1"), "bus_data1_oe");
        assert_eq!(verilog_name("bus_clk_o$0"), "bus_clk0_o");
        assert_eq!(verilog_name("channel$1"), "channel_1");
        assert_eq!(verilog_name("bus$data$0"), "bus_data_0");
    }

    #[test]
    fn type_names_become_snake_case() {
        assert_eq!(snake_case("ClockGen"), "clock_gen");
        assert_eq!(snake_case("Crc5"), "crc5");
        assert_eq!(snake_case("Crc5Serial"), "crc5_serial");
        assert_eq!(snake_case("top"), "top");
    }

    #[test]
    fn keywords_are_refused_in_any_case() {
        assert!(problem("Release").is_some());
        assert!(problem("a$b").is_some());
        assert!(problem("_x").is_some());
        assert!(problem_of_net("abort").is_some() && problem("abort").is_none());
        assert!(problem("fall").is_none());
    }
}

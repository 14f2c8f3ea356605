//! Documentation of blocks, their parts and the states of their enums.
//!
//! rust-hdl's tree has neither documentation nor the names of types. The only text that a block can carry is the list of its
//! timings, in which [`kernel`](crate::kernel) passes on the notes of [`Block`](macro@crate::Block) and
//! [`States`](crate::States).

use rust_hdl::prelude::TimingInfo;

/// Documentation of a block or an enum.
#[derive(Clone, Copy, Debug)]
pub struct TypeDocs {
    /// Its name, without module and parameters.
    pub name: &'static str,
    /// About it, line by line.
    pub lines: &'static [&'static str],
    /// Fields or variants, and about them.
    pub parts: &'static [(&'static str, &'static [&'static str])],
    /// Fields that are lists of at most one signal, whose name has no number.
    pub optional: &'static [&'static str],
    /// Fields that are bundles of ports, the suffix of the ports' names, and their documentation.
    pub bundles: &'static [(&'static str, &'static str, &'static TypeDocs)],
    /// Properties to prove: SystemVerilog, see [`properties`](super::properties). Empty without properties.
    pub properties: &'static str,
    /// Enums among the types of its fields.
    pub enums: &'static [&'static TypeDocs],
}

impl TypeDocs {
    /// One with a name, and nothing else.
    pub const fn named(name: &'static str) -> Self {
        Self {
            name,
            lines: &[],
            parts: &[],
            optional: &[],
            bundles: &[],
            properties: "",
            enums: &[],
        }
    }
}

/// A type with documentation that elaboration hands on.
pub trait Described {
    /// It.
    const DOCS: TypeDocs;
}

/// [`TimingInfo`] name of documentation.
const DOCS_TIMING: &str = "rtl_design_docs";

/// [`TimingInfo`] name of optional fields.
const OPTIONAL_TIMING: &str = "rtl_design_optional";

/// [`TimingInfo`] name of bundles.
const BUNDLE_TIMING: &str = "rtl_design_bundle";

/// [`TimingInfo`] name of properties.
const PROPERTIES_TIMING: &str = "rtl_design_properties";

/// Documentation of a block and its enums as its timings.
pub fn timing(docs: &TypeDocs) -> Vec<TimingInfo> {
    let of_one = |docs: &TypeDocs| TimingInfo {
        name: DOCS_TIMING.into(),
        clock: docs.name.into(),
        inputs: docs.lines.iter().map(|line| plain(line)).collect(),
        outputs: (docs.parts.iter())
            .map(|(name, lines)| part((*name).into(), lines))
            .chain(docs.bundles.iter().flat_map(|(bundle, _, of)| {
                let ports = of.parts.iter();
                ports.map(move |(port, lines)| part(format!("{bundle}${port}"), lines))
            }))
            .collect(),
    };
    let enums = docs.enums.iter().map(|docs| of_one(docs));
    let properties = TimingInfo {
        name: PROPERTIES_TIMING.into(),
        clock: docs.properties.into(),
        inputs: vec![],
        outputs: vec![],
    };
    let optional = TimingInfo {
        name: OPTIONAL_TIMING.into(),
        clock: String::new(),
        inputs: docs.optional.iter().map(|&name| name.into()).collect(),
        outputs: vec![],
    };
    let bundles = docs.bundles.iter().map(|(field, suffix, _)| TimingInfo {
        name: BUNDLE_TIMING.into(),
        clock: (*field).into(),
        inputs: vec![(*suffix).into()],
        outputs: vec![],
    });
    let own = [of_one(docs), optional, properties];
    own.into_iter().chain(bundles).chain(enums).collect()
}

/// A part and its lines, in one text.
fn part(name: String, lines: &[&str]) -> String {
    let lines = lines.iter().map(|line| plain(line));
    let text: Vec<String> = [name].into_iter().chain(lines).collect();
    text.join("\n")
}

/// Optional fields among the timings of a block.
pub(super) fn optional_of(timings: &[TimingInfo]) -> Vec<String> {
    let found = timings.iter().find(|t| t.name == OPTIONAL_TIMING);
    found.map_or(vec![], |t| t.inputs.clone())
}

/// Bundles among the timings of a block: the field, and the suffix of its ports' names.
pub(super) fn bundles_of(timings: &[TimingInfo]) -> Vec<(String, String)> {
    let found = timings.iter().filter(|t| t.name == BUNDLE_TIMING);
    found
        .map(|t| (t.clock.clone(), t.inputs.concat()))
        .collect()
}

/// Properties among the timings of a block.
pub(super) fn properties_of(timings: &[TimingInfo]) -> String {
    let found = timings.iter().find(|t| t.name == PROPERTIES_TIMING);
    found.map_or(String::new(), |t| t.clock.clone())
}

/// The same in the block tree.
#[derive(Clone, Debug)]
pub(super) struct Docs {
    pub name: String,
    pub lines: Vec<String>,
    /// Fields or variants, and about them.
    pub parts: Vec<(String, Vec<String>)>,
}

/// Documentation among the timings of a block: of the block first, then of its enums.
pub(super) fn of(timings: &[TimingInfo]) -> Vec<Docs> {
    let part = |text: &String| {
        let mut lines = text.split('\n').map(String::from);
        (lines.next().unwrap_or_default(), lines.collect())
    };
    let docs = timings.iter().filter(|t| t.name == DOCS_TIMING);
    docs.map(|t| Docs {
        name: t.clock.clone(),
        lines: t.inputs.clone(),
        parts: t.outputs.iter().map(part).collect(),
    })
    .collect()
}

/// A line of documentation without Rust's link brackets: `[`Reg`]` and `[text](target)` become their text.
fn plain(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line.trim_end().strip_prefix(' ').unwrap_or(line.trim_end());
    while let Some((before, after)) = rest.split_once("[`") {
        let Some((name, after)) = after.split_once("`]") else {
            break;
        };
        out.push_str(before);
        out.push_str(name.rsplit("::").next().unwrap_or(name));
        rest = match after
            .strip_prefix('(')
            .and_then(|link| link.split_once(')'))
        {
            Some((_, after)) => after,
            None => after,
        };
    }
    out.push_str(rest);
    out.replace('`', "")
}

/// A comment of a kernel, as rust-hdl hands it on: some or all of the tokens of `comment!("...")`.
pub(super) fn comment(tokens: &str) -> String {
    let text = ["comment!", "comment !"]
        .iter()
        .find_map(|name| tokens.strip_prefix(name)?.trim_start().strip_prefix("(\""))
        .unwrap_or(tokens);
    let text = text.strip_suffix("\")").unwrap_or(text);
    let mut out = String::new();
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '\\' => out.extend(letters.next()),
            _ => out.push(letter),
        }
    }
    plain(&out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_in_documentation_become_plain_text() {
        assert_eq!(
            plain(" Like [`crate::reg::Reg`], see [`x`](y)."),
            "Like Reg, see x."
        );
        assert_eq!(plain("  `a` [b]"), " a [b]");
    }

    #[test]
    fn what_is_written_arrives_in_the_tree() {
        const STATES: TypeDocs = TypeDocs {
            parts: &[("Idle", &[" Nothing."])],
            ..TypeDocs::named("State")
        };
        const FRAME: TypeDocs = TypeDocs {
            parts: &[("strobe", &[" It is new."])],
            ..TypeDocs::named("FrameOut")
        };
        let block = TypeDocs {
            name: "Timer",
            lines: &[" A timer.", " Of 8 bits."],
            parts: &[("clock", &[" System clock."]), ("level", &[])],
            optional: &["level"],
            bundles: &[("frame", "_now", &FRAME)],
            properties: "// p: words",
            enums: &[&STATES],
        };
        assert_eq!(properties_of(&timing(&block)), "// p: words");
        assert_eq!(optional_of(&timing(&block)), ["level"]);
        let bundle = ("frame".to_owned(), "_now".to_owned());
        assert_eq!(bundles_of(&timing(&block)), [bundle]);
        let [timer, state] = &of(&timing(&block))[..] else {
            panic!("two of them")
        };
        assert_eq!(timer.name, "Timer");
        assert_eq!(timer.lines, ["A timer.", "Of 8 bits."]);
        let clock = ("clock".to_owned(), vec!["System clock.".to_owned()]);
        let strobe = ("frame$strobe".to_owned(), vec!["It is new.".to_owned()]);
        assert_eq!(timer.parts, [clock, ("level".to_owned(), vec![]), strobe]);
        assert_eq!(state.parts[0].1, ["Nothing."]);
    }

    /// Catches tokens in a comment, whichever way the compiler sets them; rust-hdl takes the end of all of them away.
    #[test]
    fn a_comment_is_what_its_author_wrote() {
        for tokens in [
            r#"comment!(" The \"last\" bit of [`word`].")"#,
            r#"comment!(" The \"last\" bit of [`word`]."#,
            "comment! (\" The \\\"last\\\" bit of `word`.",
            "comment!\n(\" The \\\"last\\\" bit of `word`.",
            r#"comment ! (" The \"last\" bit of [`x::word`]."#,
            r#" The \"last\" bit of `word`."#,
        ] {
            assert_eq!(comment(tokens), "The \"last\" bit of word.", "{tokens}");
        }
    }
}

//! A page for each block, as the block describes itself.

use crate::outline::BLOCKS;
use crate::Page;
use endat_console::error::CommandError;
use endat_workshop::mutants::{subjects, Emission};
use rtl_design::elaborate::properties::properties;
use rtl_design::elaborate::{Design, Direction, Module};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A block as it is in the first card that has it.
struct Block<'a> {
    card: &'a str,
    design: &'a Design,
    module: &'a Module,
    /// Types of the blocks that it is in.
    users: BTreeSet<&'a str>,
}

impl Block<'_> {
    /// What its module is called, behind the name of the card.
    fn emitted(&self) -> &str {
        let top = &self.design.top().name;
        self.module.name.strip_prefix(top).unwrap_or_default()
    }
}

/// The page of all blocks, and that of each.
pub fn pages() -> Result<Vec<Page>, CommandError> {
    let cards: Vec<(String, Design)> = subjects()
        .map(|card| Ok((card.to_owned(), Emission::named(card)?.subject.design)))
        .collect::<Result<_, CommandError>>()?;
    let blocks = all(&cards);
    let mut pages = vec![Page::new(BLOCKS, list(&blocks))];
    let each = blocks.values().map(|block| {
        let name = &block.module.type_name;
        Page::new(&format!("{BLOCKS}/{name}"), page(block, &blocks))
    });
    pages.extend(each);
    Ok(pages)
}

/// Every block, by its type.
fn all(cards: &[(String, Design)]) -> BTreeMap<&str, Block<'_>> {
    let mut blocks = BTreeMap::new();
    for (card, design) in cards {
        for module in &design.modules {
            blocks.entry(&*module.type_name).or_insert_with(|| Block {
                card,
                design,
                module,
                users: BTreeSet::new(),
            });
        }
    }
    for (_, design) in cards {
        for user in &design.modules {
            for instance in &user.instances {
                let child = &*design.modules[instance.module].type_name;
                if let Some(block) = blocks.get_mut(child) {
                    block.users.insert(&user.type_name);
                }
            }
        }
    }
    blocks
}

/// What a block says at its head.
struct Head {
    purpose: String,
    drawings: Vec<String>,
    rest: Vec<String>,
}

/// What lines of a drawing have, and running text has not: the drawings of the sources stand between fences, which documentation does not
/// carry on.
const DRAWN: [&str; 7] = ["   ", "-->", "->", "<-", "--+", "+--", "~~"];

impl Head {
    fn of(module: &Module) -> Self {
        let paragraphs = module.docs.split(|line| line.trim().is_empty());
        let mut paragraphs = paragraphs.filter(|lines| !lines.is_empty());
        let words = |lines: &[String]| lines.iter().map(|l| l.trim()).collect::<Vec<_>>().join(" ");
        let purpose = paragraphs.next().map(words).unwrap_or_default();
        // "Receiver: takes the bits": the name is the page's heading.
        let purpose = match purpose.split_once(": ") {
            Some((name, rest)) if name.split(' ').count() < 4 => capital(rest),
            _ => purpose,
        };
        let is_table = |lines: &[String]| lines.iter().all(|line| line.trim().starts_with('|'));
        let is_drawing = |lines: &&[String]| {
            let is_drawn = |line: &String| DRAWN.iter().any(|mark| line.trim().contains(mark));
            !is_table(lines) && lines.iter().any(is_drawn)
        };
        let (drawings, rest): (Vec<_>, Vec<_>) = paragraphs.partition(is_drawing);
        Self {
            purpose,
            drawings: drawings.iter().map(|lines| lines.join("\n")).collect(),
            rest: rest
                .into_iter()
                .map(|lines| match is_table(lines) {
                    true => lines.join("\n"),
                    false => escaped(&words(lines)),
                })
                .collect(),
        }
    }
}

/// With a capital letter first.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

/// Text in a cell of a table.
fn cell(lines: &[String]) -> String {
    let text = lines.iter().map(|line| line.trim()).collect::<Vec<_>>();
    escaped(&text.join(" ")).replace('|', "\\|")
}

/// Text that has no Markdown in it.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if "<>_[]`".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

fn link(name: &str) -> String {
    format!("[{name}]({name}.md)")
}

fn list(blocks: &BTreeMap<&str, Block>) -> String {
    let mut text = String::from(
        "# All blocks\n\nA block is a module of the emitted Verilog or VHDL. Each page has what it is for, ports, parameters, its drawing and how it \
         works, as the block itself says it; values are those of the card that is named there.\n\n| block | what it is for |\n|---|---|\n",
    );
    for (name, block) in blocks {
        let purpose = escaped(&Head::of(block.module).purpose).replace('|', "\\|");
        let _ = writeln!(text, "| [{name}]({BLOCKS}/{name}.md) | {purpose} |");
    }
    text
}

fn page(block: &Block, blocks: &BTreeMap<&str, Block>) -> String {
    let module = block.module;
    let head = Head::of(module);
    let mut text = format!(
        "# {}\n\n{}\n\nIn an emission: `NAME{}`, in the file of that name.\n",
        module.type_name,
        escaped(&head.purpose),
        block.emitted()
    );
    text += "\n## Ports\n\n| port | | bits | |\n|---|---|---|---|\n";
    for port in &module.ports {
        let net = &module.nets[port.net];
        let direction = match port.direction {
            Direction::Input => "in",
            Direction::Output => "out",
        };
        let docs = cell(&net.docs);
        let _ = writeln!(
            text,
            "| `{}` | {direction} | {} | {docs} |",
            net.name, net.width_bits
        );
    }
    if !module.parameters.is_empty() {
        let _ = write!(
            text,
            "\n## Parameters\n\n| parameter | bits | in `{}` |\n|---|---|---|\n",
            block.card
        );
        for parameter in &module.parameters {
            let (name, bits, value) = (&parameter.name, parameter.width_bits, parameter.value);
            let _ = writeln!(text, "| `{name}` | {bits} | {value} |");
        }
    }
    if !head.drawings.is_empty() {
        text += "\n## Drawing\n";
    }
    for drawing in &head.drawings {
        let _ = write!(text, "\n```text\n{drawing}\n```\n");
    }
    if !head.rest.is_empty() {
        text += "\n## How it works\n";
        for paragraph in &head.rest {
            let _ = write!(text, "\n{paragraph}\n");
        }
    }
    text += &states(block);
    text += &around(block, blocks);
    let proved = properties(&module.properties);
    if !proved.is_empty() {
        text += "\n## Proved of it\n\n";
        for property in proved {
            let _ = writeln!(text, "- `{}`: {}", property.name, escaped(&property.words));
        }
        text += "\nWhat that means: [Proofs](../proofs.md).\n";
    }
    text
}

/// The states of its registers.
fn states(block: &Block) -> String {
    let module = block.module;
    let mut text = String::new();
    for register in &module.registers {
        let net = &module.nets[register.q];
        let Some(id) = net.enum_id else { continue };
        let states = &block.design.enums[id];
        let _ = write!(
            text,
            "\n## States of `{}`\n\n| value | state | |\n|---|---|---|\n",
            net.name
        );
        for (value, name) in states.variants.iter().enumerate() {
            let docs = states.variant_docs.get(value).map_or(&[][..], |d| d);
            let _ = writeln!(text, "| {value} | `{name}` | {} |", cell(docs));
        }
    }
    text
}

/// The blocks that it is in, and those in it.
fn around(block: &Block, blocks: &BTreeMap<&str, Block>) -> String {
    let instances = block.module.instances.iter();
    let children = instances.map(|i| &*block.design.modules[i.module].type_name);
    let children: BTreeSet<&str> = children.filter(|name| blocks.contains_key(name)).collect();
    let mut text = String::new();
    for (title, names) in [("In it", &children), ("Part of", &block.users)] {
        if !names.is_empty() {
            let links: Vec<String> = names.iter().map(|name| link(name)).collect();
            let _ = write!(text, "\n{title}: {}.\n", links.join(", "));
        }
    }
    match text.is_empty() {
        true => text,
        false => format!("\n## Beside it\n{text}"),
    }
}

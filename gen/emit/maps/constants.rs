//! What languages with constants say of a register map: names, places, masks and values, in one order. Each language prints them its way.

use super::{with_unit, Map, MapBlock, MapRegister, WORD_BYTES};
use endat_regs::Values;

/// How a number is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// As digits.
    Decimal,
    /// With so many hexadecimal digits at least.
    Hex(usize),
}

impl Form {
    /// Whether it is what a word may contain, and no place or count.
    pub fn is_content(self) -> bool {
        [CONTENT, BIT].contains(&self)
    }
}

/// A piece of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Item {
    /// A block begins.
    Heading(&'static str),
    /// What the next ones are.
    Comment(String),
    /// Nothing.
    Blank,
    /// A number.
    Constant {
        /// In capitals, without the card's name.
        name: String,
        value: u32,
        form: Form,
        /// What it stands for; empty if a comment before says it.
        meaning: &'static str,
    },
    /// A number that each channel has, so many apart.
    OfChannel {
        name: String,
        value: u32,
        stride: u32,
        form: Form,
    },
}

/// How a language writes them.
pub trait Language {
    /// Before each line.
    const INDENT: &'static str;

    /// The line of a block's heading.
    fn heading(&self, name: &str) -> String;
    /// A comment.
    fn comment(&self, text: &str) -> String;
    /// A number, unsigned, of 32 bits.
    fn number(&self, value: u32, form: Form) -> String;
    /// A named number.
    fn constant(&self, name: &str, number: &str) -> String;
    /// One that takes the channel.
    fn of_channel(&self, name: &str, number: &str, stride: u32) -> String;

    /// All of them.
    fn print(&self, items: &[Item]) -> String {
        let line = |item: &Item| match item {
            Item::Blank => String::new(),
            Item::Heading(name) => format!("\n{}{}\n", Self::INDENT, self.heading(name)),
            Item::Comment(text) => format!("{}{}", Self::INDENT, self.comment(text)),
            Item::Constant {
                name,
                value,
                form,
                meaning,
            } => {
                let constant = self.constant(name, &self.number(*value, *form));
                let behind = match *meaning {
                    "" => String::new(),
                    meaning => format!(" {}", self.comment(meaning)),
                };
                format!("{}{constant}{behind}", Self::INDENT)
            }
            Item::OfChannel {
                name,
                value,
                stride,
                form,
            } => {
                let number = self.number(*value, *form);
                format!(
                    "{}{}",
                    Self::INDENT,
                    self.of_channel(name, &number, *stride)
                )
            }
        };
        items.iter().map(|item| line(item) + "\n").collect()
    }
}

/// Digits of an address in words, of one in bytes, and of a word's content.
const WORD: Form = Form::Hex(3);
const BYTE: Form = Form::Hex(4);
const CONTENT: Form = Form::Hex(8);
/// A single bit of a word.
const BIT: Form = Form::Hex(1);

fn constant(name: String, value: u32, form: Form) -> Item {
    Item::Constant {
        name,
        value,
        form,
        meaning: "",
    }
}

/// Version and size of the map.
pub fn head(map: &Map) -> Vec<Item> {
    let version = ["MAJOR", "MINOR", "PATCH"].into_iter().zip(map.version);
    let version =
        version.map(|(part, number)| constant(format!("MAP_{part}"), number.into(), Form::Decimal));
    let mut items = vec![Item::Comment(
        "Version of the register map; within a major version no address and no field moves.".into(),
    )];
    items.extend(version);
    items.push(Item::Comment("Encoder ports".into()));
    items.push(constant("CHANNELS".into(), map.channels, Form::Decimal));
    if map.base_address != 0 {
        items.push(Item::Comment(
            "Where a system has the registers: a register is at this and its ..._BYTE".into(),
        ));
        items.push(constant("BASE_ADDRESS".into(), map.base_address, CONTENT));
    }
    items
}

/// A block, its words and their fields.
pub fn block(block: &MapBlock) -> Vec<Item> {
    let table = block.block;
    let name = table.name.to_ascii_uppercase();
    let mut items = vec![
        Item::Heading(table.name),
        Item::Comment(table.meaning.into()),
        constant(format!("{name}_BASE_WORD"), table.base.into(), WORD),
        constant(format!("{name}_BASE_BYTE"), block.base_bytes(), BYTE),
    ];
    if table.per_channel {
        let strides = [
            ("WORDS", table.stride.into()),
            ("BYTES", block.stride_bytes()),
        ];
        items.extend(strides.map(|(unit, stride)| {
            constant(format!("{name}_STRIDE_{unit}"), stride, Form::Decimal)
        }));
    }
    for entry in &block.registers {
        let register = entry.register;
        let name = format!("{name}_{}", register.name.to_ascii_uppercase());
        let word = u32::from(table.address(register, 0));
        items.push(Item::Blank);
        let access = register.access.short();
        items.push(Item::Comment(format!("{access}: {}", register.meaning)));
        let places = [
            ("WORD", word, table.stride.into(), WORD),
            ("BYTE", word * WORD_BYTES, block.stride_bytes(), BYTE),
        ];
        items.extend(places.map(|(unit, value, stride, form)| {
            let name = format!("{name}_{unit}");
            match table.per_channel {
                true => Item::OfChannel {
                    name,
                    value,
                    stride,
                    form,
                },
                false => constant(name, value, form),
            }
        }));
        resets(&mut items, entry, &name);
        fields(&mut items, entry, &name);
    }
    items
}

/// One value, or one for each channel where they differ.
fn resets(items: &mut Vec<Item>, entry: &MapRegister, name: &str) {
    if entry.reset_mask() == u32::MAX {
        items.push(constant(format!("{name}_RESET"), entry.reset(), CONTENT));
        return;
    }
    let each = entry.resets.iter().enumerate();
    items.extend(
        each.map(|(channel, reset)| constant(format!("{name}_RESET_{channel}"), *reset, CONTENT)),
    );
}

fn fields(items: &mut Vec<Item>, entry: &MapRegister, register: &str) {
    for field in entry.register.fields {
        let name = format!("{register}_{}", field.name.to_ascii_uppercase());
        items.push(Item::Comment(format!(
            "{}: {}",
            field.name,
            with_unit(field)
        )));
        items.push(constant(format!("{name}_SHIFT"), field.lsb, Form::Decimal));
        items.push(constant(format!("{name}_MASK"), field.mask(), CONTENT));
        values(items, &name, field.values);
        for (protocol, special) in entry.values_elsewhere(field) {
            items.push(Item::Comment(format!(
                "{}: on {}",
                field.name,
                protocol.row().channel
            )));
            let suffix = protocol.row().word.to_ascii_uppercase();
            values(items, &format!("{name}_{suffix}"), special);
        }
    }
}

fn values(items: &mut Vec<Item>, name: &str, values: Values) {
    let (listed, is_bits) = match values {
        Values::Plain => return,
        Values::Codes(listed) => (listed, false),
        Values::Bits(listed) => (listed, true),
    };
    items.extend(listed.iter().map(|value| Item::Constant {
        name: format!("{name}_{}", value.name.to_ascii_uppercase()),
        // Of bits as the content of the field.
        value: match is_bits {
            true => 1 << value.number,
            false => value.number,
        },
        form: match is_bits {
            true => BIT,
            false => Form::Decimal,
        },
        meaning: value.meaning,
    }));
}

//! Keys of a form: what each is called, what may stand there and what it means, said once. The reader takes names, limits, words and
//! defaults from here, and so do the pages, the JSON Schema and `explain`.

use endat_hdl::config::Limits;
use std::fmt::Write;
use std::ops::RangeInclusive;

/// What may stand under a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A whole number.
    Number,
    /// Text.
    Text,
    /// True or false.
    Boolean,
    /// A list of texts, none of them twice.
    Texts,
    /// A list of whole numbers.
    Numbers,
}

/// One of a few words or numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// As it is written.
    pub word: String,
    /// What it means; may be empty.
    pub meaning: &'static str,
}

impl Choice {
    /// A word or number and its meaning.
    pub fn new(word: impl ToString, meaning: &'static str) -> Self {
        Self {
            word: word.to_string(),
            meaning,
        }
    }
}

/// What counts when a key is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Usual {
    /// Nothing: it must be there, for example so.
    Required(&'static str),
    /// This number.
    Number(u64),
    /// This word.
    Word(&'static str),
    /// This.
    Boolean(bool),
    /// An empty list.
    Empty,
    /// A list of all that there may be.
    All,
    /// What follows from other keys, or nothing, in words.
    Follows(&'static str),
}

/// Limits of a key, by its name, at this system clock or at any.
pub type LimitsOf = fn(&str, Option<u64>) -> Limits;

/// A key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Tables that it may stand in; an empty name is the top of the file.
    pub tables: &'static [&'static str],
    /// What may stand there.
    pub kind: Kind,
    /// What it is.
    pub meaning: &'static str,
    /// What else there is to know of its values, limits that follow from other keys above all.
    pub note: &'static str,
    /// What counts without it.
    pub usual: Usual,
    /// Kinds of forms that have it, as bits.
    pub forms: u8,
    /// It takes this word in `parts` of its table; empty if it takes none.
    pub takes: &'static str,
    /// The first of its words is there whenever another one is.
    pub first_leads: bool,
    /// Each of its words may come more than once.
    pub repeats: bool,
    /// Most characters of a text, or values of a list; 0 = no limit.
    pub most: usize,
    /// What a text matches, as a regular expression; empty = anything.
    pub pattern: &'static str,
    /// Numbers are multiples of this.
    pub step: u64,
    /// It may be something else than its choices, too.
    pub is_open: bool,
    /// Its name stands for any of these, or for any name if there are none.
    pub names: Option<fn() -> Vec<String>>,
    /// What the numbers of a list may be.
    pub items: &'static [RangeInclusive<u64>],
    limits: LimitsOf,
    choices: fn() -> Vec<Choice>,
}

impl Key {
    const fn new(
        kind: Kind,
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self {
            name,
            tables,
            kind,
            meaning,
            note: "",
            usual: Usual::Follows("none"),
            forms: u8::MAX,
            takes: "",
            first_leads: false,
            repeats: false,
            most: 0,
            pattern: "",
            step: 1,
            is_open: false,
            names: None,
            items: &[],
            limits: endat_hdl::config::limits,
            choices: Vec::new,
        }
    }

    /// A whole number.
    pub const fn number(
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self::new(Kind::Number, tables, name, meaning)
    }

    /// A text.
    pub const fn text(
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self::new(Kind::Text, tables, name, meaning)
    }

    /// True or false.
    pub const fn boolean(
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self::new(Kind::Boolean, tables, name, meaning)
    }

    /// A list of texts, empty unless something is written.
    pub const fn texts(
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self::new(Kind::Texts, tables, name, meaning).usual(Usual::Empty)
    }

    /// A list of numbers, empty unless something is written.
    pub const fn numbers(
        tables: &'static [&'static str],
        name: &'static str,
        meaning: &'static str,
    ) -> Self {
        Self::new(Kind::Numbers, tables, name, meaning).usual(Usual::Empty)
    }

    /// The same with more to know.
    pub const fn note(self, note: &'static str) -> Self {
        Self { note, ..self }
    }

    /// The same that must be there, for example so.
    pub const fn required(self, example: &'static str) -> Self {
        self.usual(Usual::Required(example))
    }

    /// The same with what counts without it.
    pub const fn usual(self, usual: Usual) -> Self {
        Self { usual, ..self }
    }

    /// The same, in these kinds of forms only.
    pub const fn of(self, forms: u8) -> Self {
        Self { forms, ..self }
    }

    /// The same that takes a part of its table.
    pub const fn takes(self, takes: &'static str) -> Self {
        Self { takes, ..self }
    }

    /// The same where every other word takes the first one.
    pub const fn first_leads(self) -> Self {
        Self {
            first_leads: true,
            ..self
        }
    }

    /// The same where words have an order, and each may come more than once.
    pub const fn repeating(self) -> Self {
        Self {
            repeats: true,
            ..self
        }
    }

    /// The same of so many characters, or values, at most.
    pub const fn at_most(self, most: usize) -> Self {
        Self { most, ..self }
    }

    /// The same of texts that match an expression.
    pub const fn pattern(self, pattern: &'static str) -> Self {
        Self { pattern, ..self }
    }

    /// The same, a list of these numbers.
    pub const fn items(self, items: &'static [RangeInclusive<u64>]) -> Self {
        Self { items, ..self }
    }

    /// The same of multiples only.
    pub const fn step(self, step: u64) -> Self {
        Self { step, ..self }
    }

    /// The same that may be something else than its choices, too.
    pub const fn open(self) -> Self {
        Self {
            is_open: true,
            ..self
        }
    }

    /// The same under any of these names, or any name at all if there are none.
    pub const fn named(self, names: fn() -> Vec<String>) -> Self {
        Self {
            names: Some(names),
            ..self
        }
    }

    /// The same with limits of its own.
    pub const fn within(self, limits: LimitsOf) -> Self {
        Self { limits, ..self }
    }

    /// The same of a few words or numbers.
    pub const fn one_of(self, choices: fn() -> Vec<Choice>) -> Self {
        Self { choices, ..self }
    }

    /// Its limits at this system clock, or at any when it is not known.
    pub fn limits(&self, system_hz: Option<u64>) -> Limits {
        (self.limits)(self.name, system_hz)
    }

    /// All that it may be, if it is one of a few.
    pub fn choices(&self) -> Vec<Choice> {
        (self.choices)()
    }

    /// The words of its choices.
    pub fn words(&self) -> Vec<String> {
        self.choices().into_iter().map(|c| c.word).collect()
    }

    /// What stands for it where it is missing and must be there; empty where it need not.
    pub const fn example(&self) -> &'static str {
        match self.usual {
            Usual::Required(example) => example,
            _ => "",
        }
    }

    /// The number that counts without it; 0 if there is none.
    pub const fn usual_number(&self) -> u64 {
        match self.usual {
            Usual::Number(number) => number,
            _ => 0,
        }
    }

    /// Name with the first of its tables.
    pub fn path(&self) -> String {
        self.path_in(self.tables.first().unwrap_or(&""))
    }

    /// Name with one of its tables.
    pub fn path_in(&self, table: &str) -> String {
        match table {
            "" => self.name.to_owned(),
            table => format!("{table}.{}", self.name),
        }
    }

    /// Whether it belongs to the table with this path.
    pub fn belongs_to(&self, path: &str) -> bool {
        let table = path.split('[').next().unwrap_or_default();
        let is = |name: &&str| match name.strip_suffix(ANY_NAME) {
            None => *name == table,
            Some(of) => table.strip_prefix(of).is_some_and(|n| n.starts_with('.')),
        };
        self.tables.iter().any(is)
    }

    /// Unit of its numbers, which its name ends in.
    pub fn unit(&self) -> &'static str {
        const UNITS: [(&str, &str); 8] = [
            ("baud", "bit/s"),
            ("_hz", "Hz"),
            ("_ns", "ns"),
            ("_us", "us"),
            ("_ms", "ms"),
            ("_m", "m"),
            ("_mv", "mV"),
            ("_cycles", "cycles"),
        ];
        let found = UNITS.iter().find(|(end, _)| self.name.ends_with(end));
        found.map_or("", |(_, unit)| unit)
    }

    /// A number with its unit.
    fn quantity(&self, number: u64) -> String {
        match self.unit() {
            // One of a few stands there as it is written.
            _ if !self.choices().is_empty() => number.to_string(),
            "Hz" if number >= 1_000_000 => format!("{} MHz", number as f64 / 1e6),
            "Hz" if number >= 1_000 => format!("{} kHz", number as f64 / 1e3),
            "" if self.step > 1 => format!("0x{number:X}"),
            "" => number.to_string(),
            unit => format!("{number} {unit}"),
        }
    }

    /// What may stand there, in words; `mark` is put around what is written as it stands.
    pub fn may_be(&self, mark: &str) -> String {
        let quoted = |word: &String| match self.kind {
            Kind::Number => word.clone(),
            _ => format!("{mark}\"{word}\"{mark}"),
        };
        // Where words are marked nothing else tells what they mean.
        let choices = self.choices();
        let told = |choice: &Choice| match choice.meaning {
            meaning if mark.is_empty() || meaning.is_empty() || meaning == choice.word => {
                quoted(&choice.word)
            }
            meaning => format!("{} ({meaning})", quoted(&choice.word)),
        };
        let words: Vec<String> = choices.iter().map(told).collect();
        let words = words.join(", ");
        let mut text = match self.kind {
            Kind::Boolean => format!("{mark}true{mark} or {mark}false{mark}"),
            Kind::Texts if !words.is_empty() => format!("any of {words}, or {mark}[]{mark}"),
            Kind::Texts => "a list of texts".into(),
            Kind::Numbers => {
                let range =
                    |r: &RangeInclusive<u64>| format!("0x{:X} to 0x{:X}", r.start(), r.end());
                let ranges: Vec<String> = self.items.iter().map(range).collect();
                format!("any of {}, or {mark}[]{mark}", ranges.join(", "))
            }
            _ if !words.is_empty() => words,
            Kind::Text => "text".into(),
            Kind::Number => {
                let limits = self.limits(None);
                let (low, high) = limits.range().into_inner();
                let zero = if limits.or_zero() { "0, or " } else { "" };
                let low = match self.unit() {
                    "Hz" | "" => self.quantity(low),
                    _ => low.to_string(),
                };
                format!("{zero}{low} to {}", self.quantity(high))
            }
        };
        if self.kind == Kind::Number && self.step > 1 {
            let _ = write!(text, ", a multiple of {}", self.quantity(self.step));
        }
        if self.most > 0 {
            let what = match self.kind {
                Kind::Text => "characters",
                _ => "of them",
            };
            let _ = write!(text, ", up to {} {what}", self.most);
        }
        if self.first_leads {
            let first = choices.first().map(|choice| quoted(&choice.word));
            let _ = write!(
                text,
                " (every other part also needs {})",
                first.unwrap_or_default()
            );
        }
        if !self.takes.is_empty() {
            let table = self.tables.first().unwrap_or(&"");
            let _ = write!(
                text,
                "; takes {mark}\"{}\"{mark} in {mark}{table}.parts{mark}",
                self.takes
            );
        }
        text
    }

    /// Its row on a page.
    fn row(&self) -> String {
        let mut may_be = self.may_be("`");
        if !self.note.is_empty() {
            let _ = write!(may_be, "; {}", self.note);
        }
        let otherwise = self.otherwise("`");
        format!(
            "| `{}` | {} | {may_be} | {otherwise} |\n",
            self.path(),
            self.meaning
        )
    }

    /// What counts without it, in words.
    pub fn otherwise(&self, mark: &str) -> String {
        match self.usual {
            Usual::Required(_) => "required".into(),
            Usual::Number(0) => "0".into(),
            Usual::Number(number) => self.quantity(number),
            Usual::Word(word) => format!("{mark}\"{word}\"{mark}"),
            Usual::Boolean(value) => format!("{mark}{value}{mark}"),
            Usual::Empty => format!("{mark}[]{mark}"),
            Usual::All => "all of them".into(),
            Usual::Follows(words) => words.into(),
        }
    }
}

/// Ends the name of a table that there may be several of, each with a name of its own.
pub const ANY_NAME: &str = ".NAME";

/// The one table that a form may have several of.
pub const CHANNELS: &str = "channel";

/// What stands above the keys of a table.
pub fn head(table: &str) -> String {
    match table {
        CHANNELS => format!("[[{table}]]"),
        table => format!("[{table}]"),
    }
}

/// Keys as a table of Markdown.
pub fn page<'k>(keys: impl IntoIterator<Item = &'k Key>) -> String {
    let head = "| key | meaning | allowed values | default |\n|---|---|---|---|\n";
    let rows: String = keys.into_iter().map(Key::row).collect();
    format!("{head}{rows}")
}

/// Names keys, and the list of all of them. Without a list the compiler names a key that no reader asks for; with one a test does.
macro_rules! keys {
    ($(#[$about:meta])* $all:ident; $($name:ident = $key:expr;)*) => {
        $crate::form::key::keys! { $($name = $key;)* }

        $(#[$about])*
        pub static $all: &[&$crate::form::key::Key] = &[$(&$name),*];
    };
    ($($name:ident = $key:expr;)*) => {
        $(
            #[doc = concat!("The key of the table that is called ", stringify!($name), ".")]
            pub static $name: $crate::form::key::Key = $key;
        )*
    };
}
pub(crate) use keys;

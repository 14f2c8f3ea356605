//! Packages: how the pins of one are called, and which there are.

/// The pins of a package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Package {
    /// Numbered around its edge.
    Numbered {
        /// What stands before the number.
        prefix: String,
        /// How many there are, from 1 on.
        pins: u32,
    },
    /// A grid of balls, each called by row and column.
    Grid {
        /// Letters of the rows.
        rows: Vec<String>,
        /// How many columns there are, from 1 on.
        columns: u32,
    },
}

/// What a word is among the pins of a package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Word {
    /// A pin, as the vendor's tools spell it.
    Pin(String),
    /// Looks like one, but there is none of that name.
    NoPin,
    /// Does not look like one.
    Other,
}

impl Package {
    /// What a word in capital letters is.
    pub fn look_up(&self, word: &str) -> Word {
        let number = |digits: &str| {
            let plain = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
            // A number beyond every other is no pin, and still looks like one.
            plain.then(|| digits.parse::<u32>().unwrap_or(u32::MAX))
        };
        match self {
            Self::Numbered { prefix, pins } => {
                match word.strip_prefix(prefix.as_str()).and_then(number) {
                    Some(n) if (1..=*pins).contains(&n) => Word::Pin(format!("{prefix}{n}")),
                    Some(_) => Word::NoPin,
                    None => Word::Other,
                }
            }
            Self::Grid { rows, columns } => {
                let split = word
                    .find(|c: char| c.is_ascii_digit())
                    .unwrap_or(word.len());
                let (row, column) = word.split_at(split);
                let is_row =
                    (1..=2).contains(&row.len()) && row.bytes().all(|b| b.is_ascii_uppercase());
                match number(column).filter(|_| is_row) {
                    Some(n) if (1..=*columns).contains(&n) && rows.iter().any(|r| r == row) => {
                        Word::Pin(format!("{row}{n}"))
                    }
                    Some(_) => Word::NoPin,
                    None => Word::Other,
                }
            }
        }
    }

    /// First and last pin, for messages.
    pub fn ends(&self) -> String {
        match self {
            Self::Numbered { prefix, pins } => format!("{prefix}1..{prefix}{pins}"),
            Self::Grid { rows, columns } => {
                let first = rows.first().map_or("", String::as_str);
                let last = rows.last().map_or("", String::as_str);
                format!("{first}1..{last}{columns}")
            }
        }
    }
}

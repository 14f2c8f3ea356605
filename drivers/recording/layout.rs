//! What columns a recording has.

use endat_host::units::Scale;

/// A column that is calculated from others.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivedColumn {
    /// Its name, without the unit.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Digits behind the point in text; none: as many as the number has.
    pub digits: Option<usize>,
}

impl DerivedColumn {
    /// Name of the column in a file; a slash would be none of a name.
    pub fn column(&self) -> String {
        match self.unit.is_empty() {
            true => self.name.clone(),
            false => format!("{}_{}", self.name, self.unit.replace('/', "_per_")),
        }
    }
}

/// The columns of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// What a measuring step is, of every channel.
    pub scales: Vec<Scale>,
    /// Rows have additional data.
    pub additional_data: bool,
    /// What is calculated.
    pub derived: Vec<DerivedColumn>,
    /// CSV as spreadsheets read it where the comma is in numbers: fields apart by semicolons.
    pub decimal_comma: bool,
}

/// Columns of the additional data of a channel.
pub const INFOS: [&str; 4] = ["info_1", "info_1_status", "info_2", "info_2_status"];

/// Column `what` of a channel.
pub fn of_channel(channel: usize, what: &str) -> String {
    format!("ch{channel}_{what}")
}

impl Layout {
    /// Positions of these channels, and nothing else.
    pub fn of(scales: Vec<Scale>) -> Self {
        Self {
            scales,
            additional_data: false,
            derived: Vec::new(),
            decimal_comma: false,
        }
    }

    /// Columns of text.
    pub fn text(&self) -> Vec<String> {
        let mut names = vec!["trigger".to_owned(), "time_s".into(), "missing".into()];
        for (n, scale) in self.scales.iter().enumerate() {
            let unit = scale.convert(0).unit;
            let all = ["raw", unit, "turns", "fresh", "cause"];
            names.extend(all.map(|name| of_channel(n, name)));
            names.extend(self.infos().map(|name| of_channel(n, name)));
        }
        names.extend(self.derived.iter().map(DerivedColumn::column));
        names
    }

    /// Columns of additional data, if there are any.
    pub fn infos(&self) -> impl Iterator<Item = &'static str> {
        let count = if self.additional_data { INFOS.len() } else { 0 };
        INFOS.into_iter().take(count)
    }
}

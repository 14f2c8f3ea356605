//! A configuration as lines of tables, so that keys can be written as anybody may write them.

/// A value as it is written below a key, in a table (`channel[0]` for the first one in double brackets).
#[derive(Clone, Debug)]
struct Entry {
    key: String,
    value: String,
}

/// A table and its lines.
#[derive(Clone, Debug)]
struct Part {
    head: String,
    entries: Vec<Entry>,
}

/// A configuration.
#[derive(Clone, Debug)]
pub struct Document(Vec<Part>);

/// Table and key of a path.
fn split(path: &str) -> (&str, &str) {
    path.rsplit_once('.').unwrap_or(("", path))
}

impl Document {
    /// Reads a text whose values take one line each.
    pub fn new(text: &str) -> Self {
        let part = |head: &str| Part {
            head: head.into(),
            entries: vec![],
        };
        let mut parts = vec![part("")];
        for line in text.lines() {
            let line = line.split(" #").next().unwrap_or_default().trim();
            if line.starts_with('[') {
                parts.push(part(line));
            } else if let Some((key, value)) =
                line.split_once(" = ").filter(|_| !line.starts_with('#'))
            {
                parts.last_mut().unwrap().entries.push(Entry {
                    key: key.trim().into(),
                    value: value.trim().into(),
                });
            }
        }
        Self(parts)
    }

    /// The text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for part in &self.0 {
            if !part.head.is_empty() {
                text += &format!("{}\n", part.head);
            }
            for Entry { key, value } in &part.entries {
                text += &format!("{key} = {value}\n");
            }
        }
        text
    }

    fn part(&mut self, table: &str) -> Option<&mut Part> {
        let (name, number) = match table.split_once('[') {
            Some((name, rest)) => (name, rest.trim_end_matches(']').parse().unwrap_or(0)),
            None => (table, 0),
        };
        let is_it = |part: &&mut Part| match name {
            "" => part.head.is_empty(),
            name => part.head.trim_matches(['[', ']']) == name,
        };
        self.0.iter_mut().filter(is_it).nth(number)
    }

    /// Whether the table is there.
    pub fn has_table(&self, table: &str) -> bool {
        self.clone().part(table).is_some()
    }

    /// The value of a key.
    pub fn get(&self, path: &str) -> Option<String> {
        let (table, key) = split(path);
        let mut copy = self.clone();
        let mut entries = copy.part(table)?.entries.iter();
        entries.find(|e| e.key == key).map(|e| e.value.clone())
    }

    /// Writes a key, in a table that comes last if it is not there.
    pub fn set(&mut self, path: &str, value: &str) {
        let (table, key) = split(path);
        if self.part(table).is_none() {
            let head = match table.split_once('[') {
                Some((name, _)) => format!("[[{name}]]"),
                None if table == "channel" => "[[channel]]".into(),
                None => format!("[{table}]"),
            };
            self.0.push(Part {
                head,
                entries: vec![],
            });
        }
        let Some(part) = self.part(table) else {
            return;
        };
        match part.entries.iter_mut().find(|e| e.key == key) {
            Some(entry) => entry.value = value.into(),
            None => part.entries.push(Entry {
                key: key.into(),
                value: value.into(),
            }),
        }
    }

    /// Removes a key, duplicates included.
    pub fn remove(&mut self, path: &str) {
        let (table, key) = split(path);
        if let Some(part) = self.part(table) {
            part.entries.retain(|e| e.key != key);
        }
    }

    /// Removes all tables of a name.
    pub fn remove_table(&mut self, name: &str) {
        self.0
            .retain(|part| part.head.is_empty() || part.head.trim_matches(['[', ']']) != name);
    }

    /// Gives a key, or a table where no key is called so, another name.
    pub fn rename(&mut self, path: &str, to: &str) {
        let (table, key) = split(path);
        if let Some(entry) = self
            .part(table)
            .and_then(|p| p.entries.iter_mut().find(|e| e.key == key))
        {
            entry.key = to.into();
            return;
        }
        for part in &mut self.0 {
            if part.head.trim_matches(['[', ']']) == path {
                part.head = part.head.replace(path, to);
            }
        }
    }

    /// Takes the brackets of a table for others: `[[` or `[`.
    pub fn bracket(&mut self, name: &str, bracket: &str) {
        for part in &mut self.0 {
            if part.head.trim_matches(['[', ']']) == name {
                part.head = format!("{bracket}{name}{}", bracket.replace('[', "]"));
            }
        }
    }

    /// Repeats the last table of a name, so that there are so many.
    pub fn repeat(&mut self, name: &str, count: usize) {
        let is_it = |part: &Part| part.head.trim_matches(['[', ']']) == name;
        let Some(at) = self.0.iter().rposition(is_it) else {
            return;
        };
        let last = self.0[at].clone();
        let there = self.0.iter().filter(|part| is_it(part)).count();
        for _ in there..count {
            self.0.insert(at, last.clone());
        }
    }

    /// Leaves so many tables of a name.
    pub fn keep(&mut self, name: &str, count: usize) {
        let mut seen = 0;
        self.0.retain(|part| {
            let is_it = part.head.trim_matches(['[', ']']) == name;
            seen += usize::from(is_it);
            !is_it || seen <= count
        });
    }

    /// Writes a key twice.
    pub fn double(&mut self, path: &str) {
        let (table, key) = split(path);
        if let Some(part) = self.part(table) {
            let again = part.entries.iter().find(|e| e.key == key).cloned();
            part.entries.extend(again);
        }
    }

    /// Leaves the first of keys that a table has twice.
    pub fn dedup(&mut self, path: &str) {
        let (table, _) = split(path);
        if let Some(part) = self.part(table) {
            let mut seen = std::collections::BTreeSet::new();
            part.entries.retain(|e| seen.insert(e.key.clone()));
        }
    }

    /// Path of the key in a line of the text, counted from 1.
    pub fn path_of_line(&self, line: usize) -> String {
        let mut at = 0;
        let mut numbers = std::collections::BTreeMap::new();
        for part in &self.0 {
            let name = part.head.trim_matches(['[', ']']).to_owned();
            let count = numbers.entry(name.clone()).or_insert(0);
            let table = match part.head.starts_with("[[") {
                true => format!("{name}[{count}]."),
                false if name.is_empty() => name,
                false => format!("{name}."),
            };
            *count += 1;
            at += usize::from(!part.head.is_empty());
            for entry in &part.entries {
                at += 1;
                if at == line {
                    return format!("{table}{}", entry.key);
                }
            }
        }
        String::new()
    }
}

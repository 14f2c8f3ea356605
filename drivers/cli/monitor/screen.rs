//! What is on the screen, and what keys do to it.

use super::look::{Look, Seen};
use super::text::{names, rate};
use crate::read::{is_in_range, shown, verdict};
use endat_host::motion::nearest;
use endat_host::range;
use endat_host::units::Scale;
use ratatui::crossterm::event::{KeyCode, KeyModifiers};
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Clear, Paragraph};
use ratatui::Frame;

/// What is known of a card from the beginning.
pub struct Facts {
    pub port: String,
    pub about: String,
    pub scales: Vec<Scale>,
    /// Name plates, a line for each thing that is known.
    pub plates: Vec<String>,
}

/// The screen.
pub struct Screen {
    facts: Facts,
    look: Option<Look>,
    trouble: Option<String>,
    selected: usize,
    /// Positions that are 0, in measuring steps.
    zeros: Vec<Option<i128>>,
    is_paused: bool,
    has_help: bool,
    has_colour: bool,
}

/// Keys, and what they do.
const KEYS: [(&str, &str); 7] = [
    ("q, Esc", "end"),
    ("space", "stop the picture, and go on"),
    ("up, down, 0 to 7", "choose a channel"),
    ("z", "its position is 0 from here on"),
    ("Z", "no zero: as the encoders send them"),
    ("?", "this help"),
    ("Ctrl-C", "end"),
];
/// The same in a line.
const FOOT: &str = "q end  space stop  up/down channel  z zero  Z no zero  ? help";
/// The same where that is too long.
const SHORT_FOOT: &str = "q end  space stop  up/down  z zero  ? help";
/// Where it is narrower, frames by cause are below what else there is of a channel.
const BESIDE_COLUMNS: u16 = 72;
/// Lines of the table but those of channels: its frame, and what is above the columns.
const TABLE: u16 = 3;
/// Less is no room for what there is of one channel.
const DETAIL: u16 = 4;

impl Screen {
    pub fn new(facts: Facts, has_colour: bool) -> Self {
        Self {
            zeros: vec![None; facts.scales.len()],
            facts,
            look: None,
            trouble: None,
            selected: 0,
            is_paused: false,
            has_help: false,
            has_colour,
        }
    }

    /// The card has answered.
    pub fn look(&mut self, look: Look) {
        self.trouble = None;
        if !self.is_paused {
            self.look = Some(look);
        }
    }

    /// It has not.
    pub fn trouble(&mut self, text: String) {
        self.trouble = Some(text);
    }

    /// A key; true if it is the end.
    pub fn key(&mut self, code: KeyCode, modifiers: KeyModifiers) -> bool {
        let last = self.facts.scales.len().saturating_sub(1);
        if self.has_help && code != KeyCode::Char('c') {
            self.has_help = false;
            return false;
        }
        match code {
            KeyCode::Char('q') | KeyCode::Esc => return true,
            KeyCode::Char('c') if modifiers.contains(KeyModifiers::CONTROL) => return true,
            KeyCode::Char(' ') => self.is_paused = !self.is_paused,
            KeyCode::Char('?' | 'h') => self.has_help = true,
            KeyCode::Up => self.selected = self.selected.saturating_sub(1),
            KeyCode::Down | KeyCode::Tab => self.selected = (self.selected + 1).min(last),
            KeyCode::Char(digit @ '0'..='7') => {
                self.selected = (digit as usize - '0' as usize).min(last);
            }
            KeyCode::Char('z') => self.zero(),
            KeyCode::Char('Z') => self.zeros.fill(None),
            _ => {}
        }
        false
    }

    fn seen(&self, channel: usize) -> Option<&Seen> {
        self.look.as_ref()?.channels.get(channel)
    }

    fn zero(&mut self) {
        let scale = self.facts.scales.get(self.selected);
        let reading = self.seen(self.selected).map(|seen| seen.reading);
        if let (Some(scale), Some(reading)) = (scale, reading.filter(|r| r.valid)) {
            if !scale.is_known() {
                // A difference takes what a turn is.
                self.trouble = Some(format!("z: {}", range::refusal(self.selected)));
                return;
            }
            self.zeros[self.selected] = Some(scale.steps(reading.position).into());
        }
    }

    /// A position, from its zero if it has one.
    fn position(&self, channel: usize, seen: &Seen) -> String {
        let (Some(scale), reading) = (self.facts.scales.get(channel), &seen.reading) else {
            return String::new();
        };
        let zero = self.zeros.get(channel).copied().flatten();
        let Some(zero) = zero.filter(|_| reading.valid) else {
            return shown(reading, scale);
        };
        let steps = i128::from(scale.steps(reading.position)) - zero;
        let steps = scale.range().map_or(steps, |range| nearest(steps, range));
        let unit = scale.convert(0).unit;
        format!("{:+.*} {unit} z", scale.digits(), scale.value(steps))
    }

    fn style(&self, colour: Color) -> Style {
        match self.has_colour {
            true => Style::new().fg(colour),
            false => Style::new(),
        }
    }

    /// How well a channel is.
    fn health(&self, seen: &Seen, scale: &Scale) -> Style {
        let is_good = seen.reading.fresh && is_in_range(&seen.reading, scale);
        match (is_good, seen.reading.cause) {
            (true, 0) => self.style(Color::Green),
            (true, _) => self.style(Color::Yellow),
            _ => self.style(Color::Red).add_modifier(Modifier::BOLD),
        }
    }

    fn title(&self) -> Line<'_> {
        let (state, style) = match (&self.trouble, self.is_paused) {
            (Some(text), _) => (text.as_str(), self.style(Color::Red)),
            (None, true) => ("stopped, space goes on", self.style(Color::Yellow)),
            (None, false) => ("live", self.style(Color::Green)),
        };
        let Facts { port, about, .. } = &self.facts;
        Line::from(vec![
            Span::styled(state, style.add_modifier(Modifier::BOLD)),
            Span::raw(format!("  {port}  {about}")),
        ])
    }

    /// A line for each channel. Where its columns are too many, those that help least go first, so that the result is whole.
    fn table(&self, width: usize) -> Vec<Line<'_>> {
        const NUMBER: usize = 5;
        const GAP: usize = 2;
        let channels = || self.facts.scales.iter().enumerate();
        let known = channels().filter_map(|(n, scale)| Some((n, scale, self.seen(n)?)));
        let (mut position, mut result) = ("position".len(), "result".len());
        for (n, scale, seen) in known {
            position = position.max(self.position(n, seen).chars().count());
            result = result.max(verdict(&seen.reading, scale).chars().count());
        }
        position += 1;
        let mut room = width.saturating_sub(NUMBER + position + GAP + result);
        // The first ones that there is room for.
        let figures = [("per s", 9), ("age us", 8)]
            .into_iter()
            .take_while(|(_, columns)| {
                let left = room.checked_sub(*columns);
                room = left.unwrap_or(room);
                left.is_some()
            });
        let (names, columns): (Vec<&str>, Vec<usize>) = figures.unzip();
        let position = (position + room).min(27.max(position));
        let row = |begin: String, place: &str, figures: &[String]| {
            let figures = figures.iter().zip(&columns);
            let figures: String = figures
                .map(|(text, columns)| format!("{text:>columns$}"))
                .collect();
            format!("{begin:<NUMBER$}{place:<position$}{figures}{:GAP$}", "")
        };
        let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
        let head = row("  ch".into(), "position", &names) + "result";
        let bold = Style::new().add_modifier(Modifier::BOLD);
        let mut lines = vec![Line::styled(head, bold)];
        for (channel, scale) in channels() {
            let mark = if channel == self.selected { '>' } else { ' ' };
            let Some(seen) = self.seen(channel) else {
                lines.push(Line::raw(format!("{mark} {channel:<3}-")));
                continue;
            };
            let r = &seen.reading;
            let figures = [rate(seen), r.age_us.to_string()];
            let begin = format!("{mark} {channel}");
            let row = vec![
                Span::raw(row(begin, &self.position(channel, seen), &figures)),
                Span::styled(verdict(r, scale), self.health(seen, scale)),
            ];
            let chosen = match channel == self.selected {
                true => bold,
                false => Style::new(),
            };
            lines.push(Line::from(row).style(chosen));
        }
        lines
    }

    /// What there is of the chosen channel.
    fn details(&self) -> Vec<Line<'_>> {
        let mut lines = Vec::new();
        let mut line = |name: &str, value: String| {
            lines.push(Line::raw(format!("{name:<18}{value}")));
        };
        if let Some(seen) = self.seen(self.selected) {
            let r = &seen.reading;
            line("raw", format!("0x{:X}", r.position));
            if let Some((delay_ns, recovery_us)) = seen.times {
                line("line delay", format!("{delay_ns:.0} ns"));
                line("recovery time", format!("{recovery_us:.2} us"));
            }
            if let Some(found) = seen.edges {
                let found = found.map(|(first, last)| format!("{first} to {last} places"));
                line("edges", found.unwrap_or("none".into()));
            }
            if let Some(state) = &seen.state {
                line("state", names(state));
            }
            for (n, content, status) in seen.infos() {
                let value = format!("0x{content:04X}, status 0x{status:02X}");
                line(&format!("additional data {n}"), value);
            }
        }
        let retries = self.look.as_ref().map_or(0, |look| look.retries);
        if retries > 0 {
            line("asked again", format!("{retries} answers"));
        }
        let plate = self.facts.plates.get(self.selected);
        let plate = plate.into_iter().flat_map(|plate| plate.lines());
        lines.extend(plate.map(|text| Line::raw(text.trim_start())));
        lines
    }

    /// Frames of the chosen channel by their cause, the most first.
    fn causes(&self) -> Option<Vec<Line<'_>>> {
        let frames = self.seen(self.selected)?.frames.as_ref()?;
        let row =
            |name: &str, count: u64, style| Line::styled(format!("{name:<22}{count:>10}"), style);
        let mut lines = vec![
            row("all", frames.all, Style::new()),
            row("good", frames.good, self.style(Color::Green)),
        ];
        let mut causes = frames.causes.clone();
        causes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let bad = self.style(Color::Red);
        lines.extend(causes.iter().map(|(name, count)| row(name, *count, bad)));
        if frames.bad_infos > 0 {
            lines.push(row("wrong CRC of data", frames.bad_infos, bad));
        }
        Some(lines)
    }
}

/// Draws it, in as much room as there is.
pub fn draw(frame: &mut Frame<'_>, screen: &Screen) {
    let area = frame.area();
    let channels = screen.facts.scales.len() as u16;
    let has_foot = area.height > channels + 2;
    // Frames go first where there is little room, then what there is of one channel.
    let has_frames = area.height >= channels + TABLE + 2;
    let table = channels + if has_frames { TABLE } else { 1 };
    let rows = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(table),
        Constraint::Min(0),
        Constraint::Length(has_foot.into()),
    ]);
    let [title, table, detail, foot] = rows.areas(area);
    frame.render_widget(Paragraph::new(screen.title()), title);
    let block = match has_frames {
        true => Block::bordered().title(" positions "),
        false => Block::new(),
    };
    let room = area.width.saturating_sub(if has_frames { 2 } else { 0 });
    let lines = screen.table(room.into());
    frame.render_widget(Paragraph::new(lines).block(block), table);
    if detail.height >= DETAIL {
        let name = format!(" channel {} ", screen.selected);
        let details = screen.details();
        let (left, right) = match screen.causes() {
            Some(causes) if area.width >= BESIDE_COLUMNS => {
                let columns = Layout::horizontal([Constraint::Min(0), Constraint::Length(34)]);
                let [left, right] = columns.areas(detail);
                (left, Some((right, causes)))
            }
            Some(causes) => {
                let high = (details.len() as u16 + 2).min(detail.height);
                let rows = Layout::vertical([Constraint::Length(high), Constraint::Min(0)]);
                let [above, below] = rows.areas(detail);
                (above, (below.height > 2).then_some((below, causes)))
            }
            None => (detail, None),
        };
        let details = Paragraph::new(details).block(Block::bordered().title(name));
        frame.render_widget(details, left);
        if let Some((right, causes)) = right {
            let block = Block::bordered().title(" frames by cause ");
            frame.render_widget(Paragraph::new(causes).block(block), right);
        }
    }
    let keys = match usize::from(area.width) < FOOT.len() {
        true => SHORT_FOOT,
        false => FOOT,
    };
    frame.render_widget(Paragraph::new(keys), foot);
    if screen.has_help {
        help(frame, area);
    }
}

fn help(frame: &mut Frame<'_>, area: Rect) {
    let lines = KEYS.map(|(key, does)| Line::raw(format!(" {key:<18}{does} ")));
    let (width, height) = (64.min(area.width), (KEYS.len() as u16 + 2).min(area.height));
    let place = Rect {
        x: (area.width - width) / 2,
        y: (area.height - height) / 2,
        width,
        height,
    };
    frame.render_widget(Clear, place);
    let block = Block::bordered().title(" keys ");
    frame.render_widget(Paragraph::new(lines.to_vec()).block(block), place);
}

#[cfg(test)]
mod tests;

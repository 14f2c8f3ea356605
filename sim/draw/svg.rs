//! Just enough SVG.

use std::fmt::Write as _;

/// A drawing that grows downwards in the file in the order of the calls.
#[derive(Default)]
pub struct Svg {
    body: String,
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// Text begins there.
    Start,
    /// Text is centred there.
    Middle,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
        }
    }
}

/// How each file begins, and its third line.
const HEAD: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="#;
const STYLE_HEAD: &str = "<style>text{";

/// Whether a file that begins like this can be a drawing of ours.
pub fn is_drawing(head: &str) -> bool {
    let style = head.lines().nth(2);
    head.starts_with(HEAD) && style.is_some_and(|l| l.starts_with(STYLE_HEAD))
}

/// Mean width of a character, as a part of the font size.
const CHARACTER_WIDTH: f64 = 0.57;

/// How much wider bold characters are.
pub const BOLD_WIDTH: f64 = 1.2;

/// Estimated width of a text.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER_WIDTH
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

impl Svg {
    /// An empty drawing.
    pub fn new() -> Self {
        Self::default()
    }

    fn add(&mut self, text: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{text}");
    }

    /// A rectangle of a style class.
    pub fn rect(&mut self, x: f64, y: f64, width: f64, height: f64, class: &str) {
        self.add(format_args!(
            r#"<rect class="{class}" x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}"/>"#
        ));
    }

    /// A polyline.
    pub fn line(&mut self, points: &[(f64, f64)], class: &str) {
        let mut d = String::new();
        for (i, (x, y)) in points.iter().enumerate() {
            let _ = write!(d, "{}{x:.1} {y:.1}", if i == 0 { "M" } else { " L" });
        }
        self.path(&d, class);
    }

    /// A path.
    pub fn path(&mut self, d: &str, class: &str) {
        self.add(format_args!(r#"<path class="{class}" d="{d}"/>"#));
    }

    /// A text; its baseline is at `y`.
    pub fn text(&mut self, x: f64, y: f64, anchor: Anchor, class: &str, text: &str) {
        self.add(format_args!(
            r#"<text class="{class}" x="{x:.1}" y="{y:.1}" text-anchor="{}">{}</text>"#,
            anchor.name(),
            escape(text)
        ));
    }

    /// Title and subtitle of a drawing; where they end.
    pub fn head(&mut self, title: &str, subtitle: &str) -> f64 {
        let x = 24.0;
        self.text(x, 34.0, Anchor::Start, "title", title);
        self.text(x, 55.0, Anchor::Start, "sub", subtitle);
        let bold = text_width(title, 19.0) * BOLD_WIDTH;
        x + bold.max(text_width(subtitle, 12.5))
    }

    /// The file: title and description for those who do not see it, style, drawing.
    pub fn finish(self, width: f64, height: f64, title: &str, style: &str) -> String {
        format!(
            r#"{HEAD}"{width:.0}" height="{height:.0}" viewBox="0 0 {width:.0} {height:.0}" role="img">
<title>{}</title>
<style>{style}</style>
<rect width="100%" height="100%" fill="white"/>
{}</svg>
"#,
            escape(title),
            self.body
        )
    }
}

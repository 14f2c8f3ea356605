//! Draws signals of a run, a row for each: levels of single wires, values of words.

use super::svg::{text_width, Anchor, Svg};

/// A signal in every cycle of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wave {
    /// Name.
    pub name: String,
    /// Width, 1 to 64.
    pub width_bits: usize,
    /// Levels, the first cycle first.
    pub levels: Vec<u64>,
}

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:12px;font-weight:bold}\
.tick{font-size:10.5px;fill:#4b5563}.value{font-size:10px;fill:#111827}path{fill:none}.grid{stroke:#e5e7eb;stroke-width:0.8}\
.wire{stroke:#1d4ed8;stroke-width:1.4}.word{stroke:#b45309;stroke-width:1.2}.mark{stroke:#dc2626;stroke-width:1.4}";

const TOP: f64 = 84.0;
/// Height of a row, and of the signal in it.
const ROW: f64 = 30.0;
const HEIGHT: f64 = 18.0;
/// Most width of all cycles, and of one.
const WIDTH_MAX: f64 = 2400.0;
const CYCLE_MAX: f64 = 26.0;
const MARGIN: f64 = 24.0;
/// Space for the last values.
const VALUE: f64 = 84.0;

/// Spans of one level: first cycle, end (exclusive), level.
fn spans(levels: &[u64]) -> Vec<(usize, usize, u64)> {
    let mut at = 0;
    let chunks = levels.chunk_by(|a, b| a == b);
    let span = |chunk: &[u64]| {
        let from = at;
        at += chunk.len();
        (from, at, chunk[0])
    };
    chunks.map(span).collect()
}

/// The signals as SVG; the last cycle is marked as the cycle of interest.
pub fn waves_svg(waves: &[Wave], title: &str, subtitle: &str) -> String {
    let cycles = waves
        .iter()
        .map(|w| w.levels.len())
        .max()
        .unwrap_or(0)
        .max(1);
    let names = waves.iter().map(|w| text_width(&w.name, 13.0));
    let left = MARGIN + names.fold(40.0, f64::max) + 10.0;
    let cycle = (WIDTH_MAX / cycles as f64).min(CYCLE_MAX);
    let x = |at: usize| left + cycle * at as f64;
    let bottom = TOP + ROW * waves.len() as f64;
    let mut svg = Svg::new();
    let head = svg.head(title, subtitle);
    let (ticks, _) = super::series::ticks(0.0, cycles as f64);
    for tick in ticks.into_iter().filter(|tick| tick.fract() == 0.0) {
        let at = x(tick as usize);
        svg.line(&[(at, TOP - 6.0), (at, bottom)], "grid");
        let text = format!("{tick:.0}");
        svg.text(at, bottom + 14.0, Anchor::Middle, "tick", &text);
    }
    for (row, wave) in waves.iter().enumerate() {
        let top = TOP + ROW * row as f64;
        let low = top + HEIGHT;
        svg.text(MARGIN, low - 4.0, Anchor::Start, "name", &wave.name);
        let spans = spans(&wave.levels);
        if wave.width_bits == 1 {
            let y = |level: u64| if level == 0 { low } else { top };
            let points = spans.iter();
            let points =
                points.flat_map(|(from, to, level)| [(x(*from), y(*level)), (x(*to), y(*level))]);
            svg.line(&points.collect::<Vec<_>>(), "wire");
            continue;
        }
        // The value at the mark is the important one, and often too wide for its span.
        let last = wave
            .levels
            .last()
            .map_or(String::new(), |l| format!("{l:x}"));
        svg.text(x(cycles) + 8.0, low - 5.0, Anchor::Start, "value", &last);
        for (from, to, level) in spans {
            let (from, to) = (x(from), x(to));
            // The slopes of a short span meet.
            let slope = (to - from).min(6.0) / 2.0;
            let middle = (top + low) / 2.0;
            let upper = [
                (from, middle),
                (from + slope, top),
                (to - slope, top),
                (to, middle),
            ];
            let lower = upper.map(|(x, y)| (x, top + low - y));
            svg.line(&upper, "word");
            svg.line(&lower, "word");
            let text = format!("{level:x}");
            if text_width(&text, 10.0) < to - from - 8.0 {
                svg.text((from + to) / 2.0, low - 5.0, Anchor::Middle, "value", &text);
            }
        }
    }
    let last = x(cycles - 1) + cycle / 2.0;
    svg.line(&[(last, TOP - 10.0), (last, bottom + 3.0)], "mark");
    let width = (x(cycles) + VALUE + MARGIN).max(head + MARGIN);
    let unit = "system clock cycles; words are hexadecimal";
    svg.text(left, bottom + 30.0, Anchor::Start, "tick", unit);
    svg.finish(width, bottom + 44.0, title, STYLE)
}

//! Draws a shmoo map: the margin as a shade if all frames were good, otherwise a colour and a letter.

use crate::shmoo::{Axis, Fate, Map, Quantity, DECIMALS, PUBLISHED};
use endat_draw::{decimal, text_width, Anchor, Svg, BOLD_WIDTH};

/// Colours for colour-blind readers (Okabe and Ito), each with a letter.
const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,Helvetica,sans-serif;fill:#1f2937}\
.title{font-size:19px;font-weight:bold}.sub{font-size:12.5px;fill:#4b5563}.name{font-size:13px;font-weight:bold}\
.tick{font-size:11px;fill:#374151}.legend{font-size:11.5px;fill:#374151}.head{font-size:12px;font-weight:bold}\
.letter{font-size:10px;font-weight:bold;fill:#ffffff}.letter-dark{font-size:10px;font-weight:bold;fill:#111827}\
path{fill:none}rect{stroke:#ffffff;stroke-width:0.6}.frame{fill:none;stroke:#374151;stroke-width:1.2}.axis{stroke:#374151;stroke-width:1}\
.halo{stroke:#ffffff;stroke-width:4.5;stroke-opacity:0.85}.limit{stroke:#111827;stroke-width:2}\
.limit-0{stroke:#111827}.limit-1{stroke:#111827;stroke-dasharray:7 4}.limit-2{stroke:#111827;stroke-dasharray:2 4;stroke-linecap:round}\
.m0{fill:#e3eef9}.m1{fill:#c6dbef}.m2{fill:#9ecae1}.m3{fill:#6baed6}.m4{fill:#4292c6}.m5{fill:#2171b5}.m6{fill:#08519c}.m7{fill:#08306b}\
.refused{fill:#e69f00}.start_bit{fill:#9a9a9a}.crc{fill:#d55e00}.pulse_count{fill:#cc79a7}.silently_wrong{fill:#000000}";

/// Shades of the margin, from none to half a bit.
const SHADES: usize = 8;
const LEFT: f64 = 86.0;
const TOP: f64 = 104.0;

/// A map as SVG.
pub fn map_svg(map: &Map, title: &str) -> String {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let width = (760.0 / x.values.len() as f64).clamp(9.0, 46.0);
    let height = (380.0 / y.values.len() as f64).clamp(14.0, 34.0);
    let (right, bottom) = (
        LEFT + width * x.values.len() as f64,
        TOP + height * y.values.len() as f64,
    );
    let mut svg = Svg::new();
    let head = svg.head(title, &subtitle(map));
    let column = |place: f64| LEFT + width * (place + 0.5);
    let row = |place: f64| bottom - height * (place + 0.5);
    for line in 0..y.values.len() {
        for place in 0..x.values.len() {
            let cell = map.cell(place, line);
            let (cx, cy) = (column(place as f64), row(line as f64));
            let class = match cell.margin() {
                Some(margin) => format!("m{}", shade(margin)),
                None => cell.fate().column().into(),
            };
            svg.rect(cx - width / 2.0, cy - height / 2.0, width, height, &class);
            if cell.fate() != Fate::Good {
                let letter = cell.fate().letter().to_string();
                svg.text(cx, cy + 3.6, Anchor::Middle, ink(cell.fate()), &letter);
            }
        }
    }
    svg.rect(LEFT, TOP, right - LEFT, bottom - TOP, "frame");
    ticks(
        &mut svg,
        x,
        width,
        |text| text_width(text, 11.0) + 8.0,
        |svg, place, text| {
            let at = column(place);
            svg.line(&[(at, bottom), (at, bottom + 5.0)], "axis");
            svg.text(at, bottom + 19.0, Anchor::Middle, "tick", text);
        },
    );
    ticks(
        &mut svg,
        y,
        height,
        |_| 13.0,
        |svg, place, text| {
            let at = row(place);
            svg.line(&[(LEFT - 5.0, at), (LEFT, at)], "axis");
            let before = text_width(text, 11.0);
            svg.text(LEFT - 9.0 - before, at + 4.0, Anchor::Start, "tick", text);
        },
    );
    let middle = (LEFT + right) / 2.0;
    svg.text(
        middle,
        bottom + 42.0,
        Anchor::Middle,
        "name",
        x.quantity.title(),
    );
    svg.text(24.0, TOP - 10.0, Anchor::Start, "name", y.quantity.title());
    let limits = limits(map);
    for (index, points) in &limits {
        let line: Vec<_> = points.iter().map(|(x, y)| (column(*x), row(*y))).collect();
        svg.line(&line, "halo");
        svg.line(&line, &format!("limit limit-{index}"));
    }
    let shown: Vec<usize> = limits.iter().map(|(index, _)| *index).collect();
    let (edge, end) = legend(&mut svg, map, right + 28.0, &shown);
    svg.finish(edge.max(head) + 24.0, end.max(bottom + 62.0), title, STYLE)
}

/// The shade of a margin.
fn shade(margin: f64) -> usize {
    let step = (margin / 0.5 * SHADES as f64).floor() as usize;
    step.min(SHADES - 1)
}

/// Text colour for a letter on the colour of a fate.
fn ink(fate: Fate) -> &'static str {
    match fate {
        Fate::Start | Fate::Refused | Fate::Pulses => "letter-dark",
        _ => "letter",
    }
}

/// Settings that all cells share.
fn subtitle(map: &Map) -> String {
    let plan = &map.plan;
    let conditions = &plan.conditions;
    let mut parts = vec![
        format!(
            "system clock {} MHz",
            decimal(conditions.system_hz as f64 / 1e6, DECIMALS)
        ),
        format!(
            "{:06b}, {} bits",
            conditions.command.code(),
            conditions.position_bits
        ),
    ];
    for quantity in Quantity::ALL {
        let value = conditions.get(quantity);
        let is_axis = [plan.x.quantity, plan.y.quantity].contains(&quantity);
        if !is_axis && value != 0.0 {
            parts.push(format!(
                "{} = {}",
                quantity.name(),
                decimal(value, DECIMALS)
            ));
        }
    }
    parts.push(format!(
        "{} x {} frames in each cell",
        plan.runs, plan.frames
    ));
    parts.join(" · ")
}

/// Calls `mark` for as many values as fit.
fn ticks(
    svg: &mut Svg,
    axis: &Axis,
    step: f64,
    room: impl Fn(&str) -> f64,
    mark: impl Fn(&mut Svg, f64, &str),
) {
    let texts: Vec<String> = axis.values.iter().map(|v| decimal(*v, DECIMALS)).collect();
    let widest = texts.iter().map(|text| room(text)).fold(0.0, f64::max);
    let every = (widest / step).ceil().max(1.0) as usize;
    for (index, text) in texts.iter().enumerate().step_by(every) {
        mark(svg, index as f64, text);
    }
}

/// Published limits, by number, in map coordinates; only for maps of cable and clock.
fn limits(map: &Map) -> Vec<(usize, Vec<(f64, f64)>)> {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let swapped = match (x.quantity, y.quantity) {
        (Quantity::Cable, Quantity::Clock) => false,
        (Quantity::Clock, Quantity::Cable) => true,
        _ => return vec![],
    };
    let place = |(cable_m, clock_mhz): &(f64, f64)| match swapped {
        false => (x.place(*cable_m), y.place(*clock_mhz)),
        true => (x.place(*clock_mhz), y.place(*cable_m)),
    };
    let drawn = PUBLISHED.iter().enumerate().map(|(index, limit)| {
        let points: Vec<_> = limit.points.iter().map(place).collect();
        (index, points)
    });
    drawn.collect()
}

/// Margin, fates and limits next to the map; returns its right and lower end.
fn legend(svg: &mut Svg, map: &Map, x: f64, limits: &[usize]) -> (f64, f64) {
    let mut y = TOP + 4.0;
    let mut edge = x + 26.0 * SHADES as f64;
    let told = [
        "all frames good; smallest distance of a",
        "sample from a DATA edge, part of a bit",
    ];
    for text in told {
        svg.text(x, y, Anchor::Start, "head", text);
        edge = edge.max(x + text_width(text, 12.0) * BOLD_WIDTH);
        y += 15.0;
    }
    y -= 4.0;
    for step in 0..SHADES {
        svg.rect(x + 26.0 * step as f64, y, 26.0, 16.0, &format!("m{step}"));
    }
    for (place, text) in [(0.0, "0"), (0.5, "25 %"), (1.0, "50 %")] {
        let at = x + 26.0 * SHADES as f64 * place;
        svg.text(at, y + 30.0, Anchor::Middle, "tick", text);
    }
    y += 56.0;
    let present = |fate: &&Fate| **fate != Fate::Good && map.count(**fate) > 0;
    let present: Vec<_> = Fate::ALL.iter().filter(present).collect();
    if !present.is_empty() {
        svg.text(
            x,
            y,
            Anchor::Start,
            "head",
            "the worst that happened, otherwise",
        );
        y += 10.0;
    }
    for fate in present {
        svg.rect(x, y, 20.0, 16.0, fate.column());
        let letter = fate.letter().to_string();
        svg.text(x + 10.0, y + 12.0, Anchor::Middle, ink(*fate), &letter);
        let text = format!("{} ({} cells)", fate.title(), map.count(*fate));
        svg.text(x + 28.0, y + 12.0, Anchor::Start, "legend", &text);
        edge = edge.max(x + 28.0 + text_width(&text, 11.5));
        y += 21.0;
    }
    if !limits.is_empty() {
        y += 18.0;
        svg.text(x, y, Anchor::Start, "head", "published by others");
        y += 14.0;
    }
    for index in limits {
        svg.line(&[(x, y), (x + 20.0, y)], &format!("limit limit-{index}"));
        let text = PUBLISHED[*index].title;
        svg.text(x + 28.0, y + 4.0, Anchor::Start, "legend", text);
        edge = edge.max(x + 28.0 + text_width(text, 11.5));
        y += 20.0;
    }
    (edge, y + 16.0)
}

//! A look as plain lines.

use super::look::{Look, Seen};
use crate::read::{shown, verdict};
use endat_host::units::Scale;
use std::fmt::Write;

/// A rate, or a dash.
pub fn rate(seen: &Seen) -> String {
    seen.rate_hz.map_or("-".into(), |hz| format!("{hz:.0}"))
}

/// Where the edges were.
fn edges(edges: Option<(i8, i8)>) -> String {
    edges.map_or("none".into(), |(earliest, latest)| {
        format!("{earliest} to {latest} places from where they are expected")
    })
}

/// Names in a row, or a dash.
pub fn names(all: &[&str]) -> String {
    match all.is_empty() {
        true => "-".into(),
        false => all.join(", "),
    }
}

/// All of it.
pub fn lines(look: &Look, scales: &[Scale]) -> String {
    let mut text = String::new();
    for (channel, (seen, scale)) in look.channels.iter().zip(scales).enumerate() {
        let r = &seen.reading;
        let _ = writeln!(
            text,
            "channel {channel}  {:<28} {}",
            shown(r, scale),
            verdict(r, scale)
        );
        let _ = write!(
            text,
            "           {} results/s, age {} us",
            rate(seen),
            r.age_us
        );
        if let Some((delay_ns, recovery_us)) = seen.times {
            let _ = write!(
                text,
                ", line delay {delay_ns:.0} ns, recovery time {recovery_us:.2} us"
            );
        }
        text.push('\n');
        let infos = seen.infos();
        let infos = infos
            .map(|(n, content, status)| format!("{n}: 0x{content:04X} (status 0x{status:02X})"));
        let infos: Vec<String> = infos.collect();
        if !infos.is_empty() {
            let _ = writeln!(text, "           additional data {}", infos.join(", "));
        }
        if let Some(frames) = &seen.frames {
            let _ = write!(
                text,
                "           frames {}, good {}",
                frames.all, frames.good
            );
            for (cause, count) in &frames.causes {
                let _ = write!(text, ", {cause} {count}");
            }
            if frames.bad_infos > 0 {
                let _ = write!(
                    text,
                    "; additional data with a wrong CRC {}",
                    frames.bad_infos
                );
            }
            text.push('\n');
        }
        if let Some(state) = &seen.state {
            let _ = writeln!(text, "           state: {}", names(state));
        }
        if let Some(seen) = seen.edges {
            let _ = writeln!(text, "           edges: {}, since cleared", edges(seen));
        }
    }
    if look.retries > 0 {
        let s = if look.retries == 1 { "" } else { "s" };
        let _ = writeln!(text, "link: {} answer{s} asked for again", look.retries);
    }
    text
}

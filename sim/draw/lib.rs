//! Drawings as SVG that need no simulation: series over time, edges of DATA, waves, wiring.

mod columns;
mod decimal;
mod edges;
mod histogram;
mod opening;
mod series;
mod svg;
mod waves;
mod wiring;

pub use decimal::{decimal, mhz};
pub use edges::Edges;
pub use histogram::edges_svg;
pub use series::{series_svg, Lane, Series};
pub use svg::{is_drawing, text_width, Anchor, Svg, BOLD_WIDTH};
pub use waves::{waves_svg, Wave};
pub use wiring::{wiring_svg, WiredChannel, WiredPort};

//! Recordings: what becomes of rows of positions on their way into files, and how files are read again.
//!
//! ```text
//! Row -> Derivation -> Keep (every nth, around a fault) -> Recorder (numbered files) -> Sheet, ParquetFile
//! file -> read -> Measurement -> stats, plot
//! ```

pub mod about;
pub mod count;
pub mod derive;
pub mod files;
pub mod histogram;
pub mod keep;
pub mod layout;
pub mod lines;
pub mod parquet;
pub mod picture;
pub mod read;
pub mod recorder;
pub mod resume;
pub mod sheet;
pub mod stats;

//! The C driver as files that can be handed out beside a card.

use crate::artifact::Artifact;

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        /// Every file of the driver: its name, and its text.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../drivers/c/", $name)))),*];
    };
}

files![
    "endat.c",
    "endat.h",
    "endat_internal.h",
    "endat_map.h",
    "endat_parallel.c",
    "endat_service.c",
    "endat_settings.c",
    "endat_spi.c",
    "endat_stream.c",
    "endat_t_format.c",
    "endat_texts.c",
    "endat_transports.h",
    "endat_uart.c",
];

/// What the README of an emission says of it.
pub const ROW: &str = "| `endat.h` and the other `endat*` | driver in C99 for this and every other card, on any bus: `endat.h` documents its calls; `endat_transports.h` is for SPI, parallel bus and UART |";

/// Every file of the driver.
pub fn artifacts() -> Vec<Artifact> {
    let artifact = |(name, text): &(&str, &str)| Artifact::new(*name, *text);
    FILES.iter().map(artifact).collect()
}

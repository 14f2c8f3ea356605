//! The driver in C99 as texts, for programs that hand it out.

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        /// Every file of the driver: its name, and its text.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!($name))),*];
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

//! EnDat: the blocks that send a frame and receive its answer, and the service that maintains an encoder.
//!
//! ```text
//! trigger -> Transaction -> ClockGen ------> endat_clk
//!                |   \----> CommandSender -> data_o, data_oe
//!                |
//!                +-- LineDelay <- InputFilter <- data_i
//!                |       | sample strobes
//!                +-- Receiver -> Crc5 -> Snapshot -> result
//! ```
//!
//! Reading order: [`crate::protocol`] and [`timing`] (facts), then the blocks from left to right in the drawing, [`channel`], [`service`]. [`encoder`] is the other end of the line.

pub mod add_info;
pub mod channel;
pub mod clock_gen;
pub mod command_sender;
pub mod command_shape;
pub mod crc5;
pub mod encoder;
pub mod features;
pub mod frame_settings;
pub mod line_delay;
pub mod line_health;
pub mod line_monitor;
pub mod phase_tracker;
pub mod ports;
pub mod receiver;
pub mod second_receiver;
pub mod sequencer;
pub mod service;
pub mod timing;
pub mod transaction;

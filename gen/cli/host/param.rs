//! `param`: words of the encoder's memory.

use super::super::number::number;
use super::super::{to_json, Outcome};
use super::{channel, told, PortArgs};
use crate::error::GenError;
use clap::{Args, Subcommand};
use endat_host::mailbox::Answer;
use serde_json::json;

/// Arguments of `param`.
#[derive(Args)]
pub struct ParamArgs {
    #[command(subcommand)]
    action: Action,
}

/// Which word of which encoder.
#[derive(Args)]
struct Word {
    #[command(flatten)]
    port: PortArgs,
    /// Channel [default: 0]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    channel: Option<String>,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Memory area (MRS code), for example 0xA1
    #[arg(allow_negative_numbers = true)]
    area: String,
    /// Address in it, for example 0x0D
    #[arg(allow_negative_numbers = true)]
    address: String,
}

#[derive(Subcommand)]
enum Action {
    /// Read a word
    Read(Word),
    /// Write a word; the encoder may keep it for good
    Write {
        #[command(flatten)]
        word: Word,
        /// What is written, 0 to 0xFFFF
        #[arg(allow_negative_numbers = true)]
        value: String,
    },
}

/// Runs the command.
pub fn run(arguments: &ParamArgs) -> Result<Outcome, GenError> {
    let (word, value) = match &arguments.action {
        Action::Read(word) => (word, None),
        Action::Write { word, value } => (word, Some(number("value", value, 0..=0xFFFF)? as u16)),
    };
    let area = number("area", &word.area, 0..=0xFF)? as u8;
    let address = number("address", &word.address, 0..=0xFF)? as u8;
    let mut card = word.port.open()?;
    let channel = channel(&card, word.channel.as_deref())?;
    let answer = match value {
        None => card.read_parameter(channel, area, address),
        Some(value) => card.write_parameter(channel, area, address, value),
    };
    let Answer { data, duration, .. } = answer.map_err(told)?;
    let us = duration.as_micros() as u64;
    Ok(Outcome::good(if word.json {
        to_json(
            &json!({"channel": channel, "area": area, "address": address, "value": data, "duration_us": us}),
        )?
    } else {
        format!("channel {channel}, area 0x{area:02X}, address 0x{address:02X}: 0x{data:04X} = {data} ({us} us)\n")
    }))
}

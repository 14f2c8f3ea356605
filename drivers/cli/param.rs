//! `param`: words of the encoder's memory, and any other mode command.

use crate::port::{channel, told, PortArgs};
use clap::{Args, Subcommand};
use endat_console::error::{shown, CommandError};
use endat_console::number::{number, number_if};
use endat_host::mailbox::{Answer, Request};
use endat_terminal::outcome::{to_json, Outcome};
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
    /// Give up a request that waits for a trigger
    Cancel {
        #[command(flatten)]
        port: PortArgs,
        /// Channel [default: 0]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        channel: Option<String>,
    },
    /// Send any of the fourteen mode commands, and show what comes back
    Send {
        #[command(flatten)]
        port: PortArgs,
        /// Channel [default: 0]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        channel: Option<String>,
        /// As JSON
        #[arg(long)]
        json: bool,
        /// Mode command, six binary digits, for example 101010
        command: String,
        /// MRS code, address or port [default: 0]
        #[arg(allow_negative_numbers = true)]
        address: Option<String>,
        /// Data, 0 to 0xFFFF [default: 0]
        #[arg(allow_negative_numbers = true)]
        data: Option<String>,
    },
}

/// Runs the command.
pub fn run(arguments: &ParamArgs) -> Result<Outcome, CommandError> {
    let (word, value) = match &arguments.action {
        Action::Send {
            port,
            channel,
            json,
            command,
            address,
            data,
        } => {
            let request = Request {
                command: mode_command(command)?,
                address: number_if("address", address, 0..=0xFF)?.unwrap_or(0) as u8,
                data: number_if("data", data, 0..=0xFFFF)?.unwrap_or(0) as u16,
            };
            return send(port, channel.as_deref(), request, *json);
        }
        Action::Cancel { port, channel } => return cancel(port, channel.as_deref()),
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

/// Six binary digits.
fn mode_command(text: &str) -> Result<u8, CommandError> {
    let is_binary = text.len() == 6 && text.bytes().all(|b| matches!(b, b'0' | b'1'));
    is_binary
        .then(|| u8::from_str_radix(text, 2).unwrap_or_default())
        .ok_or_else(|| {
            CommandError::input(format!(
                "command = {}: a mode command is six binary digits; write 101010, for example",
                shown(text)
            ))
        })
}

/// What a mode command brings back by itself.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reply {
    /// It goes out with a position: EnDat 2.2, where both triplets are the same, or 111000. But not 010010.
    None,
    /// 8 and 16 bits.
    Parameter,
    /// A position.
    Position,
    /// 40 bits.
    TestValues,
}

fn reply_of(command: u8) -> Reply {
    match command {
        0b000111 => Reply::Position,
        0b010101 => Reply::TestValues,
        0b111000 => Reply::None,
        0b010010 => Reply::Parameter,
        _ if command >> 3 == command & 7 => Reply::None,
        _ => Reply::Parameter,
    }
}

fn cancel(port: &PortArgs, wanted: Option<&str>) -> Result<Outcome, CommandError> {
    let mut card = port.open()?;
    let channel = channel(&card, wanted)?;
    let said = match card.cancel_request(channel).map_err(told)? {
        true => "the request has been cancelled",
        false => "no request is under way",
    };
    Ok(Outcome::good(format!("channel {channel}: {said}\n")))
}

fn send(
    port: &PortArgs,
    wanted: Option<&str>,
    request: Request,
    as_json: bool,
) -> Result<Outcome, CommandError> {
    let mut card = port.open()?;
    let channel = channel(&card, wanted)?;
    let Answer {
        address,
        data,
        bits,
        duration,
    } = card.request(channel, request).map_err(told)?;
    let us = duration.as_micros() as u64;
    let command = format!("{:06b}", request.command);
    let reply = reply_of(request.command);
    Ok(Outcome::good(if as_json {
        let parts = (reply == Reply::Parameter).then_some((address, data));
        let (address, data) = parts.unzip();
        let answer = (reply != Reply::None).then_some(bits);
        to_json(
            &json!({"channel": channel, "command": command, "address": address, "data": data, "answer": answer, "duration_us": us}),
        )?
    } else {
        let said = match reply {
            Reply::Parameter => format!("8 bits 0x{address:02X}, 16 bits 0x{data:04X}"),
            Reply::Position => format!("position 0x{bits:X} = {bits}"),
            Reply::TestValues => format!("40 bits 0x{bits:010X}"),
            Reply::None => {
                "sent with a position; what the encoder answers comes as additional data".into()
            }
        };
        format!("channel {channel}, {command}: {said} ({us} us)\n")
    }))
}

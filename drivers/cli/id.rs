//! `id`: who the card is, and the name plates of its encoders.

use crate::port::{long, told, PortArgs};
use clap::Args;
use endat_console::error::CommandError;
use endat_host::card::Identity;
use endat_host::name_plate::Told;
use endat_host::name_plate::{step_name, NamePlate};
use endat_regs::{Named, Part, Protocol};
use endat_terminal::outcome::{to_json, Outcome};
use serde_json::{json, Value};
use std::fmt::Write;

/// Arguments of `id`.
#[derive(Args)]
pub struct IdArgs {
    #[command(flatten)]
    port: PortArgs,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &IdArgs) -> Result<Outcome, CommandError> {
    let mut card = arguments.port.open()?;
    let identity = *card.identity();
    let reads_plates = identity.has(Part::Initialise);
    card.wait_until_initialised(long).map_err(told)?;
    let mut encoders = Vec::new();
    for channel in 0..identity.channels {
        encoders.push(match card.ask_encoder(channel).map_err(told)? {
            Some(reply) => Encoder::Other(identity.protocol(channel), reply),
            None => match identity.protocol(channel) {
                Protocol::Endat if reads_plates => {
                    let plate = card.name_plate(channel).map_err(told)?;
                    Encoder::Endat(plate.into())
                }
                Protocol::Endat => Encoder::NotRead,
                other => Encoder::Mute(other),
            },
        });
    }
    let is_good = encoders.iter().all(|encoder| match encoder {
        Encoder::Endat(plate) => plate.initialised,
        Encoder::Other(_, reply) => reply.is_ok(),
        Encoder::NotRead | Encoder::Mute(_) => true,
    });
    let stdout = if arguments.json {
        to_json(&as_json(&identity, &encoders))?
    } else {
        as_text(&identity, &encoders)
    };
    Ok(Outcome {
        exit_code: u8::from(!is_good),
        ..Outcome::good(stdout)
    })
}

/// What is known about the encoder of a channel.
enum Encoder {
    /// An EnDat encoder on a card that does not initialise it.
    NotRead,
    /// An EnDat encoder.
    Endat(Box<NamePlate>),
    /// One of another protocol, which sends nothing but positions.
    Mute(Protocol),
    /// One of another protocol, which has no name plate: what it has told, or why it has not.
    Other(Protocol, Result<Told, String>),
}

fn version(identity: &Identity) -> String {
    identity.version.map(|n| n.to_string()).join(".")
}

fn as_text(identity: &Identity, encoders: &[Encoder]) -> String {
    let mut text = format!(
        "card                {} channel{}, positions to {} bits, system clock {} Hz\n\
         register map        {}\nconfiguration       {:08x}\n",
        identity.channels,
        if identity.channels == 1 { "" } else { "s" },
        identity.max_position_bits,
        identity.system_hz,
        version(identity),
        identity.configuration_hash
    );
    for Named { name, meaning, .. } in identity.parts().map(Part::named) {
        let _ = writeln!(text, "part                {name}: {meaning}");
    }
    for (channel, encoder) in encoders.iter().enumerate() {
        match encoder {
            Encoder::NotRead => {
                let _ = writeln!(
                    text,
                    "\nencoder {channel}\n  type              EnDat, not read: the card has no part initialise"
                );
            }
            Encoder::Mute(protocol) => {
                let _ = write!(text, "\nencoder {channel}\n{}", without_plate(*protocol));
            }
            Encoder::Endat(plate) => {
                let plate = plate_text(plate, identity.system_hz);
                let _ = write!(text, "\nencoder {channel}\n{plate}");
            }
            Encoder::Other(protocol, reply) => {
                let reply = other_text(*protocol, reply);
                let _ = write!(text, "\nencoder {channel}\n{reply}");
            }
        }
    }
    text
}

/// The only line about an encoder that sends nothing but positions, and the first one about others without a name plate.
fn without_plate(protocol: Protocol) -> String {
    format!(
        "  type              {}, which has no name plate\n",
        protocol.name()
    )
}

/// The answer of an encoder without a name plate, in the form of one.
pub fn other_text(protocol: Protocol, reply: &Result<Told, String>) -> String {
    let mut text = without_plate(protocol);
    let lines = match reply {
        Ok(told) => told.lines.clone(),
        Err(why) => vec![("does not tell", why.clone())],
    };
    for (head, says) in lines {
        let _ = writeln!(text, "  {head:<17} {says}");
    }
    text
}

fn other_json(reply: &Result<Told, String>) -> Value {
    let mut all = json!({ "error": reply.as_ref().err() });
    for (name, number) in reply.iter().flat_map(|told| &told.fields) {
        all[*name] = json!(number);
    }
    all
}

/// Name of a step.
fn step(number: u16) -> String {
    format!("step {number} ({})", step_name(number))
}

/// A line of a name plate, if there is something to say.
fn add_line(text: &mut String, name: &str, value: Option<String>) {
    if let Some(value) = value {
        let _ = writeln!(text, "  {name:<18}{value}");
    }
}

/// A name plate, a line for each thing that is known.
pub fn plate_text(plate: &NamePlate, system_hz: u32) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value| add_line(&mut text, name, value);
    let state = match (plate.initialised, plate.failed, plate.step) {
        (true, ..) => "yes".to_owned(),
        (_, Some(failed), _) => format!("no: {} failed; is the encoder plugged in?", step(failed)),
        (_, _, Some(now)) => format!("under way: {}", step(now)),
        _ => "no".to_owned(),
    };
    line("initialised", Some(state));
    line(
        "type",
        plate.rotary.map(|rotary| {
            let kind = if rotary { "rotary" } else { "linear" };
            let endat = if plate.endat22 {
                "EnDat 2.2"
            } else {
                "EnDat 2.1"
            };
            let safety = if plate.safety == Some(true) {
                ", functional safety"
            } else {
                ""
            };
            format!("{kind}, {endat}{safety}")
        }),
    );
    line(
        "position",
        plate.position_bits.map(|bits| format!("{bits} bits")),
    );
    // The drivers print the same lines.
    let _ = write!(text, "{}", plate.driver);
    let mut line = |name: &str, value| add_line(&mut text, name, value);
    line(
        "tcal",
        plate
            .tcal
            .map(|tcal| format!("{tcal} (word 39; its unit is not published)")),
    );
    line(
        "fastest clock",
        plate.clock_max_khz.map(|khz| format!("{khz} kHz")),
    );
    line(
        "recovery time tm",
        plate.short_recovery.map(|short| {
            let range = if short {
                "1.25 to 3.75 us"
            } else {
                "10 to 30 us"
            };
            range.to_owned()
        }),
    );
    let codes = |bits: u16, first: u8| {
        let set = (0..16).filter(|n| bits >> n & 1 == 1);
        set.map(|n| format!("{:02X}", first + n))
            .collect::<Vec<_>>()
            .join(" ")
    };
    line(
        "additional data 1",
        plate.infos_1.map(|bits| codes(bits, 0x40)),
    );
    line(
        "additional data 2",
        plate.infos_2.map(|bits| codes(bits, 0x50)),
    );
    line(
        "alarms at start",
        plate.alarms.map(|bits| format!("0x{bits:04X}")),
    );
    line(
        "warnings at start",
        plate.warnings.map(|bits| format!("0x{bits:04X}")),
    );
    line(
        "line delay",
        plate.delay_cycles.map(|cycles| {
            let ns = f64::from(cycles) * 1e9 / f64::from(system_hz.max(1));
            format!("{cycles} system clocks, {ns:.0} ns, with synchroniser and filter")
        }),
    );
    text
}

fn as_json(identity: &Identity, encoders: &[Encoder]) -> Value {
    let plate = |p: &NamePlate| {
        json!({
            "initialised": p.initialised,
            "failed_step": p.failed,
            "endat22": p.endat22,
            "position_bits": p.position_bits,
            "rotary": p.rotary,
            "steps": p.steps,
            "revolutions": p.revolutions,
            "signal_periods": p.signal_periods,
            "id": p.id,
            "serial": p.serial,
            "safety": p.safety,
            "tcal_word": p.tcal,
            "clock_max_khz": p.clock_max_khz,
            "short_recovery": p.short_recovery,
            "infos_1": p.infos_1,
            "infos_2": p.infos_2,
            "alarms": p.alarms,
            "warnings": p.warnings,
            "delay_cycles": p.delay_cycles,
        })
    };
    let encoder = |(channel, encoder): (usize, &Encoder)| {
        let (protocol, told) = match encoder {
            Encoder::NotRead => ("endat", json!({ "initialised": null })),
            Encoder::Endat(p) => ("endat", plate(p)),
            Encoder::Mute(protocol) => (protocol.row().word, json!({})),
            Encoder::Other(protocol, reply) => (protocol.row().word, other_json(reply)),
        };
        let mut all = json!({ "channel": channel, "protocol": protocol });
        if let (Value::Object(all), Value::Object(told)) = (&mut all, told) {
            all.extend(told);
        }
        all
    };
    json!({
        "channels": identity.channels,
        "max_position_bits": identity.max_position_bits,
        "system_hz": identity.system_hz,
        "register_map": version(identity),
        "configuration": format!("{:08x}", identity.configuration_hash),
        "parts": identity.parts().map(|part| part.named().name).collect::<Vec<_>>(),
        "encoders": encoders.iter().enumerate().map(encoder).collect::<Vec<_>>(),
    })
}

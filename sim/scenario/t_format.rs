//! A T-format scenario: exchanges of triggers and of the host, one of them corrupted.

use crate::{
    bench::{Bench, ChannelResult, PinNames, TFormatLink},
    t_format::{Defect, EncoderConfig},
    Time, MS, US,
};
use endat_hdl::protocols::t_format::{
    cause,
    port::word,
    protocol::{Request, BIT_HZ, REPLY_GAP_US_MAX},
};
use endat_hdl::regs::Protocol;
use rtl_design::engine::Engine;
use std::fmt;

/// Name on the command line.
pub const NAME: &str = "t-format";
/// Summary.
pub const SUMMARY: &str =
    "a T-format encoder at 2.5 Mbit/s: positions, kind, a wrong check sum, a byte of the EEPROM written and read";
/// System clock in hertz.
pub const SYSTEM_HZ: u64 = 40_000_000;

/// An exchange, and its expected cause.
struct Exchange {
    request: Request,
    defect: Defect,
    /// Address and data of a host request.
    memory: (u8, u8),
    cause: u64,
}

const fn asked(request: Request) -> Exchange {
    Exchange {
        request,
        defect: Defect::None,
        memory: (0x10, 0x5A),
        cause: cause::NONE,
    }
}

/// All exchanges.
const EXCHANGES: [Exchange; 7] = [
    asked(Request::SingleTurn),
    asked(Request::Everything),
    asked(Request::MultiTurn),
    asked(Request::EncoderId),
    Exchange {
        defect: Defect::Flip { field: 3, bit: 2 },
        cause: cause::CRC,
        ..asked(Request::Everything)
    },
    asked(Request::WriteEeprom),
    asked(Request::ReadEeprom),
];
const PERIOD: Time = 200 * US;
/// Timeout from request to answer.
const PATIENCE: Time = MS;
/// Delay of about ten metres of cable.
const DELAY: Time = US / 20;

/// Report of an exchange.
#[derive(Clone, Debug)]
pub struct ExchangeReport {
    /// Time of the request.
    pub time: Time,
    /// The request.
    pub request: Request,
    /// Bytes received by the encoder.
    pub sent: Vec<u8>,
    /// The encoder's reply before corruption.
    pub reply: Vec<u8>,
    /// The result of a trigger.
    pub result: Option<ChannelResult>,
    /// The answer word of a host request.
    pub answer: Option<u64>,
}

impl ExchangeReport {
    /// Code of the cause; `None` without an answer.
    pub fn cause(&self) -> Option<u64> {
        let answer = self.answer.map(|word| word >> 12 & 15);
        self.result.as_ref().map(|r| r.last_cause()).or(answer)
    }

    /// Name of the cause.
    pub fn cause_name(&self) -> &'static str {
        match self.cause() {
            None => "no answer",
            Some(0) => "good",
            Some(code) => (Protocol::TFormat.row().coded)
                .iter()
                .find(|c| u64::from(c.number) == code)
                .map_or("unknown", |c| c.name),
        }
    }
}

/// Report of the scenario, with the faults.
#[derive(Clone, Debug)]
pub struct TFormatReport {
    /// All exchanges.
    pub exchanges: Vec<ExchangeReport>,
    /// All faults; empty for a good run.
    pub complaints: Vec<String>,
}

/// Runs the scenario on a block `EncoderPort` for T-format, with its link recorded.
pub fn run<E: Engine>(engine: E) -> (Bench<E>, TFormatReport) {
    let mut bench = Bench::new(engine, SYSTEM_HZ, vec![]);
    let config = EncoderConfig {
        single_turn: 0x12_3456,
        multi_turn: 0x00_0789,
        status: 0,
        alarm: 0,
        write_time: PERIOD / 2,
        ..EncoderConfig::default()
    };
    let mut link = TFormatLink::new(config, DELAY);
    link.record();
    bench.add_t_format(&PinNames::channel(), link);
    for name in ["trigger", "busy", "result_strobe", "cause", "position"] {
        bench.watch(name);
    }
    bench.set("period_cycles", (SYSTEM_HZ / BIT_HZ).into());
    bench.set("start_timeout_us", (REPLY_GAP_US_MAX / 6).into());
    bench.set("field_gap_us", 1);
    bench.power_up();
    let mut report = TFormatReport {
        exchanges: vec![],
        complaints: vec![],
    };
    for (n, exchange) in EXCHANGES.iter().enumerate() {
        bench.run_until(PERIOD * (n as Time + 1));
        let told = one(&mut bench, exchange);
        if told.cause() != Some(exchange.cause) {
            let (id, name) = (exchange.request.id(), told.cause_name());
            report
                .complaints
                .push(format!("exchange {n}, request {id:X}: {name}"));
        }
        report.exchanges.push(told);
    }
    let violations = bench.t_format(0).encoder().violations();
    let violations = violations.iter().map(|v| format!("encoder: {v:?}"));
    report.complaints.extend(violations);
    bench.run_for(PERIOD / 4);
    (bench, report)
}

fn one<E: Engine>(bench: &mut Bench<E>, exchange: &Exchange) -> ExchangeReport {
    let request = exchange.request;
    let encoder = bench.t_format_mut(0).encoder_mut();
    encoder.config.defect = exchange.defect;
    let (heard, replied) = (encoder.requests().len(), encoder.replies().len());
    let time = bench.now();
    let (mut result, mut answer) = (None, None);
    if matches!(request, Request::WriteEeprom | Request::ReadEeprom) {
        let (address, data) = exchange.memory;
        bench.set("host_address", word::SEND.into());
        for (half, value) in [
            (1, request.id().into()),
            (0, u16::from_be_bytes([address, data])),
        ] {
            bench.set("host_half", half);
            bench.set("host_data", value.into());
            bench.set("host_write", 1);
            bench.run_cycles(1);
            bench.set("host_write", 0);
            bench.run_cycles(1);
        }
        if bench.run_until_done(PATIENCE, |b| b.get("over") == 1) {
            bench.run_cycles(2);
            bench.set("host_address", word::ANSWER.into());
            bench.set("host_read", 1);
            bench.run_cycles(1);
            bench.set("host_read", 0);
            bench.run_cycles(2);
            answer = Some(bench.get("host_word") as u64);
        }
    } else {
        bench.set("request_id", request.id().into());
        bench.run_cycles(1);
        result = bench.frame(PATIENCE);
    }
    let encoder = bench.t_format(0).encoder();
    let new = |all: &[Vec<u8>], from: usize| all.get(from).cloned().unwrap_or_default();
    ExchangeReport {
        time,
        request,
        sent: new(encoder.requests(), heard),
        reply: new(encoder.replies(), replied),
        result,
        answer,
    }
}

/// Bytes as hexadecimal text.
fn hex(bytes: &[u8]) -> String {
    let bytes = bytes.iter().map(|b| format!("{b:02X}"));
    bytes.collect::<Vec<_>>().join(" ")
}

impl fmt::Display for TFormatReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{SUMMARY}\n")?;
        writeln!(
            f,
            "    time us  ID  request      reply                             position        result"
        )?;
        for e in &self.exchanges {
            let position = e.result.as_ref().filter(|r| r.fresh);
            let position = position.map_or("-".into(), |r| format!("{:#014X}", r.position));
            writeln!(
                f,
                "{:>11.3}   {:X}  {:<11}  {:<32}  {position:<14}  {}",
                e.time as f64 / US as f64,
                e.request.id(),
                hex(&e.sent),
                hex(&e.reply),
                e.cause_name()
            )?;
        }
        match self.complaints.is_empty() {
            true => writeln!(f, "\nall as it should be"),
            false => self.complaints.iter().try_for_each(|c| writeln!(f, "{c}")),
        }
    }
}

//! What is measured: the card of the preset, one channel, and some of its blocks.

use endat_config::{load_preset, DEFAULT_PRESET};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_emit::sources;
use endat_hdl::card::bus::{
    apb::ApbCard, axi_lite::AxiLiteCard, parallel::ParallelCard, spi::SpiCard,
    wishbone::WishboneCard,
};
use endat_hdl::card::direct::DirectOutput;
use endat_hdl::card::interrupt::Interrupt;
use endat_hdl::card::recovery_counter::RecoveryCounter;
use endat_hdl::card::second_interface::{record::SecondRecord, SecondInterface};
use endat_hdl::card::stream::{buffer::SetParts, channel::SetChannel, Stream};
use endat_hdl::card::Card;
use endat_hdl::config::CardConfig;
use endat_hdl::encoder_port::EncoderPort;
use endat_hdl::endat::channel::{Channel, Features, FixedTimes};
use endat_hdl::endat::crc5::{Crc5Check, Crc5Fixed, Crc5Word};
use endat_hdl::endat::line_delay::LineDelay;
use endat_hdl::endat::line_monitor::LineStart;
use endat_hdl::endat::receiver::Receiver;
use endat_hdl::endat::second_receiver::SecondReceiver;
use endat_hdl::endat::service::program::ServiceTimes;
use endat_hdl::endat::transaction::{cause, Transaction};
use endat_hdl::protocols::t_format::{
    channel::TFormatChannel,
    dsp::{AsyncDsp, TFormatStart},
    port::TFormatPort,
};
use endat_hdl::snapshot::{Snapshot, Withdrawal};
use endat_regs::Protocol;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;

/// A design whose area is measured.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name; also that of the top module.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// The design.
    pub design: Design,
}

impl Subject {
    fn new(
        name: &'static str,
        title: &'static str,
        mut block: impl Block,
    ) -> Result<Self, CommandError> {
        block.connect_all();
        let design = elaborate(&block, name).map_err(|e| CommandError::fault(name, &e))?;
        Ok(Self {
            name,
            title,
            design,
        })
    }

    /// Its Verilog.
    pub fn files(&self) -> Vec<Artifact> {
        sources::untitled(&self.design)
    }
}

/// A channel's features, but for what is changed.
fn part(change: impl FnOnce(&mut Features)) -> Features {
    let mut features = Features::default();
    change(&mut features);
    features
}

/// Everything that is measured, the largest first.
pub fn subjects() -> Result<Vec<Subject>, CommandError> {
    let card = load_preset(DEFAULT_PRESET)?.card;
    let times = FixedTimes::at(card.system_hz);
    let mut subjects = cards(&card)?;
    subjects.extend(ports(times, card.system_hz)?);
    subjects.extend(parts(times, card.stream.fifo_bytes)?);
    Ok(subjects)
}

/// Cards, behind each bus.
fn cards(streaming: &CardConfig) -> Result<Vec<Subject>, CommandError> {
    // The others are measured without the stream, so that each row says what it costs by itself.
    let mut card = streaming.clone();
    card.stream = Default::default();
    let full = load_preset("s6_two_channel_service")?.card;
    let mut unguarded = full.clone();
    unguarded.safety.upset_guards = false;
    let mixed = load_preset("mixed_protocols")?.card;
    Ok(vec![
        Subject::new("card_service", "the card with everything", Card::new(&full))?,
        Subject::new(
            "card_unguarded",
            "the same without guards against upsets",
            Card::new(&unguarded),
        )?,
        Subject::new(
            "card",
            "two-channel card without its stream",
            Card::new(&card),
        )?,
        Subject::new(
            "card_mixed",
            "the same with T-format on its second channel (mixed_protocols)",
            Card::new(&mixed),
        )?,
        Subject::new(
            "card_stream",
            "two-channel card s6_two_channel, with its stream of 2048 bytes",
            Card::new(streaming),
        )?,
        Subject::new("card_apb", "the same behind APB3", ApbCard::new(&card))?,
        Subject::new(
            "card_wishbone",
            "the same behind Wishbone",
            WishboneCard::new(&card),
        )?,
        Subject::new(
            "card_axi_lite",
            "the same behind AXI4-Lite",
            AxiLiteCard::new(&card),
        )?,
        Subject::new("card_spi", "the same behind SPI", SpiCard::new(&card))?,
        Subject::new(
            "card_parallel",
            "the same behind the parallel bus",
            ParallelCard::new(&card),
        )?,
    ])
}

/// Receivers, ports and channels with what they may have.
fn ports(times: FixedTimes, system_hz: u64) -> Result<Vec<Subject>, CommandError> {
    let service = |is_all| {
        let service = ServiceTimes {
            diagnosis: is_all,
            continuous: is_all,
            ..ServiceTimes::at(system_hz)
        };
        EncoderPort::new(times, Some(&service), false)
    };
    Ok(vec![
        Subject::new(
            "async_dsp",
            "T-format receiver behind the bus of a signal processor",
            AsyncDsp::new(&TFormatStart::default(), false),
        )?,
        Subject::new("t_format", "T-format receiver", TFormatChannel::new(false))?,
        Subject::new(
            "t_format_port",
            "one T-format port of a card",
            TFormatPort::new(false),
        )?,
        Subject::new("channel", "one position channel", Channel::new(times))?,
        Subject::new(
            "channel_restore",
            "the same that shows the position before again when one is withdrawn, as in a card",
            Channel::with(times, part(|f| f.restore = true)),
        )?,
        Subject::new(
            "channel_guards",
            "the same with guards against upsets",
            Channel::with(times, Features::GUARDED),
        )?,
        Subject::new("port_all", "one port with everything", service(true))?,
        Subject::new(
            "port_service",
            "one port with requests; initialisation is only another program",
            service(false),
        )?,
        Subject::new(
            "channel_all",
            "position channel with all of what follows, without service",
            Channel::with(
                times,
                Features {
                    restore: false,
                    ..Features::PROTOCOL
                },
            ),
        )?,
        Subject::new(
            "channel_requests",
            "position channel with all mode commands and additional data, without service",
            Channel::with(times, part(|f| f.requests = true)),
        )?,
        Subject::new(
            "channel_diagnosis",
            "position channel with line diagnosis and watchdog",
            Channel::with(times, part(|f| f.diagnosis = true)),
        )?,
        Subject::new(
            "channel_continuous",
            "position channel with continuous clock",
            Channel::with(times, part(|f| f.continuous = true)),
        )?,
        Subject::new(
            "channel_alignment",
            "position channel with the three sources of its phase, and majority of three",
            Channel::with(times, part(|f| f.alignment = true)),
        )?,
        Subject::new(
            "channel_double_edge",
            "the same with double edge",
            Channel::with(times, part(|f| (f.alignment, f.double_edge) = (true, true))),
        )?,
        Subject::new(
            "port_margin",
            "one port with alignment and margin, without service",
            EncoderPort::with_line(
                times,
                None,
                false,
                part(|f| (f.alignment, f.margin) = (true, true)),
                LineStart::default(),
            ),
        )?,
    ])
}

/// Blocks by themselves.
fn parts(times: FixedTimes, fifo_bytes: u64) -> Result<Vec<Subject>, CommandError> {
    Ok(vec![
        Subject::new(
            "transaction",
            "order and time-outs",
            Transaction::new(times, Features::default()),
        )?,
        Subject::new(
            "line_delay",
            "propagation delay",
            LineDelay::new(Features::NONE),
        )?,
        Subject::new("receiver", "receiver", Receiver::new(Features::default()))?,
        Subject::new(
            "stream",
            "stream with a buffer of 2048 bytes, without the channels' parts",
            Stream::new(fifo_bytes, 2, false, false, SetParts::default()),
        )?,
        Subject::new(
            "set_channel",
            "a channel's part of it",
            SetChannel::new(0, Protocol::Endat, false, SetParts::default(), false),
        )?,
        Subject::new(
            "direct_output",
            "direct outputs of a channel: crop, error",
            DirectOutput::new(0, 29),
        )?,
        Subject::new("irq", "interrupt of two channels", Interrupt::new(2))?,
        Subject::new(
            "second_interface",
            "SPI of the second interface, without its records",
            SecondInterface::new(2, 0x1234_5678),
        )?,
        Subject::new(
            "second_record",
            "record of a channel for the second interface",
            SecondRecord::new(0),
        )?,
        Subject::new(
            "second_receiver",
            "second receiver of a channel, and the comparison",
            SecondReceiver::new(Features::NONE),
        )?,
        Subject::new(
            "recovery_counter",
            "recovery time of a channel, measured a second time",
            RecoveryCounter::new(0),
        )?,
        Subject::new(
            "snapshot",
            "snapshot with time stamp",
            Snapshot::new(
                Withdrawal::Restores,
                false,
                cause::UPSET,
                cause::flag(cause::UPSET),
            ),
        )?,
        Subject::new(
            "crc5_parallel",
            "CRC5, parallel, any length to 50 bits",
            Crc5Word::default(),
        )?,
        Subject::new(
            "crc5_fixed_31",
            "CRC5, parallel, 31 bits",
            Crc5Fixed::<31>::default(),
        )?,
        Subject::new(
            "crc5_stored",
            "CRC5 of the stored word, a guard",
            Crc5Check::default(),
        )?,
    ])
}

//! Builds a card from its configuration: the number of each block.

use super::*;
use crate::replicate::numbered;

impl CardCore {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        Self::with_times(config, &service_times(config))
    }

    /// A card with other waiting times of its services.
    pub fn with_times(config: &CardConfig, service: &ServiceTimes) -> Self {
        let n = Counts::of(config);
        let is_endat = |i: usize| config.channels[i].is_endat();
        Self::from_parts(CardCoreParts {
            direct_position_o: each(n.direct_ports),
            direct_valid_o: each(n.direct_ports),
            direct_fresh_o: each(n.direct_ports),
            direct_error_o: each(n.direct_ports),
            second_sck_i: each(n.seconds),
            second_cs_n_i: each(n.seconds),
            second_miso_o: each(n.seconds),
            second_miso_oe: each(n.seconds),
            endat_clk_o: each(n.channels),
            endat_data_o: each(n.channels),
            endat_data_oe: each(n.channels),
            endat_data_i: each(n.channels),
            led_channel_o: each(n.channels),
            timebase: Timebase::new(config.system_hz),
            own_trigger: channel_triggers(config, n.own_triggers),
            trigger_of: each(n.channels),
            is_off: each(n.channels),
            bank: RegisterBank::new(config),
            registers: numbered(n.channels, |i| ChannelRegisters::new(config, i)),
            port: numbered(n.channels, |i| port(config, i, service)),
            whole: numbered(n.served, |i| {
                WholeResult::new(i, is_endat(i), config.safety.second_interface)
            }),
            info_byte: each(n.served + 1),
            set_open: each(n.set_infos + 1),
            service: numbered(n.services, |i| {
                Service::new(service, n.served - i * CHANNELS_SERVED)
            }),
            stream: numbered(n.streams, |_| {
                let start = config.stream.start;
                let (collect, push) = (start.collects(), start.pushes());
                Stream::new(config.stream.fifo_bytes, n.channels, collect, push, n.parts)
            }),
            set: numbered(n.sets, |i| {
                SetChannel::new(
                    i,
                    config.channels[i].protocol(),
                    n.own_triggers != 0,
                    n.parts,
                    config.safety.upset_guards,
                )
            }),
            set_byte: each(n.sets + n.streams),
            set_owes: each(n.sets + n.streams),
            set_replaced: each(n.sets + n.streams),
            set_taken: each(n.streams),
            set_block: each(n.streams),
            set_byte_at: each(n.streams),
            run: numbered(n.runs, RunChannel::new),
            run_ready: each(n.runs + 1),
            run_sequence: each(n.runs + 1),
            run_timestamp: each(n.runs + 1),
            run_head: each(n.runs + 1),
            run_place: each(n.runs + 1),
            run_lost: each(n.runs + 1),
            direct: numbered(n.directs, |i| {
                DirectOutput::new(i, config.channels[i].position_bits)
            }),
            interrupt: numbered(n.interrupts, |_| Interrupt::new(n.channels)),
            direct_byte: each(n.directs + 1),
            part_byte: each(3),
            recovery: numbered(n.recoveries, RecoveryCounter::new),
            recovery_byte: each(n.recoveries + 1),
            second: numbered(n.seconds, |_| {
                SecondInterface::new(n.channels, config.hash >> 16)
            }),
            record: numbered(n.records, SecondRecord::new),
            record_link: each(n.records + n.seconds),
            ring_link: each(n.channels + 1),
            read_link: each(n.channels + 1),
            service_link: each(n.channels + 1),
            selected: each(n.channels),
            io_address: each(n.services * CHANNELS_SERVED),
            io_read: each(n.served),
            io_in: each(n.served),
            io_out: each(n.services * CHANNELS_SERVED),
            io_write: each(n.served),
            word_link: each(n.services + 1),
            taken: each(n.channels + 1),
            owes: each(n.channels + 1),
            brought: each(n.channels + 1),
            faulty: each(n.channels + 1),
            slow_bit: Constant::new(blink_bit(config.system_hz, 1).into()),
            quick_bit: Constant::new(blink_bit(config.system_hz, 8).into()),
            _channels: n.channels,
            _links: n.channels + 1,
            _own_triggers: n.own_triggers,
            _streams: n.streams,
            _sets: n.sets,
            _set_links: n.sets + n.streams,
            _infos: n.served,
            _set_ends: if n.set_infos == 0 { 0 } else { n.set_infos + 1 },
            _info_interrupts: n.served * n.interrupts,
            _info_links: if n.served == 0 { 0 } else { n.served + 1 },
            _set_infos: n.set_infos,
            _plain_sets: n.plain_sets,
            _runs: n.runs,
            _run_sets: if n.parts.runs { n.sets } else { 0 },
            _run_links: if n.runs == 0 { 0 } else { n.runs + 1 },
            _directs: n.directs,
            _direct_links: n.directs + 1,
            _direct_ports: n.direct_ports,
            _interrupts: n.interrupts,
            _seconds: n.seconds,
            _records: n.records,
            _record_links: n.records + n.seconds,
            _record_infos: n.records.min(n.served),
            _recoveries: n.recoveries,
            _recovery_links: n.recoveries + 1,
            _served: n.served,
            _services: n.services,
            _pairs: n.served / CHANNELS_SERVED,
            _service_links: n.services + 1,
            _interrupt_channels: n.channels * n.interrupts,
        })
    }
}

/// Number of blocks of each kind.
struct Counts {
    channels: usize,
    own_triggers: usize,
    streams: usize,
    sets: usize,
    directs: usize,
    direct_ports: usize,
    interrupts: usize,
    recoveries: usize,
    seconds: usize,
    records: usize,
    served: usize,
    services: usize,
    runs: usize,
    set_infos: usize,
    plain_sets: usize,
    parts: SetParts,
}

impl Counts {
    fn of(config: &CardConfig) -> Self {
        let channels = config.channels.len();
        let streams = usize::from(config.stream.fifo_bytes != 0);
        let sets = channels * streams;
        let seconds = usize::from(config.safety.second_interface);
        let served = served_channels(config);
        let parts = SetParts {
            additional_data: config.stream.additional_data,
            runs: config.service.continuous && streams != 0,
        };
        let with = |part: bool, n: usize| if part { n } else { 0 };
        Self {
            channels,
            own_triggers: with(config.own_triggers(), channels),
            streams,
            sets,
            directs: with(config.outputs.any(), channels),
            direct_ports: with(config.outputs.position, channels),
            interrupts: config.outputs.interrupt.into(),
            recoveries: with(config.safety.recovery_counter, channels),
            seconds,
            records: channels * seconds,
            served,
            services: services(config),
            runs: with(parts.runs, served),
            set_infos: with(parts.additional_data, served),
            plain_sets: with(parts.additional_data, sets),
            parts,
        }
    }
}

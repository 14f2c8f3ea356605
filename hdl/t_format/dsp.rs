//! T-format receiver behind the 16-bit bus of a signal processor.
//!
//! ```text
//! bus pins --BusStrobes--> request, settings --> TFormatChannel <-> transceiver
//! bus_data_o <-- two registers <-- seven-address map <-- moment of the last read of address 0
//! ```
//!
//! | address | read 7..0 | read 15..8 | write |
//! |---|---|---|---|
//! | 0 | request ID | 0 | 3:0 request ID; sends it, 6 only once for each write of address 7 |
//! | 1 | control data | single-turn 7..0 | |
//! | 2 | single-turn 15..8 | single-turn 23..16 | |
//! | 3 | encoder ID | multi-turn 7..0 | |
//! | 4 | multi-turn 15..8 | multi-turn 23..16 | |
//! | 5 | alarms (ALMC) | status (SF) | |
//! | 6 | CRC | communication alarm | settings: 5:0 reply gap in us, 8 fast rate, 11:9 field gap in us, 15:12 filter in clocks |
//! | 7 | EEPROM data | 11:8 cause, 12 and 13 single- and multi-turn valid, 14 trigger overrun, 15 busy | 6:0 EEPROM address, 15:8 EEPROM data |
//!
//! Control data: 3:0 ID of the reply, 4 it is that of the request, 5 communication alarm, 7 fresh. Communication alarm: 0 no
//! answer, 1 no header, 2 field missing, 3 delimiter, 4 parity, 5 another ID, 6 CRC, 7 the encoder complains.
//!
//! Data stand at the pins 4 clocks after the address and change 4 clocks after it changes. Reading address 0 takes the moment that
//! addresses 1 to 7 show, bit 15 of address 7 excepted. While that bit is set writes are ignored, but a request counts as trigger.

use super::channel::TFormatChannel;
use super::primary::LowestCause;
use super::protocol::{BIT_HZ, FAST_BIT_HZ, SYSTEM_HZ};
use crate::bus::strobes::BusStrobes;
use crate::reg::{Reg, SyncReg};
use endat_macros::{kernel, Block};
use rust_hdl::prelude::*;

/// What a T-format receiver starts with; all of it can be set by the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TFormatStart {
    /// 5 Mbit/s instead of 2.5 Mbit/s.
    pub fast: bool,
    /// Longest pause before a reply, in microseconds, 1 to 63.
    pub reply_gap_us: u64,
    /// Longest pause between two fields, in microseconds, 0 to 7.
    pub field_gap_us: u64,
    /// Pulses of at most this many system clock cycles are ignored, 0 to 15.
    pub filter_cycles: u64,
    /// Request ID before one is written.
    pub request_id: u8,
}

impl Default for TFormatStart {
    fn default() -> Self {
        Self {
            fast: false,
            reply_gap_us: 20,
            field_gap_us: 2,
            filter_cycles: 1,
            request_id: 3,
        }
    }
}

impl TFormatStart {
    /// The word of address 6.
    pub fn word(&self) -> u64 {
        self.reply_gap_us
            | u64::from(self.fast) << 8
            | self.field_gap_us << 9
            | self.filter_cycles << 12
    }
}

/// Asynchronous receiver with its bus.
#[derive(LogicBlock, Block)]
pub struct AsyncDsp {
    /// System clock, 20 or 60 MHz.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// The clock is one of 60 MHz; low = 20 MHz. A strap: it does not change while the receiver runs.
    pub clk_select_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge sends the last request again, unless it writes to the EEPROM.
    pub trigger_i: Signal<In, Bit>,
    /// Chip select, active low, asynchronous.
    pub bus_cs_n_i: Signal<In, Bit>,
    /// Read strobe, active low, asynchronous.
    pub bus_rd_n_i: Signal<In, Bit>,
    /// Write strobe, active low, asynchronous; its rising edge writes.
    pub bus_wr_n_i: Signal<In, Bit>,
    /// Address A2..A0, asynchronous.
    pub bus_address_i: Signal<In, Bits<3>>,
    /// Data from the processor, asynchronous.
    pub bus_data_i: Signal<In, Bits<16>>,
    /// Data to the processor, valid 4 clocks after the address.
    pub bus_data_o: Signal<Out, Bits<16>>,
    /// The receiver drives the data lines, straight from the strobes.
    pub bus_data_oe: Signal<Out, Bit>,
    /// Line to the transceiver.
    pub encoder_data_o: Signal<Out, Bit>,
    /// Driver enable of the transceiver.
    pub encoder_data_oe: Signal<Out, Bit>,
    /// Line from the transceiver, asynchronous, idle HIGH.
    pub encoder_data_i: Signal<In, Bit>,
    /// The last reply was good.
    pub led_o: Signal<Out, Bit>,
    #[start]
    strobes: BusStrobes,
    #[start]
    channel: TFormatChannel,
    #[start]
    primary: LowestCause,
    select_0: SyncReg<Bit>,
    select_1: SyncReg<Bit>,
    // HIGH, so that a pin that is high at power-up is not an edge.
    #[start(true)]
    trigger_0: SyncReg<Bit>,
    #[start(true)]
    trigger_1: SyncReg<Bit>,
    #[start(true)]
    trigger_2: SyncReg<Bit>,
    us_count: Reg<Bits<6>>,
    us_tick: Reg<Bit>,
    start: Reg<Bit>,
    #[given]
    request_id: Reg<Bits<4>>,
    #[given]
    settings: Reg<Bits<16>>,
    memory: Reg<Bits<16>>,
    // Nothing to write yet.
    #[start(true)]
    memory_sum: Reg<Bit>,
    armed: Reg<Bit>,
    was_first: Reg<Bit>,
    seen_fresh: Reg<Bit>,
    seen_valid: Reg<Bits<2>>,
    seen_sums: Reg<Bits<2>>,
    seen_id: Reg<Bits<4>>,
    seen_flags: Reg<Bits<16>>,
    seen_single: Reg<Bits<24>>,
    seen_multi: Reg<Bits<24>>,
    seen_identity: Reg<Bits<8>>,
    seen_alarm: Reg<Bits<8>>,
    seen_status: Reg<Bits<8>>,
    seen_crc: Reg<Bits<8>>,
    seen_memory: Reg<Bits<8>>,
    chosen: Reg<Bits<16>>,
    out_data: Reg<Bits<16>>,
    is_first: Signal<Local, Bit>,
    memory_fits: Signal<Local, Bit>,
    single_fits: Signal<Local, Bit>,
    multi_fits: Signal<Local, Bit>,
    fits: Signal<Local, Bit>,
    valid: Signal<Local, Bits<2>>,
    us_last: Signal<Local, Bit>,
    can_write: Signal<Local, Bit>,
    control: Signal<Local, Bits<8>>,
    repeats: Signal<Local, Bit>,
    complains: Signal<Local, Bit>,
    communication: Signal<Local, Bits<8>>,
    overrun: Signal<Local, Bit>,
    us_cycles: Vec<Constant<Bits<6>>>,
    bit_cycles: Vec<Constant<Bits<5>>>,
}

impl AsyncDsp {
    /// A receiver that starts with these settings.
    pub fn new(start: &TFormatStart) -> Self {
        let cycles = |bit_hz: u64| SYSTEM_HZ.map(|hz| hz / bit_hz);
        let bits = [cycles(BIT_HZ), cycles(FAST_BIT_HZ)].concat();
        Self::from_parts(AsyncDspParts {
            request_id: Reg::new(u64::from(start.request_id).into()),
            settings: Reg::new(start.word().into()),
            us_cycles: (SYSTEM_HZ.iter())
                .map(|hz| Constant::new((hz / 1_000_000 - 1).into()))
                .collect(),
            bit_cycles: bits.iter().map(|n| Constant::new((*n).into())).collect(),
        })
    }
}

impl Logic for AsyncDsp {
    #[kernel(clk_i, rst_i)]
    fn update(&mut self) {
        self.strobes.clock.next = self.clk_i.val();
        self.strobes.reset.next = self.rst_i.val();
        self.channel.clock.next = self.clk_i.val();
        self.channel.reset.next = self.rst_i.val();

        self.strobes.cs_n.next = self.bus_cs_n_i.val();
        self.strobes.rd_n.next = self.bus_rd_n_i.val();
        self.strobes.wr_n.next = self.bus_wr_n_i.val();
        self.strobes.register_at.next = self.bus_address_i.val();
        self.strobes.data_in.next = self.bus_data_i.val();
        // No register: the lines are free as soon as the strobe ends.
        self.bus_data_oe.next = !self.bus_cs_n_i.val() & !self.bus_rd_n_i.val();

        self.select_0.d.next = self.clk_select_i.val();
        self.select_1.d.next = self.select_0.q.val();
        self.us_last.next = self.us_count.q.val() == self.us_cycles[0].val();
        self.channel.bit_cycles.next = self.bit_cycles[0].val();
        if self.settings.q.val().get_bit(8) {
            self.channel.bit_cycles.next = self.bit_cycles[2].val();
        }
        if self.select_1.q.val() {
            self.us_last.next = self.us_count.q.val() == self.us_cycles[1].val();
            self.channel.bit_cycles.next = self.bit_cycles[1].val();
            if self.settings.q.val().get_bit(8) {
                self.channel.bit_cycles.next = self.bit_cycles[3].val();
            }
        }
        self.us_count.d.next = self.us_count.q.val() + 1;
        if self.us_last.val() {
            self.us_count.d.next = 0.into();
        }
        self.us_tick.d.next = self.us_last.val();

        self.trigger_0.d.next = self.trigger_i.val();
        self.trigger_1.d.next = self.trigger_0.q.val();
        self.trigger_2.d.next = self.trigger_1.q.val();
        self.start.d.next = self.trigger_1.q.val() & !self.trigger_2.q.val();
        self.can_write.next = !self.channel.busy.val() & !self.start.q.val();
        if self.strobes.written.val() & !self.strobes.written_register.val().any() {
            self.start.d.next = true;
        }
        // A byte is written once for each write of address 7 and one of address 0 behind it: no pin, no upset does it again.
        self.memory_fits.next = self.memory.q.val().xor() == self.memory_sum.q.val();
        self.armed.d.next = self.armed.q.val() & (self.start.q.val() | self.channel.busy.val());
        if self.channel.result_strobe.val() & self.armed.q.val() & (self.request_id.q.val() == 6) {
            self.memory_sum.d.next = !self.memory.q.val().xor();
        }
        if self.strobes.written.val() & self.can_write.val() {
            match self.strobes.written_register.val().index() {
                0 => {
                    self.request_id.d.next = self.strobes.written_data.val().get_bits::<4>(0);
                    self.armed.d.next = true;
                }
                6 => {
                    self.settings.d.next = self.strobes.written_data.val();
                }
                7 => {
                    self.memory.d.next = self.strobes.written_data.val();
                    self.memory_sum.d.next = self.strobes.written_data.val().xor();
                }
                _ => {}
            }
        }

        self.channel.tick_us.next = self.us_tick.q.val();
        self.channel.trigger.next = self.start.q.val();
        self.channel.request_id.next = self.request_id.q.val();
        if (self.request_id.q.val() == 6) & !(self.armed.q.val() & self.memory_fits.val()) {
            self.channel.request_id.next = 15.into();
        }
        self.channel.address.next = self.memory.q.val().get_bits::<7>(0);
        self.channel.data.next = self.memory.q.val().get_bits::<8>(8);
        self.channel.reply_gap_us.next = self.settings.q.val().get_bits::<6>(0);
        self.channel.field_gap_us.next = self.settings.q.val().get_bits::<3>(9);
        self.channel.filter_cycles.next = self.settings.q.val().get_bits::<4>(12);
        self.channel.rx.next = self.encoder_data_i.val();
        self.encoder_data_o.next = self.channel.tx.val();
        self.encoder_data_oe.next = self.channel.driver.val();
        self.led_o.next = self.channel.fresh.val();

        self.is_first.next = self.strobes.reading.val() & !self.strobes.register.val().any();
        self.was_first.d.next = self.is_first.val();
        if self.is_first.val() & !self.was_first.q.val() {
            self.seen_fresh.d.next = self.channel.fresh.val();
            self.seen_valid.d.next = bit_cast::<2, 1>(self.channel.single_valid.val().into())
                | (bit_cast::<2, 1>(self.channel.multi_valid.val().into()) << 1);
            self.seen_sums.d.next = bit_cast::<2, 1>(self.channel.single_parity.val().into())
                | (bit_cast::<2, 1>(self.channel.multi_parity.val().into()) << 1);
            self.seen_id.d.next = self.channel.reply_id.val();
            self.seen_flags.d.next = self.channel.flags.val();
            self.seen_single.d.next = self.channel.single_turn.val();
            self.seen_multi.d.next = self.channel.multi_turn.val();
            self.seen_identity.d.next = self.channel.encoder_id.val();
            self.seen_alarm.d.next = self.channel.alarm.val();
            self.seen_status.d.next = self.channel.status.val();
            self.seen_crc.d.next = self.channel.crc.val();
            self.seen_memory.d.next = self.channel.memory_data.val();
        }

        // From the wire to here each position has its parity with it.
        self.single_fits.next = (self.seen_single.q.val().xor()
            ^ self.seen_valid.q.val().get_bit(0))
            == self.seen_sums.q.val().get_bit(0);
        self.multi_fits.next = (self.seen_multi.q.val().xor() ^ self.seen_valid.q.val().get_bit(1))
            == self.seen_sums.q.val().get_bit(1);
        self.fits.next = self.single_fits.val() & self.multi_fits.val();
        self.valid.next = self.seen_valid.q.val();
        self.primary.flags.next = self.seen_flags.q.val();
        if !self.fits.val() {
            // An alarm beside it would hide the upset.
            self.primary.flags.next =
                bit_cast::<16, 12>(self.seen_flags.q.val().get_bits::<12>(0)) | 0x4000;
            self.valid.next = bit_cast::<2, 1>(
                (self.single_fits.val() & self.seen_valid.q.val().get_bit(0)).into(),
            ) | (bit_cast::<2, 1>(
                (self.multi_fits.val() & self.seen_valid.q.val().get_bit(1)).into(),
            ) << 1);
        }
        self.complains.next = self.seen_flags.q.val().get_bits::<2>(9).any();
        self.communication.next = bit_cast::<8, 2>(self.seen_flags.q.val().get_bits::<2>(2))
            | (bit_cast::<8, 1>(self.seen_flags.q.val().get_bits::<1>(7)) << 2)
            | (bit_cast::<8, 1>(self.seen_flags.q.val().get_bits::<1>(6)) << 3)
            | (bit_cast::<8, 2>(self.seen_flags.q.val().get_bits::<2>(4)) << 4)
            | (bit_cast::<8, 1>(self.seen_flags.q.val().get_bits::<1>(8)) << 6)
            | (bit_cast::<8, 1>(self.complains.val().into()) << 7);
        // Any flag up to the echo says that no ID came, or another one.
        self.repeats.next = !self.seen_flags.q.val().get_bits::<6>(0).any();
        self.control.next = bit_cast::<8, 4>(self.seen_id.q.val())
            | (bit_cast::<8, 1>(self.repeats.val().into()) << 4)
            | (bit_cast::<8, 1>(self.communication.val().any().into()) << 5)
            | (bit_cast::<8, 1>((self.seen_fresh.q.val() & self.fits.val()).into()) << 7);
        self.overrun.next = self.seen_flags.q.val().get_bit(15);
        match self.strobes.register.val().index() {
            0 => {
                self.chosen.d.next = bit_cast::<16, 4>(self.request_id.q.val());
            }
            1 => {
                self.chosen.d.next = bit_cast::<16, 8>(self.control.val())
                    | (bit_cast::<16, 8>(self.seen_single.q.val().get_bits::<8>(0)) << 8);
            }
            2 => {
                self.chosen.d.next = self.seen_single.q.val().get_bits::<16>(8);
            }
            3 => {
                self.chosen.d.next = bit_cast::<16, 8>(self.seen_identity.q.val())
                    | (bit_cast::<16, 8>(self.seen_multi.q.val().get_bits::<8>(0)) << 8);
            }
            4 => {
                self.chosen.d.next = self.seen_multi.q.val().get_bits::<16>(8);
            }
            5 => {
                self.chosen.d.next = bit_cast::<16, 8>(self.seen_alarm.q.val())
                    | (bit_cast::<16, 8>(self.seen_status.q.val()) << 8);
            }
            6 => {
                self.chosen.d.next = bit_cast::<16, 8>(self.seen_crc.q.val())
                    | (bit_cast::<16, 8>(self.communication.val()) << 8);
            }
            _ => {
                self.chosen.d.next = bit_cast::<16, 8>(self.seen_memory.q.val())
                    | (bit_cast::<16, 4>(self.primary.cause.val().get_bits::<4>(0)) << 8)
                    | (bit_cast::<16, 2>(self.valid.val()) << 12)
                    | (bit_cast::<16, 1>(self.overrun.val().into()) << 14)
                    | (bit_cast::<16, 1>(self.channel.busy.val().into()) << 15);
            }
        }
        self.out_data.d.next = self.chosen.q.val();
        self.bus_data_o.next = self.out_data.q.val();
    }
}

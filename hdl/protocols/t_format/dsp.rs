//! T-format receiver with the 16-bit bus of a signal processor.
//!
//! ```text
//! bus pins --BusStrobes--> request, settings --> Exchange -> transceiver
//!                                                   ^   |
//! transceiver -> InputFilter -----------------------+-> ReplyBytes -> ResultBanks -> bus_data_o
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
//! Control data: 3:0 ID of the reply, 4 it equals that of the request, 5 communication alarm, 7 fresh. Communication alarm: 0 no
//! answer, 1 no header, 2 field missing, 3 delimiter, 4 parity, 5 another ID, 6 CRC, 7 the encoder reports an error.
//!
//! Data reach the pins 4 clocks after the address and change 4 clocks after it changes. Reading address 0 latches the content of
//! addresses 1 to 7, except bit 15 of address 7. While that bit is set writes are ignored, but a request counts as trigger.

use super::exchange::Exchange;
use super::ports::{FieldBitsOut, ReplyPartsOut};
use super::protocol::{BIT_HZ, FAST_BIT_HZ, SYSTEM_HZ};
use super::reply_bytes::ReplyBytes;
use super::result_banks::ResultBanks;
use crate::card::bus::strobes::BusStrobes;
use crate::endat::features::Features;
use crate::input_filter::InputFilter;
use rtl_design::reg::{Reg, SyncReg};
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

/// Start values of a T-format receiver; the processor can change all of them.
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
        Self::DEFAULT
    }
}

impl TFormatStart {
    /// Default settings after reset.
    pub const DEFAULT: Self = Self {
        fast: false,
        reply_gap_us: 20,
        field_gap_us: 2,
        filter_cycles: 1,
        request_id: 3,
    };

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
    /// The clock runs at 60 MHz; low = 20 MHz. A strap: constant while the receiver runs.
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
    /// The receiver drives the data lines; combinational from the strobes.
    pub bus_data_oe: Signal<Out, Bit>,
    /// Line to the transceiver.
    pub encoder_data_o: Signal<Out, Bit>,
    /// Driver enable of the transceiver.
    pub encoder_data_oe: Signal<Out, Bit>,
    /// Line from the transceiver, asynchronous, idle HIGH.
    pub encoder_data_i: Signal<In, Bit>,
    /// The last reply was good.
    pub led_o: Signal<Out, Bit>,
    /// Strobes of the bus, in the system clock domain.
    #[start]
    strobes: BusStrobes,
    /// Synchroniser and filter of the line.
    filter: InputFilter,
    /// Request and reply.
    exchange: Exchange,
    /// Fields of the reply while it is received.
    #[start]
    reply: ReplyBytes,
    /// Words of the results.
    banks: ResultBanks,
    /// Clock strap, first synchroniser stage.
    select_0: SyncReg<Bit>,
    /// Clock strap, second synchroniser stage.
    select_1: SyncReg<Bit>,
    /// Trigger pin, first synchroniser stage; starts HIGH, so that a pin HIGH at power-up is not an edge.
    #[start(true)]
    trigger_0: SyncReg<Bit>,
    /// Trigger pin, second synchroniser stage.
    #[start(true)]
    trigger_1: SyncReg<Bit>,
    /// Trigger pin one cycle before `trigger_1`, to find the edge.
    #[start(true)]
    trigger_2: SyncReg<Bit>,
    /// System clock cycles of the current microsecond, from 0.
    us_count: Reg<Bits<6>>,
    /// High for one cycle each microsecond.
    us_tick: Reg<Bit>,
    /// High for one cycle when a request is sent: at a rising edge of the trigger pin, or a write of address 0.
    start: Reg<Bit>,
    /// Request ID; written with address 0.
    #[given]
    request_id: Reg<Bits<4>>,
    /// Settings; written with address 6.
    #[given]
    settings: Reg<Bits<16>>,
    /// EEPROM address and data; written with address 7.
    memory: Reg<Bits<16>>,
    /// Parity of `memory` as written; wrong while the data must not be sent.
    #[start(true)]
    memory_sum: Reg<Bit>,
    /// High from a write of address 0 to the end of its exchange: only such a request can write to the EEPROM.
    armed: Reg<Bit>,
    /// High from a write of address 7 until its data has been sent once.
    memory_is_new: Reg<Bit>,
    /// High if the EEPROM data can be sent.
    memory_fits: Signal<Local, Bit>,
    /// 1 if stored bits are checked against their parity.
    has_guards: Constant<Bit>,
    /// High in the last cycle of a microsecond.
    us_last: Signal<Local, Bit>,
    /// System clock cycles in a bit, for the clock and rate selected.
    chosen_cycles: Signal<Local, Bits<5>>,
    /// High if no request is starting or under way: writes are taken.
    can_write: Signal<Local, Bit>,
    /// System clock cycles in a microsecond, minus one: at 20 MHz, at 60 MHz.
    us_cycles: Vec<Constant<Bits<6>>>,
    /// System clock cycles in a bit: slow at 20 and 60 MHz, fast at 20 and 60 MHz.
    bit_cycles: Vec<Constant<Bits<5>>>,
}

impl AsyncDsp {
    /// A receiver with these settings after reset; `guards` check for upsets of stored bits.
    pub fn new(start: &TFormatStart, guards: bool) -> Self {
        let cycles = |bit_hz: u64| SYSTEM_HZ.map(|hz| hz / bit_hz);
        let bits = [cycles(BIT_HZ), cycles(FAST_BIT_HZ)].concat();
        Self::from_parts(AsyncDspParts {
            filter: InputFilter::new(Features::NONE),
            exchange: Exchange::new(guards),
            banks: ResultBanks::new(guards),
            has_guards: Constant::new(guards),
            request_id: Reg::new(u64::from(start.request_id).into()),
            settings: Reg::new(start.word().into()),
            us_cycles: (SYSTEM_HZ.iter())
                .map(|hz| Constant::new((hz / 1_000_000 - 1).into()))
                .collect(),
            bit_cycles: bits.iter().map(|n| Constant::new((*n).into())).collect(),
        })
    }
}

#[kernel(clk_i, rst_i)]
impl Logic for AsyncDsp {
    fn update(&mut self) {
        connect!(self.strobes <= self; clock = clk_i, reset = rst_i);
        connect!(self.filter <= self; clock = clk_i, reset = rst_i);
        connect!(self.exchange <= self; clock = clk_i, reset = rst_i);
        connect!(self.reply <= self; clock = clk_i, reset = rst_i);
        connect!(self.banks <= self; clock = clk_i, reset = rst_i);

        connect!(self.strobes <= self;
            cs_n = bus_cs_n_i, rd_n = bus_rd_n_i, wr_n = bus_wr_n_i, register_at = bus_address_i,
            data_in = bus_data_i
        );
        // Combinational: the lines are free as soon as the strobe ends.
        self.bus_data_oe.next = !self.bus_cs_n_i.val() & !self.bus_rd_n_i.val();

        self.select_0.d.next = self.clk_select_i.val();
        self.select_1.d.next = self.select_0.q.val();
        self.us_last.next = self.us_count.q.val() == self.us_cycles[0].val();
        self.chosen_cycles.next = self.bit_cycles[0].val();
        if self.settings.q.val().get_bit(8) {
            self.chosen_cycles.next = self.bit_cycles[2].val();
        }
        if self.select_1.q.val() {
            self.us_last.next = self.us_count.q.val() == self.us_cycles[1].val();
            self.chosen_cycles.next = self.bit_cycles[1].val();
            if self.settings.q.val().get_bit(8) {
                self.chosen_cycles.next = self.bit_cycles[3].val();
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
        self.can_write.next = !self.exchange.busy.val() & !self.start.q.val();
        if self.strobes.written.val() & !self.strobes.written_register.val().any() {
            self.start.d.next = true;
        }
        // Each write of address 7 followed by one of address 0 writes one byte; neither the pin nor an upset repeats it.
        self.memory_fits.next = self.memory_is_new.q.val();
        if self.has_guards.val() {
            self.memory_fits.next = self.memory.q.val().xor() == self.memory_sum.q.val();
        }
        self.armed.d.next = self.armed.q.val() & (self.start.q.val() | self.exchange.busy.val());
        if self.banks.published.val() & self.armed.q.val() & (self.request_id.q.val() == 6) {
            self.memory_sum.d.next = !self.memory.q.val().xor();
            self.memory_is_new.d.next = false;
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
                    // Formed at the pins, before the data were stored.
                    self.memory_sum.d.next = self.strobes.written_sum.val();
                    self.memory_is_new.d.next = true;
                }
                _ => {}
            }
        }

        self.filter.pin.next = self.encoder_data_i.val();
        self.filter.filter_cycles.next = self.settings.q.val().get_bits::<4>(12);
        self.filter.filter_half.next = false;
        self.filter.majority.next = false;
        self.filter.both_edges.next = false;

        self.exchange.tick_us.next = self.us_tick.q.val();
        self.exchange.trigger.next = self.start.q.val();
        self.exchange.request_id.next = self.request_id.q.val();
        if (self.request_id.q.val() == 6) & !(self.armed.q.val() & self.memory_fits.val()) {
            self.exchange.request_id.next = 15.into();
        }
        self.exchange.request_fits.next = true;
        self.exchange.address.next = self.memory.q.val().get_bits::<7>(0);
        self.exchange.data.next = self.memory.q.val().get_bits::<8>(8);
        self.exchange.bit_cycles.next = bit_cast::<7, 5>(self.chosen_cycles.val());
        self.exchange.reply_gap_us.next = self.settings.q.val().get_bits::<6>(0);
        self.exchange.field_gap_us.next = self.settings.q.val().get_bits::<3>(9);
        self.exchange.level.next = self.filter.level.val();
        self.exchange.status.next = self.reply.status.val();
        self.exchange.hold.next = self.banks.hold.val();
        connect!(self <= self.exchange; encoder_data_o = tx, encoder_data_oe = driver);

        self.reply.idle.next = !self.exchange.busy.val();
        self.reply.take.next = self.exchange.take.val();
        self.reply.level.next = self.filter.level.val();
        FieldBitsOut::join(&mut self.exchange.field, &mut self.reply.field);
        connect!(self.reply <= self.banks; copy, tail);

        connect!(self.banks <= self.exchange; verdict = publish, good, flags, reply_id, crc);
        connect!(self.banks <= self.reply; single_parity, multi_parity);
        ReplyPartsOut::join(&mut self.exchange.parts, &mut self.banks.parts);
        connect!(self.banks <= self.reply; head, second);
        connect!(self.banks <= self.strobes; register, reading);
        self.banks.request_id.next = self.request_id.q.val();
        self.banks.busy.next = self.exchange.busy.val();
        connect!(self <= self.banks; bus_data_o = word, led_o = fresh);
    }
}

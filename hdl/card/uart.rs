//! The card with a UART: [`CardCore`] behind a [`UartBridge`].
//!
//! ```text
//! uart_rx_i, uart_tx_o <-> UartBridge <-> CardCore <-> trigger_i, endat_*, led_*
//! ```

use super::{service_times, CardCore};
use crate::config::CardConfig;
use crate::service::program::ServiceTimes;
use crate::several::each;
use crate::uart_bridge::{UartBridge, TIMEOUT_US};
use endat_macros::{kernel, Block};
use rust_hdl::prelude::*;

/// The whole core with a UART to the host; the number of channels is that of [`CardConfig::channels`].
#[derive(LogicBlock, Block)]
pub struct Card {
    /// System clock.
    pub clk_i: Signal<In, Clock>,
    /// Synchronous reset, active high.
    pub rst_i: Signal<In, Bit>,
    /// Trigger pin, asynchronous; a rising edge triggers.
    pub trigger_i: Signal<In, Bit>,
    /// Serial line from the host, asynchronous.
    pub uart_rx_i: Signal<In, Bit>,
    /// Serial line to the host.
    pub uart_tx_o: Signal<Out, Bit>,
    /// EnDat clock to the transceiver.
    pub endat_clk_o: Vec<Signal<Out, Bit>>,
    /// EnDat data to the transceiver.
    pub endat_data_o: Vec<Signal<Out, Bit>>,
    /// Driver enable of the EnDat data line.
    pub endat_data_oe: Vec<Signal<Out, Bit>>,
    /// EnDat data from the transceiver, asynchronous.
    pub endat_data_i: Vec<Signal<In, Bit>>,
    /// Blinks: slowly = well, quickly = the last result of a channel is an error.
    pub led_status_o: Signal<Out, Bit>,
    /// The channel's last result is a good position.
    pub led_channel_o: Vec<Signal<Out, Bit>>,
    pub(super) core: CardCore,
    bridge: UartBridge,
    _channels: usize,
}

impl Card {
    /// A card.
    pub fn new(config: &CardConfig) -> Self {
        Self::with_timeout(config, TIMEOUT_US)
    }

    /// A card with another limit on pauses within a host command, for quick tests.
    pub fn with_timeout(config: &CardConfig, timeout_us: u64) -> Self {
        Self::with_times(config, timeout_us, &service_times(config))
    }

    /// A card with other waits, too.
    pub fn with_times(config: &CardConfig, timeout_us: u64, service: &ServiceTimes) -> Self {
        let channels = config.channels.len();
        Self::from_parts(CardParts {
            endat_clk_o: each(channels),
            endat_data_o: each(channels),
            endat_data_oe: each(channels),
            endat_data_i: each(channels),
            led_channel_o: each(channels),
            core: CardCore::with_times(config, service),
            bridge: UartBridge::new(config.uart_bit_cycles, timeout_us),
            _channels: channels,
        })
    }
}

impl Logic for Card {
    #[kernel]
    fn update(&mut self) {
        self.core.clk_i.next = self.clk_i.val();
        self.core.rst_i.next = self.rst_i.val();
        self.core.trigger_i.next = self.trigger_i.val();
        self.bridge.clock.next = self.clk_i.val();
        self.bridge.reset.next = self.rst_i.val();

        self.bridge.rx.next = self.uart_rx_i.val();
        self.uart_tx_o.next = self.bridge.tx.val();
        self.bridge.tick_us.next = self.core.tick_us.val();
        self.bridge.take_byte.next = self.core.take_byte.val();
        self.bridge.read_byte.next = self.core.read_byte.val();
        self.bridge.done.next = self.core.done.val();
        self.core.word_address.next = self.bridge.word_address.val();
        self.core.in_range.next = self.bridge.in_range.val();
        self.core.lane.next = self.bridge.lane.val();
        self.core.access.next = self.bridge.access.val();
        self.core.write.next = self.bridge.write.val();
        self.core.write_data.next = self.bridge.write_data.val();
        self.core.reading.next = self.bridge.reading.val();
        self.bridge.push.next = self.core.push.val();
        self.bridge.in_frame.next = self.core.in_frame.val();
        self.bridge.push_valid.next = self.core.push_valid.val();
        self.bridge.push_byte.next = self.core.push_byte.val();
        self.core.push_take.next = self.bridge.push_take.val();

        for i in 0..self._channels {
            self.core.endat_data_i[i].next = self.endat_data_i[i].val();
            self.endat_clk_o[i].next = self.core.endat_clk_o[i].val();
            self.endat_data_o[i].next = self.core.endat_data_o[i].val();
            self.endat_data_oe[i].next = self.core.endat_data_oe[i].val();
            self.led_channel_o[i].next = self.core.led_channel_o[i].val();
        }
        self.led_status_o.next = self.core.led_status_o.val();
    }
}

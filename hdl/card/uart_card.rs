//! The card with a UART: [`CardCore`] with a [`UartBridge`].
//!
//! ```text
//! uart_rx_i, uart_tx_o <-> UartBridge <-> CardCore <-> trigger_i, endat_*, led_*
//! ```

use super::ports::{AccessOut, PushOut};
use super::{service_times, top::card_top, CardCore};
use crate::card::uart_bridge::{UartBridge, TIMEOUT_US};
use crate::config::CardConfig;
use crate::endat::service::program::ServiceTimes;
use crate::replicate::each;
use rtl_design::{kernel, Block};
use rust_hdl::prelude::*;

card_top! {
    /// The whole core with a UART to the host; [`CardConfig::channels`] sets the number of channels.
    Card, CardParts: bridge: UartBridge
    in {
        /// Serial line from the host, asynchronous.
        uart_rx_i: Bit => rx,
    }
    out {
        /// Serial line to the host.
        uart_tx_o: Bit => tx,
    }
    pushed { pushed }
    silent {}
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

    /// A card with this limit and other waiting times.
    pub fn with_times(config: &CardConfig, timeout_us: u64, service: &ServiceTimes) -> Self {
        let bridge = UartBridge::new(config.uart_bit_cycles, timeout_us);
        Self::behind(bridge, CardCore::with_times(config, service))
    }
}

//! Cards in native code, each made once per process: elaboration and code generation take longer than most simulations.

use endat_config::Project;
use endat_hdl::card::uart_bridge::TIMEOUT_US;
use endat_hdl::card::{service_times, Card};
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Empty until the first test has made it.
type Slot = Arc<Mutex<Option<Compiled>>>;

static MADE: LazyLock<Mutex<HashMap<String, Slot>>> = LazyLock::new(Mutex::default);

/// A copy, before its first cycle, of the design with this key; `make` runs once per key. The key contains everything that the design depends on.
pub fn once(key: String, make: impl FnOnce() -> Design) -> Compiled {
    let slot = {
        let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(made.entry(key).or_default())
    };
    // Only threads that want the same design wait here.
    let mut made = slot.lock().unwrap_or_else(PoisonError::into_inner);
    made.get_or_insert_with(|| Compiled::new(&make()).unwrap())
        .clone()
}

/// The card of a project.
pub fn card(project: &Project) -> Compiled {
    card_with(project, &service_times(&project.card), TIMEOUT_US)
}

/// The card of a project with these waits of its services, and this limit in microseconds on pauses within a command over the UART.
pub fn card_with(project: &Project, times: &ServiceTimes, timeout_us: u64) -> Compiled {
    let (bus, card) = (project.bus, &project.card);
    once(format!("{bus:?} {times:?} {timeout_us} {card:?}"), || {
        endat_emit::design_with(project, times, timeout_us).unwrap()
    })
}

/// The core with a UART, without a project around it.
pub fn uart_card(card: &CardConfig, times: &ServiceTimes, timeout_us: u64) -> Compiled {
    once(format!("core {times:?} {timeout_us} {card:?}"), || {
        let mut block = Card::with_times(card, timeout_us, times);
        block.connect_all();
        elaborate(&block, "card").unwrap()
    })
}

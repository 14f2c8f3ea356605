//! Requests of the library: whole answers, and requests that wait.

use super::{desk::Desk, quick, SERVICE};
use endat_card::VirtualConfig;
use endat_host::mailbox::Request;

fn desk() -> Desk {
    Desk::new(&quick(SERVICE), &VirtualConfig::default())
}

#[test]
fn a_request_without_a_trigger_is_refused_in_time_and_the_next_one_works() {
    let mut desk = desk();
    let sources = desk.reg("card_config.trigger_sources");
    desk.set("card_config.trigger_sources", 0);
    desk.set("service0.request_wait", 20);
    let request = Request {
        command: 0b101101,
        address: 0,
        data: 0,
    };
    let refused = desk.card.request(0, request).unwrap_err().to_string();
    assert!(refused.contains("no trigger came"), "{refused}");
    // A frame of its own needs none.
    assert_eq!(desk.send(0, 0b001110, 0xA1, 0), (0xA1, 0));
    // One that another program has left is cancelled.
    desk.set("service0.request_wait", 0);
    desk.set("service0.request", 0x2D00_0000);
    desk.run_ms(5);
    assert_eq!(desk.reg("service0.request_state.busy"), 1);
    desk.card.cancel_request(0).unwrap();
    assert_eq!(desk.reg("service0.request_state.busy"), 0);
    assert_eq!(desk.reg("service0.request_state.error"), 9);
    desk.set("card_config.trigger_sources", sources);
    desk.send(0, 0b101101, 0, 0);
}

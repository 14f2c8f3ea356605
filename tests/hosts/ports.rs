//! Virtual cards behind ports: TCP and pseudo terminals, in threads of the test.

use super::{changed, QUICKER};
use endat_card::{serve, Door, VirtualCard, VirtualConfig};
use endat_config::Project;
use endat_host::transport::Port;
use endat_host::{Bridge, Card};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How long an answer that is due may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A card in a thread; ends with the value.
pub struct Served {
    pub name: String,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Served {
    pub fn new(project: Project, door: impl FnOnce() -> Door + Send + 'static) -> Self {
        Self::with(project, VirtualConfig::default(), door)
    }

    /// A card whose sets are made by arithmetic: it keeps real time on every machine.
    pub fn loaded(project: Project, door: impl FnOnce() -> Door + Send + 'static) -> Self {
        let config = VirtualConfig {
            makes_sets: true,
            ..VirtualConfig::default()
        };
        Self::with(project, config, door)
    }

    fn with(
        project: Project,
        config: VirtualConfig,
        door: impl FnOnce() -> Door + Send + 'static,
    ) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let (told, name) = std::sync::mpsc::channel();
        let raised = stop.clone();
        let thread = thread::spawn(move || {
            let mut card = VirtualCard::new(&project, &config).unwrap();
            let mut door = door();
            told.send(door.name()).unwrap();
            serve(&mut card, &mut door, &raised, None, |_| {});
        });
        Self {
            name: name.recv().unwrap(),
            stop,
            thread: Some(thread),
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A quick card that samples slowly enough for a machine that simulates slowly.
pub fn slow_card() -> Project {
    let mut changes = QUICKER;
    changes[5] = ("sample_hz = 10_000", "sample_hz = 1_000");
    changed("s6_two_channel", &changes)
}

/// Catches advice on the form of an address that has the right one.
#[test]
fn a_port_that_is_taken_is_told_to_be_another() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let told = Door::tcp(&address).err().unwrap().to_string();
    assert!(
        told.ends_with("give another port (port 0 takes a free one)"),
        "{told}"
    );
}

fn read_and_write(name: &str) {
    let port = Port::open(name, 2_000_000).unwrap();
    let mut card = Card::find(Bridge::new(port)).unwrap();
    let scratch = card.place("card_config.hold.scratch").unwrap();
    for value in [0x00_0000, 0xFF_FFFF, 0x5A_A513] {
        card.write(&scratch, value).unwrap();
        assert_eq!(card.read(&scratch).unwrap(), value);
    }
    let sequence = |card: &mut Card<Port>| card.results().unwrap().channels[1].sequence;
    let first = sequence(&mut card);
    while sequence(&mut card) == first {}
}

/// Hosts come and go; the card goes on.
#[test]
fn hosts_come_and_go_over_tcp() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    for _ in 0..3 {
        read_and_write(&card.name);
    }
}

/// Catches bytes of one host that end a command of the one before.
#[test]
fn half_a_command_goes_with_the_host_that_sent_it() {
    use std::io::Write;
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let address = card.name.trim_start_matches("tcp:");
    let mut last = None;
    for _ in 0..3 {
        // One word to trigger_sources, and the half of it; then a burst of 255 words, of which nothing comes.
        for half in [&[1, 1, 0, 0, 1, 0, 0xFF][..], &[1, 255, 0, 0, 1, 0]] {
            let mut stream = std::net::TcpStream::connect(address).unwrap();
            stream.write_all(half).unwrap();
            drop(stream);
            let mut bridge = Bridge::new(Port::open(&card.name, 2_000_000).unwrap());
            // A busy machine answers late, which is no retry of this test.
            bridge.set_wait(PATIENCE);
            assert_eq!(bridge.read(0, 1).unwrap(), [0x456E_4474]);
            assert_eq!(
                bridge.retries(),
                0,
                "the first command was taken for something else"
            );
            let words = bridge.read(0x100, 2).unwrap();
            assert_eq!(*last.get_or_insert(words.clone()), words);
        }
    }
}

#[cfg(unix)]
#[test]
fn a_pseudo_terminal_is_a_serial_port() {
    let card = Served::new(slow_card(), || Door::terminal().unwrap());
    for _ in 0..2 {
        read_and_write(&card.name);
    }
}

/// A link that goes away in mid command, and comes back.
#[test]
fn a_port_that_was_unplugged_is_opened_again() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let name = card.name.clone();
    let port = Port::open(&name, 2_000_000).unwrap();
    let mut bridge = Bridge::new(port);
    let id = bridge.read(0, 1).unwrap();
    drop(card);
    assert!(bridge.read(0, 1).is_err(), "nobody is there");
    let address = name.trim_start_matches("tcp:").to_owned();
    let _again = Served::new(slow_card(), move || {
        // The system keeps the port for a moment.
        for _ in 0..100 {
            if let Ok(door) = Door::tcp(&address) {
                return door;
            }
            thread::sleep(std::time::Duration::from_millis(100));
        }
        panic!("{address} does not become free");
    });
    assert_eq!(bridge.read(0, 1).unwrap(), id);
    assert!(bridge.transport().reopened() >= 1);
}

//! A host at a virtual card: registers by name, requests, and time that passes.

use endat_card::{VirtualCard, VirtualConfig};
use endat_config::Project;
use endat_host::mailbox::Request;
use endat_host::{Bridge, Card};
use std::time::Duration;

/// A card whose encoders have been initialised, if it does that.
pub struct Desk {
    pub card: Card<VirtualCard>,
    channels: usize,
    ms_cycles: u64,
}

impl Desk {
    pub fn new(project: &Project, config: &VirtualConfig) -> Self {
        let card = VirtualCard::new(project, config).unwrap();
        let mut card = Card::find(Bridge::new(card)).unwrap();
        let channels = project.card.channels.len();
        if project.card.service.initialise {
            // `initialising` is 0 until the service has begun, some microseconds after power-up.
            let begun = project.card.system_hz / 10_000;
            card.bridge().transport().run(begun);
            for channel in 0..channels {
                card.wait_for_initialisation(channel).unwrap();
            }
        }
        Self {
            card,
            channels,
            ms_cycles: project.card.system_hz / 1_000,
        }
    }

    pub fn reg(&mut self, name: &str) -> u32 {
        let place = self.card.place(name).unwrap();
        self.card.read(&place).unwrap()
    }

    pub fn set(&mut self, name: &str, value: u32) {
        let place = self.card.place(name).unwrap();
        self.card.write(&place, value).unwrap();
    }

    pub fn run_ms(&mut self, ms: u64) {
        let cycles = ms * self.ms_cycles;
        self.card.bridge().transport().run(cycles);
    }

    pub fn send(&mut self, channel: usize, command: u8, address: u8, data: u16) -> (u8, u16) {
        let request = Request {
            command,
            address,
            data,
        };
        let answer = self.card.request(channel, request).unwrap();
        assert!(answer.duration > Duration::ZERO);
        (answer.address, answer.data)
    }

    /// All channels give a position that their encoder has sent in one of its last `frames` frames.
    pub fn assert_positions(&mut self, frames: usize) {
        let results = self.card.results().unwrap().channels;
        assert_eq!(results.len(), self.channels);
        for (channel, result) in results.iter().enumerate() {
            assert_eq!(
                (result.cause, result.fresh),
                (0, true),
                "{channel}: {result:?}"
            );
            let bench = self.card.bridge().transport().bench();
            let sent = bench.frames(channel).iter().rev().take(frames);
            let positions: Vec<u64> = sent.map(|f| f.position).collect();
            assert!(
                positions.contains(&result.position),
                "{channel}: {result:?} {positions:?}"
            );
        }
    }
}

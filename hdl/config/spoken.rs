//! What a channel speaks, in cycles.

use super::*;
use crate::protocols::{of_spoken, Spoken};
use endat_regs::{Protocol, Protocols};

impl Spoken {
    fn resolve(
        &self,
        check: &mut Check<'_>,
        request: &ChannelSpec,
        system_hz: u64,
        double_edge: bool,
    ) -> Option<ChannelConfig> {
        of_spoken!(
            self,
            ChannelConfig::of_endat(check, request, system_hz, double_edge),
            asked => asked.resolve(check, request, system_hz)
        )
    }
}

impl ChannelConfig {
    /// Converts and checks one channel; `Err` has every problem found.
    pub fn resolve(
        request: &ChannelSpec,
        system_hz: u64,
        double_edge: bool,
        index: usize,
    ) -> Result<Self, Vec<Problem>> {
        let mut problems = Vec::new();
        let mut check = Check::new(Section::Channel(index), &mut problems);
        let spoken = request.spoken;
        let resolved = spoken.resolve(&mut check, request, system_hz, double_edge);
        if let Some(config) = &resolved {
            range::check_range(&mut check, config);
        }
        match resolved {
            Some(config) if problems.is_empty() => Ok(config),
            _ => Err(problems),
        }
    }

    /// What it speaks.
    pub const fn protocol(&self) -> Protocol {
        self.spoken.protocol()
    }

    /// Whether that is EnDat.
    pub fn is_endat(&self) -> bool {
        self.protocol() == Protocol::Endat
    }

    /// Shortest time between two triggers in the worst case, in system clock cycles.
    pub fn cycle_max_cycles(&self, system_hz: u64) -> u64 {
        of_spoken!(
            &self.spoken,
            self.frame_cycle_max_cycles(system_hz),
            asked => asked.cycle_max_cycles(self, system_hz)
        )
    }

    /// Why a trigger would come before the channel is ready, and the remedy.
    pub(crate) fn too_long(&self, index: usize, times: TooLong) -> String {
        of_spoken!(
            &self.spoken,
            frame_too_long(index, self, times),
            asked => asked.too_long(index, self, times)
        )
    }
}

impl CardConfig {
    /// What each channel speaks.
    pub fn protocols(&self) -> Protocols {
        let channels = self.channels.iter().enumerate();
        channels.fold(Protocols::ENDAT, |all, (n, c)| all.with(n, c.protocol()))
    }

    /// Numbers of the channels that speak a protocol.
    pub fn speakers(&self, protocol: Protocol) -> impl Iterator<Item = usize> + '_ {
        let channels = self.channels.iter().enumerate();
        let speakers = channels.filter(move |(_, c)| c.protocol() == protocol);
        speakers.map(|(n, _)| n)
    }

    /// Whether a channel speaks it.
    pub fn speaks(&self, protocol: Protocol) -> bool {
        self.speakers(protocol).next().is_some()
    }

    /// Channels that speak EnDat, with their numbers.
    pub fn endat_channels(&self) -> impl Iterator<Item = (usize, &ChannelConfig)> {
        let channels = self.channels.iter().enumerate();
        channels.filter(|(_, c)| c.is_endat())
    }
}

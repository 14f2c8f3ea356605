//! Protocol of a channel, converted to cycles.

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

    /// Protocol of the channel.
    pub const fn protocol(&self) -> Protocol {
        self.spoken.protocol()
    }

    /// True for EnDat.
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

    /// Message for a trigger that comes before the channel is ready, with the remedy.
    pub(crate) fn too_long(&self, index: usize, times: TooLong) -> String {
        of_spoken!(
            &self.spoken,
            frame_too_long(index, self, times),
            asked => asked.too_long(index, self, times)
        )
    }
}

impl CardConfig {
    /// Protocol of each channel.
    pub fn protocols(&self) -> Protocols {
        let channels = self.channels.iter().enumerate();
        channels.fold(Protocols::ENDAT, |all, (n, c)| all.with(n, c.protocol()))
    }

    /// Numbers of the channels with a protocol.
    pub fn speakers(&self, protocol: Protocol) -> impl Iterator<Item = usize> + '_ {
        let channels = self.channels.iter().enumerate();
        let speakers = channels.filter(move |(_, c)| c.protocol() == protocol);
        speakers.map(|(n, _)| n)
    }

    /// True if a channel has the protocol.
    pub fn speaks(&self, protocol: Protocol) -> bool {
        self.speakers(protocol).next().is_some()
    }

    /// EnDat channels, with their numbers.
    pub fn endat_channels(&self) -> impl Iterator<Item = (usize, &ChannelConfig)> {
        let channels = self.channels.iter().enumerate();
        channels.filter(|(_, c)| c.is_endat())
    }
}

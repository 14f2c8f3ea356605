//! The protocols that a channel may speak, as far as a host has to do with them: beside the folder of each, the one file here that knows
//! them by name.

use crate::card::Card;
use crate::name_plate::Told;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::Protocol;

impl<T: Transport> Card<T> {
    /// What the encoder of a channel tells of itself, or why it does not; none of EnDat, whose encoders have name plates, and where an encoder
    /// tells nothing.
    pub fn ask_encoder(
        &mut self,
        channel: usize,
    ) -> Result<Option<Result<Told, String>>, HostError> {
        match self.identity().protocol(channel) {
            Protocol::TFormat => Ok(Some(
                self.t_format_state(channel)?.map(|state| state.told()),
            )),
            _ => Ok(None),
        }
    }
}

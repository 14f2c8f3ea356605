//! The protocols of a channel, as far as the host handles them. Apart from the folder of each, only this file of the crate names
//! them.

use crate::card::Card;
use crate::name_plate::Told;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::Protocol;

impl<T: Transport> Card<T> {
    /// Asks the encoder of a channel for its description. Returns the reason if this fails, and `None` for EnDat, whose encoders have name plates,
    /// and for encoders without a description.
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

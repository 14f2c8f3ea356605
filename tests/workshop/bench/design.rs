//! The card that is run.

use endat_config::{load_preset, DEFAULT_PRESET};
use endat_console::error::CommandError;
use endat_hdl::card::Card;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;
use std::path::Path;

/// The two-channel card, elaborated.
pub struct CardDesign {
    /// Name of the top module.
    pub name: String,
    /// The design.
    pub design: Design,
    /// System clock.
    pub system_hz: u64,
    /// Baud rate of the host link.
    pub baud: u64,
}

impl CardDesign {
    /// The block itself.
    pub fn block() -> Result<Card, CommandError> {
        let mut block = Card::new(&load_preset(DEFAULT_PRESET)?.card);
        block.connect_all();
        Ok(block)
    }

    /// The card of the preset.
    pub fn new() -> Result<Self, CommandError> {
        let card = load_preset(DEFAULT_PRESET)?.card;
        let design = elaborate(&Self::block()?, DEFAULT_PRESET).map_err(|e| super::fault(&e))?;
        Ok(Self {
            name: DEFAULT_PRESET.into(),
            design,
            system_hz: card.system_hz,
            baud: card.baud,
        })
    }

    /// Writes its Verilog into a folder; the names of the files.
    pub fn write(&self, folder: &Path) -> Result<Vec<String>, CommandError> {
        let files = endat_emit::sources::untitled(&self.design);
        endat_console::artifact::write(folder, &files, endat_tools::scratch::REMEDY)?;
        Ok(files.into_iter().map(|f| f.path).collect())
    }
}

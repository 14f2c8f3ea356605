//! The words of an encoder, in areas selected by an MRS code.

use super::{status::Status, words, EncoderConfig, ErrorSource};
use std::collections::BTreeMap;

/// MRS codes of the areas, as in TI's and ADDI-DATA's drivers.
pub mod area {
    /// Encoder manufacturer, words 4 to 15 at addresses 0x04 to 0x0F.
    pub const MANUFACTURER_1: u8 = 0xA1;
    /// Encoder manufacturer, words 16 to 31.
    pub const MANUFACTURER_2: u8 = 0xA3;
    /// Encoder manufacturer, words 32 to 47.
    pub const MANUFACTURER_3: u8 = 0xA5;
    /// Operating parameters: datum shift in words 0 (low) and 1, configuration of diagnostics in word 3.
    pub const OPERATING_PARAMETERS: u8 = 0xA7;
    /// OEM parameters, part 1.
    pub const OEM_1: u8 = 0xA9;
    /// Operating status: alarms, warnings, write protection, function initialisation.
    pub const OPERATING_STATUS: u8 = 0xB9;
    /// Encoder manufacturer, for EnDat 2.2.
    pub const MANUFACTURER_22: u8 = 0xBD;
    /// Section 2: four blocks of 256 words, EnDat 2.2 only.
    pub const SECTION_2: u8 = 0xBF;
}

/// Words of [`area::OPERATING_STATUS`].
pub mod status_word {
    /// Alarms; 0 clears them.
    pub const ALARMS: u8 = 0;
    /// Warnings; 0 clears them.
    pub const WARNINGS: u8 = 1;
    /// Write protection: a bit once set stays.
    pub const PROTECTION: u8 = 2;
    /// Function initialisation: bits 1..0 = 10 for the long recovery time, 01 for the short one.
    pub const FUNCTION: u8 = 3;
}

/// Areas protected by bit 0, 1, 2 of the protection word. The assignment is not published: an assumption.
const PROTECTED_BY_BIT: [u8; 3] = [area::OPERATING_PARAMETERS, area::OEM_1, area::SECTION_2];
const BLOCK_WORDS: usize = 256;

/// MRS codes of areas in the interface description, supported or not.
fn is_area_code(mrs: u8) -> bool {
    (0xA1..=0xBF).contains(&mrs) && mrs & 1 == 1
}

#[derive(Clone)]
struct Area {
    first: usize,
    words: Vec<u16>,
    writable: bool,
}

/// Address of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub mrs: u8,
    pub block: u8,
    pub address: u8,
}

impl Place {
    fn index(self) -> usize {
        usize::from(self.block) * BLOCK_WORDS + usize::from(self.address)
    }
}

#[derive(Clone)]
pub(super) struct Memory {
    areas: BTreeMap<u8, Area>,
    /// Selected area and block.
    pub selected: Option<(u8, u8)>,
}

impl Memory {
    /// Memory as delivered by the factory.
    pub fn new(config: &EncoderConfig) -> Self {
        use area::*;
        let mut areas = BTreeMap::new();
        let mut put = |mrs, first, words, writable| {
            let area = Area {
                first,
                words,
                writable,
            };
            areas.insert(mrs, area);
        };
        let manufacturer = words::manufacturer(config);
        put(MANUFACTURER_1, 4, manufacturer[4..16].to_vec(), false);
        put(MANUFACTURER_2, 0, manufacturer[16..32].to_vec(), false);
        put(MANUFACTURER_3, 0, manufacturer[32..48].to_vec(), false);
        put(OPERATING_PARAMETERS, 0, vec![0; 16], true);
        put(OEM_1, 0, vec![0; 64], true); // 64 words as in TI's driver; its size differs from encoder to encoder
        put(OPERATING_STATUS, 0, vec![0, 0, 0, config.function], true);
        if config.endat22 {
            put(MANUFACTURER_22, 0, words::manufacturer_22(config), false);
            put(SECTION_2, 0, vec![0; 4 * BLOCK_WORDS], true);
        }
        Self {
            areas,
            selected: None,
        }
    }

    /// State after a loss of supply, or a reset.
    pub fn restart(&mut self, config: &EncoderConfig) {
        self.selected = None;
        self.set(
            Place {
                mrs: area::OPERATING_STATUS,
                block: 0,
                address: status_word::FUNCTION,
            },
            config.function,
        );
    }

    /// Checks that this area can be selected.
    pub fn check_area(&self, mrs: u8, block: u8) -> Result<(), ErrorSource> {
        match self.areas.get(&mrs) {
            Some(a) if usize::from(block) * BLOCK_WORDS < a.words.len() => Ok(()),
            Some(_) => Err(ErrorSource::Block),
            None if is_area_code(mrs) => Err(ErrorSource::MrsNotAllowed),
            None => Err(ErrorSource::MrsCode),
        }
    }

    /// The place of an address in the selected area.
    pub fn place(&self, address: u8) -> Result<Place, ErrorSource> {
        let (mrs, block) = self.selected.ok_or(ErrorSource::Address)?;
        self.place_in(mrs, block, address)
    }

    /// The place of an address in an existing area.
    pub fn place_in(&self, mrs: u8, block: u8, address: u8) -> Result<Place, ErrorSource> {
        let place = Place {
            mrs,
            block,
            address,
        };
        let area = &self.areas[&mrs];
        let known = area.first..area.first + area.words.len();
        let known = known.contains(&place.index());
        known.then_some(place).ok_or(ErrorSource::Address)
    }

    /// Checks that this value may be written to this word.
    pub fn check_write(&self, place: Place, data: u16) -> Result<(), ErrorSource> {
        let protection = self.word(area::OPERATING_STATUS, status_word::PROTECTION);
        let bit = PROTECTED_BY_BIT.iter().position(|m| *m == place.mrs);
        let protected = bit.is_some_and(|bit| protection >> bit & 1 != 0);
        if protected || !self.areas[&place.mrs].writable {
            return Err(ErrorSource::Protected);
        }
        match (place.mrs, place.address) {
            (area::OPERATING_STATUS, status_word::PROTECTION) if protection & !data != 0 => {
                Err(ErrorSource::ClearProtection)
            }
            // Only whole words can be cleared, and alarms cannot be set from outside.
            (area::OPERATING_STATUS, status_word::ALARMS | status_word::WARNINGS) if data != 0 => {
                Err(ErrorSource::Protected)
            }
            _ => Ok(()),
        }
    }

    /// The word at a place from [`Memory::place`]. Alarms and warnings are stored separately.
    pub fn get(&self, place: Place, status: &Status) -> u16 {
        match (place.mrs, place.address) {
            (area::OPERATING_STATUS, status_word::ALARMS) => status.alarms,
            (area::OPERATING_STATUS, status_word::WARNINGS) => status.warnings,
            _ => self.stored(place),
        }
    }

    fn stored(&self, place: Place) -> u16 {
        let area = &self.areas[&place.mrs];
        area.words[place.index() - area.first]
    }

    /// Stores a word.
    pub fn set(&mut self, place: Place, data: u16) {
        if let Some(area) = self.areas.get_mut(&place.mrs) {
            area.words[place.index() - area.first] = data;
        }
    }

    /// A word of an area that every encoder has.
    pub fn word(&self, mrs: u8, address: u8) -> u16 {
        self.stored(Place {
            mrs,
            block: 0,
            address,
        })
    }

    /// Offset that the encoder adds to its position.
    pub fn datum_shift(&self) -> i32 {
        let word = |address| u32::from(self.word(area::OPERATING_PARAMETERS, address));
        (word(1) << 16 | word(0)) as i32
    }
}

//! The EEPROM of a T-format encoder: pages of 127 bytes, the page register at address 127.

use crate::Time;

const PAGE_ADDRESS: u8 = 127;
const BUSY: u8 = 1 << 7;

#[derive(Clone)]
pub(super) struct Eeprom {
    pages: Vec<[u8; 127]>,
    page: u8,
    busy_until: Time,
}

impl Eeprom {
    pub fn new(pages: u8) -> Self {
        Self {
            pages: vec![[0; 127]; usize::from(pages)],
            page: 0,
            busy_until: 0,
        }
    }

    pub fn byte(&self, page: u8, address: u8) -> u8 {
        let page = self.pages.get(usize::from(page));
        page.and_then(|p| p.get(usize::from(address)))
            .copied()
            .unwrap_or(0)
    }

    /// A read or a write; returns address and data of the reply.
    pub fn access(
        &mut self,
        address: u8,
        write: Option<u8>,
        now: Time,
        write_time: Time,
    ) -> (u8, u8) {
        let address = address & !BUSY;
        if now < self.busy_until {
            return (address | BUSY, 0);
        }
        if let Some(data) = write {
            if address == PAGE_ADDRESS {
                self.page = data;
                return (address, data);
            }
            let page = self.pages.get_mut(usize::from(self.page));
            if let Some(byte) = page.and_then(|p| p.get_mut(usize::from(address))) {
                *byte = data;
            }
            self.busy_until = now + write_time;
            return (address, data);
        }
        let data = match address {
            PAGE_ADDRESS => self.page,
            _ => self.byte(self.page, address),
        };
        (address, data)
    }
}

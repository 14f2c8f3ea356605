//! No bus: one encoder port with its signals.

use crate::error::GenError;
use crate::front::{design_of, Front};
use endat_hdl::card::bare_port;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::program::ServiceTimes;
use rtl_design::elaborate::Design;

/// See the module.
pub(super) struct Bare;

impl Front for Bare {
    fn design(
        &self,
        card: &CardConfig,
        name: &str,
        _: &ServiceTimes,
        _: u64,
    ) -> Result<Design, GenError> {
        design_of(bare_port(card), name)
    }
}

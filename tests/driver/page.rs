use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;
use endat_driver::{signed, Card, Error, Spi};

/// Shows angles of encoder 0, also over a plug that is pulled and put back.
pub fn angles<S: SpiDevice, D: DelayNs>(
    device: S,
    delay: D,
    mut show: impl FnMut(Result<i64, &'static str>) -> bool,
) -> Result<(), Error<S::Error>> {
    let mut card = Card::open(Spi::new(device), delay, None)?;
    card.try_link()?;
    card.wait_ready(0, 5_000)?; // the card initialises the encoder: two seconds
    loop {
        let shown = match card.measure_channels(1, 1_000) {
            Ok(moment) => match moment.results()[0] {
                result if result.fresh => Ok(signed(result.position, result.width_bits)),
                result => Err(result.cause_meaning()),
            },
            Err(Error::Timeout) => Err("no result: unplugged?"),
            Err(error) => return Err(error),
        };
        if shown.is_err() {
            card.wait_ready(0, 20_000)?; // pull the plug, and put it back within 20 s
        }
        if !show(shown) {
            return Ok(());
        }
    }
}

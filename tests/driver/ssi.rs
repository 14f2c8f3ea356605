//! Channels with SSI, as the drivers have them: positions and causes, and a refusal of everything that asks an encoder for something.

use super::rig::Rig;
use super::world::World;
use super::{home, sources};
use crate::tools;
use endat_config::{parse, preset};
use endat_driver::{Card, Error, Range, Uart};
use endat_regs::Protocol;

#[test]
fn the_rust_driver_has_positions_and_refuses_what_an_ssi_encoder_has_not() {
    let project = parse("ssi.toml", preset("ssi_two_channel").unwrap()).unwrap();
    let world = World::new(Rig::of_virtual_card(&project));
    let mut card = Card::open(Uart::new(world.clone()), world.clone(), None).unwrap();
    assert_eq!([0, 1].map(|n| card.facts().protocol(n)), [Protocol::Ssi; 2]);
    world.told("delay 3e8");
    let results = card.read_moment().unwrap();
    for result in results.results() {
        assert!(result.fresh && result.valid && result.fits, "{result:?}");
        assert_eq!((result.cause, result.width_bits), (0, 0));
        assert_ne!(result.position, 0);
    }
    let turns = Range::rotary(13, 12, Protocol::Ssi).unwrap();
    assert_eq!(
        [0, 1].map(|n| card.read_range(n).unwrap()),
        [turns, Range::Linear]
    );
    assert_eq!(card.read_range(2), Err(Error::Argument));
    assert_eq!(card.read_eeprom(0, 1, 10), Err(Error::Protocol));
    assert_eq!(card.read_state(1).err(), Some(Error::Protocol));
    world.is_content();
}

/// Catches a C driver that takes a cause of one protocol for that of another one, and a channel for another one's.
#[test]
fn the_c_driver_knows_what_each_channel_speaks() {
    if !tools::require("gcc", "C driver") {
        return;
    }
    let folder = tools::folder("driver-protocols");
    let program = r#"
#include "endat.h"
#include "endat_internal.h"
/* The same bits in status.line of every channel. */
static endat_error burst(void *context, uint32_t address, uint32_t count, uint32_t *values)
{
    (void)context;
    (void)address;
    for (uint32_t n = 0u; n < count; n++) {
        values[n] = (n % ENDAT_MAP_RESULT_STRIDE_WORDS == 0u) ? 0x12C00001u : 0u;
    }
    return ENDAT_OK;
}
int main(void)
{
    endat_moment moment;
    const uint32_t word = 0x02000001u; /* channel 0 T-format, channel 1 SSI */
    const uint32_t speaks[3] = {ENDAT_PROTOCOL_T_FORMAT, ENDAT_PROTOCOL_SSI, ENDAT_PROTOCOL_ENDAT};
    endat_card card = {0};
    int wrong = 0;
    card.channels = 3u;
    card.protocols = word;
    for (uint32_t n = 0u; n < 3u; n++) {
        wrong |= endat_protocol(&card, n) != speaks[n];
        wrong |= endat_needs_endat(&card, n) != (n == 2u ? ENDAT_OK : ENDAT_ERROR_PROTOCOL);
        wrong |= endat_needs_t_format(&card, n) != (n == 0u ? ENDAT_OK : ENDAT_ERROR_PROTOCOL);
    }
    card.link.read_burst = burst;
    wrong |= endat_read_moment(&card, &moment) != ENDAT_OK;
    for (uint32_t n = 0u; n < 3u; n++) {
        wrong |= moment.channel[n].special_bits != (n == 1u ? 0x12u : 0u);
    }
    wrong |= endat_needs_endat(&card, 3u) != ENDAT_ERROR_ARGUMENT;
    wrong |= endat_cause_of(5u, ENDAT_PROTOCOL_ENDAT) != ENDAT_CAUSE_F1;
    wrong |= endat_cause_of(5u, ENDAT_PROTOCOL_SSI) != ENDAT_CAUSE_COPIES_DIFFER;
    wrong |= endat_cause_of(6u, ENDAT_PROTOCOL_SSI) != ENDAT_CAUSE_UPSET;
    wrong |= endat_cause_of(10u, ENDAT_PROTOCOL_SSI) != ENDAT_CAUSE_POWER_FAIL;
    wrong |= endat_cause_of(5u, ENDAT_PROTOCOL_T_FORMAT) != ENDAT_CAUSE_CONTROL_PARITY;
    wrong |= endat_cause_of(30u, ENDAT_PROTOCOL_SSI) != 94u;
    return wrong;
}
"#;
    std::fs::write(folder.join("main.c"), program).unwrap();
    let include = format!("-I{}", home().display());
    let mut arguments = vec![
        "-std=c99", "-Wall", "-Werror", "-o", "run", "main.c", &include,
    ];
    let sources = sources();
    arguments.extend(sources.iter().map(String::as_str));
    let (is_good, text) = tools::run("gcc", &folder, &arguments);
    assert!(is_good, "{text}");
    let run = folder.join("run");
    let (is_good, text) = tools::run(run.to_str().unwrap(), &folder, &[]);
    assert!(is_good, "{text}");
}

//! An EnDat channel does not know who its neighbours are.

use super::*;

/// The pins of EnDat channel `endat` in every cycle of a run with triggers at the pin.
fn pins(channels: &[&str], endat: usize) -> Vec<[u128; 5]> {
    let project = project(channels, "\"pin\"", "");
    let mut master = Master::at_channels(&project, &[(endat, 29)]);
    for (n, _) in channels.iter().enumerate().filter(|(_, c)| **c == T) {
        let link = TFormatLink::new(EncoderConfig::default(), US / 20);
        master.bench.add_t_format(&PinNames::card(n), link);
    }
    let names = [
        "endat_clk",
        "endat_data",
        "endat_data",
        "endat_data",
        "led_channel",
    ];
    let ends = ["_o", "_o", "_oe", "_i", "_o"];
    let names: Vec<String> = (names.iter().zip(ends))
        .map(|(name, end)| format!("{name}{endat}{end}"))
        .collect();
    let mut rows = Vec::new();
    for round in 0..12 {
        master.bench.trigger();
        let cycles = if round == 0 {
            40_000
        } else {
            8_000 + 37 * round
        };
        for _ in 0..cycles {
            master.bench.run_cycles(1);
            let mut row = [0; 5];
            for (value, name) in row.iter_mut().zip(&names) {
                *value = master.bench.get(name);
            }
            rows.push(row);
        }
    }
    // The first trigger's frame is one more, which measures.
    assert_eq!(master.bench.frames(0).len(), 13);
    rows
}

/// The channels of each case, and which of them is the one that speaks EnDat.
fn an_endat_channel_is_the_same(cases: &[(&[&str], usize)]) {
    let alone = pins(&[ENDAT], 0);
    assert!(alone.iter().any(|row| row[4] == 1));
    for &(channels, endat) in cases {
        let beside = pins(channels, endat);
        let first = alone.iter().zip(&beside).position(|(a, b)| a != b);
        assert_eq!(first, None, "{channels:?}");
    }
}

#[test]
fn an_endat_channel_is_the_same_bit_by_bit_with_two_neighbours() {
    an_endat_channel_is_the_same(&[(&[T, ENDAT, T], 1)]);
}

#[test]
#[ignore = "slow: an EnDat channel with any neighbours that speak T-format"]
fn an_endat_channel_is_the_same_bit_by_bit_with_any_neighbour() {
    an_endat_channel_is_the_same(&[(&[ENDAT, T], 0), (&[T, ENDAT], 1), (&[T, ENDAT, T], 1)]);
}

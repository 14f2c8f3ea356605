//! The core's three CRC blocks, compared with published vectors and a CRC library.

use endat_hdl::endat::crc5::{Crc5Check, Crc5Fixed, Crc5Word, MAX_COVERED_BITS};
use endat_sim::rng::Rng;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine};
use rust_hdl::prelude::Block;
use std::sync::LazyLock;

/// Covered bits in the order of transmission, with their CRC.
struct Vector {
    name: String,
    bits: Vec<bool>,
    crc: u8,
}

fn vectors() -> Vec<Vector> {
    let text = include_str!("../../../tests/data/crc_vectors.json");
    let file: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let bits =
        |text: &serde_json::Value| text.as_str().unwrap().bytes().map(|b| b == b'1').collect();
    let frames = file["vectors"].as_array().unwrap().iter().map(|v| Vector {
        name: v["id"].as_str().unwrap().into(),
        bits: bits(&v["covered_bits_tx_order"]),
        crc: u8::from_str_radix(v["crc_hex"].as_str().unwrap().trim_start_matches("0x"), 16)
            .unwrap(),
    });
    let random = file["random_bitstrings"].as_array().unwrap().iter();
    let random = random.map(|v| Vector {
        name: v["bits_tx_order"].to_string(),
        bits: bits(&v["bits_tx_order"]),
        crc: v["crc"].as_u64().unwrap() as u8,
    });
    let all: Vec<Vector> = frames.chain(random).collect();
    assert_eq!(all.len(), 62 + 64);
    all
}

fn compiled(mut block: impl Block) -> Compiled {
    block.connect_all();
    let design = elaborate(&block, "crc").expect("the block elaborates");
    Compiled::new(&design).expect("no loop")
}

/// The CRCs that the run-time block accepts for these covered bits, of which the first `error_bits` are F1 and F2.
fn parallel(engine: &mut Compiled, bits: &[bool], error_bits: usize) -> Vec<u8> {
    let [clear, word_bit, crc_bit, bit] =
        ["clear", "word_bit", "crc_bit", "bit"].map(|name| engine.port(name));
    let is_ok = engine.port("is_ok");
    let error_bit = |i: usize| u128::from(error_bits > i && bits[i]);
    for (name, value) in [
        ("has_f1", u128::from(error_bits > 0)),
        ("has_f2", u128::from(error_bits > 1)),
        ("f1", error_bit(0)),
        ("f2", error_bit(1)),
    ] {
        let port = engine.port(name);
        engine.set(port, value);
    }
    let word = bits[error_bits..]
        .iter()
        .rev()
        .fold(0, |word, bit| word << 1 | u128::from(*bit));
    let port = engine.port("word");
    engine.set(port, word);
    (0..32)
        .filter(|crc| {
            let mut strobe = |port, level: bool| {
                engine.set(bit, level.into());
                engine.set(port, 1);
                engine.tick();
                engine.set(port, 0);
            };
            strobe(clear, false);
            bits[error_bits..].iter().for_each(|b| strobe(word_bit, *b));
            (0..5).for_each(|i| strobe(crc_bit, crc >> (4 - i) & 1 == 1));
            engine.get(is_ok) != 0
        })
        .collect()
}

/// A block of exactly this length, if the list has one: the top bit was received first.
fn fixed(bits: &[bool]) -> Option<u8> {
    macro_rules! lengths {
        ($($n:literal)*) => {
            match bits.len() {
                $($n => compiled(Crc5Fixed::<$n>::default()),)*
                _ => return None,
            }
        };
    }
    let mut engine = lengths!(6 9 11 14 15 16 20 21 23 24 26 27 28 29 30 31 33 34 35 37 38 39 41 44 47 50 51 60 64 68);
    let (word, crc) = (engine.port("word"), engine.port("crc"));
    engine.set(word, bits.iter().fold(0, |w, b| w << 1 | u128::from(*b)));
    Some(engine.get(crc) as u8)
}

/// The CRC of the word on reception, with its last bit at the lowest of the four places that fits.
fn as_it_comes(engine: &mut Compiled, bits: &[bool]) -> u8 {
    let [word, covered, crc] = ["word", "covered", "crc"].map(|name| engine.port(name));
    let places = [5, 20, 35, 50].into_iter().find(|n| *n >= bits.len());
    let shift = places.expect("at most 50 bits") - bits.len();
    let value = (bits.iter().rev()).fold(0, |word, bit| word << 1 | u128::from(*bit));
    engine.set(word, value << shift);
    engine.set(covered, bits.len() as u128 % 15);
    engine.get(crc) as u8
}

/// The CRC library works on bytes: leading zeros fill the first one, and the preset is the value that they turn into 11111.
fn library(bits: &[bool]) -> u8 {
    static CRC: LazyLock<crc::Crc<u8>> = LazyLock::new(|| {
        crc::Crc::<u8>::new(&crc::Algorithm {
            width: 5,
            poly: 0x0B,
            init: 0x1F,
            refin: false,
            refout: false,
            xorout: 0x1F,
            check: 0,
            residue: 0,
        })
    });
    let fill = bits.len().next_multiple_of(8) - bits.len();
    // x^15 = 1: 15 - fill (or 30 - ...) zeros before them undo `fill` entering zeros.
    let preset = (0..32).find(|start| {
        let mut register = *start;
        (0..fill).for_each(|_| {
            register = (register << 1 & 0x1F) ^ if register & 16 != 0 { 0x0B } else { 0 }
        });
        register == 0x1F
    });
    let padded: Vec<bool> = std::iter::repeat_n(false, fill)
        .chain(bits.iter().copied())
        .collect();
    let bytes: Vec<u8> = padded
        .chunks(8)
        .map(|c| c.iter().fold(0, |byte, b| byte << 1 | u8::from(*b)))
        .collect();
    let mut digest =
        CRC.digest_with_initial(preset.expect("zeros are a permutation of the register"));
    digest.update(&bytes);
    digest.finalize()
}

#[test]
fn every_published_vector_holds_in_all_blocks() {
    let (mut stored, mut coming) = (
        compiled(Crc5Check::default()),
        compiled(Crc5Word::default()),
    );
    let (mut at_run_time, mut at_fixed_length) = (0, 0);
    for v in vectors() {
        assert_eq!(library(&v.bits), v.crc, "library: {}", v.name);
        if v.bits.len() <= MAX_COVERED_BITS {
            for error_bits in 0..=2 {
                if !(1..=48).contains(&v.bits.len().saturating_sub(error_bits)) {
                    continue;
                }
                let got = parallel(&mut stored, &v.bits, error_bits);
                assert_eq!(got, [v.crc], "{}, {error_bits} error bits", v.name);
            }
            assert_eq!(
                as_it_comes(&mut coming, &v.bits),
                v.crc,
                "as it comes: {}",
                v.name
            );
            at_run_time += 1;
        }
        if let Some(crc) = fixed(&v.bits) {
            assert_eq!(crc, v.crc, "fixed length: {}", v.name);
            at_fixed_length += 1;
        }
    }
    assert!(
        at_run_time >= 100 && at_fixed_length >= 90,
        "{at_run_time}, {at_fixed_length}"
    );
}

#[test]
fn random_words_of_every_length_agree_with_the_library() {
    let (mut stored, mut coming) = (
        compiled(Crc5Check::default()),
        compiled(Crc5Word::default()),
    );
    let mut rng = Rng::new(5);
    for length in 1..=MAX_COVERED_BITS {
        for _ in 0..20 {
            let word = rng.next_u64();
            let bits: Vec<bool> = (0..length).map(|i| word >> i & 1 != 0).collect();
            let want = library(&bits);
            for error_bits in 0..=2 {
                if !(1..=48).contains(&length.saturating_sub(error_bits)) {
                    continue;
                }
                let got = parallel(&mut stored, &bits, error_bits);
                assert_eq!(got, [want], "{bits:?}, {error_bits} error bits");
            }
            assert_eq!(as_it_comes(&mut coming, &bits), want, "{bits:?}");
        }
    }
}

/// The block for the verdict is a sum of bits and constants, and so is a CRC: both agree on every word of a length if they agree on 0 and on
/// each single bit. So this is a proof for every width, with and without F1 and F2.
#[test]
fn the_crc_of_every_word_is_that_of_the_library() {
    let mut coming = compiled(Crc5Word::default());
    for length in 1..=MAX_COVERED_BITS {
        let mut bits = vec![false; length];
        assert_eq!(
            as_it_comes(&mut coming, &bits),
            library(&bits),
            "{length} zeros"
        );
        for one in 0..length {
            bits[one] = true;
            assert_eq!(
                as_it_comes(&mut coming, &bits),
                library(&bits),
                "{length} bits, bit {one}"
            );
            bits[one] = false;
        }
    }
}

//! What positions are, as both drivers take it from the words of a card: the same vectors in C and in Rust.

use crate::tools;
use endat_driver::regs::protocols::t_format::request;
use endat_driver::regs::{range, Protocol, Protocols, CHANNEL_CONFIG};
use endat_driver::{Range, Turns};

/// Words of a channel's configuration.
fn words(position_bits: u32, multi_turn_bits: u32, kind: u8, request_id: u8) -> [u32; 3] {
    let put = |register, field, value| {
        let field = CHANNEL_CONFIG.field(register, field);
        field.put(0, value).unwrap()
    };
    [
        put("frame", "position_bits", position_bits),
        put("timing", "multi_turn_bits", multi_turn_bits)
            | put("timing", "request_id", request_id.into()),
        put("limits", "range", kind.into()),
    ]
}

/// A card's words, what they mean as single-turn bits, multi-turn bits and their lowest one, and a move: from, to, steps.
type Vector = (Protocol, [u32; 3], Range, [u64; 2], i64);

fn rotary(single_turn_bits: u32, multi_turn_bits: u32, turns_at: u32) -> Range {
    Range::Rotary(Turns {
        single_turn_bits,
        multi_turn_bits,
        turns_at,
    })
}

fn vectors() -> Vec<Vector> {
    use Protocol::{Endat, Ssi, TFormat};
    let (all, single) = (request::EVERYTHING, request::SINGLE_TURN);
    let t_format = words(33, 16, range::ROTARY, all);
    let of_17 = rotary(17, 16, 24);
    let (last, first) = (100 << 24 | 130_285, 101 << 24);
    vec![
        (TFormat, t_format, of_17, [last, first], 787),
        (TFormat, t_format, of_17, [first, last], -787),
        // Over the last turn that is counted.
        (TFormat, t_format, of_17, [0xFFFF << 24 | 0x1_FFFF, 2], 3),
        // A request without turns: those in the position are old.
        (
            TFormat,
            words(33, 16, range::ROTARY, single),
            rotary(17, 0, 24),
            [7 << 24 | 5, 9 << 24 | 0x1_FFFF],
            -6,
        ),
        (
            TFormat,
            words(60, 16, range::ROTARY, all),
            Range::Unknown,
            [0, 1],
            0,
        ),
        (
            Ssi,
            words(25, 12, range::ROTARY, 0),
            rotary(13, 12, 13),
            [0x1FF_FFFF, 1],
            2,
        ),
        // More than a turn at once.
        (
            Ssi,
            words(25, 12, range::ROTARY, 0),
            rotary(13, 12, 13),
            [7, 3 << 13 | 12],
            (3 << 13) + 5,
        ),
        (
            Ssi,
            words(24, 0, range::LINEAR, 0),
            Range::Linear,
            [1, 0xFF_FFFF],
            0xFF_FFFE,
        ),
        (
            Endat,
            words(37, 12, range::ROTARY, 0),
            rotary(25, 12, 25),
            [(1 << 25) - 10, (1 << 25) + 5],
            15,
        ),
        (
            Endat,
            words(37, 12, range::ROTARY, 0),
            rotary(25, 12, 25),
            [4, (1 << 37) - 4],
            -8,
        ),
        (
            Endat,
            words(29, 0, range::UNKNOWN, 0),
            Range::Unknown,
            [0, 1],
            0,
        ),
        (
            Endat,
            words(12, 12, range::ROTARY, 0),
            Range::Unknown,
            [0, 1],
            0,
        ),
    ]
}

#[test]
fn turns_and_their_ends_are_passed_in_rust() {
    for (protocol, words, wanted, [from, to], steps) in vectors() {
        let found = Range::of_words(words, protocol);
        assert_eq!(found, wanted, "{words:x?}");
        let is_known = wanted != Range::Unknown;
        assert_eq!(found.difference(from, to), is_known.then_some(steps));
        if let Some(turns) = found.turns() {
            let (turn, step) = turns.split(from);
            assert!(step < 1 << turns.single_turn_bits && turn < 1 << turns.multi_turn_bits);
            assert_eq!(turns.steps(from), turn << turns.single_turn_bits | step);
        }
    }
    let turns = rotary(17, 16, 24).turns().unwrap();
    assert!(turns.fits(100 << 24 | 130_285) && !turns.fits(1 << 17));
}

#[test]
fn turns_and_their_ends_are_passed_in_c() {
    if !tools::require("gcc", "C driver") {
        return;
    }
    let folder = tools::folder("driver-range");
    let mut rows = String::new();
    for (protocol, words, wanted, [from, to], steps) in vectors() {
        let protocols = Protocols::ENDAT.with(0, protocol).word();
        let [frame, timing, limits] = words;
        let (kind, bits) = match wanted {
            Range::Unknown => (range::UNKNOWN, [0; 3]),
            Range::Linear => (range::LINEAR, [0; 3]),
            Range::Rotary(t) => (
                range::ROTARY,
                [t.single_turn_bits, t.multi_turn_bits, t.turns_at],
            ),
        };
        let [single, multi, at] = bits;
        let turns = wanted.turns().map_or((0, 0), |turns| turns.split(from));
        rows += &format!(
            "    {{{protocols}u, {{{frame}u, {timing}u, {limits}u}}, {{{kind}u, {single}u, {multi}u, {at}u}}, {from}u, {to}u, {steps}, {}u, {}u}},\n",
            turns.0, turns.1
        );
    }
    let program = format!(
        r#"
#include <string.h>
#include "endat.h"
static const struct {{
    uint32_t protocols; uint32_t words[3]; endat_range range; uint64_t from; uint64_t to; int64_t steps; uint32_t turn; uint64_t step;
}} vectors[] = {{
{rows}}};
static endat_error read_word(void *context, uint32_t address, uint32_t *value)
{{
    *value = ((const uint32_t *)context)[address - ENDAT_MAP_CONFIG_FRAME_WORD(0u)];
    return ENDAT_OK;
}}
int main(void)
{{
    int wrong = 0;
    for (unsigned n = 0u; n < sizeof vectors / sizeof vectors[0]; n++) {{
        endat_card card = {{0}};
        endat_range range;
        uint32_t turn;
        uint64_t step;
        int64_t steps;
        uint32_t words[3];
        memcpy(words, vectors[n].words, sizeof words);
        card.channels = 1u;
        card.protocols = vectors[n].protocols;
        card.link.context = words;
        card.link.read = read_word;
        if (endat_read_range(&card, 0u, &range) != ENDAT_OK || memcmp(&range, &vectors[n].range, sizeof range) != 0) {{
            wrong |= 1;
        }}
        const int is_rotary = range.kind == ENDAT_MAP_CONFIG_LIMITS_RANGE_ROTARY;
        const int is_known = range.kind != ENDAT_MAP_CONFIG_LIMITS_RANGE_UNKNOWN;
        wrong |= (endat_turns(&range, vectors[n].from, &turn, &step) == (is_rotary ? ENDAT_OK : ENDAT_NOTHING)) ? 0 : 2;
        wrong |= (turn == vectors[n].turn && step == vectors[n].step) ? 0 : 4;
        wrong |= (endat_moved(&range, vectors[n].from, vectors[n].to, &steps) == (is_known ? ENDAT_OK : ENDAT_NOTHING)) ? 0 : 8;
        wrong |= (steps == vectors[n].steps) ? 0 : 16;
        wrong |= (endat_read_range(&card, 1u, &range) == ENDAT_ERROR_ARGUMENT) ? 0 : 32;
    }}
    return wrong;
}}
"#
    );
    std::fs::write(folder.join("main.c"), program).unwrap();
    let home = concat!(env!("CARGO_MANIFEST_DIR"), "/drivers/c");
    let include = format!("-I{home}");
    let mut arguments = vec![
        "-std=c99", "-Wall", "-Werror", "-o", "run", "main.c", &include,
    ];
    let sources = endat_emit::driver::FILES
        .iter()
        .filter(|(name, _)| name.ends_with(".c"));
    let sources: Vec<String> = sources.map(|(name, _)| format!("{home}/{name}")).collect();
    arguments.extend(sources.iter().map(String::as_str));
    let (is_good, text) = tools::run("gcc", &folder, &arguments);
    assert!(is_good, "{text}");
    let run = folder.join("run");
    let (is_good, text) = tools::run(run.to_str().unwrap(), &folder, &[]);
    assert!(is_good, "{text}");
}

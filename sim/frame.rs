//! Answers of an encoder, bit by bit, with their CRC5.
//!
//! Written from the encoder's side and independent of the core's CRC, so that each checks the other.

/// Bits of the CRC that ends every answer.
pub const CRC_BITS: u32 = 5;

/// CRC5 of `bits` in transmission order: long division by x^5+x^3+x+1 of the message followed by five zeros, with the
/// first five bits complemented (the preset of ones) and the remainder complemented. The MSB is transmitted first.
pub fn crc5(bits: impl Iterator<Item = bool>) -> u8 {
    const DIVISOR: u8 = 0b10_1011;
    let dividend = bits.chain([false; CRC_BITS as usize]);
    let remainder = dividend.enumerate().fold(0u8, |rest, (i, bit)| {
        let rest = rest << 1 | u8::from(bit ^ (i < CRC_BITS as usize));
        if rest & 0b10_0000 != 0 {
            rest ^ DIVISOR
        } else {
            rest
        }
    });
    remainder ^ 0b1_1111
}

/// A run of bits in transmission order: bit `i` of `word` is sent as number `i`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AnswerBits {
    /// The bits; those at and above `len` are zero.
    pub word: u128,
    /// Number of bits.
    pub len: u32,
}

impl AnswerBits {
    /// Bit number `index`, 0 for the first sent.
    pub fn get(&self, index: u32) -> bool {
        self.word >> index & 1 != 0
    }

    /// Appends one bit.
    pub fn push(&mut self, bit: bool) {
        self.word |= u128::from(bit) << self.len;
        self.len += 1;
    }

    /// Appends the low `width` bits of `value`, MSB first.
    pub fn push_msb_first(&mut self, value: u64, width: u32) {
        (0..width)
            .rev()
            .for_each(|i| self.push(value >> i & 1 != 0));
    }

    /// Appends all bits of `other`.
    pub fn append(&mut self, other: &AnswerBits) {
        self.word |= other.word << self.len;
        self.len += other.len;
    }

    /// The bits in transmission order.
    pub fn iter(&self) -> impl Iterator<Item = bool> + '_ {
        (0..self.len).map(|i| self.get(i))
    }

    /// The bits as `0`s and `1`s in transmission order.
    pub fn to_text(&self) -> String {
        self.iter().map(|b| if b { '1' } else { '0' }).collect()
    }
}

/// Content of a position answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionAnswer {
    /// First error bit, 1 = error.
    pub f1: bool,
    /// Second error bit, 0 = error; absent in EnDat 2.1 frames.
    pub f2: Option<bool>,
    /// The position.
    pub position: u64,
    /// Width in bits.
    pub position_bits: u32,
}

impl PositionAnswer {
    /// The covered bits: F1, F2, position LSB first.
    fn covered(&self) -> AnswerBits {
        let mut bits = AnswerBits::default();
        bits.push(self.f1);
        if let Some(f2) = self.f2 {
            bits.push(f2);
        }
        (0..self.position_bits).for_each(|i| bits.push(self.position >> i & 1 != 0));
        bits
    }

    /// The CRC of this answer.
    pub fn crc(&self) -> u8 {
        crc5(self.covered().iter())
    }

    /// The whole answer: start bit, covered bits, CRC MSB first.
    pub fn bits(&self) -> AnswerBits {
        self.bits_with_crc(self.crc())
    }

    /// The whole answer with another CRC.
    pub fn bits_with_crc(&self, crc: u8) -> AnswerBits {
        let mut bits = AnswerBits::default();
        bits.push(true);
        bits.append(&self.covered());
        bits.push_msb_first(crc.into(), CRC_BITS);
        bits
    }
}

/// An 8-bit and a 16-bit field, as a receiver sends them and an encoder answers them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parameter {
    /// MRS code, address or port.
    pub address: u8,
    /// Parameter, or other data that follow the 8 bits.
    pub data: u16,
}

impl Parameter {
    /// Both fields in one number: address in bits 23..16.
    pub fn from_word(word: u32) -> Self {
        Self {
            address: (word >> 16) as u8,
            data: word as u16,
        }
    }

    /// Both fields in one number: address in bits 23..16.
    pub fn word(&self) -> u32 {
        u32::from(self.address) << 16 | u32::from(self.data)
    }

    fn covered(&self) -> AnswerBits {
        let mut bits = AnswerBits::default();
        bits.push_msb_first(self.word().into(), 24);
        bits
    }

    /// The CRC of these fields.
    pub fn crc(&self) -> u8 {
        crc5(self.covered().iter())
    }

    /// The whole answer with this CRC: start bit, both fields, CRC.
    pub fn bits_with_crc(&self, crc: u8) -> AnswerBits {
        self.block(true, crc)
    }

    fn block(&self, first: bool, crc: u8) -> AnswerBits {
        let mut bits = AnswerBits::default();
        bits.push(first);
        bits.append(&self.covered());
        bits.push_msb_first(crc.into(), CRC_BITS);
        bits
    }
}

/// One block of additional data of an EnDat 2.2 answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Info {
    /// WRN: at least one warning.
    pub warning: bool,
    /// RM: the reference run is done.
    pub reference: bool,
    /// Busy: a memory request is in progress.
    pub busy: bool,
    /// MRS code that selected it; its low five bits are sent.
    pub code: u8,
    /// Content.
    pub content: u16,
}

impl Info {
    /// Length in bits, including the leading LOW and the CRC.
    pub const BITS: u32 = 30;

    /// The covered bits as two fields: status and code, content.
    pub fn fields(&self) -> Parameter {
        let status = [self.warning, self.reference, self.busy];
        let status = status.iter().fold(0, |s, bit| s << 1 | u8::from(*bit));
        Parameter {
            address: status << 5 | self.code & 0x1F,
            data: self.content,
        }
    }

    /// The CRC of this block.
    pub fn crc(&self) -> u8 {
        self.fields().crc()
    }

    /// The whole block with this CRC: LOW, covered bits, CRC.
    pub fn bits_with_crc(&self, crc: u8) -> AnswerBits {
        self.fields().block(false, crc)
    }
}

/// Kind of an answer bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Start bit.
    Start,
    /// First error bit.
    F1,
    /// Second error bit.
    F2,
    /// Bit of the position, 0 = LSB.
    Position(u32),
    /// Bit of the CRC, 4 = first sent.
    Crc(u32),
    /// Bit of the MRS code, address or port, 7 = first sent.
    Address(u32),
    /// Bit of the parameter, or of the content of a block of additional data, 15 = first sent.
    Data(u32),
    /// Bit of a block address, 7 = first sent.
    Block(u32),
    /// LOW that begins a block of additional data.
    InfoLow,
    /// Collective warning WRN.
    Warning,
    /// Reference run done RM.
    Reference,
    /// Memory request in progress.
    Busy,
    /// Bit of the code of a block of additional data, 4 = first sent.
    Code(u32),
    /// Beyond the answer.
    None,
}

/// The field that bit `index` of a position answer belongs to.
pub fn position_field(index: u32, has_f2: bool, position_bits: u32) -> Field {
    let head = 2 + u32::from(has_f2);
    match index {
        0 => Field::Start,
        1 => Field::F1,
        2 if has_f2 => Field::F2,
        i if i < head + position_bits => Field::Position(i - head),
        i if i < head + position_bits + CRC_BITS => {
            Field::Crc(CRC_BITS - 1 - (i - head - position_bits))
        }
        _ => Field::None,
    }
}

/// The field that bit `index` of an answer with a parameter belongs to.
pub fn parameter_field(index: u32) -> Field {
    match index {
        0 => Field::Start,
        1..=8 => Field::Address(8 - index),
        9..=24 => Field::Data(24 - index),
        25..=29 => Field::Crc(29 - index),
        _ => Field::None,
    }
}

/// The field that bit `index` of a block of additional data belongs to.
pub fn info_field(index: u32) -> Field {
    match index {
        0 => Field::InfoLow,
        1 => Field::Warning,
        2 => Field::Reference,
        3 => Field::Busy,
        4..=8 => Field::Code(8 - index),
        _ => parameter_field(index),
    }
}

impl std::fmt::Display for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Start => f.write_str("S"),
            Self::F1 => f.write_str("F1"),
            Self::F2 => f.write_str("F2"),
            Self::Position(i) => write!(f, "D{i}"),
            Self::Crc(i) => write!(f, "C{i}"),
            Self::Address(i) => write!(f, "A{i}"),
            Self::Data(i) => write!(f, "P{i}"),
            Self::Block(i) => write!(f, "B{i}"),
            Self::InfoLow => f.write_str("0"),
            Self::Warning => f.write_str("WRN"),
            Self::Reference => f.write_str("RM"),
            Self::Busy => f.write_str("BSY"),
            Self::Code(i) => write!(f, "I{i}"),
            Self::None => f.write_str("-"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REAL: PositionAnswer = PositionAnswer {
        f1: false,
        f2: Some(true),
        position: 0x7_5006_84EF,
        position_bits: 37,
    };

    #[test]
    fn the_captured_frame_is_reproduced_bit_by_bit() {
        assert_eq!(REAL.crc(), 0x19);
        assert_eq!(
            REAL.bits().to_text(),
            "101111101110010000101100000000010101110011001"
        );
    }

    #[test]
    fn fields_follow_the_frame() {
        let text = |has_f2| {
            (0..12)
                .map(|i| position_field(i, has_f2, 3).to_string())
                .collect::<Vec<_>>()
                .join(" ")
        };
        assert_eq!(text(true), "S F1 F2 D0 D1 D2 C4 C3 C2 C1 C0 -");
        assert_eq!(text(false), "S F1 D0 D1 D2 C4 C3 C2 C1 C0 - -");
    }

    #[test]
    fn fields_of_parameters_and_infos_follow_the_frame() {
        let text = |field: fn(u32) -> Field| {
            let names: Vec<_> = (0..31).map(|i| field(i).to_string()).collect();
            names.join(" ")
        };
        let tail = "P15 P14 P13 P12 P11 P10 P9 P8 P7 P6 P5 P4 P3 P2 P1 P0 C4 C3 C2 C1 C0 -";
        let head = "S A7 A6 A5 A4 A3 A2 A1 A0";
        assert_eq!(text(parameter_field), format!("{head} {tail}"));
        let head = "0 WRN RM BSY I4 I3 I2 I1 I0";
        assert_eq!(text(info_field), format!("{head} {tail}"));
    }

    #[test]
    fn every_published_crc_vector_holds() {
        let text = include_str!("../tests/data/crc_vectors.json");
        let file: serde_json::Value = serde_json::from_str(text).unwrap();
        let bits = |text: &serde_json::Value| -> Vec<bool> {
            text.as_str().unwrap().bytes().map(|b| b == b'1').collect()
        };
        let hex = |text: &serde_json::Value| {
            u64::from_str_radix(text.as_str().unwrap().trim_start_matches("0x"), 16).unwrap()
        };
        let vectors = file["vectors"].as_array().unwrap();
        assert!(vectors.len() >= 62);
        for v in vectors {
            let want = hex(&v["crc_hex"]) as u8;
            assert_eq!(
                crc5(bits(&v["covered_bits_tx_order"]).into_iter()),
                want,
                "{v}"
            );
            if let Some(byte) = v.get("byte8_hex").filter(|b| !b.is_null()) {
                let fields = Parameter {
                    address: hex(byte) as u8,
                    data: hex(&v["word16_hex"]) as u16,
                };
                assert_eq!(fields.crc(), want, "{v}");
            }
            let Some(position) = v.get("position_hex").filter(|p| !p.is_null()) else {
                continue;
            };
            let answer = PositionAnswer {
                f1: v["f1"].as_u64() == Some(1),
                f2: v["f2"].as_u64().map(|b| b == 1),
                position: hex(position),
                position_bits: v["n_bits"].as_u64().unwrap() as u32,
            };
            assert_eq!(answer.crc(), want, "{v}");
            if let Some(whole) = v["frame_S_to_CRC"].as_str() {
                assert_eq!(answer.bits().to_text(), whole, "{v}");
            }
        }
        let random = file["random_bitstrings"].as_array().unwrap();
        assert!(!random.is_empty());
        for v in random {
            let got = crc5(bits(&v["bits_tx_order"]).into_iter());
            assert_eq!(Some(u64::from(got)), v["crc"].as_u64(), "{v}");
        }
    }
}

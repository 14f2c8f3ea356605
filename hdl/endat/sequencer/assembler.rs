//! Programs for the [`Sequencer`](super::Sequencer), one method for each instruction.
//!
//! ```ignore
//! use endat_hdl::endat::sequencer::assembler::Assembler;
//! let mut a = Assembler::new();
//! let again = a.here();
//! a.inp(3).jz(again); // waits until port 3 is not 0
//! a.call("count").jmp(again);
//! a.place("count").ld(7).addi(1).st(7).ret();
//! assert_eq!(a.finish().unwrap()[0], 0xb0003);
//! ```
//!
//! A label is a name or a handle ([`Assembler::label`]), and may be used before it is placed. [`Assembler::finish`] returns the first
//! fault.

use super::{PORTS, PROGRAM_WORDS};
use std::collections::BTreeMap;

/// Reasons why a program is rejected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AssemblerError {
    /// A label is used and never placed.
    #[error(
        "label = {name}: is used at word {word} and never placed; place it with place({name})"
    )]
    UnknownLabel {
        /// The label.
        name: String,
        /// Word of its first use.
        word: usize,
    },
    /// A label is placed twice.
    #[error(
        "label = {name}: is placed at word {first} and again at word {second}; rename one of them"
    )]
    LabelTwice {
        /// The label.
        name: String,
        /// Its first place.
        first: usize,
        /// Its second place.
        second: usize,
    },
    /// A port number is out of range.
    #[error("port = {port}: is used at word {word}, ports go from 0 to {}; use one of these", PORTS - 1)]
    UnknownPort {
        /// Number of the port.
        port: u8,
        /// Word of its use.
        word: usize,
    },
    /// The program has more words than the program memory.
    #[error("program = {words} words: the limit is {PROGRAM_WORDS}; shorten it")]
    TooLong {
        /// Words of the program.
        words: usize,
    },
}

/// A place in a program, with a name or a handle.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Label {
    /// A name.
    Name(String),
    /// The number of a handle; see [`Assembler::label`].
    Handle(Handle),
}

/// A label without a name; valid for one [`Assembler`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Handle(usize);

impl From<&str> for Label {
    fn from(name: &str) -> Self {
        Label::Name(name.into())
    }
}

impl From<Handle> for Label {
    fn from(handle: Handle) -> Self {
        Label::Handle(handle)
    }
}

impl std::fmt::Display for Label {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Label::Name(name) => f.write_str(name),
            Label::Handle(Handle(number)) => write!(f, "#{number}"),
        }
    }
}

/// `imm[8]`: the address is relative to X.
const INDEXED: u32 = 1 << 8;
/// `imm[9]`: includes the carry.
const WITH_CARRY: u32 = 1 << 9;

/// A program under construction. Instructions are appended in the order of the calls.
#[derive(Clone, Debug, Default)]
pub struct Assembler {
    words: Vec<u32>,
    /// Words whose lowest bits are the address of a label.
    uses: Vec<(usize, Label)>,
    places: BTreeMap<Label, usize>,
    handles: usize,
    /// The first fault.
    fault: Option<AssemblerError>,
}

macro_rules! instructions {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $kind:ty)?) = $op:expr, $imm:expr;)*) => {
        $($(#[$doc])* pub fn $name(&mut self $(, $argument: $kind)?) -> &mut Self {
            self.word($op, $imm)
        })*
    };
}

macro_rules! jumps {
    ($($(#[$doc:meta])* $name:ident = $op:expr, $imm:expr;)*) => {
        $($(#[$doc])* pub fn $name(&mut self, target: impl Into<Label>) -> &mut Self {
            self.uses.push((self.words.len(), target.into()));
            self.word($op, $imm)
        })*
    };
}

impl Assembler {
    /// An empty program.
    pub fn new() -> Self {
        Self::default()
    }

    /// A new label, not yet placed.
    pub fn label(&mut self) -> Handle {
        self.handles += 1;
        Handle(self.handles - 1)
    }

    /// A new label for the next instruction.
    pub fn here(&mut self) -> Handle {
        let handle = self.label();
        self.place(handle);
        handle
    }

    /// Places the label at the next instruction.
    pub fn place(&mut self, label: impl Into<Label>) -> &mut Self {
        let (label, second) = (label.into(), self.words.len());
        if let Some(first) = self.places.get(&label).copied() {
            let name = label.to_string();
            self.note(AssemblerError::LabelTwice {
                name,
                first,
                second,
            });
        } else {
            self.places.insert(label, second);
        }
        self
    }

    /// Number of words so far.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// True if the program has no instruction yet.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// The words of the program, with all labels resolved.
    ///
    /// # Errors
    /// The first fault.
    pub fn finish(&self) -> Result<Vec<u32>, AssemblerError> {
        if let Some(fault) = &self.fault {
            return Err(fault.clone());
        }
        if self.words.len() > PROGRAM_WORDS {
            return Err(AssemblerError::TooLong {
                words: self.words.len(),
            });
        }
        let mut words = self.words.clone();
        for (word, label) in &self.uses {
            let Some(place) = self.places.get(label) else {
                return Err(AssemblerError::UnknownLabel {
                    name: label.to_string(),
                    word: *word,
                });
            };
            // A label after the last word is address 0, as for the machine.
            words[*word] |= (place % PROGRAM_WORDS) as u32;
        }
        Ok(words)
    }

    fn note(&mut self, fault: AssemblerError) {
        self.fault.get_or_insert(fault);
    }

    fn word(&mut self, op: u32, imm: u32) -> &mut Self {
        self.words.push(op << 16 | imm);
        self
    }

    fn port(&mut self, op: u32, port: u8) -> &mut Self {
        let word = self.words.len();
        if usize::from(port) >= PORTS {
            self.note(AssemblerError::UnknownPort { port, word });
        }
        self.word(op, port.into())
    }

    /// A = port.
    pub fn inp(&mut self, port: u8) -> &mut Self {
        self.port(11, port)
    }

    /// Port = A.
    pub fn out(&mut self, port: u8) -> &mut Self {
        self.port(12, port)
    }

    instructions! {
        /// A = `imm`.
        ldi(imm: u16) = 0, imm.into();
        /// A = RAM word.
        ld(address: u8) = 1, address.into();
        /// A = RAM word at `address` + X.
        ld_x(address: u8) = 1, u32::from(address) | INDEXED;
        /// RAM word = A.
        st(address: u8) = 2, address.into();
        /// RAM word at `address` + X = A.
        st_x(address: u8) = 2, u32::from(address) | INDEXED;
        /// A = A + RAM word; C is the carry.
        add(address: u8) = 3, address.into();
        /// A = A + RAM word at `address` + X; C is the carry.
        add_x(address: u8) = 3, u32::from(address) | INDEXED;
        /// A = A + RAM word + C; C is the carry.
        adc(address: u8) = 3, u32::from(address) | WITH_CARRY;
        /// A = A + RAM word at `address` + X + C; C is the carry.
        adc_x(address: u8) = 3, u32::from(address) | INDEXED | WITH_CARRY;
        /// A = A - RAM word; C is the borrow.
        sub(address: u8) = 4, address.into();
        /// A = A - RAM word at `address` + X; C is the borrow.
        sub_x(address: u8) = 4, u32::from(address) | INDEXED;
        /// A = A - RAM word - C; C is the borrow.
        sbc(address: u8) = 4, u32::from(address) | WITH_CARRY;
        /// A = A - RAM word at `address` + X - C; C is the borrow.
        sbc_x(address: u8) = 4, u32::from(address) | INDEXED | WITH_CARRY;
        /// A = A + `imm`; C is the carry.
        addi(imm: u16) = 8, imm.into();
        /// A = A and `imm`.
        andi(imm: u16) = 9, imm.into();
        /// A = A xor `imm`.
        xori(imm: u16) = 10, imm.into();
        /// Return: jump to the word after the last call.
        ret() = 15, 0;
        /// X = low byte of A.
        tax() = 15, 1;
        /// A = address of the word after the last call.
        link() = 15, 2;
        /// Jump to the address in A.
        jmpa() = 15, 3;
        /// A = A / 2; C is the bit shifted out.
        shr() = 15, 4;
        /// Exchange the bytes of A.
        swap() = 15, 5;
    }

    jumps! {
        /// A = address of a label, for [`Assembler::jmpa`].
        ldi_label = 0, 0;
        /// Jump to a label.
        jmp = 13, 0;
        /// Jump to a label if A is 0.
        jz = 13, 1 << 13;
        /// Jump to a label if A is not 0.
        jnz = 13, 2 << 13;
        /// Jump to a label if C is 1.
        jc = 13, 3 << 13;
        /// Jump to a label if C is 0.
        jnc = 13, 4 << 13;
        /// Jump to a label if bit 15 of A is 1.
        jneg = 13, 5 << 13;
        /// Call a label; [`Assembler::ret`] returns to the next word. A subroutine that calls another one must save the link with
        /// [`Assembler::link`].
        call = 14, 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example at the top of this file; a documentation test would compile the whole crate for it.
    #[test]
    fn example_of_the_documentation_assembles() {
        let example = include_str!("assembler.rs").split("```").nth(1).unwrap();
        for line in [
            r#"a.inp(3).jz(again);"#,
            r#"a.call("count").jmp(again);"#,
            r#"a.place("count").ld(7).addi(1).st(7).ret();"#,
            r#"assert_eq!(a.finish().unwrap()[0], 0xb0003);"#,
        ] {
            assert!(example.contains(line), "{line}");
        }
        let mut a = Assembler::new();
        let again = a.here();
        a.inp(3).jz(again);
        a.call("count").jmp(again);
        a.place("count").ld(7).addi(1).st(7).ret();
        assert_eq!(a.finish().unwrap()[0], 0xb0003);
    }

    #[test]
    fn faults_of_a_program_are_told_with_their_place() {
        let message = |make: &dyn Fn(&mut Assembler) -> &mut Assembler| {
            let mut a = Assembler::new();
            make(&mut a);
            a.finish().unwrap_err().to_string()
        };
        assert_eq!(
            message(&|a| a.ldi(1).jmp("nowhere")),
            "label = nowhere: is used at word 1 and never placed; place it with place(nowhere)"
        );
        assert_eq!(
            message(&|a| a.place("x").ldi(1).place("x").ldi(2)),
            "label = x: is placed at word 0 and again at word 1; rename one of them"
        );
        assert_eq!(
            message(&|a| a.out(31).inp(32)),
            "port = 32: is used at word 1, ports go from 0 to 31; use one of these"
        );
        let mut long = Assembler::new();
        for _ in 0..=PROGRAM_WORDS {
            long.ret();
        }
        assert_eq!(
            long.finish().unwrap_err().to_string(),
            "program = 2049 words: the limit is 2048; shorten it"
        );
        let mut a = Assembler::new();
        let handle = a.label();
        assert_eq!(
            a.jmp(handle).finish(),
            Err(AssemblerError::UnknownLabel {
                name: "#0".into(),
                word: 0
            })
        );
    }

    #[test]
    fn instructions_have_their_words() {
        let mut a = Assembler::new();
        let start = a.here();
        a.ldi(0xffff).ld(1).ld_x(2).st(3).st_x(4);
        a.add(5)
            .add_x(6)
            .adc(7)
            .adc_x(8)
            .sub(9)
            .sub_x(10)
            .sbc(11)
            .sbc_x(12);
        a.addi(1).andi(2).xori(3).inp(30).out(31);
        a.jmp("end")
            .jz("end")
            .jnz("end")
            .jc("end")
            .jnc("end")
            .jneg(start)
            .call("end");
        a.ret()
            .tax()
            .link()
            .jmpa()
            .shr()
            .swap()
            .ldi_label("end")
            .place("end");
        assert_eq!(
            a.finish().unwrap(),
            [
                0x0ffff, 0x10001, 0x10102, 0x20003, 0x20104, 0x30005, 0x30106, 0x30207, 0x30308,
                0x40009, 0x4010a, 0x4020b, 0x4030c, 0x80001, 0x90002, 0xa0003, 0xb001e, 0xc001f,
                0xd0020, 0xd2020, 0xd4020, 0xd6020, 0xd8020, 0xda000, 0xe0020, 0xf0000, 0xf0001,
                0xf0002, 0xf0003, 0xf0004, 0xf0005, 0x00020
            ]
        );
    }
}

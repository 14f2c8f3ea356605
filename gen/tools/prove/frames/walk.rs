//! Runs of a channel with its encoder, in which every bit is a function of what may be anything.

use super::forms::{Form, Forms, Sample};
use super::text;
use super::{Case, Trace, Undriven};
use crate::prove::netlist::{Kind, Net, Netlist, ANYTHING, HIGH};
use endat_draw::Wave;

/// Longest run, in microseconds: the frame that measures takes less.
const LIMIT_US: u64 = 4_000;

/// Levels of all registers: one, or anything.
pub(super) type State = Vec<Option<bool>>;

/// What a run begins with and leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Run {
    /// From the start values until the channel waits for its first trigger.
    PowerUp,
    /// A cycle without a trigger.
    Wait,
    /// A trigger, and all until the channel waits again.
    Frame,
}

/// What a run came to.
pub(super) enum End {
    /// The channel waits again, after so many cycles; how its registers are then.
    Waits { state: State, cycles: u64 },
    /// It did what it must not.
    Breaks(Break),
}

/// What a channel did that it must not.
#[derive(Clone, Debug)]
pub(super) struct Break {
    /// In words.
    pub what: &'static str,
    /// Cycle of the run.
    pub cycle: u64,
    /// The run up to there for one choice of all that may be anything; none: no choice was found that leads there.
    pub trace: Option<Trace>,
}

/// A run under way.
struct Walk<'a> {
    netlist: &'a Netlist,
    case: &'a Case,
    forms: Forms,
    levels: Vec<Form>,
    /// When each net changed last, in looks at all gates.
    changed: Vec<u32>,
    looks: u32,
    history: Vec<Vec<Form>>,
}

/// Runs from a state, the microsecond in this phase.
pub(super) fn run(
    netlist: &Netlist,
    case: &Case,
    begins: &State,
    run: Run,
    tick_phase: u64,
) -> Result<End, String> {
    let count = netlist.net_count;
    let mut walk = Walk {
        netlist,
        case,
        forms: Forms::new(),
        levels: vec![Form::LOW; count],
        changed: vec![1; count],
        looks: 0,
        history: vec![],
    };
    walk.set(HIGH, Form::HIGH);
    for (register, level) in netlist.registers.iter().zip(begins) {
        let form = level.map_or_else(|| walk.forms.free(), Form::from);
        walk.set(register.output, form);
    }
    walk.go(run, tick_phase)
}

impl Walk<'_> {
    fn go(&mut self, run: Run, tick_phase: u64) -> Result<End, String> {
        let ticks = self.case.tick_cycles();
        let limit = LIMIT_US * ticks;
        let mut has_result = false;
        let sent_bits = self.case.position_bits as usize;
        let position: Vec<Form> = (0..sent_bits).map(|_| self.forms.free()).collect();
        let infos = [Form::LOW, Form::HIGH].map(|is_second| {
            // Bit I4 tells which of the two it is; the top one would be a warning.
            let bit = |bit| match bit {
                20 => is_second,
                23 => Form::LOW,
                _ => self.forms.free(),
            };
            (0..24).map(bit).collect::<Vec<Form>>()
        });
        self.drive("position_now", &position)?;
        self.drive("info_1_now", &infos[0])?;
        self.drive("info_2_now", &infos[1])?;
        for cycle in 0..limit {
            let is_tick = (cycle + tick_phase) % ticks == ticks - 1;
            self.drive("tick_us", &[is_tick.into()])?;
            self.drive("trigger", &[Form::LOW])?;
            self.drive_anything()?;
            self.evaluate();
            self.name_sent()?;
            if cycle == 0 {
                self.relate()?;
            }
            let busy = self.one("busy")?;
            let Some(is_busy) = busy.level() else {
                return Ok(self.breaks(
                    "whether the channel waits depends on data",
                    &[busy, !busy],
                    cycle,
                ));
            };
            // A trigger that meets a frame is lost, and changes nothing but that this is told.
            let trigger = match (cycle, is_busy) {
                (0, false) => (run == Run::Frame).into(),
                (_, true) => self.forms.free(),
                (_, false) => Form::LOW,
            };
            let is_end = !is_busy
                && match run {
                    Run::PowerUp => true,
                    Run::Wait | Run::Frame => cycle > 0,
                };
            if is_end {
                return self.end(run, has_result, cycle);
            }
            self.drive("trigger", &[trigger])?;
            self.evaluate();
            self.remember()?;
            if let Some(end) = self.look(&mut has_result, cycle)? {
                return Ok(end);
            }
            self.clock()?;
        }
        Ok(self.breaks("the frame does not end", &[Form::HIGH], limit))
    }

    fn end(&mut self, run: Run, has_result: bool, cycle: u64) -> Result<End, String> {
        if run == Run::Frame {
            if !has_result {
                return Ok(self.breaks("no result", &[Form::HIGH], cycle));
            }
            let wrong = self.wrong_infos()?;
            if wrong != Form::LOW {
                let what = "the additional data are not those that were sent";
                return Ok(self.breaks(what, &[wrong], cycle));
            }
        }
        let whole = self.whole()?;
        if let Some(&(_, form)) = whole.iter().find(|(_, form)| *form != Form::HIGH) {
            let what = "the stored position does not fit its parity";
            return Ok(self.breaks(what, &[!form], cycle));
        }
        let registers = self.netlist.registers.iter();
        let state = registers.map(|r| self.levels[r.output].level()).collect();
        Ok(End::Waits {
            state,
            cycles: cycle,
        })
    }

    /// What must hold in every cycle.
    fn look(&mut self, has_result: &mut bool, cycle: u64) -> Result<Option<End>, String> {
        let wrong = self.one("wrong")?;
        let (drives, is_driven) = (self.one("drives")?, self.one("is_driven")?);
        let both = self.forms.and(drives, is_driven);
        let strobe = self.one("result_strobe")?;
        let never = [
            ("the encoder sees a wrong clock, command or driver", wrong),
            ("both drive DATA", both),
            (
                "a second result",
                match *has_result {
                    true => strobe,
                    false => Form::LOW,
                },
            ),
        ];
        for (what, form) in never {
            if form != Form::LOW {
                return Ok(Some(self.breaks(what, &[form], cycle)));
            }
        }
        match strobe.level() {
            Some(false) => Ok(None),
            None => {
                let what = "whether there is a result depends on data";
                // Whatever it is: that it is not always the same is seen at two draws.
                Ok(Some(self.breaks(what, &[strobe, !strobe], cycle)))
            }
            Some(true) => {
                *has_result = true;
                let wrong = self.wrong_result()?;
                let what = "what is published is not what was sent";
                Ok((wrong != Form::LOW).then(|| self.breaks(what, &[wrong], cycle)))
            }
        }
    }

    /// HIGH where a result is not the position that was sent, good, with no cause but that a trigger was lost.
    fn wrong_result(&mut self) -> Result<Form, String> {
        let mut wrong = Form::LOW;
        let sent = self.nets("sent")?.to_vec();
        let sent: Vec<Form> = sent.iter().map(|net| self.levels[*net]).collect();
        for (index, net) in self.nets("position")?.to_vec().into_iter().enumerate() {
            let bit = sent.get(index).copied().unwrap_or(Form::LOW);
            let differs = self.forms.xor(self.levels[net], bit);
            wrong = self.forms.or(wrong, differs);
        }
        for name in ["fresh", "position_valid"] {
            let level = self.one(name)?;
            wrong = self.forms.or(wrong, !level);
        }
        let (mut is_good, mut is_overrun) = (Form::HIGH, Form::HIGH);
        for (index, net) in self.nets("cause")?.to_vec().into_iter().enumerate() {
            let bit = self.levels[net];
            let of_overrun = text::OVERRUN >> index & 1 == 1;
            is_good = self.forms.and(is_good, !bit);
            is_overrun = self.forms.and(is_overrun, bit.inverted_if(!of_overrun));
        }
        let is_known = self.forms.or(is_good, is_overrun);
        Ok(self.forms.or(wrong, !is_known))
    }

    /// HIGH where the additional data are not those that were sent, all of them with a right CRC.
    fn wrong_infos(&mut self) -> Result<Form, String> {
        let mut wrong = Form::LOW;
        let infos = self.case.infos;
        let pairs = [("info_1", "sent_1"), ("info_2", "sent_2")];
        for (index, (came, sent)) in pairs.into_iter().enumerate() {
            let is_sent = infos >> index & 1 == 1;
            for name in ["info_came", "info_good"] {
                let level = self.levels[self.nets(name)?[index]];
                wrong = self.forms.or(wrong, level.inverted_if(is_sent));
            }
            let nets = self.nets(came)?.iter().zip(self.nets(sent)?);
            let pairs: Vec<[Form; 2]> = nets
                .map(|(a, b)| [self.levels[*a], self.levels[*b]])
                .collect();
            for [came, sent] in pairs.into_iter().filter(|_| is_sent) {
                let differs = self.forms.xor(came, sent);
                wrong = self.forms.or(wrong, differs);
            }
        }
        Ok(wrong)
    }

    /// The end of a run in which one of these, all of which may be HIGH for some choice, should not be.
    fn breaks(&self, what: &'static str, forms: &[Form], cycle: u64) -> End {
        let trace = (0..16).find_map(|seed| {
            let sample = self.forms.sample(seed);
            let mut draws = forms.iter().map(|form| sample.levels(*form));
            let first = draws.next()?;
            let is_possible = first != 0 && draws.all(|levels| levels != 0);
            is_possible.then(|| self.trace(&sample, first.trailing_zeros()))
        });
        End::Breaks(Break { what, cycle, trace })
    }

    fn trace(&self, sample: &Sample, draw: u32) -> Trace {
        let signals = text::SHOWN.iter().enumerate().map(|(signal, name)| {
            let width = self.netlist.names.get(*name).map_or(1, Vec::len);
            let from: usize = (text::SHOWN[..signal].iter())
                .map(|n| self.netlist.names.get(*n).map_or(0, Vec::len))
                .sum();
            let word = |forms: &Vec<Form>| {
                let bits = forms[from..from + width].iter().enumerate();
                bits.fold(0, |word, (bit, form)| {
                    word | (sample.levels(*form) >> draw & 1) << bit
                })
            };
            Wave {
                name: (*name).into(),
                width_bits: width,
                levels: self.history.iter().map(word).collect(),
            }
        });
        Trace {
            system_hz: self.case.system_hz,
            waves: signals.collect(),
        }
    }

    fn remember(&mut self) -> Result<(), String> {
        let mut forms = vec![];
        for name in text::SHOWN {
            forms.extend(self.nets(name)?.iter().map(|net| self.levels[*net]));
        }
        self.history.push(forms);
        Ok(())
    }

    /// Makes the registers fit each other as they do whenever the channel waits.
    fn relate(&mut self) -> Result<(), String> {
        for (name, form) in self.whole()? {
            if form == Form::HIGH {
                continue;
            }
            let registers = self.netlist.registers.iter();
            let mut outputs = registers.map(|r| r.output);
            let alone = |net: &Net| self.forms.has_alone(form, self.levels[*net]);
            let Some(net) = outputs.find(alone) else {
                return Err(format!("{name}: no register to make it so"));
            };
            let fits = self.forms.xor(self.levels[net], !form);
            self.set(net, fits);
        }
        self.evaluate();
        match self.whole()?.iter().find(|(_, form)| *form != Form::HIGH) {
            None => Ok(()),
            Some((name, _)) => Err(format!("{name}: cannot be made so")),
        }
    }

    /// Nets that are HIGH whenever the channel waits.
    fn whole(&self) -> Result<Vec<(String, Form)>, String> {
        let found = self.netlist.names.iter();
        let found = found.filter(|(name, _)| name.ends_with(text::WHOLE));
        let found: Vec<(String, Form)> = found
            .map(|(name, nets)| (name.clone(), self.levels[nets[0]]))
            .collect();
        match found.is_empty() {
            true => Err(format!("{}: no such net", text::WHOLE)),
            false => Ok(found),
        }
    }

    /// What the encoder sends is an unknown of its own, CRC bits, too.
    fn name_sent(&mut self) -> Result<(), String> {
        let sent = self.one("value")?;
        if let Some(mut renamed) = self.forms.name(sent) {
            for level in &mut self.levels {
                *level = self.forms.renamed(*level, &mut renamed);
            }
        }
        Ok(())
    }

    fn nets(&self, name: &str) -> Result<&[Net], String> {
        let nets = self.netlist.names.get(name);
        nets.map(Vec::as_slice)
            .ok_or_else(|| format!("{name}: no such net"))
    }

    fn one(&self, name: &str) -> Result<Form, String> {
        Ok(self.levels[self.nets(name)?[0]])
    }

    fn set(&mut self, net: Net, form: Form) {
        if self.levels[net] != form {
            self.levels[net] = form;
            self.changed[net] = self.looks + 1;
        }
    }

    fn drive(&mut self, name: &str, forms: &[Form]) -> Result<(), String> {
        for (index, form) in forms.iter().enumerate() {
            self.set(self.nets(name)?[index], *form);
        }
        Ok(())
    }

    /// DATA while nobody drives it, the time, and what the Verilog leaves open.
    fn drive_anything(&mut self) -> Result<(), String> {
        for net in self.nets("timestamp")?.to_vec() {
            let form = self.forms.free();
            self.set(net, form);
        }
        if self.case.line.undriven == Undriven::Anything {
            let form = self.forms.free();
            self.drive("undriven", &[form])?;
        }
        let form = self.forms.free();
        self.set(ANYTHING, form);
        Ok(())
    }

    /// Looks at the gates whose inputs have changed.
    fn evaluate(&mut self) {
        self.looks += 1;
        let now = self.looks;
        for gate in &self.netlist.gates {
            if gate.inputs.iter().all(|net| self.changed[*net] < now) {
                continue;
            }
            let [a, b, c] = gate.inputs.map(|net| self.levels[net]);
            let form = match gate.kind {
                Kind::Not => !a,
                Kind::And => self.forms.and(a, b),
                Kind::Or => self.forms.or(a, b),
                Kind::Xor => self.forms.xor(a, b),
                Kind::Mux => self.forms.mux(a, b, c),
            };
            if self.levels[gate.output] != form {
                self.levels[gate.output] = form;
                self.changed[gate.output] = now;
            }
        }
    }

    /// The falling edge, if registers look at it, and the rising one.
    fn clock(&mut self) -> Result<(), String> {
        if self.netlist.registers.iter().any(|r| r.falls) {
            self.take(true);
            self.drive_anything()?;
            self.evaluate();
        }
        self.take(false);
        Ok(())
    }

    fn take(&mut self, falls: bool) {
        let registers = self.netlist.registers.iter();
        let registers = registers.filter(|r| r.falls == falls);
        let next: Vec<(Net, Form)> = registers
            .map(|r| (r.output, self.levels[r.input]))
            .collect();
        for (net, form) in next {
            self.set(net, form);
        }
    }
}

//! Columns that are calculated from positions: `NAME=CHANNEL` or `NAME=CHANNEL-CHANNEL`, and steps behind it, done from left to right.
//!
//! As long as no step needs fractions, everything is counted in whole measuring steps, so that nothing of 48 bits is lost.

use super::layout::DerivedColumn;
use endat_console::did_you_mean::guess;
use endat_console::error::{shown, CommandError};
use endat_console::number::decimal;
use endat_host::feed::Row;
use endat_host::motion::{nearest, Unwrap, Velocity, VELOCITY_OVER_S};
use endat_host::range;
use endat_host::units::Scale;

/// What can be done, and how it is written.
const STEPS: [(&str, &str); 8] = [
    ("unwrap", "turns counted on"),
    ("zero", "the first value is 0"),
    ("negate", "the other way round"),
    ("offset", "offset=X, in the unit"),
    ("scale", "scale=X"),
    ("modulo", "modulo=X, in the unit"),
    ("velocity", "velocity or velocity=SECONDS, per second"),
    ("unit", "unit=NAME"),
];

/// A value on its way: whole steps as long as they can be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Steps(i128),
    Number(f64),
}

/// Something that is done with a value.
#[derive(Clone, Debug)]
enum Step {
    /// Nothing: what does not begin anew is counted on as it is.
    Same,
    Unwrap(Unwrap),
    Zero(Option<Value>),
    Negate,
    Offset(f64),
    Scale(f64),
    Modulo(f64),
    Velocity(Velocity<i128>),
}

/// A column, and what is between its last row and the next.
#[derive(Clone, Debug)]
struct Derived {
    channels: (usize, Option<usize>),
    scale: Scale,
    steps: Vec<Step>,
    column: DerivedColumn,
}

/// All that is calculated.
#[derive(Clone, Debug, Default)]
pub struct Derivation {
    all: Vec<Derived>,
}

/// Beyond is no position.
const AMOUNT_MAX: f64 = 1e15;

/// A number of a step.
fn amount(spec: &str, name: &str, text: &str) -> Result<f64, CommandError> {
    let what = format!("--derive = {}: {name}", shown(spec));
    decimal(&what, text, -AMOUNT_MAX..=AMOUNT_MAX)
}

fn wrong(spec: &str, what: &str) -> CommandError {
    CommandError::input(format!("--derive = {}: {what}", shown(spec)))
}

/// What can be a name in a file.
fn is_name(text: &str) -> bool {
    let is_fit = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    text.chars().all(is_fit)
        && text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.len() <= 40
}

impl Step {
    /// The step that a word means; none if it only names the unit.
    fn parse(spec: &str, word: &str, of: &Derived) -> Result<Option<Self>, CommandError> {
        let (name, argument) = match word.split_once('=') {
            Some((name, argument)) => (name, Some(argument)),
            None => (word, None),
        };
        let number = || match argument {
            Some(text) => amount(spec, name, text),
            None => Err(wrong(
                spec,
                &format!("{name}: takes a number; write {name}=X"),
            )),
        };
        if let ("unwrap" | "zero" | "negate", Some(_)) = (name, argument) {
            return Err(wrong(
                spec,
                &format!("{name}: takes no number; write {name} alone"),
            ));
        }
        Ok(Some(match name {
            "unwrap" if of.scale.range().is_none() => Self::Same,
            "unwrap" => Self::Unwrap(Unwrap::new(of.scale.range())),
            "zero" => Self::Zero(None),
            "negate" => Self::Negate,
            "offset" => Self::Offset(number()?),
            "scale" => Self::Scale(number()?),
            "modulo" => Self::Modulo(match number()? {
                x if x > 0.0 => x,
                x => return Err(wrong(spec, &format!("modulo={x}: takes a number above 0"))),
            }),
            "velocity" => Self::Velocity(Velocity::over(match argument {
                None => VELOCITY_OVER_S,
                Some(_) => match number()? {
                    x if (0.0..=3_600.0).contains(&x) => x,
                    x => {
                        return Err(wrong(
                            spec,
                            &format!("velocity={x}: takes seconds from 0 to 3600"),
                        ))
                    }
                },
            })),
            "unit" => return Ok(None),
            _ => return Err(wrong(spec, &unknown(name))),
        }))
    }

    fn is_exact(&self) -> bool {
        matches!(
            self,
            Self::Same | Self::Unwrap(_) | Self::Zero(_) | Self::Negate
        )
    }

    fn done(&mut self, value: Value, time_s: f64, scale: &Scale) -> Option<Value> {
        let in_unit = |value| match value {
            Value::Steps(steps) => scale.value(steps),
            Value::Number(x) => x,
        };
        Some(match (self, value) {
            (Self::Same, value) => value,
            (Self::Unwrap(unwrap), Value::Steps(steps)) => Value::Steps(unwrap.step(steps as u64)),
            // Checked when it was read.
            (Self::Unwrap(_), other) => other,
            (Self::Zero(first), value) => match (*first.get_or_insert(value), value) {
                (Value::Steps(first), Value::Steps(now)) => Value::Steps(now - first),
                (first, now) => Value::Number(in_unit(now) - in_unit(first)),
            },
            (Self::Negate, Value::Steps(steps)) => Value::Steps(-steps),
            (Self::Negate, Value::Number(x)) => Value::Number(-x),
            (Self::Offset(by), value) => Value::Number(in_unit(value) + *by),
            (Self::Scale(by), value) => Value::Number(in_unit(value) * *by),
            (Self::Modulo(by), Value::Steps(steps)) => {
                let whole = *by / scale.step();
                match (whole - whole.round()).abs() < 1e-6 && whole >= 1.0 {
                    true => Value::Steps(steps.rem_euclid(whole.round() as i128)),
                    false => Value::Number(in_unit(value).rem_euclid(*by)),
                }
            }
            (Self::Modulo(by), Value::Number(x)) => Value::Number(x.rem_euclid(*by)),
            (Self::Velocity(velocity), Value::Steps(steps)) => {
                Value::Number(velocity.step(time_s, steps)? * scale.step())
            }
            (Self::Velocity(_), other) => other,
        })
    }
}

fn unknown(name: &str) -> String {
    let known = STEPS.map(|s| s.0);
    let guess = guess(name, known).map_or(String::new(), |near| near + " ");
    let all = STEPS
        .map(|(name, means)| format!("{name} ({means})"))
        .join(", ");
    format!("there is no step {}; {guess}Steps are {all}", shown(name))
}

/// `0`, or `0-1`.
fn source(
    spec: &str,
    text: &str,
    scales: &[Scale],
) -> Result<(usize, Option<usize>), CommandError> {
    let channel = |text: &str| match text.trim_start_matches("ch").parse::<usize>() {
        Ok(n) if n < scales.len() => Ok(n),
        _ => Err(wrong(
            spec,
            &format!(
                "{} is no channel of 0..{}; write NAME=0:unwrap, or NAME=0-1 for a difference",
                shown(text),
                scales.len() - 1
            ),
        )),
    };
    let Some((one, other)) = text.split_once('-') else {
        return Ok((channel(text)?, None));
    };
    let (one, other) = (channel(one)?, channel(other)?);
    if scales[one] != scales[other] {
        let text = format!(
            "channels {one} and {other} have different measuring steps; derive a column of each, with scale=X, and subtract those"
        );
        return Err(wrong(spec, &text));
    }
    Ok((one, Some(other)))
}

impl Derived {
    fn parse(spec: &str, scales: &[Scale]) -> Result<Self, CommandError> {
        let (name, rest) = spec
            .split_once('=')
            .ok_or_else(|| wrong(spec, "has no name; write NAME=0:unwrap:zero"))?;
        if !is_name(name) {
            let what = format!(
                "{} is no name; take small letters, digits and _",
                shown(name)
            );
            return Err(wrong(spec, &what));
        }
        let mut words = rest.split(':');
        let channels = source(spec, words.next().unwrap_or_default(), scales)?;
        let scale = scales[channels.0];
        let mut unit = scale.convert(0).unit.to_owned();
        let mut derived = Self {
            channels,
            scale,
            steps: Vec::new(),
            column: DerivedColumn {
                name: name.to_owned(),
                unit: String::new(),
                digits: None,
            },
        };
        for word in words {
            if let Some(named) = word.strip_prefix("unit=") {
                let is_fit = |c: char| c.is_ascii_alphanumeric() || "_/".contains(c);
                if named.is_empty() || !named.chars().all(is_fit) || named.len() > 20 {
                    return Err(wrong(spec, "unit= takes letters, digits, _ and /"));
                }
                unit = named.to_owned();
                continue;
            }
            let Some(step) = Step::parse(spec, word, &derived)? else {
                return Err(wrong(spec, "unit takes a name; write unit=mm"));
            };
            let is_whole = derived.steps.iter().all(Step::is_exact);
            if matches!(step, Step::Unwrap(_) | Step::Velocity(_)) && !is_whole {
                let what = format!("{word} counts measuring steps; write it before offset, scale, modulo and velocity");
                return Err(wrong(spec, &what));
            }
            if matches!(step, Step::Unwrap(_)) && !derived.steps.is_empty() {
                return Err(wrong(spec, "unwrap comes first, behind the channel"));
            }
            if matches!(step, Step::Velocity(_)) {
                unit += "/s";
            }
            derived.steps.push(step);
        }
        derived.check_known(spec)?;
        let is_whole = derived.steps.iter().all(Step::is_exact);
        derived.column.digits = is_whole.then(|| scale.digits());
        derived.column.unit = unit;
        Ok(derived)
    }

    /// Refuses steps that count on or compare positions with an unknown range.
    fn check_known(&self, spec: &str) -> Result<(), CommandError> {
        let counts = |step: &Step| matches!(step, Step::Same | Step::Unwrap(_) | Step::Velocity(_));
        let is_needed = self.channels.1.is_some() || self.steps.iter().any(counts);
        if self.scale.is_known() || !is_needed {
            return Ok(());
        }
        Err(wrong(spec, &range::refusal(self.channels.0)))
    }

    fn value(&mut self, row: &Row, time_s: f64) -> Option<f64> {
        let position = |n: usize| {
            let cell = row.cells.get(n)?;
            let position = cell.position.filter(|_| cell.fresh)?;
            let fits = self.scale.fits(position);
            fits.then(|| self.scale.steps(position))
        };
        let range = self.scale.range();
        let steps = match self.channels {
            (one, None) => position(one)?.into(),
            // Of two on a turn the difference is the short way round.
            (one, Some(other)) => {
                let difference = i128::from(position(one)?) - i128::from(position(other)?);
                range.map_or(difference, |r| nearest(difference, r))
            }
        };
        // A difference is counted on from what is within the range.
        let mut value = match (range, self.steps.first()) {
            (Some(range), Some(Step::Unwrap(_))) => Value::Steps(steps.rem_euclid(range.into())),
            _ => Value::Steps(steps),
        };
        for step in &mut self.steps {
            value = step.done(value, time_s, &self.scale)?;
        }
        Some(match value {
            Value::Steps(steps) => self.scale.value(steps),
            Value::Number(x) => x,
        })
    }
}

impl Derivation {
    /// What these ask for.
    pub fn parse(
        specs: &[String],
        scales: &[Scale],
        taken: &[String],
    ) -> Result<Self, CommandError> {
        let mut all: Vec<Derived> = Vec::new();
        for spec in specs {
            let one = Derived::parse(spec, scales)?;
            let column = one.column.column();
            let is_twice = all.iter().any(|other| other.column.column() == column);
            if is_twice || taken.contains(&column) {
                return Err(wrong(
                    spec,
                    &format!("there is a column {column} already; give another name"),
                ));
            }
            all.push(one);
        }
        Ok(Self { all })
    }

    /// The columns.
    pub fn columns(&self) -> Vec<DerivedColumn> {
        self.all.iter().map(|one| one.column.clone()).collect()
    }

    /// Their values in a row; each row must come here, in order, whether it is kept or not.
    pub fn values(&mut self, row: &Row, time_s: f64) -> Vec<Option<f64>> {
        self.all
            .iter_mut()
            .map(|one| one.value(row, time_s))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_host::feed::Cell;

    const BITS: u32 = 48;
    const TURN: u64 = 1 << BITS;

    fn derived(spec: &str) -> Result<Derivation, CommandError> {
        let scales = [Scale::singleturn(BITS); 2];
        Derivation::parse(&[spec.to_owned()], &scales, &[])
    }

    /// Values of rows that are a second apart.
    fn values(spec: &str, rows: &[[Option<u64>; 2]]) -> Vec<Option<f64>> {
        let mut all = derived(spec).unwrap();
        let rows = rows.iter().enumerate().map(|(n, positions)| {
            let cells = positions.iter().map(|position| Cell {
                position: *position,
                fresh: position.is_some(),
                cause: "none",
                infos: [None; 2],
            });
            let row = Row {
                run: None,
                trigger: n as u64,
                cycles: 0,
                missing: 0,
                cells: cells.collect(),
            };
            all.values(&row, n as f64)[0]
        });
        rows.collect()
    }

    const STEP: f64 = 360.0 / TURN as f64;

    /// Catches arithmetic in f64 before the difference: one step of 48 bits, a thousand turns on, is lost in it.
    #[test]
    fn one_step_of_48_bits_is_kept() {
        let rows = [
            [Some(TURN - 1), Some(0)],
            [Some(3), Some(1)],
            [None, Some(1)],
            [Some(5), Some(1)],
        ];
        let found = values("d=0-1", &rows);
        assert_eq!(
            found,
            [Some(-STEP), Some(2.0 * STEP), None, Some(4.0 * STEP)]
        );
        let zeroed = values("d=0:unwrap:zero", &rows);
        assert_eq!(
            zeroed,
            [Some(0.0), Some(4.0 * STEP), None, Some(6.0 * STEP)]
        );
        let negated = values("d=0-1:unwrap:zero:negate", &rows);
        assert_eq!(
            negated,
            [Some(0.0), Some(-3.0 * STEP), None, Some(-5.0 * STEP)]
        );
    }

    #[test]
    fn steps_are_done_from_left_to_right() {
        let quarter = TURN / 4;
        let rows: Vec<[Option<u64>; 2]> =
            (0..6).map(|n| [Some(n * quarter % TURN), None]).collect();
        for (spec, wanted) in [
            ("a=0:unwrap", [0.0, 90.0, 180.0, 270.0, 360.0, 450.0]),
            ("a=0:unwrap:modulo=180", [0.0, 90.0, 0.0, 90.0, 0.0, 90.0]),
            (
                "a=0:unwrap:offset=5:scale=2",
                [10.0, 190.0, 370.0, 550.0, 730.0, 910.0],
            ),
            (
                "a=0:unwrap:scale=2:offset=5",
                [5.0, 185.0, 365.0, 545.0, 725.0, 905.0],
            ),
            ("a=0:unwrap:modulo=0.7", [0.0, 0.4, 0.1, 0.5, 0.2, 0.6]),
        ] {
            let found = values(spec, &rows);
            let near = found
                .iter()
                .zip(wanted)
                .all(|(f, w)| (f.unwrap() - w).abs() < 1e-9);
            assert!(near, "{spec}: {found:?}");
        }
        let speed = values("v=0:unwrap:velocity", &rows);
        assert_eq!(
            speed,
            [
                None,
                Some(90.0),
                Some(90.0),
                Some(90.0),
                Some(90.0),
                Some(90.0)
            ]
        );
        let column = &derived("v=0:unwrap:velocity").unwrap().columns()[0];
        assert_eq!(column.column(), "v_deg_per_s");
    }

    #[test]
    fn a_turn_of_unknown_length_is_not_counted_on() {
        let turns_at = Some(24);
        let ask = |spec: &str, scale: Scale| {
            let done = Derivation::parse(&[spec.to_owned()], &[scale; 2], &[]);
            done.map_err(|e| e.messages()[0].clone())
        };
        for spec in ["t=1:unwrap", "v=1:velocity", "d=1-0"] {
            let why = ask(spec, Scale::Counts { turns_at }).unwrap_err();
            assert!(why.starts_with(&format!("--derive = {spec}: ")), "{why}");
            assert!(why.contains("--range 1=SINGLE+MULTI"), "{why}");
            for known in [Scale::of_bits(17, 16, turns_at), Scale::Counted] {
                assert!(ask(spec, known).is_ok(), "{spec} {known}");
            }
        }
        assert!(ask("z=1:zero:scale=2", Scale::Counts { turns_at }).is_ok());
    }

    #[test]
    fn what_is_wrong_is_told() {
        for (spec, told) in [
            ("a=0:unwarp", "did you mean unwrap?"),
            ("a=2", "2 is no channel of 0..1"),
            ("0:unwrap", "has no name"),
            ("A=0", "A is no name"),
            ("a=0:scale", "scale: takes a number; write scale=X"),
            ("a=0:zero=1", "zero: takes no number"),
            ("a=0:offset=x", "offset = x: is not a number"),
            ("a=0:scale=nan", "scale = nan: outside"),
            ("a=0:modulo=0", "takes a number above 0"),
            ("a=0:offset=1:velocity", "velocity counts measuring steps"),
            ("a=0:zero:unwrap", "unwrap comes first"),
            ("a=0:unit=", "unit= takes letters"),
        ] {
            let error = derived(spec).unwrap_err();
            assert!(error.messages()[0].contains(told), "{spec}: {error:?}");
        }
    }
}

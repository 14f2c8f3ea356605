//! Combinational processes as VHDL text.

use super::expression::{choice, is_condition};
use super::{Added, ModulePrinter};
use crate::elaborate::{Expr, ExprKind, NetId, Statement};
use crate::printing::{constant_values, reads_and_targets, INDENT};
use crate::vhdl::text::{comment, literal, subtype, wrapped, Context};
use std::collections::BTreeSet;

/// Where a list of signals goes on in the next line.
const LINE: usize = 110;

/// Declarations of variables with these names and widths.
pub(in crate::vhdl) fn variable_lines(variables: &[(String, usize)]) -> String {
    let width = variables.iter().map(|(name, _)| name.len()).max();
    let (width, pad) = (width.unwrap_or(0), INDENT.repeat(2));
    (variables.iter())
        .map(|(name, bits)| format!("{pad}variable {name:width$} : {};\n", subtype(*bits)))
        .collect()
}

impl ModulePrinter<'_> {
    /// Processes outside clocked ones.
    pub(super) fn processes(&mut self) -> String {
        let mut out = String::new();
        for process in self.clocked.processes.clone() {
            out.push_str(&self.process(&process.statements));
        }
        out
    }

    fn process(&mut self, statements: &[Statement]) -> String {
        let (reads, targets) = reads_and_targets(statements);
        if reads.is_subset(&targets) {
            // Such a process would wait for nothing: the values are constants.
            let values = constant_values(self.module, statements);
            let line = |(net, value): (&NetId, &u128)| {
                let width_bits = self.module.nets[*net].width_bits;
                let value = self.known(*value, width_bits);
                format!("{INDENT}{} <= {value};\n", self.reference(*net))
            };
            let docs = match statements {
                [one] => comment(one.docs(), INDENT),
                _ => String::new(),
            };
            return values.iter().map(line).fold(docs, |all, line| all + &line);
        }
        if let Some(lines) = self.concurrent(statements, &reads) {
            return lines;
        }
        for net in targets.intersection(&reads) {
            let name = self
                .scope
                .unique(&format!("{}_v", self.module.nets[*net].name));
            self.variables.insert(*net, name);
        }
        let body = self.block(statements, 2);
        let list: Vec<String> = reads
            .difference(&targets)
            .map(|net| self.reference(*net))
            .collect();
        let variables = std::mem::take(&mut self.variables);
        let mut declared: Vec<(String, usize)> = (variables.iter())
            .map(|(net, name)| (name.clone(), self.module.nets[*net].width_bits))
            .collect();
        declared.extend(self.taken_subjects());
        let declared = variable_lines(&declared);
        let pad = INDENT.repeat(2);
        let given: String = (variables.iter())
            .map(|(net, name)| format!("{pad}{} <= {name};\n", self.reference(*net)))
            .collect();
        format!(
            "\n{INDENT}process ({})\n{declared}{INDENT}begin\n{body}{given}{INDENT}end process;\n\n",
            wrapped(&list, LINE).join(&format!("\n{INDENT}         "))
        )
    }

    /// Names and widths of the variables that hold subjects of the process that has been printed.
    pub fn taken_subjects(&mut self) -> Vec<(String, usize)> {
        let subjects = std::mem::take(&mut self.subjects).into_iter();
        subjects.map(|s| (s.name, s.width_bits)).collect()
    }

    /// Statements that assign whole signals and read none of them need no process.
    fn concurrent(&mut self, statements: &[Statement], reads: &BTreeSet<NetId>) -> Option<String> {
        let mut seen = BTreeSet::new();
        for statement in statements {
            let Statement::Assign {
                net,
                low_bit: 0,
                value,
                ..
            } = statement
            else {
                return None;
            };
            let is_whole = value.width_bits == self.module.nets[*net].width_bits;
            if !is_whole || reads.contains(net) || !seen.insert(*net) {
                return None;
            }
        }
        let mut out = String::new();
        for statement in statements {
            if let Statement::Assign {
                net, value, docs, ..
            } = statement
            {
                out.push_str(&comment(docs, INDENT));
                let name = self.reference(*net);
                let value = match is_condition(value) {
                    true => format!("'1' when {} else '0'", self.condition(value)),
                    false => self.assigned(value),
                };
                out.push_str(&format!("{INDENT}{name} <= {value};\n"));
            }
        }
        Some(out)
    }

    /// A value that is assigned to something of its width.
    pub fn assigned(&mut self, value: &Expr) -> String {
        match value.kind {
            ExprKind::Constant(known) => self.known(known, value.width_bits),
            _ => self.value(value, Context::Target),
        }
    }

    fn known(&self, value: u128, width_bits: usize) -> String {
        match value {
            0 if width_bits > 1 => "(others => '0')".into(),
            _ => literal(value, width_bits, Context::Target),
        }
    }

    pub fn block(&mut self, statements: &[Statement], depth: usize) -> String {
        let texts = statements.iter().map(|s| self.statement(s, depth));
        texts.collect()
    }

    /// The statements of a branch; VHDL wants one.
    fn branch(&mut self, statements: &[Statement], depth: usize) -> String {
        match statements {
            [] => format!("{}null;\n", INDENT.repeat(depth)),
            _ => self.block(statements, depth),
        }
    }

    fn statement(&mut self, statement: &Statement, depth: usize) -> String {
        let pad = INDENT.repeat(depth);
        let docs = comment(statement.docs(), &pad);
        let text = match statement {
            Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } => {
                let place = self.place(*net, *low_bit, value.width_bits);
                let sign = if self.variables.contains_key(net) {
                    ":="
                } else {
                    "<="
                };
                let value = self.assigned(value);
                format!("{pad}{place} {sign} {value};\n")
            }
            Statement::If {
                condition,
                then,
                otherwise,
                ..
            } => {
                let condition = self.condition(condition);
                let then = self.branch(then, depth + 1);
                let otherwise = self.otherwise(otherwise, depth);
                format!("{pad}if {condition} then\n{then}{otherwise}")
            }
            Statement::Case {
                subject,
                arms,
                default,
                ..
            } => self.case(subject, arms, default, depth),
        };
        docs + &text
    }

    fn otherwise(&mut self, otherwise: &[Statement], depth: usize) -> String {
        let pad = INDENT.repeat(depth);
        match otherwise {
            [] => format!("{pad}end if;\n"),
            [only @ Statement::If { docs, .. }] if docs.is_empty() => {
                let text = self.statement(only, depth);
                format!("{pad}els{}", text.trim_start())
            }
            _ => format!(
                "{pad}else\n{}{pad}end if;\n",
                self.block(otherwise, depth + 1)
            ),
        }
    }

    fn case(
        &mut self,
        subject: &Expr,
        arms: &[(Expr, Vec<Statement>)],
        default: &[Statement],
        depth: usize,
    ) -> String {
        let (pad, inner) = (INDENT.repeat(depth), INDENT.repeat(depth + 1));
        let is_net = match &subject.kind {
            ExprKind::Net(net) => !self.is_vector_port(*net),
            _ => subject.width_bits == 1,
        };
        let value = self.value(subject, Context::Target);
        // VHDL-93 wants to know the width of a subject beforehand.
        let (before, name) = match is_net {
            true => (String::new(), value),
            false => {
                let name = self.scope.unique("subject");
                let width_bits = subject.width_bits;
                self.subjects.push(Added {
                    name: name.clone(),
                    width_bits,
                });
                (format!("{pad}{name} := {value};\n"), name)
            }
        };
        let mut text = format!("{before}{pad}case {name} is\n");
        let mut seen = BTreeSet::new();
        for (value, body) in arms {
            let (known, choice) = match value.kind {
                ExprKind::Variant(id, variant) => (variant as u128, self.scope.state(id, variant)),
                ExprKind::Parameter(index) => {
                    let known = self.module.parameters[index].value;
                    (known, choice(known, value.width_bits))
                }
                ExprKind::Constant(known) => (known, choice(known, value.width_bits)),
                // Elaboration gives nothing else.
                _ => continue,
            };
            // The first arm counts; a second one would be an error.
            if seen.insert(known) {
                let body = self.branch(body, depth + 2);
                text.push_str(&format!("{inner}when {choice} =>\n{body}"));
            }
        }
        let body = self.branch(default, depth + 2);
        text + &format!("{inner}when others =>\n{body}{pad}end case;\n")
    }
}

//! Comments of a kernel, for the emitted text: rust-hdl reads tokens, which have none.

use syn::parse_quote;
use syn::spanned::Spanned;
use syn::visit_mut::{visit_block_mut, VisitMut};
use syn::{Block, ImplItemFn, Stmt};

/// Inserts the comment lines before a statement as `comment!`, from its source; the documentation of a part precedes its
/// first statement.
pub fn lift(function: &mut ImplItemFn, source: &[String]) {
    let documentation: Vec<Stmt> = super::lines(&function.attrs)
        .into_iter()
        .map(|line| parse_quote!(comment!(#line);))
        .collect();
    Lifter { source }.visit_block_mut(&mut function.block);
    function.block.stmts.splice(0..0, documentation);
}

struct Lifter<'a> {
    source: &'a [String],
}

impl VisitMut for Lifter<'_> {
    fn visit_block_mut(&mut self, block: &mut Block) {
        let mut all = Vec::with_capacity(block.stmts.len());
        for statement in std::mem::take(&mut block.stmts) {
            all.extend(self.before(statement.span().start().line));
            all.push(statement);
        }
        block.stmts = all;
        visit_block_mut(self, block);
    }
}

impl Lifter<'_> {
    /// The comment right above a line, which counts from 1.
    fn before(&self, line: usize) -> Vec<Stmt> {
        let above = self.source.iter().take(line.saturating_sub(1)).rev();
        let comment = above.map_while(|line| line.trim().strip_prefix("//"));
        let mut lines: Vec<Stmt> = comment.map(|text| parse_quote!(comment!(#text);)).collect();
        lines.reverse();
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::ToTokens;

    /// Catches a comment that is lost, is put before another statement, or leaves its place in a branch.
    #[test]
    fn a_comment_stands_before_its_statement() {
        let source = r#"
            /// The lamp.
            fn light(&mut self) {
                self.first.next = false;
                // Two lines
                // of it.
                if self.first.val() {
                    // Inside.
                    self.lamp.next = true;
                }
                self.last.next = true;

                // Of nothing.
            }"#;
        let whole = r#"{
            comment!(" The lamp.");
            self.first.next = false;
            comment!(" Two lines");
            comment!(" of it.");
            if self.first.val() {
                comment!(" Inside.");
                self.lamp.next = true;
            }
            self.last.next = true;
        }"#;
        let lines: Vec<String> = source.lines().map(str::to_owned).collect();
        let mut function = syn::parse_str(source).unwrap();
        lift(&mut function, &lines);
        let whole: Block = syn::parse_str(whole).unwrap();
        assert_eq!(
            function.block.to_token_stream().to_string(),
            whole.to_token_stream().to_string()
        );
    }
}

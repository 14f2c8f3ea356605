//! What rust-hdl's macro erases or mangles before anyone can see it must not stand in a kernel.

use std::fs;
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// What is wrong in the kernels of a source: one line each, `file:line: what; what to write instead`.
/// And how many functions of kernels there are.
fn check_source(file: &str, source: &str) -> (Vec<String>, usize) {
    let mut search = Search {
        file,
        found: vec![],
        functions: 0,
        loop_variables: vec![],
    };
    match syn::parse_file(source) {
        Ok(parsed) => search.visit_file(&parsed),
        Err(error) => search.found.push(format!("{file}: {error}")),
    }
    (search.found, search.functions)
}

struct Search<'a> {
    file: &'a str,
    found: Vec<String>,
    /// Functions of kernels that were looked into.
    functions: usize,
    loop_variables: Vec<String>,
}

/// Finds kernels and looks into each.
impl<'ast> Visit<'ast> for Search<'_> {
    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let names = ["kernel", "kernel_parts"];
        let is_kernel = |a: &syn::Attribute| names.iter().any(|name| a.path().is_ident(name));
        if !item.attrs.iter().any(is_kernel) {
            return;
        }
        for inner in &item.items {
            if let syn::ImplItem::Fn(function) = inner {
                self.functions += 1;
                Kernel(self).visit_block(&function.block);
            }
        }
    }
}

struct Kernel<'a, 'b>(&'a mut Search<'b>);

impl Kernel<'_, '_> {
    fn report(&mut self, at: proc_macro2::Span, problem: &str) {
        let search = &mut *self.0;
        search
            .found
            .push(format!("{}:{}: {problem}", search.file, at.start().line));
    }

    /// Bits may be taken of `self.x.val()` only, `x` being a path with indices.
    fn is_plain_value(expr: &syn::Expr) -> bool {
        let syn::Expr::MethodCall(call) = expr else {
            return false;
        };
        call.method == "val" && is_path(&call.receiver)
    }
}

fn is_path(expr: &syn::Expr) -> bool {
    match expr {
        syn::Expr::Path(path) => path.path.is_ident("self"),
        syn::Expr::Field(field) => is_path(&field.base),
        syn::Expr::Index(index) => is_path(&index.expr),
        _ => false,
    }
}

/// Whether an expression is read from `self._field`.
fn is_plain_field(field: &syn::ExprField) -> bool {
    matches!(&field.member, syn::Member::Named(name) if name.to_string().starts_with('_'))
}

impl<'ast> Visit<'ast> for Kernel<'_, '_> {
    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let syn::Pat::Guard(guarded) = &arm.pat {
            self.report(
                guarded.guard.span(),
                "match guard, which rust-hdl drops; write an if inside the arm",
            );
        }
        // The pattern is not an expression: variants and literals are fine there.
        self.visit_expr(&arm.body);
    }

    fn visit_expr_for_loop(&mut self, expr: &'ast syn::ExprForLoop) {
        // Loop bounds are Rust expressions, evaluated when the design is made: fields and constants are fine there.
        if let syn::Expr::Range(range) = &*expr.expr {
            if matches!(range.limits, syn::RangeLimits::Closed(_)) {
                self.report(
                    range.span(),
                    "`..=`, which rust-hdl takes for `..`; write `0..n + 1`",
                );
            }
        }
        let name = match &*expr.pat {
            syn::Pat::Ident(name) => name.ident.to_string(),
            _ => String::new(),
        };
        self.0.loop_variables.push(name);
        self.visit_block(&expr.body);
        self.0.loop_variables.pop();
    }

    fn visit_expr_field(&mut self, field: &'ast syn::ExprField) {
        if is_plain_field(field) {
            self.report(
                field.span(),
                "plain field in an expression, which rust-hdl prints as a name that does not exist; write a Constant<..> field",
            );
        }
        visit::visit_expr_field(self, field);
    }

    fn visit_expr_path(&mut self, path: &'ast syn::ExprPath) {
        let names: Vec<String> = path
            .path
            .segments
            .iter()
            .map(|s| s.ident.to_string())
            .collect();
        let Some((last, before)) = names.split_last() else {
            return;
        };
        let is_upper = |name: &str| {
            !name.chars().any(|c| c.is_ascii_lowercase())
                && name.starts_with(|c: char| c.is_ascii_uppercase())
        };
        // `State::F1` is a variant, and elaboration refuses it if it is not; `Self::F1` and `timing::F1` are constants.
        let is_variant = before
            .last()
            .is_some_and(|t| t != "Self" && t.starts_with(|c: char| c.is_ascii_uppercase()));
        if is_upper(last) && !is_variant {
            self.report(
                path.span(),
                "Rust constant in an expression, which rust-hdl prints as a name that does not exist; \
                 write a literal or a Constant<..> field",
            );
        }
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let is_slice = call.method == "get_bits" || call.method == "get_bit";
        if is_slice && !Self::is_plain_value(&call.receiver) {
            self.report(
                call.span(),
                "bits of an expression, which Verilog does not have; assign it to a Local and take bits of its .val()",
            );
        }
        // Arguments and receiver are values; the type arguments (a width) are not.
        self.visit_expr(&call.receiver);
        call.args
            .iter()
            .for_each(|argument| self.visit_expr(argument));
    }

    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        // The function's own path (bit_cast::<W, N>) holds types, no values.
        call.args
            .iter()
            .for_each(|argument| self.visit_expr(argument));
    }
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

#[test]
fn no_kernel_of_the_core_uses_what_the_macro_erases() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![];
    rust_files(&root.join("hdl"), &mut files);
    let mut functions = 0;
    let mut found = vec![];
    for path in files {
        let source = fs::read_to_string(&path).unwrap();
        let name = path.strip_prefix(root).unwrap().display().to_string();
        let (wrong, count) = check_source(&name, &source);
        found.extend(wrong);
        functions += count;
    }
    // A kernel for each block, and parts of the long ones.
    assert!(functions > 120, "the search found only {functions}");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// The complaints about a kernel with this body, without the place.
fn complaints(body: &str) -> Vec<String> {
    let source = format!("#[kernel]\nimpl Logic for X {{\nfn update(&mut self) {{\n{body}\n}}\n}}");
    check_source("x.rs", &source).0
}

#[test]
fn bad_kernels_are_found_with_file_line_and_remedy() {
    for (body, line, what, remedy) in [
        (
            "match self.a.val() { S::A if self.f.val() => {} _ => {} }",
            4,
            "match guard",
            "write an if",
        ),
        (
            "\nfor i in 0..=3 { self.x[i].next = true; }",
            5,
            "..=",
            "0..n + 1",
        ),
        (
            "self.x.next = self.a.val() + LIMIT;",
            4,
            "constant",
            "Constant<..>",
        ),
        (
            "self.x.next = self.a.val() + timing::LIMIT_1;",
            4,
            "constant",
            "Constant<..>",
        ),
        (
            "self.x.next = self.a.val() + Self::LIMIT;",
            4,
            "constant",
            "Constant<..>",
        ),
        (
            "self.x.next = self.a.val() + N;",
            4,
            "constant",
            "Constant<..>",
        ),
        (
            "self.x.next = self.a.val() + self._cfg;",
            4,
            "plain field",
            "Constant<..>",
        ),
        (
            "if self.a.val() == self._cfg.limit { self.x.next = 1.into(); }",
            4,
            "plain field",
            "Constant<..>",
        ),
        (
            "self.x.next = (self.a.val() + 1).get_bits::<3>(0);",
            4,
            "bits of an expression",
            "Local",
        ),
        (
            "self.x.next = bit_cast::<4, 8>(self.a.val()).get_bit(2);",
            4,
            "bits of an expression",
            "Local",
        ),
        (
            "match self.a.val().index() { 0 => { self.y.next = LIMIT.into(); } _ => {} }",
            4,
            "constant",
            "literal",
        ),
    ] {
        let found = complaints(body);
        assert_eq!(found.len(), 1, "{body}: {found:?}");
        assert!(
            found[0].starts_with(&format!("x.rs:{line}: ")),
            "{}",
            found[0]
        );
        assert!(
            found[0].contains(what) && found[0].contains(remedy),
            "{}",
            found[0]
        );
    }
}

#[test]
fn good_kernels_pass() {
    for body in [
        "for i in 0..self._n { self.x[i].next = self.a[i + 1].val(); }",
        "for i in 0..COUNT { self.x[i].next = true; }",
        "self.x.next = bit_cast::<W, 8>(self.a.val()).any();",
        "self.x.next = self.a[0].b.val().get_bits::<WIDTH>(self.c.val().index());",
        "match self.s.q.val() { State::Idle => {} State::RUN => {} _ => {} }",
        "self.s.d.next = State::Idle;",
        "self.s.d.next = Field::F1;",
    ] {
        assert_eq!(complaints(body), Vec::<String>::new(), "{body}");
    }
}

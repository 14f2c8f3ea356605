//! The rules of the house, where a tool can see them: lengths of files, functions and test binaries, no import in a circle, slow tests that
//! say what they cover.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{ImplItemFn, ItemFn, ItemImpl, ItemMod, ItemStruct, ItemUse, UseTree};

/// Folders of the crates.
const CRATES: [&str; 10] = [
    "design/macros",
    "design",
    "regs",
    "hdl/macros",
    "hdl",
    "sim",
    "host",
    "drivers/rust",
    "gen",
    "site",
];
/// Longest file.
const FILE_LINES: usize = 500;
/// Longest test binary: the sum of its files. A longer one is slow to build, and has too many topics.
const BINARY_LINES: usize = 10_000;
/// Longest function.
const FUNCTION_LINES: usize = 120;
/// Longest `update` of a kernel; its parts are functions as others are.
const KERNEL_LINES: usize = 200;
/// Most ports of a block; those that travel together are a bundle, and count once.
const PORTS: usize = 30;

/// What is still longer, and how long it may be at most: each of them becomes shorter, none is added.
const LONGER: &[(&str, usize)] = &[];

/// Files, beside those of its own, that name every protocol so that cards can have channels of it: a further one has a line or an arm there.
const NAME_PROTOCOLS: [&str; 6] = [
    "gen/config/keys.rs",
    "gen/protocols.rs",
    "hdl/encoder_port.rs",
    "hdl/protocols.rs",
    "regs/protocols.rs",
    "sim/lib.rs",
];
/// Files that name T-format for what only it has, or has besides: words of its own, a receiver that is no card, calls of drivers and host, a
/// scenario, campaigns.
const NAME_T_FORMAT: [&str; 26] = [
    "drivers/rust/lib.rs",
    "gen/area/flows.rs",
    "gen/area/subject.rs",
    "gen/bench/comparison.rs",
    "gen/bench/mod.rs",
    "gen/campaign/configurations/mod.rs",
    "gen/campaign/mutants/mod.rs",
    "gen/cli/campaign/tallies.rs",
    "gen/cli/emit.rs",
    "gen/cli/mod.rs",
    "gen/cli/new/questions.rs",
    "gen/cli/sim.rs",
    "gen/config/receiver.rs",
    "gen/integration.rs",
    "gen/json_schema.rs",
    "gen/maps/driver.rs",
    "gen/prove/mod.rs",
    "gen/vhdl/play.rs",
    "gen/virtual_card/mod.rs",
    "host/lib.rs",
    "host/protocols.rs",
    "regs/lib.rs",
    "regs/part.rs",
    "sim/bench/mod.rs",
    "sim/campaign/mod.rs",
    "sim/scenario/mod.rs",
];

/// A source of the product, without its tests.
struct Source {
    /// Path from the root of the repository.
    path: String,
    /// Crate and modules that lead to it.
    module: Vec<String>,
    lines: usize,
    parsed: syn::File,
}

fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => walk(&path, found),
            false => found.push(path),
        }
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = BTreeMap::new();
    for name in CRATES {
        let mut paths = Vec::new();
        walk(&root.join(name), &mut paths);
        for path in paths {
            let inside = path.strip_prefix(root.join(name)).unwrap();
            let parts: Vec<String> = inside
                .with_extension("")
                .iter()
                .map(|p| p.to_str().unwrap().to_owned())
                .collect();
            let is_test = parts
                .iter()
                .any(|p| ["tests", "testing"].contains(&p.as_str()));
            if path.extension().is_none_or(|e| e != "rs") || is_test || parts[0] == "templates" {
                continue;
            }
            let own = |p: &String| !["lib", "mod"].contains(&p.as_str());
            let module = std::iter::once(name.to_owned()).chain(parts.into_iter().filter(own));
            let text = fs::read_to_string(&path).unwrap();
            let path = path
                .strip_prefix(root)
                .unwrap()
                .to_str()
                .unwrap()
                .to_owned();
            let source = Source {
                module: module.collect(),
                lines: text.lines().count(),
                parsed: syn::parse_file(&text).unwrap_or_else(|e| panic!("{path}: {e}")),
                path: path.clone(),
            };
            // A crate inside another one's folder is its own.
            all.entry(path).or_insert(source);
        }
    }
    all.into_values().collect()
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    let text = |a: &syn::Attribute| a.meta.require_list().map(|l| l.tokens.to_string());
    attributes
        .iter()
        .any(|a| a.path().is_ident("cfg") && text(a).is_ok_and(|t| t == "test"))
}

/// Functions that are too long.
#[derive(Default)]
struct Functions {
    long: Vec<(String, usize)>,
    /// Within an `impl` that is a kernel.
    in_kernel: bool,
}

impl Functions {
    fn look(&mut self, name: &syn::Ident, block: &syn::Block) {
        let span = block.span();
        let lines = span.end().line - span.start().line + 1;
        let at_most = match self.in_kernel && name == "update" {
            true => KERNEL_LINES,
            false => FUNCTION_LINES,
        };
        if lines > at_most {
            self.long.push((name.to_string(), lines));
        }
    }
}

impl<'ast> Visit<'ast> for Functions {
    fn visit_item_impl(&mut self, item: &'ast ItemImpl) {
        self.in_kernel = item.attrs.iter().any(|a| a.path().is_ident("kernel"));
        visit::visit_item_impl(self, item);
        self.in_kernel = false;
    }

    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        self.look(&function.sig.ident, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        self.look(&function.sig.ident, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }
}

/// Paths that a source names, from its crate on.
struct Names<'a> {
    module: &'a [String],
    children: BTreeSet<String>,
    paths: BTreeSet<Vec<String>>,
    /// What it hands on: name, and path that it comes from; `*` for all.
    hands_on: Vec<(String, Vec<String>)>,
}

impl Names<'_> {
    fn absolute(&self, path: &[String]) -> Option<Vec<String>> {
        let mut base = self.module.to_vec();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => {
                base.truncate(1);
                rest = &path[1..];
            }
            "self" => rest = &path[1..],
            "super" => {}
            child if self.children.contains(child) => {}
            _ => return None,
        }
        while rest.first().is_some_and(|part| part == "super") {
            base.pop();
            rest = &rest[1..];
        }
        Some(base.into_iter().chain(rest.iter().cloned()).collect())
    }

    fn tree(&mut self, before: &[String], tree: &UseTree, is_public: bool) {
        let with = |name: &syn::Ident| {
            let own = (name != "self").then(|| name.to_string());
            let own = own.or_else(|| before.is_empty().then(|| name.to_string()));
            before.iter().cloned().chain(own).collect::<Vec<_>>()
        };
        let (name, path) = match tree {
            UseTree::Path(path) => return self.tree(&with(&path.ident), &path.tree, is_public),
            UseTree::Group(group) => {
                for item in &group.items {
                    self.tree(before, item, is_public);
                }
                return;
            }
            UseTree::Name(name) => (name.ident.to_string(), with(&name.ident)),
            UseTree::Rename(rename) => (rename.rename.to_string(), with(&rename.ident)),
            UseTree::Glob(_) => ("*".to_owned(), before.to_vec()),
        };
        if let Some(path) = self.absolute(&path) {
            if is_public {
                self.hands_on.push((name, path.clone()));
            }
            self.paths.insert(path);
        }
    }
}

impl<'ast> Visit<'ast> for Names<'_> {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let is_public = !matches!(item.vis, syn::Visibility::Inherited);
        if !is_test(&item.attrs) {
            self.tree(&[], &item.tree, is_public);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !is_test(&module.attrs) && module.content.is_some() {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        if parts.len() > 1 {
            self.paths.extend(self.absolute(&parts));
        }
        visit::visit_path(self, path);
    }
}

/// Which source takes something from which.
fn imports(sources: &[Source]) -> Vec<BTreeSet<usize>> {
    let of_module: BTreeMap<&[String], usize> = (0..)
        .zip(sources)
        .map(|(index, s)| (&s.module[..], index))
        .collect();
    let names: Vec<Names> = sources
        .iter()
        .map(|source| {
            let children = sources.iter().filter(|other| {
                other.module.len() == source.module.len() + 1
                    && other.module.starts_with(&source.module)
            });
            let mut names = Names {
                module: &source.module,
                children: children.map(|c| c.module.last().unwrap().clone()).collect(),
                paths: BTreeSet::new(),
                hands_on: vec![],
            };
            names.visit_file(&source.parsed);
            names
        })
        .collect();
    // The source that a path leads to, behind what others hand on.
    let home = |path: &[String]| {
        let mut path = path.to_vec();
        for _ in 0..8 {
            let length = (1..=path.len())
                .rev()
                .find(|n| of_module.contains_key(&path[..*n]))?;
            let at = of_module[&path[..length]];
            let Some(name) = path.get(length) else {
                return Some(at);
            };
            let handed = names[at].hands_on.iter().find(|(n, _)| n == name);
            let Some((_, from)) = handed else {
                return Some(at);
            };
            path = from.iter().chain(&path[length + 1..]).cloned().collect();
        }
        None
    };
    let edges = |index: usize| {
        let mut to: BTreeSet<usize> = names[index].paths.iter().filter_map(|p| home(p)).collect();
        // A part may use what the whole is made of: folder and file of a module are one.
        to.retain(|to| !sources[index].module.starts_with(&sources[*to].module));
        to
    };
    (0..sources.len()).map(edges).collect()
}

/// Sources that reach themselves again, those of one circle together.
fn circles(edges: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let reach = |start: usize| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(at) = open.pop() {
            open.extend(edges[at].iter().filter(|next| seen.insert(**next)));
        }
        seen
    };
    let reached: Vec<BTreeSet<usize>> = (0..edges.len()).map(reach).collect();
    let mut circles = BTreeSet::new();
    for (index, own) in reached
        .iter()
        .enumerate()
        .filter(|(i, own)| own.contains(i))
    {
        circles.insert(
            own.iter()
                .copied()
                .filter(|to| reached[*to].contains(&index))
                .collect(),
        );
    }
    circles.into_iter().collect()
}

#[test]
fn no_import_goes_in_a_circle() {
    let sources = sources();
    assert!(sources.len() > 200, "{} sources", sources.len());
    let edges = imports(&sources);
    let told: Vec<String> = circles(&edges)
        .into_iter()
        .map(|circle| {
            let mut text = String::from("circle:\n");
            for from in &circle {
                let to = edges[*from].iter().filter(|to| circle.contains(to));
                let to: Vec<&str> = to.map(|to| sources[*to].path.as_str()).collect();
                text += &format!("  {} takes from {}\n", sources[*from].path, to.join(", "));
            }
            text
        })
        .collect();
    assert!(told.is_empty(), "{}", told.concat());
}

#[test]
fn files_and_functions_are_short() {
    let mut found = BTreeMap::new();
    for source in sources() {
        if source.lines > FILE_LINES {
            found.insert(source.path.clone(), source.lines);
        }
        let mut functions = Functions::default();
        functions.visit_file(&source.parsed);
        let named = |(name, lines)| (format!("{}: {name}", source.path), lines);
        found.extend(functions.long.into_iter().map(named));
    }
    for (name, at_most) in LONGER {
        let lines = found
            .remove(*name)
            .unwrap_or_else(|| panic!("{name} is short now: take it off the list"));
        assert!(lines <= *at_most, "{name}: {lines} lines, were {at_most}");
    }
    assert!(found.is_empty(), "too long: {found:#?}");
}

/// Ports of each block of a file.
#[derive(Default)]
struct Ports(Vec<(String, usize)>);

impl<'ast> Visit<'ast> for Ports {
    fn visit_item_struct(&mut self, item: &'ast ItemStruct) {
        let mut is_block = false;
        for attribute in item.attrs.iter().filter(|a| a.path().is_ident("derive")) {
            attribute
                .parse_nested_meta(|derive| {
                    is_block |= derive.path.is_ident("LogicBlock");
                    Ok(())
                })
                .unwrap();
        }
        if is_block {
            let is_port = |field: &&syn::Field| matches!(field.vis, syn::Visibility::Public(_));
            let ports = item.fields.iter().filter(is_port).count();
            self.0.push((item.ident.to_string(), ports));
        }
    }
}

#[test]
fn a_block_has_few_ports() {
    let mut all = Ports::default();
    let sources = sources();
    let blocks = sources.iter().filter(|s| s.path.starts_with("hdl/"));
    blocks.for_each(|source| all.visit_file(&source.parsed));
    assert!(all.0.len() > 50, "only {} blocks found", all.0.len());
    all.0.retain(|(_, ports)| *ports > PORTS);
    assert!(all.0.is_empty(), "more than {PORTS} ports: {:?}", all.0);
}

/// Adds a file of a crate and the files of its modules. `folder` is the place of the modules that it declares.
fn add_modules(file: &Path, folder: &Path, found: &mut BTreeSet<PathBuf>) {
    let file = file
        .canonicalize()
        .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let parsed = syn::parse_file(&fs::read_to_string(&file).unwrap()).unwrap();
    let place = file.parent().unwrap().to_owned();
    if found.insert(file) {
        add_declared(&parsed.items, &place, folder, found);
    }
}

/// Adds the modules that these items declare; `place` is the folder of their file, `folder` that of its modules.
fn add_declared(items: &[syn::Item], place: &Path, folder: &Path, found: &mut BTreeSet<PathBuf>) {
    for item in items {
        let syn::Item::Mod(module) = item else {
            continue;
        };
        let inside = folder.join(module.ident.to_string());
        let path = module.attrs.iter().find_map(|a| {
            let value = &a.meta.require_name_value().ok()?.value;
            let syn::Expr::Lit(literal) = value else {
                return None;
            };
            match &literal.lit {
                syn::Lit::Str(text) if a.path().is_ident("path") => Some(text.value()),
                _ => None,
            }
        });
        match (&module.content, path) {
            (Some((_, items)), _) => add_declared(items, &inside, &inside, found),
            (None, Some(path)) => {
                let file = place.join(path);
                add_modules(&file, file.parent().unwrap(), found);
            }
            (None, None) => {
                let single = inside.with_extension("rs");
                let file = match single.exists() {
                    true => single,
                    false => inside.join("mod.rs"),
                };
                add_modules(&file, &inside, found);
            }
        }
    }
}

#[test]
fn no_test_binary_is_above_10_000_lines() {
    let members = crate::packages::members();
    let packages = members["packages"].as_array().unwrap().iter();
    let targets = packages.flat_map(|p| p["targets"].as_array().unwrap());
    let mut lines = BTreeMap::new();
    for target in targets.filter(|t| t["kind"][0] == "test") {
        let file = Path::new(target["src_path"].as_str().unwrap());
        let mut files = BTreeSet::new();
        add_modules(file, file.parent().unwrap(), &mut files);
        let of = |file: &PathBuf| fs::read_to_string(file).unwrap().lines().count();
        lines.insert(
            target["name"].as_str().unwrap(),
            files.iter().map(of).sum::<usize>(),
        );
    }
    for name in [
        "emission", "cards", "programs", "delivery", "endat", "blocks", "designs",
    ] {
        assert!(lines[name] > 1_000, "{lines:?}");
    }
    lines.retain(|_, lines| *lines > BINARY_LINES);
    assert!(lines.is_empty(), "above {BINARY_LINES} lines: {lines:?}");
}

/// Every file of the repository in folders that people write.
fn written_files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![];
    let folders = ["tests", "gen", "drivers", "campaigns", ".ci"];
    for folder in CRATES.iter().chain(&folders) {
        let folder = root.join(folder);
        if folder.exists() {
            walk(&folder, &mut files);
        }
    }
    files.sort();
    files.dedup();
    files
}

/// Verdicts of earlier runs are not kept: a test that is in the suite runs. One that is too slow is ignored, and its reason says what it
/// covers: CI runs these at night.
#[test]
fn slow_tests_say_what_they_cover_and_no_verdict_is_kept() {
    let files = written_files();
    assert!(files.len() > 500, "{} files", files.len());
    let mut slow = 0;
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let path_text = path.display();
        assert!(
            !["passed.toml", "passed.rs"].contains(&name),
            "{path_text}: keeps verdicts; delete it"
        );
        if !name.ends_with(".rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim_start().starts_with("#[ignore") {
                let reason = line.trim().strip_prefix("#[ignore = \"slow: ");
                assert!(
                    reason.is_some_and(|r| r.len() > "\"]".len()),
                    "{path_text}:{number}: give the reason: #[ignore = \"slow: WHAT IT COVERS\"]"
                );
                slow += 1;
            }
        }
    }
    assert!(slow > 0, "no slow test");
}

/// The compiler is for any block of rust-hdl: nothing in it is named after what it compiles here, and it needs no other crate of ours.
#[test]
fn the_compiler_knows_no_endat() {
    let mut files = Vec::new();
    walk(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("design"),
        &mut files,
    );
    for path in files
        .iter()
        .filter(|p| p.extension() != Some("md".as_ref()))
    {
        let text = fs::read_to_string(path).unwrap().to_lowercase();
        assert!(!text.contains("endat"), "{}", path.display());
    }
}

/// Whether a file has such a name in its code; what stands in texts and comments says something to people only.
fn is_naming(source: &Source, is_named: fn(&str) -> bool) -> bool {
    struct Search {
        is_named: fn(&str) -> bool,
        found: bool,
    }
    impl Search {
        fn look(&mut self, tokens: proc_macro2::TokenStream) {
            for token in tokens {
                match token {
                    proc_macro2::TokenTree::Ident(name) => self.visit_ident(&name),
                    proc_macro2::TokenTree::Group(group) => self.look(group.stream()),
                    _ => {}
                }
            }
        }
    }
    impl<'ast> Visit<'ast> for Search {
        fn visit_ident(&mut self, name: &proc_macro2::Ident) {
            self.found |= (self.is_named)(&name.to_string());
        }

        fn visit_macro(&mut self, call: &'ast syn::Macro) {
            self.look(call.tokens.clone());
        }

        fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

        fn visit_item_fn(&mut self, function: &'ast ItemFn) {
            if !is_test(&function.attrs) {
                visit::visit_item_fn(self, function);
            }
        }

        fn visit_item_mod(&mut self, module: &'ast ItemMod) {
            if !is_test(&module.attrs) {
                visit::visit_item_mod(self, module);
            }
        }
    }
    let mut search = Search {
        is_named,
        found: false,
    };
    search.visit_file(&source.parsed);
    search.found
}

/// Catches a new place that asks which bus a card stands behind: the next front would have to be told there, too. Shown by the one that came last.
#[test]
fn a_bus_is_known_by_name_in_few_places() {
    let sources = sources();
    let others = sources.iter().filter(|s| !s.path.contains("ahb"));
    let is_ahb = |name: &str| name.to_lowercase().starts_with("ahb");
    let naming = others.filter(|s| is_naming(s, is_ahb));
    let naming: Vec<&str> = naming.map(|s| s.path.as_str()).collect();
    assert_eq!(naming, ["gen/buses.rs", "hdl/card/bus.rs"]);
}

/// Catches a new place that asks which protocol a channel speaks instead of asking the protocol: the next one would have to be told there, too.
#[test]
fn a_protocol_is_known_by_name_in_few_places() {
    let sources = sources();
    let found = |folder: &str, is_named: fn(&str) -> bool| -> Vec<String> {
        let others = sources.iter().filter(|s| !s.path.contains(folder));
        let naming = others.filter(|s| is_naming(s, is_named));
        naming.map(|s| s.path.clone()).collect()
    };
    // What a third protocol takes, shown by the one that came third.
    let is_ssi = |name: &str| {
        name.to_lowercase()
            .trim_start_matches('_')
            .starts_with("ssi")
    };
    assert_eq!(found("ssi", is_ssi), NAME_PROTOCOLS);
    let mut known = [&NAME_PROTOCOLS[..], &NAME_T_FORMAT].concat();
    known.sort_unstable();
    let is_t_format = |name: &str| name.to_lowercase().replace('_', "").contains("tformat");
    assert_eq!(found("t_format", is_t_format), known);
}

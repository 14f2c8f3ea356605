//! The rules of the house, where a tool can see them: lengths of files, functions and test binaries, no import in a circle, slow tests that
//! say what they cover.

mod suite;
mod words;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{ImplItemFn, ItemFn, ItemImpl, ItemMod, ItemStruct, ItemUse, UseTree};

/// Folders of the crates; one in the folder of another comes first.
const CRATES: [&str; 23] = [
    "design/macros",
    "design",
    "regs",
    "hdl/macros",
    "hdl",
    "sim/card",
    "sim/draw",
    "sim",
    "constraints",
    "drivers/c",
    "drivers/cli",
    "drivers/console",
    "drivers/host",
    "drivers/recording",
    "drivers/rust",
    "drivers/terminal",
    "gen/campaign",
    "gen/config",
    "gen/emit",
    "gen/tools",
    "gen",
    "site",
    "tests/workshop",
];
/// Longest file.
const FILE_LINES: usize = 500;
/// Longest function.
const FUNCTION_LINES: usize = 120;
/// Longest `update` of a kernel; its parts are functions as others are.
const KERNEL_LINES: usize = 200;
/// Most ports of a block; those that travel together are a bundle, and count once.
const PORTS: usize = 30;

/// What is still longer, and how long it may be at most: each of them becomes shorter, none is added.
const LONGER: &[(&str, usize)] = &[];

/// Files, beside those of its own, that name every protocol so that cards can have channels of it: a further one has a line or an arm there.
const NAME_PROTOCOLS: [&str; 11] = [
    "gen/campaign/budget.rs",
    "gen/cli/campaign/tallies.rs",
    "gen/config/keys.rs",
    "gen/config/protocols/mod.rs",
    "gen/emit/protocols/mod.rs",
    "hdl/encoder_port.rs",
    "hdl/protocols.rs",
    "regs/protocols.rs",
    "sim/campaign/other/mod.rs",
    "sim/card/protocols/mod.rs",
    "sim/lib.rs",
];
/// Files that name T-format for what only it has, or has besides: words of its own, a receiver that is no card, calls of drivers and host, a
/// scenario, campaigns.
const NAME_T_FORMAT: [&str; 24] = [
    "drivers/rust/lib.rs",
    "tests/workshop/flows.rs",
    "gen/tools/area/subject.rs",
    "tests/workshop/bench/comparison.rs",
    "tests/workshop/bench/mod.rs",
    "gen/campaign/configurations/mod.rs",
    "tests/workshop/mutants/mod.rs",
    "gen/cli/new/questions.rs",
    "gen/cli/sim.rs",
    "gen/config/explain/receiver.rs",
    "gen/config/receiver.rs",
    "gen/emit/integration.rs",
    "gen/config/json_schema.rs",
    "gen/emit/maps/driver.rs",
    "gen/tools/prove/mod.rs",
    "gen/emit/vhdl/play.rs",
    "gen/emit/with.rs",
    "sim/card/lib.rs",
    "drivers/host/lib.rs",
    "drivers/host/protocols.rs",
    "regs/lib.rs",
    "regs/part.rs",
    "sim/bench/mod.rs",
    "sim/scenario/mod.rs",
];

/// A source of the product, without its tests: what the rules look at.
struct Source {
    /// Path from the root of the repository.
    path: String,
    /// Crate and modules that lead to it.
    module: Vec<String>,
    lines: usize,
    /// Functions that are too long, and their lines.
    long: Vec<(String, usize)>,
    /// Blocks, and their ports.
    blocks: Vec<(String, usize)>,
    /// Names in its code.
    names: BTreeSet<String>,
    /// Paths that it names, from its crate on.
    paths: BTreeSet<Vec<String>>,
    /// Names that it hands on, and the paths that they come from; `*` for all.
    hands_on: Vec<(String, Vec<String>)>,
}

impl Source {
    fn new(path: String, module: Vec<String>, children: BTreeSet<String>, text: &str) -> Self {
        let parsed = syn::parse_file(text).unwrap_or_else(|e| panic!("{path}: {e}"));
        let (mut functions, mut ports) = (Functions::default(), Ports::default());
        functions.visit_file(&parsed);
        ports.visit_file(&parsed);
        let mut code = Code::default();
        code.visit_file(&parsed);
        let mut names = Names {
            module: &module,
            children,
            paths: BTreeSet::new(),
            hands_on: vec![],
        };
        names.visit_file(&parsed);
        let Names {
            paths, hands_on, ..
        } = names;
        Self {
            lines: text.lines().count(),
            long: functions.long,
            blocks: ports.0,
            names: code.0,
            paths,
            hands_on,
            path,
            module,
        }
    }
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

/// Parsed once for all tests: that takes longer than they do.
static SOURCES: LazyLock<Vec<Source>> = LazyLock::new(|| {
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
            let file = path.strip_prefix(root).unwrap().to_str().unwrap();
            // A crate inside another one's folder is its own.
            all.entry(file.to_owned())
                .or_insert_with(|| module.collect::<Vec<String>>());
        }
    }
    let sources = all.iter().map(|(path, module)| {
        let others = all
            .values()
            .filter(|other| other.len() == module.len() + 1 && other.starts_with(module));
        let children = others.map(|other| other.last().unwrap().clone()).collect();
        let text = fs::read_to_string(root.join(path)).unwrap();
        Source::new(path.clone(), module.clone(), children, &text)
    });
    sources.collect()
});

fn sources() -> &'static [Source] {
    &SOURCES
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
            let handed = sources[at].hands_on.iter().find(|(n, _)| n == name);
            let Some((_, from)) = handed else {
                return Some(at);
            };
            path = from.iter().chain(&path[length + 1..]).cloned().collect();
        }
        None
    };
    let edges = |index: usize| {
        let mut to: BTreeSet<usize> = sources[index]
            .paths
            .iter()
            .filter_map(|p| home(p))
            .collect();
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
    let edges = imports(sources);
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
        let named = |(name, lines): &(String, usize)| (format!("{}: {name}", source.path), *lines);
        found.extend(source.long.iter().map(named));
    }
    for (name, at_most) in LONGER {
        let lines = found
            .remove(*name)
            .unwrap_or_else(|| panic!("{name} is short now: take it off the list"));
        assert!(lines <= *at_most, "{name}: {lines} lines, were {at_most}");
    }
    assert!(found.is_empty(), "too long: {found:#?}");
}

/// rustdoc reads the whole crate for a documentation test, so crates that only draw have none.
#[test]
fn crates_without_documentation_tests_have_no_runnable_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut checked = 0;
    for source in sources() {
        let path = root.join(&source.path);
        let manifests = path.ancestors().map(|folder| folder.join("Cargo.toml"));
        let manifest = manifests.into_iter().find(|m| m.exists()).unwrap();
        let manifest = fs::read_to_string(manifest).unwrap();
        if !manifest.contains("\ndoctest = false") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let comments = text.lines().map(str::trim_start);
        let fences = comments.filter_map(|line| {
            let comment = line
                .strip_prefix("//!")
                .or_else(|| line.strip_prefix("///"))?;
            comment.trim_start().strip_prefix("```")
        });
        for opening in fences.step_by(2) {
            checked += 1;
            assert!(
                ["text", "ignore", "toml"].contains(&opening),
                "{}: ```{opening} never runs; make it a unit test",
                source.path
            );
        }
    }
    assert!(checked > 60, "only {checked} fences found");
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
    let blocks = sources().iter().filter(|s| s.path.starts_with("hdl/"));
    let mut all: Vec<_> = blocks.flat_map(|source| &source.blocks).collect();
    assert!(all.len() > 50, "only {} blocks found", all.len());
    all.retain(|(_, ports)| *ports > PORTS);
    assert!(all.is_empty(), "more than {PORTS} ports: {all:?}");
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

/// Names in the code of a file; texts and comments say something to people only.
#[derive(Default)]
struct Code(BTreeSet<String>);

impl Code {
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

impl<'ast> Visit<'ast> for Code {
    fn visit_ident(&mut self, name: &proc_macro2::Ident) {
        self.0.insert(name.to_string());
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

/// True if a file has such a name in its code.
fn is_naming(source: &Source, is_named: fn(&str) -> bool) -> bool {
    source.names.iter().any(|name| is_named(name))
}

/// Catches a new place that asks which bus a card stands behind: the next front would have to be told there, too. Shown by the one that came last.
#[test]
fn a_bus_is_known_by_name_in_few_places() {
    let sources = sources();
    let others = sources.iter().filter(|s| !s.path.contains("ahb"));
    let is_ahb = |name: &str| name.to_lowercase().starts_with("ahb");
    let naming = others.filter(|s| is_naming(s, is_ahb));
    let naming: Vec<&str> = naming.map(|s| s.path.as_str()).collect();
    assert_eq!(naming, ["gen/emit/buses/mod.rs", "hdl/card/bus.rs"]);
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

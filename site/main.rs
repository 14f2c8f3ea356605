//! `cargo run -p endat-site`: the documentation as a site, in one folder.

use clap::Parser;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Builds the documentation as a site, and follows each link in it
#[derive(Parser)]
#[command(name = "endat-site")]
struct Arguments {
    /// Folder for it
    #[arg(long, value_name = "DIR", default_value = "target/site")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    // Beside this crate: the pages are the repository's.
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (complaints, code) = match endat_site::build(&repository, &arguments.out) {
        Err(complaints) => (complaints, 2),
        Ok(first) => match endat_site::dead_links(first.parent().unwrap_or(&arguments.out)) {
            Err(error) => (vec![error.to_string()], 2),
            Ok(dead) if dead.is_empty() => {
                println!("{}", first.display());
                return ExitCode::SUCCESS;
            }
            Ok(dead) => (dead, 1),
        },
    };
    complaints
        .iter()
        .for_each(|text| eprintln!("endat-site: {text}"));
    ExitCode::from(code)
}

//! Files of an emission, by the blocks that they hold.

use endat_console::artifact::Artifact;
use endat_tools::readers::is_core;
use rtl_design::elaborate::block_name;
use rtl_design::verilog::file_name;

/// The name of an emitted card or receiver.
pub fn name_of(files: &[Artifact]) -> &str {
    let mut names = files.iter().filter_map(|f| f.path.strip_suffix(".f"));
    names.next().expect("a list of files")
}

/// The file of a block of an emitted card; the card's own module has no block's name.
pub fn file_of(files: &[Artifact], block: &str) -> String {
    match block {
        "" => file_name(name_of(files)),
        _ => file_name(&block_name(name_of(files), block)),
    }
}

/// Whether a card has a block, in whatever variants.
pub fn has_block(files: &[Artifact], block: &str) -> bool {
    let name = block_name(name_of(files), block);
    files
        .iter()
        .any(|f| is_core(f) && f.path.starts_with(&name))
}

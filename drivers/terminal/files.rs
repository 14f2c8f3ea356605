//! Files that a command writes besides its result: never over what is not its own.

use endat_console::artifact::{self, Artifact};
use endat_console::error::{shown, CommandError};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A file to be written.
pub struct File {
    /// The option that asked for it.
    pub option: &'static str,
    /// Where.
    pub path: PathBuf,
    /// What.
    pub text: String,
    /// Whether a file that begins like this may be replaced.
    pub is_ours: fn(&str) -> bool,
}

/// So much of a file that is there already is looked at.
const HEAD_BYTES: u64 = 4096;

/// Refuses files that cannot be written, or would replace something else.
pub fn check_all(files: &[&File]) -> Result<(), CommandError> {
    check_places(files)?;
    files.iter().try_for_each(|file| {
        check_owner(file)?;
        check_writable(file)
    })
}

/// Writes files, unless one of them would replace something else; returns one message for each.
pub fn write_all(files: &[File]) -> Result<Vec<String>, CommandError> {
    check_all(&files.iter().collect::<Vec<_>>())?;
    let mut written = Vec::new();
    for file in files {
        written.extend(write(file)?);
    }
    Ok(written)
}

/// Refuses two files in one place: the layout of the waveforms, too, has one.
fn check_places(files: &[&File]) -> Result<(), CommandError> {
    for (index, file) in files.iter().enumerate() {
        for other in &files[..index] {
            let (this, that) = (place(&file.path), place(&other.path));
            if this != that && (this.starts_with(&that) || that.starts_with(&this)) {
                return Err(file.refused(&format!(
                    "one of it and the file of {} is below the other; give another file",
                    other.option
                )));
            }
            if this == that {
                return Err(file.refused(&if file.option == other.option {
                    "is the name of the layout beside it; give a name that ends in .vcd".into()
                } else {
                    format!(
                        "is the place of a file of {}; give another file",
                        other.option
                    )
                }));
            }
        }
    }
    Ok(())
}

/// Refuses a place that no file can be made in: missing folders are made, so the nearest that is there counts.
fn check_writable(file: &File) -> Result<(), CommandError> {
    if file.path.exists() && !file.path.is_file() {
        return Ok(());
    }
    let mut folders = folder(&file.path).ancestors();
    // The last one of a relative path is empty.
    let nearest = folders.find(|f| f.as_os_str().is_empty() || f.symlink_metadata().is_ok());
    let nearest = nearest.filter(|f| !f.as_os_str().is_empty());
    let nearest = nearest.unwrap_or(Path::new("."));
    let made = tempfile::tempfile_in(nearest);
    made.map(drop).map_err(|e| {
        file.refused(&format!(
            "no file can be made in {}: {e}; give another file",
            nearest.display()
        ))
    })
}

/// Refuses to replace a file that the program cannot have written, and what is no file unless anything may be written over.
fn check_owner(file: &File) -> Result<(), CommandError> {
    match std::fs::metadata(&file.path) {
        Ok(there) if there.is_file() => {}
        Ok(there) if there.is_dir() => {
            return Err(file.refused("is a folder, not a file; give another file"));
        }
        Ok(_) if !(file.is_ours)("") => {
            return Err(file.refused("is not a regular file; give another file"));
        }
        _ => return Ok(()),
    }
    let mut head = Vec::new();
    std::fs::File::open(&file.path)
        .and_then(|f| f.take(HEAD_BYTES).read_to_end(&mut head))
        .map_err(|e| CommandError::io("read", &file.path, &e, "give another file"))?;
    // Nothing is lost with an empty file.
    if head.is_empty() || (file.is_ours)(&String::from_utf8_lossy(&head)) {
        return Ok(());
    }
    Err(file.refused(
        "holds something else; only files of this program are replaced; give another file, or delete this one",
    ))
}

impl File {
    fn refused(&self, text: &str) -> CommandError {
        CommandError::input(format!("{} = {}: {text}", self.option, self.path.display()))
    }
}

/// The folder that a file is in.
pub fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

/// One spelling for all the ways to name a file.
fn place(path: &Path) -> PathBuf {
    let whole = std::fs::canonicalize(path);
    whole.unwrap_or_else(|_| {
        // A link to a file that is not there yet.
        let to = std::fs::read_link(path).map(|to| folder(path).join(to));
        let path = to.as_deref().unwrap_or(path);
        let folder = folder(path);
        let folder = std::fs::canonicalize(folder)
            .or_else(|_| std::path::absolute(folder))
            .unwrap_or_else(|_| folder.to_owned());
        folder.join(path.file_name().unwrap_or_default())
    })
}

/// The name of a file that an option asks for.
pub fn file_name(option: &str, path: &Path) -> Result<String, CommandError> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
    name.ok_or_else(|| {
        CommandError::input(format!(
            "{option} = {}: is not the name of a file; give one",
            shown(&path.display().to_string())
        ))
    })
}

fn write(file: &File) -> Result<Vec<String>, CommandError> {
    let path = &file.path;
    let artifact = Artifact::new(file_name(file.option, path)?, &file.text);
    let files = artifact::write(folder(path), &[artifact], "give another file")?;
    let told = match files.is_empty() {
        true => format!("{}: up to date", path.display()),
        false => format!("wrote {}", path.display()),
    };
    Ok(vec![told])
}

//! Output files that are whole or not there.

use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A file under a temporary name beside its final one. [`commit`](Self::commit) gives it its name;
/// dropped without that, it is removed.
///
/// It is made before the work starts, so that a place that cannot be written to is known early.
#[derive(Debug)]
pub(crate) struct Output {
    target: PathBuf,
    /// Where the bytes go; the target itself if that is no ordinary file, as `/dev/null`.
    path: PathBuf,
    pending: bool,
}

impl Output {
    /// Makes the temporary file.
    ///
    /// # Errors
    /// [`Failure::Write`] if the folder is missing or not writable.
    pub(crate) fn create(target: &Path) -> Result<Self, Failure> {
        let fail = |source| Failure::Write {
            path: target.to_path_buf(),
            source,
        };
        let special = fs::metadata(target).is_ok_and(|m| !m.is_file() && !m.is_dir());
        if special {
            return Ok(Self {
                target: target.to_path_buf(),
                path: target.to_path_buf(),
                pending: false,
            });
        }
        let name = target
            .file_name()
            .filter(|_| !target.is_dir())
            .ok_or_else(|| fail(io::Error::from(io::ErrorKind::IsADirectory)))?;
        // A link stays a link: the file it leads to is replaced.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
        let mut temporary = OsString::from(".");
        temporary.push(name);
        temporary.push(format!(".{}.part", std::process::id()));
        let path = target.with_file_name(temporary);
        OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)
            .map_err(fail)?;
        Ok(Self {
            target,
            path,
            pending: true,
        })
    }

    /// Where to write; the name's ending says nothing about the format.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes all of the content.
    ///
    /// # Errors
    /// [`Failure::Write`].
    pub(crate) fn write(&self, content: &[u8]) -> Result<(), Failure> {
        fs::write(&self.path, content).map_err(|source| Failure::Write {
            path: self.target.clone(),
            source,
        })
    }

    /// Moves the file to its name.
    ///
    /// # Errors
    /// [`Failure::Write`].
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        if self.pending {
            fs::rename(&self.path, &self.target).map_err(|source| Failure::Write {
                path: self.target.clone(),
                source,
            })?;
            self.pending = false;
        }
        Ok(())
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if self.pending {
            // Nothing can be done about a failure here, and the user hears of the first one.
            fs::remove_file(&self.path).ok();
        }
    }
}

/// Writes to an open [`Output`], or to standard output if there is none.
///
/// # Errors
/// [`Failure::Write`].
pub(crate) fn finish(output: Option<Output>, content: &[u8]) -> Result<(), Failure> {
    match output {
        Some(output) => {
            output.write(content)?;
            output.commit()
        }
        None => print(content),
    }
}

/// Writes to standard output. A reader that has gone away, as `head` does, is no failure.
///
/// # Errors
/// [`Failure::Write`].
pub(crate) fn print(content: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(content).and_then(|()| stdout.flush()) {
        Err(source) if source.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Write {
            path: PathBuf::from("standard output"),
            source,
        }),
        _ => Ok(()),
    }
}

/// A value as one line of JSON.
///
/// # Errors
/// [`Failure::Json`] if a number is not finite.
pub(crate) fn json_line(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    let mut line = serde_json::to_vec(value).map_err(Failure::Json)?;
    line.push(b'\n');
    Ok(line)
}

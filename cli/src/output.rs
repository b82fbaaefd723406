//! Output files that are whole or not there.

use std::cell::Cell;
use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A file under a temporary name beside its final one. [`commit`](Self::commit) gives it its name;
/// dropped without that, it is removed.
///
/// It is tried before the work starts, so that a place that cannot be written to is known early,
/// and made when it is written, so that a program that is stopped in its work leaves nothing.
#[derive(Debug)]
pub(crate) struct Output {
    target: PathBuf,
    /// `None` if the target is no ordinary file, as `/dev/null`, and is written directly.
    temporary: Option<PathBuf>,
    made: Cell<bool>,
}

impl Output {
    /// Tries whether the file can be made.
    ///
    /// # Errors
    /// [`Failure::Write`] if the folder is missing or not writable, or the target is a folder.
    pub(crate) fn create(target: &Path) -> Result<Self, Failure> {
        let fail = |source| Failure::Write {
            path: target.to_path_buf(),
            source,
        };
        if fs::metadata(target).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
            return Ok(Self {
                target: target.to_path_buf(),
                temporary: None,
                made: Cell::new(false),
            });
        }
        let name = target
            .file_name()
            .filter(|_| !target.is_dir())
            .ok_or_else(|| fail(io::Error::from(io::ErrorKind::IsADirectory)))?;
        let mut temporary = OsString::from(".");
        temporary.push(name);
        temporary.push(format!(".{}.part", std::process::id()));
        // A link stays a link: the file it leads to is replaced.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_path_buf());
        let output = Self {
            temporary: Some(target.with_file_name(temporary)),
            target,
            made: Cell::new(false),
        };
        output.path()?;
        output.remove();
        Ok(output)
    }

    /// Where to write, an empty file; its name's ending says nothing about the format.
    ///
    /// # Errors
    /// [`Failure::Write`] if it cannot be made.
    pub(crate) fn path(&self) -> Result<&Path, Failure> {
        let Some(path) = &self.temporary else {
            return Ok(&self.target);
        };
        if !self.made.get() {
            // A file of that name that is there already is another's, and not to be written to.
            let made = OpenOptions::new().write(true).create_new(true).open(path);
            made.map_err(|source| self.failure(source))?;
            self.made.set(true);
        }
        Ok(path)
    }

    /// Writes all of the content.
    ///
    /// # Errors
    /// [`Failure::Write`].
    pub(crate) fn write(&self, content: &[u8]) -> Result<(), Failure> {
        fs::write(self.path()?, content).map_err(|source| self.failure(source))
    }

    /// Moves the file to its name.
    ///
    /// # Errors
    /// [`Failure::Write`].
    pub(crate) fn commit(self) -> Result<(), Failure> {
        if let (Some(path), true) = (&self.temporary, self.made.get()) {
            fs::rename(path, &self.target).map_err(|source| self.failure(source))?;
            self.made.set(false);
        }
        Ok(())
    }

    fn failure(&self, source: io::Error) -> Failure {
        Failure::Write {
            path: self.target.clone(),
            source,
        }
    }

    fn remove(&self) {
        if let (Some(path), true) = (&self.temporary, self.made.replace(false)) {
            // Nothing can be done about a failure here, and the user hears of the first one.
            fs::remove_file(path).ok();
        }
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        self.remove();
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

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty folder of this test's own.
    fn folder(name: &str) -> PathBuf {
        let name = format!("faceformer-output-{}-{name}", std::process::id());
        let dir = std::env::temp_dir().join(name);
        fs::create_dir_all(&dir).unwrap();
        dir
    }

    fn count(dir: &Path) -> usize {
        fs::read_dir(dir).unwrap().count()
    }

    #[test]
    fn only_a_committed_file_stays() {
        let dir = folder("commit");
        let target = dir.join("a.txt");
        fs::write(&target, "old").unwrap();
        let output = Output::create(&target).unwrap();
        assert_eq!(count(&dir), 1, "nothing is there before it is written");
        output.write(b"new").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"old");
        drop(output);
        assert_eq!(
            (count(&dir), fs::read(&target).unwrap()),
            (1, b"old".to_vec())
        );
        let output = Output::create(&target).unwrap();
        output.write(b"new").unwrap();
        output.commit().unwrap();
        assert_eq!(
            (count(&dir), fs::read(&target).unwrap()),
            (1, b"new".to_vec())
        );
        fs::remove_dir_all(dir).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let dir = folder("links");
        let (file, link) = (dir.join("file"), dir.join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        finish(Some(Output::create(&link).unwrap()), b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        finish(Some(Output::create(Path::new("/dev/null")).unwrap()), b"x").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        fs::remove_dir_all(dir).unwrap();
    }
}

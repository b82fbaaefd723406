//! Where a drawing comes from: a file, standard input, or one line of a data set.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use faceformer::drawing::{CleanDrawing, Limits, Report, dataset, diagnose, read};

use crate::failure::Failure;

/// Largest text that is read, in bytes. Drawings within [`Limits`] are far below it.
const TEXT_LIMIT: u64 = 1 << 30;

/// Reads the drawing that `DRAWING` on the command line names.
///
/// # Errors
/// [`Failure::Read`] if there is no such file, [`Failure::Drawing`] if it is no drawing,
/// [`Failure::Usage`] if it is a data set.
pub(crate) fn load(name: &str) -> Result<CleanDrawing, Failure> {
    let fail = |source| Failure::Drawing {
        name: shown(name).to_owned(),
        source,
    };
    if let Some((path, id)) = split_data_set(name) {
        let drawing = dataset::find(path, id).map_err(fail)?;
        return Ok(CleanDrawing {
            sources: (0..drawing.edges.len()).map(|e| vec![e]).collect(),
            report: Report {
                findings: diagnose(&drawing),
                ..Report::default()
            },
            drawing,
        });
    }
    if is_data_set(name) {
        return Err(Failure::Usage(format!(
            "{name} is a data set: name one of its drawings, as in {name}#ID"
        )));
    }
    read(&text(name)?, &Limits::default()).map_err(fail)
}

/// What messages call an input.
pub(crate) fn shown(name: &str) -> &str {
    if name == "-" { "standard input" } else { name }
}

/// Reads a whole text file, or standard input for `-`.
///
/// # Errors
/// [`Failure::Read`] if it cannot be read, is too large, or is no UTF-8.
pub(crate) fn text(name: &str) -> Result<String, Failure> {
    let fail = |source| Failure::Read {
        path: PathBuf::from(shown(name)),
        source,
    };
    let read = |reader: &mut dyn Read| {
        let mut text = String::new();
        let count = reader.take(TEXT_LIMIT + 1).read_to_string(&mut text)?;
        if count as u64 > TEXT_LIMIT {
            return Err(io::Error::other("it is larger than 1 GiB"));
        }
        Ok(text)
    };
    if name == "-" {
        read(&mut io::stdin().lock()).map_err(fail)
    } else {
        read(&mut File::open(name).map_err(fail)?).map_err(fail)
    }
}

/// Splits `DATA.jsonl#ID` and `DATA.jsonl.zst#ID`; ids may hold further `#`.
fn split_data_set(name: &str) -> Option<(&Path, &str)> {
    name.match_indices('#').find_map(|(at, _)| {
        let (path, id) = (&name[..at], &name[at + 1..]);
        is_data_set(path).then(|| (Path::new(path), id))
    })
}

fn is_data_set(path: &str) -> bool {
    path.ends_with(".jsonl") || path.ends_with(".jsonl.zst")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_sets_are_told_from_files() {
        let split = |name| split_data_set(name).map(|(path, id)| (path.to_str().unwrap(), id));
        assert_eq!(split("a/b.jsonl#x/1#o0"), Some(("a/b.jsonl", "x/1#o0")));
        assert_eq!(split("p#1/b.jsonl.zst#7"), Some(("p#1/b.jsonl.zst", "7")));
        assert_eq!(split("drawing#1.json"), None);
        assert_eq!(split("-"), None);
    }
}

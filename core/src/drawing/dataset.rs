//! Data sets: one drawing a line, `.jsonl` or Zstandard-compressed `.jsonl.zst`.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use super::{Drawing, DrawingError};

/// Longest line that is read, in bytes; a drawing at its limits is well below.
const LONGEST_LINE: u64 = 256 << 20;

/// The drawings of a data set, read one at a time.
///
/// Blank lines are skipped. A line that is no drawing is an `Err` that names it; reading goes on
/// after it. An error of the file itself ends the iteration.
pub struct Drawings {
    path: String,
    reader: Box<dyn BufRead + Send>,
    line: usize,
    ended: bool,
}

impl Drawings {
    /// Opens a data set. Compression is recognised by content, not by name.
    ///
    /// # Errors
    /// [`DrawingError::File`] if the file cannot be opened or read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, DrawingError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let open = || -> io::Result<Box<dyn BufRead + Send>> {
            let mut file = BufReader::new(File::open(path)?);
            Ok(if is_zstd(file.fill_buf()?) {
                Box::new(BufReader::new(Frames::new(file)))
            } else {
                Box::new(file)
            })
        };
        match open() {
            Ok(reader) => Ok(Self::new(name, reader)),
            Err(e) => Err(DrawingError::File {
                path: name,
                what: e.to_string(),
            }),
        }
    }

    fn new(path: String, reader: Box<dyn BufRead + Send>) -> Self {
        Self {
            path,
            reader,
            line: 0,
            ended: false,
        }
    }

    /// Number of the line read last, from 1; 0 before the first.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The next line that is not blank.
    fn next_line(&mut self) -> Option<Result<String, DrawingError>> {
        while !self.ended {
            let mut bytes = Vec::new();
            let read = (&mut self.reader)
                .take(LONGEST_LINE + 1)
                .read_until(b'\n', &mut bytes);
            self.line += 1;
            match read {
                Ok(0) => self.ended = true,
                Ok(n) if n as u64 > LONGEST_LINE => {
                    self.ended = true;
                    return Some(Err(self.at_line(DrawingError::TooLarge {
                        what: "bytes",
                        found: n,
                        limit: LONGEST_LINE as usize,
                    })));
                }
                Ok(_) if bytes.trim_ascii().is_empty() => {}
                Ok(_) => {
                    return Some(String::from_utf8(bytes).map_err(|_| {
                        self.at_line(DrawingError::Format("it is not UTF-8 text".into()))
                    }));
                }
                Err(e) => {
                    self.ended = true;
                    return Some(Err(DrawingError::File {
                        path: self.path.clone(),
                        what: format!("line {}: {e}", self.line),
                    }));
                }
            }
        }
        None
    }

    fn at_line(&self, error: DrawingError) -> DrawingError {
        DrawingError::Line {
            line: self.line,
            error: Box::new(error),
        }
    }
}

impl Iterator for Drawings {
    type Item = Result<Drawing, DrawingError>;

    fn next(&mut self) -> Option<Self::Item> {
        let line = self.next_line()?;
        Some(line.and_then(|text| Drawing::from_json(&text).map_err(|e| self.at_line(e))))
    }
}

/// Reads the drawing of the given id, without parsing the others.
///
/// # Errors
/// [`DrawingError::NoSuchDrawing`] if there is none, [`DrawingError::Line`] if its line is wrong,
/// [`DrawingError::File`] if the file cannot be read.
pub fn find(path: impl AsRef<Path>, id: &str) -> Result<Drawing, DrawingError> {
    let path = path.as_ref();
    let mut drawings = Drawings::open(path)?;
    while let Some(line) = drawings.next_line() {
        let text = line?;
        if !may_name(&text, id) {
            continue;
        }
        if let Ok(drawing) = Drawing::from_json(&text) {
            if drawing.id == id {
                return Ok(drawing);
            }
        } else if let Some(error) = named_but_wrong(&text, id) {
            return Err(drawings.at_line(error));
        }
    }
    Err(DrawingError::NoSuchDrawing {
        path: path.display().to_string(),
        id: id.to_owned(),
    })
}

/// Whether a line can hold the id: a quick look before parsing. Escapes can hide it, so a line
/// with a backslash always can.
fn may_name(text: &str, id: &str) -> bool {
    text.contains(id) || text.contains('\\')
}

/// The error of a line that does name the id but is no drawing.
fn named_but_wrong(text: &str, id: &str) -> Option<DrawingError> {
    #[derive(serde::Deserialize)]
    struct Name {
        id: String,
    }
    let name: Name = serde_json::from_str(text).ok()?;
    (name.id == id)
        .then(|| Drawing::from_json(text).err())
        .flatten()
}

fn is_zstd(start: &[u8]) -> bool {
    matches!(
        start,
        [0x28, 0xb5, 0x2f, 0xfd, ..] | [0x50..=0x5f, 0x2a, 0x4d, 0x18, ..]
    )
}

/// Zstandard frames one after the other, as parallel compressors write them; `ruzstd` reads one.
struct Frames<R> {
    source: R,
    decoder: FrameDecoder,
    inside: bool,
}

impl<R: BufRead> Frames<R> {
    fn new(source: R) -> Self {
        Self {
            source,
            decoder: FrameDecoder::new(),
            inside: false,
        }
    }

    /// Goes into the next frame, over skippable ones; `false` at the end of the file.
    fn enter(&mut self) -> io::Result<bool> {
        while !self.source.fill_buf()?.is_empty() {
            match self.decoder.init(&mut self.source) {
                Ok(()) => return Ok(true),
                Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame {
                    length,
                    ..
                })) => {
                    let mut frame = (&mut self.source).take(length.into());
                    io::copy(&mut frame, &mut io::sink())?;
                }
                Err(e) => return Err(io::Error::other(e.to_string())),
            }
        }
        Ok(false)
    }

    fn check_sum(&self) -> io::Result<()> {
        match self.decoder.get_checksum_from_data() {
            Some(sum) if self.decoder.get_calculated_checksum() != Some(sum) => {
                Err(io::Error::other("the file is damaged: a checksum is wrong"))
            }
            _ => Ok(()),
        }
    }
}

impl<R: BufRead> Read for Frames<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        loop {
            if !self.inside {
                self.inside = self.enter()?;
                if !self.inside {
                    return Ok(0);
                }
            }
            let n = self.decoder.read(buffer)?;
            if n > 0 {
                return Ok(n);
            }
            if self.decoder.is_finished() {
                self.check_sum()?;
                self.inside = false;
            } else {
                self.decoder
                    .decode_blocks(&mut self.source, BlockDecodingStrategy::UptoBlocks(1))
                    .map_err(|e| io::Error::other(e.to_string()))?;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str =
        r#"{"id":"a","vertices":[[0,0],[1,0]],"edges":[{"v":[0,1],"points":[[0,0],[1,0]]}]}"#;

    fn over(bytes: Vec<u8>) -> Drawings {
        let reader: Box<dyn BufRead + Send> = if is_zstd(&bytes) {
            Box::new(BufReader::new(Frames::new(io::Cursor::new(bytes))))
        } else {
            Box::new(io::Cursor::new(bytes))
        };
        Drawings::new("test".into(), reader)
    }

    fn frame(text: &str) -> Vec<u8> {
        ruzstd::encoding::compress_to_vec(
            text.as_bytes(),
            ruzstd::encoding::CompressionLevel::Fastest,
        )
    }

    #[test]
    fn corpus_is_read_whole_and_found_by_id() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../tests/corpus/sample.jsonl.zst"
        );
        let all: Vec<Drawing> = Drawings::open(path).unwrap().map(Result::unwrap).collect();
        assert_eq!(all.len(), 300);
        let last = &all[299];
        assert_eq!(&find(path, &last.id).unwrap(), last);
        assert!(matches!(
            find(path, "no such id"),
            Err(DrawingError::NoSuchDrawing { .. })
        ));
    }

    #[test]
    fn a_bad_line_is_named_and_passed_over() {
        let text = format!("{LINE}\n\n{{\"id\":3}}\n{LINE}");
        let results: Vec<_> = over(text.into_bytes()).collect();
        assert_eq!(results.len(), 3);
        assert!(results[0].is_ok() && results[2].is_ok());
        assert!(matches!(
            results[1],
            Err(DrawingError::Line { line: 3, .. })
        ));
    }

    #[test]
    fn frames_follow_each_other_and_skippable_ones_are_skipped() {
        let mut bytes = frame(&format!("{LINE}\n"));
        bytes.extend([0x50, 0x2a, 0x4d, 0x18, 3, 0, 0, 0, 1, 2, 3]);
        bytes.extend(frame(LINE));
        assert_eq!(over(bytes).map(Result::unwrap).count(), 2);
    }

    #[test]
    fn damaged_compression_is_an_error_and_ends_the_file() {
        let mut bytes = frame(&format!("{LINE}\n").repeat(50));
        let keep = bytes.len() / 2;
        bytes.truncate(keep);
        let results: Vec<_> = over(bytes).collect();
        assert!(matches!(
            results.last(),
            Some(Err(DrawingError::File { .. }))
        ));
    }
}

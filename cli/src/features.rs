//! `faceformer features`: tables for training the engines' models.

use std::io;
use std::path::Path;

use faceformer::drawing::Drawing;
use faceformer::drawing::dataset::Drawings;
use faceformer::identify::faceformer::shards::Shard as PointerShard;
use faceformer::identify::rotation::shards::{Augment, Shard};

use crate::args::{FeaturesArgs, Tables};
use crate::eval::Bar;
use crate::failure::Failure;
use crate::output::Output;

/// The tables of one kind of model.
enum Writer {
    Rotation(Box<Shard>),
    Pointer(Box<PointerShard>),
}

impl Writer {
    fn new(tables: Tables) -> Self {
        match tables {
            Tables::Rotation => Self::Rotation(Box::default()),
            Tables::Faceformer => Self::Pointer(Box::default()),
        }
    }

    fn add(&mut self, drawing: &Drawing) -> bool {
        match self {
            Self::Rotation(shard) => shard.add(drawing),
            Self::Pointer(shard) => shard.add(drawing),
        }
    }

    fn write(&self, path: &Path) -> io::Result<()> {
        match self {
            Self::Rotation(shard) => shard.write(path),
            Self::Pointer(shard) => shard.write(path),
        }
    }
}

/// Writes the tables of a data set; a drawing whose truth is not complete is left out, and how
/// many are is said.
///
/// # Errors
/// [`Failure`].
pub(crate) fn run(args: &FeaturesArgs) -> Result<(), Failure> {
    let output = Output::create(&args.output)?;
    let bad_input = |source| Failure::Drawing {
        name: args.data.display().to_string(),
        source,
    };
    let augment = Augment {
        mirror: args.mirror,
        rotate: args.rotate,
        renumber: args.renumber,
        reverse: args.reverse,
        noise: args.noise,
        seed: args.seed,
    };
    let mut shard = Writer::new(args.tables);
    let mut left_out = 0;
    let mut bar = Bar::new(args.limit);
    let drawings = Drawings::open(&args.data).map_err(bad_input)?;
    for (index, drawing) in drawings.take(args.limit.unwrap_or(usize::MAX)).enumerate() {
        let drawing = augment.apply(&drawing.map_err(bad_input)?, index as u64);
        left_out += usize::from(!shard.add(&drawing));
        bar.advance(index + 1);
    }
    bar.clear();
    shard
        .write(output.path()?)
        .map_err(|source| Failure::Write {
            path: args.output.clone(),
            source,
        })?;
    output.commit()?;
    if left_out > 0 {
        eprintln!("faceformer: note: {left_out} drawings without a complete truth are left out");
    }
    Ok(())
}

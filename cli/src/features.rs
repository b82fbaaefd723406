//! `faceformer features`: tables for training the rotation engine's model.

use faceformer::drawing::dataset::Drawings;
use faceformer::identify::rotation::shards::{Augment, Shard};

use crate::args::FeaturesArgs;
use crate::eval::Bar;
use crate::failure::Failure;
use crate::output::Output;

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
    let mut shard = Shard::default();
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

//! The command line: what can be typed. Scripts rely on the names here.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use faceformer::identify::EngineKind;
use faceformer::identify::faceformer::DecodeOptions;

use crate::render::Labels;

/// Turns 2D wireframe drawings of solids into CAD solids.
#[derive(Debug, Parser)]
#[command(name = "faceformer", version, propagate_version = true)]
#[command(after_help = "\
DRAWING is a JSON file, DATA.jsonl#ID or DATA.jsonl.zst#ID for one drawing of a data set, or - for \
standard input.

Exit status: 0 done, 1 the work failed, 2 bad input or usage.")]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Read and clean a drawing, and say what is wrong with it
    Check(CheckArgs),
    /// Find the faces of a drawing
    Identify(IdentifyArgs),
    /// Recover the depth of a drawing
    Lift(LiftArgs),
    /// Turn a drawing into a solid
    Solid(SolidArgs),
    /// Measure faces, depth and solids on drawings with known truth
    Eval(EvalArgs),
    /// Draw a picture of a drawing and its faces
    Render(RenderArgs),
    /// Write the tables that an engine's model is trained on
    Features(FeaturesArgs),
}

/// Where the faces come from.
#[derive(Debug, Args)]
pub(crate) struct FacesArgs {
    /// Engine that finds the faces [default: rotation] [rotation, varley, shortest, faceformer,
    /// seq2seq-coedge, seq2seq]
    #[arg(long, value_name = "E", conflicts_with = "faces")]
    pub(crate) engine: Option<EngineKind>,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Use these faces: "truth" for those in the drawing, or a file that `identify` wrote
    #[arg(long, value_name = "truth|FILE")]
    pub(crate) faces: Option<String>,
}

/// Which trained model the engine uses.
#[derive(Debug, Args)]
pub(crate) struct ModelArgs {
    /// Trained model (.safetensors, its .json beside it) for the engine; for rotation also "none",
    /// the hand-made scores [default: $FACEFORMER_MODEL, else rotation's own]
    #[arg(long, value_name = "FILE")]
    pub(crate) model: Option<String>,
    /// faceformer, seq2seq...: keep K sequences from each start; 1 is greedy, as in the paper
    #[arg(long, value_name = "K", default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=64))]
    pub(crate) beam: u16,
    /// faceformer, seq2seq-coedge: allow only co-edges that continue the walk
    #[arg(long)]
    pub(crate) walks_only: bool,
    /// faceformer, seq2seq...: decode without the causal mask, as the authors' program does
    #[arg(long)]
    pub(crate) non_causal: bool,
}

impl ModelArgs {
    /// How sequences are decoded.
    pub(crate) fn decoding(&self) -> DecodeOptions {
        DecodeOptions {
            causal: !self.non_causal,
            beam: self.beam.into(),
            walks_only: self.walks_only,
        }
    }
}

/// Which engine's model tables are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tables {
    /// The rotation engine.
    Rotation,
    /// The engines faceformer, seq2seq-coedge and seq2seq.
    Faceformer,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The drawing
    pub(crate) drawing: String,
    /// Print one JSON object: the cleaned drawing, the sources of its edges, the findings
    #[arg(long)]
    pub(crate) json: bool,
}

/// Arguments of `identify`.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// The drawing
    pub(crate) drawing: String,
    /// Engine that finds the faces [rotation, varley, shortest, faceformer, seq2seq-coedge, seq2seq]
    #[arg(long, value_name = "E", default_value_t)]
    pub(crate) engine: EngineKind,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// File for the faces (JSON); standard output without it
    #[arg(short, long, value_name = "FACES.json")]
    pub(crate) output: Option<PathBuf>,
}

/// Arguments of `lift`.
#[derive(Debug, Args)]
pub(crate) struct LiftArgs {
    /// The drawing
    pub(crate) drawing: String,
    #[command(flatten)]
    pub(crate) faces: FacesArgs,
    /// Take the solid that is the mirror image in depth
    #[arg(long)]
    pub(crate) flip: bool,
    /// File for the depths and surfaces (JSON); standard output without it
    #[arg(short, long, value_name = "LIFT.json")]
    pub(crate) output: Option<PathBuf>,
}

/// How the solid stands in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OrientationArg {
    /// The model's own axes along x, y and z.
    Upright,
    /// As seen in the drawing: x to the right, y up, z towards the viewer.
    Drawn,
}

/// Arguments of `solid`.
#[derive(Debug, Args)]
pub(crate) struct SolidArgs {
    /// The drawing
    pub(crate) drawing: String,
    #[command(flatten)]
    pub(crate) faces: FacesArgs,
    /// File for the solid: .step, .stp, .brep, .brp, .stl, or .json for the plan, lift and report
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Take the solid that is the mirror image in depth
    #[arg(long)]
    pub(crate) flip: bool,
    /// Model units for each drawing unit
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    pub(crate) scale: f64,
    /// How the solid stands in space
    #[arg(long, value_enum, default_value_t = OrientationArg::Upright)]
    pub(crate) orientation: OrientationArg,
    /// If the solid cannot be built, keep the faces that could be (BREP)
    #[arg(long, value_name = "FILE")]
    pub(crate) keep_partial: Option<PathBuf>,
}

/// Which drawings of a data set are measured, by their truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shapes {
    /// Every drawing.
    All,
    /// All faces are planes.
    Polyhedra,
    /// All faces are planes with one loop each.
    PolyhedraSingle,
    /// All faces are planes and cylinders.
    PlanesCylinders,
}

/// Arguments of `eval`.
#[derive(Debug, Args)]
pub(crate) struct EvalArgs {
    /// Data set: .jsonl or .jsonl.zst, every drawing with its truth
    pub(crate) data: PathBuf,
    #[command(flatten)]
    pub(crate) faces: FacesArgs,
    /// Also lift the drawings and build their solids
    #[arg(long)]
    pub(crate) solids: bool,
    /// Measure the first N drawings only
    #[arg(long, value_name = "N")]
    pub(crate) limit: Option<usize>,
    /// Which drawings to measure
    #[arg(long, value_enum, default_value_t = Shapes::All)]
    pub(crate) shapes: Shapes,
    /// Make K faces of each drawing wrong on purpose, lift, and look whether they are named
    #[arg(long, value_name = "K", requires = "solids", conflicts_with = "noise")]
    pub(crate) corrupt: Option<usize>,
    /// Shake the coordinates by normal noise of P percent of the drawing's size before its faces are
    /// found
    #[arg(long, value_name = "P")]
    pub(crate) noise: Option<f64>,
    /// Let the ends of edges miss each other by up to P percent of the drawing's size, and find the
    /// faces of what clean-up makes of these edges; after --noise if both are given
    #[arg(long, value_name = "P", conflicts_with_all = ["corrupt", "solids"])]
    pub(crate) gap: Option<f64>,
    /// Seed of what is spoilt on purpose
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// File for what was refused or failed: JSON lines with id, stage and message
    #[arg(long, value_name = "FILE")]
    pub(crate) failures: Option<PathBuf>,
    /// File for the figures of every drawing: JSON lines
    #[arg(long, value_name = "FILE")]
    pub(crate) each: Option<PathBuf>,
}

/// Arguments of `features`. The options vary the drawings in ways that leave their faces.
#[derive(Debug, Args)]
pub(crate) struct FeaturesArgs {
    /// Data set: .jsonl or .jsonl.zst, every drawing with its truth
    pub(crate) data: PathBuf,
    /// File for the tables
    #[arg(short, long, value_name = "OUT.safetensors")]
    pub(crate) output: PathBuf,
    /// Engine whose model they are for
    #[arg(long = "for", value_enum, default_value_t = Tables::Rotation)]
    pub(crate) tables: Tables,
    /// Take the first N drawings only
    #[arg(long, value_name = "N")]
    pub(crate) limit: Option<usize>,
    /// Mirror every other drawing
    #[arg(long)]
    pub(crate) mirror: bool,
    /// Turn every drawing by an angle of its own
    #[arg(long)]
    pub(crate) rotate: bool,
    /// Number vertices and edges anew
    #[arg(long)]
    pub(crate) renumber: bool,
    /// Walk every other edge the other way
    #[arg(long)]
    pub(crate) reverse: bool,
    /// Largest error of coordinates, in half diagonals of the drawing; each drawing has its own
    #[arg(long, value_name = "R", default_value_t = 0.0)]
    pub(crate) noise: f64,
    /// Seed of these choices
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
}

/// Arguments of `render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The drawing; with --mistakes there may be several
    #[arg(required = true, value_name = "DRAWING")]
    pub(crate) drawings: Vec<String>,
    #[command(flatten)]
    pub(crate) faces: FacesArgs,
    /// File for the picture: .svg or .png
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// What to number
    #[arg(long, value_enum, default_value_t = Labels::Faces)]
    pub(crate) labels: Labels,
    /// Text above the picture; the drawing's id without it
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,
    /// Width of the picture in pixels [default: 960, with --solid 1440, with --mistakes 1280]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(160..=8192))]
    pub(crate) width: Option<u32>,
    /// Height of the picture in pixels; follows from the drawing without it
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(160..=8192))]
    pub(crate) height: Option<u32>,
    /// Compare with the truth: a small picture of each wrong loop, wrong type and missed face
    #[arg(long, conflicts_with_all = ["solid", "labels"])]
    pub(crate) mistakes: bool,
    /// Build the solid too, and show it from another side in a second panel
    #[arg(long)]
    pub(crate) solid: bool,
    /// With --solid: take the mirror image in depth
    #[arg(long, requires = "solid")]
    pub(crate) flip: bool,
}

//! Builds a [`Plan`](faceformer::plan::Plan) as an OpenCASCADE solid.
//!
//! One coarse call, [`build`], builds and checks a whole solid; [`reconstruct`] plans it first, and
//! gives up the surfaces that none can be built with. Vertices and edges are shared between faces from
//! the start; loose faces are never sewn. Planes, cylinders, cones,
//! spheres and tori, lines, circles and ellipses stay what they are; silhouettes are taken out
//! first, so that a hole is one cylinder face with a seam. A face on a surface of no known kind is
//! filled, and reported with its deviation. What comes out is valid, closed, of positive volume and
//! tight, or an [`OcctError`] that names the edge or face.
//!
//! # Why a bridge of its own
//! The crate `opencascade` 0.3 (over `opencascade-sys`) cannot make edges from shared vertices nor
//! trimmed faces on a given surface, has no shape check, and an OCCT exception in it ends the
//! process, which would take FreeCAD down with it. Here every call returns a `Result`: OCCT's
//! `Standard_Failure`, `std::exception` and anything else that is thrown become
//! [`OcctError::Kernel`]. What we do take from that project is its static OCCT, through the crate
//! `occt-sys` and the feature `bundled-occt`.
//!
//! # Invariants
//! - Shapes never leave this crate: BREP text does. So the OCCT in here and another one in the same
//!   process (FreeCAD's) never see each other's objects.
//! - Inside the kernel the model has a half diagonal of about 100 units, whatever the plan's scale.

mod body;
mod bridge;
mod encode;
mod error;
mod groups;
mod reconstruct;
mod report;
mod solid;

pub use error::OcctError;
pub use reconstruct::{Reconstruction, reconstruct};
pub use report::{FaceCounts, FilledFace, SolidReport};
pub use solid::{Format, Solid, build, occt_version};

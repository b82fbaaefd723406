//! What crosses between Rust and C++: plain data one way, an outcome the other way.
//!
//! No shape crosses: the C++ side builds, checks and writes in one call and gives BREP text.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use faceformer::{Progress, Stage};

// The lints look at what the macro makes of the declarations.
#[allow(unused_qualifications, unreachable_pub)]
#[cxx::bridge(namespace = "faceformer::occt")]
pub(crate) mod ffi {
    /// A point or vector.
    #[derive(Debug, Clone, Copy, PartialEq)]
    struct Point {
        x: f64,
        y: f64,
        z: f64,
    }

    /// Kind of an edge's curve.
    #[derive(Debug)]
    enum CurveKind {
        Line,
        /// Also the circle: ratio 1.
        Ellipse,
        /// Interpolated through points.
        Spline,
    }

    /// An edge from vertex `first` to vertex `last`, counted from 0.
    #[derive(Debug)]
    struct Edge {
        first: u32,
        last: u32,
        kind: CurveKind,
        /// Centre, unit normal and semi-major axis of an ellipse, walked counter-clockwise.
        center: Point,
        normal: Point,
        major: Point,
        /// Minor over major semi-axis.
        ratio: f64,
        /// Points of a spline, both ends included.
        points: Vec<Point>,
        /// Unit tangents at its ends; none if they are not known.
        tangents: Vec<Point>,
    }

    /// Kind of a face's surface.
    #[derive(Debug)]
    enum SurfaceType {
        Plane,
        Cylinder,
        Cone,
        Sphere,
        Torus,
        /// Laid through the edges.
        Filled,
    }

    /// A closed walk of co-edges: edge number from 1, negative if walked backwards.
    #[derive(Debug)]
    struct Loop {
        coedges: Vec<i32>,
    }

    /// A face: outer loop first, seen from outside the face is on the left. A seam is in one loop
    /// twice; a whole sphere or torus has no loop.
    #[derive(Debug)]
    struct Face {
        kind: SurfaceType,
        origin: Point,
        /// Outward unit normal of a plane, unit axis of a round surface.
        direction: Point,
        /// Radius of a cylinder or sphere, of a cone at its origin, of the spine of a torus.
        first: f64,
        /// Half angle of a cone, radius of the tube of a torus.
        second: f64,
        /// Whether the solid is outside the round surface.
        hollow: bool,
        loops: Vec<Loop>,
        /// Shell that the face is in, from 0.
        shell: u32,
        /// Face of the plan that it is, from 1, for messages.
        source: u32,
    }

    /// A whole B-rep, in units in which its half diagonal is about 100.
    #[derive(Debug)]
    struct Model {
        points: Vec<Point>,
        edges: Vec<Edge>,
        faces: Vec<Face>,
        shells: u32,
        /// Largest tolerance allowed.
        tolerance: f64,
        /// The same where faces are filled.
        filled_tolerance: f64,
        /// The finished solid is scaled by this.
        scale: f64,
    }

    /// What went wrong.
    #[derive(Debug)]
    enum Fault {
        None,
        Cancelled,
        /// An edge cannot be built, or is invalid.
        Edge,
        /// A face cannot be built, or is invalid.
        Face,
        /// The shell has a gap, overlaps itself or is inside out.
        Shell,
        /// A tolerance is too large.
        Tolerance,
    }

    /// Result of a build.
    #[derive(Debug)]
    struct Outcome {
        fault: Fault,
        /// Edge or face number from 1; 0 if the fault has no single place.
        number: u32,
        message: String,
        /// The solid, or what there is of its shell after a fault, as BREP text.
        brep: Vec<u8>,
        volume: f64,
        area: f64,
        /// Face counts: plane, cylinder, cone, sphere, torus, other.
        kinds: [u32; 6],
        edges: u32,
        vertices: u32,
        shells: u32,
        largest_tolerance: f64,
        lower: Point,
        upper: Point,
        /// Faces (number from 1) whose surface was laid through their edges.
        filled: Vec<u32>,
        /// Largest distance of each one's edges from it.
        deviations: Vec<f64>,
    }

    extern "Rust" {
        type Watcher<'a>;
        /// Reports the share done; `false` asks to stop.
        fn report(self: &Watcher<'_>, share: f64) -> bool;
    }

    unsafe extern "C++" {
        include!("faceformer-occt/cpp/bridge.h");

        fn build(model: &Model, watcher: &Watcher<'_>) -> Result<Outcome>;
        fn write_step(brep: &[u8], path: &str) -> Result<()>;
        fn write_stl(brep: &[u8], path: &str) -> Result<()>;
        /// Corners of triangles within `deflection` of the solid's faces, nine numbers a triangle.
        fn triangles(brep: &[u8], deflection: f64) -> Result<Vec<f64>>;
        fn version() -> Result<String>;
    }
}

/// The caller's [`Progress`] as the C++ side sees it.
pub(crate) struct Watcher<'a> {
    progress: Progress<'a>,
    panic: RefCell<Option<Box<dyn Any + Send>>>,
}

impl<'a> Watcher<'a> {
    pub(crate) fn new(progress: Progress<'a>) -> Self {
        Self {
            progress,
            panic: RefCell::new(None),
        }
    }

    /// A panic in the callback may not unwind through C++: it is kept and stops the build.
    fn report(&self, share: f64) -> bool {
        match catch_unwind(AssertUnwindSafe(|| {
            self.progress.report(Stage::Build, share)
        })) {
            Ok(answer) => answer.is_ok(),
            Err(panic) => {
                *self.panic.borrow_mut() = Some(panic);
                false
            }
        }
    }

    /// Goes on with a panic of the callback, now that no C++ is on the stack.
    pub(crate) fn resume(self) {
        if let Some(panic) = self.panic.into_inner() {
            std::panic::resume_unwind(panic);
        }
    }
}

//! Lifting loops before they are grouped into faces: parts of the drawing that share no vertex each
//! keep a depth of their own.

use std::borrow::Cow;

use glam::{DVec2, DVec3};

use super::camera::Relation;
use super::circle::DrawnCircle;
use super::directions::Directions;
use super::sheet::Sheet;
use super::solve::{self, Solved};
use super::straight::{Straight, ends, straightened};
use super::{Camera, LiftError};
use crate::drawing::{Curve2, Drawing, Edge, SurfaceKind};
use crate::identify::Face;

/// Sine of the angle below which neighbouring planes are one.
const BENT: f64 = 0.02;

/// Share of a normal towards the viewer below which a plane is seen from its edge.
const EDGE_ON: f64 = 0.01;

/// A drawing with all readings of its directions; one by hand is made straight by each.
pub(crate) struct Readings<'a> {
    drawing: &'a Drawing,
    /// Of an exact drawing.
    exact: Vec<Directions>,
    /// Of one by hand.
    straight: Vec<Straight>,
}

impl<'a> Readings<'a> {
    /// The readings of a drawing, none if nothing tells directions.
    pub(crate) fn new(drawing: &'a Drawing) -> Self {
        let straight = straightened(drawing);
        let exact = if straight.is_empty() {
            Directions::candidates(drawing).unwrap_or_default()
        } else {
            Vec::new()
        };
        Self {
            drawing,
            exact,
            straight,
        }
    }

    /// The drawing made straight by the likeliest reading, if it is by hand.
    pub(crate) fn straight(&self) -> Option<&Drawing> {
        self.straight.first().map(|s| &s.drawing)
    }

    /// The likeliest directions of the drawing or, if it is by hand, of what it is made straight to.
    pub(crate) fn directions(&self) -> Option<Cow<'_, Directions>> {
        match self.straight() {
            Some(drawing) => Directions::estimate(drawing).ok().map(Cow::Owned),
            None => self.exact.first().map(Cow::Borrowed),
        }
    }
}

/// A lifted drawing whose parts may still move in depth against each other.
pub(crate) struct Pieces {
    solved: Solved,
    /// Mean of each face's vertices, the origin of its plane.
    middles: Vec<DVec2>,
    /// Axes in the camera frame, as in [`Directions::axes`].
    pub(crate) axes: Vec<DVec3>,
    circles: Vec<Option<(usize, DrawnCircle)>>,
    pub(crate) camera: Camera,
    /// Standard error of the drawing's coordinates, drawing units.
    pub(crate) precision: f64,
}

/// A plane of the heights `h = -(a x + b y + c)`; see [`Camera`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tilt {
    /// Slope along x, negative.
    pub(crate) a: f64,
    /// Slope along y, negative.
    pub(crate) b: f64,
    /// Height of the origin, negative.
    pub(crate) c: f64,
    pub(crate) camera: Camera,
}

impl Tilt {
    /// The plane with the normal `n` through the point of a height that is drawn at `at`, unless it
    /// is seen from its edge.
    pub(crate) fn across(camera: Camera, n: DVec3, at: DVec2, height: f64) -> Option<Self> {
        let over = |p: DVec2| {
            let Relation { to, from, rise } = camera.across(n, at, p);
            (from * height + rise) / to
        };
        let [x, y] = [DVec2::X, DVec2::Y].map(|d| over(at + d) - height);
        (camera.facing(n, at).abs() > EDGE_ON).then(|| Self {
            a: -x,
            b: -y,
            c: x * at.x + y * at.y - height,
            camera,
        })
    }

    /// [Level](Camera::level) of a drawn point.
    pub(crate) fn level(&self, p: DVec2) -> f64 {
        self.camera.level(self.height(p))
    }

    fn height(&self, p: DVec2) -> f64 {
        -(self.a * p.x + self.b * p.y + self.c)
    }

    /// The point of the plane that is drawn at `p`.
    pub(crate) fn place(&self, p: DVec2) -> DVec3 {
        self.camera.place(p, self.camera.depth(self.height(p)))
    }

    /// Unit normal; of which side is left open.
    pub(crate) fn normal(&self) -> DVec3 {
        let normal = self.camera.normal([self.a, self.b, self.c], DVec2::ZERO);
        normal.normalize_or_zero()
    }
}

impl Pieces {
    /// Lifts a drawing with the given faces, of all readings of its directions by the one that
    /// contradicts the faces least; returns it with the drawing that it lifts.
    ///
    /// # Errors
    /// As [`lift`](super::lift()), but depths may stay open.
    pub(crate) fn new<'a>(
        readings: &'a Readings<'_>,
        faces: &[Face],
    ) -> Result<(Cow<'a, Drawing>, Self), LiftError> {
        let mut best: Option<(usize, Cow<'a, Drawing>, Self)> = None;
        let mut refusal = None;
        let exact = readings.exact.iter();
        let exact = exact.map(|directions| Self::exact(readings.drawing, directions, faces));
        let straight = readings.straight.iter();
        let by_hand = straight.map(|s| Self::by_hand(readings.drawing, s, faces));
        for found in exact.chain(by_hand) {
            match found {
                Ok(own) if best.as_ref().is_none_or(|b| 2 * own.0 < b.0) => best = Some(own),
                Ok(_) => {}
                Err(error) => refusal = Some(error),
            }
            if best.as_ref().is_some_and(|b| b.0 == 0) {
                break;
            }
        }
        match (best, refusal) {
            (Some((_, drawing, pieces)), _) => Ok((drawing, pieces)),
            (None, Some(error)) => Err(error),
            (None, None) => Err(LiftError::NoDirections("no reading".into())),
        }
    }

    /// Lifts an exact drawing by one reading; also how many arcs, rows, flat edges and open planes speak
    /// against it.
    fn exact<'a>(
        drawing: &'a Drawing,
        directions: &Directions,
        faces: &[Face],
    ) -> Result<(usize, Cow<'a, Drawing>, Self), LiftError> {
        let sheet = Sheet::new(drawing, faces, directions);
        let solved = solve::solve_parts(&sheet)?;
        let contradicted = solved.dropped() + oblique(&sheet);
        let wrong = contradicted + flat(&sheet, &solved) + open(&sheet, &solved);
        Ok((wrong, Cow::Borrowed(drawing), Self::of(&sheet, solved)))
    }

    /// Lifts a drawing by hand by one reading; also how many edges and rows contradict it.
    fn by_hand<'a>(
        drawn: &Drawing,
        straight: &'a Straight,
        faces: &[Face],
    ) -> Result<(usize, Cow<'a, Drawing>, Self), LiftError> {
        let directions = &straight.directions;
        let ends = ends::ends(&Sheet::new(&straight.drawing, faces, directions));
        let trusted = ends.directions;
        let anew = trusted.and_then(|trusted| straight.anew(drawn, trusted));
        let own = anew.as_ref().unwrap_or(straight);
        let mut sheet = Sheet::new(&own.drawing, faces, &own.directions);
        sheet.set_parallels(own.parallels());
        sheet.ends = ends.faces;
        let solved = solve::solve_parts(&sheet)?;
        let wrong = solved.dropped() + flat(&sheet, &solved);
        let pieces = Self::of(&sheet, solved);
        let drawing = match anew {
            Some(anew) => Cow::Owned(anew.drawing),
            None => Cow::Borrowed(&straight.drawing),
        };
        Ok((wrong, drawing, pieces))
    }

    fn of(sheet: &Sheet<'_>, solved: Solved) -> Self {
        let axes: Vec<DVec3> = sheet.directions.axes.iter().map(|a| a.direction).collect();
        // Not those around normals beside the axes, which are assumed.
        let around = |c: &Option<_>| c.filter(|(k, _): &(usize, DrawnCircle)| *k < axes.len());
        let circles = sheet.circles.iter().map(around).collect();
        Self {
            solved,
            middles: sheet.middles.clone(),
            axes,
            circles,
            camera: *sheet.camera(),
            precision: sheet.directions.precision,
        }
    }

    /// The axis that an arc is a circle around, with the circle.
    pub(crate) fn circle(&self, edge: usize) -> Option<(usize, DrawnCircle)> {
        self.circles[edge]
    }

    /// Height of a vertex.
    pub(crate) fn height(&self, vertex: usize) -> f64 {
        self.solved.height(vertex)
    }

    /// Plane of a planar face, if its slope is determined.
    pub(crate) fn plane(&self, face: usize) -> Option<Tilt> {
        let [a, b, c] = self.solved.plane(face)?;
        let middle = self.middles[face];
        Some(Tilt {
            a,
            b,
            c: c - a * middle.x - b * middle.y,
            camera: self.camera,
        })
    }
}

/// Number of arcs that are no circles around an axis of the reading: a frame that straight edges tell
/// by chance explains no circles.
fn oblique(sheet: &Sheet<'_>) -> usize {
    let edges = sheet.drawing.edges.iter().zip(&sheet.circles);
    let is_oblique = |(edge, circle): &(&Edge, &Option<_>)| {
        matches!(edge.curve, Curve2::Ellipse(_)) && circle.is_none()
    };
    edges.filter(is_oblique).count()
}

/// Number of planes whose slope stays open: what is not lifted contradicts nothing.
fn open(sheet: &Sheet<'_>, solved: &Solved) -> usize {
    let faces = sheet.faces.iter().enumerate();
    let is_open =
        |(f, face): &(usize, &Face)| face.kind == SurfaceKind::Plane && solved.plane(*f).is_none();
    faces.filter(is_open).count()
}

/// Number of edges between planes that are one: what is read wrongly is often flat.
fn flat(sheet: &Sheet<'_>, solved: &Solved) -> usize {
    let normal = |f: usize| {
        let [a, b, c] = solved.plane(f)?;
        let normal = sheet.camera().normal([a, b, c], sheet.middles[f]);
        normal.try_normalize()
    };
    let edges = 0..sheet.drawing.edges.len();
    let is_flat = |e: &usize| match *sheet.neighbours(*e) {
        [f, g] => match [f, g].map(normal) {
            [Some(a), Some(b)] => a.cross(b).length() < BENT,
            _ => false,
        },
        _ => false,
    };
    edges.filter(is_flat).count()
}

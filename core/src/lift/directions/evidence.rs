//! What a drawing shows of directions: straight edges in parallel clusters, and circles.

use glam::{DMat2, DVec2, DVec3};

use crate::drawing::{Curve2, Drawing, EllipseArc};

/// Standard errors within which a measurement agrees with a prediction.
pub(crate) const AGREE: f64 = 4.0;

/// Arcs that are too short have axes less certain than this and are left out.
const UNCERTAIN: f64 = 0.01;

/// Circles seen from straight above, or outlines of spheres: their axis is the view's.
const FACE_ON: f64 = 1.0 - 1e-4;

/// A straight edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment {
    pub(crate) edge: usize,
    /// Unit direction, of no meaning of its sign.
    pub(crate) direction: DVec2,
    pub(crate) length: f64,
}

/// Straight edges that are parallel within the drawing's precision.
#[derive(Debug, Clone)]
pub(crate) struct Cluster {
    /// Unit direction: the mean of the members, weighted by the square of their lengths.
    pub(crate) direction: DVec2,
    /// Indices into the list of segments.
    pub(crate) members: Vec<usize>,
    /// Sum of the members' lengths.
    pub(crate) length: f64,
    /// Root of the sum of squared lengths: end-point errors over this give the angle's error.
    pub(crate) lever: f64,
}

/// Arcs of circles in parallel planes.
#[derive(Debug, Clone)]
pub(crate) struct CircleGroup {
    /// Edges that show it.
    pub(crate) edges: Vec<usize>,
    /// Shape of a unit circle's image, `I - n_xy n_xy^T` for a circle of unit normal n.
    pub(crate) shape: DMat2,
    /// Standard error of the entries of `shape`.
    pub(crate) error: f64,
}

/// The evidence at one precision.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// Standard error of a coordinate, drawing units.
    pub(crate) precision: f64,
    /// Half diagonal of the drawing.
    pub(crate) size: f64,
    pub(crate) segments: Vec<Segment>,
    /// Clusters, the one with the largest total length first.
    pub(crate) clusters: Vec<Cluster>,
    /// Circles, the ones with most edges first.
    pub(crate) circles: Vec<CircleGroup>,
}

impl Evidence {
    pub(crate) fn new(drawing: &Drawing, precision: f64) -> Self {
        let segments = segments(drawing, precision);
        let clusters = cluster(&segments, precision);
        Self {
            precision,
            size: drawing.size(),
            clusters,
            segments,
            circles: circles(drawing, precision),
        }
    }
}

impl Cluster {
    /// Standard error of the direction, radians.
    pub(crate) fn error(&self, precision: f64) -> f64 {
        std::f64::consts::SQRT_2 * precision / self.lever
    }
}

impl CircleGroup {
    /// The normal with positive z; the other one that fits is its reversal in depth.
    pub(crate) fn normal(&self) -> DVec3 {
        // I - shape = n_xy n_xy^T has rank one: its larger column is along n_xy.
        let m = DMat2::IDENTITY - self.shape;
        let column = if m.x_axis.x > m.y_axis.y {
            m.x_axis
        } else {
            m.y_axis
        };
        let squared = (m.x_axis.x + m.y_axis.y).clamp(0.0, 1.0);
        let xy = column.normalize_or_zero() * squared.sqrt();
        xy.extend((1.0 - squared).sqrt())
    }

    /// Whether circles of the unit normal `n` look like this, `n` known to `error` radians.
    pub(crate) fn agrees(&self, n: DVec3, error: f64) -> bool {
        shape_distance(self.shape, n) < AGREE * (self.error + error)
    }
}

/// Largest difference of the entries of a shape from that of a circle with unit normal `n`.
pub(crate) fn shape_distance(shape: DMat2, n: DVec3) -> f64 {
    let d = shape - circle_shape(n);
    let largest = d.x_axis.abs().max(d.y_axis.abs());
    largest.max_element()
}

/// Image of a unit circle with unit normal `n`: `M M^T` for the 2x2 matrix M that maps the unit
/// circle to its drawing.
pub(crate) fn circle_shape(n: DVec3) -> DMat2 {
    let xy = n.truncate();
    DMat2::IDENTITY - DMat2::from_cols(xy * xy.x, xy * xy.y)
}

fn segments(drawing: &Drawing, precision: f64) -> Vec<Segment> {
    let mut all: Vec<Segment> = drawing
        .edges
        .iter()
        .enumerate()
        .filter(|(_, e)| e.is_straight())
        .filter_map(|(edge, e)| {
            let d = drawing.vertices.get(e.v[1])? - drawing.vertices.get(e.v[0])?;
            let length = d.length();
            // Below this an edge's direction is mostly error.
            (length > 50.0 * precision).then(|| Segment {
                edge,
                direction: d / length,
                length,
            })
        })
        .collect();
    all.sort_by(|a, b| b.length.total_cmp(&a.length));
    all
}

fn cluster(segments: &[Segment], precision: f64) -> Vec<Cluster> {
    let mut clusters: Vec<Cluster> = Vec::new();
    let error = std::f64::consts::SQRT_2 * precision;
    for (index, s) in segments.iter().enumerate() {
        let offset = |c: &Cluster| {
            (s.direction.perp_dot(c.direction) * s.length).abs()
                / (error * (1.0 + (s.length / c.lever).powi(2)).sqrt())
        };
        let nearest = clusters
            .iter_mut()
            .map(|c| (offset(c), c))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest {
            Some((distance, c)) if distance < AGREE => {
                let signed = s.direction * s.direction.dot(c.direction).signum();
                let (old, new) = (c.lever * c.lever, s.length * s.length);
                c.direction = (c.direction * old + signed * new).normalize();
                c.lever = (old + new).sqrt();
                c.length += s.length;
                c.members.push(index);
            }
            _ => clusters.push(Cluster {
                direction: s.direction,
                members: vec![index],
                length: s.length,
                lever: s.length,
            }),
        }
    }
    clusters.sort_by(|a, b| b.length.total_cmp(&a.length));
    clusters
}

/// Standard error of the entries of an arc's shape matrix: that of its axes, and not below what the
/// drawing's precision leaves.
fn shape_error(arc: &EllipseArc, precision: f64) -> f64 {
    2.0 * arc.uncertainty + 2.0 * precision / arc.major.length()
}

fn circles(drawing: &Drawing, precision: f64) -> Vec<CircleGroup> {
    let mut arcs: Vec<CircleGroup> = drawing
        .edges
        .iter()
        .enumerate()
        .filter_map(|(edge, e)| match e.curve {
            Curve2::Ellipse(arc)
                if arc.uncertainty < UNCERTAIN
                    && arc.residual < AGREE * precision
                    && arc.ratio < FACE_ON
                    && arc.ratio * arc.major.length() > 20.0 * precision =>
            {
                let (major, minor) = (arc.major, arc.minor());
                let outer = |v: DVec2| DMat2::from_cols(v * v.x, v * v.y);
                Some(CircleGroup {
                    edges: vec![edge],
                    shape: (outer(major) + outer(minor)) * major.length_squared().recip(),
                    error: shape_error(&arc, precision),
                })
            }
            _ => None,
        })
        .collect();
    arcs.sort_by(|a, b| a.error.total_cmp(&b.error));
    let mut groups: Vec<CircleGroup> = Vec::new();
    for arc in arcs {
        let normal = arc.normal();
        match groups.iter_mut().find(|g| g.agrees(normal, arc.error)) {
            Some(group) => group.edges.extend(arc.edges),
            None => groups.push(arc),
        }
    }
    groups.sort_by_key(|g| std::cmp::Reverse(g.edges.len()));
    groups
}

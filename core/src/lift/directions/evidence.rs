//! What a drawing shows of directions: straight edges in parallel clusters, and circles.

use glam::{DVec2, DVec3};

use super::DrawnNormals;
use crate::drawing::{Curve2, Drawing, EllipseArc};

/// Standard errors within which a measurement agrees with a prediction.
pub(crate) const AGREE: f64 = 4.0;

/// Arcs that are too short have axes less certain than this and are left out; in a coarse drawing,
/// than so many times its precision, as a share of its size.
const UNCERTAIN: f64 = 0.01;
const UNCERTAIN_BY_HAND: f64 = 20.0;
const MOST_UNCERTAIN: f64 = 0.1;

/// Errors, radians, up to which it is no chance that an edge is drawn along a normal.
const SHARP: f64 = 1e-3;

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
    /// Indices of groups of circles from which all members start along the normal, as it is drawn:
    /// outlines of their cylinders.
    pub(super) of_circles: Vec<usize>,
}

/// Arcs of circles in parallel planes, or in the mirror images of such planes.
#[derive(Debug, Clone)]
pub(crate) struct CircleGroup {
    /// Edges that show it.
    pub(crate) edges: Vec<usize>,
    /// Unit normal with positive z; the other one that fits is its reversal in depth.
    pub(crate) normal: DVec3,
    /// Standard error of the normal, radians.
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
    /// What the edges at each vertex show.
    pub(super) corners: Vec<Vec<Shown>>,
}

impl Evidence {
    pub(crate) fn new(drawing: &Drawing, precision: f64) -> Self {
        let segments = segments(drawing, precision);
        let clusters = cluster(&segments, precision);
        let mut evidence = Self {
            precision,
            size: drawing.size(),
            clusters,
            segments,
            circles: circles(drawing, precision),
            corners: vec![Vec::new(); drawing.vertices.len()],
        };
        let of_circles: Vec<Vec<usize>> = evidence
            .clusters
            .iter()
            .map(|c| evidence.starts_of(c, drawing))
            .collect();
        for (cluster, groups) in evidence.clusters.iter_mut().zip(of_circles) {
            cluster.of_circles = groups;
        }
        for (e, shown) in evidence.shown(drawing.edges.len()).into_iter().enumerate() {
            for v in drawing.edges[e].v {
                evidence.corners[v].push(shown);
            }
        }
        evidence
    }
}

impl Evidence {
    /// Edges (from 0) of a cluster.
    pub(crate) fn edges_of(&self, cluster: &Cluster) -> impl Iterator<Item = usize> {
        let members = cluster.members.iter();
        members.filter_map(|&m| self.segments.get(m).map(|s| s.edge))
    }

    /// How much a cluster says: many edges more than few, long ones more than short ones, but less
    /// than by their length.
    pub(crate) fn salience(&self, cluster: &Cluster) -> f64 {
        let members = cluster.members.iter().filter_map(|&m| self.segments.get(m));
        members.map(|s| (s.length / self.size).sqrt()).sum()
    }

    /// Groups of circles from which all members of a cluster start along the normal.
    fn starts_of(&self, cluster: &Cluster, drawing: &Drawing) -> Vec<usize> {
        let starts = |group: &CircleGroup| {
            let drawn = group.normal.truncate();
            let error = cluster.error(self.precision) + group.error / drawn.length();
            let along = cluster.direction.perp_dot(drawn.normalize_or_zero()).abs();
            let ends = group.edges.iter().map(|&e| drawing.edges[e].v);
            error < SHARP
                && along < AGREE * error
                && self.edges_of(cluster).all(|e| {
                    let line = drawing.edges[e].v;
                    ends.clone().any(|v| line.iter().any(|u| v.contains(u)))
                })
        };
        let groups = self.circles.iter().enumerate();
        groups.filter(|(_, g)| starts(g)).map(|(i, _)| i).collect()
    }

    /// Cluster of each straight edge and group of each circle, by edge.
    fn shown(&self, edges: usize) -> Vec<Shown> {
        let mut shown = vec![Shown::Other; edges];
        for (i, c) in self.clusters.iter().enumerate() {
            self.edges_of(c).for_each(|e| shown[e] = Shown::Straight(i));
        }
        for (i, g) in self.circles.iter().enumerate() {
            g.edges.iter().for_each(|&e| shown[e] = Shown::Circle(i));
        }
        shown
    }
}

/// What an edge shows of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    /// A straight edge of a cluster.
    Straight(usize),
    /// A circle of a group.
    Circle(usize),
    /// Nothing.
    Other,
}

impl Cluster {
    /// Standard error of the direction, radians.
    pub(crate) fn error(&self, precision: f64) -> f64 {
        std::f64::consts::SQRT_2 * precision / self.lever
    }
}

impl CircleGroup {
    /// A circle's normal is drawn along the minor axis, and |n_z| is minor over major. An error of
    /// that ratio is one of the normal, times 1 / |n_xy|; one of the axes' direction too.
    fn new(edge: usize, arc: &EllipseArc, precision: f64) -> Self {
        let slant = (1.0 - arc.ratio * arc.ratio).sqrt();
        let xy = arc.major.perp().normalize() * slant;
        Self {
            edges: vec![edge],
            normal: xy.extend(arc.ratio),
            error: (arc.uncertainty + precision / arc.major.length()) / slant,
        }
    }

    /// A direction, its reverse, or the mirror image in depth of either: the one next to the
    /// group's normal, and by which signs.
    pub(crate) fn fold(&self, n: DVec3) -> (DVec3, DVec3) {
        let xy = n.truncate().dot(self.normal.truncate()).signum();
        let signs = DVec3::new(xy, xy, n.z.signum());
        (n * signs, signs)
    }

    /// Whether circles of the unit normal `n`, known to `error` radians, look like this.
    pub(crate) fn agrees(&self, n: DVec3, error: f64) -> bool {
        self.fold(n).0.distance(self.normal) < AGREE * (self.error + error).min(0.05)
    }

    /// Takes in further arcs of the same normal, by the weight of their errors.
    fn merge(&mut self, other: Self) {
        let (own, new) = (self.error.powi(-2), other.error.powi(-2));
        let mean = self.normal * own + self.fold(other.normal).0 * new;
        self.normal = mean.normalize_or(self.normal);
        self.error = (own + new).sqrt().recip();
        self.edges.extend(other.edges);
    }
}

fn segments(drawing: &Drawing, precision: f64) -> Vec<Segment> {
    // A drawing by hand has few edges that are longer than 50 errors.
    let shortest = (50.0 * precision).min(0.05 * drawing.size());
    let mut all: Vec<Segment> = drawing
        .edges
        .iter()
        .enumerate()
        .filter(|(_, e)| e.is_straight())
        .filter_map(|(edge, e)| {
            let d = drawing.vertices.get(e.v[1])? - drawing.vertices.get(e.v[0])?;
            let length = d.length();
            // Below this an edge's direction is mostly error.
            (length > shortest).then(|| Segment {
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
                of_circles: Vec::new(),
            }),
        }
    }
    clusters.sort_by(|a, b| b.length.total_cmp(&a.length));
    clusters
}

/// All arcs that may be circles and show it well enough.
fn arcs(drawing: &Drawing, precision: f64) -> impl Iterator<Item = (usize, EllipseArc)> {
    let by_hand = UNCERTAIN_BY_HAND * precision / drawing.size();
    let uncertain = by_hand.clamp(UNCERTAIN, MOST_UNCERTAIN);
    drawing
        .edges
        .iter()
        .enumerate()
        .filter_map(move |(edge, e)| match e.curve {
            Curve2::Ellipse(arc)
                if arc.uncertainty < uncertain
                    && arc.residual < AGREE * precision
                    && arc.ratio < FACE_ON
                    && arc.ratio * arc.major.length() > 20.0 * precision =>
            {
                Some((edge, arc))
            }
            _ => None,
        })
}

/// The normals of all circles of a parallel projection, two each.
pub(super) fn drawn_normals(drawing: &Drawing, precision: f64) -> Vec<DrawnNormals> {
    let normals = |(edge, arc): (usize, EllipseArc)| {
        let group = CircleGroup::new(edge, &arc, precision);
        DrawnNormals {
            edge,
            v: drawing.edges[edge].v,
            normals: [1.0, -1.0].map(|sign| group.normal * DVec3::new(1.0, 1.0, sign)),
            error: group.error,
            center: arc.center,
            reach: arc.major.length(),
        }
    };
    arcs(drawing, precision).map(normals).collect()
}

fn circles(drawing: &Drawing, precision: f64) -> Vec<CircleGroup> {
    let group = |(edge, arc): (usize, EllipseArc)| CircleGroup::new(edge, &arc, precision);
    let mut arcs: Vec<CircleGroup> = arcs(drawing, precision).map(group).collect();
    arcs.sort_by(|a, b| a.error.total_cmp(&b.error));
    let mut groups: Vec<CircleGroup> = Vec::new();
    for arc in arcs {
        match groups.iter_mut().find(|g| g.agrees(arc.normal, arc.error)) {
            Some(group) => group.merge(arc),
            None => groups.push(arc),
        }
    }
    groups.sort_by_key(|g| std::cmp::Reverse(g.edges.len()));
    groups
}

//! Ellipse through points: direct fit, statistical refinement, and how sure the result is.
//!
//! A conic `a x^2 + b xy + c y^2 + d x + e y + f = 0` is fitted in an affine frame in which the
//! points have unit spread both ways. Ellipses stay ellipses under affine maps, and a short shallow
//! arc, which is nearly a line, becomes well conditioned that way.
//!
//! 1. The direct least-squares fit of an ellipse, `4ac - b^2 > 0` (Halir & Flusser 1998,
//!    "Numerically stable direct least squares fitting of ellipses", after Fitzgibbon 1996). The
//!    linear coefficients are eliminated by QR instead of normal equations.
//! 2. Refinement to first-order geometric distances (Sampson 1982): rows weighted by the inverse
//!    gradient, without the constraint, as long as the result stays an ellipse. It takes away the
//!    direct fit's bias towards small ellipses.

mod linear;

use glam::{DMat2, DMat3, DVec2, DVec3};

/// An ellipse fitted to points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    pub(super) center: DVec2,
    /// Semi-major axis.
    pub(super) major: DVec2,
    /// Minor over major semi-axis.
    pub(super) ratio: f64,
    /// Largest first-order distance of a point.
    pub(super) residual: f64,
    /// Standard uncertainty, the larger of the major axis (relative) and the ratio; at most 1.
    pub(super) uncertainty: f64,
}

/// Fewest points of a fit: five fix an ellipse, and one more is needed to say how well it fits.
pub(super) const FEWEST: usize = 6;

/// Rounds of refinement. Each one squares the small error of the weights, so two would do for
/// points that lie on an ellipse.
const ROUNDS: usize = 2;

/// Axes beyond this many times the points' spread are no ellipse to speak of: a thousandth of a
/// radian of it would be seen.
const LARGEST: f64 = 2e3;

/// Fits an ellipse to at least [`FEWEST`] points that are not all on one line.
pub(super) fn fit(points: &[DVec2]) -> Option<Fit> {
    if points.len() < FEWEST {
        return None;
    }
    let frame = Frame::new(points)?;
    let local: Vec<DVec2> = points.iter().map(|&p| frame.local(p)).collect();
    let mut system = System::new(&local, None, &frame);
    let mut conic = system.ellipse()?;
    for _ in 0..ROUNDS {
        system = System::new(&local, Some(&conic), &frame);
        let free = system.conic(system.v.z_axis);
        conic = match free.shape(&frame) {
            Some(_) => free,
            None => system.ellipse()?,
        };
    }
    let shape = conic.shape(&frame)?;
    let distances = local.iter().map(|&q| conic.distance(q, &frame).abs());
    let (mut residual, mut sum) = (0f64, 0.0);
    for d in distances {
        residual = residual.max(d);
        sum += d * d;
    }
    let sigma = (sum / (points.len() - 5) as f64).sqrt();
    Some(Fit {
        center: frame.center + shape.center,
        major: shape.major,
        ratio: shape.ratio,
        residual,
        uncertainty: system.uncertainty(&conic, &shape, sigma.max(1e-15 * frame.spread.x), &frame),
    })
}

/// The affine frame in which the points have zero mean and unit spread in both directions.
struct Frame {
    center: DVec2,
    /// Directions of largest and smallest spread, columns.
    axes: DMat2,
    /// Root mean square spread along them.
    spread: DVec2,
}

impl Frame {
    fn new(points: &[DVec2]) -> Option<Self> {
        let n = points.len() as f64;
        let center = points.iter().sum::<DVec2>() / n;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for q in points.iter().map(|p| *p - center) {
            xx += q.x * q.x;
            xy += q.x * q.y;
            yy += q.y * q.y;
        }
        let e = DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
        let axes = DMat2::from_cols(e, e.perp());
        let along = |axis: DVec2| {
            let squares = points.iter().map(|p| (*p - center).dot(axis).powi(2));
            (squares.sum::<f64>() / n).sqrt()
        };
        let spread = DVec2::new(along(e), along(e.perp()));
        (spread.y > 1e-9 * spread.x && spread.is_finite()).then_some(Self {
            center,
            axes,
            spread,
        })
    }

    fn local(&self, p: DVec2) -> DVec2 {
        self.axes.transpose() * (p - self.center) / self.spread
    }
}

/// A conic in the local frame.
struct Conic {
    /// Coefficients of x^2, xy, y^2.
    quadratic: DVec3,
    /// Coefficients of x, y, 1.
    linear: DVec3,
}

/// An ellipse in drawing units, relative to the frame's centre.
struct Shape {
    center: DVec2,
    major: DVec2,
    ratio: f64,
}

impl Conic {
    fn value(&self, q: DVec2) -> f64 {
        self.quadratic
            .dot(DVec3::new(q.x * q.x, q.x * q.y, q.y * q.y))
            + self.linear.dot(q.extend(1.0))
    }

    /// Length of the gradient by drawing coordinates.
    fn slope(&self, q: DVec2, frame: &Frame) -> f64 {
        let DVec3 { x: a, y: b, z: c } = self.quadratic;
        let local =
            DVec2::new(2.0 * a * q.x + b * q.y, b * q.x + 2.0 * c * q.y) + self.linear.truncate();
        (local / frame.spread).length()
    }

    /// First-order distance of a point, in drawing units.
    fn distance(&self, q: DVec2, frame: &Frame) -> f64 {
        let slope = self.slope(q, frame);
        if slope > 0.0 {
            self.value(q) / slope
        } else {
            f64::INFINITY
        }
    }

    /// Centre and axes, if the conic is an ellipse of bounded size.
    fn shape(&self, frame: &Frame) -> Option<Shape> {
        let DVec3 { x: a, y: b, z: c } = self.quadratic;
        let matrix = DMat2::from_cols_array(&[a, b / 2.0, b / 2.0, c]);
        let det = a * c - b * b / 4.0;
        if det.is_nan() || det <= 0.0 {
            return None;
        }
        let inverse = matrix.inverse();
        let center = inverse * self.linear.truncate() * -0.5;
        let level = -(self.linear.z + self.linear.truncate().dot(center) / 2.0);
        // Points are center + w with w^T (matrix / level) w = 1; the inverse of that matrix maps
        // to drawing units by the frame, and its eigenvalues are the squared semi-axes.
        let back = frame.axes * DMat2::from_diagonal(frame.spread);
        let sigma = back * (inverse * level) * back.transpose();
        let (xx, xy, yy) = (sigma.x_axis.x, sigma.x_axis.y, sigma.y_axis.y);
        let largest = (xx + yy) / 2.0 + ((xx - yy) / 2.0).hypot(xy);
        let spread = frame.spread;
        let area2 = level * level / det * (spread.x * spread.y).powi(2);
        let ratio = area2.sqrt() / largest;
        let bounded = (LARGEST * spread.x).powi(2);
        if level.is_nan() || a * level <= 0.0 || !(largest > 0.0 && largest <= bounded) {
            return None;
        }
        Some(Shape {
            center: back * center,
            major: DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy)) * largest.sqrt(),
            ratio: ratio.min(1.0),
        })
        .filter(|s| s.ratio > 0.0 && s.center.is_finite())
    }
}

/// The least-squares problem of all conics, reduced to the quadratic coefficients.
struct System {
    upper: [[f64; 6]; 6],
    /// Singular values of the reduced problem, largest first.
    s: DVec3,
    /// Right singular vectors, columns.
    v: DMat3,
}

impl System {
    /// Rows weighted to distances from `near`, unweighted without it.
    fn new(points: &[DVec2], near: Option<&Conic>, frame: &Frame) -> Self {
        let row = |q: &DVec2| {
            let w = match near.map(|c| c.slope(*q, frame)) {
                Some(slope) if slope > 0.0 => slope.recip(),
                Some(_) => 0.0,
                None => 1.0,
            };
            [q.x, q.y, 1.0, q.x * q.x, q.x * q.y, q.y * q.y].map(|z| z * w)
        };
        let mut rows: Vec<[f64; 6]> = points.iter().map(row).collect();
        let upper = linear::triangle(&mut rows);
        let reduced = DMat3::from_cols_array_2d(&[3, 4, 5].map(|j| [3, 4, 5].map(|i| upper[i][j])));
        let (s, v) = linear::singular(reduced);
        Self { upper, s, v }
    }

    /// The conic with the given quadratic part whose linear part fits best.
    fn conic(&self, quadratic: DVec3) -> Conic {
        let r = &self.upper;
        let mut linear = [0.0; 3];
        for i in (0..3).rev() {
            let right: f64 = (0..3).map(|j| r[i][3 + j] * quadratic[j]).sum();
            let known: f64 = (i + 1..3).map(|j| r[i][j] * linear[j]).sum();
            linear[i] = -(right + known) / r[i][i];
        }
        Conic {
            quadratic,
            linear: linear.into(),
        }
    }

    /// The best ellipse: smallest residual with `4ac - b^2` fixed (Halir & Flusser).
    ///
    /// In coordinates y = S V^T x the residual is |y|^2, so the answer is the eigenvector of the
    /// constraint's one positive eigenvalue there.
    fn ellipse(&self) -> Option<Conic> {
        let floor = self.s.x * 1e-12;
        let scale = DMat3::from_diagonal(self.s.max(DVec3::splat(floor)).recip());
        let constraint = DMat3::from_cols(
            DVec3::new(0.0, 0.0, 2.0),
            DVec3::new(0.0, -1.0, 0.0),
            DVec3::new(2.0, 0.0, 0.0),
        );
        let map = self.v * scale;
        // Scaling the smallest singular value to 1 keeps the numbers in range.
        let top = linear::top_eigenvector(map.transpose() * constraint * map * floor.powi(2));
        (map * top).try_normalize().map(|x| self.conic(x))
    }

    /// Standard uncertainty of the larger of relative major axis and ratio, for points with an
    /// error of `sigma`: what moving the quadratic part by one standard deviation along each
    /// singular direction changes.
    fn uncertainty(&self, conic: &Conic, shape: &Shape, sigma: f64, frame: &Frame) -> f64 {
        let mut sum = 0.0;
        for (direction, s) in [(self.v.x_axis, self.s.x), (self.v.y_axis, self.s.y)] {
            let step = direction * (sigma / s);
            let change = [step, -step].map(|step| {
                let moved = self.conic(conic.quadratic + step);
                moved.shape(frame).map_or(f64::INFINITY, |m| {
                    let major = m.major.length() / shape.major.length() - 1.0;
                    major.abs().max((m.ratio - shape.ratio).abs())
                })
            });
            sum += change[0].max(change[1]).powi(2);
        }
        sum.sqrt().min(1.0)
    }
}

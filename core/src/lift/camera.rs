//! How a drawing was projected, and what that makes of depth.
//!
//! The unknown of a vertex is its *height* h: its depth z in a parallel projection, and `f^2 / -z`,
//! the inverse depth in units of the drawing, in a central one. In both, heights over a plane of
//! space are an affine function of the drawn point, and those along a line too, so all rows stay
//! linear. Central rows are homogeneous: the scale of a perspective drawing is free.
//!
//! With the focal length growing at unit scale, `f^2 / -z` tends to `f + z`, and every formula here
//! tends to its parallel twin. So errors and weights mean the same in both.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A projection with all that is needed to place drawn points in space.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Camera {
    /// (x, y, z) is drawn at (x, y).
    #[default]
    Parallel,
    /// (x, y, z) is drawn at `principal + f (x, y) / -z`; the camera is the origin.
    Central {
        /// Where the line of sight at right angles to the page is drawn.
        principal: DVec2,
        /// Focal length f, drawing units.
        focal: f64,
    },
}

/// A linear relation of the heights of two drawn points: `to v - from u = rise`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Relation {
    /// Factor of the second point's height.
    pub(crate) to: f64,
    /// Factor of the first point's height.
    pub(crate) from: f64,
    pub(crate) rise: f64,
}

impl Camera {
    /// Whether the projection is parallel.
    pub const fn is_parallel(&self) -> bool {
        matches!(self, Self::Parallel)
    }

    /// The point that is drawn at `p` and has the depth `z`.
    pub fn place(&self, p: DVec2, z: f64) -> DVec3 {
        match *self {
            Self::Parallel => p.extend(z),
            Self::Central { principal, focal } => ((p - principal) * (-z / focal)).extend(z),
        }
    }

    /// Where a point is drawn.
    pub fn project(&self, p: DVec3) -> DVec2 {
        match *self {
            Self::Parallel => p.truncate(),
            Self::Central { principal, focal } => principal + p.truncate() * (focal / -p.z),
        }
    }

    /// The line of all points drawn at `p`: a point and a direction, towards the viewer in a
    /// parallel projection, away from the viewer, and with the depth -f after a step of 1, else.
    pub fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        match *self {
            Self::Parallel => (p.extend(0.0), DVec3::Z),
            Self::Central { principal, focal } => (DVec3::ZERO, (p - principal).extend(-focal)),
        }
    }

    /// Depth z of a height.
    pub(crate) fn depth(&self, height: f64) -> f64 {
        match *self {
            Self::Parallel => height,
            Self::Central { focal, .. } => -focal * focal / height,
        }
    }

    /// The point that is drawn at `p` at the distance where lengths are drawn as they are.
    pub(crate) fn unit(&self, p: DVec2) -> DVec3 {
        match *self {
            Self::Parallel => p.extend(0.0),
            Self::Central { focal, .. } => self.place(p, -focal),
        }
    }

    /// The point that is drawn at `p` in the plane of normal `n` through `origin`.
    pub(crate) fn on_plane(&self, p: DVec2, n: DVec3, origin: DVec3) -> DVec3 {
        let (from, ray) = self.ray(p);
        from + ray * (n.dot(origin - from) / n.dot(ray))
    }

    /// The heights of two points of which one part of a drawing, moved along the lines of sight, has
    /// these.
    pub(crate) fn apart(&self, from: f64, to: f64) -> Relation {
        match self {
            Self::Parallel => Relation {
                to: 1.0,
                from: 1.0,
                rise: to - from,
            },
            Self::Central { .. } => Relation {
                to: 1.0,
                from: to / from,
                rise: 0.0,
            },
        }
    }

    /// Height of a depth z.
    pub(crate) fn height(&self, z: f64) -> f64 {
        match *self {
            Self::Parallel => z,
            Self::Central { focal, .. } => focal * focal / -z,
        }
    }

    /// Height on a scale on which a part of a drawing that moves along the lines of sight shifts:
    /// itself in a parallel projection, `f ln(h / f)` in a central one, where such a part grows.
    pub(crate) fn level(&self, height: f64) -> f64 {
        match *self {
            Self::Parallel => height,
            Self::Central { focal, .. } => focal * (height / focal).max(f64::MIN_POSITIVE).ln(),
        }
    }

    /// Difference of level between two points on a line along `l`, drawn at `u` and `v`.
    pub(crate) fn climb(&self, l: DVec3, u: DVec2, v: DVec2) -> f64 {
        let Relation { to, from, rise } = self.along(l, u, v);
        match *self {
            Self::Parallel => rise,
            Self::Central { focal, .. } => focal * (from / to).max(f64::MIN_POSITIVE).ln(),
        }
    }

    /// How a point drawn at `p` at the unit height moves in the drawing for a unit step along `l`;
    /// that height is f in a central projection, where it draws lengths as they are.
    pub(crate) fn drawn(&self, l: DVec3, p: DVec2) -> DVec2 {
        match *self {
            Self::Parallel => l.truncate(),
            Self::Central { principal, focal } => l.truncate() + (p - principal) * (l.z / focal),
        }
    }

    /// Cosine between the unit normal `n` and the ray through `p`, up to the ray's slant against
    /// the page's normal.
    pub(crate) fn facing(&self, n: DVec3, p: DVec2) -> f64 {
        match *self {
            Self::Parallel => n.z,
            Self::Central { principal, focal } => n.z - n.truncate().dot(p - principal) / focal,
        }
    }

    /// The heights of two points on a line along `l`, drawn at `u` and `v`.
    ///
    /// In a central projection they are as the distances from the line's vanishing point.
    pub(crate) fn along(&self, l: DVec3, u: DVec2, v: DVec2) -> Relation {
        let middle = self.drawn(l, u.midpoint(v));
        let length = middle.length();
        let e = middle / length;
        match self {
            Self::Parallel => Relation {
                to: 1.0,
                from: 1.0,
                rise: (v - u).dot(e) / length * l.z,
            },
            Self::Central { .. } => Relation {
                to: self.drawn(l, u).dot(e) / length,
                from: self.drawn(l, v).dot(e) / length,
                rise: 0.0,
            },
        }
    }

    /// The heights of two points in a plane with the normal `n`, drawn at `u` and `v`.
    pub(crate) fn across(&self, n: DVec3, u: DVec2, v: DVec2) -> Relation {
        match self {
            Self::Parallel => Relation {
                to: 1.0,
                from: 1.0,
                rise: -(v - u).dot(n.truncate()) / n.z,
            },
            Self::Central { .. } => {
                let middle = self.facing(n, u.midpoint(v));
                Relation {
                    to: self.facing(n, u) / middle,
                    from: self.facing(n, v) / middle,
                    rise: 0.0,
                }
            }
        }
    }

    /// Normal, not of unit length, of the plane `h + a (x - x0) + b (y - y0) + c = 0` of heights
    /// with (x0, y0) at `middle`.
    pub(crate) fn normal(&self, [a, b, c]: [f64; 3], middle: DVec2) -> DVec3 {
        match *self {
            Self::Parallel => DVec3::new(a, b, 1.0),
            Self::Central { principal, focal } => {
                let across = DVec2::new(a, b);
                across.extend((across.dot(middle - principal) - c) / focal)
            }
        }
    }

    /// The number 1 times a plane's distance: a right-hand side `r` of a row about a plane's slope
    /// is the term `r * constant` of its third unknown, on the left-hand side, in a central
    /// projection; `None` if it stays on the right.
    pub(crate) fn constant(&self) -> Option<f64> {
        match *self {
            Self::Parallel => None,
            Self::Central { focal, .. } => Some(focal.recip()),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn unit(v: [f64; 3]) -> DVec3 {
        DVec3::from_array(v).normalize_or(DVec3::Y)
    }

    proptest! {
        /// Relations and planes hold for points that are projected.
        #[test]
        fn relations_hold_for_projected_points(
            focal in 1.5..6.0f64, x in -0.3..0.3f64, y in -0.3..0.3f64, parallel: bool,
            a in prop::array::uniform3(-0.5..0.5f64), l in prop::array::uniform3(-1.0..1.0f64),
            m in prop::array::uniform3(-1.0..1.0f64), step in 0.1..0.8f64,
        ) {
            let camera = if parallel {
                Camera::Parallel
            } else {
                Camera::Central { principal: DVec2::new(x, y), focal }
            };
            let (l, a) = (unit(l), DVec3::from_array(a) - DVec3::Z * 4.0);
            let n = l.cross(unit(m)).normalize_or(l.any_orthonormal_vector());
            let b = a + l * step;
            let c = a + (n.cross(l) - 0.4 * l) * step;
            let [pa, pb, pc] = [a, b, c].map(|p| camera.project(p));
            let [ha, hb, hc] = [a, b, c].map(|p| camera.height(p.z));
            prop_assert!(camera.place(pa, camera.depth(ha)).distance(a) < 1e-12);
            prop_assume!(camera.drawn(l, pa.midpoint(pb)).length() > 0.05);
            prop_assume!(camera.facing(n, pa).abs() > 0.05 && camera.facing(n, pb).abs() > 0.05);
            let row = camera.along(l, pa, pb);
            prop_assert!((row.to * hb - row.from * ha - row.rise).abs() < 1e-9);
            let row = camera.across(n, pa, pc);
            let scale = row.to.abs() + row.from.abs();
            prop_assert!((row.to * hc - row.from * ha - row.rise).abs() < 1e-9 * scale);
            // The plane of heights through the three points has the normal n.
            let (u, v) = (pb - pa, pc - pa);
            let det = u.perp_dot(v);
            prop_assume!(det.abs() > 1e-3);
            let slope = DVec2::new(
                (hb - ha) * v.y - (hc - ha) * u.y,
                (hc - ha) * u.x - (hb - ha) * v.x,
            ) / -det;
            let found = camera.normal([slope.x, slope.y, -ha], pa).normalize();
            prop_assert!(found.cross(n).length() < 1e-6, "{found} {n}");
        }
    }
}

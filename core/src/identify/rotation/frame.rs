//! What dominant directions say about edges: which planes and cylinders they can lie on.

use crate::drawing::Drawing;
use crate::lift::directions::Directions;

/// Axis-aligned surfaces that an edge can lie on, as sets of axes (bit `k` for axis `k`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Fits {
    /// Normals of the planes.
    pub(super) planes: u8,
    /// Axes of the cylinders.
    pub(super) cylinders: u8,
    /// Whether the edge is straight.
    pub(super) straight: bool,
}

/// Axes of the model with the edges that follow them.
#[derive(Debug)]
pub(super) struct Frame {
    fits: Vec<Option<Fits>>,
}

/// How three edges go together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Agreement {
    /// An edge follows no axis.
    Unknown,
    /// A plane holds all three.
    Plane,
    /// A cylinder holds all three, and no plane does.
    Cylinder,
    /// Neither.
    None,
}

impl Frame {
    /// Assigns the edges of a drawing with these dominant directions, none without them.
    pub(super) fn new(drawing: &Drawing, directions: Option<&Directions>) -> Self {
        let mut fits = vec![None; drawing.edges.len()];
        if let Some(directions) = directions {
            let all: u8 = if directions.is_frame() { 0b111 } else { 0 };
            for (k, axis) in directions.axes.iter().enumerate() {
                let own = 1u8 << k;
                for &e in &axis.edges {
                    fits[e] = Some(Fits {
                        planes: all & !own,
                        cylinders: own,
                        straight: true,
                    });
                }
                for &e in &axis.circles {
                    fits[e] = Some(Fits {
                        planes: own,
                        cylinders: own,
                        straight: false,
                    });
                }
            }
        }
        Self { fits }
    }

    /// What an edge can lie on; `None` if it follows no axis.
    pub(super) fn fits(&self, edge: usize) -> Option<Fits> {
        self.fits[edge]
    }

    /// Whether edges that follow axes cannot be in one plane.
    pub(super) fn is_bent(&self, edges: impl Iterator<Item = usize>) -> bool {
        // Without a frame of three axes nothing is known of planes.
        let straight = edges
            .filter_map(|e| self.fits[e])
            .filter(|f| f.straight && f.planes != 0);
        let common = straight.fold(None, |all: Option<u8>, f| {
            Some(all.map_or(f.planes, |a| a & f.planes))
        });
        common == Some(0)
    }

    /// How three edges go together.
    pub(super) fn agreement(&self, edges: [usize; 3]) -> Agreement {
        let [Some(a), Some(b), Some(c)] = edges.map(|e| self.fits[e]) else {
            return Agreement::Unknown;
        };
        if a.planes & b.planes & c.planes != 0 {
            Agreement::Plane
        } else if a.cylinders & b.cylinders & c.cylinders != 0
            && !(a.straight && b.straight && c.straight)
        {
            Agreement::Cylinder
        } else {
            Agreement::None
        }
    }
}

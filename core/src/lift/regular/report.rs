//! What was made regular.

use std::fmt;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::drawing::{Curve2, Drawing};

/// Something that was measured and was taken for what is meant. Faces count from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Snap {
    /// Normals or axes of these faces are along dominant directions.
    Square {
        /// Faces.
        faces: Vec<usize>,
    },
    /// Faces at right angles to an axis are turned by a usual angle from the others.
    Angle {
        /// Degrees, a multiple of 15.
        degrees: f64,
        /// Faces.
        faces: Vec<usize>,
    },
    /// These faces have one normal or axis.
    Parallel {
        /// Faces.
        faces: Vec<usize>,
    },
    /// These faces are in one plane.
    Coplanar {
        /// Faces.
        faces: Vec<usize>,
    },
    /// These cylinders have one axis.
    Coaxial {
        /// Faces.
        faces: Vec<usize>,
    },
    /// These cylinders have one radius.
    EqualRadius {
        /// Faces.
        faces: Vec<usize>,
    },
    /// These faces touch others along an edge.
    Tangent {
        /// Faces.
        faces: Vec<usize>,
    },
}

impl Snap {
    /// The faces, from 0.
    pub fn faces(&self) -> &[usize] {
        match self {
            Self::Square { faces }
            | Self::Angle { faces, .. }
            | Self::Parallel { faces }
            | Self::Coplanar { faces }
            | Self::Coaxial { faces }
            | Self::EqualRadius { faces }
            | Self::Tangent { faces } => faces,
        }
    }
}

impl fmt::Display for Snap {
    /// In the words of the drawing: faces from 1.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<String> = self.faces().iter().map(|n| (n + 1).to_string()).collect();
        let word = if numbers.len() == 1 { "face" } else { "faces" };
        let (is, was) = if numbers.len() == 1 {
            ("is", "was")
        } else {
            ("are", "were")
        };
        write!(f, "{word} {} ", numbers.join(", "))?;
        match self {
            Self::Square { .. } => write!(f, "{was} squared with the model's axes"),
            Self::Angle { degrees, .. } => write!(f, "{was} set at {degrees} degrees"),
            Self::Parallel { .. } => write!(f, "{was} made parallel"),
            Self::Coplanar { .. } => write!(f, "{was} put in one plane"),
            Self::Coaxial { .. } => write!(f, "{was} put around one axis"),
            Self::EqualRadius { .. } => write!(f, "{was} given one radius"),
            Self::Tangent { .. } => write!(f, "{is} tangent to a neighbour"),
        }
    }
}

/// A drawing as it was meant, beside one that is drawn inexactly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Regular {
    /// Standard error of the coordinates as drawn, drawing units.
    pub noise: f64,
    /// How far a vertex was moved in the drawing at most, drawing units.
    pub moved: f64,
    /// Vertices as they were meant, drawing units.
    pub vertices: Vec<DVec2>,
    /// Polyline of every edge as it was meant, drawing units.
    pub curves: Vec<Vec<DVec2>>,
    /// What was snapped.
    pub snapped: Vec<Snap>,
}

impl Regular {
    /// The drawing with what was meant in place of what is drawn.
    #[must_use]
    pub fn applied(&self, drawing: &Drawing) -> Drawing {
        let mut regular = drawing.clone();
        regular.vertices.clone_from(&self.vertices);
        for (edge, points) in regular.edges.iter_mut().zip(&self.curves) {
            edge.points.clone_from(points);
            if !edge.is_straight() {
                edge.curve = match Curve2::recognise(points) {
                    // A flat arc is still none of the straight edges.
                    Curve2::Line => Curve2::Polyline,
                    curve => curve,
                };
            }
        }
        regular
    }

    /// What was done, for the user.
    pub fn notices(&self) -> Vec<String> {
        let first = format!(
            "the drawing is inexact by about {:.1e}; vertices were moved by up to {:.1e} to make it regular",
            self.noise, self.moved
        );
        std::iter::once(first)
            .chain(self.snapped.iter().map(Snap::to_string))
            .collect()
    }
}

//! What lifting takes and gives.

use std::fmt;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::{Camera, Regular};

/// Options of lifting.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LiftOptions {
    /// Take the Necker reversal of the default choice (the model seen from above).
    #[serde(default)]
    pub flip: bool,
}

/// Surface of a lifted face, in drawing units, camera frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Surface {
    /// Plane through `origin`; `normal` has unit length and no meaning of its sign.
    Plane {
        /// A point of the plane.
        origin: DVec3,
        /// Unit normal.
        normal: DVec3,
    },
    /// Circular cylinder.
    Cylinder {
        /// A point of the axis.
        origin: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius.
        radius: f64,
    },
    /// One nappe of a circular cone.
    Cone {
        /// The apex.
        apex: DVec3,
        /// Unit direction of the axis, from the apex into the cone.
        axis: DVec3,
        /// Angle between axis and surface, radians, between 0 and a right angle.
        angle: f64,
    },
    /// Sphere.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius.
        radius: f64,
    },
    /// Torus.
    Torus {
        /// Centre.
        center: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Radius of the spine, the circle that the tube follows.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// A surface that lifting does not know; its vertices still have depth.
    Unknown,
}

impl Surface {
    /// The surface moved away from the viewer by `depth`.
    pub(super) fn lowered(self, depth: f64) -> Self {
        self.with_origin(self.origin() - DVec3::new(0.0, 0.0, depth))
    }
}

/// How the depths were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LiftMethod {
    /// All rows agree: linear least squares.
    Exact,
    /// Rows conflicted: L1, then the rows that agree once more as least squares.
    L1,
    /// The drawing is inexact: what was meant holds exactly, and the drawing was moved to it
    /// ([`Lift::regular`]).
    Regular,
}

/// A face that the lifted depths contradict. In JSON it has its sentence as `message` as well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "ToldConflict")]
pub struct Conflict {
    /// Face index, from 0.
    pub face: usize,
    /// Vertices (from 0) that lie off the face's surface, or on an edge that it cannot have.
    pub vertices: Vec<usize>,
    /// Other faces (from 0) at those vertices.
    pub others: Vec<usize>,
    /// Largest distance, in drawing units; 0 if the face holds an edge twice.
    pub residual: f64,
}

impl fmt::Display for Conflict {
    /// In the words of the drawing: faces from 1, vertices from 0.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "face {} conflicts with ", self.face + 1)?;
        if self.others.is_empty() {
            write!(f, "itself")?;
        } else {
            let others: Vec<usize> = self.others.iter().map(|o| o + 1).collect();
            write!(f, "{}", list("face", "faces", &others))?;
        }
        write!(f, " at {}", list("vertex", "vertices", &self.vertices))
    }
}

/// A [`Conflict`] as it is written.
#[derive(Serialize)]
struct ToldConflict {
    face: usize,
    vertices: Vec<usize>,
    others: Vec<usize>,
    residual: f64,
    message: String,
}

impl From<Conflict> for ToldConflict {
    fn from(conflict: Conflict) -> Self {
        Self {
            message: conflict.to_string(),
            face: conflict.face,
            vertices: conflict.vertices,
            others: conflict.others,
            residual: conflict.residual,
        }
    }
}

/// Numbers that a sentence lists; more would hide what it says.
const MOST: usize = 8;

/// "face 3", "faces 3 and 9", "faces 3, 9 and 10", and the count of the rest if there are too many.
fn list(one: &str, several: &str, numbers: &[usize]) -> String {
    let mut text: Vec<String> = numbers.iter().take(MOST).map(usize::to_string).collect();
    if numbers.len() > MOST {
        text.push(format!("{} more", numbers.len() - MOST));
    }
    match text.split_last() {
        Some((last, [])) => format!("{one} {last}"),
        Some((last, rest)) => format!("{several} {} and {last}", rest.join(", ")),
        None => format!("no {several}"),
    }
}

/// A lifted drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lift {
    /// Depth z of every vertex, drawing units, towards the viewer. The mean is 0 in a parallel
    /// projection. In a central one the camera is at 0 and the scale, which the drawing does not
    /// tell, is such that the mean of f / -z is 1.
    pub depths: Vec<f64>,
    /// The projection: given, or estimated in a perspective drawing.
    #[serde(default)]
    pub camera: Camera,
    /// Surface of every face, in the order of the faces given.
    pub surfaces: Vec<Surface>,
    /// Dominant directions found, unit vectors in the camera frame; three if a full frame.
    pub directions: Vec<DVec3>,
    /// How the depths were found.
    pub method: LiftMethod,
    /// Largest residual of the rows that were kept, drawing units.
    pub residual: f64,
    /// Faces that the depths contradict; empty when consistent.
    pub conflicts: Vec<Conflict>,
    /// The drawing as it was meant, if it is drawn inexactly: depths and surfaces belong to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regular: Option<Regular>,
    /// Curves in space of edges that are more than their surfaces tell: those of sections swept along a
    /// helix.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<LiftedCurve>,
}

/// The curve of an edge in space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LiftedCurve {
    /// Edge index, from 0.
    pub edge: usize,
    /// Points along it, camera frame and drawing units, from the edge's first vertex to its second.
    pub points: Vec<DVec3>,
    /// Unit tangents at both ends, along the curve.
    pub tangents: [DVec3; 2],
}

impl LiftedCurve {
    /// The curve turned about the origin of space.
    pub(crate) fn turned(&self, rotation: DMat3) -> Self {
        Self {
            edge: self.edge,
            points: self.points.iter().map(|p| rotation * *p).collect(),
            tangents: self.tangents.map(|t| rotation * t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conflicts_are_told_in_the_words_of_the_drawing() {
        let conflict = |others: &[usize], vertices: &[usize]| Conflict {
            face: 6,
            vertices: vertices.to_vec(),
            others: others.to_vec(),
            residual: 0.1,
        };
        assert_eq!(
            conflict(&[2, 8], &[12]).to_string(),
            "face 7 conflicts with faces 3 and 9 at vertex 12"
        );
        assert_eq!(
            conflict(&[], &[1, 4, 5]).to_string(),
            "face 7 conflicts with itself at vertices 1, 4 and 5"
        );
        let many: Vec<usize> = (0..11).collect();
        assert_eq!(
            conflict(&[0], &many).to_string(),
            "face 7 conflicts with face 1 at vertices 0, 1, 2, 3, 4, 5, 6, 7 and 3 more"
        );
    }

    #[test]
    fn a_written_conflict_has_its_sentence() {
        let conflict = Conflict {
            face: 6,
            vertices: vec![12],
            others: vec![2, 8],
            residual: 0.25,
        };
        let value = serde_json::to_value(&conflict).unwrap();
        assert_eq!(
            value,
            serde_json::json!({
                "face": 6, "vertices": [12], "others": [2, 8], "residual": 0.25,
                "message": "face 7 conflicts with faces 3 and 9 at vertex 12",
            })
        );
        assert_eq!(serde_json::from_value::<Conflict>(value).unwrap(), conflict);
    }
}

//! Triangle meshes of solids, from binary STL.

use std::collections::HashMap;

use glam::DVec3;

/// A closed mesh; triangles are counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mesh {
    /// Corners, each one once.
    pub(crate) vertices: Vec<DVec3>,
    /// Indices of the corners of each triangle.
    pub(crate) triangles: Vec<[usize; 3]>,
}

/// A side that two triangles share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Side {
    /// Its ends, indices of vertices.
    pub(crate) ends: [usize; 2],
    /// The triangles.
    pub(crate) triangles: [usize; 2],
}

impl Mesh {
    /// Reads binary STL: 80 bytes, the number of triangles, then 50 bytes a triangle (normal, three
    /// corners, two unused bytes), all little endian. Equal corners become one vertex, triangles
    /// without area are left out. `None` if the length does not fit the number.
    pub(crate) fn from_stl(bytes: &[u8]) -> Option<Self> {
        let (head, body) = bytes.split_at_checked(84)?;
        let count = u32::from_le_bytes(head.get(80..)?.try_into().ok()?) as usize;
        if body.len() != count.checked_mul(50)? {
            return None;
        }
        let mut seen = HashMap::new();
        let mut mesh = Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        for record in body.chunks_exact(50) {
            let mut numbers = record
                .chunks_exact(4)
                .skip(3)
                .filter_map(|b| Some(f32::from_le_bytes(b.try_into().ok()?)));
            let mut corners = [0; 3];
            for corner in &mut corners {
                let p = [numbers.next()?, numbers.next()?, numbers.next()?];
                // Adding zero makes -0 and 0 the same corner.
                let key = p.map(|x| (x + 0.0).to_bits());
                *corner = *seen.entry(key).or_insert_with(|| {
                    mesh.vertices.push(DVec3::from_array(p.map(f64::from)));
                    mesh.vertices.len() - 1
                });
            }
            if mesh.area_vector(corners).length_squared() > 0.0 {
                mesh.triangles.push(corners);
            }
        }
        Some(mesh)
    }

    /// The corners of a triangle.
    pub(crate) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.vertices[v])
    }

    /// Unit normal of a triangle, out of the solid.
    pub(crate) fn normal(&self, triangle: usize) -> DVec3 {
        self.area_vector(self.triangles[triangle])
            .normalize_or_zero()
    }

    /// Half diagonal of the bounding box.
    pub(crate) fn size(&self) -> f64 {
        let min = self.vertices.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let max = self
            .vertices
            .iter()
            .fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        if self.vertices.is_empty() {
            0.0
        } else {
            (max - min).length() / 2.0
        }
    }

    /// The same mesh with every vertex moved; `f` must keep handedness.
    pub(crate) fn map(&self, f: impl Fn(DVec3) -> DVec3) -> Self {
        Self {
            vertices: self.vertices.iter().map(|p| f(*p)).collect(),
            triangles: self.triangles.clone(),
        }
    }

    /// The sides that exactly two triangles share, in the order of the first triangle.
    pub(crate) fn sides(&self) -> Vec<Side> {
        let mut first: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (t, corners) in self.triangles.iter().enumerate() {
            for ends in sides_of(*corners) {
                first.entry(ends).or_default().push(t);
            }
        }
        let mut sides: Vec<Side> = first
            .into_iter()
            .filter_map(|(ends, triangles)| {
                let triangles = triangles.try_into().ok()?;
                Some(Side { ends, triangles })
            })
            .collect();
        sides.sort_unstable_by_key(|s| (s.triangles, s.ends));
        sides
    }

    fn area_vector(&self, [a, b, c]: [usize; 3]) -> DVec3 {
        let [a, b, c] = [self.vertices[a], self.vertices[b], self.vertices[c]];
        (b - a).cross(c - a)
    }
}

fn sides_of([a, b, c]: [usize; 3]) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Binary STL of triangles.
    fn stl(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = vec![0; 80];
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const O: [f32; 3] = [0.0; 3];
    const X: [f32; 3] = [1.0, 0.0, -0.0];
    const Y: [f32; 3] = [0.0, 1.0, 0.0];
    const Z: [f32; 3] = [0.0, 0.0, 1.0];

    /// The corner tetrahedron: origin and the three unit points.
    pub(crate) fn tetrahedron() -> Mesh {
        Mesh::from_stl(&stl(&[[O, Y, X], [O, X, Z], [O, Z, Y], [X, Y, Z]])).unwrap()
    }

    #[test]
    fn corners_are_shared() {
        let mesh = tetrahedron();
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!(mesh.triangles.len(), 4);
        assert_eq!(mesh.sides().len(), 6);
        assert_eq!(mesh.normal(0), -DVec3::Z);
        assert!((mesh.size() - 0.75f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn triangles_without_area_are_left_out() {
        let mesh = Mesh::from_stl(&stl(&[[O, X, X], [O, X, Y]])).unwrap();
        assert_eq!(mesh.triangles.len(), 1);
    }

    #[test]
    fn a_cut_file_is_no_mesh() {
        let bytes = stl(&[[O, X, Y]]);
        assert_eq!(Mesh::from_stl(&bytes[..bytes.len() - 1]), None);
        assert_eq!(Mesh::from_stl(&bytes[..40]), None);
    }
}

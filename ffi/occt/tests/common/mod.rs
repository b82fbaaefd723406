//! Hand-made plans: prisms with holes and pockets, along z. Each test file uses some of them.
#![allow(dead_code, unreachable_pub)]

use faceformer::drawing::CoEdge;
use faceformer::plan::{Curve3, Plan, PlanEdge, PlanFace, Surface3};
use glam::{DVec2, DVec3};

/// A closed ring of edges at one height, counter-clockwise seen from above.
#[derive(Clone)]
pub struct Ring {
    vertices: Vec<usize>,
    edges: Vec<usize>,
    /// Centre and radius if the ring is a circle of two arcs.
    circle: Option<(DVec3, f64)>,
}

impl Ring {
    fn forwards(&self) -> Vec<CoEdge> {
        self.edges.iter().map(|&e| CoEdge::new(e, false)).collect()
    }

    fn backwards(&self) -> Vec<CoEdge> {
        let edges = self.edges.iter().rev();
        edges.map(|&e| CoEdge::new(e, true)).collect()
    }
}

/// Puts a plan together.
#[derive(Default)]
pub struct Maker {
    vertices: Vec<DVec3>,
    edges: Vec<PlanEdge>,
    faces: Vec<PlanFace>,
}

impl Maker {
    fn edge(&mut self, a: usize, b: usize, curve: Curve3, silhouette: bool) -> usize {
        self.edges.push(PlanEdge {
            v: [a, b],
            curve,
            silhouette,
        });
        self.edges.len() - 1
    }

    pub fn polygon(&mut self, corners: &[[f64; 2]], z: f64) -> Ring {
        let first = self.vertices.len();
        let n = corners.len();
        let corner = |c: &[f64; 2]| DVec2::from_array(*c).extend(z);
        self.vertices.extend(corners.iter().map(corner));
        let vertices: Vec<usize> = (first..first + n).collect();
        let edges = (0..n)
            .map(|i| self.edge(vertices[i], vertices[(i + 1) % n], Curve3::Line, false))
            .collect();
        Ring {
            vertices,
            edges,
            circle: None,
        }
    }

    pub fn circle(&mut self, center: [f64; 2], radius: f64, z: f64) -> Ring {
        let center = DVec2::from_array(center).extend(z);
        let a = self.vertices.len();
        self.vertices.push(center + DVec3::X * radius);
        self.vertices.push(center - DVec3::X * radius);
        let arc = || Curve3::Circle {
            center,
            normal: DVec3::Z,
            radius,
        };
        let edges = vec![
            self.edge(a, a + 1, arc(), false),
            self.edge(a + 1, a, arc(), false),
        ];
        Ring {
            vertices: vec![a, a + 1],
            edges,
            circle: Some((center, radius)),
        }
    }

    fn face(&mut self, surface: Surface3, loops: Vec<Vec<CoEdge>>) {
        let sources = vec![self.faces.len()];
        self.faces.push(PlanFace {
            surface,
            loops,
            sources,
        });
    }

    /// The faces between two rings of one shape; `hollow` if the solid is around them.
    pub fn walls(&mut self, lower: &Ring, upper: &Ring, hollow: bool) {
        let n = lower.vertices.len();
        let silhouette = lower.circle.is_some();
        let up: Vec<usize> = (0..n)
            .map(|i| {
                self.edge(
                    lower.vertices[i],
                    upper.vertices[i],
                    Curve3::Line,
                    silhouette,
                )
            })
            .collect();
        for i in 0..n {
            let mut walk = vec![
                CoEdge::new(lower.edges[i], false),
                CoEdge::new(up[(i + 1) % n], false),
                CoEdge::new(upper.edges[i], true),
                CoEdge::new(up[i], true),
            ];
            if hollow {
                walk = walk.iter().rev().map(|c| c.mate()).collect();
            }
            let [a, b] = self.edges[lower.edges[i]].v.map(|v| self.vertices[v]);
            let normal = (b - a).cross(DVec3::Z).normalize();
            let surface = match lower.circle {
                Some((origin, radius)) => Surface3::Cylinder {
                    origin,
                    axis: DVec3::Z,
                    radius,
                    hollow,
                },
                None => Surface3::Plane {
                    origin: a,
                    normal: if hollow { -normal } else { normal },
                },
            };
            self.face(surface, vec![walk]);
        }
    }

    /// A face in the plane of the rings, the first one outside.
    pub fn cap(&mut self, rings: &[&Ring], up: bool) {
        let origin = self.vertices[rings[0].vertices[0]];
        let normal = if up { DVec3::Z } else { -DVec3::Z };
        let loops = rings.iter().enumerate().map(|(i, ring)| {
            if (i == 0) == up {
                ring.forwards()
            } else {
                ring.backwards()
            }
        });
        let loops = loops.collect();
        self.face(Surface3::Plane { origin, normal }, loops);
    }

    pub fn plan(self) -> Plan {
        Plan {
            vertices: self.vertices,
            edges: self.edges,
            faces: self.faces,
            notices: Vec::new(),
        }
    }
}

pub const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];

/// A prism of height 2.
pub fn prism(corners: &[[f64; 2]]) -> Plan {
    let mut m = Maker::default();
    let (low, high) = (m.polygon(corners, 0.0), m.polygon(corners, 2.0));
    m.walls(&low, &high, false);
    m.cap(&[&low], false);
    m.cap(&[&high], true);
    m.plan()
}

/// A block of 4 x 3 x 2 with a through hole of radius 1.
pub fn drilled_block() -> Plan {
    let mut m = Maker::default();
    let (low, high) = (m.polygon(&SQUARE, 0.0), m.polygon(&SQUARE, 2.0));
    let hole = [0.0, 2.0].map(|z| m.circle([2.0, 1.5], 1.0, z));
    m.walls(&low, &high, false);
    m.walls(&hole[0], &hole[1], true);
    m.cap(&[&low, &hole[0]], false);
    m.cap(&[&high, &hole[1]], true);
    m.plan()
}

/// A block of 4 x 3 x 2 with a pocket of 2 x 1 x 1.5 in its top.
pub fn block_with_pocket() -> Plan {
    let mut m = Maker::default();
    let (low, high) = (m.polygon(&SQUARE, 0.0), m.polygon(&SQUARE, 2.0));
    let corners = [[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]];
    let (floor, rim) = (m.polygon(&corners, 0.5), m.polygon(&corners, 2.0));
    m.walls(&low, &high, false);
    m.walls(&floor, &rim, true);
    m.cap(&[&low], false);
    m.cap(&[&high, &rim], true);
    m.cap(&[&floor], true);
    m.plan()
}

/// A cylinder of radius 1 and height 2.
pub fn cylinder() -> Plan {
    let mut m = Maker::default();
    let rings = [0.0, 2.0].map(|z| m.circle([0.0, 0.0], 1.0, z));
    m.walls(&rings[0], &rings[1], false);
    m.cap(&[&rings[0]], false);
    m.cap(&[&rings[1]], true);
    m.plan()
}

/// A plan turned about an oblique axis, moved and scaled.
pub fn moved(plan: &Plan, scale: f64) -> Plan {
    let turn = glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let point = |p: DVec3| (turn * p + DVec3::new(5.0, -7.0, 11.0)) * scale;
    let mut out = plan.clone();
    for p in &mut out.vertices {
        *p = point(*p);
    }
    for edge in &mut out.edges {
        if let Curve3::Circle {
            center,
            normal,
            radius,
        } = &mut edge.curve
        {
            *center = point(*center);
            *normal = turn * *normal;
            *radius *= scale;
        }
    }
    for face in &mut out.faces {
        match &mut face.surface {
            Surface3::Plane { origin, normal } => {
                *origin = point(*origin);
                *normal = turn * *normal;
            }
            Surface3::Cylinder {
                origin,
                axis,
                radius,
                ..
            } => {
                *origin = point(*origin);
                *axis = turn * *axis;
                *radius *= scale;
            }
            other => panic!("no plan of these tests has the surface {other:?}"),
        }
    }
    out
}

//! The finished solid from another side: shaded, hidden lines removed.

use std::collections::BTreeMap;

use faceformer::plan::{Plan, Surface3};
use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};

use super::INK;
use super::mesh::Mesh;
use super::owner::same_surface;
use super::page::{Page, Stroke};
use super::painter::{self, Polygon};
use super::palette::Rgb;
use super::view::{Frame, View};
use super::visible::Screen;

const UNKNOWN: Rgb = Rgb(170, 174, 178);

/// A solid ready to be drawn.
#[derive(Debug)]
pub(crate) struct SolidView<'a> {
    /// Mesh in the drawing's frame.
    pub(crate) mesh: &'a Mesh,
    /// Plan in the drawing's frame.
    pub(crate) plan: &'a Plan,
    /// The plan's face of each triangle.
    pub(crate) owners: &'a [Option<usize>],
    /// One colour for each face of the plan.
    pub(crate) colours: &'a [Rgb],
    /// Model axes in the drawing's frame, unit vectors.
    pub(crate) axes: &'a [DVec3],
}

impl SolidView<'_> {
    /// Draws the solid into a frame.
    pub(crate) fn draw(&self, page: &mut Page, frame: Frame) {
        let turn = turn(self.axes);
        let mesh = self.mesh.map(|p| turn * p);
        let view = View::fit(mesh.vertices.iter().map(|p| p.xy()), frame);
        let tolerance = 1e-6 * mesh.size();
        let front: Vec<usize> = (0..mesh.triangles.len())
            .filter(|t| mesh.normal(*t).z > 1e-9)
            .collect();
        let polygons = front.iter().map(|&t| Polygon {
            points: mesh.corners(t).to_vec(),
            normal: mesh.normal(t),
            tag: t,
        });
        self.fill(
            page,
            &view,
            turn,
            &painter::order(polygons.collect(), tolerance),
        );
        let triangles = front.iter().map(|&t| mesh.corners(t)).collect();
        let screen = Screen::new(triangles, 1e-3 * mesh.size());
        let stroke = Stroke {
            colour: INK,
            width: 0.16 * view.unit(),
            dashed: false,
        };
        for [a, b] in self.lines(&mesh) {
            for part in screen.visible(a, b) {
                page.line(&part.map(|p| view.place(p.xy())), stroke);
            }
        }
    }

    /// Paints polygons in the given order; neighbours of one colour become one area.
    fn fill(&self, page: &mut Page, view: &View, turn: DMat3, polygons: &[Polygon]) {
        let colour = |p: &Polygon| {
            let owner = self.owners[p.tag];
            let base = owner.and_then(|f| self.colours.get(f));
            // A plane's own normal gives it one shade all over; its triangles' normals are rounded.
            let normal = match owner
                .and_then(|f| self.plan.faces.get(f))
                .map(|f| &f.surface)
            {
                Some(Surface3::Plane { normal, .. }) => turn * *normal,
                _ => p.normal,
            };
            shaded(base.copied().unwrap_or(UNKNOWN), normal)
        };
        for run in polygons.chunk_by(|p, q| colour(p) == colour(q)) {
            let Some(first) = run.first() else { continue };
            let rings: Vec<Vec<DVec2>> = run
                .iter()
                .map(|p| p.points.iter().map(|p| view.place(p.xy())).collect())
                .collect();
            // A rim of the same colour closes the hairlines between neighbouring areas.
            let rim = Stroke {
                colour: colour(first),
                width: 0.7,
                dashed: false,
            };
            page.area(&rings, colour(first), 1.0, Some(rim));
        }
    }

    /// The segments to draw: edges between surfaces, and the outline of curved ones.
    fn lines(&self, mesh: &Mesh) -> Vec<[DVec3; 2]> {
        let tolerance = 1e-3 * mesh.size();
        let mut smooth = BTreeMap::new();
        let mut is_smooth = |a: usize, b: usize| {
            *smooth.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let faces = &self.plan.faces;
                a == b || same_surface(&faces[a].surface, &faces[b].surface, tolerance)
            })
        };
        mesh.sides()
            .into_iter()
            .filter(|side| {
                let [s, t] = side.triangles;
                let sharp = match (self.owners[s], self.owners[t]) {
                    (Some(a), Some(b)) => !is_smooth(a, b),
                    _ => mesh.normal(s).dot(mesh.normal(t)) < 0.9,
                };
                let [s, t] = [s, t].map(|t| mesh.normal(t).z > 0.0);
                (sharp && (s || t)) || s != t
            })
            .map(|side| side.ends.map(|v| mesh.vertices[v]))
            .collect()
    }
}

/// The rotation to the second viewpoint: about the model axis that stands most upright in the
/// drawing, by an angle that shows three sides well.
fn turn(axes: &[DVec3]) -> DMat3 {
    let up = axes
        .iter()
        .max_by(|a, b| a.y.abs().total_cmp(&b.y.abs()))
        .map_or(DVec3::Y, |axis| *axis * axis.y.signum());
    let shown = |degrees: f64| {
        let turn = DMat3::from_axis_angle(up, degrees.to_radians());
        let depth = |axis: &DVec3| (turn * *axis).z.abs();
        axes.iter().map(depth).fold(1.0, f64::min)
    };
    let angles = [70.0, -70.0, 85.0, -85.0, 55.0, -55.0, 100.0, -100.0];
    let best = angles
        .into_iter()
        .reduce(|best, a| {
            if shown(a) > shown(best) + 1e-6 {
                a
            } else {
                best
            }
        })
        .unwrap_or(70.0);
    DMat3::from_axis_angle(up, best.to_radians())
}

/// A surface's colour in light that comes from the upper left, over the viewer's shoulder.
fn shaded(colour: Rgb, normal: DVec3) -> Rgb {
    let light = DVec3::new(-0.35, 0.65, 0.67).normalize();
    colour.scaled(0.62 + 0.38 * normal.dot(light).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::mesh::tests::tetrahedron;
    use super::*;

    #[test]
    fn turning_shows_all_three_axes() {
        let frame = DMat3::from_axis_angle(DVec3::X, 0.6) * DMat3::from_axis_angle(DVec3::Y, 0.5);
        let axes = [frame.x_axis, frame.y_axis, frame.z_axis];
        let turned = axes.map(|a| (turn(&axes) * a).z.abs());
        assert!(turned.iter().all(|z| *z > 0.3), "{turned:?}");
        assert!(turn(&[]).is_finite());
    }

    #[test]
    fn a_tetrahedron_is_drawn_with_its_visible_edges() {
        let mesh = tetrahedron();
        let plan = Plan {
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
            notices: Vec::new(),
        };
        let view = SolidView {
            mesh: &mesh,
            plan: &plan,
            owners: &[None; 4],
            colours: &[],
            axes: &[DVec3::X, DVec3::Y, DVec3::Z],
        };
        let mut page = Page::new(200.0, 200.0);
        let frame = Frame {
            corner: DVec2::splat(10.0),
            size: DVec2::splat(180.0),
        };
        view.draw(&mut page, frame);
        let svg = page.to_svg();
        let lines = svg.matches("fill=\"none\"").count();
        assert!((3..=6).contains(&lines), "{svg}");
        assert!(svg.contains("fill-rule"), "{svg}");
    }
}

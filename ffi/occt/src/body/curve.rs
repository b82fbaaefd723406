//! Curves walked backwards and joined.

use faceformer::drawing::CoEdge;
use faceformer::plan::Curve3;
use glam::DVec3;

use super::{Body, BodyEdge};

/// A curve walked the other way.
pub(super) fn reversed(curve: &Curve3) -> Curve3 {
    let mut curve = curve.clone();
    match &mut curve {
        Curve3::Line => {}
        Curve3::Circle { normal, .. } | Curve3::Ellipse { normal, .. } => *normal = -*normal,
        Curve3::Points { points, tangents } => {
            points.reverse();
            *tangents = tangents.map(|[a, b]| [-b, -a]);
        }
    }
    curve
}

/// The edge along two co-edges that meet, if they are of one curve within `tolerance`.
pub(super) fn joined(
    body: &Body,
    first: CoEdge,
    second: CoEdge,
    tolerance: f64,
) -> Option<BodyEdge> {
    let along = |c: CoEdge| {
        let curve = &body.edges[c.edge()].curve;
        if c.is_reversed() {
            reversed(curve)
        } else {
            curve.clone()
        }
    };
    let ends = [body.start(first), body.end(second)];
    let close = |a: DVec3, b: DVec3| a.distance(b) <= tolerance;
    let curve = match (along(first), along(second)) {
        (Curve3::Line, Curve3::Line) => {
            let [a, b] = ends.map(|v| body.vertices[v]);
            let between = body.vertices[body.end(first)];
            let d = (b - a).try_normalize()?;
            (close((between - a).reject_from_normalized(d), DVec3::ZERO)).then_some(Curve3::Line)?
        }
        (
            Curve3::Circle {
                center,
                normal,
                radius,
            },
            Curve3::Circle {
                center: c,
                normal: n,
                radius: r,
            },
        ) => (close(center, c)
            && (radius - r).abs() <= tolerance
            && (normal - n).length() * radius <= tolerance)
            .then_some(Curve3::Circle {
                center: center.midpoint(c),
                normal: (normal + n).try_normalize()?,
                radius: f64::midpoint(radius, r),
            })?,
        (
            Curve3::Ellipse {
                center,
                normal,
                major,
                ratio,
            },
            Curve3::Ellipse {
                center: c,
                normal: n,
                major: m,
                ratio: q,
            },
        ) => (close(center, c)
            && (close(major, m) || close(major, -m))
            && (ratio - q).abs() * major.length() <= tolerance
            && (normal - n).length() * major.length() <= tolerance)
            .then_some(Curve3::Ellipse {
                center,
                normal,
                major,
                ratio,
            })?,
        (
            Curve3::Points {
                mut points,
                tangents,
            },
            Curve3::Points {
                points: more,
                tangents: ends,
            },
        ) => {
            points.extend(more.into_iter().skip(1));
            Curve3::Points {
                points,
                tangents: tangents.zip(ends).map(|(first, last)| [first[0], last[1]]),
            }
        }
        _ => return None,
    };
    Some(BodyEdge {
        v: ends,
        curve,
        source: body.edges[first.edge()].source,
    })
}

//! Parts of a drawing that share no vertex.

use glam::DVec2;

use super::super::clean::names;
use super::super::{Finding, FindingKind, Severity};
use super::Case;
use crate::sets::Sets;

/// Says into which parts the drawing falls, and warns of parts that are drawn apart from all others.
///
/// The rim of a hole or of a boss is an inner loop of some face, and lies inside that face's outer
/// loop. So the outlines of two parts of one solid overlap, directly or through other parts.
pub(super) fn findings(case: &Case<'_>) -> Vec<Finding> {
    let count = case.graph.component_count();
    if count < 2 {
        return Vec::new();
    }
    let mut edges: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut points: Vec<Vec<DVec2>> = vec![Vec::new(); count];
    for (i, e) in case.drawing.edges.iter().enumerate() {
        let part = case.graph.component(e.v[0]);
        edges[part].push(i);
        points[part].extend(&e.points);
    }
    let hulls: Vec<Vec<DVec2>> = points.into_iter().map(hull).collect();
    let groups = groups(&hulls);
    // The group with the most edges is the solid; what stands apart from it is named.
    let mut sizes = vec![0; count];
    for (part, list) in edges.iter().enumerate() {
        sizes[groups[part]] += list.len();
    }
    let main = (0..count).fold(0, |b, g| if sizes[g] > sizes[b] { g } else { b });
    let mut found = Vec::new();
    let together = groups.iter().filter(|&&g| g == main).count();
    if together > 1 {
        found.push(Finding {
            severity: Severity::Notice,
            kind: FindingKind::IsolatedPart,
            message: format!(
                "the drawing has {together} parts that share no vertex, as solids with holes, \
                 pockets or bosses have; look whether an edge between them is missing"
            ),
            edges: smaller_parts(&edges, &groups, main),
            vertices: Vec::new(),
            points: Vec::new(),
        });
    }
    for group in (0..count).filter(|&g| g != main && sizes[g] > 0) {
        let list: Vec<usize> = (0..count)
            .filter(|&part| groups[part] == group)
            .flat_map(|part| edges[part].clone())
            .collect();
        found.push(Finding {
            severity: Severity::Warning,
            kind: FindingKind::IsolatedPart,
            message: format!(
                "{} stand apart from the rest of the drawing and cannot belong to the same solid; \
                 select one solid's edges only",
                names(case.labels, &list)
            ),
            points: vec![case.drawing.edges[list[0]].points[0]],
            edges: list,
            vertices: Vec::new(),
        });
    }
    found
}

/// Edges of all parts of the group but the largest one.
fn smaller_parts(edges: &[Vec<usize>], groups: &[usize], main: usize) -> Vec<usize> {
    let parts = || (0..edges.len()).filter(|&p| groups[p] == main);
    let largest = parts().max_by_key(|&p| edges[p].len());
    parts()
        .filter(|&p| Some(p) != largest)
        .flat_map(|p| edges[p].clone())
        .collect()
}

/// The group of each part: parts with overlapping outlines are in one.
fn groups(hulls: &[Vec<DVec2>]) -> Vec<usize> {
    let mut order: Vec<(f64, f64, usize)> = hulls
        .iter()
        .enumerate()
        .map(|(i, h)| {
            let xs = h.iter().map(|p| p.x);
            let min = xs.clone().fold(f64::INFINITY, f64::min);
            (min, xs.fold(f64::NEG_INFINITY, f64::max), i)
        })
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut group = Sets::new(hulls.len());
    for (k, &(_, end, i)) in order.iter().enumerate() {
        for &(_, _, j) in order[k + 1..].iter().take_while(|o| o.0 <= end) {
            if group.find(i) != group.find(j) && overlap(&hulls[i], &hulls[j]) {
                group.join(i, j);
            }
        }
    }
    (0..hulls.len()).map(|i| group.find(i)).collect()
}

/// Convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp_dot(p - b) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    if points.len() < 3 {
        return points;
    }
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}

/// Whether two convex polygons overlap: no side of either separates them.
fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    let separated = |a: &[DVec2], b: &[DVec2]| {
        (0..a.len()).any(|i| {
            let (p, q) = (a[i], a[(i + 1) % a.len()]);
            p != q && b.iter().all(|r| (q - p).perp_dot(*r - p) < 0.0)
        })
    };
    // A segment's hull has no inside; its two sides and its ends' directions are tried.
    let apart_along = |a: &[DVec2], b: &[DVec2]| match a {
        &[p, q] => {
            let d = q - p;
            b.iter().all(|r| (*r - q).dot(d) > 0.0) || b.iter().all(|r| (*r - p).dot(d) < 0.0)
        }
        _ => false,
    };
    !separated(a, b) && !separated(b, a) && !apart_along(a, b) && !apart_along(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, half: f64) -> Vec<DVec2> {
        let corners = [
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
            (0.0, 0.5),
        ];
        hull(
            corners
                .map(|(i, j)| DVec2::new(x + i * half, y + j * half))
                .to_vec(),
        )
    }

    #[test]
    fn hulls_leave_inner_points_out() {
        assert_eq!(square(0.0, 0.0, 1.0).len(), 4);
        assert_eq!(hull(vec![DVec2::ZERO, DVec2::X, DVec2::X * 2.0]).len(), 2);
    }

    #[test]
    fn outlines_overlap_or_stand_apart() {
        assert!(overlap(&square(0.0, 0.0, 1.0), &square(0.0, 0.0, 0.2)));
        assert!(overlap(&square(0.0, 0.0, 1.0), &square(1.5, 1.5, 1.0)));
        assert!(!overlap(&square(0.0, 0.0, 1.0), &square(2.5, 0.0, 1.0)));
        let bar = [DVec2::new(2.0, 0.0), DVec2::new(3.0, 0.0)];
        assert!(!overlap(&square(0.0, 0.0, 1.0), &bar));
        assert!(overlap(&square(0.0, 0.0, 2.5), &bar));
    }

    #[test]
    fn parts_are_grouped_through_others() {
        let hulls = [
            square(0.0, 0.0, 1.0),
            square(5.0, 0.0, 1.0),
            square(1.5, 0.0, 1.0),
            square(3.0, 0.0, 1.2),
            square(9.0, 0.0, 1.0),
        ];
        assert_eq!(groups(&hulls), [0, 0, 0, 0, 4]);
    }
}

//! Solving the depth problem of one reading: exactly if its rows agree, else in the L1 norm and
//! then exactly once more over the rows that agree.

use super::assumed::LEVELS;
use super::completion;
use super::gauge;
use super::heights::Heights;
use super::rows::{self, Tag, Unknowns};
use super::sheet::Sheet;
use super::system::{NullSpace, System};
use super::{LiftError, LiftMethod};

/// Standard errors beyond which a row is wrong.
const WRONG: f64 = 10.0;

/// Openness of a row that adds to what is known.
const OPEN: f64 = 2e-4;

/// Rounds of weighing planes by their slope.
const WEIGHINGS: usize = 3;

/// Rounds of dropping and taking back rows.
const ROUNDS: usize = 4;

/// Rounds of tying loose parts by surfaces.
const COMPLETIONS: usize = 4;

/// A solved reading.
pub(super) struct Solved {
    unknowns: Unknowns,
    system: System<Tag>,
    x: Vec<f64>,
    null_space: NullSpace,
    /// Which rows were kept.
    active: Vec<bool>,
    pub(super) method: LiftMethod,
}

impl Solved {
    /// Number of rows that were dropped.
    pub(super) fn dropped(&self) -> usize {
        self.active.iter().filter(|a| !**a).count()
    }

    /// Faces at the rows that were dropped, with the number of these rows, most first.
    pub(super) fn suspects(&self, sheet: &Sheet<'_>) -> Vec<(usize, usize)> {
        let mut rows = vec![0; sheet.faces.len()];
        let dropped = self.system.rows().iter().zip(&self.active);
        for (row, _) in dropped.filter(|(_, active)| !**active) {
            match row.tag {
                Tag::Incidence { face, .. }
                | Tag::Alignment { face }
                | Tag::Disc { face }
                | Tag::Revolved { face }
                | Tag::Prism { face }
                | Tag::Frustum { face }
                | Tag::Generator { face } => rows[face] += 1,
                Tag::Edge { edge }
                | Tag::Chord { edge }
                | Tag::Parallel { edge }
                | Tag::Swept { edge } => {
                    let beside = sheet.neighbours(edge).iter();
                    beside.for_each(|&face| rows[face] += 1);
                }
                Tag::Gauge | Tag::Coaxial => {}
            }
        }
        let mut suspects: Vec<(usize, usize)> = rows.into_iter().enumerate().collect();
        suspects.retain(|(_, count)| *count > 0);
        suspects.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        suspects
    }

    /// All heights, taken as known.
    pub(super) fn heights(&self, sheet: &Sheet<'_>) -> Heights {
        Heights {
            vertices: self.unknowns.vertices().map(|v| self.height(v)).collect(),
            planes: (0..sheet.faces.len()).map(|f| self.plane(f)).collect(),
            known: vec![true; self.unknowns.vertices().len()],
        }
    }

    pub(super) fn height(&self, vertex: usize) -> f64 {
        self.x[vertex]
    }

    /// (a, b, c) of a planar face, if the rows determine its slope.
    pub(super) fn plane(&self, face: usize) -> Option<[f64; 3]> {
        let p = self.unknowns.plane(face)?;
        let fixed = !self.null_space.is_free(p) && !self.null_space.is_free(p + 1);
        fixed.then(|| [self.x[p], self.x[p + 1], self.x[p + 2]])
    }

    /// Vertices whose depth is not tied to that of most others, sorted.
    pub(super) fn loose(&self, sheet: &Sheet<'_>) -> Vec<usize> {
        loose(sheet, &self.unknowns, &self.null_space)
    }

    /// Whether the depths of two vertices are determined by each other.
    pub(super) fn are_tied(&self, sheet: &Sheet<'_>, a: usize, b: usize) -> bool {
        if sheet.camera().is_parallel() {
            self.null_space.are_tied(a, b)
        } else {
            !self.null_space.is_free(a) && !self.null_space.is_free(b)
        }
    }

    /// Largest residual of the rows kept that are lengths, drawing units; those of planes are
    /// distances from the plane.
    pub(super) fn residual(&self) -> f64 {
        let rows = self.system.rows().iter().zip(&self.active);
        rows.filter(|(_, active)| **active)
            .map(|(row, _)| match row.tag {
                Tag::Incidence { face, .. } => {
                    row.residual(&self.x).abs() / steepness(&self.unknowns, &self.x, face)
                }
                Tag::Alignment { .. } | Tag::Disc { .. } | Tag::Prism { .. } => 0.0,
                _ => row.residual(&self.x).abs(),
            })
            .fold(0.0, f64::max)
    }
}

/// Solves a reading whose depths must all be tied together.
pub(super) fn solve(sheet: &Sheet<'_>) -> Result<Solved, LiftError> {
    let solved = solve_open(sheet)?;
    let vertices = solved.loose(sheet);
    if !vertices.is_empty() {
        return Err(LiftError::UnderConstrained { vertices });
    }
    gauge::in_front(sheet, &solved.null_space, &solved.x)?;
    Ok(solved)
}

/// Solves a reading, whatever its rows leave open.
pub(super) fn solve_open(sheet: &Sheet<'_>) -> Result<Solved, LiftError> {
    solve_rows(sheet, true)
}

/// Solves a reading whose parts keep the depth that their own rows give them: loops that are not
/// grouped into faces yet bound no surface that could tie one part to another.
pub(super) fn solve_parts(sheet: &Sheet<'_>) -> Result<Solved, LiftError> {
    solve_rows(sheet, false)
}

fn solve_rows(sheet: &Sheet<'_>, tie_parts: bool) -> Result<Solved, LiftError> {
    let unknowns = Unknowns::new(sheet);
    let mut system = rows::certain(sheet, &unknowns);
    let mut null_space = gauge::choose(sheet, &unknowns, &mut system)?;
    if !tie_parts {
        null_space = gauge::choose_parts(sheet, &mut system, null_space)?;
    }
    let parallel = sheet.camera().is_parallel();
    for level in LEVELS {
        if loose(sheet, &unknowns, &null_space).is_empty() {
            break;
        }
        let mut more = System::new(system.unknowns());
        level(sheet, &unknowns, &mut more);
        let before = system.rows().len();
        for row in more.rows() {
            // Rows within a loose part of a central drawing disagree by their errors, and would say
            // that all of it is nothing.
            let open = parallel || null_space.openness(&row.terms) > OPEN;
            if open && null_space.leaves_open(&row.terms) {
                system.push(row.terms.iter().copied(), row.rhs, row.weight, row.tag);
            }
        }
        if system.rows().len() > before {
            null_space = system.null_space()?;
        }
    }
    if tie_parts {
        complete(sheet, &unknowns, &mut system, &mut null_space)?;
    }
    let base: Vec<f64> = system.rows().iter().map(|r| r.weight).collect();
    let mut active = vec![true; system.rows().len()];
    let mut x = settle(&mut system, &unknowns, &base, &active)?;
    gauge::rescale(sheet, &null_space, &mut system, &mut x);
    let mut method = LiftMethod::Exact;
    if agreeing(&system, &x).contains(&false) || gauge::in_front(sheet, &null_space, &x).is_err() {
        method = LiftMethod::L1;
        restore(&mut system, &base);
        gauge::release(&mut system);
        x = system.least_absolute()?.x;
        for _ in 0..ROUNDS {
            gauge::rescale(sheet, &null_space, &mut system, &mut x);
            weigh(&mut system, &unknowns, &base, &x);
            let next = agreeing(&system, &x);
            let same = next == active;
            active = next;
            if same {
                break;
            }
            x = settle(&mut system, &unknowns, &base, &active)?;
        }
        gauge::hold(sheet, &mut system);
        null_space = system.null_space_of(&active)?;
        gauge::rescale(sheet, &null_space, &mut system, &mut x);
    }
    Ok(Solved {
        unknowns,
        system,
        x,
        null_space,
        active,
        method,
    })
}

/// Ties what is loose to the main part by surfaces that the main part's heights fix.
fn complete(
    sheet: &Sheet<'_>,
    unknowns: &Unknowns,
    system: &mut System<Tag>,
    null_space: &mut NullSpace,
) -> Result<(), LiftError> {
    let parallel = sheet.camera().is_parallel();
    for _ in 0..COMPLETIONS {
        let groups = if parallel {
            groups(unknowns, null_space)
        } else {
            one_by_one(unknowns, null_space)
        };
        if groups.len() < 2 || groups[0].is_empty() {
            break;
        }
        let x = system.minimise(&vec![true; system.rows().len()])?;
        let main = groups[0][0];
        let plane = |f: usize| {
            let p = unknowns.plane(f)?;
            let open = |terms: &[(usize, f64)]| null_space.leaves_open(terms);
            // All heights of a parallel projection may shift together.
            let shift: &[(usize, f64)] = if parallel { &[(main, 1.0)] } else { &[] };
            let constant = [&[(p + 2, 1.0)], shift].concat();
            let fixed = !open(&[(p, 1.0)]) && !open(&[(p + 1, 1.0)]) && !open(&constant);
            fixed.then(|| [x[p], x[p + 1], x[p + 2]])
        };
        let mut known = vec![false; unknowns.vertices().len()];
        groups[0].iter().for_each(|&v| known[v] = true);
        let heights = Heights {
            vertices: x[..known.len()].to_vec(),
            planes: (0..sheet.faces.len()).map(plane).collect(),
            known,
        };
        let ties = |any_kind| completion::ties(sheet, &heights, &groups[1..], any_kind);
        let mut found = ties(false);
        if found.is_empty() {
            found = ties(true);
        }
        if found.is_empty() {
            break;
        }
        for tie in found {
            let (weight, tag) = (tie.error.recip(), Tag::Revolved { face: tie.face });
            let row = sheet.camera().apart(x[main], tie.height);
            let terms = [(tie.vertex, row.to), (main, -row.from)];
            system.push(terms, row.rise, weight, tag);
        }
        *null_space = system.null_space()?;
    }
    Ok(())
}

/// Least squares, with the rows of planes weighed by the slopes that come out.
fn settle(
    system: &mut System<Tag>,
    unknowns: &Unknowns,
    base: &[f64],
    active: &[bool],
) -> Result<Vec<f64>, LiftError> {
    restore(system, base);
    let pattern = system.pattern(active)?;
    let mut x = system.minimise_as(active, &pattern)?;
    for _ in 1..WEIGHINGS {
        weigh(system, unknowns, base, &x);
        x = system.minimise_as(active, &pattern)?;
    }
    weigh(system, unknowns, base, &x);
    Ok(x)
}

fn restore(system: &mut System<Tag>, base: &[f64]) {
    for (row, &weight) in system.rows_mut().iter_mut().zip(base) {
        row.weight = weight;
    }
}

/// An error of a drawn point is one of its depth times the plane's slope, so the residual that
/// counts is the distance from the plane.
fn weigh(system: &mut System<Tag>, unknowns: &Unknowns, base: &[f64], x: &[f64]) {
    for (row, &weight) in system.rows_mut().iter_mut().zip(base) {
        if let Tag::Incidence { face, .. } | Tag::Alignment { face } = row.tag {
            row.weight = weight / steepness(unknowns, x, face);
        }
    }
}

/// Reciprocal of |n_z| of a planar face.
fn steepness(unknowns: &Unknowns, x: &[f64], face: usize) -> f64 {
    unknowns
        .plane(face)
        .map_or(1.0, |p| (1.0 + x[p] * x[p] + x[p + 1] * x[p + 1]).sqrt())
}

fn agreeing(system: &System<Tag>, x: &[f64]) -> Vec<bool> {
    let rows = system.rows().iter();
    rows.map(|row| (row.residual(x) * row.weight).abs() <= WRONG)
        .collect()
}

/// Vertices in groups whose depths are tied, the largest group first.
fn groups(unknowns: &Unknowns, null_space: &NullSpace) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for v in unknowns.vertices() {
        match groups.iter_mut().find(|g| null_space.are_tied(g[0], v)) {
            Some(group) => group.push(v),
            None => groups.push(vec![v]),
        }
    }
    groups.sort_by_key(|g| std::cmp::Reverse(g.len()));
    groups
}

/// The vertices whose height is fixed in a central projection, then every other one by itself: a
/// loose part there does not shift but grows, each of its heights by a share.
fn one_by_one(unknowns: &Unknowns, null_space: &NullSpace) -> Vec<Vec<usize>> {
    let (free, fixed): (Vec<usize>, Vec<usize>) =
        unknowns.vertices().partition(|&v| null_space.is_free(v));
    let free = free.into_iter().map(|v| vec![v]);
    std::iter::once(fixed).chain(free).collect()
}

/// Vertices whose depth is not tied to that of most others, sorted.
fn loose(sheet: &Sheet<'_>, unknowns: &Unknowns, null_space: &NullSpace) -> Vec<usize> {
    if !sheet.camera().is_parallel() {
        let vertices = unknowns.vertices();
        return vertices.filter(|&v| null_space.is_free(v)).collect();
    }
    let mut loose: Vec<usize> = groups(unknowns, null_space)
        .into_iter()
        .skip(1)
        .flatten()
        .collect();
    loose.sort_unstable();
    loose
}

//! Solving the depth problem of one reading: exactly if its rows agree, else in the L1 norm and
//! then exactly once more over the rows that agree.

use super::rows::{self, Tag, Unknowns};
use super::sheet::Sheet;
use super::system::{NullSpace, Solution, System};
use super::{LiftError, LiftMethod};

/// Standard errors beyond which a row is wrong.
const WRONG: f64 = 10.0;

/// Rounds of weighing planes by their slope; of dropping and taking back rows.
const ROUNDS: usize = 3;

/// A solved reading.
pub(super) struct Solved {
    pub(super) unknowns: Unknowns,
    pub(super) system: System<Tag>,
    pub(super) solution: Solution,
    /// Which rows were kept.
    pub(super) active: Vec<bool>,
    pub(super) method: LiftMethod,
}

impl Solved {
    /// Number of rows that were dropped.
    pub(super) fn dropped(&self) -> usize {
        self.active.iter().filter(|a| !**a).count()
    }

    /// Largest residual of the rows kept that are lengths, drawing units; those of planes are
    /// distances from the plane.
    pub(super) fn residual(&self) -> f64 {
        let rows = self.system.rows().iter().zip(&self.solution.residuals);
        rows.zip(&self.active)
            .filter(|(_, active)| **active)
            .map(|((row, r), _)| match row.tag {
                Tag::Incidence { face, .. } => self.unknowns.plane(face).map_or(0.0, |p| {
                    let (a, b) = (self.solution.x[p], self.solution.x[p + 1]);
                    r.abs() / (1.0 + a * a + b * b).sqrt()
                }),
                Tag::Alignment { .. } | Tag::Disc { .. } => 0.0,
                _ => r.abs(),
            })
            .fold(0.0, f64::max)
    }

    pub(super) fn depth(&self, vertex: usize) -> f64 {
        self.solution.x[vertex]
    }

    /// (a, b, c) of a planar face, if the rows determine its slope.
    pub(super) fn plane(&self, face: usize) -> Option<[f64; 3]> {
        let p = self.unknowns.plane(face)?;
        let null = &self.solution.null_space;
        let fixed = !null.is_free(p) && !null.is_free(p + 1);
        let x = &self.solution.x;
        fixed.then(|| [x[p], x[p + 1], x[p + 2]])
    }
}

pub(super) fn solve(sheet: &Sheet<'_>) -> Result<Solved, LiftError> {
    let unknowns = Unknowns::new(sheet);
    let mut system = rows::certain(sheet, &unknowns);
    let mut null_space = system.null_space()?;
    for level in rows::LEVELS {
        if loose(&unknowns, &null_space).is_empty() {
            break;
        }
        let more = level(sheet, &unknowns);
        let before = system.rows().len();
        for row in more.rows() {
            if null_space.leaves_open(&row.terms) {
                system.push(row.terms.iter().copied(), row.rhs, row.weight, row.tag);
            }
        }
        if system.rows().len() > before {
            null_space = system.null_space()?;
        }
    }
    refuse_loose(&unknowns, &null_space)?;
    let base: Vec<f64> = system.rows().iter().map(|r| r.weight).collect();
    let mut active = vec![true; system.rows().len()];
    let mut solution = settle(&mut system, &unknowns, &base, &active)?;
    let mut method = LiftMethod::Exact;
    if solution.worst(&system) > WRONG {
        method = LiftMethod::L1;
        restore(&mut system, &base);
        solution = system.least_absolute()?;
        for _ in 0..ROUNDS {
            weigh(&mut system, &unknowns, &base, &solution);
            let agreeing = agreeing(&system, &solution);
            let same = agreeing == active;
            active = agreeing;
            if same {
                break;
            }
            solution = settle(&mut system, &unknowns, &base, &active)?;
        }
        refuse_loose(&unknowns, &solution.null_space)?;
    }
    Ok(Solved {
        unknowns,
        system,
        solution,
        active,
        method,
    })
}

/// Least squares, with the rows of planes weighed by the slopes that come out.
fn settle(
    system: &mut System<Tag>,
    unknowns: &Unknowns,
    base: &[f64],
    active: &[bool],
) -> Result<Solution, LiftError> {
    restore(system, base);
    let mut solution = system.least_squares_of(active)?;
    for _ in 1..ROUNDS {
        weigh(system, unknowns, base, &solution);
        solution = system.least_squares_of(active)?;
    }
    weigh(system, unknowns, base, &solution);
    Ok(solution)
}

fn restore(system: &mut System<Tag>, base: &[f64]) {
    for (row, &weight) in system.rows_mut().iter_mut().zip(base) {
        row.weight = weight;
    }
}

/// An error of a drawn point is one of its depth times the plane's slope, so the residual that
/// counts is the distance from the plane.
fn weigh(system: &mut System<Tag>, unknowns: &Unknowns, base: &[f64], solution: &Solution) {
    for (row, &weight) in system.rows_mut().iter_mut().zip(base) {
        let face = match row.tag {
            Tag::Incidence { face, .. } | Tag::Alignment { face } => face,
            _ => continue,
        };
        if let Some(p) = unknowns.plane(face) {
            let (a, b) = (solution.x[p], solution.x[p + 1]);
            row.weight = weight / (1.0 + a * a + b * b).sqrt();
        }
    }
}

fn agreeing(system: &System<Tag>, solution: &Solution) -> Vec<bool> {
    let rows = system.rows().iter().zip(&solution.residuals);
    rows.map(|(row, r)| (r * row.weight).abs() <= WRONG)
        .collect()
}

/// Vertices whose depth is not tied to that of most others.
fn loose(unknowns: &Unknowns, null_space: &NullSpace) -> Vec<usize> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for v in unknowns.vertices() {
        match groups.iter_mut().find(|g| null_space.are_tied(g[0], v)) {
            Some(group) => group.push(v),
            None => groups.push(vec![v]),
        }
    }
    let Some(main) = (0..groups.len()).max_by_key(|&g| groups[g].len()) else {
        return Vec::new();
    };
    groups.swap_remove(main);
    let mut loose: Vec<usize> = groups.into_iter().flatten().collect();
    loose.sort_unstable();
    loose
}

fn refuse_loose(unknowns: &Unknowns, null_space: &NullSpace) -> Result<(), LiftError> {
    let vertices = loose(unknowns, null_space);
    if vertices.is_empty() {
        Ok(())
    } else {
        Err(LiftError::UnderConstrained { vertices })
    }
}

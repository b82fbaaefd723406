//! What an engine got wrong, one small picture a mistake (after the paper's figure of incorrect
//! predictions): the drawing, then each wrong face, each face of the wrong type, each missed face.

use faceformer::drawing::{CoEdge, Drawing};
use faceformer::identify::Identification;
use faceformer::identify::metrics::Mistakes;
use glam::DVec2;

use super::page::{Anchor, Page, Stroke};
use super::palette::{MISSED, MISTYPED, Rgb, WRONG};
use super::view::{Frame, View};
use super::wireframe::ring;
use super::{INK, MARGIN, QUIET};
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::stages::{FacesFrom, tell, usable};

/// Side of one picture, in pixels.
const CELL: f64 = 148.0;
/// Blank border in a picture.
const BORDER: f64 = 12.0;
/// Room for the words below a picture.
const CAPTION: f64 = 20.0;
/// Height of the title and of the legend.
const TITLE: f64 = 46.0;
const LEGEND: f64 = 34.0;
const PATCH_OPACITY: f64 = 0.35;

/// A drawing with what was found in it.
struct Case {
    drawing: Drawing,
    found: Identification,
    mistakes: Mistakes,
}

/// One picture: a drawing, perhaps with a face in a colour.
struct Cell<'a> {
    drawing: &'a Drawing,
    face: Option<(&'a [Vec<CoEdge>], Rgb)>,
    caption: &'a str,
}

/// The picture of the mistakes in all drawings of the command line, as SVG.
///
/// # Errors
/// [`Failure`], and [`Failure::Usage`] for a drawing without truth.
pub(super) fn picture(args: &RenderArgs) -> Result<String, Failure> {
    let faces = FacesFrom::new(&args.faces);
    let mut cases = Vec::new();
    for name in &args.drawings {
        let drawing = usable(name)?;
        let Some(truth) = &drawing.truth else {
            return Err(Failure::Usage(format!(
                "{name} has no truth to compare with: leave out --mistakes"
            )));
        };
        let found = faces.faces(&drawing)?;
        tell(&found.notices);
        let mistakes = Mistakes::of(truth, &found.faces);
        cases.push(Case {
            drawing,
            found,
            mistakes,
        });
    }
    let cells: Vec<Cell<'_>> = cases.iter().flat_map(Case::cells).collect();
    let width = args.width.map_or(1280.0, f64::from);
    let columns = (((width - 2.0 * MARGIN) / CELL) as usize).max(1);
    let rows = cells.len().div_ceil(columns);
    let below = TITLE + rows as f64 * (CELL + CAPTION) + 12.0;
    let height = args.height.map_or(below + LEGEND, f64::from);
    let mut page = Page::new(width, height);
    draw_title(&mut page, args, &cases);
    for (k, cell) in cells.iter().enumerate() {
        let place = DVec2::new((k % columns) as f64, (k / columns) as f64);
        let corner = DVec2::new(MARGIN, TITLE) + place * DVec2::new(CELL, CELL + CAPTION);
        cell.draw(&mut page, corner, k % columns > 0);
    }
    draw_legend(&mut page, below, &cases);
    Ok(page.to_svg())
}

impl Case {
    /// The drawing alone, then its mistakes.
    fn cells(&self) -> Vec<Cell<'_>> {
        let Self {
            drawing,
            found,
            mistakes,
        } = self;
        let truth = drawing.truth.iter().flat_map(|t| &t.faces);
        let truth: Vec<_> = truth.map(|face| face.loops.as_slice()).collect();
        let own = |f: &usize| found.faces[*f].loops.as_slice();
        let wrong = mistakes.wrong.iter().map(|f| (own(f), WRONG));
        let mistyped = mistakes.mistyped.iter().map(|f| (own(f), MISTYPED));
        let missed = mistakes.missed.iter().map(|f| (truth[*f], MISSED));
        let mut cells = vec![Cell {
            drawing,
            face: None,
            caption: &drawing.id,
        }];
        cells.extend(wrong.chain(mistyped).chain(missed).map(|face| Cell {
            drawing,
            face: Some(face),
            caption: "",
        }));
        cells
    }
}

impl Cell<'_> {
    /// Draws into the square whose upper left corner is given. `ruled` asks for a line at the left
    /// of a drawing that begins within a row.
    fn draw(&self, page: &mut Page, corner: DVec2, ruled: bool) {
        let frame = Frame {
            corner: corner + DVec2::splat(BORDER),
            size: DVec2::splat(CELL - 2.0 * BORDER),
        };
        let edges = &self.drawing.edges;
        let view = View::fit(edges.iter().flat_map(|e| e.points.iter().copied()), frame);
        let solid = |colour, width| Stroke {
            colour,
            width,
            dashed: false,
        };
        let placed = |points: &[DVec2]| points.iter().map(|p| view.place(*p)).collect::<Vec<_>>();
        if let Some((loops, colour)) = self.face {
            let rings = loops.iter().map(|walk| placed(&ring(self.drawing, walk)));
            page.area(&rings.collect::<Vec<_>>(), colour, PATCH_OPACITY, None);
        }
        for edge in edges {
            page.line(&placed(&edge.points), solid(INK, 0.8));
        }
        if let Some((loops, colour)) = self.face {
            for coedge in loops.iter().flatten() {
                page.line(&placed(&edges[coedge.edge()].points), solid(colour, 2.2));
            }
        } else if ruled {
            let ends = [corner, corner + DVec2::new(0.0, CELL)];
            page.line(&ends, solid(QUIET, 0.8));
        }
        let at = corner + DVec2::new(CELL / 2.0, CELL + 2.0);
        page.text(at, self.caption, 11.0, QUIET, Anchor::Middle, false);
    }
}

fn draw_title(page: &mut Page, args: &RenderArgs, cases: &[Case]) {
    let engine = cases.first().map_or("", |case| case.found.engine.as_str());
    let title = args.title.clone().unwrap_or_else(|| {
        let drawings = if cases.len() == 1 {
            "drawing"
        } else {
            "drawings"
        };
        format!("Mistakes of {engine} in {} {drawings}", cases.len())
    });
    let at = DVec2::new(MARGIN, 32.0);
    page.text(at, &title, 18.0, INK, Anchor::Start, false);
}

fn draw_legend(page: &mut Page, top: f64, cases: &[Case]) {
    const SWATCH: f64 = 13.0;
    let count = |of: fn(&Mistakes) -> usize| cases.iter().map(|c| of(&c.mistakes)).sum::<usize>();
    let lists = [
        (WRONG, "wrong loops", count(|m| m.wrong.len())),
        (MISTYPED, "wrong type", count(|m| m.mistyped.len())),
        (MISSED, "missed", count(|m| m.missed.len())),
    ];
    let mut x = MARGIN;
    for (colour, name, number) in lists {
        page.rect(DVec2::new(x, top), DVec2::splat(SWATCH), colour);
        let at = DVec2::new(x + SWATCH + 6.0, top + SWATCH - 2.0);
        let text = format!("{name} {number}");
        page.text(at, &text, 13.0, INK, Anchor::Start, false);
        x += 130.0;
    }
}

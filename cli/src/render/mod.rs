//! `faceformer render`: a picture of a drawing and its faces, or of what is wrong in them.

mod built;
mod mesh;
mod mistakes;
mod owner;
mod page;
mod painter;
mod palette;
mod polygon;
mod raster;
mod solid_view;
mod view;
mod visible;
mod wireframe;

use std::path::Path;

use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::Identification;
use glam::DVec2;

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::Output;
use crate::stages::{FacesFrom, tell, usable};
use built::Built;
use page::{Anchor, Page};
use palette::Rgb;
use view::{Frame, View};

pub(crate) use raster::RasterError as RenderError;
pub(crate) use wireframe::Labels;

/// Blank border of the page and between its parts, in pixels.
const MARGIN: f64 = 24.0;
/// Height of the title, in pixels.
const TITLE: f64 = 52.0;
/// Height of the legend, in pixels.
const LEGEND: f64 = 32.0;
pub(crate) const INK: Rgb = Rgb(34, 38, 43);
const QUIET: Rgb = Rgb(104, 112, 120);

/// Formats of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Svg,
    Png,
}

impl Target {
    fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        match ending.to_ascii_lowercase().as_str() {
            "svg" => Ok(Self::Svg),
            "png" => Ok(Self::Png),
            _ => Err(Failure::Usage(format!(
                "{}: the ending says the format, and must be .svg or .png",
                path.display()
            ))),
        }
    }
}

/// Makes the picture and writes it.
///
/// # Errors
/// [`Failure`].
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let target = Target::of(&args.output)?;
    let output = Output::create(&args.output)?;
    let svg = if args.mistakes {
        mistakes::picture(args)?
    } else {
        faces(args, &output)?
    };
    match target {
        Target::Svg => output.write(svg.as_bytes())?,
        Target::Png => {
            let png = raster::png(&svg)?;
            if !png.has_text {
                eprintln!("faceformer: note: no font is installed, so the picture has no text");
            }
            output.write(&png.bytes)?;
        }
    }
    output.commit()
}

/// The picture of one drawing with its faces, as SVG.
fn faces(args: &RenderArgs, output: &Output) -> Result<String, Failure> {
    let [name] = args.drawings.as_slice() else {
        return Err(Failure::Usage(
            "one picture shows one drawing; several only with --mistakes".to_owned(),
        ));
    };
    let drawing = usable(name)?;
    let mut found = FacesFrom::new(&args.faces).faces(&drawing)?;
    tell(&found.notices);
    let solid = args
        .solid
        .then(|| Built::new(&drawing, &mut found, args.flip, output))
        .transpose()?;
    Ok(picture(args, &drawing, &found, solid.as_ref()).to_svg())
}

/// The whole page: title, panels, legend.
fn picture(
    args: &RenderArgs,
    drawing: &Drawing,
    found: &Identification,
    solid: Option<&Built>,
) -> Page {
    let panels = if solid.is_some() { 2.0 } else { 1.0 };
    let width = args.width.map_or(480.0 + 480.0 * panels, f64::from);
    let points = || drawing.edges.iter().flat_map(|e| e.points.iter().copied());
    let (min, max) = view::bounds(points());
    let inner = (width - (panels + 1.0) * MARGIN) / panels;
    let chrome = TITLE + LEGEND + 2.0 * MARGIN;
    let height = match args.height {
        Some(height) => f64::from(height).max(chrome + 32.0),
        None => {
            let aspect = (max.y - min.y) / (max.x - min.x);
            let aspect = if aspect.is_finite() { aspect } else { 1.0 };
            (chrome + inner * aspect.clamp(0.5, 1.0)).round()
        }
    };
    let mut page = Page::new(width, height);
    let frame = |panel: f64| Frame {
        corner: DVec2::new(MARGIN + panel * (inner + MARGIN), TITLE + MARGIN),
        size: DVec2::new(inner, height - chrome),
    };
    let colours = colours(found);
    let view = View::fit(points(), frame(0.0));
    draw_title(&mut page, args, drawing, found);
    wireframe::draw(
        &mut page,
        &view,
        drawing,
        &found.faces,
        &colours,
        args.labels,
    );
    if let Some(built) = solid {
        built.draw(&mut page, frame(1.0), drawing, found, &colours);
    }
    draw_legend(&mut page, height - LEGEND, drawing, found);
    page
}

/// One colour a face: the hue says the kind, the shade tells faces apart.
fn colours(found: &Identification) -> Vec<Rgb> {
    let mut counts = [0usize; SurfaceKind::ALL.len()];
    found
        .faces
        .iter()
        .map(|face| {
            let n = &mut counts[face.kind as usize];
            *n += 1;
            palette::shade(face.kind, *n - 1)
        })
        .collect()
}

fn draw_title(page: &mut Page, args: &RenderArgs, drawing: &Drawing, found: &Identification) {
    let title = match &args.title {
        Some(title) => title,
        None if drawing.id.is_empty() => &args.drawings[0],
        None => &drawing.id,
    };
    let below = format!(
        "{} edges, {} faces ({})",
        drawing.edges.len(),
        found.faces.len(),
        found.engine
    );
    let at = |y: f64| DVec2::new(MARGIN, y);
    page.text(at(30.0), title, 18.0, INK, Anchor::Start, false);
    page.text(at(50.0), &below, 13.0, QUIET, Anchor::Start, false);
}

fn draw_legend(page: &mut Page, top: f64, drawing: &Drawing, found: &Identification) {
    const SWATCH: f64 = 13.0;
    let mut x = MARGIN;
    let y = top + SWATCH - 2.0;
    for kind in SurfaceKind::ALL {
        let count = found.faces.iter().filter(|f| f.kind == kind).count();
        if count == 0 {
            continue;
        }
        let corner = DVec2::new(x, top);
        page.rect(corner, DVec2::splat(SWATCH), palette::kind_colour(kind));
        let text = format!("{} {count}", kind.name());
        let at = DVec2::new(x + SWATCH + 6.0, y);
        page.text(at, &text, 13.0, INK, Anchor::Start, false);
        // No font is measured here; 7.5 pixels a letter is ample for this size.
        x += SWATCH + 6.0 + 7.5 * text.len() as f64 + 14.0;
    }
    let open = wireframe::open_edges(drawing, &found.faces).len();
    if open > 0 {
        let text = format!("dashed: {open} edges without two faces");
        page.text(DVec2::new(x, y), &text, 13.0, QUIET, Anchor::Start, false);
    }
}

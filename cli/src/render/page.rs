//! A page of shapes, written as SVG.

use std::fmt::Write as _;

use glam::DVec2;

use super::palette::Rgb;

/// Where a text's anchor point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// At the start of the text, on its base line.
    Start,
    /// In the middle of the text, in both directions.
    Middle,
}

/// How lines are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    /// Colour.
    pub(crate) colour: Rgb,
    /// Width in pixels.
    pub(crate) width: f64,
    /// Whether the line is dashed.
    pub(crate) dashed: bool,
}

/// A page in pixels, y downwards; shapes cover the shapes added before them.
#[derive(Debug, Clone)]
pub(crate) struct Page {
    width: f64,
    height: f64,
    body: String,
}

impl Page {
    /// An empty white page of the given size in pixels.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        let mut page = Self {
            width,
            height,
            body: String::new(),
        };
        page.rect(DVec2::ZERO, DVec2::new(width, height), Rgb(255, 255, 255));
        page
    }

    /// Adds an element; the pieces are pixels and colours, so writing to the string cannot fail.
    fn push(&mut self, element: std::fmt::Arguments<'_>) {
        self.body.write_fmt(element).ok();
        self.body.push('\n');
    }

    /// A filled rectangle.
    pub(crate) fn rect(&mut self, corner: DVec2, size: DVec2, fill: Rgb) {
        self.push(format_args!(
            r#"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="{fill}"/>"#,
            corner.x, corner.y, size.x, size.y
        ));
    }

    /// A filled area bounded by rings; a point is inside where an odd number of rings winds around
    /// it. `outline` strokes the rings.
    pub(crate) fn area(
        &mut self,
        rings: &[Vec<DVec2>],
        fill: Rgb,
        opacity: f64,
        outline: Option<Stroke>,
    ) {
        let mut data = String::new();
        for ring in rings {
            path_data(&mut data, ring);
            data.push('Z');
        }
        let outline = outline.map(stroke_attributes).unwrap_or_default();
        self.push(format_args!(
            r#"<path d="{data}" fill="{fill}" fill-opacity="{opacity:.2}" fill-rule="evenodd"{outline}/>"#
        ));
    }

    /// A polyline.
    pub(crate) fn line(&mut self, points: &[DVec2], stroke: Stroke) {
        let mut data = String::new();
        path_data(&mut data, points);
        let stroke = stroke_attributes(stroke);
        self.push(format_args!(r#"<path d="{data}" fill="none"{stroke}/>"#));
    }

    /// A filled circle.
    pub(crate) fn disc(&mut self, center: DVec2, radius: f64, fill: Rgb) {
        self.push(format_args!(
            r#"<circle cx="{:.2}" cy="{:.2}" r="{radius:.2}" fill="{fill}"/>"#,
            center.x, center.y
        ));
    }

    /// A line of text; `size` is the font size in pixels. With `halo` the letters have a white rim
    /// that keeps them readable over lines.
    pub(crate) fn text(
        &mut self,
        at: DVec2,
        text: &str,
        size: f64,
        colour: Rgb,
        anchor: Anchor,
        halo: bool,
    ) {
        // A third of the font size below the centre is the base line of digits centred there;
        // `dominant-baseline` is not known to every viewer.
        let (anchor, y) = match anchor {
            Anchor::Start => ("start", at.y),
            Anchor::Middle => ("middle", at.y + 0.35 * size),
        };
        let text = escape(text);
        let place = format!(
            r#"x="{:.2}" y="{y:.2}" font-size="{size:.1}" font-family="sans-serif" text-anchor="{anchor}""#,
            at.x
        );
        if halo {
            let rim = size * 0.3;
            self.push(format_args!(
                r##"<text {place} fill="none" stroke="#ffffff" stroke-width="{rim:.1}" stroke-linejoin="round">{text}</text>"##
            ));
        }
        self.push(format_args!(
            r#"<text {place} fill="{colour}">{text}</text>"#
        ));
    }

    /// The page as an SVG document.
    pub(crate) fn to_svg(&self) -> String {
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="{w:.0}" height="{h:.0}" "#,
                "viewBox=\"0 0 {w:.0} {h:.0}\">\n{body}</svg>\n"
            ),
            w = self.width,
            h = self.height,
            body = self.body
        )
    }
}

fn path_data(data: &mut String, points: &[DVec2]) {
    for (i, p) in points.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        write!(data, "{command}{:.2} {:.2}", p.x, p.y).ok();
    }
}

fn stroke_attributes(stroke: Stroke) -> String {
    let dash = if stroke.dashed {
        format!(
            r#" stroke-dasharray="{:.1} {:.1}""#,
            4.0 * stroke.width,
            3.0 * stroke.width
        )
    } else {
        String::new()
    };
    format!(
        r#" stroke="{}" stroke-width="{:.2}" stroke-linejoin="round" stroke-linecap="round"{dash}"#,
        stroke.colour, stroke.width
    )
}

/// Escapes markup and drops the control characters that XML does not allow.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_text_stays_text() {
        let mut page = Page::new(10.0, 10.0);
        let black = Rgb(0, 0, 0);
        page.text(DVec2::ZERO, "<&\u{1}\">", 8.0, black, Anchor::Start, false);
        let svg = page.to_svg();
        assert!(svg.contains(">&lt;&amp;&quot;&gt;</text>"), "{svg}");
    }

    #[test]
    fn document_has_size_and_shapes() {
        let mut page = Page::new(120.0, 80.0);
        let stroke = Stroke {
            colour: Rgb(1, 2, 3),
            width: 2.0,
            dashed: true,
        };
        page.line(&[DVec2::new(1.0, 2.0), DVec2::new(3.0, 4.0)], stroke);
        let svg = page.to_svg();
        assert!(svg.contains(r#"viewBox="0 0 120 80""#));
        assert!(svg.contains(r#"d="M1.00 2.00L3.00 4.00""#));
        assert!(svg.contains("stroke-dasharray=\"8.0 6.0\""));
    }
}

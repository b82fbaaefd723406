//! SVG to PNG with resvg.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

/// A picture as PNG.
#[derive(Debug)]
pub(crate) struct Png {
    /// The file's bytes.
    pub(crate) bytes: Vec<u8>,
    /// Whether a font was found; without one the picture has no text.
    pub(crate) has_text: bool,
}

/// Why a page could not become a PNG.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RasterError {
    /// The SVG was not understood.
    #[error("the page is no valid SVG: {0}")]
    Svg(#[from] usvg::Error),
    /// The size is zero or too large for memory.
    #[error("a picture of {0} x {1} pixels cannot be made; choose another --width")]
    Size(u32, u32),
    /// The encoder failed.
    #[error("the PNG encoder failed: {0}")]
    Encode(String),
}

/// Renders an SVG document, one pixel for each of its units.
///
/// # Errors
/// [`RasterError`].
pub(crate) fn png(svg: &str) -> Result<Png, RasterError> {
    let fonts = fonts();
    let has_text = !fonts.is_empty();
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size();
    let mut pixmap = tiny_skia::Pixmap::new(size.width(), size.height())
        .ok_or(RasterError::Size(size.width(), size.height()))?;
    resvg::render(&tree, tiny_skia::Transform::default(), &mut pixmap.as_mut());
    let bytes = pixmap
        .encode_png()
        .map_err(|e| RasterError::Encode(e.to_string()))?;
    Ok(Png { bytes, has_text })
}

/// The system's fonts, with "sans-serif" pointed at one that is there.
fn fonts() -> usvg::fontdb::Database {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_system_fonts();
    let wanted = [
        "DejaVu Sans",
        "Liberation Sans",
        "Noto Sans",
        "Arial",
        "Helvetica",
    ];
    let has = |name: &str| {
        fonts
            .faces()
            .any(|face| face.families.iter().any(|(family, _)| family == name))
    };
    let first = || Some(fonts.faces().next()?.families.first()?.0.clone());
    let family = wanted.iter().find(|name| has(name));
    if let Some(family) = family.map(|f| (*f).to_owned()).or_else(first) {
        fonts.set_sans_serif_family(family);
    }
    fonts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_becomes_a_png_of_its_size() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="30" height="20"/>"#;
        let png = png(svg).unwrap();
        assert_eq!(&png.bytes[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(png.bytes[16..24], [0, 0, 0, 30, 0, 0, 0, 20]);
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(matches!(png("<p/>"), Err(RasterError::Svg(_))));
    }
}

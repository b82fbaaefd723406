//! Placing drawing coordinates on the page.

use glam::DVec2;

/// A box on the page, in pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// Upper left corner.
    pub(crate) corner: DVec2,
    /// Width and height.
    pub(crate) size: DVec2,
}

/// A uniform scaling from coordinates with y upwards into a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    scale: f64,
    center: DVec2,
    page_center: DVec2,
    unit: f64,
}

impl View {
    /// The view that shows all `points` as large as the frame allows, centred in it.
    pub(crate) fn fit(points: impl Iterator<Item = DVec2>, frame: Frame) -> Self {
        let (min, max) = bounds(points);
        let extent = max - min;
        let ratio = |size: f64, extent: f64| {
            if extent > 0.0 {
                size / extent
            } else {
                f64::INFINITY
            }
        };
        let scale = ratio(frame.size.x, extent.x).min(ratio(frame.size.y, extent.y));
        Self {
            scale: if scale.is_finite() { scale } else { 1.0 },
            center: (min + max) / 2.0,
            page_center: frame.corner + frame.size / 2.0,
            unit: (frame.size.min_element() / 52.0).clamp(4.0, 14.0),
        }
    }

    /// A point on the page, in pixels.
    pub(crate) fn place(&self, p: DVec2) -> DVec2 {
        let d = (p - self.center) * self.scale;
        self.page_center + DVec2::new(d.x, -d.y)
    }

    /// Size in pixels that labels and line widths follow: the radius of a label.
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }
}

/// Smallest and largest coordinates; both zero if there are no points.
pub(crate) fn bounds(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    let (min, max) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
        (a.min(p), b.max(p))
    });
    if min.is_finite() && max.is_finite() {
        (min, max)
    } else {
        (DVec2::ZERO, DVec2::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fill_the_frame_upside_down() {
        let frame = Frame {
            corner: DVec2::new(10.0, 20.0),
            size: DVec2::new(200.0, 400.0),
        };
        let corners = [DVec2::ZERO, DVec2::new(2.0, 1.0)];
        let view = View::fit(corners.into_iter(), frame);
        assert_eq!(view.place(corners[0]), DVec2::new(10.0, 270.0));
        assert_eq!(view.place(corners[1]), DVec2::new(210.0, 170.0));
    }

    #[test]
    fn one_point_is_centred() {
        let frame = Frame {
            corner: DVec2::ZERO,
            size: DVec2::splat(100.0),
        };
        let view = View::fit([DVec2::ONE].into_iter(), frame);
        assert_eq!(view.place(DVec2::ONE), DVec2::splat(50.0));
    }
}

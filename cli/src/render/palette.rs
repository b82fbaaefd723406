//! Colours that stay apart for readers with colour vision deficiencies.
//!
//! Every surface kind has its own hue, close to the set of Okabe and Ito (2008), which was chosen
//! to be told apart with the common deficiencies. Faces of one kind differ in lightness and a
//! little in hue, in the perceptual space OKLCH (Ottosson 2020), so equal steps look equal.

use faceformer::drawing::SurfaceKind;

/// An opaque colour, 8 bits a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rgb(pub(crate) u8, pub(crate) u8, pub(crate) u8);

impl std::fmt::Display for Rgb {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

impl Rgb {
    /// The colour with every channel multiplied by `k`, 0 to 1.
    pub(crate) fn scaled(self, k: f64) -> Self {
        let scale = |c: u8| (f64::from(c) * k).round().clamp(0.0, 255.0) as u8;
        Self(scale(self.0), scale(self.1), scale(self.2))
    }
}

/// A predicted face with wrong loops; the three as in the paper's figure, and in the set of Okabe and
/// Ito.
pub(crate) const WRONG: Rgb = Rgb(0, 114, 178);
/// A predicted face of the wrong type.
pub(crate) const MISTYPED: Rgb = Rgb(0, 158, 115);
/// A true face that was not found.
pub(crate) const MISSED: Rgb = Rgb(213, 60, 0);

/// Hue in degrees, half the hue range of the kind's shades, lightness and chroma.
fn base(kind: SurfaceKind) -> (f64, f64, f64, f64) {
    match kind {
        SurfaceKind::Plane => (245.0, 48.0, 0.68, 0.13),
        SurfaceKind::Cylinder => (52.0, 12.0, 0.68, 0.17),
        SurfaceKind::Cone => (162.0, 12.0, 0.66, 0.13),
        SurfaceKind::Sphere => (340.0, 12.0, 0.68, 0.15),
        SurfaceKind::Torus => (100.0, 8.0, 0.82, 0.16),
        SurfaceKind::Other => (0.0, 0.0, 0.62, 0.0),
    }
}

/// The middle shade of a kind, for legends.
pub(crate) fn kind_colour(kind: SurfaceKind) -> Rgb {
    let (hue, _, lightness, chroma) = base(kind);
    oklch(lightness, chroma, hue)
}

/// Shade number `n` of a kind. Steps by the golden ratio keep neighbours in the list apart and
/// need no count in advance.
pub(crate) fn shade(kind: SurfaceKind, n: usize) -> Rgb {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (hue, range, lightness, chroma) = base(kind);
    let t = (n as f64 * GOLDEN).fract();
    let u = (n as f64 * GOLDEN * GOLDEN + 0.5).fract();
    oklch(
        lightness + 0.22 * (u - 0.5),
        chroma,
        hue + 2.0 * range * (t - 0.5),
    )
}

/// OKLCH to sRGB (Ottosson 2020); channels out of range are clipped.
fn oklch(lightness: f64, chroma: f64, hue_degrees: f64) -> Rgb {
    let (sin, cos) = hue_degrees.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let encode = |linear: f64| {
        let v = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        (v.clamp(0.0, 1.0) * 255.0).round() as u8
    };
    Rgb(
        encode(4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s),
        encode(-1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s),
        encode(-0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_axis_and_primaries_are_right() {
        assert_eq!(oklch(1.0, 0.0, 0.0), Rgb(255, 255, 255));
        assert_eq!(oklch(0.0, 0.0, 0.0), Rgb(0, 0, 0));
        // sRGB red is OKLCH (0.62796, 0.25768, 29.234) in Ottosson's article.
        assert_eq!(oklch(0.627_96, 0.257_68, 29.234), Rgb(255, 0, 0));
    }

    #[test]
    fn kinds_and_neighbouring_shades_differ() {
        let far = |a: Rgb, b: Rgb| {
            let d = |x: u8, y: u8| f64::from(x.abs_diff(y)).powi(2);
            (d(a.0, b.0) + d(a.1, b.1) + d(a.2, b.2)).sqrt()
        };
        for (i, &a) in SurfaceKind::ALL.iter().enumerate() {
            for &b in &SurfaceKind::ALL[..i] {
                assert!(far(kind_colour(a), kind_colour(b)) > 60.0, "{a:?} {b:?}");
            }
            for n in 0..20 {
                assert!(far(shade(a, n), shade(a, n + 1)) > 8.0, "{a:?} {n}");
            }
        }
    }
}

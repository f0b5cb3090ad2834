//! Colours that readers with any colour vision tell apart, and colour maps.

/// Red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Black.
pub const BLACK: Colour = Colour(0, 0, 0);
/// White.
pub const WHITE: Colour = Colour(255, 255, 255);
/// A grey for guides.
pub const GREY: Colour = Colour(0x80, 0x80, 0x80);
/// A light grey for what has no value.
pub const LIGHT_GREY: Colour = Colour(0xe4, 0xe4, 0xe4);
/// Okabe–Ito blue.
pub const BLUE: Colour = Colour(0x00, 0x72, 0xb2);
/// Okabe–Ito vermillion.
pub const VERMILLION: Colour = Colour(0xd5, 0x5e, 0x00);
/// Okabe–Ito bluish green.
pub const GREEN: Colour = Colour(0x00, 0x9e, 0x73);
/// Okabe–Ito reddish purple.
pub const PURPLE: Colour = Colour(0xcc, 0x79, 0xa7);
/// Okabe–Ito orange.
pub const ORANGE: Colour = Colour(0xe6, 0x9f, 0x00);
/// Okabe–Ito sky blue.
pub const SKY: Colour = Colour(0x56, 0xb4, 0xe9);

/// The order in which series take their colours.
pub const SERIES: [Colour; 7] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK];

/// The dashes of the k-th line (pt drawn, pt left out): full, long, dotted, longer; then again. Seven colours and four patterns
/// make 28 lines that differ.
pub fn pattern(k: usize) -> Option<(f64, f64)> {
    [None, Some((4.5, 1.8)), Some((1.6, 1.4)), Some((8.0, 2.2))][k % 4]
}

/// The mixture (1 − t) a + t b, t in [0, 1].
pub fn mix(a: Colour, b: Colour, t: f64) -> Colour {
    let t = t.clamp(0.0, 1.0);
    let channel = |a: u8, b: u8| (f64::from(a) + t * (f64::from(b) - f64::from(a))).round() as u8;
    Colour(channel(a.0, b.0), channel(a.1, b.1), channel(a.2, b.2))
}

/// A map of [0, 1] for curves of a family: dark blue, purple, orange.
pub fn sequential(t: f64) -> Colour {
    const DARK: Colour = Colour(0x1a, 0x2a, 0x6c);
    let t = t.clamp(0.0, 1.0);
    if t < 0.5 { mix(DARK, PURPLE, 2.0 * t) } else { mix(PURPLE, ORANGE, 2.0 * t - 1.0) }
}

/// A diverging map of [−1, 1]: blue, white, red, of equal lightness on both sides.
pub fn diverging(v: f64) -> Colour {
    let t = if v.is_finite() { v.clamp(-1.0, 1.0) } else { 0.0 };
    let hue = if t < 0.0 { 255.0_f64 } else { 28.0 }.to_radians();
    let s = t.abs();
    let lightness = 0.975 - 0.53 * libm::pow(s, 1.25);
    let chroma = 0.165 * libm::sin(1.35 * s);
    oklab(lightness, chroma * libm::cos(hue), chroma * libm::sin(hue))
}

/// A cyclic map of an angle (rad): the hue circle at nearly equal lightness; 0 is red, π green-blue.
pub fn cyclic(phi: f64) -> Colour {
    let phi = if phi.is_finite() { phi } else { 0.0 };
    let hue = phi + 25.0_f64.to_radians();
    let lightness = 0.70 + 0.10 * libm::cos(phi - 1.5);
    oklab(lightness, 0.125 * libm::cos(hue), 0.125 * libm::sin(hue))
}

/// A direction, as in the page: hue in the plane, 0 along +x red, lightness along z: a warm white up, a blue black down.
pub fn direction([x, y, z]: [f64; 3]) -> Colour {
    let across = libm::hypot(x, y).min(1.0);
    let hue = libm::atan2(y, x) + 0.4363;
    let (low, high) = (0.38 * libm::pow((-z).max(0.0), 1.5), 0.29 * libm::pow(z.max(0.0), 1.5));
    let chroma = 0.14 * libm::pow(across, 0.8);
    let tint = if z > 0.0 { 0.03 } else { -0.07 } * z * z * z * z;
    oklab(0.67 + high - low, chroma * libm::cos(hue), chroma * libm::sin(hue) + tint)
}

/// From Oklab (Ottosson 2020): lightness and two opponent axes.
fn oklab(l: f64, a: f64, b: f64) -> Colour {
    let cube = |v: f64| v * v * v;
    let long = cube(l + 0.3963377774 * a + 0.2158037573 * b);
    let medium = cube(l - 0.1055613458 * a - 0.0638541728 * b);
    let short = cube(l - 0.0894841775 * a - 1.2914855480 * b);
    Colour(
        gamma(4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short),
        gamma(-1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short),
        gamma(-0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short),
    )
}

/// Linear red, green and blue in Oklab.
#[cfg(test)]
pub(super) fn oklab_of([r, g, b]: [f64; 3]) -> [f64; 3] {
    let long = libm::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    let medium = libm::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    let short = libm::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    [
        0.2104542553 * long + 0.7936177850 * medium - 0.0040720468 * short,
        1.9779984951 * long - 2.4285922050 * medium + 0.4505937099 * short,
        0.0259040371 * long + 0.7827717662 * medium - 0.8086757660 * short,
    ]
}

/// The sRGB transfer curve.
fn gamma(linear: f64) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    let s = if v <= 0.0031308 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (255.0 * s).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_diverging_map_is_white_in_the_middle_and_blue_and_red_at_the_ends() {
        let Colour(r, g, b) = diverging(0.0);
        assert!(r.min(g).min(b) > 240);
        let (cold, warm) = (diverging(-1.0), diverging(1.0));
        assert!(cold.2 > cold.0 && warm.0 > warm.2);
    }

    #[test]
    fn the_cyclic_map_closes() {
        use std::f64::consts::PI;
        assert_eq!(cyclic(-PI), cyclic(PI));
    }
}

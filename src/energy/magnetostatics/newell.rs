//! The demagnetising tensor of equal cuboid cells in a row, per volume of a cell.
//!
//! ```text
//! N_xx(n) = −(4πV)⁻¹ δ²_x δ²_y δ²_z f(x, y, z) at x = n a, y = z = 0      δ²: second differences by a cell's edges
//! f(x, y, z) = ½y(z² − x²) arsinh(y/√(x² + z²)) + ½z(y² − x²) arsinh(z/√(x² + y²)) − xyz arctan(yz/xr) + ⅙(2x² − y² − z²) r
//! ```
//! (N_yy and N_zz by exchanging the axes; on the row itself the tensor is diagonal.) The energy of two cells is
//! μ₀ Ms² V m₁·N(n) m₂, of one ½ μ₀ Ms² V m·N(0) m.
//! Newell, Williams, Dunlop, J. Geophys. Res. 98, 9551 (1993), doi:10.1029/93JB00694.
//!
//! The differences cancel all but a part 1/n⁶ of f, so they are taken in double-double arithmetic; from six diagonals of a
//! cell on, the multipole series of [`super::series`] takes over.

use crate::linalg::DoubleDouble;

type Dd = DoubleDouble;

/// N(n) = (xx, yy, zz) of cells with edges 1 × width × thickness (in units of their spacing), n cells apart.
pub fn cell_tensor(n: usize, width: f64, thickness: f64) -> [f64; 3] {
    let [zero, width, thickness] = [0.0, width, thickness].map(Dd::from);
    let scale = Dd::from(-4.0 * std::f64::consts::PI) * width * thickness;
    differences(n, [(zero, -2.0), (width, 2.0)], [(zero, -2.0), (thickness, 2.0)]).map(|s| (s / scale).to_f64())
}

/// G(n) = (xx, yy, zz) of two cells on one axis, n spacings apart, each 1 long, with these widths and thicknesses (in units of the
/// spacing): N(n)/V where they are equal.
pub fn pair_tensor(n: usize, a: [f64; 2], b: [f64; 2]) -> [f64; 3] {
    let half = Dd::from(0.5);
    let edges = |c: usize| {
        let (p, q) = (Dd::from(a[c].max(b[c])), Dd::from(a[c].min(b[c])));
        [(half * (p - q), -2.0), (half * (p + q), 2.0)]
    };
    let volumes = Dd::from(a[0]) * Dd::from(a[1]) * Dd::from(b[0]) * Dd::from(b[1]);
    let scale = Dd::from(-4.0 * std::f64::consts::PI) * volumes;
    differences(n, edges(0), edges(1)).map(|s| (s / scale).to_f64())
}

/// Σ of Newell's f for xx, yy and zz over the second differences of cells n apart: lengths and weights across and through.
fn differences(n: usize, across: [(Dd, f64); 2], through: [(Dd, f64); 2]) -> [Dd; 3] {
    let mut sums = [Dd::from(0.0); 3];
    let m = n as f64;
    for (x, along) in [(m - 1.0, 1.0), (m, -2.0), (m + 1.0, 1.0)] {
        for (y, across) in across {
            for (z, through) in through {
                let weight = Dd::from(along * across * through);
                let x = Dd::from(x.abs());
                for (sum, value) in sums.iter_mut().zip([newell_f(x, y, z), newell_f(y, x, z), newell_f(z, x, y)]) {
                    *sum = *sum + weight * value;
                }
            }
        }
    }
    sums
}

/// Newell's f for lengths that are not negative.
fn newell_f(x: Dd, y: Dd, z: Dd) -> Dd {
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let r = (xx + yy + zz).sqrt();
    let half = Dd::from(0.5);
    let one = half * y * (zz - xx) * arsinh(y, (xx + zz).sqrt(), r);
    let two = half * z * (yy - xx) * arsinh(z, (xx + yy).sqrt(), r);
    let area = x * y * z;
    let three = if area.to_f64() > 0.0 { area * (y * z / (x * r)).atan() } else { Dd::from(0.0) };
    one + two - three + (xx + xx - yy - zz) * r / Dd::from(6.0)
}

/// arsinh(y/ρ) with r² = y² + ρ²; 0 where ρ is 0, for there its factor is.
fn arsinh(y: Dd, rho: Dd, r: Dd) -> Dd {
    if rho.to_f64() == 0.0 || y.to_f64() == 0.0 { Dd::from(0.0) } else { ((y + r) / rho).ln() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::magnetostatics::series::Series;

    /// (width, thickness, n, xx, yy, zz) from the closed form in 60-digit arithmetic.
    const EXACT: [(f64, f64, usize, [f64; 3]); 12] = [
        (1.0, 1.0, 1, [-0.13501718054449527, 0.06750859027224763, 0.06750859027224763]),
        (1.0, 1.0, 7, [-0.00046392442065692514, 0.00023196221032846257, 0.00023196221032846257]),
        (1.0, 1.0, 30, [-5.894624338776225e-06, 2.9473121693881123e-06, 2.9473121693881123e-06]),
        (1.0, 1.0, 100_000, [-1.5915494309189533e-16, 7.957747154594767e-17, 7.957747154594767e-17]),
        (4.0, 1.0, 0, [0.4457729842637608, 0.10845403147247845, 0.4457729842637608]),
        (4.0, 1.0, 3, [-0.014365738158045841, 0.005454053715739347, 0.008911684442306495]),
        (4.0, 1.0, 20, [-7.812462318742958e-05, 3.870239328551103e-05, 3.942222990191855e-05]),
        (4.0, 1.0, 1000, [-6.366149977709338e-10, 3.183063052407016e-10, 3.183086925302322e-10]),
        (0.5, 20.0, 0, [0.34551952365451744, 0.6384243236867282, 0.016056152658754368]),
        (0.5, 20.0, 2, [-0.021874421309568164, 0.020003817707294886, 0.001870603602273277]),
        (0.5, 20.0, 100, [-1.5607748317917471e-06, 7.880352374323538e-07, 7.727395943593934e-07]),
        (0.5, 20.0, 1000, [-1.5912326083551858e-09, 7.956958002928488e-10, 7.955368080623372e-10]),
    ];

    #[test]
    fn near_and_far_the_tensor_has_the_value_of_sixty_digit_arithmetic() {
        for (width, thickness, n, exact) in EXACT {
            let series = Series::of_cells(width, thickness);
            let found = if n < series.first() { cell_tensor(n, width, thickness) } else { series.at(n as f64) };
            for c in 0..3 {
                let error = (found[c] / exact[c] - 1.0).abs();
                assert!(error < 2e-15, "{width} × {thickness}, {n}: {:e} {:e}, off by {error:e}", found[c], exact[c]);
            }
        }
    }

    #[test]
    fn the_closed_form_and_the_multipole_series_agree_where_one_takes_over_from_the_other() {
        for (width, thickness) in [(1.0, 1.0), (4.0, 1.0), (0.2, 0.3), (0.5, 20.0)] {
            let series = Series::of_cells(width, thickness);
            for n in series.first()..series.first() + 3 {
                let (near, far) = (cell_tensor(n, width, thickness), series.at(n as f64));
                for c in 0..3 {
                    assert!((near[c] / far[c] - 1.0).abs() < 1e-14, "{width} × {thickness}, {n}: {near:?} {far:?}");
                }
            }
        }
    }

    #[test]
    fn the_self_term_has_trace_one_a_cube_a_third_each_and_other_cells_trace_zero() {
        for (width, thickness) in [(1.0, 1.0), (4.0, 1.0), (0.01, 3.0), (7.0, 0.3)] {
            assert!((cell_tensor(0, width, thickness).iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for n in [1, 2, 9] {
                let t = cell_tensor(n, width, thickness);
                assert!(t.iter().sum::<f64>().abs() < 1e-15 * t[0].abs());
            }
        }
        assert!(cell_tensor(0, 1.0, 1.0).iter().all(|n| (n - 1.0 / 3.0).abs() < 1e-16));
    }

    /// Aharoni's demagnetising factor along c of a prism with half edges a, b, c.
    /// J. Appl. Phys. 83, 3432 (1998), doi:10.1063/1.367113, eq. (1).
    fn aharoni(a: f64, b: f64, c: f64) -> f64 {
        let r = (a * a + b * b + c * c).sqrt();
        let [ab, bc, ac] = [(a * a + b * b).sqrt(), (b * b + c * c).sqrt(), (a * a + c * c).sqrt()];
        let ln = |x: f64| x.ln();
        let sum = (b * b - c * c) / (2.0 * b * c) * ln((r - a) / (r + a))
            + (a * a - c * c) / (2.0 * a * c) * ln((r - b) / (r + b))
            + b / (2.0 * c) * ln((ab + a) / (ab - a))
            + a / (2.0 * c) * ln((ab + b) / (ab - b))
            + c / (2.0 * a) * ln((bc - b) / (bc + b))
            + c / (2.0 * b) * ln((ac - a) / (ac + a))
            + 2.0 * (a * b / (c * r)).atan()
            + (a * a * a + b * b * b - 2.0 * c * c * c) / (3.0 * a * b * c)
            + (a * a + b * b - 2.0 * c * c) / (3.0 * a * b * c) * r
            + c / (a * b) * (ac + bc)
            - (ab * ab * ab + bc * bc * bc + ac * ac * ac) / (3.0 * a * b * c);
        sum / std::f64::consts::PI
    }

    #[test]
    fn a_prism_has_aharonis_factors_as_one_cell_and_as_a_row_of_cells() {
        for (width, thickness) in [(1.0, 1.0), (2.0, 1.0), (0.5, 3.0), (4.0, 1.0)] {
            let exact =
                [aharoni(width, thickness, 1.0), aharoni(1.0, thickness, width), aharoni(1.0, width, thickness)];
            let cell = cell_tensor(0, width, thickness);
            for c in 0..3 {
                assert!((cell[c] - exact[c]).abs() < 1e-13, "{cell:?} {exact:?}");
            }
            let (length, series) = (200, Series::of_cells(width, thickness));
            let at = |n: usize| if n < series.first() { cell_tensor(n, width, thickness) } else { series.at(n as f64) };
            let mut row = cell.map(|n| n * length as f64);
            for n in 1..length {
                for (sum, v) in row.iter_mut().zip(at(n)) {
                    *sum += 2.0 * (length - n) as f64 * v;
                }
            }
            let l = length as f64;
            let exact = [aharoni(width, thickness, l), aharoni(l, thickness, width), aharoni(l, width, thickness)];
            for c in 0..3 {
                assert!((row[c] / l - exact[c]).abs() < 1e-11, "{row:?} {exact:?}");
            }
        }
    }
}

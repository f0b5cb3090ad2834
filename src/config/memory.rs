//! How much memory a run needs, estimated before anything is allocated.

use std::fs;

/// Memory that is taken for granted where the system does not say (bytes).
const USUAL: f64 = 64e9;

/// Memory of one image (bytes): spins, gradients, forces, tangents and moves of the band, and its banded Hessian with its
/// factors; `reach` is how many sites away the furthest partner is.
pub fn image_bytes(sites: usize, reach: usize, periodic: bool) -> f64 {
    let vectors = 14 * 3 * size_of::<f64>();
    // 2 rows a site, each with the blocks up to the furthest partner; a folded ring has twice the width.
    let width = 2 * (reach + 1) * if periodic { 2 } else { 1 };
    let hessian = 2 * 2 * (width + 4) * size_of::<f64>();
    sites as f64 * (vectors + hessian) as f64
}

/// Memory of the Hessian's couplings of distant sites, and their factors (bytes), as many at a time as there are threads;
/// `state` is how many numbers they pass through at a site, and none where they are all pairs.
pub fn far_bytes(sites: usize, state: Option<usize>, threads: usize) -> f64 {
    let a_site = state.map_or(2.0 * 4.0 * sites as f64, |s| 2.0 * (4 * s + 12) as f64);
    a_site * (sites * size_of::<f64>()) as f64 * (2 * threads) as f64
}

/// Memory of the energy (bytes): coefficients of its terms and constant blocks.
pub fn hamiltonian_bytes(sites: usize, reach: usize, terms: usize) -> f64 {
    let blocks = 9 * (reach + 1) * size_of::<f64>();
    let coefficients = 2 * (terms + reach) * size_of::<f64>();
    // The states, and what building the sum takes on the way.
    let states = 8 * 3 * size_of::<f64>();
    sites as f64 * (blocks + coefficients + states) as f64
}

/// What a run of `images` images needs (bytes).
pub fn run_bytes(sites: usize, images: usize, reach: usize, terms: usize, periodic: bool) -> f64 {
    hamiltonian_bytes(sites, reach, terms) + images as f64 * image_bytes(sites, reach, periodic)
}

/// What this machine has (bytes); a usual amount where that is not known.
pub fn machine_bytes() -> f64 {
    let text = fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let total =
        text.lines().find_map(|line| line.strip_prefix("MemTotal:")?.strip_suffix("kB")?.trim().parse::<f64>().ok());
    total.map_or(USUAL, |kib| 1024.0 * kib)
}

/// Bytes as a person would say them: `1.5 GB`.
pub fn shown(bytes: f64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB", "EB"];
    let power = ((bytes.max(1.0).log10() / 3.0).floor() as usize).min(units.len() - 1);
    let value = bytes / 1000f64.powi(power as i32);
    if value < 10.0 { format!("{value:.1} {}", units[power]) } else { format!("{value:.0} {}", units[power]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_shown_with_a_unit_that_fits() {
        for (bytes, expected) in
            [(0.0, "0.0 B"), (999.0, "999 B"), (1500.0, "1.5 kB"), (2e10, "20 GB"), (3e24, "3000000 EB")]
        {
            assert_eq!(shown(bytes), expected);
        }
    }
}

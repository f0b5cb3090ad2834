//! How much memory a run needs, estimated before anything is allocated.

use crate::error::{Error, Result};
use crate::linalg::Layout;
use std::fs;
use std::path::Path;

/// Memory that is taken for granted where the system does not say (bytes).
const USUAL: f64 = 64e9;
/// Where none is factorised: matrices of an energy that are kept at a time, and bands, of first paths that wait.
const MATRICES: usize = 4;
const BANDS: usize = 3;
/// Limits of a process that its memory counts against, as `/proc/self/limits` names them.
const LIMITS: [&str; 2] = ["Max address space", "Max data size"];

/// Memory of the images of a band (bytes): spins, gradients, forces, tangents and moves, and the Hessian of each with its factors;
/// where those are no band, of as many images as so many threads prepare ahead, of blocks of so many as are made at a time.
pub fn band_bytes(images: usize, sites: usize, layout: &Layout, factors: usize, threads: usize) -> f64 {
    let (factored, hessian) = match layout {
        // 2 rows a site, each with the blocks up to the furthest partner
        Layout::Band { span, .. } => (images, sites * 2 * 2 * (2 * span + 6) * size_of::<f64>()),
        Layout::Sparse(plan) if factors == 0 => (MATRICES, plan.matrix_bytes()),
        Layout::Sparse(plan) => (images.min(factors), plan.bytes(1)),
        Layout::Dense => (images.min(2 * threads), 2 * 4 * sites * sites * size_of::<f64>()),
    };
    let bands = if factors == 0 { BANDS } else { 1 };
    images_bytes(images * bands, sites) + factored as f64 * hessian as f64
}

/// Memory of so many images alone, their forces and moves (bytes).
pub fn images_bytes(images: usize, sites: usize) -> f64 {
    images as f64 * (sites * 14 * 3 * size_of::<f64>()) as f64
}

/// Memory of the Hessian's couplings of distant sites, and their factors (bytes), as many at a time as there are threads;
/// `state` is how many numbers they pass through at a site, and none where they are all pairs.
pub fn far_bytes(sites: usize, state: Option<usize>, threads: usize) -> f64 {
    let a_site = state.map_or(2.0 * 4.0 * sites as f64, |s| 2.0 * (4 * s + 12) as f64);
    a_site * (sites * size_of::<f64>()) as f64 * (2 * threads) as f64
}

/// Memory of the energy (bytes): coefficients of its terms and constant blocks, of so many bonds a site.
pub fn hamiltonian_bytes(sites: usize, reach: usize, terms: usize) -> f64 {
    let blocks = 9 * (reach + 1) * size_of::<f64>();
    let coefficients = 2 * (terms + reach) * size_of::<f64>();
    // The states, and what building the sum takes on the way.
    let states = 8 * 3 * size_of::<f64>();
    sites as f64 * (blocks + coefficients + states) as f64
}

/// Refuses what no memory can hold (bytes), of so many sites, whose number is given at `extent`; and of the path's images, where it has come to them: how many, and
/// whether an automatic path begins with them.
pub fn affordable(bytes: f64, sites: usize, extent: &str, images: Option<(usize, bool)>) -> Result<()> {
    let Some(whose) = exceeded(bytes) else { return Ok(()) };
    let (place, what, way_out) = match images {
        None => (extent, format!("{sites} sites"), ""),
        Some((n, true)) => {
            let what = format!("{sites} sites with the {n} images that an automatic path begins with");
            (extent, what, ": give fewer as \"images\" of \"path\"")
        }
        Some((n, false)) => ("path.images", format!("{sites} sites and {n} images"), ""),
    };
    let message = format!("{what} need about {} of memory, more than {whose}{way_out}", shown(bytes));
    Err(Error::invalid(place, message))
}

/// Who does not give so many bytes, in words: the machine, the limits of the process (`ulimit -v`, `-d`) or its control group
/// (a container, a batch job); nothing where there is room.
pub fn exceeded(bytes: f64) -> Option<String> {
    let read = |path: &Path| fs::read_to_string(path).unwrap_or_default();
    first_exceeded(
        bytes,
        machine(&read(Path::new("/proc/meminfo"))),
        process(&read(Path::new("/proc/self/limits"))),
        control_group(&read(Path::new("/proc/self/cgroup")), read),
    )
}

fn first_exceeded(bytes: f64, machine: Option<f64>, process: Option<f64>, group: Option<f64>) -> Option<String> {
    let below = |most: &f64| *most < bytes;
    if below(&machine.unwrap_or(USUAL)) {
        return Some("this machine has".into());
    }
    let allowed = |whose: &str, most: f64| format!("{whose} may have, {}", shown(most));
    let process = process.filter(below).map(|most| allowed("this process (ulimit)", most));
    process.or_else(|| group.filter(below).map(|most| allowed("its control group (a container, a batch job)", most)))
}

fn machine(meminfo: &str) -> Option<f64> {
    let total = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:")?.strip_suffix("kB"));
    total?.trim().parse::<f64>().ok().map(|kib| 1024.0 * kib)
}

/// The smallest of the limits on a process's memory.
fn process(limits: &str) -> Option<f64> {
    let soft = |line: &str| {
        let rest = LIMITS.iter().find_map(|name| line.strip_prefix(name))?;
        rest.split_whitespace().next()?.parse::<f64>().ok()
    };
    limits.lines().filter_map(soft).min_by(f64::total_cmp)
}

/// The smallest limit of a process's control group and of those that it is in; of either version, and seen from inside a
/// container, where the group is the root.
fn control_group(groups: &str, read: impl Fn(&Path) -> String) -> Option<f64> {
    let of = |line: &str| {
        let (kinds, group) = line.split_once(':')?.1.split_once(':')?;
        let (root, file) = match kinds {
            "" => ("/sys/fs/cgroup", "memory.max"),
            _ if kinds.split(',').any(|kind| kind == "memory") => ("/sys/fs/cgroup/memory", "memory.limit_in_bytes"),
            _ => return None,
        };
        let within = Path::new(group.trim_start_matches('/')).ancestors();
        let limits =
            within.filter_map(|group| read(&Path::new(root).join(group).join(file)).trim().parse::<f64>().ok());
        limits.min_by(f64::total_cmp)
    };
    groups.lines().filter_map(of).min_by(f64::total_cmp)
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
    fn what_a_run_can_have_ends_at_the_machine_the_process_and_its_control_group() {
        assert_eq!(machine("MemTotal:       24684096 kB\nMemFree: 1 kB\n"), Some(24684096.0 * 1024.0));
        let limits = "Max data size             unlimited            unlimited            bytes\n\
                      Max open files            1024                 4096                 files\n\
                      Max address space         2000000000           unlimited            bytes\n";
        assert_eq!(process(limits), Some(2e9));
        assert_eq!(process(&limits.replace("2000000000", "unlimited ")), None);
        // version 2: the group itself has no limit, that around it has
        let read = |path: &Path| match path.to_str() {
            Some("/sys/fs/cgroup/job/step/memory.max") => "max\n".into(),
            Some("/sys/fs/cgroup/job/memory.max") => "4000000000\n".into(),
            Some("/sys/fs/cgroup/memory/batch/7/memory.limit_in_bytes") => "3000000000\n".into(),
            Some("/sys/fs/cgroup/memory/memory.limit_in_bytes") => "9223372036854771712\n".into(),
            _ => String::new(),
        };
        assert_eq!(control_group("0::/job/step\n", read), Some(4e9));
        // version 1, beside an empty version 2, and inside a container where the group is the root
        assert_eq!(control_group("9:cpu:/job\n4:cpu,memory:/batch/7\n0::/\n", read), Some(3e9));
        assert_eq!(control_group("4:memory:/elsewhere\n", read), Some(9223372036854771712.0));
        assert_eq!(control_group("0::/\n", |_| "max\n".into()), None);
        let whose = |bytes, process, group| first_exceeded(bytes, Some(8e9), process, group);
        assert_eq!(whose(1e10, Some(2e9), None).unwrap(), "this machine has");
        assert_eq!(whose(3e9, Some(2e9), Some(1e9)).unwrap(), "this process (ulimit) may have, 2.0 GB");
        let group = "its control group (a container, a batch job) may have, 1.0 GB";
        assert_eq!(whose(3e9, None, Some(1e9)).unwrap(), group);
        assert_eq!(whose(3e9, None, Some(4e9)), None);
        assert!(first_exceeded(2.0 * USUAL, None, None, None).is_some());
    }

    #[test]
    fn bytes_are_shown_with_a_unit_that_fits() {
        for (bytes, expected) in
            [(0.0, "0.0 B"), (999.0, "999 B"), (1500.0, "1.5 kB"), (2e10, "20 GB"), (3e24, "3000000 EB")]
        {
            assert_eq!(shown(bytes), expected);
        }
    }
}

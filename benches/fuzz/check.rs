//! What must hold of every result, whatever the config: its files agree with each other and with what is promised of them.

use super::arrays::{self, Numbers};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// J in a meV and meV in a K.
const J_PER_MEV: f64 = 1.602176634e-22;
const K_B_MEV: f64 = 8.617333262e-2;
/// Rounding of a sum of energies, in parts of the sum of their sizes.
const ROUNDING: f64 = 1e-12;

/// What is wrong with a result, a line a fault.
#[derive(Default)]
pub struct Faults {
    /// What no result may have.
    pub found: Vec<String>,
    /// What a result without a certificate may have: saddles that do not tell the barrier, or out of order.
    pub doubtful: Vec<String>,
}

impl Faults {
    fn unless(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.found.push(what());
        }
    }

    /// Makes what was found from here on doubtful alone.
    fn doubt(&mut self, from: usize) {
        self.doubtful.extend(self.found.drain(from..));
    }

    fn near(&mut self, what: &str, a: f64, b: f64, tolerance: f64) {
        self.unless((a - b).abs() <= tolerance, || format!("{what}: {a:?} is not {b:?} (to {tolerance:.1e})"));
    }
}

/// A result as its files tell it.
struct Stored<'a> {
    summary: &'a Value,
    config: &'a Value,
    table: BTreeMap<String, Vec<f64>>,
    arrays: BTreeMap<String, Numbers>,
    /// Size of the energies of one image (meV).
    scale: f64,
}

impl Stored<'_> {
    fn flag(&self, key: &str) -> bool {
        self.summary[key] == true
    }

    /// Whether the ends were relaxed.
    fn relaxed(&self) -> bool {
        self.config["relax_ends"] != false
    }

    fn above(&self) -> &[f64] {
        &self.table["energy_above_initial_meV"]
    }
}

/// All that is wrong with the result in a folder: `line` is what `--json` said of it, `least` what the energies of an image are
/// made of, at least (meV), where they cancel.
pub fn faults(folder: &Path, line: &Value, least: f64) -> Faults {
    let mut faults = Faults::default();
    match read(folder, &mut faults) {
        Err(what) => faults.found.push(what),
        Ok((summary, config, table, arrays)) => {
            let size = |k: usize| -> f64 { terms(&table).map(|(_, column)| column[k].abs()).sum() };
            let scale = (0..table["image"].len()).map(size).fold(least, f64::max);
            let stored = Stored { summary: &summary, config: &config, table, arrays, scale };
            said(&stored, line, &mut faults);
            tables(&stored, &mut faults);
            units(&stored, &mut faults);
            certificate(&stored, &mut faults);
            rates(&stored, &mut faults);
            let from = faults.found.len();
            barrier(&stored, &mut faults);
            saddles(&stored, &mut faults);
            if !stored.flag("certified") {
                faults.doubt(from);
            }
        }
    }
    faults
}

type Table = BTreeMap<String, Vec<f64>>;

/// The energies by term.
fn terms(table: &Table) -> impl Iterator<Item = (&String, &Vec<f64>)> {
    table.iter().filter(|(name, _)| {
        name.ends_with("_meV")
            && !["energy_meV", "max_perpendicular_torque_meV", "energy_above_initial_meV"].contains(&name.as_str())
    })
}

fn read(folder: &Path, faults: &mut Faults) -> Result<(Value, Value, Table, BTreeMap<String, Numbers>), String> {
    let bytes = |name: &str| fs::read(folder.join(name)).map_err(|e| format!("{name}: {e}"));
    let json = |name: &str| serde_json::from_slice::<Value>(&bytes(name)?).map_err(|e| format!("{name}: {e}"));
    let (summary, config) = (json("summary.json")?, json("config.json")?);
    let hash = |name: &str| -> Result<String, String> {
        Ok(Sha256::digest(bytes(name)?).iter().map(|b| format!("{b:02x}")).collect())
    };
    let own = hash("config.json")?;
    faults.unless(summary["config_sha256"] == own.as_str(), || "config_sha256 is not that of config.json".into());
    for (name, told) in summary["manifest"]["files"].as_object().ok_or("there is no manifest")? {
        let found = hash(name)?;
        faults.unless(*told == found.as_str(), || format!("{name} is not the file of the manifest"));
    }
    let members = arrays::members(&bytes("path.npz")?).ok_or("path.npz is no archive")?;
    let mut found = BTreeMap::new();
    for (name, content) in members {
        let array = arrays::array(&content).ok_or_else(|| format!("path.npz: {name} is no array"))?;
        faults.unless(array.values.iter().all(|v| v.is_finite()), || format!("path.npz: {name} is not finite"));
        found.insert(name.trim_end_matches(".npy").to_string(), array);
    }
    for name in ["profile.csv", "history.csv", "magnetisation.csv"] {
        table(name, &bytes(name)?)?;
    }
    // one term has no parts to show
    if folder.join("energy_terms.csv").exists() {
        table("energy_terms.csv", &bytes("energy_terms.csv")?)?;
    }
    Ok((summary, config, table("path.csv", &bytes("path.csv")?)?, found))
}

/// Columns of finite numbers under their names.
fn table(name: &str, bytes: &[u8]) -> Result<Table, String> {
    let text = std::str::from_utf8(bytes).map_err(|e| format!("{name}: {e}"))?;
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().ok_or_else(|| format!("{name} is empty"))?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); header.len()];
    for (k, cells) in lines.enumerate() {
        let numbers: Option<Vec<f64>> = cells.iter().map(|c| c.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match numbers.filter(|n| n.len() == header.len()) {
            Some(numbers) => columns.iter_mut().zip(numbers).for_each(|(column, x)| column.push(x)),
            None => return Err(format!("{name}: row {k}: {cells:?}")),
        }
    }
    Ok(header.iter().map(|name| name.to_string()).zip(columns).collect())
}

/// What the line of JSON says.
const KEYS: [&str; 5] = ["name", "exit_code", "barrier_meV", "converged", "certified"];

/// The exit code says what the summary says, and so does the line of JSON.
fn said(stored: &Stored, line: &Value, faults: &mut Faults) {
    let code = if stored.flag("converged") && stored.flag("certified") { 0 } else { 3 };
    for (key, value) in line.as_object().into_iter().flatten() {
        if let Some(other) = stored.summary.get(key) {
            faults.unless(value == other, || format!("--json says {key}: {value}, the summary {other}"));
        }
    }
    // the lines of a sweep have an index instead of a name, and one exit code for all
    let keys = if line.get("index").is_some() { &KEYS[2..] } else { &KEYS };
    for key in keys {
        faults.unless(line.get(key).is_some(), || format!("--json does not say {key}"));
    }
    if let Some(told) = line.get("exit_code") {
        faults.unless(*told == code, || format!("exit code {told} where the summary says {code}"));
    }
    let warned = stored.summary["warnings"].as_array().is_some_and(|w| !w.is_empty());
    let silent = stored.flag("converged") && !stored.flag("certified") && !warned;
    faults.unless(!silent, || "no certificate, and no warning says why".into());
    faults.unless(stored.summary["stop_reason"].as_str().is_some_and(|s| !s.is_empty()), || "no stop_reason".into());
}

/// `path.csv` and `path.npz` have the same numbers, a row an image, and those are the path's.
fn tables(stored: &Stored, faults: &mut Faults) {
    let images = stored.summary["path"]["images"].as_u64().unwrap_or(0) as usize;
    for (name, column) in &stored.table {
        faults.unless(column.len() == images, || format!("path.csv: {} rows of {images} images", column.len()));
        if name != "image" {
            let same = stored.arrays.get(name).is_some_and(|a| a.values == *column);
            faults.unless(same, || format!("path.npz: {name} is not the column of path.csv"));
        }
    }
    let Some(spins) = stored.arrays.get("spins") else { return faults.found.push("path.npz has no spins".into()) };
    let sites = stored.config["lattice"]["chain"]["sites"].as_u64().unwrap_or(0) as usize;
    faults.unless(spins.shape == [images, sites, 3], || format!("path.npz: spins of shape {:?}", spins.shape));
    if images == 0 || faults.found.iter().any(|f| f.contains("shape")) {
        return;
    }
    let (unit, far) = spins.values.chunks(3).fold((0.0f64, 0), |(worst, n), v| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        (worst.max((length - 1.0).abs()), n + usize::from(length == 0.0))
    });
    faults.unless(unit < 1e-14 || far > 0, || format!("a spin's length is off by {unit:.1e}"));
    let coordinate = &stored.table["reaction_coordinate_rad"];
    let mut length = 0.0;
    for (k, pair) in spins.values.chunks(3 * sites).collect::<Vec<_>>().windows(2).enumerate() {
        length += pair[0].chunks(3).zip(pair[1].chunks(3)).map(|(a, b)| angle(a, b).powi(2)).sum::<f64>().sqrt();
        faults.near(
            &format!("reaction coordinate of image {}", k + 1),
            coordinate[k + 1],
            length,
            1e-9 * (1.0 + length),
        );
    }
    faults.near("path.length_rad", number(&stored.summary["path"]["length_rad"]), coordinate[images - 1], 0.0);
    let (energy, above, scale) = (&stored.table["energy_meV"], stored.above(), stored.scale);
    for k in 0..images {
        let sum: f64 = terms(&stored.table).map(|(_, column)| column[k]).sum();
        faults.near(&format!("energy of image {k} and the sum of its terms"), energy[k], sum, ROUNDING * scale);
        let difference = energy[k] - energy[0];
        faults.near(&format!("energy of image {k} above the initial one"), above[k], difference, ROUNDING * scale);
    }
    for (end, k) in [("initial", 0), ("final", images - 1)] {
        let told = number(&stored.summary[end]["energy_meV"]);
        faults.near(&format!("{end}.energy_meV and its image"), told, energy[k], ROUNDING * scale);
    }
}

/// The angle between two vectors, also where it is small.
fn angle(a: &[f64], b: &[f64]) -> f64 {
    let norm = |f: fn(f64, f64) -> f64| (0..3).map(|c| f(a[c], b[c]).powi(2)).sum::<f64>().sqrt();
    2.0 * norm(|x, y| x - y).atan2(norm(|x, y| x + y))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A barrier is told in three units, and never negative.
fn units(stored: &Stored, faults: &mut Faults) {
    let (summary, scale) = (stored.summary, stored.scale);
    if summary["barrier_meV"].is_null() {
        faults.unless(!stored.flag("certified"), || "certified without a barrier".into());
        for key in ["barrier_J", "barrier_K"] {
            faults.unless(summary[key].is_null(), || format!("{key} without barrier_meV"));
        }
        return;
    }
    let [forward, backward] = ["forward", "backward"].map(|way| number(&summary["barrier_meV"][way]));
    for (way, mev) in [("forward", forward), ("backward", backward)] {
        faults.near(
            &format!("barrier_J {way}"),
            number(&summary["barrier_J"][way]),
            mev * J_PER_MEV,
            1e-15 * mev.abs() * J_PER_MEV,
        );
        faults.near(
            &format!("barrier_K {way}"),
            number(&summary["barrier_K"][way]),
            mev / K_B_MEV,
            1e-15 * mev.abs() / K_B_MEV,
        );
        let least = if stored.relaxed() { -ROUNDING * scale } else { f64::NEG_INFINITY };
        faults.unless(mev >= least, || format!("a barrier of {mev:?} meV {way}"));
    }
}

/// The barrier is the highest saddle above both ends.
fn barrier(stored: &Stored, faults: &mut Faults) {
    let (summary, scale) = (stored.summary, stored.scale);
    if summary["barrier_meV"].is_null() {
        return;
    }
    let [forward, backward] = ["forward", "backward"].map(|way| number(&summary["barrier_meV"][way]));
    let saddles = summary["saddles"].as_array().map_or(&[][..], Vec::as_slice);
    let top = |key: &str| saddles.iter().map(|s| number(&s[key])).fold(f64::NEG_INFINITY, f64::max);
    if saddles.is_empty() {
        // states that a symmetry turns into each other
        let flat = forward.abs().max(backward.abs()) <= ROUNDING * scale;
        faults.unless(flat, || "a barrier without a saddle".into());
        return;
    }
    let above = top("energy_above_initial_meV");
    faults.near("barrier forward and the top saddle", forward, above, ROUNDING * scale);
    let [initial, last] = ["initial", "final"].map(|end| number(&summary[end]["energy_meV"]));
    faults.near("barrier forward", forward, top("energy_meV") - initial, ROUNDING * scale);
    faults.near("barrier backward", backward, top("energy_meV") - last, ROUNDING * scale);
}

/// What a certificate promises.
fn certificate(stored: &Stored, faults: &mut Faults) {
    if !stored.flag("certified") {
        return;
    }
    let summary = stored.summary;
    let top = number(&summary["barrier_meV"]["forward"]);
    let (image, highest) = stored
        .above()
        .iter()
        .enumerate()
        .fold((0, f64::NEG_INFINITY), |best, (k, e)| if *e > best.1 { (k, *e) } else { best });
    faults.unless(highest <= top + ROUNDING * stored.scale, || {
        format!("certified, but image {image} lies {:.3e} meV above the top saddle", highest - top)
    });
    if stored.relaxed() {
        for end in ["initial", "final"] {
            faults.unless(summary[end]["negative_modes"] == 0, || format!("certified, but {end} is no minimum"));
        }
    }
    let list = |key: &str| summary[key].as_array().map_or(&[][..], Vec::as_slice);
    let (minima, saddles) = (list("intermediate_minima"), list("saddles"));
    if unproven(summary) || !stored.relaxed() {
        return;
    }
    for (what, entries, modes) in [("minimum", minima, 0), ("saddle", saddles, 1)] {
        for (k, entry) in entries.iter().enumerate() {
            let negative = entry["negative_modes"].as_u64();
            let flat = what == "saddle" && negative == Some(0) && entry["zero_modes"].as_u64() > Some(0);
            faults.unless(negative == Some(modes) || flat, || {
                format!("certified, but {what} {k} has {} negative modes", entry["negative_modes"])
            });
        }
    }
    let between = saddles.len() == minima.len() + 1 || saddles.is_empty();
    faults.unless(between, || format!("certified: {} saddles and {} minima between", saddles.len(), minima.len()));
}

/// Whether a certified path has a dip beside its saddles that nobody looked at: a minimum without a count of its modes.
pub fn unproven(summary: &Value) -> bool {
    let minima = summary["intermediate_minima"].as_array().map_or(&[][..], Vec::as_slice);
    summary["certified"] == true && minima.iter().any(|m| m["negative_modes"].is_null())
}

/// Saddles are on the path, in order, and so are the minima; two may be at one place where the path is coarse.
fn saddles(stored: &Stored, faults: &mut Faults) {
    let (images, length) = (stored.above().len(), number(&stored.summary["path"]["length_rad"]));
    let list = |key: &str| stored.summary[key].as_array().map_or(&[][..], Vec::as_slice);
    for key in ["saddles", "intermediate_minima"] {
        let mut last = 0.0;
        for (k, entry) in list(key).iter().enumerate() {
            let image = entry["image"].as_u64();
            faults.unless(image < Some(images as u64), || format!("{key}[{k}].image: {}", entry["image"]));
            let at = number(&entry["reaction_coordinate_rad"]);
            let on = at >= last && (0.0..=length * (1.0 + 1e-9) + 1e-9).contains(&at);
            faults.unless(on, || format!("{key}[{k}] at {at:?} rad, behind {last:?} of {length:?}"));
            last = at;
        }
    }
}

/// What soft modes that are pinned by U, with a top A, take of a state's volume at a temperature (K): of each the mean of
/// e^(−(A sin²πx + ¼(U − A) sin²2πx)/k_BT).
fn soft(modes: &Value, t: f64) -> f64 {
    const POINTS: usize = 4096;
    let one = |curved_mev: f64, top_mev: f64| {
        let [slow, fast] = [top_mev, 0.25 * (curved_mev - top_mev)].map(|mev| mev / (K_B_MEV * t));
        let at = |k: usize| {
            let x = PI * k as f64 / POINTS as f64;
            (-slow * x.sin().powi(2) - fast * (2.0 * x).sin().powi(2)).exp()
        };
        (0..POINTS).map(at).sum::<f64>() / POINTS as f64
    };
    let of = |mode: &Value, key: &str| mode[key].as_array().into_iter().flatten().map(number).collect::<Vec<f64>>();
    let entries = modes.as_array().into_iter().flatten();
    entries
        .flat_map(|mode| of(mode, "pinning_meV").into_iter().zip(of(mode, "top_meV")))
        .map(|(u, a)| one(u, a))
        .product()
}

/// Rates are over proven saddles, and follow from their own prefactors.
fn rates(stored: &Stored, faults: &mut Faults) {
    let saddles = stored.summary["saddles"].as_array().map_or(&[][..], Vec::as_slice);
    let entries = |key: &str| stored.summary[key].as_array().cloned().unwrap_or_default();
    for (k, entry) in entries("rates").iter().enumerate() {
        let what = format!("rates[{k}]");
        let theories = ["htst", "langer"];
        let known = theories.map(|t| entry[format!("{t}_prefactor_Hz")].as_f64());
        let saddle = entry["saddle"].as_u64().and_then(|s| saddles.get(s as usize));
        faults.unless(saddle.is_some(), || format!("{what} over a saddle that is not there"));
        if known.iter().any(Option::is_some) {
            let negative = saddle.and_then(|s| s["negative_modes"].as_u64());
            faults.unless(negative == Some(1), || format!("{what} over a saddle with {negative:?} negative modes"));
        }
        let near = entry["nearly_equivalent_saddles"].as_array().into_iter().flatten();
        let siblings: Vec<[f64; 2]> = near.map(|s| [number(&s["above_meV"]), number(&s["saddles"])]).collect();
        let many = |t: f64| {
            let weights = siblings.iter().map(|[above, count]| count * (-above / (K_B_MEV * t)).exp());
            number(&entry["equivalent_saddles"]) + weights.sum::<f64>()
        };
        let first = number(&entry["prefactor_temperature_K"]);
        let exponent = number(&entry["prefactor_temperature_exponent"]);
        let changes: Vec<f64> = entry["soft_modes_change_at_K"].as_array().into_iter().flatten().map(number).collect();
        let told = |t: f64| changes.iter().all(|at| (*at < t) == (*at < first));
        let held = |t: f64| soft(&entry["saddle_zero_modes"], t) / soft(&entry["minimum_zero_modes"], t);
        for row in entry["temperatures"].as_array().into_iter().flatten() {
            let (t, delta) = (number(&row["temperature_K"]), number(&row["barrier_over_kT"]));
            faults.near(
                &format!("{what}: ΔE/k_BT"),
                delta,
                number(&entry["barrier_meV"]) / (K_B_MEV * t),
                1e-12 * delta.abs(),
            );
            for (theory, prefactor) in theories.iter().zip(known) {
                let rate = row[format!("{theory}_rate_per_s")].as_f64();
                faults.unless(rate.is_none() || prefactor.is_some(), || {
                    format!("{what}: a rate by {theory} without a prefactor")
                });
                faults.unless(rate.is_none() || delta >= 1.0, || format!("{what}: a rate at ΔE = {delta} k_BT"));
                if let (Some(rate), Some(prefactor), true) = (rate, prefactor, told(t)) {
                    let wanted =
                        many(t) * prefactor * (t / first).powf(exponent) * held(t) / held(first) * (-delta).exp();
                    faults.near(&format!("{what}: rate by {theory}"), rate, wanted, 1e-9 * wanted + 1e-300);
                }
            }
            lifetime(row, &what, faults);
        }
    }
    for (k, entry) in entries("transition_rates").iter().enumerate() {
        let what = format!("transition_rates[{k}]");
        let rows = entry["temperatures"].as_array().cloned().unwrap_or_default();
        let told =
            rows.iter().any(|row| ["htst_rate_per_s", "langer_rate_per_s"].iter().any(|key| row[*key].is_number()));
        faults.unless(!told || stored.flag("certified"), || format!("{what} without a certificate"));
        faults.unless(!told || entry["refused"].is_null(), || format!("{what} refused and given"));
    }
}

/// The mean lifetime is the inverse of the rate, and null where there is none.
fn lifetime(row: &Value, what: &str, faults: &mut Faults) {
    let rate = row["langer_rate_per_s"].as_f64().or(row["htst_rate_per_s"].as_f64());
    match (rate, row["lifetime_s"].as_f64()) {
        (None, told) => faults.unless(told.is_none(), || format!("{what}: a lifetime without a rate")),
        (Some(rate), Some(told)) => faults.near(&format!("{what}: lifetime"), told * rate, 1.0, 1e-9),
        // a rate that a double does not hold
        (Some(rate), None) => faults.unless(rate < 1e-300, || format!("{what}: a rate without a lifetime")),
    }
}

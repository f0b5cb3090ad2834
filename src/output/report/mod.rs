//! `report.html`: the result as one page that needs nothing but a browser: summary, energy profile, map and the spins in 3D along
//! the path.
//!
//! Style, scripts and data are in the page itself, and its policy (Content-Security-Policy) forbids everything else: no network, no
//! script but the one whose SHA-256 it names. Data are JSON in which `<`, `>` and `&` are escaped, and the scripts put words from the
//! run into the page as text only, so that nothing in a config becomes markup. A long path is [thinned](shown) and the page says so.
//! Time and threads are left out: the page of a config is always the same, byte for byte.

mod landscape;
mod pack;
mod shown;

pub(super) use landscape::landscape_page;

use super::csv::{CHARGE, path_columns};
use super::summary::{J_PER_MEV, K_B_MEV};
use super::{Certainty, Format, RunReport, SummaryJson};
use crate::base64::base64;
use crate::drive::Outcome;
use crate::error::{Error, Result};
use crate::geometry::{Direction, vector};
use crate::lattice::Lattice;
use pack::{column, packed};
use serde::Serialize;
use serde_json::Value;
use sha2::{Digest, Sha256};
use shown::{Shown, evenly};

const PAGE: &str = concat!(include_str!("head.html"), include_str!("page.html"));
/// The picture of the spins, with its tools.
const VIEW: &str = include_str!("view.html");
const STYLE: &str = include_str!("page.css");
/// One module, the scripts that show spins and then these; the order is that of use.
macro_rules! script {
    ($($own:literal),*) => {
        concat!(
            include_str!("base.js"),
            include_str!("path.js"),
            include_str!("colour.js"),
            include_str!("scene.js"),
            include_str!("webgl.js"),
            include_str!("flat.js"),
            include_str!("view.js"),
            $(include_str!($own)),*
        )
    };
}
use script;
const SCRIPT: &str = script!("chart.js", "summary.js", "page.js", "choices.js", "run.js");
/// A longer config is not repeated in the page (bytes).
const LONGEST_CONFIG: usize = 40_000;
/// Most points of the interpolated curve.
const CURVE: usize = 2000;

/// `report.html`.
#[derive(Clone, Copy, Debug)]
pub struct ReportPage;

impl Format for ReportPage {
    fn file_name(&self) -> String {
        "report.html".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        page([PAGE, STYLE, SCRIPT], run.name, &data(run)?)
    }
}

/// A page of a template, a style and a script.
fn page([template, style, script]: [&str; 3], title: &str, data: &impl Serialize) -> Result<Vec<u8>> {
    let json = serde_json::to_string(data).map_err(|e| Error::Numerical(format!("report.html: {e}")))?;
    let policy = format!(
        "default-src 'none'; img-src data: blob:; style-src {}; script-src {}; base-uri 'none'; form-action 'none'",
        hash(style),
        hash(script)
    );
    let content = |name: &str| match name {
        "policy" => Some(policy.clone()),
        "title" => Some(markup(title)),
        // a long name may go on in the next line behind these
        "heading" => Some(markup(title).replace('_', "_<wbr>").replace('.', ".<wbr>")),
        "style" => Some(style.into()),
        "view" => Some(VIEW.into()),
        "data" => Some(inert(&json)),
        "script" => Some(script.into()),
        _ => None,
    };
    filled(template, content).map(String::into_bytes)
}

/// What the scripts read; the names of numbers have their units.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Data {
    summary: Value,
    barrier_told: Option<Told>,
    moved: Vec<String>,
    config: Option<String>,
    material: Material,
    sites: usize,
    images: usize,
    periodic: bool,
    spacing_nm: Option<f64>,
    direction: [f64; 3],
    lattice: Option<Film>,
    vacant: Vec<usize>,
    frozen: Vec<usize>,
    sites_shown: Vec<usize>,
    images_shown: Vec<usize>,
    reaction_coordinate_rad: String,
    energy_above_initial_meV: String,
    max_perpendicular_torque_meV: String,
    terms: Vec<Term>,
    profile: Curve,
    profile_points: usize,
    spins: Spins,
}

/// A barrier that is not certified, as it may be told: in meV, J and K.
#[derive(Serialize)]
struct Told {
    forward: [String; 3],
    backward: [String; 3],
}

/// A film or crystal: what it is, where its shown sites are, in distances of neighbours from the middle, and the topological charge of
/// its shown images.
#[derive(Serialize)]
struct Film {
    words: String,
    places: String,
    charge: Option<String>,
}

#[derive(Serialize)]
struct Material {
    name: Option<String>,
    source: Option<String>,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct Term {
    name: String,
    above_initial_meV: String,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct Curve {
    reaction_coordinate_rad: String,
    energy_above_initial_meV: String,
}

#[derive(Serialize)]
struct Spins {
    scale: f64,
    packed: String,
}

fn data(run: &RunReport) -> Result<Data> {
    let (outcome, lattice) = (run.outcome, run.lattice);
    let (t, path) = (&outcome.images, &outcome.path);
    let shown = Shown::of(outcome, lattice);
    let of = |name: &str, values: &[f64]| column(name, shown.images.iter().filter_map(|k| values.get(*k).copied()));
    let terms = t.terms_mev.iter().map(|(name, energy)| {
        let start = energy.first().copied().unwrap_or(0.0);
        let above: Vec<f64> = energy.iter().map(|e| e - start).collect();
        Ok(Term { name: name.clone(), above_initial_meV: of(name, &above)? })
    });
    Ok(Data {
        summary: summary(run)?,
        barrier_told: told(outcome),
        moved: Certainty::of(outcome).moved_words().collect(),
        config: (run.config_text.len() <= LONGEST_CONFIG).then(|| run.config_text.into()),
        material: material(run.config_text),
        sites: path.sites(),
        images: path.images(),
        periodic: lattice.is_ring(),
        spacing_nm: lattice.spacing_nm,
        direction: if lattice.is_row() { lattice.direction() } else { Direction::X }.vector(),
        lattice: (!lattice.is_row()).then(|| film(run, &shown)).transpose()?,
        vacant: shown.sites.iter().copied().filter(|i| lattice.vacant.get(*i) == Some(&true)).collect(),
        frozen: shown.among(lattice.frozen.iter().flat_map(|f| &f.sites).copied()),
        reaction_coordinate_rad: of("reaction_coordinate_rad", &t.reaction_coordinate_rad)?,
        energy_above_initial_meV: of("energy_above_initial_meV", &t.above_initial_mev)?,
        max_perpendicular_torque_meV: of("max_perpendicular_torque_meV", &t.max_perpendicular_torque_mev)?,
        terms: terms.collect::<Result<_>>()?,
        profile: curve(outcome)?,
        profile_points: outcome.profile.len(),
        spins: Spins { scale: pack::SCALE, packed: packed(path, &shown.images, &shown.sites)? },
        sites_shown: shown.sites,
        images_shown: shown.images,
    })
}

fn film(run: &RunReport, shown: &Shown) -> Result<Film> {
    let lattice = run.lattice;
    let columns = path_columns(run).into_iter().find(|(name, _)| name == CHARGE);
    let charge = columns.map(|(name, all)| column(&name, shown.images.iter().map(|k| all[*k])));
    Ok(Film {
        words: lattice.words(),
        places: places(lattice, &shown.sites, shown.stride)?,
        charge: charge.transpose()?,
    })
}

/// Where sites of a film or crystal are, of which every so manieth is shown, in distances of neighbours from the middle.
fn places(lattice: &Lattice, sites: &[usize], stride: usize) -> Result<String> {
    let bonds = lattice.shell(1).into_iter().map(|family| vector::norm(family.along));
    let nearest = bonds.fold(f64::INFINITY, f64::min);
    let stride = if lattice.atoms.len() == 1 { stride } else { 1 };
    let apart = stride as f64 * if nearest.is_finite() { nearest } else { lattice.spacing_nm.unwrap_or(1.0) };
    let middle = vector::scale(lattice.spacing_nm.unwrap_or(1.0), lattice.middle());
    let place = |i: &usize| vector::scale(1.0 / apart, vector::sub(lattice.position(*i), middle));
    column("places", sites.iter().flat_map(place))
}

fn told(outcome: &Outcome) -> Option<Told> {
    let (barrier, certainty) = (outcome.barrier?, Certainty::of(outcome));
    let units = |mev: f64| {
        let units = [(1.0, "meV"), (J_PER_MEV, "J"), (1.0 / K_B_MEV, "K (E/k_B)")];
        units.map(|(per_mev, unit)| format!("{} {unit}", certainty.number(mev, per_mev, 10)))
    };
    let both = || Told { forward: units(barrier.forward_mev), backward: units(barrier.backward_mev) };
    (!certainty.is_certified()).then(both)
}

/// Keys of an entry of `rates` that the page shows: of a row of many saddles the others would be most of its size.
const RATE_KEYS: [&str; 8] = [
    "saddle",
    "direction",
    "barrier_meV",
    "htst_prefactor_Hz",
    "langer_prefactor_Hz",
    "equivalent_saddles",
    "refused",
    "warnings",
];

/// `summary.json` but for what depends on the machine, what the page does not show, and warnings that repeat an earlier saddle's.
fn summary(run: &RunReport) -> Result<Value> {
    let mut summary: Value =
        serde_json::from_slice(&SummaryJson.render(run)?).map_err(|e| Error::Numerical(format!("report.html: {e}")))?;
    if let Some(work) = summary.get_mut("work").and_then(Value::as_object_mut) {
        work.retain(|key, _| key != "seconds" && key != "threads");
    }
    let mut said: Vec<Value> = Vec::new();
    for rate in summary.get_mut("rates").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(rate) = rate.as_object_mut() else { continue };
        rate.retain(|key, _| RATE_KEYS.contains(&key.as_str()));
        let warnings = rate.get("warnings").cloned().unwrap_or_default();
        match said.iter().position(|w| *w == warnings) {
            Some(earlier) => {
                rate.insert("warnings".into(), Value::Array(Vec::new()));
                rate.insert("warnings_as".into(), earlier.into());
            }
            None => said.push(warnings),
        }
    }
    Ok(summary)
}

/// Name and source of the material, as the config has them.
fn material(config: &str) -> Material {
    let config: Value = serde_json::from_str(config).unwrap_or_default();
    let text = |key: &str| config.get("material")?.get(key)?.as_str().map(String::from);
    Material { name: text("name"), source: text("source") }
}

fn curve(outcome: &Outcome) -> Result<Curve> {
    let kept: Vec<_> = evenly(outcome.profile.len(), CURVE).into_iter().map(|k| outcome.profile[k]).collect();
    Ok(Curve {
        reaction_coordinate_rad: column("profile", kept.iter().map(|p| p.reaction_coordinate_rad))?,
        energy_above_initial_meV: column("profile", kept.iter().map(|p| p.above_initial_mev))?,
    })
}

/// The source expression of a policy that allows exactly this text.
fn hash(text: &str) -> String {
    format!("'sha256-{}'", base64(&Sha256::digest(text.as_bytes())))
}

/// Text as it stands between tags.
fn markup(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// JSON that cannot end the element it stands in, nor a line of a script. Outside strings JSON has none of these characters.
fn inert(json: &str) -> String {
    let escape = |text: String, c: char| text.replace(c, &format!("\\u{:04x}", u32::from(c)));
    ['<', '>', '&', '\u{2028}', '\u{2029}'].into_iter().fold(json.into(), escape)
}

/// The template with `{{name}}` replaced by its content, which is not looked at again.
fn filled(template: &str, content: impl Fn(&str) -> Option<String>) -> Result<String> {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_string();
    for part in parts {
        let known = part.split_once("}}").and_then(|(name, rest)| Some((content(name)?, rest)));
        let (text, rest) = known.ok_or_else(|| Error::Numerical("report.html: a place without content".into()))?;
        page += &text;
        page += rest;
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_asks_for_nothing_from_elsewhere() {
        for text in [PAGE, STYLE, SCRIPT, VIEW].into_iter().chain(landscape::PARTS) {
            for load in [
                "http:",
                "https:",
                "\"//",
                "'//",
                "(//",
                "@import",
                "url(",
                "import(",
                "fetch(",
                "XMLHttp",
                "WebSocket",
            ] {
                assert!(!text.contains(load), "{load}");
            }
        }
        for script in [SCRIPT, landscape::PARTS[2]] {
            assert!(!script.contains("innerHTML") && !script.contains("</script") && !script.contains("eval("));
        }
        assert!(!STYLE.contains("</style"));
    }

    #[test]
    fn page_style_and_script_are_below_110_kb() {
        assert!(PAGE.len() + STYLE.len() + SCRIPT.len() < 110_000);
    }

    #[test]
    fn json_is_inert_and_means_the_same() {
        let words = "</script><!-- & \u{2028}\u{2029} \\ \" 'µ' {{data}}";
        let json = serde_json::to_string(words).unwrap();
        let safe = inert(&json);
        assert!(!safe.contains(['<', '>', '&', '\u{2028}', '\u{2029}']));
        assert_eq!(serde_json::from_str::<String>(&safe).unwrap(), words);
    }

    #[test]
    fn content_is_not_looked_at_again_and_an_unknown_place_is_an_error() {
        let content = |name: &str| (name == "a").then(|| "{{a}}".to_string());
        assert_eq!(filled("x{{a}}y{{a}}", content).unwrap(), "x{{a}}y{{a}}");
        assert!(filled("{{b}}", content).is_err());
    }
}

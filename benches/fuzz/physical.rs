//! Configs that mean something: small ones of every kind, with values, terms, sites, states and settings changed within their range.

use rand::{RngExt, seq::IndexedRandom};
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value, json};
use std::fs;
use std::path::Path;

/// The longest chain; most are much shorter.
const MOST_SITES: usize = 30;

/// Small editions of the shipped configs of chains, their materials written out.
pub struct Physical {
    seeds: Vec<Value>,
}

impl Physical {
    /// From the folder of the shipped configs.
    pub fn new(configs: &Path) -> Physical {
        let mut paths: Vec<_> = fs::read_dir(configs).expect("configs").map(|e| e.expect("an entry").path()).collect();
        paths.retain(|p| p.extension().is_some_and(|e| e == "json"));
        paths.sort();
        // what is changed below speaks of chains
        let is_chain = |config: &Value| config["lattice"]["chain"].is_object();
        let seeds = paths.iter().map(|p| with_material(&read(p), configs)).filter(is_chain).collect();
        Physical { seeds }
    }

    /// A config of at most 30 sites: one of the shipped ones made smaller, with up to six changes.
    pub fn config(&self, name: &str, r: &mut ChaCha8Rng) -> Value {
        let mut config = self.seeds.choose(r).expect("a config").clone();
        let sites = sites(r);
        resize(&mut config, sites);
        config["name"] = json!(name);
        config["output"] = output(r);
        for _ in 0..r.random_range(0..=6) {
            change(&mut config, r);
        }
        config
    }
}

fn read(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("a config")).expect("JSON")
}

fn with_material(config: &Value, configs: &Path) -> Value {
    let mut config = config.clone();
    if let Some(path) = config["material"].as_str().filter(|name| name.ends_with(".json")) {
        config["material"] = read(&configs.join(path));
    }
    config
}

/// Short chains are quick, and have the same code to go through.
fn sites(r: &mut ChaCha8Rng) -> usize {
    match r.random_range(0..10) {
        0..6 => r.random_range(2..=10),
        6..9 => r.random_range(8..=18),
        _ => r.random_range(1..=MOST_SITES),
    }
}

fn output(r: &mut ChaCha8Rng) -> Value {
    let mut formats = vec!["csv", "npz"];
    let more = ["ovf", "ovf_text", "ovf_binary4", "ovf_images", "spins_csv", "vtk", "html"];
    formats.extend(more.into_iter().filter(|_| r.random_range(0..12) == 0));
    let plots: &[&str] = if r.random_range(0..12) == 0 { &["svg"] } else { &[] };
    json!({"formats": formats, "plots": plots})
}

/// The chain gets another length, and all places in it go along.
fn resize(config: &mut Value, sites: usize) {
    let old = config["lattice"]["chain"]["sites"].as_f64().expect("a number of sites");
    let scale = (sites as f64 - 1.0) / (old - 1.0).max(1.0);
    move_places(config, scale);
    config["lattice"]["chain"]["sites"] = json!(sites);
}

fn move_places(value: &mut Value, scale: f64) {
    let moved = |v: &mut Value| {
        if let Some(n) = v.as_u64() {
            *v = json!((n as f64 * scale).round() as u64);
        } else if let Some(x) = v.as_f64() {
            *v = json!(x * scale);
        }
    };
    match value {
        Value::Array(values) => values.iter_mut().for_each(|v| move_places(v, scale)),
        Value::Object(members) => {
            for (key, v) in members {
                match (key.as_str(), &mut *v) {
                    ("sites", Value::Array(list)) => {
                        list.iter_mut().for_each(moved);
                        list.dedup();
                    }
                    ("sites", Value::Object(range)) => range.values_mut().for_each(moved),
                    ("center", v) => moved(v),
                    (_, v) => move_places(v, scale),
                }
            }
        }
        _ => {}
    }
}

/// One thing becomes another one.
fn change(config: &mut Value, r: &mut ChaCha8Rng) {
    let n = config["lattice"]["chain"]["sites"].as_u64().unwrap_or(1) as usize;
    match r.random_range(0..22) {
        0..5 => scale_a_quantity(config, r),
        5..8 => {
            let term = term(config, n, r);
            if !config["energy"].is_array() {
                config["energy"] = json!([]);
            }
            config["energy"].as_array_mut().expect("a list").push(term);
        }
        8 => {
            let place = if r.random() { &mut config["material"] } else { &mut *config };
            // a material of the library is a name
            if let Some(terms) = place.get_mut("energy").and_then(Value::as_array_mut).filter(|t| !t.is_empty()) {
                terms.remove(r.random_range(0..terms.len()));
            }
        }
        9 => resize(config, sites(r)),
        10 => {
            let (initial, last) = (config["initial"].take(), config["final"].take());
            (config["initial"], config["final"]) = (last, initial);
        }
        11..14 => {
            let end = ["initial", "final"][r.random_range(0..2)];
            config[end] = state(n, r);
        }
        14 => lattice(&mut config["lattice"]["chain"], n, r),
        15 => config["relax_ends"] = json!(r.random_range(0..3) > 0),
        16..18 => path(object(config, "path"), n, r),
        18 => neb(object(config, "neb"), r),
        19 => {
            let key = ["refine", "certify"][r.random_range(0..2)];
            object(config, "saddle").insert(key.into(), json!(r.random::<bool>()));
        }
        _ => config["rates"] = rates(r),
    }
}

/// An object under a key, made if it is not there.
fn object<'a>(config: &'a mut Value, key: &str) -> &'a mut Map<String, Value> {
    if !config[key].is_object() {
        config[key] = json!({});
    }
    config[key].as_object_mut().expect("an object")
}

/// All texts that are a number and a unit.
fn quantities<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::String(text) if text.split_once(' ').is_some_and(|(number, _)| number.parse::<f64>().is_ok()) => {
            found.push(value);
        }
        Value::Array(values) => values.iter_mut().for_each(|v| quantities(v, found)),
        Value::Object(members) => members.values_mut().for_each(|v| quantities(v, found)),
        _ => {}
    }
}

fn scale_a_quantity(config: &mut Value, r: &mut ChaCha8Rng) {
    let mut found = Vec::new();
    quantities(config, &mut found);
    if found.is_empty() {
        return;
    }
    let value = found.swap_remove(r.random_range(0..found.len()));
    let factor = match r.random_range(0..12) {
        0 => 0.0,
        1 | 2 => -1.0,
        _ => 2f64.powf(r.random_range(-3.0..3.0)),
    };
    let (number, unit) = value.as_str().and_then(|text| text.split_once(' ')).expect("a quantity");
    *value = json!(format!("{} {unit}", number.parse::<f64>().expect("a number") * factor));
}

/// A direction: often an axis, else anything.
fn direction(r: &mut ChaCha8Rng) -> Value {
    match r.random_range(0..8) {
        0 => json!([1, 0, 0]),
        1 => json!([0, -1, 0]),
        2 | 3 => json!([0, 0, 1]),
        4 | 5 => json!([0, 0, -1]),
        _ => json!([r.random_range(-1.0..1.0), r.random_range(-1.0..1.0), r.random_range(0.1..1.0)]),
    }
}

/// Some sites of a chain.
fn some_sites(n: usize, r: &mut ChaCha8Rng) -> Value {
    let a = r.random_range(0..n);
    match r.random_range(0..3) {
        0 => json!([a]),
        1 => json!({"from": a, "to": r.random_range(a..n)}),
        _ => {
            let chosen: Vec<usize> = (0..n).filter(|_| r.random_range(0..3) == 0).collect();
            json!(if chosen.is_empty() { vec![a] } else { chosen })
        }
    }
}

fn term(config: &Value, n: usize, r: &mut ChaCha8Rng) -> Value {
    // the units of a continuum where the material has a magnetisation
    let continuum = config["material"].is_string() || config["material"].get("Ms").is_some();
    let energy = |x: f64| if continuum { format!("{x} MJ/m^3") } else { format!("{x} meV") };
    let size = if continuum { r.random_range(-0.5..0.5) } else { r.random_range(-2.0..2.0) };
    let mut term = match r.random_range(0..9) {
        0..3 => json!({"anisotropy": {"K": energy(size), "axis": direction(r)}}),
        3 => json!({"anisotropy": {"K": energy(size), "axis": direction(r), "K2": energy(0.3 * size)}}),
        4 => json!({"cubic_anisotropy": {"K": energy(size)}}),
        5 if continuum => json!({"dmi": {"D": format!("{} mJ/m^2", 2.0 * size), "direction": direction(r)}}),
        5 => json!({"dmi": {"D": energy(size), "direction": direction(r)}}),
        6 => {
            let field = [0; 3].map(|_| format!("{} mT", r.random_range(-300..=300)));
            json!({"zeeman": {"B": field}})
        }
        7 if !continuum => json!({"exchange": {"J": ["0 meV", energy(size)]}}),
        7 => json!({"demag": {}}),
        _ => json!({"dipolar": {}}),
    };
    let local = ["anisotropy", "cubic_anisotropy", "zeeman"].iter().find(|name| term.get(**name).is_some());
    if let Some(name) = local.filter(|_| r.random_range(0..3) > 0) {
        term[*name]["sites"] = some_sites(n, r);
    }
    term
}

fn state(n: usize, r: &mut ChaCha8Rng) -> Value {
    let mut state = match r.random_range(0..10) {
        0..3 => json!({"uniform": {"direction": direction(r)}}),
        3..6 => json!({"domain_wall": {"center": r.random_range(0.0..n as f64)}}),
        6 => {
            let left = direction(r);
            json!({"domain_wall": {"center": r.random_range(0..n), "width": r.random_range(0.5..4.0), "left": left,
                "right": direction(r), "through": direction(r)}})
        }
        7 => json!({"spiral": {"axis": direction(r), "period": r.random_range(2.0..40.0), "phase": "30 deg"}}),
        8 => json!({"random": {"seed": r.random_range(0..1000)}}),
        _ => json!({"vectors": (0..n).map(|_| direction(r)).collect::<Vec<_>>()}),
    };
    if r.random_range(0..10) == 0 {
        state.as_object_mut().expect("a state").values_mut().for_each(|s| {
            if s.is_object() {
                s["staggered"] = json!(true);
            }
        });
    }
    state
}

fn lattice(chain: &mut Value, n: usize, r: &mut ChaCha8Rng) {
    match r.random_range(0..6) {
        0 | 1 => chain["periodic"] = json!(!chain["periodic"].as_bool().unwrap_or(false)),
        2 => chain["vacant"] = some_sites(n, r),
        3 => {
            let mut frozen = json!({"sites": some_sites(n, r)});
            if r.random() {
                frozen["direction"] = direction(r);
            }
            chain["frozen"] = json!([frozen]);
        }
        4 => {
            chain["moments"] = json!([{"sites": some_sites(n, r), "moment": format!("{} mu_B", r.random_range(1..5))}])
        }
        _ => {
            chain["spacing"] = json!(format!("{} nm", r.random_range(0.2..4.0)));
            chain["direction"] = direction(r);
        }
    }
}

fn path(path: &mut Map<String, Value>, n: usize, r: &mut ChaCha8Rng) {
    match r.random_range(0..6) {
        0 | 1 => drop(path.insert("images".into(), json!(r.random_range(3..25)))),
        2 => drop(path.remove("guess")),
        3 => {
            path.entry("guess").or_insert(json!({"geodesic": {}}));
            path.insert("noise".into(), json!({"amplitude": "2 deg", "seed": r.random_range(0..100)}));
        }
        4 => {
            path.entry("guess").or_insert(json!({"geodesic": {}}));
            path.insert("smooth".into(), json!(r.random_range(0.0..1.0)));
        }
        _ => {
            let guess = match r.random_range(0..6) {
                0 => json!({"geodesic": {"axis": direction(r)}}),
                1 => json!({"geodesic": {}}),
                2 => {
                    let from = ["left", "right", "center", "ends"][r.random_range(0..4)];
                    json!({"sweep": {"from": from}})
                }
                3 => json!({"rotation": {"axis": direction(r)}}),
                4 => json!({"waypoints": {"states": [state(n, r)]}}),
                _ => json!({"nlerp": {}}),
            };
            path.insert("guess".into(), guess);
        }
    }
}

fn neb(neb: &mut Map<String, Value>, r: &mut ChaCha8Rng) {
    let (key, value) = match r.random_range(0..6) {
        0 => ("climb", json!(r.random::<bool>())),
        1 => ("tolerance", json!(10f64.powi(-r.random_range(2..10)))),
        2 => ("max_evaluations", json!(r.random_range(1..400))),
        3 => ("optimiser", json!({"preconditioned": {}})),
        4 => ("optimiser", json!({"velocity_projection": {}})),
        _ => ("optimiser", json!({"lbfgs": {}})),
    };
    neb.insert(key.into(), value);
}

fn rates(r: &mut ChaCha8Rng) -> Value {
    let temperatures: Vec<String> =
        (0..r.random_range(1..4)).map(|_| format!("{} K", r.random_range(1..400))).collect();
    let mut rates = json!({"temperatures": temperatures});
    if r.random() {
        rates["damping"] = json!([0.0, 0.01, 0.5, 2.0][r.random_range(0..4)]);
    }
    if r.random() {
        rates["theory"] = json!([["htst"], ["langer"]][r.random_range(0..2)]);
    }
    rates
}

use super::*;
use crate::config::Config;
use crate::config::json::written;

const CONFIG: &str = r#"{
  "comment": "every part of a config", "name": "all",
  "material": {"name": "film", "moment": "2 mu_B", "also": ["x"], "energy": [{"exchange": {"J": ["10 meV", "-1 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]},
  "lattice": {"chain": {
    "sites": 40, "spacing": "2 nm", "periodic": false, "cross_section": ["20 nm", {"from": "1 nm", "to": "2 nm"}],
    "sections": [{"sites": {"from": 3, "to": 9}, "width": "12 nm"}], "frozen": [{"sites": [0, 1], "direction": [0, 0, 1]}],
    "moments": [{"sites": [7], "moment": "3 mu_B"}], "vacant": [12]
  }},
  "energy": [
    {"dmi": {"D": "0.2 meV", "direction": [0, 1, 0]}}, {"zeeman": {"B": ["0 T", "0 T", "25 mT"]}},
    {"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0], "sites": {"from": 4, "to": 9}}}, {"demag": {}}
  ],
  "initial": {"domain_wall": {"center": 10, "width": 2, "left": [0, 0, 1]}},
  "final": {"spiral": {"axis": [0, 0, 1], "period": 8}},
  "relax_ends": true,
  "path": {
    "images": 21, "smooth": 0.2, "noise": {"amplitude": "2 deg", "seed": 1},
    "guess": {"waypoints": {"states": [{"uniform": {"direction": [1, 0, 0]}}, {"random": {"seed": 3}}]}}
  },
  "neb": {"climb": true, "tolerance": 1e-6, "max_evaluations": 100, "optimiser": {"lbfgs": {"memory": 5}}},
  "saddle": {"refine": true, "certify": false},
  "rates": {"temperatures": ["4 K", "300 K"], "damping": 0.1, "g_factor": 2.0, "theory": ["htst"]},
  "output": {"formats": ["csv"], "plots": ["svg"], "style": "paper", "width": "85 mm"}
}"#;

/// The places that are refused in a document.
fn refused(value: &Value) -> Vec<String> {
    match read::<Config>(value, 1) {
        Ok(_) => Vec::new(),
        Err(refusals) => refusals.iter().map(|r| written(&r.steps)).collect(),
    }
}

/// The places of all values in a document.
fn places(value: &Value, place: Vec<Step>, all: &mut Vec<Vec<Step>>) {
    let mut deeper = |step: Step, value: &Value| places(value, [&place[..], &[step]].concat(), all);
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| deeper(Step::Key(key.clone()), value)),
        Value::Array(values) => values.iter().enumerate().for_each(|(i, value)| deeper(Step::Index(i), value)),
        _ => {}
    }
    all.push(place);
}

/// What no type takes.
fn wrong() -> Value {
    serde_json::json!([[[{}]]])
}

#[test]
fn one_wrong_value_anywhere_is_refused_once_and_two_are_both_refused() {
    let good: Value = serde_json::from_str(CONFIG).unwrap();
    assert_eq!(refused(&good), Vec::<String>::new());
    let mut all = Vec::new();
    places(&good, Vec::new(), &mut all);
    assert!(all.len() > 120, "{}", all.len());
    let broken = |wanted: &[&Vec<Step>]| {
        let mut value = good.clone();
        wanted.iter().for_each(|place| *at(&mut value, place).unwrap() = wrong());
        refused(&value)
    };
    // where the wrong value is told depends on the type: at it, in it or at what it is in, but once
    let alone: Vec<Vec<String>> = all.iter().map(|place| broken(&[place])).collect();
    for (place, told) in all.iter().zip(&alone) {
        assert_eq!(told.len(), 1, "{}: {told:?}", written(place));
    }
    let mut pairs = 0;
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate().skip(i + 1).step_by(7) {
            // one that is in the other, or told at what both are in, is not seen
            let apart = |a: &str, b: &str| ![a, b].contains(&".") && !a.starts_with(b) && !b.starts_with(a);
            if apart(&written(a), &written(b)) && apart(&alone[i][0], &alone[j][0]) {
                let mut both = [alone[i].clone(), alone[j].clone()].concat();
                let mut told = broken(&[a, b]);
                both.sort();
                told.sort();
                assert_eq!(told, both, "{} and {}", written(a), written(b));
                pairs += 1;
            }
        }
    }
    assert!(pairs > 500, "{pairs}");
}

#[test]
fn every_misspelt_key_is_refused_once_and_what_it_holds_is_still_read() {
    let good: Value = serde_json::from_str(CONFIG).unwrap();
    let mut all = Vec::new();
    places(&good, Vec::new(), &mut all);
    for place in &all {
        let Some((Step::Key(key), parent)) = place.split_last() else { continue };
        let mut value = good.clone();
        let members = at(&mut value, parent).unwrap().as_object_mut().unwrap();
        let held = members.remove(key).unwrap();
        members.insert(format!("{key}_"), held);
        let told = refused(&value);
        let own = written(&[parent, &[Step::Key(format!("{key}_"))]].concat());
        // a key of one letter is near to nothing: that it is missing is told beside
        assert!(told.contains(&own) && told.len() <= if key.len() < 3 { 2 } else { 1 }, "{own}: {told:?}");
    }
    let mut value = good.clone();
    value["energy"][2] = serde_json::json!({"anistropy": {"K": 0.5, "axes": [0, 0, 1], "sites": [1.5]}});
    value["lattice"]["chain"]["spacng"] = value["lattice"]["chain"]["spacing"].take();
    value["lattice"]["chain"].as_object_mut().unwrap().remove("spacing");
    value["path"]["images"] = 2.into();
    value.as_object_mut().unwrap().remove("final");
    let mut told = refused(&value);
    told.sort();
    assert_eq!(
        told,
        [
            ".",
            "energy[2].anistropy",
            "energy[2].anistropy.K",
            "energy[2].anistropy.axes",
            "energy[2].anistropy.sites[0]",
            "lattice.chain.spacng",
            "path.images",
        ]
    );
}

#[test]
fn a_document_that_is_wrong_in_more_places_than_can_be_told_is_read_a_bounded_number_of_times() {
    let mut value: Value = serde_json::from_str(CONFIG).unwrap();
    value["energy"] = vec![wrong(); 1000].into();
    assert_eq!(refused(&value).len(), MOST);
    assert!(read::<Config>(&value, WORK).unwrap_err().len() <= 2, "a large one is read again once at most");
}

#[test]
fn examples_are_values_of_configs() {
    let keys: Value = serde_json::from_str(KEYS).unwrap();
    assert!(keys.as_object().unwrap().len() > 40);
    for (key, part) in
        [("neb", "neb"), ("path", "path"), ("output", "output"), ("rates", "rates"), ("lattice", "lattice")]
    {
        let mut value: Value = serde_json::from_str(CONFIG).unwrap();
        value[part] = keys[key].clone();
        assert_eq!(refused(&value), Vec::<String>::new(), "{key}");
    }
}

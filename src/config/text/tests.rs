use super::*;
use crate::units::{Energy, Length};
use serde::Deserialize;

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Run {
    lattice: Lattice,
    #[serde(default)]
    energy: Vec<Term>,
    name: Option<String>,
    #[serde(default)]
    relax_ends: bool,
    format: Option<Format>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Lattice {
    Chain(Chain),
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Chain {
    sites: usize,
    spacing: Length,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Term {
    Exchange(Exchange),
    Anisotropy(Anisotropy),
    Demag(Demag),
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Exchange {
    #[serde(rename = "J")]
    j: Vec<Energy>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Anisotropy {
    #[serde(rename = "K")]
    k: Energy,
    axis: [f64; 3],
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Demag {}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Format {
    Csv,
    Npz,
}

const LATTICE: &str = r#""lattice": {"chain": {"sites": 3, "spacing": "0.25 nm"}}"#;

fn message(text: &str) -> String {
    match parse::<Run>("run.json", text) {
        Ok(run) => format!("read as {run:?}"),
        Err(e) => e.to_string(),
    }
}

#[test]
fn zz() {
    for text in [
        r#"{LAT, "energy": [{"demag": {}}, {"anisotropy": {"K": 0.5, "axis": [0, 0, 1]}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": "1 pJ/m", "axis": [0, 0, 1]}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 1]}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1, 2]}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, "z", 1]}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV"}}]}"#,
        r#"{LAT, "energy": [{"anisotropy": {"K": true}}]}"#,
        r#"{LAT, "energy": [{"anistropy": {"K": "1 meV"}}]}"#,
        r#"{LAT, "energy": [{"zeeman": {"K": "1 meV"}}]}"#,
        r#"{LAT, "energy": ["demag"]}"#,
        r#"{LAT, "energy": ["demg"]}"#,
        r#"{LAT, "energy": [{}]}"#,
        r#"{LAT, "energy": [{"demag": {}, "exchange": {"J": []}}]}"#,
        r#"{LAT, "energy": [10]}"#,
        r#"{LAT, "energy": [null]}"#,
        r#"{LAT, "energy": [[]]}"#,
        r#"{LAT, "energy": {"demag": {}}}"#,
        r#"{LAT, "energy": [{"demag": null}]}"#,
        r#"{LAT, "energy": [{"demag": {"x": 1}}]}"#,
        r#"{LAT, "energy": [{"exchange": {"J": "10 meV"}}]}"#,
        r#"{LAT, "energy": [{"exchange": {"J": ["1 meV", "2 mev"]}}]}"#,
        r#"{LAT, "nam": 1}"#,
        r#"{LAT, "totally": 1}"#,
        r#"{LAT, "name": 1}"#,
        r#"{LAT, "relax_ends": "yes"}"#,
        r#"{LAT, "format": "svg"}"#,
        r#"{LAT, "format": "CSV"}"#,
        r#"{LAT, "format": {"csv": {}}}"#,
        r#"{LAT, "format": {"csvv": {}}}"#,
        r#"{"energy": []}"#,
        r#"{"lattice": {"chain": {"sites": -3, "spacing": "0.25 nm"}}}"#,
        r#"{"lattice": {"chain": {"sites": 3.5, "spacing": "0.25 nm"}}}"#,
        r#"{"lattice": {"chain": {"sites": 1e3, "spacing": "0.25 nm"}}}"#,
        r#"{"lattice": {"chain": {"sites": 99999999999999999999, "spacing": "0.25 nm"}}}"#,
        r#"{"lattice": {"chain": {"sites": 1e999, "spacing": "0.25 nm"}}}"#,
        "{\n \"lattice\": {\n  \"chain\": {\"sites\": 3,\n   \"späcing\": 1}\n}}",
        r#"{"lattice": {"chain": [3, "0.25 nm"]}}"#,
        r#"[]"#,
        r#""abc""#,
        "",
        "  \n ",
        "{} x",
        "{",
        "{\"a\"",
        "{\"a\":",
        "{\"a\": 1",
        "{\"a\": 1,}",
        "{\"a\": [1, 2,]}",
        "{\"a\": 1 \"b\": 2}",
        "{a: 1}",
        "{'a': 1}",
        "{\"a\": 'x'}",
        "{\"a\": 1, \"a\": 2}",
        "{\"a\": {\"b\": 1,\n \"b\": 2}}",
        "// hi\n{}",
        "{ # hi\n}",
        "{\"a\": 1 /* x */}",
        "{\"a\": NaN}",
        "{\"a\": -Infinity}",
        "{\"a\": +1}",
        "{\"a\": .5}",
        "{\"a\": 5.}",
        "{\"a\": 01}",
        "{\"a\": 0x10}",
        "{\"a\": 1 meV}",
        "{\"a\": 10meV}",
        "{\"a\": True}",
        "{\"a\": None}",
        "{\"a\": yes}",
        "{\"a\": \"x}",
        "{\"a\": \"x\n\"}",
        r#"{"a": "C:\pics"}"#,
        r#"{"a": "C:\users"}"#,
        r#"{"a": "\ud800"}"#,
        "{\"a\": \"\t\"}",
        "{\"a\" 1}",
        "{\"a\": ]}",
        "{\"a\": [1}}",
        "{\"a\":: 1}",
        "\u{FEFF}{\"a\": 1}",
        "\u{FEFF}{\n\"a\": 1}",
        &"[".repeat(100000),
        &"{\"a\":".repeat(100),
    ] {
        let text = text.replace("LAT", LATTICE);
        println!("{}  <=  {text:.80}", message(&text));
    }
}

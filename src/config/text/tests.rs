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

/// Checks whole messages; LAT stands for a good lattice.
fn refused(table: &[(&str, &str)]) {
    for (text, expected) in table {
        assert_eq!(message(&text.replace("LAT", LATTICE)), format!("run.json:{expected}"), "{text}");
    }
}

#[test]
fn what_the_wanted_type_refuses_is_said_in_plain_words_at_its_own_place() {
    refused(&[
        (
            r#"{LAT, "energy": [{"demag": {}}, {"anisotropy": {"K": 0.5, "axis": [0, 0, 1]}}]}"#,
            r#"1:107: energy[1].anisotropy.K: found the number 0.5, but an energy needs its unit: write "0.5 meV" (J, eV, Ry or erg, with SI prefixes)"#,
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": "1 pJ/m", "axis": [0, 0, 1]}}]}"#,
            r#"1:92: energy[0].anisotropy.K: "1 pJ/m" is an exchange stiffness, but an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 1]}}]}"#,
            "1:109: energy[0].anisotropy.axis: found 2 values, expected an array of 3 values, such as [0, 0, 1]",
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1, 2]}}]}"#,
            "1:109: energy[0].anisotropy.axis: found 4 values, fewer are expected, such as [0, 0, 1]",
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, "z", 1]}}]}"#,
            r#"1:113: energy[0].anisotropy.axis[1]: found the string "z", expected a number"#,
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": "1 meV"}}]}"#,
            r#"1:86: energy[0].anisotropy: key "axis" is missing, such as "axis": [0, 0, 1]"#,
        ),
        (
            r#"{LAT, "energy": [{"anisotropy": {"K": true}}]}"#,
            "1:86: energy[0].anisotropy: key \"axis\" is missing, such as \"axis\": [0, 0, 1]\n\
             run.json:1:92: energy[0].anisotropy.K: found true, expected an energy with its unit, such as \"10 meV\"",
        ),
        (
            r#"{LAT, "energy": [{"anistropy": {"K": "1 meV"}}]}"#,
            r#"1:72: energy[0].anistropy: unknown kind "anistropy": did you mean "anisotropy"? (known kinds: exchange, anisotropy, demag)"#,
        ),
        (
            r#"{LAT, "energy": [{"zeeman": {"K": "1 meV"}}]}"#,
            r#"1:72: energy[0].zeeman: unknown kind "zeeman" (known kinds: exchange, anisotropy, demag)"#,
        ),
        (
            r#"{LAT, "energy": ["demag"]}"#,
            r#"1:71: energy[0]: found the kind "demag" alone, expected an object: {"demag": {…}}"#,
        ),
        (
            r#"{LAT, "energy": ["demg"]}"#,
            r#"1:71: energy[0]: unknown kind "demg": did you mean "demag"? (known kinds: exchange, anisotropy, demag)"#,
        ),
        (
            r#"{LAT, "energy": [{}]}"#,
            r#"1:71: energy[0]: found an empty object, expected an object with exactly one key, which names the kind, such as {"exchange": {"J": ["10 meV"]}}"#,
        ),
        (
            r#"{LAT, "energy": [{"demag": {}, "exchange": {"J": []}}]}"#,
            r#"1:71: energy[0]: found an object with the keys "demag", "exchange", expected an object with exactly one key, which names the kind, such as {"exchange": {"J": ["10 meV"]}}"#,
        ),
        (
            r#"{LAT, "energy": [10]}"#,
            r#"1:71: energy[0]: found the number 10, expected an object with exactly one key, which names the kind, such as {"exchange": {"J": ["10 meV"]}}"#,
        ),
        (
            r#"{LAT, "energy": [null]}"#,
            r#"1:71: energy[0]: found null, expected an object with exactly one key, which names the kind, such as {"exchange": {"J": ["10 meV"]}}"#,
        ),
        (
            r#"{LAT, "energy": [[]]}"#,
            r#"1:71: energy[0]: found an empty array, expected an object with exactly one key, which names the kind, such as {"exchange": {"J": ["10 meV"]}}"#,
        ),
        (
            r#"{LAT, "energy": {"demag": {}}}"#,
            r#"1:70: energy: found an object with the key "demag", expected an array, such as [{"exchange": {"J": ["10 meV"]}}]"#,
        ),
        (r#"{LAT, "energy": [{"demag": null}]}"#, "1:81: energy[0].demag: found null, expected an object"),
        (
            r#"{LAT, "energy": [{"demag": {"x": 1}}]}"#,
            r#"1:82: energy[0].demag.x: unknown key "x": no key is possible here"#,
        ),
        (
            r#"{LAT, "energy": [{"exchange": {"J": "10 meV"}}]}"#,
            r#"1:90: energy[0].exchange.J: found the string "10 meV", expected an array, such as ["10 meV"]"#,
        ),
        (
            r#"{LAT, "energy": [{"exchange": {"J": ["1 meV", "2 mev"]}}]}"#,
            r#"1:100: energy[0].exchange.J[1]: unknown unit "mev" in "2 mev": did you mean "meV"? (J, eV, Ry or erg, with SI prefixes)"#,
        ),
        (
            r#"{LAT, "nam": 1}"#,
            r#"1:60: nam: unknown key "nam": did you mean "name"? (known keys: lattice, energy, name, relax_ends, format)"#,
        ),
        (
            r#"{LAT, "totally": 1}"#,
            r#"1:60: totally: unknown key "totally" (known keys: lattice, energy, name, relax_ends, format)"#,
        ),
        (r#"{LAT, "name": 1}"#, "1:68: name: found the number 1, expected a string"),
        (r#"{LAT, "relax_ends": "yes"}"#, r#"1:74: relax_ends: found the string "yes", expected true or false"#),
        (r#"{LAT, "format": "svg"}"#, r#"1:70: format: unknown kind "svg" (known kinds: csv, npz)"#),
        (
            r#"{LAT, "format": "CSV"}"#,
            r#"1:70: format: unknown kind "CSV": did you mean "csv"? (known kinds: csv, npz)"#,
        ),
        (
            r#"{LAT, "format": {"csv": {}}}"#,
            "1:78: format.csv: found an empty object, expected the name alone, as a string",
        ),
        (
            r#"{LAT, "format": {"csvv": {}}}"#,
            r#"1:71: format.csvv: unknown kind "csvv": did you mean "csv"? (known kinds: csv, npz)"#,
        ),
        (r#"{"energy": []}"#, r#"1:1: .: key "lattice" is missing"#),
        (
            r#"{"lattice": {"chain": {"sites": -3, "spacing": "0.25 nm"}}}"#,
            "1:33: lattice.chain.sites: found the number -3, expected a whole number in digits, not negative",
        ),
        (
            r#"{"lattice": {"chain": {"sites": 3.5, "spacing": "0.25 nm"}}}"#,
            "1:33: lattice.chain.sites: found the number 3.5, expected a whole number in digits, not negative",
        ),
        (
            r#"{"lattice": {"chain": {"sites": 1e3, "spacing": "0.25 nm"}}}"#,
            "1:33: lattice.chain.sites: found the number 1e3, expected a whole number in digits, not negative",
        ),
        (
            r#"{"lattice": {"chain": {"sites": 99999999999999999999, "spacing": "0.25 nm"}}}"#,
            "1:33: lattice.chain.sites: found the number 99999999999999999999, expected a whole number in digits, not negative",
        ),
        (
            r#"{"lattice": {"chain": {"sites": 1e999, "spacing": "0.25 nm"}}}"#,
            r#"1:33: lattice.chain.sites: the number "1e999" is too large for double precision"#,
        ),
        (
            "{\n \"lattice\": {\n  \"chain\": {\"sites\": 3,\n   \"späcing\": 1}\n}}",
            r#"4:4: lattice.chain.späcing: unknown key "späcing": did you mean "spacing"? (known keys: sites, spacing)"#,
        ),
        ("[]", "1:1: .: found an empty array, expected an object"),
        (r#""abc""#, r#"1:1: .: found the string "abc", expected an object"#),
    ]);
}

#[test]
fn what_is_no_json_is_said_in_plain_words() {
    refused(&[
        ("", "1:1: .: the file is empty: a JSON object {…} is expected"),
        ("  \n ", "1:1: .: the file is empty: a JSON object {…} is expected"),
        ("{} x", r#"1:4: .: found "x" after the end of the JSON value"#),
        ("{", "1:2: .: found the end of the text, expected a key in double quotes"),
        (r#"{"a""#, r#"1:5: a: found the end of the text, expected ":" after the key "a""#),
        (r#"{"a":"#, "1:6: a: the text ends where a value is expected"),
        (r#"{"a": 1"#, r#"1:8: .: found the end of the text, expected "," or "}""#),
        (r#"{"a": 1,}"#, r#"1:8: .: a comma right before "}": remove it"#),
        (r#"{"a": [1, 2,]}"#, r#"1:12: a[2]: a comma right before "]": remove it"#),
        (r#"{"a": 1 "b": 2}"#, r#"1:9: .: found a string, expected "," or "}""#),
        ("{a: 1}", r#"1:2: .: found "a", expected a key in double quotes"#),
        ("{'a': 1}", r#"1:2: .: found "'", expected a key in double quotes"#),
        (r#"{"a": 'x'}"#, "1:7: a: a string is written in double quotes, not in single ones"),
        (r#"{"a": 1, "a": 2}"#, r#"1:10: a: key "a" appears twice, first in line 1"#),
        ("{\"a\": {\"b\": 1,\n \"b\": 2}}", r#"2:2: a.b: key "b" appears twice, first in line 1"#),
        ("// hi\n{}", "1:1: .: a comment: JSON has none, remove it"),
        ("{ # hi\n}", "1:3: .: a comment: JSON has none, remove it"),
        (r#"{"a": 1 /* x */}"#, "1:9: .: a comment: JSON has none, remove it"),
        (r#"{"a": NaN}"#, r#"1:7: a: found "NaN": numbers must be finite"#),
        (r#"{"a": -Infinity}"#, r#"1:7: a: found "-Infinity": numbers must be finite"#),
        (
            r#"{"a": +1}"#,
            r#"1:7: a: "+1" is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (
            r#"{"a": .5}"#,
            r#"1:7: a: ".5" is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (
            r#"{"a": 5.}"#,
            r#"1:7: a: "5." is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (
            r#"{"a": 01}"#,
            r#"1:7: a: "01" is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (
            r#"{"a": 0x10}"#,
            r#"1:7: a: "0x10" is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (r#"{"a": 1 meV}"#, r#"1:9: .: found "meV", expected "," or "}""#),
        (
            r#"{"a": 10meV}"#,
            r#"1:7: a: "10meV" is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, "0.5 meV")"#,
        ),
        (r#"{"a": True}"#, r#"1:7: a: found "True": in JSON it is written true"#),
        (r#"{"a": None}"#, r#"1:7: a: found "None": in JSON it is written null"#),
        (r#"{"a": yes}"#, r#"1:7: a: found "yes" where a value is expected: a string needs double quotes"#),
        (r#"{"a": "x}"#, "1:7: a: this string has no closing double quote"),
        ("{\"a\": \"x\n\"}", "1:7: a: this string has no closing double quote on its line"),
        (r#"{"a": "C:\pics"}"#, r#"1:10: a: unknown escape \p in a string: a backslash is written \\"#),
        (r#"{"a": "C:\users"}"#, r#"1:10: a: unknown escape \u in a string: a backslash is written \\"#),
        (r#"{"a": "\ud800"}"#, r#"1:7: a: half of a surrogate pair in a \u escape"#),
        ("{\"a\": \"\t\"}", r#"1:8: a: a control character in a string: write it as \u0009"#),
        (r#"{"a" 1}"#, r#"1:6: a: found "1", expected ":" after the key "a""#),
        (r#"{"a": ]}"#, r#"1:7: a: found "]" where a value is expected"#),
        (r#"{"a": [1}}"#, r#"1:9: a[1]: found "}", expected "," or "]""#),
        (r#"{"a":: 1}"#, r#"1:6: a: found ":" where a value is expected"#),
        (
            "\u{FEFF}{\"a\": 1}",
            "1:1: .: key \"lattice\" is missing\nrun.json:1:2: a: unknown key \"a\" (known keys: lattice, energy, name, relax_ends, format)",
        ),
        (
            "\u{FEFF}{\n\"a\": 1}",
            "1:1: .: key \"lattice\" is missing\nrun.json:2:1: a: unknown key \"a\" (known keys: lattice, energy, name, relax_ends, format)",
        ),
    ]);
}

#[test]
fn a_good_text_is_read_with_or_without_a_byte_order_mark() {
    let text = format!("{{{LATTICE}, \"energy\": [{{\"demag\": {{}}}}], \"format\": \"npz\"}}");
    let run = parse::<Run>("run.json", &text).unwrap();
    assert_eq!(run.energy, [Term::Demag(Demag {})]);
    assert_eq!(run.format, Some(Format::Npz));
    assert_eq!(parse::<Run>("run.json", &format!("\u{FEFF}{text}")).unwrap(), run);
}

#[test]
fn deep_nesting_is_an_error_and_no_overflow() {
    for text in ["[".repeat(100_000), "{\"a\":".repeat(100_000), format!("{}1{}", "[".repeat(65), "]".repeat(65))] {
        assert!(message(&text).ends_with(": nested more than 64 deep"));
    }
    assert!(parse::<serde_json::Value>("f", &format!("{}1{}", "[".repeat(64), "]".repeat(64))).is_ok());
}

#[test]
fn no_text_makes_the_reader_panic() {
    let good =
        format!("{{{LATTICE}, \"energy\": [{{\"exchange\": {{\"J\": [\"1 µeV\"]}}}}], \"name\": \"a\\u00e9\\n\"}}");
    for (i, _) in good.char_indices() {
        let _ = message(&good[..i]);
        let _ = message(&good[i..]);
        for c in ["\"", "\\", "{", "]", ",", "µ", "1", "\n", "/", "'"] {
            let _ = message(&format!("{}{c}{}", &good[..i], &good[i..]));
        }
    }
}

#[test]
fn bytes_that_are_no_utf8_are_refused() {
    let message = |bytes: &[u8]| decode("run.json", bytes.to_vec()).map_err(|e| e.to_string());
    assert_eq!(message("{\"µ\": 1}".as_bytes()), Ok("{\"µ\": 1}".to_string()));
    let wide = "run.json:1:1: .: the file is UTF-16: save it as UTF-8".to_string();
    assert_eq!(message(&[0xFF, 0xFE, b'{', 0]), Err(wide.clone()));
    assert_eq!(message(&[b'{', 0, b'}', 0]), Err(wide.clone()));
    assert_eq!(message(&[0, b'{', 0, b'}']), Err(wide));
    let binary = |place: &str| Err(format!("run.json:{place}: .: a byte of value 0: the file is no text, but binary"));
    assert_eq!(message(&[0; 4]), binary("1:1"));
    assert_eq!(message(b"{\n  \0\0}"), binary("2:3"));
    let bad = "run.json:2:3: .: a byte that is not UTF-8: save the file as UTF-8";
    assert_eq!(message(b"{\n \"\xB5\": 1}"), Err(bad.to_string()));
}

#[test]
fn places_are_found_as_far_down_as_the_text_goes() {
    let text =
        "{\n  \"energy\": [\n    {\"demag\": {}},\n    {\"anisotropy\": {\"K\": \"µ\", \"axis\": [0, 0, 1]}}\n  ]\n}";
    for (place, expected) in [
        ("", (1, 1)),
        (".", (1, 1)),
        ("energy", (2, 13)),
        ("energy[0]", (3, 5)),
        ("energy[1].anisotropy.K", (4, 26)),
        ("energy.1.anisotropy.axis[2]", (4, 46)),
        ("energy[1].anisotropy.K2", (4, 20)),
        ("energy[7].anisotropy", (2, 13)),
        ("nothing", (1, 1)),
        ("energy[", (1, 1)),
    ] {
        let (line, column) = expected;
        let said = at_place("run.json", text, Error::invalid(place, "no")).to_string();
        let shown = if place.is_empty() { "." } else { place };
        assert_eq!(said, format!("run.json:{line}:{column}: {shown}: no"));
    }
    assert_eq!(at_place("run.json", "no JSON", Error::invalid("energy", "no")).to_string(), "run.json:1:1: energy: no");
}

fn at_place(file: &str, text: &str, error: Error) -> Error {
    Text::new(file, text.into()).locate(error)
}

#[test]
fn a_later_check_gets_its_line_and_column() {
    let text = "{\n \"path\": {\"images\": 2}}";
    let error = Error::invalid("images", "found 2, at least 3 are needed").within("path");
    assert_eq!(
        at_place("run.json", text, error).to_string(),
        "run.json:2:21: path.images: found 2, at least 3 are needed"
    );
    assert_eq!(at_place("run.json", text, Error::invalid("", "no")).to_string(), "run.json:1:1: .: no");
    assert_eq!(at_place("run.json", text, Error::Numerical("no".into())).to_string(), "no");
}

fn set(text: &str, assignments: &[&str]) -> std::result::Result<String, String> {
    let assignments: Vec<String> = assignments.iter().map(|a| a.to_string()).collect();
    apply_set("run.json", text, &assignments).map_err(|e| e.to_string())
}

#[test]
fn assignments_change_their_value_and_nothing_else() {
    let text = "{\n  \"path\": {\"images\": 20},\n  \"energy\": [{\"anisotropy\": {\"K\": \"0 meV\"}}], \"neb\": {}, \"list\": []\n}";
    for (assignment, from, to) in [
        ("path.images=21", "20", "21"),
        (" path.images = 21 ", "20", "21"),
        ("energy.0.anisotropy.K=\"1 meV\"", "\"0 meV\"", "\"1 meV\""),
        ("energy[0].anisotropy.K=\"1=2\"", "\"0 meV\"", "\"1=2\""),
        ("energy[1]={\"demag\": {}}", "}}]", "}}, {\"demag\": {}}]"),
        ("energy.1.demag={}", "}}]", "}}, {\"demag\": {}}]"),
        ("path.guess={\"sweep\": {}}", "20}", "20, \"guess\": {\"sweep\": {}}}"),
        ("neb.optimiser.lbfgs.memory=5", "{},", "{\"optimiser\": {\"lbfgs\": {\"memory\": 5}}},"),
        ("list.0=1", "[]", "[1]"),
        ("name=\"x\"", "[]\n", "[], \"name\": \"x\"\n"),
        ("path=null", "{\"images\": 20}", "null"),
    ] {
        assert_eq!(set(text, &[assignment]), Ok(text.replace(from, to)), "{assignment}");
    }
    assert_eq!(set("{}", &["a.b=1", "a.c=[1]", "a.c[1]=2", "a.b=3"]), Ok(r#"{"a": {"b": 3, "c": [1, 2]}}"#.into()));
    assert_eq!(set(text, &[]), Ok(text.into()));
}

#[test]
fn assignments_that_cannot_be_made_say_why() {
    let text = r#"{"path": {"images": 20}, "energy": [{}]}"#;
    for (assignment, expected) in [
        ("images", r#"--set: "images" has no "=": write KEY.PATH=JSON, such as path.images=21"#),
        ("path.images", r#"--set: "path.images" has no "=": write KEY.PATH=JSON, such as path.images=21"#),
        ("path.images=", r#"--set path.images: no value after "=": write KEY.PATH=JSON, such as path.images=21"#),
        ("=1", r#"--set : "" is not a path of keys, such as path.images"#),
        ("path..images=1", r#"--set path..images: "path..images" is not a path of keys, such as path.images"#),
        ("energy[x]=1", r#"--set energy[x]: "energy[x]" is not a path of keys, such as path.images"#),
        ("name=wall", r#"--set name: "wall" is not JSON; a string is written --set 'name="wall"'"#),
        ("name=it's", r#"--set name: "it's" is not JSON; a string is written --set 'name="it'\''s"'"#),
        (r#"path={"a": 1,}"#, r#"--set path: the value is not JSON: column 8: a comma right before "}": remove it"#),
        ("path.images.x=1", r#"--set path.images.x: path.images holds a single value: it has no key "x""#),
        ("path.images[0]=1", "--set path.images[0]: path.images holds a single value: it has no [0]"),
        ("energy[3]={}", "--set energy[3]: energy ends with [0]: there is no [3]"),
        ("energy.K=1", "--set energy.K: energy is an array: an index is expected, such as [0]"),
        ("path[0]=1", "--set path[0]: path is an object: it has keys and no [0]"),
        ("new[0]=1", "--set new[0]: there is no array to take [0] of: give the whole array"),
        ("energi[0]=1", "--set energi[0]: there is no array to take [0] of: did you mean \"energy\"?"),
        (
            "material=materials/x.json",
            r#"--set material: "materials/x.json" is not JSON; a string is written --set 'material="materials/x.json"'"#,
        ),
        (
            "neb.tolerance=1e999",
            r#"--set neb.tolerance: the value is not JSON: column 1: the number "1e999" is too large for double precision"#,
        ),
        (
            "neb.tolerance=NaN",
            r#"--set neb.tolerance: the value is not JSON: column 1: found "NaN": numbers must be finite"#,
        ),
        ("path.images=1 2", r#"--set path.images: "1 2" is not JSON; a string is written --set 'path.images="1 2"'"#),
    ] {
        assert_eq!(set(text, &[assignment]), Err(expected.to_string()), "{assignment}");
    }
    assert_eq!(set("{,}", &["a=1"]), Err("run.json:1:2: .: found \",\", expected a key in double quotes".into()));
}

#[test]
fn what_set_is_to_blame_for_is_said_of_it_and_everything_else_stays_where_the_file_has_it() {
    let text = "{\"lattice\": {\"chain\": {\"sites\": 3, \"spacing\": \"0.25 nm\"}}, \"energy\": [{\"demag\": {}}], \"name\": 1}";
    let said = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        Text::new("run.json", text.into()).set(&sets).and_then(|text| text.parse::<Run>()).unwrap_err().to_string()
    };
    let own = "run.json:1:95: name: found the number 1, expected a string";
    assert_eq!(said(&["lattice.chain.sites=300000"]), own);
    assert_eq!(
        said(&["lattice.chain.sites=-3"]),
        format!(
            "--set lattice.chain.sites: found the number -3, expected a whole number in digits, not negative\n{own}"
        )
    );
    assert_eq!(
        said(&["lattice.chain.spaces=3", "name=\"x\""]),
        "--set lattice.chain.spaces: unknown key \"spaces\" (known keys: sites, spacing)"
    );
    assert_eq!(
        said(&["energy.0={\"anisotropy\": {\"K\": 1}}", "name=\"x\""]),
        "--set energy.0: energy[0].anisotropy.K: found the number 1, but an energy needs its unit: write \"1 meV\" (J, eV, Ry or erg, with SI prefixes)\n\
         --set energy.0: energy[0].anisotropy: key \"axis\" is missing, such as \"axis\": [0, 0, 1]"
    );
    assert_eq!(
        said(&["energy[0].demag.x=1", "name=\"x\"", "form.at=3"]),
        "--set energy[0].demag.x: unknown key \"x\": no key is possible here\n\
         --set form.at: form: unknown key \"form\": did you mean \"format\"? (known keys: lattice, energy, name, relax_ends, format)\n\
         --set form.at: unknown kind \"at\" (known kinds: csv, npz)"
    );
    let set = Text::new("run.json", text.into()).set(&["lattice.chain.sites=3".into()]).unwrap();
    assert_eq!(
        set.locate(Error::invalid("lattice.chain", "too small")).to_string(),
        "run.json:1:23: lattice.chain: too small (with --set lattice.chain.sites)"
    );
}

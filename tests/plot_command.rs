//! `plot` as a user meets it: figures from stored files alone, several paths in one, and nothing overwritten that is no figure.

use serde_json::Value;
use spinneb::output::canvas::{Style, description};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const CONFIG: &str = r#"{
  "material": {"name": "toy", "moment": "2 mu_B", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
  ]},
  "lattice": {"chain": {"sites": 5, "vacant": [4]}},
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}},
  "rates": {"temperatures": ["2 K", "3 K", "4 K"]}
}"#;

const FIGURES: [&str; 6] = ["arrhenius", "convergence", "energy_path", "energy_terms", "magnetisation", "spins"];

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let Output { status, stderr, .. } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    // Windows writes paths the other way.
    (status.code(), String::from_utf8(stderr).unwrap().replace('\\', "/"))
}

/// A folder with the results `a` and `b`.
fn results(settings: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.json"), CONFIG).unwrap();
    fs::write(folder.path().join("b.json"), CONFIG.replace("0.5 meV", "0.3 meV")).unwrap();
    let sets = settings.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", "a.json", "b.json", "--out", ".", "-q"].into_iter().chain(sets).collect();
    let (code, said) = spinneb(folder.path(), &arguments);
    assert_eq!(code, Some(0), "{said}");
    folder
}

fn names(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn text(folder: &Path, name: &str) -> String {
    String::from_utf8(read(folder, name)).unwrap()
}

/// A table's columns under their names.
fn columns(table: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = table.lines();
    let mut columns: Vec<(String, Vec<f64>)> =
        lines.next().unwrap().split(',').map(|name| (name.into(), vec![])).collect();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), columns.len());
        columns.iter_mut().zip(cells).for_each(|((_, column), cell)| column.push(cell.parse().unwrap()));
    }
    columns
}

fn column<'a>(columns: &'a [(String, Vec<f64>)], name: &str) -> &'a [f64] {
    &columns.iter().find(|(n, _)| n == name).unwrap_or_else(|| panic!("no {name}")).1
}

/// Smallest text of an SVG (pt), from its viewBox, its width in mm and the sizes of its fonts; and that width.
fn smallest_text(svg: &str) -> (f64, f64) {
    let after = |text: &str, key: &str| text.split(key).nth(1).unwrap().split('"').next().unwrap().to_string();
    let width_mm: f64 = after(svg, " width=\"").trim_end_matches("mm").parse().unwrap();
    let units: f64 = after(svg, "viewBox=\"").split(' ').nth(2).unwrap().parse().unwrap();
    let points_a_unit = width_mm / 25.4 * 72.0 / units;
    let sizes = svg.split("font-size=\"").skip(1).map(|rest| rest.split('"').next().unwrap().parse::<f64>().unwrap());
    (sizes.fold(f64::INFINITY, f64::min) * points_a_unit, width_mm)
}

#[test]
fn one_result_is_drawn_again_from_its_files_to_the_last_byte() {
    let folder = results(&[]);
    let a = folder.path().join("a");
    let drawn: Vec<String> = names(&a)
        .into_iter()
        .filter(|n| [".svg", ".png", "_terms.csv", "tion.csv"].iter().any(|e| n.ends_with(e)))
        .collect();
    assert_eq!(drawn.len(), 2 * FIGURES.len() + 2, "{drawn:?}");
    let before: Vec<Vec<u8>> = drawn.iter().map(|name| read(&a, name)).collect();
    drawn.iter().for_each(|name| fs::remove_file(a.join(name)).unwrap());
    let (code, said) = spinneb(folder.path(), &["plot", "a"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.starts_with("a: drawn in a: energy_path.svg, energy_path.png, "), "{said}");
    for (name, bytes) in drawn.iter().zip(before) {
        assert!(read(&a, name) == bytes, "{name} differs from what the run drew");
    }
    // over what is there, in another format, and elsewhere; nothing else is touched
    let summary = read(&a, "summary.json");
    assert_eq!(spinneb(folder.path(), &["plot", "a", "--format", "svg", "-q"]), (Some(0), String::new()));
    assert_eq!(spinneb(folder.path(), &["plot", "a", "--format", "png", "--out", "elsewhere", "-q"]).0, Some(0));
    let pngs = FIGURES.iter().map(|name| format!("{name}.png"));
    let tables = ["energy_terms.csv", "magnetisation.csv"].map(String::from);
    assert_eq!(names(&folder.path().join("elsewhere")), pngs.chain(tables).collect());
    assert_eq!(read(&a, "summary.json"), summary);
    // in another style the figures are other files of the same result; one that was changed by hand is left
    assert_eq!(spinneb(folder.path(), &["plot", "a", "--style", "dark", "-q"]), (Some(0), String::new()));
    assert_eq!(spinneb(folder.path(), &["run", "a.json", "-q", "--out", "a"]), (Some(0), String::new()), "no damage");
    let edited = text(&a, "spins.svg").replace("#181A1F", "#000000");
    fs::write(a.join("spins.svg"), &edited).unwrap();
    let (code, said) = spinneb(folder.path(), &["plot", "a"]);
    assert_eq!(code, Some(2));
    assert!(
        said.starts_with("error: a/spins.svg: is there, was not written by an earlier run or was changed"),
        "{said}"
    );
    assert_eq!(text(&a, "spins.svg"), edited);
    assert_eq!(spinneb(folder.path(), &["plot", "a", "--force", "-q"]), (Some(0), String::new()));
}

#[test]
fn every_style_draws_text_of_seven_points_and_more_at_its_width() {
    let folder = results(&[]);
    for style in Style::ALL {
        for width in [None, Some("60"), Some("102 mm"), Some("170")] {
            let mut arguments = vec!["plot", "a", "--style", style.name(), "--out", "drawn", "-q"];
            arguments.extend(width.iter().flat_map(|w| ["--width", w, "--format", "svg"]));
            let (code, said) = spinneb(folder.path(), &arguments);
            if style == Style::Slides && width == Some("60") {
                assert_eq!(code, Some(2));
                assert_eq!(said, "error: --width: found 60 mm: figures of style slides are 102 mm to 250 mm wide\n");
                continue;
            }
            assert_eq!(code, Some(0), "{style:?} {width:?}: {said}");
            let asked = width.map(|w| w.trim_end_matches(" mm").parse::<f64>().unwrap());
            let expected = asked.unwrap_or(if style == Style::Slides { 144.5 } else { 85.0 });
            for name in FIGURES {
                let svg = text(&folder.path().join("drawn"), &format!("{name}.svg"));
                let (size, width_mm) = smallest_text(&svg);
                assert!((width_mm - expected).abs() < 1e-6, "{name}: {width_mm} mm");
                // whole units of the SVG, 20 a point
                assert!(size > style.zoom() * 7.0 - 0.03, "{style:?} {name} at {width_mm} mm: text of {size} pt");
                assert!(!svg.contains("NaN"), "{name}");
                let ground = if style == Style::Dark { "fill=\"#181A1F\"" } else { "fill=\"#FFFFFF\"" };
                assert!(svg.lines().nth(2).unwrap().contains(ground), "{name}");
                if width.is_some() {
                    continue;
                }
                let png = read(&folder.path().join("drawn"), &format!("{name}.png"));
                let info = png::Decoder::new(&png[..]).read_info().unwrap().info().clone();
                let wide = f64::from(info.width);
                assert!((wide - width_mm / 25.4 * 300.0).abs() < 1.0, "{name}: {wide} pixels");
            }
        }
    }
}

#[test]
fn the_numbers_of_the_figures_are_those_of_the_stored_tables() {
    let folder = results(&[]);
    let a = folder.path().join("a");
    let path = columns(&text(&a, "path.csv"));
    let terms = columns(&text(&a, "energy_terms.csv"));
    for name in ["image", "reaction_coordinate_rad", "energy_above_initial_meV"] {
        assert_eq!(column(&terms, name), column(&path, name), "{name}");
    }
    let mut sum = vec![0.0; column(&path, "image").len()];
    for term in ["exchange", "anisotropy"] {
        let stored = column(&path, &format!("{term}_meV"));
        let drawn = column(&terms, &format!("{term}_above_initial_meV"));
        assert_eq!(drawn, stored.iter().map(|e| e - stored[0]).collect::<Vec<_>>());
        sum.iter_mut().zip(drawn).for_each(|(s, e)| *s += e);
    }
    for (s, e) in sum.iter().zip(column(&path, "energy_above_initial_meV")) {
        assert!((s - e).abs() < 1e-12, "{s} {e}");
    }
    // between the images too the terms add up to the whole
    let profile = columns(&text(&a, "profile.csv"));
    let whole = column(&profile, "energy_above_initial_meV");
    let terms = ["exchange", "anisotropy"].map(|term| column(&profile, &format!("{term}_above_initial_meV")));
    for (k, e) in whole.iter().enumerate() {
        assert!((terms[0][k] + terms[1][k] - e).abs() < 1e-12, "{k}: {} + {} = {e}", terms[0][k], terms[1][k]);
    }
    let bent = |term: &[f64]| term.windows(3).filter(|e| (e[0] - 2.0 * e[1] + e[2]).abs() > 1e-9).count();
    assert!(terms.iter().any(|term| bent(term) > term.len() / 2), "straight lines between images");
    let mean = columns(&text(&a, "magnetisation.csv"));
    assert_eq!(column(&mean, "reaction_coordinate_rad"), column(&path, "reaction_coordinate_rad"));
    let along = column(&mean, "shown_along_axis");
    // up to down; the vacant site counts for nothing
    assert!((along[0] - 1.0).abs() < 1e-12 && (along[along.len() - 1] + 1.0).abs() < 1e-12, "{along:?}");
    assert_eq!(along, column(&mean, "mean_m_z"));
    assert_eq!(column(&mean, "axis_z"), vec![1.0; along.len()]);
}

#[test]
fn several_results_are_laid_over_each_other_with_their_barriers() {
    let folder = results(&["output.plots=[]"]);
    let here = folder.path();
    let (code, said) = spinneb(here, &["plot", "a", "b"]);
    assert_eq!((code, said.as_str()), (Some(0), "./energy_paths.svg is drawn\n./energy_paths.png is drawn\n"));
    let svg = text(here, "energy_paths.svg");
    for name in ["a", "b"] {
        let summary: Value = serde_json::from_slice(&read(&here.join(name), "summary.json")).unwrap();
        let barrier = summary["barrier_meV"]["forward"].as_f64().unwrap();
        assert!(svg.contains(&format!("{name}: {barrier:.3} meV")), "{name} {barrier}");
    }
    assert_eq!(description(svg.as_bytes()).as_deref(), Some("spinneb: energy_paths of a, b"));
    // labels, a file of one's own, another style
    let labels = ["plot", "a", "b", "--labels", "strong,weak <", "--out", "deep/er.svg", "--style", "dark", "-q"];
    assert_eq!(spinneb(here, &labels), (Some(0), String::new()));
    let svg = text(here, "deep/er.svg");
    assert!(svg.contains("strong: 2.000 meV") && svg.contains("weak &lt;: 1.200 meV"), "{svg}");
    assert!(smallest_text(&svg).0 > 6.97);
    assert_eq!(names(&here.join("deep")), ["er.svg".to_string()].into());
    // the same names: their folders tell them apart
    fs::create_dir(here.join("c")).unwrap();
    for file in names(&here.join("a")).into_iter().filter(|file| here.join("a").join(file).is_file()) {
        fs::copy(here.join("a").join(&file), here.join("c").join(&file)).unwrap();
    }
    assert_eq!(spinneb(here, &["plot", "a", "c", "--out", "same.svg", "-q"]).0, Some(0));
    let svg = text(here, "same.svg");
    assert!(svg.contains("a: 2.000 meV") && svg.contains("c: 2.000 meV"));
    // and their curves take turns
    for colour in ["#0072B2", "#D55E00"] {
        let stroke = format!("stroke=\"{colour}\"");
        let pieces: usize = svg.lines().filter(|l| l.contains(&stroke)).map(|l| l.matches('M').count()).sum();
        assert!(pieces > 10, "{colour}: {pieces} pieces");
    }
}

#[test]
fn a_command_line_that_makes_no_sense_is_refused() {
    let folder = results(&["output.plots=[]"]);
    for (arguments, expected) in [
        (&["plot", "a", "--labels", "x"][..], "error: --labels are for several results; one has no legend"),
        (
            &["plot", "a", "--out", "x.svg"],
            "error: --out x.svg: one result has several figures; give a folder for them",
        ),
        (
            &["plot", "a", "--out", "x.pdf"],
            "error: --out x.pdf: found \"pdf\", expected svg or png, or a folder (whose name may end in /)",
        ),
        (
            &["plot", "a", "b", "--out", "x.txt"],
            "error: --out x.txt: found \"txt\", expected svg or png, or a folder (whose name may end in /)",
        ),
        (
            &["plot", "a", "b", "--labels", "x"],
            "error: --labels: found 1 for 2 results; give one for each, separated by commas",
        ),
        (
            &["plot", "a", "b", "--labels", "x,漢"],
            "error: --labels: the figures' font has no '漢', found in \"漢\"; give another label",
        ),
        (
            &["plot", "a", "b", "--labels", "strong,with twice as much anisotropy in the middle"],
            "error: --labels: \"with twice as much anisotropy in the middle\" is wider than the figure: give a shorter one, or a larger --width",
        ),
        (
            &["plot", "a", "--width", "300"],
            "error: --width: found 300 mm: figures of style paper are 60 mm to 250 mm wide",
        ),
    ] {
        let before = names(folder.path());
        assert_eq!(spinneb(folder.path(), arguments), (Some(2), format!("{expected}\n")));
        assert_eq!(names(folder.path()), before);
    }
}

#[test]
fn what_is_missing_or_damaged_is_named_with_the_way_out() {
    let folder = results(&["output.plots=[]"]);
    let here = folder.path();
    let refused = |arguments: &[&str]| {
        let (code, said) = spinneb(here, arguments);
        assert_eq!(code, Some(2), "{said}");
        said
    };
    assert_eq!(
        refused(&["plot", "none"]),
        "error: none: there is no such directory; name the directory of a result, such as results/wall\n"
    );
    assert_eq!(
        refused(&["plot", "a.json"]),
        "error: a.json: is a file; name the directory of a result, such as results/wall\n"
    );
    fs::create_dir(here.join("empty")).unwrap();
    assert_eq!(
        refused(&["plot", "empty"]),
        "error: empty: holds no finished result: there is no summary.json. Run its config first: spinneb run CONFIG.json\n"
    );
    // every bad one of several is told of, and nothing is drawn
    let said = refused(&["plot", "a", "none", "empty"]);
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(!here.join("energy_paths.svg").exists());

    let a = here.join("a");
    // one figure changed by hand is left alone; what is read must be as it was written
    fs::write(a.join("profile.csv"), text(&a, "profile.csv").replace('1', "2")).unwrap();
    let said = refused(&["plot", "a"]);
    assert!(said.starts_with("error: a: the result here is damaged: profile.csv is not as the run wrote it"), "{said}");
    // without a manifest, as of version 0.1.0, the files themselves tell
    let summary = text(&a, "summary.json");
    let end = summary.find(",\n  \"manifest\"").unwrap();
    fs::write(a.join("summary.json"), format!("{}\n}}\n", &summary[..end])).unwrap();
    fs::copy(here.join("b/profile.csv"), a.join("profile.csv")).unwrap();
    let damage = |file: &str, content: &str, said: &str| {
        let whole = read(&a, file);
        fs::write(a.join(file), content).unwrap();
        let message = refused(&["plot", "a"]);
        assert!(message.starts_with(&format!("error: a/{file}:{said}")), "{message}");
        fs::write(a.join(file), whole).unwrap();
    };
    let table = text(&a, "path.csv");
    let cut = &table[..table.len() / 2];
    let cut_line = format!("line {}: ", cut.lines().count());
    damage("summary.json", "{\"name\": \"a\"", " is damaged: EOF while parsing");
    damage("summary.json", "{\"name\": 3}", " is damaged: invalid type");
    damage("path.csv", cut, &format!(" {cut_line}"));
    damage("path.csv", &table[..table.trim_end().rfind('\n').unwrap() + 1], " has ");
    damage("path.csv", &table.replace("exchange_meV", "exchange_meV,"), " line 2: found ");
    damage("profile.csv", "reaction_coordinate_rad\n0.0\n", " there is no column \"energy_above_initial_meV\"");
    damage("history.csv", "iteration,images\n1,x\n", " line 2: images: found \"x\", expected a number");
    damage("path.npz", "PK\u{3}\u{4}", " the archive cannot be opened");
    damage("config.json", "{", "1:2: .: found the end of the text");
    fs::rename(a.join("config.json"), here.join("config.json")).unwrap();
    assert!(refused(&["plot", "a"]).starts_with("error: a/config.json: there is no such file"));
    fs::rename(here.join("config.json"), a.join("config.json")).unwrap();
    assert_eq!(spinneb(here, &["plot", "a", "-q"]), (Some(0), String::new()));
}

#[test]
fn what_files_are_left_is_drawn_and_the_rest_is_said() {
    let folder = results(&["output.plots=[]", "rates=null"]);
    let (here, a) = (folder.path(), folder.path().join("a"));
    // energies from path.npz, spins from path.ovf
    assert_eq!(spinneb(here, &["plot", "a", "--format", "svg", "--out", "whole", "-q"]).0, Some(0));
    for file in ["path.csv", "profile.csv", "history.csv"] {
        fs::remove_file(a.join(file)).unwrap();
    }
    let (code, said) = spinneb(here, &["plot", "a", "--format", "svg", "--out", "npz"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("a: there is no profile.csv") && said.contains("a: there is no history.csv"), "{said}");
    for file in ["magnetisation.svg", "spins.svg", "energy_terms.csv", "magnetisation.csv"] {
        assert!(read(&here.join("npz"), file) == read(&here.join("whole"), file), "{file}");
    }
    assert!(!here.join("npz/convergence.svg").exists());
    fs::remove_file(a.join("path.npz")).unwrap();
    let (code, said) = spinneb(here, &["plot", "a"]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: a/path.csv: there is neither this nor path.npz"), "{said}");
    let b = here.join("b");
    fs::remove_file(b.join("path.npz")).unwrap();
    assert_eq!(spinneb(here, &["plot", "b", "--format", "svg", "--out", "ovf", "-q"]).0, Some(0));
    assert!(here.join("ovf/spins.svg").exists());
    fs::remove_file(b.join("path.ovf")).unwrap();
    let (code, said) = spinneb(here, &["plot", "b", "--format", "svg", "--out", "none"]);
    assert!(code == Some(0) && said.contains("there is no file of spins"), "{said}");
    let drawn = ["convergence.svg", "energy_path.svg", "energy_terms.csv", "energy_terms.svg"].map(String::from);
    assert_eq!(names(&here.join("none")), drawn.into());
}

#[test]
fn a_file_that_is_not_this_figure_is_left_as_it_is() {
    let folder = results(&["output.plots=[]"]);
    let here = folder.path();
    let left = |file: &str, content: &[u8], arguments: &[&str]| {
        fs::create_dir_all(here.join("out")).unwrap();
        fs::write(here.join(file), content).unwrap();
        let (code, said) = spinneb(here, arguments);
        assert_eq!(code, Some(2), "{said}");
        let words =
            "is there and is not an earlier one of this file; use --force to replace it, or another place with --out";
        assert_eq!(said, format!("error: {file}: {words}\n"));
        assert_eq!(read(here, file), content);
        assert_eq!(spinneb(here, &[arguments, &["--force", "-q"]].concat()), (Some(0), String::new()));
        assert!(read(here, file) != content);
        // our own is replaced without a word
        assert_eq!(spinneb(here, &[arguments, &["--style", "dark", "-q"]].concat()), (Some(0), String::new()));
        fs::remove_dir_all(here.join("out")).unwrap();
    };
    left("out/spins.png", b"mine", &["plot", "a", "--out", "out"]);
    left("out/energy_path.svg", b"<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>", &["plot", "a", "--out", "out"]);
    left("out/magnetisation.csv", b"my,columns\n1,2\n", &["plot", "a", "--out", "out"]);
    left("out/x.svg", b"notes", &["plot", "a", "b", "--out", "out/x.svg"]);
    // of another result
    assert_eq!(spinneb(here, &["plot", "a", "--out", "shared", "-q"]).0, Some(0));
    let (code, said) = spinneb(here, &["plot", "b", "--out", "shared"]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: shared/energy_path.svg: is there and is not an earlier one"), "{said}");
    // a folder is never replaced, whatever is said
    fs::create_dir_all(here.join("folder/spins.svg")).unwrap();
    let (code, said) = spinneb(here, &["plot", "a", "--out", "folder", "--force"]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: folder/spins.svg: is a folder or a device"), "{said}");
    assert_eq!(names(&here.join("folder")), ["spins.svg".to_string()].into());
}

#[test]
fn a_config_chooses_the_style_and_the_width() {
    let folder = results(&["output.style=\"dark\"", "output.width=\"17 cm\"", "rates=null"]);
    let here = folder.path();
    let svg = text(&here.join("a"), "energy_path.svg");
    assert!(svg.contains("width=\"170mm\"") && svg.contains("#181A1F"));
    assert_eq!(spinneb(here, &["plot", "a", "--out", "again", "-q"]).0, Some(0));
    assert!(text(&here.join("again"), "energy_path.svg") == svg);
    assert_eq!(spinneb(here, &["plot", "a", "--out", "paper", "--style", "paper", "--width", "85", "-q"]).0, Some(0));
    assert!(text(&here.join("paper"), "energy_path.svg").contains("width=\"85mm\""));
}

#[test]
fn a_result_without_a_band_is_drawn_anew() {
    let folder = tempfile::tempdir().unwrap();
    let config = CONFIG.replace("[0, 0, -1]", "[0.1, 0, 1]");
    fs::write(folder.path().join("same.json"), config).unwrap();
    let (code, said) = spinneb(folder.path(), &["run", "same.json", "--out", "same", "-q"]);
    assert_eq!(code, Some(3), "{said}");
    let dir = folder.path().join("same");
    assert_eq!(text(&dir, "profile.csv").lines().count(), 1);
    let before: Vec<Vec<u8>> = names(&dir).iter().map(|name| read(&dir, name)).collect();
    let (code, said) = spinneb(folder.path(), &["plot", "same"]);
    assert_eq!(code, Some(0), "{said}");
    let after: Vec<Vec<u8>> = names(&dir).iter().map(|name| read(&dir, name)).collect();
    assert!(before == after, "{said}");
}

//! Results as files: whole contents for a tiny outcome, figures that do not break, a disk that is treated with care.

use spinneb::drive::{
    Barrier, Certificate, EndPoint, HistoryRow, ImageTable, IntermediateMinimum, Outcome, ProfilePoint, RejectedPath,
    SaddlePoint, SearchReport, StopCode, Work,
};
use spinneb::files::disk;
use spinneb::geometry::Direction;
use spinneb::hessian::Bound;
use spinneb::landscape::Effort;
use spinneb::lattice::{Chain, Lattice};
use spinneb::output::canvas::{Look, Style};
use spinneb::output::{
    EnergyPath, EnergyPathPlot, Format, HistoryCsv, KINDS, PLOTS, PathCsv, Picture, PlotFile, ProfileCsv, ReportPage,
    RunReport, SummaryJson, draw_energy_paths, file_names, render_files,
};
use spinneb::path::Path;
use spinneb::spins::Spins;
use std::sync::LazyLock;

/// A path along which a tanh wall of width 4 sites moves through a chain, its plane turning by a right angle.
fn wall_sweep(sites: usize, images: usize) -> Path {
    let states: Vec<Spins> = (0..images)
        .map(|k| {
            let t = k as f64 / (images - 1).max(1) as f64;
            let centre = (0.2 + 0.6 * t) * (sites as f64 - 1.0);
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * t).sin_cos();
            let vector = |i: usize| {
                let u = (i as f64 - centre) / 4.0;
                let across = 1.0 / u.cosh();
                [across * cos, across * sin, -u.tanh()]
            };
            Spins::from_vectors(&(0..sites).map(vector).collect::<Vec<_>>()).unwrap()
        })
        .collect();
    Path::new(&states)
}

/// An outcome whose energy above the initial state is `energy(s)` at reaction coordinate s in [0, length].
fn outcome(path: Path, length: f64, energy: impl Fn(f64) -> f64) -> Outcome {
    let n = path.images();
    let s: Vec<f64> = (0..n).map(|k| length * k as f64 / (n - 1).max(1) as f64).collect();
    let above: Vec<f64> = s.iter().map(|&s| energy(s)).collect();
    let profile: Vec<ProfilePoint> = (0..=400)
        .map(|k| length * k as f64 / 400.0)
        .map(|s| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: energy(s) })
        .collect();
    let saddles: Vec<SaddlePoint> = profile
        .windows(3)
        .filter(|w| w[1].above_initial_mev > w[0].above_initial_mev && w[1].above_initial_mev >= w[2].above_initial_mev)
        .map(|w| saddle(w[1], n, length))
        .collect();
    let top = saddles.iter().map(|s| s.above_initial_mev).max_by(f64::total_cmp);
    let end = |e: f64| EndPoint {
        energy_mev: e - 500.0,

        max_torque_mev: 1e-13,
        negative_modes: Some(0),
        zero_modes: Some(1),
        moved_rad: Some(0.125),
    };
    Outcome {
        certificate: None,
        converged: true,
        certified: true,
        stop_code: StopCode::Converged,
        stop_reason: "converged: largest predicted rotation 3.1e-7 rad".into(),
        warnings: Vec::new(),
        barrier: top.map(|e| Barrier { forward_mev: e, backward_mev: e - energy(length) }),
        highest_climb: top.map(|e| Barrier { forward_mev: e, backward_mev: e - energy(length) }),
        saddles,
        initial: end(0.0),
        final_state: end(energy(length)),
        intermediate_minima: Vec::new(),
        search: SearchReport {
            effort: Effort::Quick,
            searches: 8,
            quiet: 8,
            minima: 3,
            saddles: 2,
            lowered_by_mev: 0.125,
            spent: false,
            lowest_exits_mev: [Some(0.75), None],
            exits_from_k: None,
        },
        rejected_paths: Vec::new(),
        rates: None,
        images: ImageTable {
            reaction_coordinate_rad: s,
            energy_mev: above.iter().map(|e| e - 500.0).collect(),
            terms_mev: vec![("exchange".into(), above.clone())],
            max_perpendicular_torque_mev: vec![0.0; n],
            above_initial_mev: above,
        },
        path,
        profile_terms_mev: vec![("exchange".into(), profile.iter().map(|p| p.above_initial_mev).collect())],
        profile,
        history: Vec::new(),
        work: Work { iterations: 10, force_evaluations: 200, seconds: 0.5, threads: 2 },
        max_perpendicular_torque_mev: 1e-9,
        largest_predicted_rotation_rad: 3.1e-7,
    }
}

fn saddle(p: ProfilePoint, images: usize, length: f64) -> SaddlePoint {
    SaddlePoint {
        energy_mev: p.above_initial_mev - 500.0,
        above_initial_mev: p.above_initial_mev,
        reaction_coordinate_rad: p.reaction_coordinate_rad,
        image: (p.reaction_coordinate_rad / length * (images - 1) as f64).round() as usize,
        spins: Spins::uniform(1, Direction::Z),
        max_torque_mev: Some(1e-13),
        negative_modes: Some(1),
        zero_modes: Some(0),
        lowest_eigenvalues_mev: vec![-0.25, 0.5],
    }
}

/// Three images of one spin that turns over, every number chosen by hand.
fn tiny() -> Outcome {
    let states = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]].map(|v| Spins::from_vectors(&[v]).unwrap());
    let mut o = outcome(Path::new(&states), 2.0, |_| 0.0);
    o.certified = false;
    o.warnings = vec!["flat to 1e-12 meV".into()];
    o.barrier = Some(Barrier { forward_mev: 0.5, backward_mev: 0.75 });
    o.highest_climb = Some(Barrier { forward_mev: 0.625, backward_mev: 0.75 });
    o.saddles = vec![SaddlePoint {
        energy_mev: 0.25,
        above_initial_mev: 0.5,
        reaction_coordinate_rad: 1.0,
        image: 1,
        spins: Spins::uniform(1, Direction::Z),
        max_torque_mev: None,
        negative_modes: Some(1),
        zero_modes: None,
        lowest_eigenvalues_mev: vec![-0.1],
    }];
    o.initial = EndPoint {
        energy_mev: -0.25,
        max_torque_mev: 0.0,
        negative_modes: Some(0),
        zero_modes: Some(0),
        moved_rad: Some(0.125),
    };
    o.final_state =
        EndPoint { energy_mev: -0.5, max_torque_mev: 1e-13, negative_modes: None, zero_modes: None, moved_rad: None };
    o.intermediate_minima = vec![IntermediateMinimum {
        image: 1,
        reaction_coordinate_rad: 0.9,
        spins: o.path.spins(1),
        state: o.initial.clone(),
    }];
    o.rejected_paths = vec![RejectedPath {
        guess: "rotation".into(),
        barrier_mev: None,
        negative_modes: Some(2),
        reason: "higher".into(),
    }];
    o.images = ImageTable {
        reaction_coordinate_rad: vec![0.0, 0.1 + 0.2, 2.0],
        energy_mev: vec![-0.25, 0.25, -0.5],
        above_initial_mev: vec![0.0, 0.5, -0.25],
        terms_mev: vec![("exchange".into(), vec![0.0; 3]), ("easy axis".into(), vec![-0.25, 0.25, -0.5])],
        max_perpendicular_torque_mev: vec![0.0, 1e-13, 0.0],
    };
    o.profile = vec![
        ProfilePoint { reaction_coordinate_rad: 0.0, above_initial_mev: 0.0 },
        ProfilePoint { reaction_coordinate_rad: 1.0, above_initial_mev: 0.5 },
    ];
    o.profile_terms_mev = vec![("exchange".into(), vec![0.0; 2]), ("easy axis".into(), vec![0.0, 0.5])];
    o.history = vec![HistoryRow {
        iteration: 1,
        images: 3,
        max_perpendicular_torque_mev: 0.125,
        largest_predicted_rotation_rad: 1e-7,
        highest_image_mev: 0.5,
        length_rad: 2.0,
        hessian_products: 7,
    }];
    o
}

fn report(outcome: &Outcome) -> RunReport<'_> {
    static LATTICE: LazyLock<Lattice> = LazyLock::new(|| Chain::open(1).resolve().unwrap());
    let (inputs, lattice, look) = (&[], &*LATTICE, Look::default());
    RunReport {
        name: "tiny",
        version: "0.1.0",
        config_sha256: "abc",
        config_text: "{}",
        inputs,
        lattice,
        look,
        outcome,
    }
}

fn text(format: &dyn Format, outcome: &Outcome) -> String {
    String::from_utf8(format.render(&report(outcome)).unwrap()).unwrap()
}

#[test]
fn tables_are_exactly_so() {
    let o = tiny();
    assert_eq!(
        text(&PathCsv, &o),
        "image,reaction_coordinate_rad,energy_meV,exchange_meV,easy_axis_meV,max_perpendicular_torque_meV,energy_above_initial_meV\n\
         0,0.0,-0.25,0.0,-0.25,0.0,0.0\n\
         1,0.30000000000000004,0.25,0.0,0.25,1e-13,0.5\n\
         2,2.0,-0.5,0.0,-0.5,0.0,-0.25\n"
    );
    assert_eq!(
        text(&ProfileCsv, &o),
        "reaction_coordinate_rad,energy_meV,energy_above_initial_meV,exchange_above_initial_meV,easy_axis_above_initial_meV\n\
         0.0,-0.25,0.0,0.0,0.0\n1.0,0.25,0.5,0.0,0.5\n"
    );
    assert_eq!(
        text(&HistoryCsv, &o),
        "iteration,images,max_perpendicular_torque_meV,largest_predicted_rotation_rad,highest_image_above_initial_meV,length_rad\n\
         1,3,0.125,1e-7,0.5,2.0\n"
    );
}

#[test]
fn the_summary_is_exactly_so() {
    let expected = r#"{
  "name": "tiny",
  "version": "0.1.0",
  "config_sha256": "abc",
  "converged": true,
  "certified": false,
  "certificate": null,
  "stop_code": "converged",
  "stop_reason": "converged: largest predicted rotation 3.1e-7 rad",
  "warnings": [
    "flat to 1e-12 meV"
  ],
  "barrier_meV": {
    "forward": 0.5,
    "backward": 0.75
  },
  "barrier_J": {
    "forward": 8.01088317e-23,
    "backward": 1.2016324755000001e-22
  },
  "barrier_K": {
    "forward": 5.802259060872792,
    "backward": 8.703388591309189
  },
  "barrier_uncertainty_meV": 4.650000000000001e-16,
  "highest_climb_meV": {
    "forward": 0.625,
    "backward": 0.75
  },
  "saddles": [
    {
      "energy_meV": 0.25,
      "energy_above_initial_meV": 0.5,
      "reaction_coordinate_rad": 1.0,
      "image": 1,
      "max_torque_meV": null,
      "negative_modes": 1,
      "zero_modes": null,
      "lowest_eigenvalues_meV": [
        -0.1
      ]
    }
  ],
  "initial": {
    "energy_meV": -0.25,
    "max_torque_meV": 0.0,
    "negative_modes": 0,
    "zero_modes": 0,
    "moved_rad": 0.125
  },
  "final": {
    "energy_meV": -0.5,
    "max_torque_meV": 1e-13,
    "negative_modes": null,
    "zero_modes": null,
    "moved_rad": null
  },
  "intermediate_minima": [
    {
      "image": 1,
      "reaction_coordinate_rad": 0.9,
      "energy_meV": -0.25,
      "max_torque_meV": 0.0,
      "negative_modes": 0,
      "zero_modes": 0
    }
  ],
  "search": {
    "effort": "quick",
    "searches": 8,
    "quiet": 8,
    "minima": 3,
    "saddles": 2,
    "lowered_by_meV": 0.125,
    "spent": false,
    "lowest_exit_meV": {
      "initial": 0.75,
      "final": null
    }
  },
  "rejected_paths": [
    {
      "guess": "rotation",
      "barrier_meV": null,
      "negative_modes": 2,
      "reason": "higher"
    }
  ],
  "path": {
    "images": 3,
    "length_rad": 2.0,
    "max_perpendicular_torque_meV": 1e-9,
    "largest_predicted_rotation_rad": 3.1e-7
  },
  "work": {
    "iterations": 10,
    "force_evaluations": 200,
    "seconds": 0.5,
    "threads": 2
  }
}
"#;
    assert_eq!(text(&SummaryJson, &tiny()), expected);
}

#[test]
fn a_summary_says_whether_directions_were_counted_or_bounded() {
    let mut o = tiny();
    o.certificate = Some(Certificate::Counted);
    let counted = text(&SummaryJson, &o);
    assert!(counted.contains("\"certificate\": \"counted\",") && !counted.contains("certificate_bound"));
    let bound = Bound { part: 0.002, steps: 500, probability: 1e-12 };
    o.certificate = Some(Certificate::Bounded(bound));
    let bounded: serde_json::Value = serde_json::from_str(&text(&SummaryJson, &o)).unwrap();
    assert_eq!(bounded["certificate"], "bounded");
    let told = serde_json::json!({"part_of_stiffness": 0.002, "lanczos_steps": 500, "probability_of_error": 1e-12});
    assert_eq!(bounded["certificate_bound"], told);
}

#[test]
fn a_missing_barrier_is_null() {
    let mut o = tiny();
    (o.barrier, o.highest_climb) = (None, None);
    let json: serde_json::Value = serde_json::from_str(&text(&SummaryJson, &o)).unwrap();
    for key in ["barrier_meV", "barrier_J", "barrier_K", "highest_climb_meV"] {
        assert_eq!(json.get(key), Some(&serde_json::Value::Null));
    }
}

#[test]
fn a_number_that_is_not_finite_is_an_error_with_its_place() {
    let mut o = tiny();
    o.saddles[0].lowest_eigenvalues_mev[0] = f64::NAN;
    o.images.energy_mev[2] = f64::INFINITY;
    o.images.above_initial_mev[2] = f64::INFINITY;
    let message = |format: &dyn Format| format.render(&report(&o)).unwrap_err().to_string();
    assert_eq!(message(&SummaryJson), "summary.json: saddles[0].lowest_eigenvalues_meV[0]: NaN is not a finite number");
    assert_eq!(message(&PathCsv), "path.csv: energy_meV, row 3: inf is not a finite number");
    assert!(message(&PlotFile { plot: &EnergyPathPlot, picture: Picture::Svg }).contains("not finite"));
}

#[test]
fn columns_of_different_lengths_are_an_error() {
    let mut o = tiny();
    o.images.terms_mev[0].1.pop();
    let e = PathCsv.render(&report(&o)).unwrap_err();
    assert_eq!(e.to_string(), "path.csv: exchange_meV has 2 rows, not 3");
}

#[test]
fn every_kind_has_a_name_a_summary_and_files_that_no_other_kind_has() {
    assert!(KINDS.iter().all(|k| !k.name.is_empty() && !k.summary.is_empty() && !(k.formats)().is_empty()));
    let mut names = file_names(|_| true);
    names.sort();
    names.dedup();
    assert_eq!(names.len(), file_names(|_| true).len());
}

#[test]
fn the_same_outcome_gives_the_same_bytes() {
    let o = outcome(wall_sweep(50, 20), 9.0, |s| 6.298 * (s * std::f64::consts::PI / 9.0).sin().powi(2));
    let render = || render_files(&report(&o), |_| true).unwrap();
    assert_eq!(render(), render());
}

/// Everything that once might break a plot: (name, outcome).
fn figures() -> Vec<(&'static str, Outcome)> {
    use std::f64::consts::PI;
    let one_spin = tiny().path;
    let mut no_barrier = outcome(wall_sweep(50, 20), 9.0, |s| 0.3 * s);
    no_barrier.barrier = None;
    let mut single = outcome(wall_sweep(10, 2), 1.0, |_| 0.0);
    single.images = ImageTable {
        reaction_coordinate_rad: vec![0.0],
        energy_mev: vec![1.0],
        above_initial_mev: vec![0.0],
        terms_mev: vec![],
        max_perpendicular_torque_mev: vec![0.0],
    };
    single.profile.clear();
    let mut empty = single.clone();
    empty.images = ImageTable::default();
    vec![
        ("wall", outcome(wall_sweep(50, 20), 9.0, |s| 6.29761 * (s * PI / 9.0).sin().powi(2))),
        ("tilted", outcome(wall_sweep(50, 20), 9.0, |s| 6.29761 * (s * PI / 9.0).sin().powi(2) - 0.35 * s)),
        ("uphill", outcome(wall_sweep(50, 31), 3.1, |s| 20.0 * (s * PI / 3.1).sin().powi(2) + 9.0 * s)),
        (
            "maxima",
            outcome(wall_sweep(100, 41), 28.0, |s| 0.17 * (3.0 * s * PI / 28.0).sin().powi(2) * (1.0 + 0.02 * s)),
        ),
        ("narrow", outcome(wall_sweep(200, 101), 28.0, |s| 812.3 * (-(s - 14.0).powi(2)).exp())),
        ("micro", outcome(wall_sweep(60, 20), 5.0, |s| 3.7e-3 * (s * PI / 5.0).sin().powi(2))),
        ("electronvolt", outcome(wall_sweep(20, 12), 5.0, |s| 4321.0 * (s * PI / 5.0).sin())),
        (
            "plateau",
            outcome(wall_sweep(100, 30), 40.0, |s| {
                25.0 * ((s - 3.0).tanh() - (s - 37.0).tanh() - 0.1 * (s / 40.0)) / 2.0
            }),
        ),
        ("flat", outcome(wall_sweep(30, 10), 9.0, |s| 1e-14 * s)),
        ("two", outcome(wall_sweep(12, 2), 1.0, |s| s)),
        ("three", outcome(one_spin, PI, |s| 0.5 * s.sin().powi(2))),
        ("no_barrier", no_barrier),
        ("single", single),
        ("empty", empty),
        ("long", outcome(wall_sweep(100_000, 12), 9.0, |s| 6.298 * (s * PI / 9.0).sin().powi(2))),
    ]
}

/// With SPINNEB_FIGURES=DIR the figures are kept there, to be looked at.
fn keep(name: &str, bytes: &[u8]) {
    if let Ok(dir) = std::env::var("SPINNEB_FIGURES") {
        disk::write_file(&std::path::Path::new(&dir).join(name), bytes).unwrap();
    }
}

fn size_of_png(bytes: &[u8]) -> (u32, u32) {
    let mut reader = png::Decoder::new(bytes).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|&v| v != 255), "an empty figure");
    (info.width, info.height)
}

#[test]
fn figures_of_all_outcomes_are_drawn() {
    for (k, (name, mut o)) in figures().into_iter().enumerate() {
        if o.images.above_initial_mev.len() != o.path.images() {
            // a table of fewer images has spins of as many
            o.path = Path::new(&vec![o.path.spins(0); o.images.above_initial_mev.len().max(1)]);
        }
        // every style in turn
        let style = Style::ALL[k % Style::ALL.len()];
        let look = Look::new(style, None).unwrap();
        for picture in [Picture::Svg, Picture::Png] {
            for plot in PLOTS.iter().copied() {
                let format = PlotFile { plot, picture };
                if !format.applies(&report(&o))
                    || o.images.above_initial_mev.is_empty() && plot.name() == "magnetisation"
                {
                    continue;
                }
                let bytes = format.render(&RunReport { look, ..report(&o) }).unwrap();
                keep(&format!("{name}_{}", format.file_name()), &bytes);
                let wide = (look.width_mm() / 25.4 * 300.0).round() as u32;
                match picture {
                    Picture::Png => assert_eq!(size_of_png(&bytes).0, wide, "{name}"),
                    Picture::Svg => {
                        let svg = String::from_utf8(bytes).unwrap();
                        assert!(svg.starts_with("<svg xmlns=") && svg.trim_end().ends_with("</svg>"), "{name}");
                        assert!(numbers_are_finite(&svg), "{name}");
                        assert!(svg.len() < 800_000, "{name}: {} bytes", svg.len());
                    }
                }
            }
        }
    }
}

/// No NaN or inf outside the pixels of an embedded image.
fn numbers_are_finite(svg: &str) -> bool {
    svg.lines().filter(|line| !line.starts_with("<image")).all(|line| !line.contains("NaN") && !line.contains("inf"))
}

#[test]
fn every_figure_of_an_uncertified_path_and_the_head_of_its_page_say_so_without_digits_that_nobody_knows() {
    let certified = figures().into_iter().find(|(name, _)| *name == "tilted").unwrap().1;
    let mut open = certified.clone();
    open.certified = false;
    open.saddles.iter_mut().for_each(|s| s.max_torque_mev = None);
    // 6.298 meV of which a hundredth is unknown
    open.images.above_initial_mev.iter_mut().for_each(|e| *e -= 0.01);
    for plot in PLOTS.iter().copied().filter(|plot| plot.name() != "arrhenius") {
        let svg = |o: &Outcome| text(&PlotFile { plot, picture: Picture::Svg }, o);
        assert!(svg(&open).contains("not certified"), "{}", plot.name());
        assert!(!svg(&certified).contains("certified"), "{}", plot.name());
    }
    let svg = text(&PlotFile { plot: &EnergyPathPlot, picture: Picture::Svg }, &open);
    let forward = open.barrier.unwrap().forward_mev;
    let known = format!("≈ {forward:.1} meV");
    assert!(svg.contains(&known) && !svg.contains(&format!("{forward:.2}")), "{svg}");
    let told = page(&open, "{}").0["barrier_told"]["forward"][0].clone();
    assert_eq!(told, known.as_str());
    assert_eq!(page(&certified, "{}").0["barrier_told"], serde_json::Value::Null);
}

#[test]
fn an_end_that_relaxed_far_is_told_in_figures_and_at_the_head_of_the_page() {
    let mut o = figures().into_iter().find(|(name, _)| *name == "wall").unwrap().1;
    let svg = |o: &Outcome| text(&PlotFile { plot: &EnergyPathPlot, picture: Picture::Svg }, o);
    assert!(!svg(&o).contains("relaxed far"));
    o.final_state.moved_rad = Some(2.7);
    assert!(svg(&o).contains("the final state relaxed far from where it was put"));
    let moved = page(&o, "{}").0["moved"].clone();
    assert_eq!(moved, serde_json::json!(["the final state relaxed far from where it was put (a spin turned by 155°)"]));
}

#[test]
fn several_paths_are_overlaid_with_a_legend() {
    let chosen = ["wall", "tilted", "uphill"];
    let paths: Vec<EnergyPath> = figures()
        .iter()
        .filter(|(name, _)| chosen.contains(name))
        .map(|(name, o)| EnergyPath::from_outcome(name, o))
        .collect();
    let canvas = draw_energy_paths(&paths, &Look::default()).unwrap();
    keep("overlay.png", &canvas.png().unwrap());
    let svg = String::from_utf8(canvas.svg().unwrap()).unwrap();
    assert!(chosen.iter().all(|name| svg.contains(&format!("{name}: "))));
    assert!(draw_energy_paths(&[], &Look::default()).unwrap().svg().is_ok());
}

#[test]
fn a_logarithmic_plot_leaves_out_what_has_no_logarithm() {
    use spinneb::output::canvas::{LinePlot, Marker, Series};
    let decay = |rate: f64| (0..=60).map(|k| (f64::from(k) * 10.0, (-rate * f64::from(k)).exp())).collect::<Vec<_>>();
    let mut broken = decay(0.2);
    broken[5].1 = 0.0;
    let plot = LinePlot::new("Iteration", "Largest predicted rotation (rad)")
        .log_y()
        .with(Series::line(broken).label("velocity projection").marker(Marker::Ring))
        .with(Series::line(decay(0.5)).label("implicit"))
        .with(Series::line(vec![(0.0, 1e-6), (600.0, 1e-6)]).label("tolerance").dash(3.0, 2.0).width(0.7));
    let canvas = plot.draw().unwrap();
    keep("log.png", &canvas.png().unwrap());
    assert!(numbers_are_finite(&String::from_utf8(canvas.svg().unwrap()).unwrap()));
    let not_a_number = LinePlot::new("x", "y").with(Series::line(vec![(0.0, f64::NAN)]));
    assert!(not_a_number.draw().is_err());
}

#[test]
fn text_in_an_svg_is_escaped() {
    let path =
        |name: &str| EnergyPath { name: name.into(), images: vec![(0.0, 0.0), (1.0, 1.0)], ..Default::default() };
    let svg = draw_energy_paths(&[path("a<b"), path("c&d")], &Look::default()).unwrap().svg().unwrap();
    let svg = String::from_utf8(svg).unwrap();
    assert!(svg.contains("a&lt;b") && svg.contains("c&amp;d"));
}

/// The data in a page, and the page without them.
fn page(o: &Outcome, config_text: &str) -> (serde_json::Value, String) {
    let bytes = ReportPage.render(&RunReport { config_text, ..report(o) }).unwrap();
    let page = String::from_utf8(bytes).unwrap();
    let (before, rest) = page.split_once("id=\"data\">").unwrap();
    let (data, after) = rest.split_once("</script>").unwrap();
    (serde_json::from_str(data).unwrap(), format!("{before}{after}"))
}

#[test]
fn a_page_is_made_of_every_outcome_and_stays_small() {
    for (name, o) in figures() {
        let (data, rest) = page(&o, "{}");
        let bytes = ReportPage.render(&report(&o)).unwrap();
        keep(&format!("{name}_report.html"), &bytes);
        assert!(rest.len() < 100_000, "{name}: {} bytes without data", rest.len());
        assert!(bytes.len() < 300_000, "{name}: {} bytes", bytes.len());
        assert_eq!((&data["sites"], &data["images"]), (&o.path.sites().into(), &o.path.images().into()), "{name}");
        let shown = |key: &str| data[key].as_array().unwrap().len();
        assert!(shown("sites_shown") == o.path.sites().min(1000) && shown("images_shown") == o.path.images(), "{name}");
        assert_eq!(data["terms"].as_array().unwrap().len(), o.images.terms_mev.len(), "{name}");
    }
}

#[test]
fn words_of_a_run_come_back_from_its_page_and_are_no_markup_in_it() {
    let words = "</script><script>alert(1)</script> <!-- & ' \" \u{2028} {{data}} http://example.org";
    let mut o = tiny();
    o.warnings = vec![words.into()];
    o.rejected_paths[0].guess = words.into();
    o.images.terms_mev[1].0 = words.into();
    let config = serde_json::json!({"material": {"name": words, "source": words}}).to_string();
    let (data, rest) = page(&o, &config);
    for found in [
        &data["summary"]["warnings"][0],
        &data["summary"]["rejected_paths"][0]["guess"],
        &data["terms"][1]["name"],
        &data["material"]["name"],
        &data["material"]["source"],
    ] {
        assert_eq!(found, words);
    }
    assert_eq!(data["config"], config);
    assert!(!rest.contains("alert(1)") && !rest.contains("{{") && !rest.contains("http:") && !rest.contains("https:"));
    assert_eq!(rest.matches("<script").count(), 2);
    let named = ReportPage.render(&RunReport { name: "a<b>&\"c", ..report(&o) }).unwrap();
    assert!(String::from_utf8(named).unwrap().contains("<title>a&lt;b&gt;&amp;&quot;c</title>"));
}

#[test]
fn a_page_does_not_depend_on_time_and_threads() {
    let mut o = tiny();
    let first = ReportPage.render(&report(&o)).unwrap();
    (o.work.seconds, o.work.threads) = (1234.5, 64);
    assert_eq!(ReportPage.render(&report(&o)).unwrap(), first);
    let (data, _) = page(&o, "{}");
    assert_eq!(data["summary"]["work"], serde_json::json!({"iterations": 10, "force_evaluations": 200}));
}

#[test]
fn a_long_config_is_named_but_not_repeated_and_a_number_that_is_not_finite_is_an_error() {
    let mut o = tiny();
    let long = serde_json::json!({"material": {"name": "long"}, "comment": "x".repeat(100_000)}).to_string();
    let (data, rest) = page(&o, &long);
    assert_eq!((&data["config"], &data["material"]["name"]), (&serde_json::Value::Null, &"long".into()));
    assert!(rest.contains("config.json"));
    o.images.above_initial_mev[2] = f64::INFINITY;
    let error = ReportPage.render(&report(&o)).unwrap_err().to_string();
    assert_eq!(error, "report.html: energy_above_initial_meV, row 3: inf is not a finite number");
}

//! Terms of a program's own: found to be what they are, refused where they are not, and as good as the built-in ones in a run.

use serde_json::json;
use spinneb::config::{Loaded, load_text};
use spinneb::drive::{Outcome, Silent, run};
use spinneb::energy::{Custom, CustomEnergy, EnergyTerm, Reach};
use spinneb::error::Error;
use spinneb::field::{Components, ComponentsMut};
use spinneb::geometry::{Vector, vector};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

type Shares = fn(Components, &mut [f64]);
type Gradient = fn(Components, ComponentsMut);

/// A term of two functions.
#[derive(Debug)]
struct Own {
    name: &'static str,
    energy: Shares,
    gradient: Gradient,
    quadratic: Option<bool>,
    reach: Reach,
    /// Gradients asked for; from some number on they are none.
    asked: AtomicUsize,
    broken_from: usize,
}

fn own(name: &'static str, energy: Shares, gradient: Gradient) -> Own {
    let asked = AtomicUsize::new(0);
    Own { name, energy, gradient, quadratic: None, reach: Reach::Unknown, asked, broken_from: usize::MAX }
}

impl CustomEnergy for Own {
    fn name(&self) -> &str {
        self.name
    }

    fn energy(&self, m: Components, density: &mut [f64]) {
        (self.energy)(m, density)
    }

    fn gradient(&self, m: Components, g: ComponentsMut) {
        let broken = self.asked.fetch_add(1, Ordering::Relaxed) >= self.broken_from;
        let mut g = g;
        (self.gradient)(m, g.reborrow());
        if broken {
            g.set(0, [f64::NAN; 3]);
        }
    }

    fn is_quadratic(&self) -> Option<bool> {
        self.quadratic
    }

    fn reach(&self) -> Reach {
        self.reach
    }
}

/// −K (m·z)² with K = 0.5 meV.
fn easy_axis() -> Own {
    own(
        "easy",
        |m, e| (0..m.sites()).for_each(|i| e[i] = 0.5 * (1.0 - m.z[i] * m.z[i])),
        |m, mut g| (0..m.sites()).for_each(|i| g.set(i, [0.0, 0.0, -m.z[i]])),
    )
}

/// −K (m·z)⁴ with K = 0.5 meV, by its tangential gradient alone.
fn fourth_power() -> Own {
    own(
        "fourth",
        |m, e| (0..m.sites()).for_each(|i| e[i] = 0.5 * (1.0 - m.z[i].powi(4))),
        |m, mut g| {
            for i in 0..m.sites() {
                let full = [0.0, 0.0, -2.0 * m.z[i].powi(3)];
                g.set(i, vector::normal_part(full, m.get(i)));
            }
        },
    )
}

/// The sum over second neighbours of ½ |m_i − m_i+2|² (open chain): exchange of 1 meV.
fn second_neighbours() -> Own {
    own(
        "second",
        |m, e| {
            for i in 0..m.sites().saturating_sub(2) {
                let d: Vector = vector::sub(m.get(i), m.get(i + 2));
                e[i] = 0.5 * vector::dot(d, d);
            }
        },
        |m, mut g| {
            (0..m.sites()).for_each(|i| g.set(i, [0.0; 3]));
            for i in 0..m.sites().saturating_sub(2) {
                let d = vector::sub(m.get(i), m.get(i + 2));
                g.add(i, d);
                g.add(i + 2, vector::scale(-1.0, d));
            }
        },
    )
}

/// Σ_ij m_i^z m_j^z/N: all sites act on each other.
fn mean_field() -> Own {
    own(
        "mean_field",
        |m, e| {
            let sum: f64 = m.z.iter().sum();
            e.fill(sum * sum / (m.sites() * m.sites()) as f64);
        },
        |m, mut g| {
            let sum: f64 = m.z.iter().sum();
            (0..m.sites()).for_each(|i| g.set(i, [0.0, 0.0, 2.0 * sum / m.sites() as f64]));
        },
    )
}

/// A chain of some sites with exchange, these terms in its config and those of the program.
fn chain(sites: usize, periodic: bool, terms: serde_json::Value, custom: Vec<Own>) -> Loaded {
    let names: Vec<&str> = custom.iter().map(|own| own.name).collect();
    let config = json!({
        "material": {"name": "toy", "source": "test", "moment": "2 mu_B", "energy": [{"exchange": {"J": ["10 meV"]}}]},
        "lattice": {"chain": {"sites": sites, "periodic": periodic}},
        "energy": terms, "custom_terms": names,
        "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}},
    });
    let custom = custom.into_iter().map(|own| Arc::new(own) as Arc<dyn CustomEnergy>).collect();
    load_text(Path::new("own.json"), config.to_string()).unwrap().with_terms(custom)
}

fn outcome(loaded: &Loaded) -> Outcome {
    run(&loaded.problem().unwrap(), &mut Silent).unwrap()
}

fn refused(own: Own, sites: usize) -> String {
    let lattice = chain(sites, false, json!([]), Vec::new()).lattice;
    Custom::new(&lattice, Arc::new(own)).unwrap_err().to_string()
}

fn found(own: Own, sites: usize, periodic: bool) -> Custom {
    Custom::new(&chain(sites, periodic, json!([]), Vec::new()).lattice, Arc::new(own)).unwrap()
}

#[test]
fn reach_and_degree_of_a_term_are_found() {
    let shape = |term: &Custom| (term.reach(), term.is_quadratic());
    assert_eq!(shape(&found(easy_axis(), 9, false)), (0, true));
    assert_eq!(shape(&found(fourth_power(), 9, false)), (0, false));
    assert_eq!(shape(&found(second_neighbours(), 9, false)), (2, true));
    for sites in [7, 8] {
        assert_eq!(shape(&found(mean_field(), sites, false)), (sites - 1, true));
        assert_eq!(shape(&found(mean_field(), sites, true)), (sites / 2, true));
    }
}

#[test]
fn a_chain_with_its_own_easy_axis_has_the_barrier_of_the_built_in_one() {
    let built_in = json!([{"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]);
    let [a, b] =
        [chain(30, false, built_in, vec![]), chain(30, false, json!([]), vec![easy_axis()])].map(|l| outcome(&l));
    assert!(b.converged && b.certified, "{:?}", b.warnings);
    let [a, b] = [a, b].map(|o| o.barrier.unwrap().forward_mev);
    assert!((a - b).abs() < 1e-11, "{a} {b}");
}

#[test]
fn a_term_of_fourth_degree_by_its_tangential_gradient_is_as_good_as_the_built_in_one() {
    let easy = || json!({"anisotropy": {"K": "0.3 meV", "axis": [0, 0, 1]}});
    let built_in = json!([{"anisotropy": {"K": "0.3 meV", "K2": "0.5 meV", "axis": [0, 0, 1]}}]);
    let [a, b] = [chain(20, false, built_in, vec![]), chain(20, false, json!([easy()]), vec![fourth_power()])]
        .map(|l| outcome(&l));
    assert!(b.converged && b.certified, "{:?}", b.warnings);
    assert_eq!(a.saddles[0].negative_modes, b.saddles[0].negative_modes);
    assert_eq!(a.saddles[0].zero_modes, b.saddles[0].zero_modes);
    let [a, b] = [a, b].map(|o| o.barrier.unwrap().forward_mev);
    assert!((a - b).abs() < 1e-10, "{a} {b}");
}

#[test]
fn terms_that_join_all_pairs_and_none_run_beside_built_in_ones() {
    let terms = json!([{"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]);
    for periodic in [false, true] {
        let own = outcome(&chain(8, periodic, terms.clone(), vec![mean_field(), easy_axis()]));
        assert!(own.converged && own.certified, "{:?}", own.warnings);
        // the mean field, 8 meV at both ends, is gone half-way
        assert!(own.barrier.unwrap().forward_mev < 8.0, "{:?}", own.barrier);
        let names: Vec<&str> = own.images.terms_mev.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["exchange", "anisotropy", "mean_field", "easy"]);
    }
}

#[test]
fn a_gradient_that_is_one_per_cent_wrong_is_refused() {
    let wrong =
        Own { gradient: |m, mut g| (0..m.sites()).for_each(|i| g.set(i, [0.0, 0.0, -1.01 * m.z[i]])), ..easy_axis() };
    assert!(refused(wrong, 50).contains("its gradient is not that of its energy"));
    // on one site of many
    let wrong = Own {
        gradient: |m, mut g| {
            (0..m.sites()).for_each(|i| g.set(i, [0.0, 0.0, if i == 7 { -1.01 * m.z[i] } else { -m.z[i] }]))
        },
        ..easy_axis()
    };
    assert!(refused(wrong, 500).contains("its gradient is not that of its energy"));
}

#[test]
fn what_a_term_says_of_itself_is_checked() {
    let said = refused(Own { quadratic: Some(true), ..fourth_power() }, 9);
    assert!(said.contains("said to be quadratic"), "{said}");
    let said = refused(Own { reach: Reach::Within(1.0), ..second_neighbours() }, 9);
    assert!(said.contains("further apart than its reach"), "{said}");
    let said = refused(Own { energy: |_, e| e.fill(f64::NAN), ..easy_axis() }, 9);
    assert!(said.contains("not finite"), "{said}");
    let said = refused(mean_field(), 700);
    assert!(said.contains("give its \"reach\""), "{said}");
}

#[test]
fn a_term_that_fails_on_the_way_ends_the_run_with_its_name() {
    let calls = outcome_calls();
    for part in 6..20 {
        let own = Own { broken_from: part * calls / 20, ..easy_axis() };
        let loaded = chain(20, false, json!([]), vec![own]);
        match loaded.problem().map(|problem| run(&problem, &mut Silent).map(|_| ())) {
            Ok(Err(Error::Numerical(said))) => assert!(said.contains("\"easy\""), "{said}"),
            other => panic!("{part}: {other:?}"),
        }
    }
}

/// How many gradients a run of the chain asks for.
fn outcome_calls() -> usize {
    let own = Arc::new(easy_axis());
    let loaded = chain(20, false, json!([]), vec![easy_axis()]).with_terms(vec![own.clone()]);
    outcome(&loaded);
    own.asked.load(Ordering::Relaxed)
}

#[test]
fn a_config_with_a_program_s_term_is_run_by_that_program_alone() {
    let loaded = chain(9, false, json!([]), vec![easy_axis()]).with_terms(Vec::new());
    let said = loaded.problem().unwrap_err().to_string();
    assert!(said.contains("custom_terms[0]: \"easy\" is a term of the program that wrote this config"), "{said}");
    let unnamed = loaded.with_terms(vec![Arc::new(easy_axis()), Arc::new(Own { name: "other", ..easy_axis() })]);
    let said = unnamed.problem().unwrap_err().to_string();
    assert!(said.contains("custom_terms: it does not name \"other\", which the program gives"), "{said}");
    let taken = chain(9, false, json!([]), vec![Own { name: "exchange", ..easy_axis() }]);
    assert!(taken.problem().unwrap_err().to_string().contains("the name of something else"));
}

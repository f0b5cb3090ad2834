//! A hundred random lattices against a dense computation of this file's own, which knows nothing of cells and runs: sites from the
//! vectors and atoms of their kinds, bonds from all pairs of sites and their images, shells from distances.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use spinneb::config::load_text;
use spinneb::energy::Hamiltonian;
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::linalg::{Matrix, eigenvalues_symmetric};
use spinneb::spins::Spins;
use std::collections::BTreeMap;
use std::path::Path;

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn sum(terms: impl Iterator<Item = (f64, V)>) -> V {
    terms.fold([0.0; 3], |s, (f, v)| [0, 1, 2].map(|c| s[c] + f * v[c]))
}

/// A kind of lattice as this file knows it.
struct Kind {
    name: &'static str,
    vectors: [V; 3],
    atoms: Vec<V>,
    flat: bool,
}

fn kinds() -> Vec<Kind> {
    let h = 3f64.sqrt() / 2.0;
    let hexagonal = |c: f64| [[1.0, 0.0, 0.0], [0.5, h, 0.0], [0.0, 0.0, c]];
    let cube = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let third = 1.0 / 3.0;
    let kind = |name, vectors, atoms: &[V], flat| Kind { name, vectors, atoms: atoms.to_vec(), flat };
    vec![
        kind("square", cube, &[[0.0; 3]], true),
        kind("triangular", hexagonal(1.0), &[[0.0; 3]], true),
        kind("honeycomb", hexagonal(1.0), &[[0.0; 3], [third, third, 0.0]], true),
        kind("kagome", hexagonal(1.0), &[[0.0; 3], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]], true),
        kind("cubic", cube, &[[0.0; 3]], false),
        kind("bcc", cube, &[[0.0; 3], [0.5; 3]], false),
        kind("fcc", cube, &[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]], false),
        kind("hcp", hexagonal((8f64 / 3.0).sqrt()), &[[0.0; 3], [third, third, 0.5]], false),
        kind(
            "crystal",
            [[1.0, 0.0, 0.0], [-0.3, 1.1, 0.0], [0.2, 0.1, 0.9]],
            &[[0.0; 3], [0.4, 0.55, 0.3], [0.7, 0.2, 0.75]],
            false,
        ),
    ]
}

/// A lattice with all that is random about it.
struct Case {
    kind: Kind,
    size: [usize; 3],
    periodic: [bool; 3],
    species: Vec<usize>,
    radius: Option<f64>,
    shells: usize,
    config: Value,
}

const NAMES: [&str; 2] = ["Fe", "Pt"];

fn case(seed: u64) -> Case {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let kind = kinds().swap_remove(r.random_range(0..9));
    let most = (300 / kind.atoms.len()) as f64;
    let reach = if kind.flat { most.sqrt() as usize } else { most.cbrt() as usize };
    let mut size = [0, 1, 2].map(|_| r.random_range(1..=reach.min(9)));
    if kind.flat {
        size[2] = 1;
    }
    let mut periodic = [0, 1, 2].map(|_| r.random_bool(0.4));
    periodic[2] &= !kind.flat;
    let dimensions = if kind.flat { 2 } else { 3 };
    let is_crystal = kind.name == "crystal";
    let species: Vec<usize> = kind.atoms.iter().map(|_| if is_crystal { r.random_range(0..2) } else { 0 }).collect();
    let radius = r.random_bool(0.4).then(|| r.random_range(1.5..4.0));
    let mut own = json!({"cells": size[..dimensions], "periodic": periodic[..dimensions]});
    if let Some(radius) = radius {
        own["shape"] = json!({"disc": {"center": [1.3, 1.2], "radius": radius}});
    }
    if is_crystal {
        own["vectors"] = json!(kind.vectors);
        let atom = |(at, s): (&V, &usize)| json!({"at": at, "species": NAMES[*s]});
        own["basis"] = kind.atoms.iter().zip(&species).map(atom).collect();
    }
    let shells = r.random_range(1..4);
    let config = json!({"lattice": {kind.name: own}, "initial": {"random": {"seed": seed}}, "final": {"uniform": {"direction": [0, 0, 1]}}});
    Case { kind, size, periodic, species, radius, shells, config }
}

/// Of a pair of sites: from the first to the second, the way up, and the number of the shell.
struct Bond {
    sites: [usize; 2],
    along: V,
    shell: usize,
}

impl Case {
    fn extends(&self, d: usize) -> bool {
        self.size[d] > 1 || self.periodic[d]
    }

    fn at(&self, cell: [f64; 3], atom: usize) -> V {
        let f = self.kind.atoms[atom];
        sum((0..3).map(|d| (cell[d] + f[d], self.kind.vectors[d])))
    }

    /// Positions and atoms of the sites, in order.
    fn sites(&self) -> Vec<(V, usize)> {
        let mut sites = Vec::new();
        for atom in 0..self.kind.atoms.len() {
            for z in 0..self.size[2] {
                for y in 0..self.size[1] {
                    for x in 0..self.size[0] {
                        let p = self.at([x as f64, y as f64, z as f64], atom);
                        let out = self.radius.is_some_and(|r| (p[0] - 1.3).hypot(p[1] - 1.2) > r + 1e-9);
                        if !out {
                            sites.push((p, atom));
                        }
                    }
                }
            }
        }
        sites
    }

    /// The distances of the shells of each pair of species in the unbounded lattice.
    fn distances(&self) -> BTreeMap<(usize, usize), Vec<f64>> {
        let mut all: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
        let range = |d: usize| if self.extends(d) { -6..=6 } else { 0..=0 };
        for a in 0..self.kind.atoms.len() {
            for b in 0..self.kind.atoms.len() {
                let key = (self.species[a].min(self.species[b]), self.species[a].max(self.species[b]));
                for (x, y, z) in range(0).flat_map(|x| range(1).flat_map(move |y| range(2).map(move |z| (x, y, z)))) {
                    let (p, q) = (self.at([0.0; 3], a), self.at([x as f64, y as f64, z as f64], b));
                    let length = (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>().sqrt();
                    let list = all.entry(key).or_default();
                    if length > 1e-6 && !list.iter().any(|known| (known - length).abs() < 1e-7) {
                        list.push(length);
                    }
                }
            }
        }
        all.values_mut().for_each(|list| list.sort_by(f64::total_cmp));
        all
    }

    /// All bonds; nothing where a site would be its own neighbour.
    fn bonds(&self, sites: &[(V, usize)]) -> Option<Vec<Bond>> {
        let distances = self.distances();
        // no shell here is longer than three cells
        let most = |d: usize| if self.periodic[d] { (4 / self.size[d] + 2) as i32 } else { 0 };
        let images = |d: usize| -most(d)..=most(d);
        let round = |d: usize| self.kind.vectors[d].map(|c| self.size[d] as f64 * c);
        let mut bonds = Vec::new();
        for (x, y, z) in images(0).flat_map(|x| images(1).flat_map(move |y| images(2).map(move |z| (x, y, z)))) {
            let over = sum([(x as f64, round(0)), (y as f64, round(1)), (z as f64, round(2))].into_iter());
            for (i, (p, a)) in sites.iter().enumerate() {
                for (j, (q, b)) in sites.iter().enumerate() {
                    let along = [0, 1, 2].map(|c| q[c] - p[c] + over[c]);
                    let up = along.iter().rev().find(|c| c.abs() > 1e-6).is_some_and(|c| *c > 0.0);
                    let key = (self.species[*a].min(self.species[*b]), self.species[*a].max(self.species[*b]));
                    let length = dot(along, along).sqrt();
                    let shell = distances.get(&key)?.iter().position(|d| (d - length).abs() < 1e-7);
                    let Some(shell) = shell.filter(|s| up && *s < self.shells) else { continue };
                    if i == j {
                        return None;
                    }
                    bonds.push(Bond { sites: [i, j], along, shell });
                }
            }
        }
        Some(bonds)
    }
}

/// What the energy is made of.
struct Numbers {
    j: Vec<f64>,
    b: Vec<f64>,
    d: Vec<f64>,
    kind: &'static str,
    k: Vec<f64>,
    field: f64,
}

fn numbers(case: &Case, sites: usize, r: &mut impl Rng) -> (Numbers, Value) {
    let kind = ["interfacial", "bulk", "d2d", "direction"][r.random_range(0..4)];
    let mut list = |low: f64, high: f64, n: usize| -> Vec<f64> { (0..n).map(|_| r.random_range(low..high)).collect() };
    let j = list(-1.0, 1.0, case.shells);
    let (b, d) = (list(-0.3, 0.3, case.shells), list(-0.5, 0.5, case.shells));
    let k = list(-0.4, 0.4, sites);
    let field = 0.25;
    let mev = |x: &Vec<f64>| -> Vec<String> { x.iter().map(|x| format!("{x:?} meV")).collect() };
    let turned = match kind {
        "direction" => {
            json!({"D": d.iter().map(|d| format!("{d:?} meV")).collect::<Vec<_>>(), "direction": [0.6, 0.0, 0.8]})
        }
        _ => json!({"D": mev(&d), "kind": kind}),
    };
    let terms = json!([
        {"exchange": {"J": mev(&j)}},
        {"dmi": turned},
        {"biquadratic": {"B": mev(&b)}},
        {"anisotropy": {"K": mev(&k), "axis": [0, 0, 1]}},
        {"zeeman": {"B": ["0 T", "0 T", format!("{:?} T", field / 5.7883817982e-2)]}},
    ]);
    (Numbers { j, b, d, kind, k, field }, terms)
}

impl Numbers {
    /// d̂ of a bond.
    fn direction(&self, along: V) -> V {
        let length = dot(along, along).sqrt();
        let [x, y, z] = along.map(|c| c / length);
        match self.kind {
            "interfacial" => [-y, x, 0.0],
            "bulk" => [x, y, z],
            "d2d" => [x, -y, 0.0],
            _ => [0.6, 0.0, 0.8],
        }
    }

    /// E, ∂E/∂m, and ∂²E/∂m∂m (row by row, site by site).
    fn dense(&self, bonds: &[Bond], m: &[V]) -> (f64, Vec<V>, Vec<f64>) {
        let n = m.len();
        let (mut e, mut g, mut a) = (0.0, vec![[0.0; 3]; n], vec![0.0; 9 * n * n]);
        let mut put = |i: usize, r: usize, j: usize, c: usize, x: f64| a[(3 * i + r) * 3 * n + 3 * j + c] += x;
        for Bond { sites: [i, j], along, shell } in bonds {
            let (p, q, exchange, b) = (m[*i], m[*j], self.j[*shell], self.b[*shell]);
            let d = self.direction(*along).map(|c| self.d[*shell] * c);
            let c = dot(p, q);
            e += -exchange * c + dot(d, cross(p, q)) - b * c * c;
            g[*i] = sum([(1.0, g[*i]), (-exchange - 2.0 * b * c, q), (1.0, cross(q, d))].into_iter());
            g[*j] = sum([(1.0, g[*j]), (-exchange - 2.0 * b * c, p), (1.0, cross(d, p))].into_iter());
            let turn = [[0.0, d[2], -d[1]], [-d[2], 0.0, d[0]], [d[1], -d[0], 0.0]];
            for r in 0..3 {
                for s in 0..3 {
                    let own = if r == s { -exchange - 2.0 * b * c } else { 0.0 };
                    let x = own + turn[r][s] - 2.0 * b * q[r] * p[s];
                    put(*i, r, *j, s, x);
                    put(*j, s, *i, r, x);
                    put(*i, r, *i, s, -2.0 * b * q[r] * q[s]);
                    put(*j, r, *j, s, -2.0 * b * p[r] * p[s]);
                }
            }
        }
        for (i, (m, k)) in m.iter().zip(&self.k).enumerate() {
            e += -k * m[2] * m[2] - self.field * m[2];
            g[i][2] += -2.0 * k * m[2] - self.field;
            put(i, 2, i, 2, -2.0 * k);
        }
        (e, g, a)
    }
}

fn hamiltonian(case: &Case, terms: &Value) -> Result<Hamiltonian, String> {
    let mut config = case.config.clone();
    config["material"] = json!({"name": "random", "source": "none", "moment": "1 mu_B", "energy": []});
    config["energy"] = terms.clone();
    let loaded = load_text(Path::new("random.json"), config.to_string()).map_err(|e| e.to_string())?;
    loaded.states(false).map(|states| states.hamiltonian).map_err(|e| e.to_string())
}

#[test]
fn a_hundred_random_lattices_have_the_bonds_energies_gradients_hessians_and_indices_of_a_dense_computation() {
    let (mut compared, mut indices, mut refused) = (BTreeMap::<&str, usize>::new(), 0, 0);
    for seed in 1.. {
        let case = case(seed);
        let sites = case.sites();
        if sites.len() < 2 {
            continue;
        }
        let mut r = ChaCha8Rng::seed_from_u64(1000 + seed);
        let (numbers, terms) = numbers(&case, sites.len(), &mut r);
        let bonds = case.bonds(&sites);
        let h = hamiltonian(&case, &terms);
        let (Some(bonds), Ok(h)) = (&bonds, &h) else {
            // a site is its own neighbour, or the box is smaller than a shell or, a ring, than twice a shell
            let said = h.expect_err("a lattice that cannot be");
            let known = ["images of themselves", "further than", "wraps onto itself"];
            assert!(known.iter().any(|words| said.contains(words)), "{}: {said}", case.config);
            assert!(
                bonds.is_some() || said.contains("themselves") || said.contains("wraps"),
                "{}: {said}",
                case.config
            );
            refused += 1;
            continue;
        };
        assert_eq!(h.sites(), sites.len(), "{}", case.config);
        for (i, (p, _)) in sites.iter().enumerate() {
            let apart = h.lattice().position(i);
            assert!((0..3).all(|c| (apart[c] - p[c]).abs() < 1e-12), "{}: site {i}", case.config);
        }
        let mut own: Vec<[usize; 2]> = bonds.iter().map(|b| b.sites).collect();
        let mut theirs: Vec<[usize; 2]> = h.constant_blocks().bond.iter().flat_map(|b| b.family.bonds()).collect();
        own.sort_unstable();
        theirs.sort_unstable();
        assert_eq!(own, theirs, "{}", case.config);
        indices += usize::from(compare(&case, h, &numbers, bonds));
        *compared.entry(case.kind.name).or_default() += 1;
        if compared.values().sum::<usize>() == 100 {
            break;
        }
    }
    assert!(compared.len() == 9 && indices >= 30 && refused >= 10, "{compared:?} {indices} {refused}");
}

/// Energy, gradient, Hessian and, of small lattices, its index, in a random state; whether the index was.
fn compare(case: &Case, h: &Hamiltonian, numbers: &Numbers, bonds: &[Bond]) -> bool {
    let n = h.sites();
    let state = Spins::random(n, 5);
    let (m, vectors) = (state.as_slice(), state.vectors());
    let (e, g, a) = numbers.dense(bonds, &vectors);
    let mut gradient = vec![0.0; 3 * n];
    let above = h.energy_gradient(m, &mut gradient);
    assert!((h.reference_mev() + above - e).abs() < 1e-12 * n as f64 * h.stiffness_mev(), "{}", case.config);
    assert!((h.energy_mev(m) - e).abs() < 1e-12 * n as f64 * h.stiffness_mev(), "{}", case.config);
    let (mut force, tangent) =
        (vec![0.0; 3 * n], |i: usize, v: V| sum([(1.0, v), (-dot(vectors[i], v), vectors[i])].into_iter()));
    h.force(m, &gradient, &mut force);
    for i in 0..n {
        let expected = tangent(i, g[i]);
        let apart = (0..3).map(|c| (force[c * n + i] + expected[c]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-13 * h.stiffness_mev(), "{}: force on {i} {apart}", case.config);
    }
    let basis = TangentBasis::at(m);
    let matrix: Matrix = assemble(h, m, &gradient, &basis);
    let mut dense = vec![0.0; 4 * n * n];
    for i in 0..n {
        for j in 0..n {
            for (s, u) in basis.pair(i).into_iter().enumerate() {
                for (t, w) in basis.pair(j).into_iter().enumerate() {
                    let row = |r: usize| [0, 1, 2].map(|c| a[(3 * i + r) * 3 * n + 3 * j + c]);
                    let own = if (i, s) == (j, t) { dot(vectors[i], g[i]) } else { 0.0 };
                    dense[(2 * i + s) * 2 * n + 2 * j + t] = (0..3).map(|r| u[r] * dot(row(r), w)).sum::<f64>() - own;
                }
            }
        }
    }
    for i in 0..2 * n {
        for j in 0..=i {
            let (here, there) = (matrix.get(i, j), dense[i * 2 * n + j]);
            assert!((here - there).abs() < 1e-12 * h.stiffness_mev(), "{}: {i} {j} {here} {there}", case.config);
        }
    }
    if n > 60 {
        return false;
    }
    let negative = eigenvalues_symmetric(&dense, 2 * n).into_iter().filter(|x| *x < 0.0).count();
    assert_eq!(matrix.factor().negatives(), negative, "{}", case.config);
    true
}

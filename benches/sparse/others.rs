//! The same matrices by two programs that are not ours: faer, supernodal, and a port of QDLDL. Both in the order of an approximate minimum degree, on one thread.

use cpu_time::ThreadTime;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky, supernodal,
};
use faer::sparse::linalg::{SupernodalThreshold, cholesky::CholeskySymbolicParams};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Par, Side};
use spinneb::linalg::SparseMatrix;

/// What a program took, and what it found.
pub struct Taken {
    pub plan_s: f64,
    pub factor_s: f64,
    pub solve_s: f64,
    pub negatives: usize,
    pub x: Vec<f64>,
}

/// The lower half.
fn lower(matrix: &SparseMatrix) -> SparseColMat<usize, f64> {
    let graph = matrix.plan().graph();
    let mut entries = Vec::new();
    for site in 0..graph.sites() {
        let partners = graph.partners(site).iter().map(|p| *p as usize).filter(|p| *p > site);
        for other in std::iter::once(site).chain(partners) {
            for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(u, v)| (2 * other + u, 2 * site + v)) {
                if i >= j {
                    entries.push(Triplet::new(i, j, matrix.get(i, j)));
                }
            }
        }
    }
    SparseColMat::try_new_from_triplets(matrix.order(), matrix.order(), &entries).expect("a matrix")
}

/// By faer.
pub fn faer(matrix: &SparseMatrix, b: &[f64]) -> Taken {
    let a = lower(matrix);
    let start = ThreadTime::now();
    let plan = plan(&a);
    let plan_s = start.elapsed().as_secs_f64();
    let mut values = vec![0.0; plan.len_val()];
    let scratch = plan.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
    let mut memory = MemBuffer::new(scratch);
    let mut factor = |values: &mut [f64]| {
        values.fill(0.0);
        let stack = MemStack::new(&mut memory);
        let found = plan.factorize_numeric_ldlt(
            values,
            a.as_ref(),
            Side::Lower,
            Default::default(),
            Par::Seq,
            stack,
            Default::default(),
        );
        found.expect("no pivot is zero");
    };
    factor(&mut values);
    // once more, in memory that is there
    let start = ThreadTime::now();
    factor(&mut values);
    let factor_s = start.elapsed().as_secs_f64();
    let factors = LdltRef::new(&plan, &values);
    let mut x = Mat::from_fn(b.len(), 1, |i, _| b[i]);
    let mut memory = MemBuffer::new(plan.solve_in_place_scratch::<f64>(1, Par::Seq));
    let start = ThreadTime::now();
    factors.solve_in_place_with_conj(faer::Conj::No, x.as_mut(), Par::Seq, MemStack::new(&mut memory));
    let solve_s = start.elapsed().as_secs_f64();
    let negatives = negatives(&plan, &values);
    Taken { plan_s, factor_s, solve_s, negatives, x: (0..b.len()).map(|i| x[(i, 0)]).collect() }
}

fn plan(a: &SparseColMat<usize, f64>) -> SymbolicCholesky<usize> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(a.symbolic(), Side::Lower, SymmetricOrdering::Amd, params).expect("a plan")
}

/// How many pivots are negative: they stand on the diagonals of the supernodes.
fn negatives(plan: &SymbolicCholesky<usize>, values: &[f64]) -> usize {
    let SymbolicCholeskyRaw::Supernodal(own) = plan.raw() else { unreachable!("supernodal was asked for") };
    let factors = supernodal::SupernodalLdltRef::new(own, values);
    let of = |s: usize| {
        let block = factors.supernode(s).val();
        (0..block.ncols()).filter(|i| block[(*i, *i)] < 0.0).count()
    };
    (0..own.n_supernodes()).map(of).sum()
}

/// By QDLDL.
pub fn qdldl(matrix: &SparseMatrix, b: &[f64]) -> Taken {
    let a = lower(matrix);
    let start = ThreadTime::now();
    let faer = plan(&a);
    let order: PermRef<usize> = faer.perm().expect("an order");
    let (to, from) = order.arrays();
    let (starts, rows, entries) = upper_in_order(&a, from);
    let plan = super::qdldl::Plan::of(starts, rows);
    let plan_s = start.elapsed().as_secs_f64();
    let start = ThreadTime::now();
    let factors = plan.factor(&entries);
    let factor_s = start.elapsed().as_secs_f64();
    let mut x: Vec<f64> = to.iter().map(|i| b[*i]).collect();
    let start = ThreadTime::now();
    factors.solve(&mut x);
    let solve_s = start.elapsed().as_secs_f64();
    let x = from.iter().map(|k| x[*k]).collect();
    Taken { plan_s, factor_s, solve_s, negatives: factors.negatives, x }
}

/// The upper half by columns, where `place` says at which place an order has each row.
fn upper_in_order(a: &SparseColMat<usize, f64>, place: &[usize]) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let n = a.ncols();
    let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
    for t in a.as_ref().triplet_iter() {
        let (i, j) = (place[t.row], place[t.col]);
        columns[i.max(j)].push((i.min(j), *t.val));
    }
    columns.iter_mut().for_each(|column| column.sort_unstable_by_key(|(i, _)| *i));
    let mut starts = vec![0];
    columns.iter().for_each(|column| starts.push(starts[starts.len() - 1] + column.len()));
    let (rows, entries) = columns.into_iter().flatten().unzip();
    (starts, rows, entries)
}

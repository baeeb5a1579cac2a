//! Natural frequencies by dense matrices, `M^-1/2 K M^-1/2` or its like for a consistent mass.

use foil2d::fe::model::{MassMatrix, Model};
use nalgebra::{Cholesky, DMatrix};

/// `ω²` of all modes, ascending: free dofs with mass, massless ones condensed out.
pub fn dense(model: &Model, is_fixed: &[bool]) -> Vec<f64> {
    let free: Vec<usize> = (0..model.n_dofs())
        .filter(|&dof| !is_fixed.get(dof).copied().unwrap_or(false))
        .collect();
    let (followers, massive): (Vec<usize>, Vec<usize>) =
        free.iter().partition(|&&dof| model.is_massless(dof / 2));
    let entry = |i: usize, j: usize| {
        let block = model.stiffness().block(i / 2, j / 2);
        block.map_or(0.0, |block| block[2 * (i % 2) + j % 2])
    };
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| entry(rows[i], columns[j]))
    };
    let mut stiffness = part(&massive, &massive);
    if !followers.is_empty() {
        let inner = Cholesky::new(part(&followers, &followers)).expect("held by the others");
        let beside = part(&followers, &massive);
        stiffness -= beside.transpose() * inner.solve(&beside);
    }
    let mass = DMatrix::from_fn(massive.len(), massive.len(), |i, j| {
        let (i, j) = (massive[i], massive[j]);
        match model.mass() {
            _ if i % 2 != j % 2 => 0.0,
            MassMatrix::Lumped(mass) => f64::from(u8::from(i == j)) * mass[i / 2],
            MassMatrix::Consistent(mass) => mass.block(i / 2, j / 2).map_or(0.0, |b| b[0]),
        }
    });
    let factor = Cholesky::new(mass).expect("massive").l();
    let half = factor.solve_lower_triangular(&stiffness).expect("regular");
    let reduced = factor.solve_lower_triangular(&half.transpose());
    let mut squares: Vec<f64> = reduced
        .expect("regular")
        .symmetric_eigenvalues()
        .iter()
        .copied()
        .collect();
    squares.sort_by(f64::total_cmp);
    squares
}

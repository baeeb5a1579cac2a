//! Matrices that stand for the derivative of the inner forces.

/// Which matrix stands for `∂f/∂x'`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Linearization {
    /// The derivative, made symmetric: exact for equilibrium and where a step changes nothing, else up to the first order of the
    /// change of `F`.
    Consistent,
    /// The same with stresses and second derivatives of the energy reduced until every point is positive semidefinite.
    Definite,
    /// The definite one as impulses ask for it, at equilibrium: no point resists a turn, and no point answers the motion of one node with more than
    /// `most`. With masses added it answers with all the momentum that impulses bring, as long as rounding of `most` leaves the masses.
    Impulsive {
        /// The bound (N/m).
        most: f64,
    },
}

impl Linearization {
    /// Share of the moduli of a point that counts (-).
    #[inline]
    pub(super) fn share<const N: usize>(
        self,
        gradient: &[[f64; 2]; N],
        moduli: &[[f64; 4]; 4],
        volume: f64,
    ) -> f64 {
        let Self::Impulsive { most } = self else {
            return 1.0;
        };
        let trace: f64 = (0..4).map(|k| moduli[k][k]).sum();
        let slopes = gradient.iter().map(|[x, y]| x * x + y * y);
        let stiffness = volume * trace * slopes.fold(0.0, f64::max);
        if stiffness > most {
            most / stiffness
        } else {
            1.0
        }
    }
}

/// Takes out of symmetric moduli what they answer to a turn of `f`, and what they answer with one: `(I - t tᵀ) A (I - t tᵀ)`.
pub(super) fn forget_turn([xx, xy, yx, yy]: [f64; 4], moduli: &mut [[f64; 4]; 4]) {
    let turn = [-yx, -yy, xx, xy];
    let length = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return;
    }
    let turn = turn.map(|x| x / length);
    let answer = moduli.map(|row| row.iter().zip(turn).map(|(a, t)| a * t).sum::<f64>());
    let along: f64 = answer.iter().zip(turn).map(|(a, t)| a * t).sum();
    for (row, entries) in moduli.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry += along * turn[row] * turn[column]
                - answer[row] * turn[column]
                - turn[row] * answer[column];
        }
    }
}

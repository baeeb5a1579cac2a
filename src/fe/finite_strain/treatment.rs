//! What is done so that the cells of an element do not lock.

use crate::fe::element::quadrature::SQUARE_1;
use crate::fe::element::{Element, QuadraturePoint};
use crate::fe::material::hyperelastic::Hyperelastic;
use crate::fe::record::ElementRecord;

/// What is done so that cells do not lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Treatment {
    /// Nothing: each point stands for itself.
    Plain,
    /// One point, with stiffened hourglass modes in the place of inner modes that are left out.
    Stiffened,
    /// What resists a change of volume is smoothed over the cell.
    Smoothed,
}

impl Treatment {
    /// That of the cells of an element that are made of this.
    pub fn of(element: &dyn Element, law: &dyn Hyperelastic) -> Self {
        match element.record() {
            ElementRecord::Quad4 => Self::Stiffened,
            ElementRecord::Quad8 if law.volumetric().is_some() => Self::Smoothed,
            _ => Self::Plain,
        }
    }

    /// The points of such a cell.
    pub fn quadrature(self, element: &dyn Element) -> &'static [QuadraturePoint] {
        match self {
            Self::Stiffened => &SQUARE_1,
            Self::Plain | Self::Smoothed => element.quadrature(),
        }
    }
}

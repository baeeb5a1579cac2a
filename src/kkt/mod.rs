//! The solution of (C.5) with complementarity, one island at a time.
//!
//! 1. [`position`](self) stage: `W = G A⁻¹ Gᵀ`, multipliers `p = -λ >= 0` with `g(x') >= 0`, Coulomb friction on the slip
//!    of the step, Newton iterations for rotations and curved surfaces; or the smooth laws of [`ContactMethod::ConstraintFunction`];
//! 2. velocity stage: contacts between masses get an impulse, so that no force of an impact lingers in the stored
//!    acceleration; contacts through massless surfaces need it only where the impact is shorter than the step;
//! 3. energy stage: velocities give back the energy that contact would add.
//!
//! An [`Island`] is data; the stages are functions over it, in the order of [`Island::solve`].
//!
//! | what | where |
//! |---|---|
//! | data of an island | `island`, `active_contact`, `joints`, `problem`, `sparse`, `passes`, `feasible` (the path) |
//! | positions | `position`; passes along the path in `follow`, or signed gaps; where blocks are and how laws hold in `working_set`; overlaps asked apart in `parting` |
//! | forces of positions | `multipliers`, dense through `delassus` or sparse through `cones`; `smooth` for `constraint_function` |
//! | velocities | `impact` chooses; `velocity`, `midway`, `hits`, `restitution`, `impulses`, `unresolved`, `jammed`; of joints `joint_mass`, `closing`; of explicit steps `forward`, `partner` |
//! | after both | `energy`, `calm`, `work`; `momentum` |
//! | ends of what is not solved | `gentle`, `together`, `group` |
//! | shared | `settings`, `summary`, `tolerances`, `gathered` (multipliers as impulses on blocks) |

mod active_contact;
mod answers;
mod calm;
mod closing;
mod cones;
mod constraint_function;
mod delassus;
mod energy;
mod feasible;
mod follow;
mod forward;
mod gathered;
mod gentle;
mod group;
mod hits;
mod impact;
mod impulses;
mod island;
mod jammed;
mod joint_mass;
mod joints;
mod ledgers;
mod midway;
mod momentum;
mod multipliers;
mod parting;
mod partner;
mod passes;
mod position;
mod problem;
mod rebound;
mod restitution;
mod settings;
mod smooth;
mod solve;
mod sparse;
mod summary;
mod together;
mod tolerances;
mod unresolved;
mod velocity;
mod work;
mod working_set;

pub use constraint_function::{ConstraintFunction, ContactMethod, EpsilonError};
pub(crate) use feasible::Way;
pub(crate) use gentle::{DOUBLED, GAINED};
pub use island::{ActiveContact, Island, KktError, SolveSettings};
pub use joints::{ActiveJoint, Joints};
pub use momentum::LateForce;
pub(crate) use momentum::{LeftOnDriven, late_forces, left_on_driven};
pub use settings::ImpactTreatment;
#[cfg(feature = "serde-serialize")]
pub(crate) use sparse::KeptRecord;
pub use summary::IslandSummary;
pub(crate) use tolerances::FEW_PASSES;
pub use work::KeptOn;

//! How flexible blocks turn when rows do: by the levers of the forces, which their matrices do not know.

use super::Sparse;
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::JointGrip;
use crate::kkt::active_contact::ActiveContact;
use crate::kkt::joints::ActiveJoint;
use crate::math::Vec2;
use crate::system::{Block, Grip, Point, Response};

impl Sparse {
    /// Adds up the couples of the forces at hand along the rows at hand, less those along the rows that they have acted along.
    pub(in crate::kkt) fn add_up_couples(
        &mut self,
        blocks: &[Block],
        contacts: &[ActiveContact],
        ties: &[ActiveJoint],
        [applied, kept]: [&[JointGrip]; 2],
    ) {
        for contact in contacts {
            self.add_contact(blocks, &contact.applied, contact.multiplier, -1.0);
            if !contact.is_lost {
                self.add_contact(blocks, &contact.kinematics, contact.multiplier, 1.0);
            }
        }
        for tie in ties {
            let rows = [(applied, -tie.applied), (kept, tie.direction)];
            for (grips, along) in rows {
                for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
                    let force = tie.multiplier * grip.weight * along;
                    self.add_couples(blocks, grip.block, grip.grip(), force);
                }
            }
        }
    }

    fn add_contact(&mut self, blocks: &[Block], row: &Kinematics, by: [f64; 2], sign: f64) {
        let force = sign * (by[0] * row.normal + by[1] * row.tangent());
        for a in row.attachments() {
            self.add_couples(blocks, a.block, a.grip, a.weight * force);
        }
    }

    fn add_couples(&mut self, blocks: &[Block], block: usize, grip: Grip, force: Vec2) {
        if let (Block::Flex(body), Point::Node(node)) = (&blocks[block], grip.point) {
            let couples = body.couples((node, grip.lever), force);
            self.couples[block] = [0, 1].map(|k| self.couples[block][k] + couples[k]);
        }
    }

    /// How a point of a block moves under the couples listed, beyond the answer of its matrix to the forces (m/s²).
    pub(in crate::kkt) fn turned(&self, blocks: &[Block], block: usize, grip: Grip) -> Vec2 {
        match (&blocks[block], grip.point) {
            (Block::Flex(body), Point::Node(node)) => {
                body.turned((node, grip.lever), self.couples[block], Response::Position)
            }
            _ => Vec2::zeros(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::FlexBodyBuilder;
    use crate::fe::material::LinearElastic;
    use crate::integrator::Beta2;
    use crate::math::cross;
    use crate::path::samples::Random;
    use crate::system::FlexBlock;
    use crate::system::samples::{body_of, predicted};

    const DT: f64 = 1e-3;
    /// Nodes that forces act at.
    const AT: [usize; 3] = [0, 3, 7];

    /// A rectangle one cell thick, all of whose nodes are on its surface, that flies and turns slowly.
    fn rectangle(random: &mut Random) -> FlexBlock {
        let material = LinearElastic::plane_stress(1e4, 0.3).density(10.0);
        let builder = FlexBodyBuilder::rectangle([1.0, 0.4], [4, 1])
            .small_strain()
            .material(material)
            .rotation(random.within(3.0))
            .linvel(random.point(1.0).into())
            .angvel(random.within(0.1));
        let mut block = predicted(&body_of(builder), DT);
        for node in 0..block.model().n_nodes() {
            block.prepare_compliance(node);
        }
        block
    }

    /// Where forces at levers bring all nodes.
    fn places(block: &mut FlexBlock, forces: &[(usize, Vec2, Vec2)]) -> Vec<Vec2> {
        block.clear_contact_force();
        for &(node, force, lever) in forces {
            block.add_contact_force(node, force, lever);
        }
        for _ in 0..20 {
            block.solve();
        }
        let n_nodes = block.model().n_nodes();
        (0..n_nodes).map(|node| block.position(node)).collect()
    }

    /// Forces and levers that turn a little move a block as its matrix answers, and by their couples; the matrix is that of
    /// which `turned` leaves out the turn by the reference arms.
    #[test]
    fn what_forces_that_turn_move_is_known_before_they_do() {
        let mut random = Random::new(3);
        for _ in 0..6 {
            let mut block = rectangle(&mut random);
            let forces = AT.map(|node| (node, random.point(60.0), random.point(0.5)));
            let turned = forces.map(|(node, force, lever)| {
                (
                    node,
                    force + 1e-4 * random.point(60.0),
                    lever + 1e-4 * random.point(0.5),
                )
            });
            let before = places(&mut block, &forces);
            let after = places(&mut block, &turned);
            let mut couples = [0.0; 2];
            for ((node, force, lever), (_, now, lever_now)) in forces.iter().zip(&turned) {
                let (was, is) = (
                    block.couples((*node, *lever), *force),
                    block.couples((*node, *lever_now), *now),
                );
                assert_eq!(was[0], cross(*lever, *force));
                couples = [0, 1].map(|k| couples[k] + is[k] - was[k]);
            }
            let n_nodes = block.model().n_nodes();
            let mut answer = vec![0.0; 2 * n_nodes];
            let mut load = vec![0.0; 2 * n_nodes];
            let b0 = Beta2::default().weights(DT).b0;
            let (mut worst, mut most) = (0.0f64, 0.0f64);
            for at in 0..n_nodes {
                let none = Vec2::zeros();
                let mut moved = -block.turned((at, none), [0.0, couples[1]], Response::Position);
                for ((node, force, _), (_, now, _)) in forces.iter().zip(&turned) {
                    let answer = block.compliance((at, none), (*node, none), Response::Position);
                    moved += answer * (now - force);
                }
                let local = block.local_row(at, moved);
                answer[2 * at..][..2].copy_from_slice(&local);
                let lever = before[at] - block.centre();
                let whole = moved + block.turned((at, lever), couples, Response::Position);
                worst = worst.max((after[at] - before[at] - b0 * whole).norm());
                most = most.max(b0 * whole.norm());
            }
            assert!(worst < 1e-3 * most, "{worst:e} of {most:e}");
            block.effective().multiply(&answer, &mut load);
            for ((node, force, _), (_, now, _)) in forces.iter().zip(&turned) {
                let local = block.local_row(*node, now - force);
                for k in 0..2 {
                    load[2 * node + k] -= local[k];
                }
            }
            let off = load.iter().fold(0.0f64, |off, value| off.max(value.abs()));
            assert!(off < 1e-12 * 60.0, "{off:e}");
        }
    }
}

//! Impacts return no more energy than they take.
//!
//! Newton's law asks for a velocity after an impact whatever friction does to it, and impulses of friction at levers may then do more work than the
//! impact takes (Kane and Levinson 1985): a box that falls on a corner may leave with a sixth more than it had. Contacts do the work
//! `Σ P·(v + v')/2`, none or less if nothing rebounds. Where the contacts of bodies that touch each other do more than their forces have
//! taken from what came together within the step, all of these rebound by a share of their velocities, the one at which they do no more.

use super::impulses;
use super::island::{Island, KktError, SolveSettings};
use super::together;
use crate::math::{REAL_EPSILON, judged::NEGLIGIBLE};
use crate::system::Response;

/// Shares that are tried after none at all.
const MOST_TRIES: usize = 8;

/// The normal row of a contact that rebounds.
#[derive(Clone, Copy, Debug)]
struct Rebound {
    row: usize,
    /// Its motion without impulses, and the velocity that the law asks for (m/s).
    motion: f64,
    velocity: f64,
    group: usize,
}

/// Bodies that touch and gain: shares of their rebounds, with what their contacts do then (J).
#[derive(Clone, Copy, Debug)]
struct Group {
    /// The share at hand.
    share: f64,
    /// The largest share that is known to be small enough, and the least that is not.
    low: [f64; 2],
    high: [f64; 2],
    /// What the share may leave (J).
    enough: f64,
    /// Whether the last share was small enough.
    was_low: bool,
    /// Whether a share is still looked for.
    is_open: bool,
}

/// Lessens the rebounds of solved velocity rows as far as they gain energy.
///
/// # Errors
/// If a number is not finite.
pub(super) fn keep_energy(island: &mut Island, settings: &SolveSettings) -> Result<(), KktError> {
    if island.contacts.iter().all(|one| one.parting[0] <= 0.0) {
        return Ok(());
    }
    let leaders = together::groups_of(island, |block| !block.is_prescribed());
    let mut works = vec![[0.0; 2]; island.blocks.len()];
    add_works(island, &leaders, settings.b1, &mut works);
    let gains = |leader: usize| works[leader][0] > REAL_EPSILON * works[leader][1];
    let mut groups: Vec<Option<Group>> = (0..works.len())
        .map(|leader| {
            gains(leader).then_some(Group {
                share: 0.0,
                low: [0.0; 2],
                high: [1.0, works[leader][0]],
                enough: 0.0,
                was_low: true,
                is_open: true,
            })
        })
        .collect();
    if groups.iter().all(Option::is_none) {
        return Ok(());
    }
    let rebounds = list(island, &leaders, &groups);
    for tried in 0..=MOST_TRIES {
        ask(island, &rebounds, &groups);
        impulses::solve_impulses(island, Response::Velocity, settings.dt)?;
        works.fill([0.0; 2]);
        add_works(island, &leaders, settings.b1, &mut works);
        let mut is_done = true;
        for (group, work) in groups.iter_mut().zip(&works) {
            if let Some(group) = group {
                group.learn(work[0], tried == 0);
                is_done &= !group.is_open;
            }
        }
        if is_done {
            return Ok(());
        }
        let is_last = tried + 1 == MOST_TRIES;
        groups
            .iter_mut()
            .flatten()
            .for_each(|group| group.choose(is_last));
    }
    Ok(())
}

impl Group {
    /// Takes in what the share has come to (J). Where one end stays, it counts half as much the next time (the Illinois rule).
    fn learn(&mut self, work: f64, is_first: bool) {
        if !self.is_open {
            return;
        }
        let is_low = work <= 0.0;
        if is_first {
            self.low = [0.0, work];
            self.is_open = work < 0.0;
            self.enough = NEGLIGIBLE * (self.high[1] - work);
            return;
        }
        if is_low {
            self.is_open = work < -self.enough;
            self.low = [self.share, work];
        } else {
            self.high = [self.share, work];
        }
        if is_low == self.was_low {
            let other = if is_low {
                &mut self.high
            } else {
                &mut self.low
            };
            other[1] *= 0.5;
        }
        self.was_low = is_low;
    }

    /// Chooses the next share between the two, where a line has its root; in the end the smaller one.
    fn choose(&mut self, is_last: bool) {
        if !self.is_open {
            return;
        }
        let ([low, below], [high, above]) = (self.low, self.high);
        self.share = if is_last {
            low
        } else {
            low + (high - low) * below / (below - above)
        };
    }
}

/// Lists the rebounds of the groups that gain.
fn list(island: &Island, leaders: &[usize], groups: &[Option<Group>]) -> Vec<Rebound> {
    let rows = island.problem.rows.iter().enumerate();
    let rebounds = rows.filter_map(|(row, direction)| {
        let velocity = island.contacts[direction.contact].parting[0];
        let group = group_of(island, leaders, direction.contact)?;
        let rebounds = direction.axis == 0 && velocity > 0.0 && groups[group].is_some();
        rebounds.then(|| Rebound {
            row,
            motion: island.problem.free[row] + velocity,
            velocity,
            group,
        })
    });
    rebounds.collect()
}

/// Asks for shares of the rebounds.
fn ask(island: &mut Island, rebounds: &[Rebound], groups: &[Option<Group>]) {
    for rebound in rebounds {
        let share = groups[rebound.group].map_or(1.0, |group| group.share);
        let asked = share * rebound.velocity;
        island.problem.free[rebound.row] = rebound.motion - asked;
        let contact = island.problem.rows[rebound.row].contact;
        island.contacts[contact].parting[0] = asked;
    }
}

/// Adds the work of every contact to that of its group, and what its impulses come to times the motion before (J).
///
/// A position that ends closed has stopped a part of the approach, by the forces of the position stage: from where in the step the bodies
/// met depends how much. Early in it that is more than the law asks for, and impulses give some back, with the friction that went along.
fn add_works(island: &Island, leaders: &[usize], b1: f64, works: &mut [[f64; 2]]) {
    let (mut came, mut taken) = ([0.0; 2], 0.0);
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let Some(group) = group_of(island, leaders, direction.contact) else {
            continue;
        };
        let impulse = island.problem.multipliers[row];
        let contact = &island.contacts[direction.contact];
        let motion = island.problem.free[row] + contact.parting[direction.axis];
        let mean = motion + 0.5 * impulses::change_of(island, row);
        works[group][0] += impulse * mean;
        works[group][1] += (impulse * motion).abs();
        if contact.is_hard {
            continue;
        }
        // The row of the normal comes first.
        if direction.axis == 0 {
            (came, taken) = (contact.approach(&island.blocks), 0.0);
        }
        let sum = came[direction.axis] + motion;
        taken += 0.5 * b1 * contact.multiplier[direction.axis] * sum;
        let next = island.problem.rows.get(row + 1);
        if next.is_none_or(|next| next.contact != direction.contact) {
            works[group][0] += taken.min(0.0);
        }
    }
}

/// The leader of the bodies that a contact is one of.
fn group_of(island: &Island, leaders: &[usize], contact: usize) -> Option<usize> {
    let grips = island.contacts[contact].kinematics.attachments().iter();
    let mut moving = grips.filter(|grip| !island.blocks[grip.block].is_prescribed());
    moving.next().map(|grip| leaders[grip.block])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever parabola the work is of the share, what is found in the end gains nothing, and leaves little.
    #[test]
    fn shares_are_found_that_gain_nothing() {
        for bend in [-0.9, 0.0, 0.5, 3.0, 30.0] {
            for none in [-1e-3, -1.0, -1e3] {
                let slope = 1.0 - bend - none;
                let work = |share: f64| (bend * share + slope) * share + none;
                let mut group = Group {
                    share: 0.0,
                    low: [0.0; 2],
                    high: [1.0, work(1.0)],
                    enough: 0.0,
                    was_low: true,
                    is_open: true,
                };
                for tried in 0..=MOST_TRIES {
                    group.learn(work(group.share), tried == 0);
                    if tried < MOST_TRIES {
                        group.choose(tried + 1 == MOST_TRIES);
                    }
                }
                let left = work(group.share);
                assert!(left <= 0.0, "{bend} {none}: {left}");
                assert!(left >= 5e-2 * (none - 1.0), "{bend} {none}: {left}");
            }
        }
    }
}

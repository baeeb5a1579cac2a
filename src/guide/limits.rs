//! What the crate cannot do, or does with an error that is known.
//!
//! - A body of `.small_strain()` has strains of a few percent in its one frame; as a whole it may move and turn as it likes. A clamped beam that sags by a tenth of
//!   its length is outside, and so is a rope: its steps are solved and keep their energy, and `StepReport::overbent` tells that it is another body.
//! - Bodies of large strain, the default, cost 1 to 6 times as much as ones of small strain, 1.8 times in the median of 100 random scenes. In plane stress they do not follow their thickness, and their surface
//!   keeps its mass. What is crushed flat at tens of metres a second may turn cells inside out (`StableNeoHookean`) or take cut steps (`NeoHookean`, Hooke's law).
//! - An inner pressure acts on the edges of its hole, not on what else lies in there; holes do not join where walls meet. A gas couples all nodes around its hole with each other, which costs with
//!   the square of their number.
//! - Plasticity is isotropic and independent of rate, in plane strain. A body that flows keeps its law for life. Where strains change their direction its steps are of first order.
//! - What rolls or spins while it is pressed, and is a body of large strain, is braked by that: contact forces act wholly within their step. A disc of rubber that rolls at 2 m/s loses .36 m/s in
//!   the first second at 1/60 s, .09 at 1/240 s, and .05 at 1/60 s with `.small_strain()`.
//! - In an island with a body of large strain contact forces act wholly within their step. Bodies of `.small_strain()` there vibrate with more damping, of a ratio of about .25 ω dt.
//! - A body that is shot at a sheet at hundreds of metres a second and crushed far beyond small strains may come out of its own surface, which the report tells
//!   (`StepReport::overbent`); its surface stays on its side.
//! - Gaps of a solved step hold to some 1e-6 m where bodies press on edges that they slide to and fro over, to rounding elsewhere. A step that
//!   is not solved may leave centimetres of overlap where bodies are not led; `StepReport::gap_violation` shows them. It also
//!   shows the overlaps that rapier leaves between rigid bodies far from anything flexible, once these are taken over: such pairs part within some steps.
//! - Between flexible bodies the nodes of one are kept out of the surface of the other, not the other's out of its own: where soft bodies press, a
//!   node of the target may be in the contactor by a millimetre (1.4 mm seen at E = 1e5 between bodies of half a metre).
//! - Without a feasible path rapier's own continuous collision detection may stop a claimed rigid body short of where the stage put it, at a fixed
//!   collider that it jams against: 5e-5 m of overlap were seen with a flexible body at 1/30 s.
//! - Pins and welds do not pull flexible bodies together over more than half the smaller one's size: such an attachment is refused.
//! - A rigid body of positive dominance is met as one that is moved, whatever holds the flexible body: it goes through one that is pinned, and its steps are told as unfinished.
//! - Piles of nine blocks of large strain and 1e5 Pa may creep and never sleep; from 1e6 Pa on they do within two or three seconds.
//! - Floors of boxes laid flush have seams by rapier's rounding, on which what slides may trip, as in rapier: use a polyline, a height field or one box.
//! - Attached bodies do not sleep. Pins and welds that contradict each other hold their island, step after step, as long as they last.
//! - Hooks' `tangent_velocity` is not looked at.
//! - Links of multibody joints are coupled staggered: momentum is kept to rounding in every step (where links turn, as rapier alone keeps it),
//!   forces at rest are exact, positions at a link miss by O(dt²), at an impact by up to 3/8 of the approach within the step. Links rest on the ground as softly as rapier lets them. A stiff body of
//!   small strain heavier than the link that a motor holds it with may tremble, and arms of several such links with motors swing. Islands with links allocate in every step, as rapier does for them.
//! - A joint to a flexible body's carrier is refused: attach nodes instead.
//! - Long chains of light links that a heavy body hits may gain a hundredth of the energy brought.
//! - What is solved in parts (`StepReport::n_parts`) tells of the step as a whole. The force of an impact on a body that spins turns with it before it
//!   has acted to its end: forces over time miss the momentum of bodies that turn by a tenth of a radian in a step by some hundredths of the blow.
//! - Where the mesh has too few nodes inside to carry the body's mass (up to about five cells across), or in a body one element thick, the
//!   surface keeps its mass: an impact within one step may then store more energy than there was (15 % at 2 × 2 cells, up to
//!   93 % seen in thin bars at 1/30 s), which is paid back as the body unloads. `ContactInertia::RedistributedAt` helps thin bars.
//! - Surfaces are led along a feasible path and stopped before they meet, whatever the forces do (`FlexParameters::feasible_path`). Not led, and solved
//!   with signed gaps as before, are pairs shown to hooks, links' own pairs, flexible bodies that overlap by more than a twelfth of a cell when they are inserted, rigid ones that overlap by more than a sixth
//!   of their widths, explicit steps and constraint functions. Of 1,000 random scenes of small strain (bodies of 1e5 to 1e9 Pa at up to 20 m/s, jointed at random)
//!   one had a body over 1 % of its size in another, one a rigid body that passed through the ground, and one gained more than 1 % of energy; in 137 one was
//!   crushed inside out, which small strains do not resist. In 12 of 2,000 later ones a step or more was stopped on its way
//!   (`Quality::Unfinished`). What flies near a flexible body and is flung
//!   into it within rapier's own step, by a motor or a joint, is not foreseen: the report of that step tells of it as `Unfinished`.
//! - Where friction wedges a corner against itself no sticking forces hold to the laws. The contact then slips by a thousandth to a tenth of what its force alone would move it,
//!   which `StepReport::slip_violation` tells. Joints and attachments that contradict each other are left open, which `StepReport::joint_violation` tells.
//! - A soft body that is crushed inside out, or by nine tenths of its size, may take a second for a step: passes hardly converge there, and each has a hard problem of contact.
//! - Flexible bodies rest `FlexBody::contact_offset` from terrain without thickness and from themselves, a hundredth of their shortest edge, so that they meet it that much
//!   earlier; each other, and rigid bodies with an inside, they touch. What has been folded or crushed keeps the offset from other flexible bodies.
//! - A step that can neither be solved nor stopped on its way without more energy than there was ends where it began: what touches moves on together, with the
//!   momentum that it had.
//! - What is heavier than the held body that it meets may gain energy: 4 of 720 balls did, 5 to 30 % of what they brought, all on welds. Of 720 lighter
//!   balls on bodies held by pins, damped in any way, none gained 1 % (`tests/damped_impact`).
//! - Welded bars that the step does not resolve may vibrate up under the trapezoidal rule, and one cell thick under `Beta2::damped(0.0)`: pin them,
//!   or keep to the default integrator.
//! - Bodies that are put into each other part by and by, or, where a surface passes right through the other, find no way out; `StepReport::gap_violation` tells how deep
//!   they are until they are apart. If no step can be found for such bodies, they
//!   fly and fall as one where nothing else is near, and stay where they are for a step, with the velocity that they have together, where something is; `StepReport::n_unfinished` and `unsolved` tell of such steps, which nothing sleeps in.
//! - A body that turns by a tenth of a radian or more in the step of an impact may store more elastic energy for that step than it brought
//!   (26 % seen at 0.37 rad a step); none of it is left in the next.
//! - Rigid boxes that spin fast into a pile at 1/60 s may overlap by up to 2 mm where it jams, and by .1 mm on a flexible slab.
//! - Free bodies so small and stiff that rounding hides their mass (steel of 0.2 mm at 1/60 s) are refused: shorten the step.
//! - Under the trapezoidal rule impacts through surfaces with mass (`ContactInertia::Kept`, coarse or thin bodies) may multiply the energy of what the step does not resolve
//!   (40 times seen); the default integrator keeps to what was brought.
//! - Hinged bodies of small strain are damped as they swing by the default integrator: a stiff pendulum loses 12 % of its energy in 60 s at 1/240 s, and
//!   keeps it under the trapezoidal rule. Chains of them swing about their energy by a few thousandths from step to step, and lose up to a third of it in 5 s at 1/60 s; of large strain, a thousandth.
//! - A flexible body falls asleep when it is in equilibrium to some eight digits, later than a rigid one; it never does under the trapezoidal rule
//!   without damping.
//! - Voxel and custom shapes meet no flexible body.
//! - A body of large strain meets itself on the feasible path, if it is no sensor. One of small strain passes through itself: bent so far, it is beyond what small strains describe
//!   (`StepReport::overbent`). One whose surface crosses itself all the same, as its pins were put so, is told in `StepReport::self_crossing` and passes through itself until it is
//!   apart. Contacts with itself are in `StepReport::contacts`, with the body on both sides, and make no events.

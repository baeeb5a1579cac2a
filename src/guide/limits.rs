//! What the crate cannot do, or does with an error that is known.
//!
//! Each entry says what is limited, what you **see** of it and what to **do**. The places to look at are [`StepReport::quality`], [`unsolved`](crate::pipeline::StepReport::unsolved) and the residuals
//! beside them, see [`reports`](super::reports); before a run, [`doctor::examine`](crate::doctor::examine).
//!
//! # Meshes
//!
//! - **Moments of inertia.** Mass lies in the nodes: that of a square of `n` by `n` cells is `1 + 2/n²` times too large (an eighth at four cells across, 3 % at eight). See: [`FlexBody::polar_moment`](crate::body::FlexBody::polar_moment). Do: take more cells where it matters how a
//!   body turns.
//! - **Stresses at the edge of `Quad4`** are those of the middle of its cells, so that they converge with the cells' size: at the bore of a cylinder twice as wide as its bore the pressure is told as 0.76 of what it is with five cells across the wall, 0.94
//!   with twenty; displacements are right within a hundredth. Do: take `Tri6` or `Quad8` where stress at a hole or an edge matters (a hundredth with five cells).
//! - **Tearing.** Bodies do not tear. Do: remove what has torn, and insert its pieces.
//!
//! # Large strain
//!
//! Bodies are of large strain unless you choose [`small_strain`](crate::body::FlexBodyBuilder::small_strain).
//!
//! - **Cost.** See: a step takes 1 to 6 times as long as with small strain, 1.8 times in the median of 100 random scenes. Do: take `small_strain` for what is stiff and bends by a few
//!   percent.
//! - **Crushed flat.** What is crushed flat at tens of metres a second may turn cells inside out (`StableNeoHookean`) or need its steps cut (`NeoHookean`, Hooke's law); crushed by nine
//!   tenths of its size, or by something driven against a wall, a step may take a second or two. See: [`Quality::Cut`](crate::pipeline::Quality::Cut), `Quality::Unfinished`, long steps. Do: take a stiffer material or shorter steps; a smaller
//!   [`FlexParameters::max_pivots`] ends what cannot be solved sooner.
//! - **Rolling.** What rolls or spins while it is pressed is braked, in proportion to its speed and to the step, because contact forces act wholly within their step. See: a tyre under 200 kg at 8 m/s loses 1.8 m/s in the first second at 1/60 s; a disc of rubber that rolls at 2 m/s loses 0.36 m/s in the first second at
//!   1/60 s, 0.09 m/s at 1/240 s, and 0.05 m/s at 1/60 s with small strain. What is stiff is braked as well: a disc of 2 GPa that comes to turn
//!   by .26 rad in a step ends a slope 6.5 % slower than it should with large strain, 0.7 % with small; a ring by .09 rad in a step 5.3 %, 1.1 % at a quarter of the step. Do: shorten the step, or take `small_strain`. A wheel
//!   is a polygon: from rest it takes the torque of its load at half a side to tip it over a corner. Do: take a smaller `target_edge`; that of an annulus is met at its mean radius, and outside sides are longer.
//! - **Belts.** What bends around a wheel meets it cell by cell, each within a step, and loses by that: a belt drive at 1/120 s whose brake takes 4.9 W at 1 m/s takes 5.2 W, one whose brake takes 20 W at 4 m/s takes 36 W. Told forces have the directions of the end of the step: their torque times
//!   the speed of a driven wheel is off by 4 % at 1/60 s, 1 % at 1/120 s; [`energy().dissipated`](crate::pipeline::EnergyReport::dissipated) is not. What newly met cells take from the velocities at the end of a step is given back within the next: the `angvel` of a driven wheel is less than it turns by, 0.88 of it for 1 kg at 1/60 s, 0.96 at 1/120 s, 0.99 at 1/240 s, and for a lighter one
//!   less. Do: shorten the step; count turns by `rotation`.
//! - **Bowls.** What slides in something hollow is met by other points of it in every step, and braked by as much as these come nearer within one: a disc of 5 cm in a bowl of 1 m without friction loses 0.10 of its energy in 5 s at 1/60 s; with small strain, whose
//!   normals are those of the end of each step, 0.29. Do: shorten the step.
//! - **Plane stress** of Hooke's law: the thickness does not change as the body is stretched. Do: take `NeoHookeanSheet` or `MooneyRivlinSheet` where it matters. With Poisson's ratios from -0.5 down it
//!   has no law for large strains and is refused ([`BuildError::NoLargeLaw`](crate::body::BuildError::NoLargeLaw)). Do: take `small_strain`, or plane strain.
//! - **Surface.** It keeps its mass; [`ContactInertia::RedistributedAt`](crate::body::ContactInertia::RedistributedAt) is refused
//!   ([`BuildError::LargeMassless`](crate::body::BuildError::LargeMassless)).
//! - **Inner pressure** acts on the edges of its hole, not on what else lies in there; holes do not join where walls meet. A gas couples all nodes around its hole, at a cost that grows with the
//!   square of their number. Do: mesh the hole no finer than needed.
//! - **Plasticity** is isotropic and independent of the rate, in plane strain. Where strains change their direction, its steps are of first order. A body that flows keeps its law for life
//!   ([`BuildError::FlowChanged`](crate::body::BuildError::FlowChanged)). A blow flows only what the step resolves: a metal bar of half a metre that hits a wall end-on at 30 m/s stops undented at 1/240 s, and flows from 1/4000 s on. Do: take steps shorter
//!   than a wave needs through the body. Pressed by something driven, a body that flows costs tens of times as much as an elastic one.
//!   A `Quad4` cell flows in bending from its fully plastic moment on, half as much again as what brings its edges to yield: with few of them across, what is bent by less springs back whole (of 1.4 times that, with 1, 2, 4 and 8 cells across, 0, 0,
//!   .2 and .5 of what should stay). Do: take `Tri6` or `Quad8` where that matters.
//! - **Islands of both kinds.** A body of small strain that touches one of large strain vibrates with more damping, of a ratio of about `0.25 ω dt` (ω in rad/s). Do: shorten the step, or make both of one kind.
//!
//! # Small strain
//!
//! - **Spin of small strain.** The tension of what spins does not stiffen it: a ring or strip that spins faster than it bends (its lowest frequency of bending) grows without bound. See: [`StepReport::overbent`], late. Do: take `large_strain`.
//! - **Centre of `Tri6` and `Quad8`.** As their surface takes its mass back after a contact, the centre of mass of a body that is deformed lies elsewhere than by the mass before (by 1e-5 of its size): momentum and energy go on as they were, the angular
//!   momentum about a fixed point changes by that times the momentum. See: by up to 3e-3 of `m v r` over a collision; not at all with `Quad4` and `Tri3`. Do: take these, or [`ContactInertia::Kept`](crate::body::ContactInertia::Kept).
//! - **Frequencies in contact.** While something may touch a body (rapier has a pair with its surface), or a pin or weld holds it to the world or to a rigid body that is no lighter than the nodes held, and in explicit steps, the mass of its surface is with the nodes inside, so that impacts are right; with few cells
//!   its frequencies change by that. See: the first of bending of a free bar ten times as long as high is then +17 % off at 10 × 2 cells (-3 % while nothing is near), +5 % at 20 × 2, +1.4 % at 40 × 4, that of one 3.3 times as long +53 % at 7 × 2, +19 % at 10 × 3, +1.7 % at 20 × 6;
//!   clamped bars are right in the first, +2 to +13 % off in the second. Do: take [`ContactInertia::Kept`](crate::body::ContactInertia::Kept) where vibrations matter more than impacts, more cells, or large strain, which keeps it.
//! - **Welded to what turns.** Nodes that a weld turns with its partner turn exactly, and the frame of the body sees `θ²/2` of it as a strain across the weld: a root or a tip that is welded stiffens with amplitude, by 0.6 % where the tip goes by a hundredth of the length, 2.3 % at two, 7.5 % at four.
//!   Do: pin by one node, or leave `small_strain` out.
//! - **Light on a length.** What is welded along much of a length to a rigid body, undamped, may vibrate up where that is light, but not [lighter](crate::body::ContactInertia::Redistributed) than the nodes held (0.04 J of 1e-4 J in 3 s seen), and so may what is welded to anything lighter while something touches it as well. See: `energy().dissipated` below zero,
//!   [`StepReport::overbent`], late. Do: give the material some damping (1e-3 s was enough), or leave `small_strain` out.
//! - **Slender and taut.** The frame is the mean of the nodes, against which tension bends a slender body more and more: from a strain of about `25 (h/L)²` on, .05 % for a steel tie two hundred times as long as wide. See: [`StepReport::overbent`], late. Do: leave
//!   `small_strain` out.
//! - **Contact forces** of small strain act on for the rest of their weight, half a step, after the contact is gone: a block whose ground is taken away falls a step later by half. Do: shorten the step, or leave `small_strain` out.
//! - **Springs of small strain** (attachments, and joints of rapier) act from the step after they are put in on: the error is of first order, half a step's way. Do: shorten the step, or take `large_strain`, where it is of second.
//! - **Jointed bodies of small strain give back what contacts took**, in single steps, as far as their island has lost energy before. See: two pinned bars of 1e7 Pa, undamped, that fall flat onto the ground at 5 m/s at 1/960 s lose 270 J of
//!   901 in two steps and have 293 J more after the next (23 had been lost in the air); in islands of tens of bodies, half of them on springs, it is kilojoules. Do: take `large_strain` (5 J of 901).
//! - **Strains of a few percent**, in one frame that moves and turns with the body as far as it likes. A clamped beam that sags by a tenth of its length is outside, and so is a rope. See: steps are
//!   solved and keep their energy, but the body is another one; [`StepReport::overbent`] names it. Do: leave `small_strain` out.
//! - **No contact with itself.** It passes through itself; bent so far it is outside anyhow.
//! - **Crushed inside out** without resistance. See: in 137 of 1,000 random scenes (1e5 to 1e9 Pa, up to 20 m/s, jointed at random) a soft body was. Do: leave `small_strain` out for what is soft.
//! - **Swinging on a hinge is damped** by the default integrator: a stiff pendulum of 1 m loses 15 % of its energy in 60 s at 1/240 s on a pin of the builder, 22 % on an attachment, 28 % of that from 2 rad. Chains swing about their energy by a few thousandths from step to step, and lose 42 to 44 % of
//!   it in 5 s at 1/60 s (rapier alone, rigid: 42 %), with large strain 21 to 49 %. Do: take the trapezoidal rule.
//! - **Shot at a sheet** at hundreds of metres a second and crushed far, a body may come out of its own surface, which itself stays on its side. See: `overbent`. Do: leave `small_strain` out.
//!
//! # Contact
//!
//! - **Offset.** Flexible bodies rest [`FlexBody::contact_offset`], a hundredth of their shortest edge and no less than what rapier's numbers tell apart there (9.5 mm at 10 km in `f32`), from terrain without thickness (polylines, height fields) and from
//!   themselves. Each other, and rigid bodies with an inside, they touch; what has been folded or crushed keeps the offset from other flexible bodies too.
//! - **Overlap.** Gaps of a solved step hold to rounding, and to some 1e-6 m where bodies press on edges that they slide to and fro over. See: [`StepReport::gap_violation`]. A step that is not solved may leave centimetres where bodies are
//!   not led along a path (next entry). It also counts what rapier has left between rigid bodies far from anything flexible, once these are taken over: such pairs part within some steps.
//! - **Who is led.** Surfaces are stopped before they meet, whatever forces do ([`FlexParameters::feasible_path`]). Not led, and solved by signed gaps, are: pairs whose contacts hooks take away or move, and rigid ones shown to hooks;
//!   flexible bodies that are inserted with an overlap of more than a twelfth of a cell, rigid ones of more than a sixth of their width; explicit steps; constraint functions. See: of 1,000 random scenes of small strain
//!   one had a body by over 1 % of its size in another, one a rigid body that passed through the ground, one gained over 1 % of energy; 12 of 2,000 later ones had an unfinished step.
//! - **Contacts that hooks take away or move.** A flexible body is led against what is shown to hooks as long as these keep all contacts that are met in the step where they are, with whatever friction, restitution and
//!   `tangent_velocity`. Where some of them are let through, or a normal or a distance is changed, each point is held by itself for that step. See: on polylines and height fields surfaces may then get into the ground between or beside their
//!   points, told as solved. Hooks see of every node, and of every corner of what it meets, the nearest part of a collider. Do: let hooks decide by what a body is, not by where its contacts are; make platforms that are open from below of boxes or
//!   single segments where bodies are wider than they are.
//! - **Statics between obstacles.** [`ContactStepper`](crate::large::ContactStepper) keeps nodes out of rigid obstacles, each node out of one. See: `LargeError::Wedged` where one would have to stay out of two, `LargeError::Passed` where an obstacle would go through the surface. What is smaller than a segment of the surface may go into it between two nodes up to its middle. Its bodies do not
//!   meet themselves or each other. Do: step such bodies in a world, with damping.
//! - **Nodes of the target.** Between flexible bodies the nodes of one are kept out of the surface of the other, not the other's out of its own. See: a node of a soft target may be inside by a millimetre (1.4 mm at E = 1e5 Pa,
//!   bodies of half a metre). Do: give both cells of about one size.
//! - **Quadratic surfaces on each other.** Between flexible bodies a surface is the polyline of its nodes, and what presses between two of these is shared out by the distances from them. A uniform pressure on the edge
//!   of a `Tri6` or `Quad8` cell comes to a sixth at its corners and two thirds at the node between, which on meshes that do not match no such shares add up to. See: a uniform pressure is told as 0.83 to 1.28 of what it is
//!   (0.4 to 1.64 where one mesh is four times as fine), at any fineness; its sum is right, and stresses in the cells are off by 10 % beside the surface, 2 % with cells four times as small. `Quad4` and `Tri3` have it exactly, as all have on
//!   what is rigid and where nodes match. Do: take linear cells, or nodes that match, where pressures between flexible bodies matter.
//! - **Load control** may step over a limit load: [`LoadStepper`](crate::large::LoadStepper) and `ContactStepper` then find an equilibrium far away, and say nothing of it. Do: look at how far an increment went, or follow the path with [`PathStepper`](crate::large::PathStepper).
//! - **Partial slip.** Where a ball, or another rounding larger than the edges it presses, presses many of them, sums of forces and pressures are right, but which of the nodes that stick carry the friction is not: single ones are off by up to all that friction can hold, of
//!   either sign, and change from step to step. See: [`FlexBody::contact_force`](crate::body::FlexBody::contact_force). Do: switch [`FlexParameters::feasible_path`] off where tractions are asked for (then next to the mesh, at ten times the cost). [`ContactReport::sticks`](crate::pipeline::ContactReport::sticks) is of the step alone: once a load is held, all sticks.
//! - **Wedged corners.** Where friction wedges a corner against itself no sticking forces hold to the laws, and the contact slips by a thousandth to a tenth of what its force alone would move it. See:
//!   [`StepReport::slip_violation`]. Forces of such contacts may be of any size; what they would set in motion is not: the step is cut, or ends without them (`Quality::Unfinished`).
//! - **Put into each other**, bodies part by and by: what of one lies in or beyond the other is led out, to where the larger part of it is. Polylines and height fields have no inside: a body with more than half of it below one comes out below. What is wholly in something else, across none of its surface, leaves by one face,
//!   chosen by its centre, where weight or a push moves it; what is fixed or kinematic, or at rest without weight, stays in there, and all may fall asleep so (57 of 60). Two things that lead a body in opposite ways never let it out. See: [`StepReport::insertion_notes`] once, `gap_violation` until they are apart, `Quality::Unfinished`. Do: put them apart; [`doctor::examine`](crate::doctor::examine) names them.
//! - **Platforms that accelerate.** What lies on a kinematic body slips on it by a part of `a dt²` in every step though friction would hold: at 3 m/s² and 1/60 s by up to 34 mm in a second with small strain, 9 mm with
//!   large, 6 mm in rapier alone. Do: shorten the step. On one that falls away by more than some .3 g (half of g with large strain) it presses in alternate steps only, by the right force in the mean, at any step.
//! - **A surface that crosses itself** because its pins were put so passes through itself until it is apart. See: [`StepReport::self_crossing`]. Sensors do not meet themselves. Contacts of a body with itself are in [`StepReport::contacts`],
//!   with the body on both sides, and make no events.
//! - **Flung within a step.** What flies near a flexible body and is flung into it within rapier's own step, by a motor or a joint, is not foreseen. See: [`Quality::Unfinished`](crate::pipeline::Quality::Unfinished) in that step; it
//!   is solved for from the next one on.
//! - **No way forward.** A step that can neither be solved nor stopped on its way without gaining energy ends where it began: what touches moves on together with its momentum, or, where bodies were put into each other beside
//!   something else, waits; it is tried in all parts and some finer ones again after a few such steps, then after twice as many, and so on. See: `Quality::Unfinished`; nothing sleeps in such steps. Do: shorten the step, look at who is named.
//!
//! # Impacts and energy
//!
//! What a step does not resolve is damped, not drawn; by the default integrator no impact gains energy but for these.
//!
//! - **Few cells.** In a mesh with too few inner nodes to carry the mass (up to some five cells across), or one cell thick, the surface keeps its mass. See: an impact within one step stores more energy than there was until the body unloads
//!   (15 % at 2 × 2 cells, up to 93 % in thin bars at 1/30 s). Do: take more cells, or [`ContactInertia::RedistributedAt`](crate::body::ContactInertia::RedistributedAt) for thin bars of small strain.
//! - **Waves.** A bar of small strain that hits a wall keeps part of its energy as waves that its surface without inertia leaves behind, however fine mesh and step are: it rebounds with 0.93 of its velocity (two cells across) or 0.965 (six). Do: take
//!   [`ContactInertia::RedistributedAt`](crate::body::ContactInertia::RedistributedAt) at its end, or `large_strain`: both come nearer to 1 as they are refined.
//! - **Directions.** What a blow with friction does to a body of large strain within one long step is answered by a tangent from somewhere in that step: the same scene, turned as a whole, may tell up to 29 % more or less for the force of that step
//!   (127 of 200 turned scenes differed at 1/60 s, 23 at 1/240 s). Do: shorten the step.
//! - **Trapezoidal rule.** A stiff body of small strain that a pin has jerked rings on with a fifth more energy than it should have left. Impacts through surfaces with mass may multiply the energy of what the step does not resolve (40 times seen). Do: keep to the default integrator, or resolve the impacts.
//! - **Heavy on welds.** What is heavier than the welded body that it hits may gain energy: 4 of 720 balls, by 5 to 30 % of what they brought. None of 720 lighter ones on pins gained 1 %. Do: pin nodes in the builder instead of welding.
//! - **Turning in an impact.** A body that turns by 0.1 rad or more in the step of an impact may store more elastic energy for that step (26 % at 0.37 rad); none is left in the next.
//! - **Restitution of many.** Bodies that touch in a row rebound all at once, as Newton's law has it: of three balls that touch, or come to do so within the step, a blow of 2 m/s with a restitution of 1 leaves -2/3, 4/3 and 4/3 m/s, where a cradle's
//!   last one would have all of it. Where friction would let what rebounds gain energy, all that touches there rebounds by less. What something else touches or holds is struck at the end of the step: it is late by `e v dt` at most, and turned by levers that are off by `v dt`.
//!   Do: leave gaps that a step resolves, or shorten the step.
//! - **Deep in each other.** Flexible bodies that are put, or let, into each other by more than their [`FlexBody::contact_offset`] with edges that cross may be pressed apart by forces that do not agree with each other (2.3 J that became 30 J, of plates 5 cm inside each other; 3.9 kJ that became 600 kJ, of stiff rings half inside). Half a dozen at one place cost a second a step until they are apart. See:
//!   [`StepReport::gap_violation`], `energy().dissipated` below zero. Do: keep them apart; an attachment that switches contact off lets them meet.
//! - **Chains of light links** that a heavy body hits may gain a hundredth of the energy brought.
//! - **Welded bars** that the step does not resolve may vibrate up under the trapezoidal rule, and one cell thick under `Beta2::damped(0.0)`. Do: pin them, or keep to the default integrator.
//! - **Parts of a step.** What is solved in parts ([`StepReport::n_parts`]) tells of the step as a whole; the force of an impact on a body that spins turns with it. See: forces over time miss the
//!   momentum of bodies that turn by 0.1 rad in a step by some hundredths of the blow.
//! - **Small and stiff.** Free bodies whose mass rounding hides (steel of 0.2 mm at 1/60 s) are refused ([`StepError::Factorization`](crate::pipeline::StepError::Factorization)). Do: shorten the step.
//!
//! # Joints and attachments
//!
//! - **Too far apart.** Pins and welds do not pull flexible bodies together over more than half the size of the smaller one. See: [`AttachmentError::TooFar`](crate::body::AttachmentError::TooFar). Do: put them nearer, or take a spring.
//! - **In contradiction**, joints and attachments are left open, and pins and welds hold their island as long as that lasts. See: [`StepReport::joint_violation`], `Quality::Cut`. Do: leave one of them out.
//! - **Inside each other.** Rigid bodies that a joint welds to each other, or pins at a point inside both by a millimetre or more, do not press each other where they are solved with flexible ones: contact would pull the joint open, as it does in rapier alone. Do: let links end at their joints, or say `contacts_enabled(false)`.
//! - **Round and hinged where they touch.** A ball or capsule hinged to a neighbour at the very point where the two touch cannot turn without going into it, so hinge and contact push against each other with forces of any size. See: a gain of some hundredths
//!   of the energy, more than a fifth in 14 of 660 random scenes; [`Quality::Cut`](crate::pipeline::Quality::Cut). Do: say `contacts_enabled(false)`, or leave half a millimetre between them.
//!   The same goes for flexible bodies that are welded end to end: with `contacts_enabled(true)` a falling chain of three to six bars may gain kilojoules in single steps that are told as solved. Leave contacts off there.
//! - **Taut chains.** A joint between rigid bodies that carries all which is joined with it opens by 1e-5 of the way that this falls within a step (1.4e-8 m at 1/60 s). What would have to be straight so hangs by some hundredths or thousandths of its length:
//!   ten planks between posts that are as far apart as these are long, 3 m, by 4 mm at 1/60 s and 1.6 mm at 1/240 s. One that is too short is left open. See: [`StepReport::joint_violation`]. Levers multiply it: an arm of 4 m on two hinges 2 cm apart sags by 0.8 mm at its end at 1/60 s, by 0.05 mm
//!   at 1/240 s, by 5e-6 m if they are 20 cm apart. Do: shorten the step, or weld by `FixedJoint` (8e-8 m at 1/60 s).
//! - **Light hubs.** A spring or position motor at a rigid body that carries flexible bodies of small strain alone is resolved by the mass of the rigid body, not of what is welded to that: one of 1,000 N/m at 1/60 s that moves 10 kg is damped away within
//!   seconds if its own body has less than 0.07 kg. Do: take large strain, which swings, give the hub more mass, or shorten the step.
//! - **Pins that speed up** give a body the velocity of each step as it begins; what the step does not resolve follows at once, without strain. See: a bar of rubber (ω dt = 0.8) that is drawn at a constant acceleration is stretched by 0.85 of what it should be with small strain, 1.14 with large; the
//!   [`reaction`](crate::body::FlexBody::reaction) is right, of a body of small strain on a single pin as long as nothing touches it. Do: shorten the step, or weld to a world that moves ([`Attachment::set_target`](crate::body::Attachment::set_target)).
//! - **Many nodes on one weld** are solved with each other, at the square of their number or more: two strips welded by 161 nodes take 140 times as long as one of both thicknesses. Do: weld fewer nodes, or mesh what belongs together as one body of [regions](crate::body::FlexBodyBuilder::regions_by).
//! - **Sleep.** Attached bodies do not sleep.
//! - **Carriers.** A joint to the rigid body that carries a flexible one is refused ([`StepError::CarrierJoint`](crate::pipeline::StepError::CarrierJoint)). Do: attach nodes, [`FlexBodySet::attach`](crate::body::FlexBodySet::attach).
//!
//! # Rapier
//!
//! - **Multibodies** that touch or hold something flexible are solved with it, all links of them, by the rows that impulse joints have. Of their numbers, an armature weighs on the link that the joint moves (the same where the parent stands still; where
//!   that moves, too little reaches it), a link's locked axes are passed over, one that weighs nothing weighs a millionth of all, and a coupling of two coordinates is solved where both are angles of joints; other couplings are refused ([`StepError::Coupling`](crate::pipeline::StepError::Coupling)). Joints of
//!   multibodies tell no impulses of motors and limits. Rapier alone does not move a multibody's kinematic root, and moves what
//!   hangs on it twice as far as its velocities say; solved here, it swings as on a fixed one. Rope and spring joints of multibodies hold here, in rapier alone they do not.
//! - **Put to sleep by hand** on a kinematic body, a rigid one that was woken before falls through it while it sleeps, in rapier 0.36.1 alone as well, and into what is flexible below. Do: leave sleep to rapier.
//! - **Contact pairs** of what is solved here tell no impulses: rapier lets nobody else write what `contact_pair(..)` has of them. Do: take [`StepReport::contacts`], or contact force events.
//! - **Dominance.** A rigid body of positive dominance is met as one that is moved: it goes through what is pinned, and squeezes what lies on something else flat, with energy as from nowhere (a box on a free block of 5e6 Pa: 8 MJ). See: unfinished steps. One of negative dominance rests as it
//!   should, but forces on it are told by a millionth, and where it is pressed from both sides its velocity may be anything for a step (359 m/s in 1 of 40 scenes). Do: leave dominance out.
//! - **Fast bodies.** Rapier holds rigid bodies to 400 times the `length_unit` a second; flexible ones go on as they are. See: a ball shot at 500 m/s arrives with 400. Do: choose the `length_unit` of your world (pixels to a metre).
//! - **Fast spin.** Rapier turns a rigid body by no more than an eighth of a turn in a step, and takes what is more out of its spin: at 1/60 s beyond 47 rad/s. Do: shorten the step.
//! - **Seams.** Boxes laid flush have seams by rapier's rounding, on which what slides may trip, as in rapier. Do: take a polyline, a height field or one box.
//! - **Piles of rigid boxes** that spin fast into each other at 1/60 s may overlap by up to 2 mm where they jam, by 0.1 mm on a flexible slab.
//! - **Continuous collision detection.** Off the feasible path, rapier may stop a rigid body short of where it was solved to be, at a fixed collider that it jams against: 5e-5 m of overlap at 1/30 s.
//! - **Queries and sensors see the surface alone.** A flexible body's collider is its outline, not what is inside: points, small shapes and rays from inside meet nothing there, and a trigger smaller than the body that crosses it starts and stops twice. Do:
//!   ask [`FlexBody::contains`](crate::body::FlexBody::contains) beside the query.
//! - **Carriers do not pass on** what is asked of the rigid body under a flexible one: impulses, forces, gravity scale, damping, mass and `sleep()` have no effect there, and rapier's character controller cannot push it. Do: ask the [`FlexBody`](crate::body::FlexBody), found by
//!   [`FlexBodySet::of_collider`](crate::body::FlexBodySet::of_collider).
//! - **Not met**: voxels and custom shapes; flexible bodies go through them. See: [`doctor::examine`](crate::doctor::examine). Do: take a polyline or a compound of convex shapes.
//!
//! # Explicit steps
//!
//! - **At rest in contact** a body tells the velocity `-g dt/2` for ever, its single nodes more, and does not fall asleep; `energy().kinetic` is right.
//! - **No attachments**, and no light rigid body on an explicit one: both are refused, the second in the step in which it is met.
//! - **`EnergyReport::swing`** makes the energy constant for central differences alone.
//! - **Changed for another integrator** on the way, contact forces of one step are half of what they should be, or twice.
//!
//! # Rest and sleep
//!
//! - Stresses of the laws for sheets and rubber, Hencky's and yours are known to 1e-16 of their moduli, and not to the digits of the strain as those of the other laws are beside rest.
//! - A flexible body falls asleep when it has stayed within a millionth of its size, its loads balanced to six digits, later than a rigid one: stacks that sway slowly after tens of seconds; under the trapezoidal rule without damping it may never. Do: give it damping. Beyond some 3 km
//!   from the origin, in `f32`, it does not: its places are not told that finely. Do: keep the origin near, or take `f64`.
//! - Loads below what would move a body by a millionth of its size until it sleeps do not keep it awake: it falls asleep under 1e-6 m/s².
//!
//! [`FlexBody::contact_offset`]: crate::body::FlexBody::contact_offset
//! [`FlexParameters::feasible_path`]: crate::pipeline::FlexParameters::feasible_path
//! [`FlexParameters::max_pivots`]: crate::pipeline::FlexParameters::max_pivots
//! [`StepReport::contacts`]: crate::pipeline::StepReport::contacts
//! [`StepReport::gap_violation`]: crate::pipeline::StepReport::gap_violation
//! [`StepReport::insertion_notes`]: crate::pipeline::StepReport::insertion_notes
//! [`StepReport::joint_violation`]: crate::pipeline::StepReport::joint_violation
//! [`StepReport::n_parts`]: crate::pipeline::StepReport::n_parts
//! [`StepReport::overbent`]: crate::pipeline::StepReport::overbent
//! [`StepReport::quality`]: crate::pipeline::StepReport::quality
//! [`StepReport::self_crossing`]: crate::pipeline::StepReport::self_crossing
//! [`StepReport::slip_violation`]: crate::pipeline::StepReport::slip_violation

//! What rapier hears instead of the user's hooks.

use super::HookBook;
use crate::coupling::claim::Claims;
use crate::coupling::pair_name::pair_name;
use crate::rapier::prelude::*;

/// The hooks that rapier is given in place of the user's.
pub(crate) struct HookGate<'a> {
    /// The user's.
    pub user: &'a dyn PhysicsHooks,
    /// What they said of our contacts.
    pub book: &'a HookBook,
    /// Carriers and claimed bodies.
    pub claims: &'a Claims,
    /// Whether this is the full step, in which claimed bodies are locked.
    pub is_full: bool,
}

impl HookGate<'_> {
    /// Whether the flexible stage asks the user itself.
    fn is_ours(&self, handles: [ColliderHandle; 2], colliders: &ColliderSet) -> bool {
        handles.iter().any(|&handle| {
            self.claims.flex.is_surface(handle)
                || (self.is_full && self.claims.has_collider(handle, colliders))
        })
    }
}

impl PhysicsHooks for HookGate<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let [one, other] = [context.collider1, context.collider2];
        let name = pair_name(one, other);
        let answered = self.claims.answer(name);
        match answered.filter(|_| self.is_full) {
            Some(answer) => answer,
            None => self.user.filter_contact_pair(context),
        }
    }

    fn filter_intersection_pair(&self, context: &PairFilterContext) -> bool {
        self.user.filter_intersection_pair(context)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let handles = [context.collider1, context.collider2];
        if !self.is_ours(handles, context.colliders) {
            return self.user.modify_solver_contacts(context);
        }
        let [one, other] = handles;
        let is_left = self.book.left.get(&pair_name(one, other));
        if let (Some(rigid), false) = (context.rigid_mut(), is_left.copied().unwrap_or(false)) {
            // What touches nothing must not start a collision.
            rigid.solver_contacts.clear();
        }
    }
}

//! Who is who: the names that a scene gives its bodies, for the handles that the library knows them by.

use super::at::At;
use super::problem::Problem;
use super::source::Source;
use foil2d::body::{AttachmentHandle, FlexBodyHandle};
use foil2d::pipeline::Participant;
use foil2d::rapier::prelude::{ColliderHandle, ImpulseJointHandle, RigidBodyHandle};
use std::collections::BTreeMap;

/// A rigid body with its collider, and what it is called.
pub struct RigidEntry {
    pub body: RigidBodyHandle,
    pub collider: ColliderHandle,
    label: String,
}

/// The bodies of a scene.
#[derive(Default)]
pub struct Names {
    pub flexible: BTreeMap<String, FlexBodyHandle>,
    /// All, in the order of the scene.
    rigid: Vec<RigidEntry>,
    /// Places in that order of those that have names.
    named: BTreeMap<String, usize>,
    pub joints: Vec<ImpulseJointHandle>,
    pub attachments: Vec<AttachmentHandle>,
}

impl Names {
    /// Takes in a rigid body.
    pub fn add_rigid(
        &mut self,
        name: Option<&At<String>>,
        body: RigidBodyHandle,
        collider: ColliderHandle,
    ) {
        let index = self.rigid.len();
        let label = match name {
            Some(name) => {
                self.named.insert(name.get().clone(), index);
                format!("`{}`", name.get())
            }
            None => format!("the {} of `rigid`", nth(index + 1)),
        };
        self.rigid.push(RigidEntry {
            body,
            collider,
            label,
        });
    }

    /// Refuses a name that another body has.
    pub fn refuse_taken(&self, source: &Source, name: &At<String>) -> Result<(), Problem> {
        let own = name.get();
        if own.trim().is_empty() {
            return Err(source.problem(name, "a name is not to be empty"));
        }
        match self.named.contains_key(own) || self.flexible.contains_key(own) {
            true => Err(source.problem(
                name,
                format!("there is a body `{own}` already: give each its own name"),
            )),
            false => Ok(()),
        }
    }

    /// The flexible body of a name.
    pub fn flexible_named(
        &self,
        source: &Source,
        name: &At<String>,
    ) -> Result<FlexBodyHandle, Problem> {
        let found = self.flexible.get(name.get()).copied();
        let known = self.flexible.keys();
        found.ok_or_else(|| source.problem(name, no_such("flexible body", name.get(), known)))
    }

    /// The rigid body of a name.
    pub fn rigid_named(&self, source: &Source, name: &At<String>) -> Result<&RigidEntry, Problem> {
        let known = self.named.keys();
        self.rigid_if_named(name.get())
            .ok_or_else(|| source.problem(name, no_such("rigid body", name.get(), known)))
    }

    pub fn rigid_if_named(&self, name: &str) -> Option<&RigidEntry> {
        self.rigid.get(*self.named.get(name)?)
    }

    /// Names of all bodies that have one.
    pub fn all(&self) -> impl Iterator<Item = &String> {
        self.flexible.keys().chain(self.named.keys())
    }

    pub fn of_flexible(&self, handle: FlexBodyHandle) -> String {
        let found = self.flexible.iter().find(|(_, own)| **own == handle);
        found.map_or("a flexible body".to_owned(), |(name, _)| {
            format!("`{name}`")
        })
    }

    pub fn of_collider(&self, handle: ColliderHandle) -> String {
        self.label_where(|one| one.collider == handle)
    }

    pub fn of_rigid(&self, handle: RigidBodyHandle) -> String {
        self.label_where(|one| one.body == handle)
    }

    fn label_where(&self, is_it: impl Fn(&RigidEntry) -> bool) -> String {
        let found = self.rigid.iter().find(|one| is_it(one));
        found.map_or("a rigid body".to_owned(), |one| one.label.clone())
    }

    pub fn of_participant(&self, participant: Participant) -> String {
        match participant {
            Participant::Flex(handle) => self.of_flexible(handle),
            Participant::Rigid(handle) => self.of_collider(handle),
        }
    }

    pub fn of_participants(&self, all: &[Participant]) -> String {
        let all: Vec<String> = all.iter().map(|&one| self.of_participant(one)).collect();
        all.join(", ")
    }

    pub fn of_joint(&self, handle: ImpulseJointHandle) -> String {
        numbered("joint", self.joints.iter().position(|&own| own == handle))
    }

    pub fn of_attachment(&self, handle: AttachmentHandle) -> String {
        let place = self.attachments.iter().position(|&own| own == handle);
        numbered("attachment", place)
    }
}

fn numbered(list: &str, index: Option<usize>) -> String {
    match index {
        Some(index) => format!("the {} of `{list}`", nth(index + 1)),
        None => format!("one of `{list}`"),
    }
}

fn nth(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1, rest) if rest != 11 => "st",
        (2, rest) if rest != 12 => "nd",
        (3, rest) if rest != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Says that there is nothing of a name, and what there is.
pub fn no_such<N: AsRef<str>>(
    kind: &str,
    name: &str,
    known: impl IntoIterator<Item = N>,
) -> String {
    let known: Vec<String> = known
        .into_iter()
        .map(|one| format!("`{}`", one.as_ref()))
        .collect();
    match known.as_slice() {
        [] => format!("there is no {kind} `{name}`: there is none with a name"),
        _ => format!(
            "there is no {kind} `{name}`: choose one of {}",
            known.join(", ")
        ),
    }
}

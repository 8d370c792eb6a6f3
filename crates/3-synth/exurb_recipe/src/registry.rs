//! All operations of the stage crates in one list.

use exurb_operation::{AnyOperation, Card};

/// The operations that recipes and commands can name.
pub struct Registry {
    operations: Vec<Box<dyn AnyOperation>>,
}

impl Registry {
    /// Every operation of this program, by stage and method.
    pub fn all() -> Self {
        let stages = [
            exurb_streets::operations(),
            exurb_blocks::operations(),
            exurb_buildings::operations(),
        ];
        Self::new(stages.into_iter().flatten().collect())
    }

    /// A list of one's own.
    pub fn new(operations: Vec<Box<dyn AnyOperation>>) -> Self {
        Self { operations }
    }

    /// The operations in order.
    pub fn iter(&self) -> impl Iterator<Item = &dyn AnyOperation> {
        self.operations.iter().map(Box::as_ref)
    }

    /// The operation of those command words. The error says which there are.
    pub fn find(&self, name: &str) -> Result<&dyn AnyOperation, String> {
        self.iter().find(|operation| operation.card().name() == name).ok_or_else(|| {
            let known: Vec<String> =
                self.iter().map(|o| format!("`{}`", o.card().name())).collect();
            format!("there is no operation `{name}`; there are {}", known.join(", "))
        })
    }
}

/// Does the operation work on a city that is already there, rather than begin one? Every method of
/// the stage `streets` begins a city but `furnish`, which puts trees and lamps along its streets.
pub fn needs_city(card: &Card) -> bool {
    card.stage != "streets" || card.method == "furnish"
}

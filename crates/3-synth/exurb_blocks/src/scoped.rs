use exurb_city::{Block, City};
use exurb_geom::GridPoint;
use exurb_operation::Scope;

/// The blocks an operation may change.
pub struct Scoped {
    held: Vec<u32>,
}

impl Scoped {
    /// The blocks of `scope`: those with a point well inside it and inside the city's target.
    pub fn of(city: &City, blocks: &[Block], scope: &Scope) -> Self {
        let inside = |block: &&Block| match scope {
            Scope::All => true,
            Scope::Inside(area) => area.contains(GridPoint::round(block.polygon.interior_point())),
            Scope::Blocks(ids) => ids.contains(&block.id),
        };
        let in_target =
            |block: &&Block| city.target.contains(GridPoint::round(block.polygon.interior_point()));
        let mut held: Vec<u32> =
            blocks.iter().filter(inside).filter(in_target).map(|b| b.id).collect();
        held.sort_unstable();
        Self { held }
    }

    /// May the block of that number change?
    pub fn holds(&self, block: u32) -> bool {
        self.held.binary_search(&block).is_ok()
    }
}

/// Why a block was not laid out anew.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// There is no such block.
    #[error("there is no block {block}; the city has blocks 1 to {count}")]
    NoSuchBlock {
        /// The number asked for.
        block: u32,
        /// How many there are.
        count: usize,
    },
    /// Nothing is built on islands.
    #[error("block {0} is an island too narrow to build on; choose another")]
    Island(u32),
    /// The outline cannot be a block's.
    #[error(
        "`outline` crosses or touches itself, or has no area; draw one simple polygon around the block"
    )]
    Outline,
}

/// Why no layout was transferred.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// There are no streets that enclose anything.
    #[error("the city has no blocks to fill; its streets enclose nothing")]
    NoBlocks,
    /// There is nothing to take from.
    #[error(
        "the examples have no block with buildings; take an example whose streets enclose buildings, or \
         use `blocks parcels` and `blocks footprints`"
    )]
    EmptyDatabase,
}

/// Why there are no parcels.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A parameter is out of range.
    #[error("{0}")]
    Params(String),
    /// There is no block to cut.
    #[error("the city has no streets that enclose a block; grow streets first")]
    NoBlocks,
}

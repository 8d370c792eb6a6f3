/// Why there are no footprints.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// There is nothing to build on.
    #[error("the city has no parcels; run `blocks parcels` first")]
    NoParcels,
}

//! Streams of random numbers.
//!
//! Every operation and, inside it, every element that can be worked on alone (a cell, a block, a
//! building) draws from a stream of its own, so that neither the number of threads nor an edit next
//! door changes the draw.

use rand::SeedableRng;

/// The generator of every draw: fixed across versions and machines.
pub type Rng = rand_chacha::ChaCha8Rng;

/// The stream of `seed`, an operation's name, and an element's key. Equal arguments give equal
/// streams; any difference gives an unrelated one.
pub fn stream(seed: u64, operation: &str, element: u64) -> Rng {
    let mut rng = Rng::seed_from_u64(seed ^ fnv1a(operation.as_bytes()));
    rng.set_stream(element);
    rng
}

/// FNV-1a, 64 bit: a hash that stays the same for ever, for keys of streams.
pub fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The key of an element by its place: the same place gives the same stream whatever its number.
pub fn place_key(at: exurb_geom::GridPoint) -> u64 {
    let (x, y) = (at.x.to_le_bytes(), at.y.to_le_bytes());
    fnv1a(&[x, y].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn streams_differ_by_seed_operation_and_element() {
        let first = |mut rng: Rng| rng.random::<u64>();
        let a = first(stream(1, "streets grow", 0));
        assert_eq!(a, first(stream(1, "streets grow", 0)));
        assert_ne!(a, first(stream(2, "streets grow", 0)));
        assert_ne!(a, first(stream(1, "streets walk", 0)));
        assert_ne!(a, first(stream(1, "streets grow", 1)));
    }
}

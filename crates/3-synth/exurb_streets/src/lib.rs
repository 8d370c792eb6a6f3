//! Street networks by example.
//!
//! | room | method | source |
//! |---|---|---|
//! | [`grow`] | growth that copies patches of the example and falls back to its statistics | Nishida, Garcia-Dorado, Aliaga 2015 |
//! | [`furnish`] | trees and lamps along streets | Nishida, Garcia-Dorado, Aliaga 2015 |
//!
//! [`operations()`] is the only list of rooms.

pub mod furnish;
pub mod grow;
mod operations;

pub use operations::operations;

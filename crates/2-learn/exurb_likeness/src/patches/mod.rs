//! The discriminator: can patches of two cities be told apart by their look?
//!
//! Streets are drawn at 8 m a pixel; 160 random patches of 512 m are cut from each city, turned and
//! mirrored at random. Features are learned without labels: k-means filters on whitened pieces of
//! 8 x 8 px at two scales, soft activation, pooled by mean and root mean square.
//!
//! Sources: Coates, Ng, Lee 2011, *An analysis of single-layer networks in unsupervised feature
//! learning* (filters, whitening, activation); Lopez-Paz & Oquab 2017, *Revisiting classifier
//! two-sample tests*; Bińkowski et al. 2018, *Demystifying MMD GANs* (cubic kernel). Departures: two
//! scales; root mean square beside mean pooling; mean and spread of the plain patch are features,
//! too; train and test patches lie in different halves of both cities, so that the classifier cannot
//! learn places.

mod classifier;
mod dictionary;
mod features;
mod image;
mod kernel;

pub use classifier::area_under_curve;
pub use classifier::told_apart;
pub use dictionary::{Dictionary, Filters, LearnError};
pub use features::{CANDIDATE, HELD_OUT, Patches};
pub use image::Image;
pub use kernel::kernel_distance;

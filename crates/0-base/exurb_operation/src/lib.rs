//! The one trait of every method: parameters, runs, cards.

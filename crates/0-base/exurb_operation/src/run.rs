use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::{Failure, Rng, rng};

/// Something a user should know although the work went on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The operation's command words, or the file read.
    pub from: String,
    /// What happened and what to do.
    pub message: String,
}

/// What an operation is handed: seeded streams, progress, cancelling, a place for warnings.
///
/// Clones share everything but the name, so that a run can be watched and cancelled from another
/// thread.
#[derive(Clone, Debug)]
pub struct Run {
    seed: u64,
    name: String,
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    cancelled: AtomicBool,
    /// Done and total, packed as two `u32`.
    progress: AtomicU64,
    phase: Mutex<String>,
    warnings: Mutex<Vec<Warning>>,
    tallies: Mutex<BTreeMap<String, u64>>,
}

impl Run {
    /// A run with the given random seed.
    pub fn new(seed: u64) -> Self {
        Self { seed, name: String::new(), shared: Arc::default() }
    }

    /// The same run under the name of an operation, which its streams and warnings carry.
    pub fn named(&self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self.clone() }
    }

    /// The same run with another random seed, for a step that has its own.
    pub fn seeded(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// The random seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The stream of one element of this operation; see [`rng`].
    pub fn stream(&self, element: u64) -> Rng {
        rng::stream(self.seed, &self.name, element)
    }

    /// Asks the work to stop.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// An error when the work was asked to stop. Operations call it at least every 50 ms of work.
    pub fn check(&self) -> Result<(), Failure> {
        if self.is_cancelled() { Err(Failure::Cancelled) } else { Ok(()) }
    }

    /// Was the work asked to stop?
    pub fn is_cancelled(&self) -> bool {
        self.shared.cancelled.load(Ordering::Relaxed)
    }

    /// Begins a phase of work under a name a user understands.
    pub fn phase(&self, name: &str) {
        name.clone_into(&mut self.shared.phase.lock().unwrap_or_else(PoisonError::into_inner));
        self.shared.progress.store(0, Ordering::Relaxed);
    }

    /// Tells how much of the phase is done.
    pub fn progress(&self, done: u32, total: u32) {
        self.shared.progress.store(u64::from(total) << 32 | u64::from(done), Ordering::Relaxed);
    }

    /// Phase, done and total, for whoever shows it.
    pub fn status(&self) -> (String, u32, u32) {
        let packed = self.shared.progress.load(Ordering::Relaxed);
        let phase = self.shared.phase.lock().unwrap_or_else(PoisonError::into_inner).clone();
        (phase, packed as u32, (packed >> 32) as u32)
    }

    /// Notes something the user should know.
    pub fn warn(&self, message: impl Into<String>) {
        let warning = Warning { from: self.name.clone(), message: message.into() };
        let mut list = self.shared.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        if !list.contains(&warning) {
            list.push(warning);
        }
    }

    /// Counts what was done, and why, for the result to tell: `what` is a few words in the plural.
    pub fn tally(&self, what: &str, count: u64) {
        if count > 0 {
            let mut all = self.shared.tallies.lock().unwrap_or_else(PoisonError::into_inner);
            *all.entry(what.to_owned()).or_default() += count;
        }
    }

    /// What was counted so far, by name.
    pub fn tallies(&self) -> BTreeMap<String, u64> {
        self.shared.tallies.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Takes the warnings noted so far.
    pub fn take_warnings(&self) -> Vec<Warning> {
        std::mem::take(&mut self.shared.warnings.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

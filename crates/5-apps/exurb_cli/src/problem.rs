//! What goes wrong at the edge: one or two sentences and an exit status.

use exurb_operation::Failure;

/// Why a command did not do its work.
#[derive(Debug, PartialEq, Eq)]
pub struct Problem {
    /// Exit status: 1 the work failed, 2 wrong usage or unreadable input.
    pub status: u8,
    /// What is wrong, where, and what to do.
    pub message: String,
}

impl Problem {
    /// The work failed.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { status: 1, message: message.into() }
    }

    /// Wrong usage or unreadable input.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { status: 2, message: message.into() }
    }
}

impl From<exurb_recipe::Error> for Problem {
    fn from(error: exurb_recipe::Error) -> Self {
        let status = if error.is_usage() { 2 } else { 1 };
        Self { status, message: error.to_string() }
    }
}

impl From<Failure> for Problem {
    fn from(failure: Failure) -> Self {
        exurb_recipe::Error::from(failure).into()
    }
}

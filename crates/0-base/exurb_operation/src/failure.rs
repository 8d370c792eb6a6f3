/// Why an operation did not do its work. Errors of a room are folded into it at the room's border.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A parameter is out of range or unknown.
    #[error("{operation}: {message}")]
    Params {
        /// The operation's command words.
        operation: String,
        /// Which parameter, what it is, what is expected.
        message: String,
    },
    /// The examples lack what the method learns from.
    #[error("{operation}: {message}")]
    Example {
        /// The operation's command words.
        operation: String,
        /// Which example, what it lacks, what to do.
        message: String,
    },
    /// The city or the target cannot be worked on.
    #[error("{operation}: {message}")]
    City {
        /// The operation's command words.
        operation: String,
        /// What is wrong and what to do.
        message: String,
    },
    /// The user asked to stop.
    #[error("cancelled")]
    Cancelled,
}

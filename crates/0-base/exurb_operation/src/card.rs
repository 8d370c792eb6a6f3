/// What an operation is called and where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Card {
    /// Stage: first command word (`streets`, `blocks`, `buildings`).
    pub stage: &'static str,
    /// Method: second command word (`grow`, `parcels`, ...).
    pub method: &'static str,
    /// One line: what it does.
    pub summary: &'static str,
    /// Paper and section, with the key of `docs/references.bib`.
    pub source: &'static str,
    /// Must there be an example?
    pub needs_example: bool,
}

impl Card {
    /// Both command words, as in `streets grow`.
    pub fn name(&self) -> String {
        format!("{} {}", self.stage, self.method)
    }
}

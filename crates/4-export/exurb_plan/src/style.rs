//! Styles by name.

/// Colours and widths of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A city map: light ground, cased streets, green parks, houses with a soft shadow.
    #[default]
    Default,
    /// Streets only, black on white, two widths by role: for comparing networks blindly.
    Figure,
    /// Light streets on a dark ground.
    Dark,
}

impl Style {
    /// All styles.
    pub const ALL: [Self; 3] = [Self::Default, Self::Figure, Self::Dark];

    /// The name in options.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Figure => "figure",
            Self::Dark => "dark",
        }
    }

    /// The style of that name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.as_str() == name)
    }
}

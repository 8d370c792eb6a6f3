//! Classes of streets and their roles: the one table, used by every learner, synthesiser and
//! measure (contract, section 3).

/// What a street is for the methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Motorways to tertiary streets and their links: grown first.
    Main,
    /// Residential and the like: grown inside what the main streets enclose.
    Local,
    /// Service roads and the rest: drawn and exported, never learned or measured.
    Other,
}

impl Role {
    /// The name in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Main => "main",
            Self::Local => "local",
            Self::Other => "other",
        }
    }
}

/// Value of OSM's `highway` key, as far as streets are concerned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the names are those of OSM")]
pub enum Class {
    Motorway,
    MotorwayLink,
    Trunk,
    TrunkLink,
    Primary,
    PrimaryLink,
    Secondary,
    SecondaryLink,
    Tertiary,
    TertiaryLink,
    Unclassified,
    #[default]
    Residential,
    LivingStreet,
    Road,
    Pedestrian,
    Service,
}

impl Class {
    /// All classes, most important first.
    pub const ALL: [Self; 16] = [
        Self::Motorway,
        Self::MotorwayLink,
        Self::Trunk,
        Self::TrunkLink,
        Self::Primary,
        Self::PrimaryLink,
        Self::Secondary,
        Self::SecondaryLink,
        Self::Tertiary,
        Self::TertiaryLink,
        Self::Unclassified,
        Self::Residential,
        Self::LivingStreet,
        Self::Road,
        Self::Pedestrian,
        Self::Service,
    ];

    /// The value of OSM's `highway` key.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Motorway => "motorway",
            Self::MotorwayLink => "motorway_link",
            Self::Trunk => "trunk",
            Self::TrunkLink => "trunk_link",
            Self::Primary => "primary",
            Self::PrimaryLink => "primary_link",
            Self::Secondary => "secondary",
            Self::SecondaryLink => "secondary_link",
            Self::Tertiary => "tertiary",
            Self::TertiaryLink => "tertiary_link",
            Self::Unclassified => "unclassified",
            Self::Residential => "residential",
            Self::LivingStreet => "living_street",
            Self::Road => "road",
            Self::Pedestrian => "pedestrian",
            Self::Service => "service",
        }
    }

    /// The class of a `highway` value; `None` for paths and what is no street.
    pub fn parse(highway: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.as_str() == highway)
    }

    /// Its role.
    pub fn role(self) -> Role {
        match self {
            Self::Motorway
            | Self::MotorwayLink
            | Self::Trunk
            | Self::TrunkLink
            | Self::Primary
            | Self::PrimaryLink
            | Self::Secondary
            | Self::SecondaryLink
            | Self::Tertiary
            | Self::TertiaryLink => Role::Main,
            Self::Unclassified
            | Self::Residential
            | Self::LivingStreet
            | Self::Road
            | Self::Pedestrian => Role::Local,
            Self::Service => Role::Other,
        }
    }

    /// Motorways and trunk roads: kept where given, never grown.
    pub fn is_given_only(self) -> bool {
        matches!(self, Self::Motorway | Self::MotorwayLink | Self::Trunk | Self::TrunkLink)
    }

    /// Lanes in both directions together where a map does not tell.
    pub fn default_lanes(self) -> u8 {
        match self {
            Self::Motorway | Self::Trunk => 4,
            Self::Primary => 3,
            Self::Secondary | Self::Tertiary | Self::Unclassified | Self::Residential => 2,
            Self::Road => 2,
            _ => 1,
        }
    }

    /// Width of the carriageway in metres where a map does not tell: 3.5 m a lane on main streets,
    /// 3 m on local ones, and what lanes do not describe (living streets, squares) as built.
    pub fn default_width_m(self, lanes: u8) -> f64 {
        match self {
            Self::LivingStreet => 5.5,
            Self::Pedestrian => 5.0,
            Self::Service => 4.0,
            _ if self.role() == Role::Main => 3.5 * f64::from(lanes.max(1)),
            _ => (3.0 * f64::from(lanes.max(1))).max(5.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_classes_go_both_ways() {
        for class in Class::ALL {
            assert_eq!(Class::parse(class.as_str()), Some(class));
        }
        assert_eq!(Class::parse("footway"), None);
    }
}

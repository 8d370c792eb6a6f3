//! Plain measures of a city.

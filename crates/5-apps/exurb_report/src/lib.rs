//! A comparison as one page of HTML that opens from disk with no network.
//!
//! | part | what it holds |
//! |---|---|
//! | [`Report`], [`Column`] | what a page is made of |
//! | `page` | the page, section by section |
//! | `maps` | maps side by side, at one scale |
//! | `scores` | the table of scores, each between ceiling and floor |
//! | `charts` | distributions overlaid |
//! | `tiles` | the patches that give the new city away |
//! | `html` | text safe to put into a page |

mod charts;
mod html;
mod maps;
mod page;
mod scores;
mod tiles;

use exurb_city::City;
use exurb_likeness::{Document, Likeness, Reference};
use exurb_measure::Info;

/// Everything a page tells.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The city judged.
    pub candidate: &'a City,
    /// What is in it, with its laws and gates.
    pub info: &'a Info,
    /// The examples it was compared with.
    pub columns: &'a [Column<'a>],
}

/// One example.
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    /// The example.
    pub example: &'a City,
    /// The city that its held-out part lies in; the example itself where it was split.
    pub held_out: &'a City,
    /// Ceilings and floors.
    pub reference: &'a Reference,
    /// What was found.
    pub likeness: &'a Likeness,
    /// The same as figures and sentences.
    pub document: &'a Document,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[error("a map of the report could not be drawn: {0}")]
pub struct Error(#[from] exurb_plan::Error);

/// The page. O(size of the cities); under 3 MB whatever their size, for up to nine examples: maps are
/// pictures of a limited number of bytes, and charts have a fixed number of points.
pub fn to_html(report: &Report) -> Result<String, Error> {
    page::page(report)
}

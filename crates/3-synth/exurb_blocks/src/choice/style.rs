//! Which example serves where: a map of styles.

use exurb_geom::{Bounds, GridPoint, Polygon, Vec2};
use exurb_operation::StyleMap;

/// Colours farther from every one of the legend than this, in RGB, mean nothing.
const MOST_OFF: f64 = 80.0;

/// A map of styles, ready to be asked.
#[derive(Debug)]
pub enum Styles {
    /// All examples serve everywhere.
    Free,
    /// Areas with the names of examples.
    Areas(Vec<(Polygon, String)>),
    /// Colours over the target's box.
    Image {
        /// What the image covers.
        bounds: Bounds,
        /// Pixels a row, and rows.
        size: [usize; 2],
        /// For every pixel the legend's entry.
        pixels: Vec<Option<u32>>,
        /// Names of examples.
        names: Vec<String>,
    },
}

impl Styles {
    /// The map as it was given, over a target with these bounds. `known` are the names of the examples.
    /// A message where a name or a colour is none.
    pub fn of(
        map: &StyleMap,
        legend: &str,
        bounds: Bounds,
        known: &[&str],
    ) -> Result<Self, String> {
        let styles = match map {
            _ if map.is_none() => Self::Free,
            StyleMap::File(name) => return Err(format!("the style map {name} was not read")),
            StyleMap::Areas { areas } => Self::Areas(
                areas.iter().filter_map(|a| Some((a.outline()?, a.example.clone()))).collect(),
            ),
            StyleMap::Image { width, height, pixels } => {
                let legend = read_legend(legend)?;
                if width * height != pixels.len() || pixels.is_empty() {
                    return Err("the style map has no pixels".to_owned());
                }
                let pixels = pixels.iter().map(|color| nearest(*color, &legend)).collect();
                let names = legend.into_iter().map(|(_, name)| name).collect();
                Self::Image { bounds, size: [*width, *height], pixels, names }
            }
        };
        let unknown = styles.names().find(|name| !known.contains(name)).map(str::to_owned);
        unknown.map_or(Ok(styles), |name| {
            let known = known.join(", ");
            Err(format!(
                "the style map names the example {name}, which is not given; there are {known}"
            ))
        })
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        match self {
            Self::Free => Box::new(std::iter::empty()),
            Self::Areas(areas) => Box::new(areas.iter().map(|(_, name)| name.as_str())),
            Self::Image { names, .. } => Box::new(names.iter().map(String::as_str)),
        }
    }

    /// The name of the example that serves at `p`; `None` where all do.
    pub fn at(&self, p: Vec2) -> Option<&str> {
        match self {
            Self::Free => None,
            Self::Areas(areas) => {
                let q = GridPoint::round(p);
                areas.iter().find(|(area, _)| area.contains(q)).map(|(_, name)| name.as_str())
            }
            Self::Image { bounds, size, pixels, names } => {
                let share = (p - bounds.min) / bounds.size();
                let cell = |share: f64, n: usize| ((share * n as f64) as usize).min(n - 1);
                let (x, y) = (cell(share.x, size[0]), cell(1.0 - share.y, size[1]));
                pixels[y * size[0] + x].map(|k| names[k as usize].as_str())
            }
        }
    }
}

/// `rrggbb=name`, separated by commas or spaces.
fn read_legend(text: &str) -> Result<Vec<(u32, String)>, String> {
    let wrong = |entry: &str| {
        format!("style_legend: `{entry}` is no colour and example, as in ff0000=munich")
    };
    let entries = text.split([',', ' ']).filter(|entry| !entry.is_empty());
    let read = |entry: &str| {
        let (color, name) = entry.split_once('=').ok_or_else(|| wrong(entry))?;
        let color = color.trim_start_matches('#');
        let color = u32::from_str_radix(color, 16).ok().filter(|_| color.len() == 6);
        Ok((color.ok_or_else(|| wrong(entry))?, name.to_owned()))
    };
    let legend: Vec<(u32, String)> = entries.map(read).collect::<Result<_, String>>()?;
    match legend.is_empty() {
        true => {
            Err("the style map is an image; say with style_legend what its colours mean, as in \
                     ff0000=munich,00ff00=helsinki"
                .to_owned())
        }
        false => Ok(legend),
    }
}

fn nearest(color: u32, legend: &[(u32, String)]) -> Option<u32> {
    let rgb = |c: u32| [c >> 16 & 255, c >> 8 & 255, c & 255].map(f64::from);
    let off = |other: u32| {
        let (a, b) = (rgb(color), rgb(other));
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    };
    let best = legend.iter().enumerate().map(|(k, (c, _))| (off(*c), k as u32));
    best.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(off, _)| *off <= MOST_OFF).map(|(_, k)| k)
}

#[cfg(test)]
mod tests {
    use exurb_operation::StyleArea;

    use super::*;

    const BOX: Bounds = Bounds { min: Vec2::ZERO, max: Vec2::new(200.0, 100.0) };

    #[test]
    fn an_image_lies_over_the_target_with_north_up() {
        let pixels = vec![0xff_0000, 0x00_ff00, 0x00_00ff, 0xfa_0505];
        let image = StyleMap::Image { width: 2, height: 2, pixels };
        let styles = Styles::of(&image, "ff0000=a,#00ff00=b", BOX, &["a", "b"]).expect("names");
        assert_eq!(styles.at(Vec2::new(10.0, 90.0)), Some("a"));
        assert_eq!(styles.at(Vec2::new(190.0, 90.0)), Some("b"));
        assert_eq!(styles.at(Vec2::new(10.0, 10.0)), None, "a colour of no example");
        assert_eq!(styles.at(Vec2::new(200.0, 0.0)), Some("a"), "nearly red");
    }

    #[test]
    fn names_and_legends_that_are_none_are_told() {
        let square = vec![vec![[0.0, 0.0], [50.0, 0.0], [50.0, 50.0]]];
        let areas = vec![StyleArea { example: "c".into(), polygon: square }];
        let areas = StyleMap::Areas { areas };
        let message = Styles::of(&areas, "", BOX, &["a", "b"]).expect_err("no such example");
        assert!(message.contains("c, which is not given; there are a, b"), "{message}");
        let found = Styles::of(&areas, "", BOX, &["c"]).expect("there");
        assert_eq!(
            (found.at(Vec2::new(40.0, 9.0)), found.at(Vec2::new(9.0, 40.0))),
            (Some("c"), None)
        );
        let image = StyleMap::Image { width: 1, height: 1, pixels: vec![0] };
        for legend in ["", "red=a", "ff0000"] {
            assert!(Styles::of(&image, legend, BOX, &["a"]).is_err(), "{legend}");
        }
    }
}

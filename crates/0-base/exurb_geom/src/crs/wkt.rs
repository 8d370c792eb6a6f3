//! Well-known text of coordinate systems → a `proj` text, for the common projections.

/// Texts nested deeper or longer than this describe no coordinate system.
const MAX_DEPTH: usize = 24;
const MAX_LENGTH: usize = 65_536;

/// `KEYWORD[values and nodes]`.
#[derive(Debug, Default)]
pub struct Node {
    keyword: String,
    values: Vec<String>,
    nodes: Vec<Node>,
}

impl Node {
    /// The first node below (or this) with one of the keywords, depth first.
    fn find(&self, keywords: &[&str]) -> Option<&Self> {
        if keywords.contains(&self.keyword.as_str()) {
            return Some(self);
        }
        self.nodes.iter().find_map(|node| node.find(keywords))
    }

    fn child(&self, keywords: &[&str]) -> Option<&Self> {
        self.nodes.iter().find(|node| keywords.contains(&node.keyword.as_str()))
    }

    fn text(&self) -> &str {
        self.values.first().map_or("", String::as_str)
    }

    fn number(&self, i: usize) -> Option<f64> {
        self.values.get(i)?.parse().ok().filter(|n: &f64| n.is_finite())
    }

    /// The EPSG code that stands at this node itself.
    pub fn epsg(&self) -> Option<u32> {
        let system = self.plain();
        let id = system.child(&["AUTHORITY", "ID"])?;
        let code = id.values.get(1)?;
        (id.text().eq_ignore_ascii_case("EPSG")).then(|| code.parse().ok())?
    }

    /// The plane or ellipsoidal system inside a compound or bound one.
    fn plain(&self) -> &Self {
        let keywords = [PROJECTED, GEOGRAPHIC].concat();
        if keywords.contains(&self.keyword.as_str()) {
            return self;
        }
        self.find(&keywords).unwrap_or(self)
    }
}

const PROJECTED: &[&str] = &["PROJCS", "PROJCRS", "PROJECTEDCRS"];
const GEOGRAPHIC: &[&str] = &["GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS"];

/// The web's Mercator takes places on the ellipsoid as if on a sphere.
const WEB_MERCATOR: [&str; 2] = ["popularvisualisationpseudomercator", "mercatorauxiliarysphere"];
const WEB_MERCATOR_PROJ: &str = "+proj=merc +a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 \
     +y_0=0 +k=1 +units=m +nadgrids=@null";

/// The tree of a well-known text; `None` when it is none.
pub fn parse(text: &str) -> Option<Node> {
    if text.len() > MAX_LENGTH {
        return None;
    }
    let mut chars = text.char_indices().peekable();
    let mut open: Vec<Node> = Vec::new();
    let mut word = String::new();
    while let Some((_, c)) = chars.next() {
        match c {
            '[' | '(' => {
                let keyword = std::mem::take(&mut word).to_ascii_uppercase();
                open.push(Node { keyword, ..Node::default() });
                if open.len() > MAX_DEPTH {
                    return None;
                }
            }
            '"' => {
                let mut quoted = String::new();
                while let Some((_, c)) = chars.next() {
                    match c {
                        '"' if chars.next_if(|(_, c)| *c == '"').is_none() => break,
                        c => quoted.push(c),
                    }
                }
                open.last_mut()?.values.push(quoted);
            }
            ',' => end_word(&mut open, &mut word),
            ']' | ')' => {
                end_word(&mut open, &mut word);
                let node = open.pop()?;
                match open.last_mut() {
                    Some(parent) => parent.nodes.push(node),
                    None => return Some(node),
                }
            }
            c if c.is_whitespace() => {}
            c => word.push(c),
        }
    }
    None
}

fn end_word(open: &mut [Node], word: &mut String) {
    if let Some(node) = open.last_mut()
        && !word.is_empty()
    {
        node.values.push(std::mem::take(word));
    }
    word.clear();
}

/// The same system as a `proj` text; `None` when its projection is not one of the common ones.
pub fn to_proj(root: &Node) -> Option<String> {
    let system = root.plain();
    let datum = datum(system)?;
    if GEOGRAPHIC.contains(&system.keyword.as_str()) {
        return Some(format!("+proj=longlat {datum}"));
    }
    if !PROJECTED.contains(&system.keyword.as_str()) {
        return None;
    }
    let metres = length_unit(system);
    let method = system.find(&["PROJECTION", "METHOD"])?;
    if WEB_MERCATOR.contains(&plain_name(method.text()).as_str()) {
        return Some(WEB_MERCATOR_PROJ.to_owned());
    }
    let projection = projection(method.text())?;
    let mut parameters = String::new();
    let mut nodes = Vec::new();
    collect(system, "PARAMETER", &mut nodes);
    for node in nodes {
        let Some((key, is_length)) = parameter(node.text(), projection) else { continue };
        let own_unit = node.child(&["LENGTHUNIT", "ANGLEUNIT", "UNIT"]).and_then(|u| u.number(1));
        let value = node.number(1)?;
        let value = match is_length {
            true => value * own_unit.unwrap_or(metres),
            false => value,
        };
        parameters += &format!("+{key}={value} ");
    }
    Some(format!("+proj={projection} {parameters}{datum} +to_meter={metres}"))
}

fn collect<'a>(node: &'a Node, keyword: &str, found: &mut Vec<&'a Node>) {
    for child in &node.nodes {
        if child.keyword == keyword {
            found.push(child);
        } else {
            collect(child, keyword, found);
        }
    }
}

/// Ellipsoid, shift to WGS 84 and prime meridian.
fn datum(system: &Node) -> Option<String> {
    let spheroid = system.find(&["SPHEROID", "ELLIPSOID"])?;
    let (a, inverse) = (spheroid.number(1)?, spheroid.number(2)?);
    let ellipsoid = match inverse {
        0.0 => format!("+a={a} +b={a}"),
        inverse => format!("+a={a} +rf={inverse}"),
    };
    let mut shift = "0,0,0".to_owned();
    if let Some(node) = system.find(&["TOWGS84"]) {
        let numbers: Option<Vec<f64>> = (0..node.values.len()).map(|i| node.number(i)).collect();
        let words: Vec<String> = numbers?.iter().map(f64::to_string).collect();
        shift = words.join(",");
    }
    let meridian = system.find(&["PRIMEM", "PRIMEMERIDIAN"]).and_then(|m| m.number(1));
    Some(format!("{ellipsoid} +towgs84={shift} +pm={}", meridian.unwrap_or(0.0)))
}

/// Metres of one unit of the plane.
fn length_unit(system: &Node) -> f64 {
    let direct = system.child(&["UNIT", "LENGTHUNIT"]);
    let of_axis = || system.child(&["AXIS"])?.child(&["LENGTHUNIT", "UNIT"]);
    let factor = direct.or_else(of_axis).and_then(|unit| unit.number(1));
    factor.filter(|f| *f > 0.0).unwrap_or(1.0)
}

fn plain_name(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase()
}

fn projection(method: &str) -> Option<&'static str> {
    Some(match plain_name(method).as_str() {
        "transversemercator" | "gausskruger" => "tmerc",
        "mercator1sp" | "mercator2sp" | "mercator" | "mercatorvarianta" | "mercatorvariantb" => {
            "merc"
        }
        "lambertconformalconic"
        | "lambertconformalconic1sp"
        | "lambertconformalconic2sp"
        | "lambertconicconformal1sp"
        | "lambertconicconformal2sp" => "lcc",
        "albersconicequalarea" | "albersequalarea" | "albers" => "aea",
        "lambertazimuthalequalarea" => "laea",
        "obliquestereographic" | "doublestereographic" => "sterea",
        "polarstereographic" | "polarstereographicvarianta" | "stereographic" => "stere",
        "cassinisoldner" | "cassini" => "cass",
        _ => return None,
    })
}

/// The `proj` key of a parameter, and whether it is a length.
fn parameter(name: &str, projection: &str) -> Option<(&'static str, bool)> {
    Some(match plain_name(name).as_str() {
        "latitudeoforigin"
        | "latitudeofcenter"
        | "latitudeofnaturalorigin"
        | "latitudeoffalseorigin" => ("lat_0", false),
        "centralmeridian"
        | "longitudeofcenter"
        | "longitudeoforigin"
        | "longitudeofnaturalorigin"
        | "longitudeoffalseorigin" => ("lon_0", false),
        "standardparallel1" | "latitudeof1ststandardparallel" if projection == "merc" => {
            ("lat_ts", false)
        }
        "standardparallel1" | "latitudeof1ststandardparallel" => ("lat_1", false),
        "standardparallel2" | "latitudeof2ndstandardparallel" => ("lat_2", false),
        "scalefactor" | "scalefactoratnaturalorigin" => ("k_0", false),
        "falseeasting" | "eastingatfalseorigin" => ("x_0", true),
        "falsenorthing" | "northingatfalseorigin" => ("y_0", true),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use crate::crs::Crs;
    use crate::{Frame, LonLat, Vec2};

    #[test]
    fn our_own_frame_is_read_back() {
        let frame = Frame::new(LonLat { lon: 24.9443, lat: 60.1716 }).expect("valid");
        let crs = Crs::from_wkt(&frame.to_wkt()).expect("known");
        let place = crs.to_lonlat(1234.5, -678.9).expect("in reach");
        let there = frame.unproject(Vec2::new(1234.5, -678.9));
        assert!((place.lon - there.lon).abs() < 1e-9 && (place.lat - there.lat).abs() < 1e-9);
    }

    #[test]
    fn a_foot_based_lambert_system_matches_its_code() {
        let wkt = "PROJCS[\"NAD83 / New York Long Island (ftUS)\",GEOGCS[\"NAD83\",\
            DATUM[\"North_American_Datum_1983\",SPHEROID[\"GRS 1980\",6378137,298.257222101]],\
            PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],\
            PROJECTION[\"Lambert_Conformal_Conic_2SP\"],PARAMETER[\"standard_parallel_1\",41.03333333333333],\
            PARAMETER[\"standard_parallel_2\",40.66666666666666],PARAMETER[\"latitude_of_origin\",40.16666666666666],\
            PARAMETER[\"central_meridian\",-74],PARAMETER[\"false_easting\",984250],\
            PARAMETER[\"false_northing\",0],UNIT[\"US survey foot\",0.3048006096012192]]";
        let by_text = Crs::from_wkt(wkt).and_then(|c| c.to_lonlat(983_000.0, 206_000.0));
        let by_code = Crs::from_epsg(2263).and_then(|c| c.to_lonlat(983_000.0, 206_000.0));
        let (a, b) = (by_text.expect("known"), by_code.expect("known"));
        assert!((a.lon - b.lon).abs() < 1e-7 && (a.lat - b.lat).abs() < 1e-7, "{a:?} {b:?}");
    }

    #[test]
    fn broken_texts_are_refused() {
        for text in ["", "PROJCS[", "]", "PROJCS[\"x\"]", "LOCAL_CS[\"grid\"]", &"A[".repeat(99)] {
            assert!(Crs::from_wkt(text).is_none(), "{text}");
        }
    }
}

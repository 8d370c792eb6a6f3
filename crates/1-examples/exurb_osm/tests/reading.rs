//! Small files made here: the same map in every format, rings, missing nodes, damage.

use std::io::Write;

use exurb_city::{City, ImportOptions, Imported};
use exurb_osm::{Error, Format, fuzz, read_bytes};

fn import(bytes: &[u8], name: &str) -> Result<Imported, Error> {
    read_bytes(bytes, name, Format::of_name(name), &ImportOptions::default())
}

fn city(xml: &str) -> City {
    import(xml.as_bytes(), "map.osm").expect("valid").city
}

/// Nodes 1.. on a grid of 10 columns, 0.001° (about 100 m) apart, inside an `<osm>`.
fn map(body: &str) -> String {
    let mut out = String::from("<osm version=\"0.6\">\n");
    for id in 1..=100 {
        let (lon, lat) = (f64::from((id - 1) % 10) * 1e-3, f64::from((id - 1) / 10) * 1e-3);
        out += &format!("<node id=\"{id}\" lon=\"{lon}\" lat=\"{lat}\"/>\n");
    }
    out + body + "</osm>"
}

fn way(id: i64, nodes: &[i64], tags: &[(&str, &str)]) -> String {
    let nodes: String = nodes.iter().map(|n| format!("<nd ref=\"{n}\"/>")).collect();
    let tags: String = tags.iter().map(|(k, v)| format!("<tag k=\"{k}\" v=\"{v}\"/>")).collect();
    format!("<way id=\"{id}\">{nodes}{tags}</way>\n")
}

fn relation(members: &[(i64, &str)], tags: &[(&str, &str)]) -> String {
    let members: String = members
        .iter()
        .map(|(id, role)| format!("<member type=\"way\" ref=\"{id}\" role=\"{role}\"/>"))
        .collect();
    let tags: String = tags.iter().map(|(k, v)| format!("<tag k=\"{k}\" v=\"{v}\"/>")).collect();
    format!("<relation id=\"1\">{members}<tag k=\"type\" v=\"multipolygon\"/>{tags}</relation>\n")
}

const STREET: &[(&str, &str)] = &[("highway", "residential")];

#[test]
fn attribute_values_are_unescaped() {
    let tags = [("highway", "residential"), ("name", "Caf&#233; &amp; &quot;Bar&quot; &lt;1&gt;")];
    let city = city(&map(&way(1, &[1, 2], &tags)));
    let (_, edge) = city.streets.edges().next().expect("a street");
    assert_eq!(edge.data.name.as_deref(), Some("Café & \"Bar\" <1>"));
}

#[test]
fn ways_are_split_at_missing_nodes_and_their_ends_are_no_dead_ends() {
    let imported =
        import(map(&way(1, &[1, 2, 999, 4, 5, 6], STREET)).as_bytes(), "map.osm").expect("valid");
    let city = imported.city;
    assert_eq!(city.streets.edge_count(), 2);
    let cut = city.streets.nodes().filter(|(_, n)| n.data.cut).count();
    assert_eq!(cut, 2, "one on each side of the gap");
}

#[test]
fn nodes_off_the_earth_are_missing_nodes() {
    for (lon, lat) in [("NaN", "0.001"), ("0.002", "91"), ("1e300", "0"), ("", ""), ("inf", "0")] {
        let body = format!("<node id=\"500\" lon=\"{lon}\" lat=\"{lat}\"/>")
            + &way(1, &[1, 2, 500, 4, 5], STREET);
        let imported = import(map(&body).as_bytes(), "map.osm").expect("valid");
        assert_eq!(imported.city.streets.edge_count(), 2, "{lon} {lat}");
        assert!(imported.warnings.iter().any(|w| w.contains("1 nodes lie outside")));
    }
}

#[test]
fn oneways_against_their_line_are_turned() {
    let tags = [("highway", "residential"), ("oneway", "-1")];
    let city = city(&map(&way(1, &[1, 2, 3], &tags)));
    let (_, edge) = city.streets.edges().next().expect("a street");
    assert!(edge.data.oneway);
    assert!(edge.line()[0].x > edge.line()[2].x);
}

#[test]
fn a_multipolygon_is_assembled_from_pieces_in_any_order_and_direction() {
    // A square of 3 x 3 cells in three pieces, one reversed, with a hole in two pieces.
    let pieces = way(1, &[1, 2, 3, 4], &[])
        + &way(2, &[34, 33, 32, 31, 21, 11, 1], &[])
        + &way(3, &[34, 24, 14, 4], &[])
        + &way(4, &[12, 13, 23], &[])
        + &way(5, &[12, 22, 23], &[]);
    let members = [(3, "outer"), (1, "outer"), (4, "inner"), (2, ""), (5, "inner")];
    let tags = [("building", "school"), ("height", "12 m")];
    let city = city(&map(&(way(9, &[50, 51], STREET) + &pieces + &relation(&members, &tags))));
    assert_eq!(city.buildings.len(), 0, "outside the box of the streets");

    let around = way(9, &[1, 10, 100], STREET);
    let map = map(&(around + &pieces + &relation(&members, &tags)));
    let city = self::city(&map);
    assert_eq!(city.buildings.len(), 1);
    let school = &city.buildings[0];
    assert_eq!(school.polygon.interiors().len(), 1);
    let cell = 111.2 * 111.2;
    assert!((school.polygon.area_m2() / (8.0 * cell) - 1.0).abs() < 0.02);
    assert_eq!((school.usage.as_deref(), school.height_m), (Some("school"), Some(12.0)));
}

#[test]
fn an_outer_way_that_repeats_its_relation_is_one_building() {
    let outer = way(1, &[1, 4, 34, 31, 1], &[("building", "yes")]);
    let inner = way(2, &[12, 13, 23, 22, 12], &[]);
    let members = [(1, "outer"), (2, "inner")];
    let street = way(9, &[1, 10, 100], STREET);
    for tags in [&[("building", "yes")][..], &[]] {
        let body = street.clone() + &outer + &inner + &relation(&members, tags);
        let city = city(&map(&body));
        assert_eq!(city.buildings.len(), 1, "{tags:?}");
        assert_eq!(city.buildings[0].polygon.interiors().len(), 1, "{tags:?}");
    }
}

#[test]
fn rings_that_do_not_close_are_left_out_and_counted() {
    let body = way(9, &[1, 10, 100], STREET)
        + &way(1, &[1, 2, 3], &[])
        + &way(2, &[13, 12, 11], &[])
        + &way(3, &[61, 62, 72, 71], &[("building", "yes")])
        + &way(4, &[61, 83, 62, 71, 61], &[("building", "yes")])
        + &relation(&[(1, "outer"), (2, "outer")], &[("building", "yes")]);
    let imported = import(map(&body).as_bytes(), "map.osm").expect("valid");
    let warnings = imported.warnings.join("; ");
    assert!(warnings.contains("3 outlines of buildings that do not close"), "{warnings}");
    assert!(warnings.contains("1 outlines of buildings that cross themselves were mended"));
    assert_eq!(imported.city.buildings.len(), 2, "the bow tie is two triangles");
}

#[test]
fn water_land_use_parcels_and_features_find_their_layers() {
    let ring = |a: i64| [a, a + 1, a + 11, a + 10, a];
    let body = way(9, &[1, 10, 100], STREET)
        + &way(1, &ring(1), &[("natural", "water"), ("water", "pond")])
        + &way(2, &ring(3), &[("landuse", "basin")])
        + &way(3, &[5, 15, 25], &[("waterway", "river"), ("width", "10")])
        + &way(4, &ring(31), &[("leisure", "park")])
        + &way(5, &ring(33), &[("landuse", "residential")])
        + &way(6, &ring(35), &[("place", "plot")])
        + &way(7, &ring(37), &[("leisure", "playground")])
        + &way(8, &[61, 62, 63], &[("natural", "tree_row")])
        + "<node id=\"700\" lon=\"0.0005\" lat=\"0.0065\"><tag k=\"highway\" v=\"street_lamp\"/></node>";
    let city = city(&map(&body));
    let classes = |areas: &[exurb_city::Area]| -> Vec<String> {
        areas.iter().map(|a| a.class.to_string()).collect()
    };
    assert_eq!(classes(&city.water), ["pond", "basin", "river"]);
    let river = city.water[2].polygon.area_m2();
    assert!((river / (2.0 * 111.0 * 10.0) - 1.0).abs() < 0.1, "{river}");
    assert_eq!(classes(&city.land_use), ["park", "residential"]);
    assert_eq!(city.parcels.len(), 1);
    let kinds: Vec<&str> = city.features.iter().map(|f| &*f.kind).collect();
    assert_eq!(kinds, ["playground", "tree_row", "lamp"]);
}

#[test]
fn blocks_know_their_land_use_and_buildings_their_block() {
    // A block of 3 x 3 cells, residential but for a small park.
    let streets = way(1, &[1, 4, 34, 31, 1], STREET);
    let body = streets
        + &way(2, &[1, 4, 34, 31, 1], &[("landuse", "residential")])
        + &way(3, &[12, 13, 23, 22, 12], &[("leisure", "park")])
        + "<node id=\"801\" lon=\"0.0003\" lat=\"0.0003\"/><node id=\"802\" lon=\"0.0004\" lat=\"0.0003\"/>
           <node id=\"803\" lon=\"0.0004\" lat=\"0.0004\"/>"
        + &way(4, &[801, 802, 803, 801], &[("building", "hut")]);
    let city = city(&map(&body));
    assert_eq!(city.blocks.len(), 1);
    assert_eq!(city.blocks[0].land_use.as_deref(), Some("residential"));
    assert_eq!((city.buildings[0].id, city.buildings[0].block), (1, 1));
}

const OVERPASS_NODES: &str = r#"{"version": 0.6, "osm3s": {"copyright": "ODbL data"}, "elements": [
 {"type": "node", "id": 1, "lat": 0.0, "lon": 0.0},
 {"type": "node", "id": 2, "lat": 0.0, "lon": 0.001},
 {"type": "node", "id": 3, "lat": 0.001, "lon": 0.001, "tags": {"natural": "tree"}},
 {"type": "way", "id": 7, "nodes": [1, 2, 3], "tags": {"highway": "primary", "name": "A"}},
 {"type": "way", "id": 8, "nodes": [1, 2, 3, 1], "tags": {"building": "yes"}}]}"#;

const OVERPASS_GEOMETRY: &str = r#"{"elements": [
 {"type": "way", "id": 7, "tags": {"highway": "primary", "name": "A"},
  "geometry": [{"lat": 0, "lon": 0}, {"lat": 0, "lon": 0.001}, {"lat": 0.001, "lon": 0.001}]},
 {"type": "node", "id": 3, "lat": 0.001, "lon": 0.001, "tags": {"natural": "tree"}},
 {"type": "relation", "id": 9, "tags": {"type": "multipolygon", "building": "yes"}, "members": [
  {"type": "way", "ref": 8, "role": "outer", "geometry": [{"lat": 0, "lon": 0},
   {"lat": 0, "lon": 0.001}, {"lat": 0.001, "lon": 0.001}, {"lat": 0, "lon": 0}]}]}]}"#;

#[test]
fn overpass_json_comes_with_nodes_or_with_geometry() {
    let nodes = import(OVERPASS_NODES.as_bytes(), "map.json").expect("valid").city;
    let geometry = import(OVERPASS_GEOMETRY.as_bytes(), "map.json").expect("valid").city;
    assert_eq!(nodes.streets, geometry.streets);
    assert_eq!(nodes.buildings, geometry.buildings);
    assert_eq!(nodes.features, geometry.features);
    assert_eq!(nodes.buildings.len(), 1);
    assert_eq!(nodes.metadata.attribution, [exurb_osm::ATTRIBUTION, "ODbL data"]);
    let geojson = import(br#"{"type": "FeatureCollection", "features": []}"#, "map.json");
    assert!(geojson.expect_err("no elements").to_string().contains("GeoJSON"));
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes).expect("memory is writable");
    out.finish().expect("memory is writable")
}

fn bzip2(bytes: &[u8]) -> Vec<u8> {
    let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::default());
    out.write_all(bytes).expect("memory is writable");
    out.finish().expect("memory is writable")
}

#[test]
fn packed_files_are_unpacked_whatever_their_name() {
    let xml = map(&way(1, &[1, 2, 3], STREET));
    let plain = city(&xml);
    for (bytes, name) in [
        (gzip(xml.as_bytes()), "map.osm.gz"),
        (bzip2(xml.as_bytes()), "map.osm.bz2"),
        (gzip(xml.as_bytes()), "map.pbf"),
    ] {
        let unpacked = import(&bytes, name).expect(name).city;
        assert_eq!(unpacked.streets, plain.streets, "{name}");
        assert_eq!(&*unpacked.metadata.name, "map");
    }
}

#[test]
fn archive_bombs_are_refused() {
    let xml = "<osm>".to_owned() + &" ".repeat(70_000_000) + "</osm>";
    for packed in [gzip(xml.as_bytes()), bzip2(xml.as_bytes())] {
        let error = import(&packed, "bomb.osm.gz").expect_err("a bomb");
        assert!(matches!(error, Error::Bomb { .. }), "{error}");
    }
}

#[test]
fn what_a_server_says_of_a_failed_query_is_passed_on() {
    let way = r#"{"type":"way","id":1,"nodes":[1,2],"tags":{"highway":"residential"}}"#;
    let nodes = r#"{"type":"node","id":1,"lat":41.0,"lon":21.0},{"type":"node","id":2,"lat":41.001,"lon":21.0}"#;
    let json = |elements: &str| {
        format!(
            r#"{{"version":0.6,"elements":[{elements}],"remark":"runtime error: Query timed out"}}"#
        )
    };
    let partly = import(json(&format!("{nodes},{way}")).as_bytes(), "a.json").expect("a street");
    assert!(partly.warnings.iter().any(|w| w.contains("Query timed out")), "{:?}", partly.warnings);
    let error = import(json("").as_bytes(), "a.json").expect_err("nothing").to_string();
    assert!(error.contains("Query timed out"), "{error}");
    let xml = b"<osm version=\"0.6\"><remark> runtime error: out of memory </remark></osm>";
    let error = import(xml, "a.osm").expect_err("nothing").to_string();
    assert!(error.contains("out of memory"), "{error}");
}

#[test]
fn errors_name_the_file_and_what_is_wrong() {
    let message = |bytes: &[u8], name| import(bytes, name).expect_err(name).to_string();
    assert_eq!(message(b"", "a.osm"), "a.osm is empty");
    assert!(message(b"hello", "a.txt").starts_with("a.txt is no OpenStreetMap file"));
    assert!(message(b"<gpx></gpx>", "a.osm").contains("`<gpx>` instead of `<osm>`"));
    assert!(message(b"<osm><node id='1'", "a.osm").contains("truncated or corrupt"));
    assert!(message(b"<osm><way id=\"1\">", "a.osm").contains("before `</osm>`"));
    assert!(message(b"<osm/>", "a.osm").contains("holds no streets"));
    assert!(
        message(b"\xff\xff\xff\xff1234", "a.pbf").contains("a blob header of 4294967295 bytes")
    );
    let missing = exurb_osm::read("no/such/file.osm".as_ref(), &ImportOptions::default());
    assert!(missing.expect_err("absent").to_string().starts_with("cannot read no/such/file.osm"));
}

#[test]
fn a_map_without_streets_is_a_city_with_a_warning() {
    let imported =
        import(map(&way(1, &[1, 4, 34, 31, 1], &[("building", "yes")])).as_bytes(), "a.osm");
    let imported = imported.expect("valid");
    assert_eq!((imported.city.streets.edge_count(), imported.city.buildings.len()), (0, 1));
    assert_eq!(imported.warnings, ["the map has no streets"]);
}

/// A map with everything, in all formats.
type Body = fn(&[u8]);

fn samples() -> [(Vec<u8>, Body); 4] {
    let ring = |a: i64| [a, a + 1, a + 11, a + 10, a];
    let body = "<bounds minlat=\"0\" minlon=\"0\" maxlat=\"0.009\" maxlon=\"0.009\"/>".to_owned()
        + &way(9, &[1, 10, 100], STREET)
        + &way(10, &[11, 12, 13], &[("highway", "service")])
        + &way(1, &ring(1), &[("natural", "water")])
        + &way(2, &[41, 45, 49], &[("natural", "coastline")])
        + &way(3, &ring(31), &[("building", "house"), ("height", "12")])
        + &way(4, &ring(53), &[])
        + &way(5, &[71, 72, 73], &[("barrier", "hedge")])
        + &relation(&[(4, "outer")], &[("landuse", "forest")]);
    let xml = map(&body);
    let city = city(&xml);
    let mut pbf = Vec::new();
    exurb_osm::write_pbf(&city, &mut pbf).expect("memory is writable");
    [
        (xml.into_bytes(), fuzz::xml),
        (pbf, fuzz::pbf),
        (OVERPASS_NODES.as_bytes().to_vec(), fuzz::overpass),
        (OVERPASS_GEOMETRY.as_bytes().to_vec(), fuzz::overpass),
    ]
}

#[test]
fn truncated_files_are_errors_and_damaged_ones_never_panic() {
    for (bytes, body) in samples() {
        for end in (0..bytes.len()).step_by(97) {
            body(&bytes[..end]);
        }
        // Every bit of some bytes, more bytes of small files.
        for at in (0..bytes.len()).step_by(1 + bytes.len() / 150) {
            for bit in [0, 3, 5, 7] {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                body(&damaged);
            }
        }
    }
}

#[test]
fn a_pbf_cut_anywhere_is_an_error_but_between_blobs() {
    let pbf = &samples()[1].0;
    let whole = import(pbf, "a.pbf").expect("valid").city;
    for end in 1..pbf.len() {
        match import(&pbf[..end], "a.pbf") {
            Ok(part) => assert!(part.city.streets.edge_count() <= whole.streets.edge_count()),
            Err(error) => assert!(error.to_string().starts_with("a.pbf"), "{error}"),
        }
    }
}

#[test]
fn unpacked_pbf_blocks_are_damaged_too() {
    // Inside zlib a flipped bit mostly fails the checksum; damage the message itself instead.
    let pbf = &samples()[1].0;
    for seed in 0..400usize {
        fuzz::pbf(&repacked(pbf, |data| {
            let at = seed * 7919 % data.len().max(1);
            if let Some(byte) = data.get_mut(at) {
                *byte ^= 1 << (seed % 8);
            }
        }));
    }
}

/// The file with the content of every data blob unpacked, changed and stored raw.
fn repacked(pbf: &[u8], change: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = pbf;
    while !rest.is_empty() {
        let size = u32::from_be_bytes(rest[..4].try_into().expect("four bytes")) as usize;
        let header = &rest[4..4 + size];
        let is_data = header.windows(7).any(|w| w == b"OSMData");
        // Field 3 is the last of the header: its tag, then the length as a varint.
        let tag = header.iter().rposition(|b| *b == 0x18).expect("a length");
        let length = varint(&header[tag + 1..]);
        let blob = &rest[4 + size..4 + size + length];
        rest = &rest[4 + size + length..];
        // The packed data begin with the zlib header 78 9c.
        let start = blob.windows(2).position(|w| w == [0x78, 0x9c]).expect("zlib");
        let mut data = Vec::new();
        let mut unpack = flate2::read::ZlibDecoder::new(&blob[start..]);
        std::io::Read::read_to_end(&mut unpack, &mut data).expect("valid zlib");
        if is_data {
            change(&mut data);
        }
        let mut raw = vec![0x0a];
        put_varint(data.len(), &mut raw);
        raw.extend(data);
        let mut head = header[..=tag].to_vec();
        put_varint(raw.len(), &mut head);
        out.extend((head.len() as u32).to_be_bytes());
        out.extend(head);
        out.extend(raw);
    }
    out
}

fn varint(bytes: &[u8]) -> usize {
    let mut value = 0;
    for (i, byte) in bytes.iter().enumerate() {
        value |= usize::from(byte & 0x7f) << (7 * i);
        if byte & 0x80 == 0 {
            break;
        }
    }
    value
}

fn put_varint(mut value: usize, out: &mut Vec<u8>) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

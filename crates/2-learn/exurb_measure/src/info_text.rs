//! [`Info`] as a table for people.

use std::fmt::Write;

use crate::Info;

/// Problems shown at most.
const SHOWN: usize = 10;

impl Info {
    /// The figures, laws and gates as plain text, one fact a line.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        figures(self, &mut out);
        laws(self, &mut out);
        gates(self, &mut out);
        problems(self, &mut out);
        out
    }
}

fn figures(info: &Info, out: &mut String) {
    let Info { streets, intersections, blocks, parcels, buildings, provenance, .. } = info;
    line(out, "area", format!("{:.3} km²", info.area_km2));
    if let Some(terrain) = &info.terrain {
        let (low, high) = (number(terrain.lowest, 0, " m"), number(terrain.highest, 0, " m"));
        let slope = percent(terrain.mean_slope);
        line(out, "terrain", format!("{low} to {high}, mean slope {slope}"));
    }
    line(out, "streets", format!("{} of {:.1} km", streets.count, streets.km));
    let lengths = |map: &std::collections::BTreeMap<String, f64>| {
        let known: Vec<String> =
            map.iter().filter(|(_, km)| **km > 0.0).map(|(k, km)| format!("{k} {km:.1}")).collect();
        known.join(", ")
    };
    line(out, "  km by role", lengths(&streets.km_by_role));
    line(out, "  km by class", lengths(&streets.km_by_class));
    if streets.other_ways > 0 {
        let besides = format!("{} ways of {:.1} km", streets.other_ways, streets.other_ways_km);
        line(out, "  besides", format!("{besides}, service roads and the like, not measured"));
    }
    if let Some(land) = &info.on_land {
        let steep = |grade: Option<f64>| percent(grade);
        let (water, grade) = (number(Some(land.in_water_m), 0, " m"), steep(land.steepest_grade));
        let bridges = number(Some(land.bridge_km), 2, " km");
        line(out, "  on land", format!("{bridges} of bridges, {water} in water, steepest {grade}"));
    }
    line(out, "  dead ends", percent(streets.dead_end_share));
    let largest = percent(streets.largest_component_share);
    line(out, "  components", format!("{}, the largest holds {largest}", streets.components));
    let degrees: Vec<String> = intersections
        .by_degree
        .iter()
        .map(|(degree, n)| format!("{n} of degree {degree}"))
        .collect();
    line(out, "intersections", format!("{}: {}", intersections.count, degrees.join(", ")));
    let median = number(blocks.median_area, 0, " m²");
    let blocks = format!("{}, {} of them islands, median {median}", blocks.count, blocks.islands);
    line(out, "blocks", blocks);
    let access = percent(parcels.street_access_share);
    line(out, "parcels", format!("{}, {access} with street access", parcels.count));
    let height = number(buildings.median_height, 1, " m");
    let coverage = percent(buildings.coverage);
    line(
        out,
        "buildings",
        format!("{}, coverage {coverage}, median height {height}", buildings.count),
    );
    let origin = format!(
        "{} from the example, {} procedural, {} other",
        percent(provenance.example_share),
        percent(provenance.procedural_share),
        percent(provenance.other_share)
    );
    line(out, "street length", origin);
}

fn laws(info: &Info, out: &mut String) {
    let verdict = if info.valid { "all kept" } else { "broken" };
    let _ = writeln!(out, "\nlaws: {verdict}");
    for (name, law) in info.laws.iter().filter(|(_, law)| law.value.is_some()) {
        let mark = if law.pass { "ok  " } else { "FAIL" };
        let value = number(law.value, 4, "");
        let _ = writeln!(out, "  {mark} {name:<28}{value:>10}  limit {}", law.limit);
    }
}

fn gates(info: &Info, out: &mut String) {
    let _ = writeln!(out, "\nlikeness gates");
    for (name, gate) in &info.likeness_gates {
        let mark = match gate.pass {
            Some(true) => "ok  ",
            Some(false) => "FAIL",
            None => "    ",
        };
        let limit = match (gate.limit_min, gate.limit) {
            (Some(least), Some(most)) => format!("limit {least:.4} to {most:.4}"),
            (_, Some(most)) => format!("limit {most:.4}"),
            _ => "no example to compare with".to_owned(),
        };
        let value = number(gate.value, 4, "");
        let _ = writeln!(out, "  {mark} {name:<28}{value:>10}  {limit}");
    }
}

fn problems(info: &Info, out: &mut String) {
    if info.problems_total == 0 {
        return;
    }
    let _ = writeln!(out, "\n{} problems, the first of them", info.problems_total);
    for problem in info.problems.iter().take(SHOWN) {
        let [lon, lat] = problem.at;
        let _ = writeln!(
            out,
            "  {} {} at {lon:.6}, {lat:.6}: {} ({})",
            problem.layer, problem.id, problem.message, problem.law
        );
    }
}

fn line(out: &mut String, name: &str, text: String) {
    let _ = writeln!(out, "{name:<16}{text}");
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", share * 100.0))
}

fn number(value: Option<f64>, decimals: usize, unit: &str) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.decimals$}{unit}"))
}

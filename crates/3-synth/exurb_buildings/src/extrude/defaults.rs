//! Heights and roofs for cities whose example tells none.

use exurb_city::Roof;
use exurb_geom::trig;

use super::likeness::Likeness;

/// Footprints under this area are sheds and garages, in m².
const SHED_M2: f64 = 45.0;
/// Footprints over this area are halls, in m².
const HALL_M2: f64 = 2500.0;

/// Storeys: one for sheds, one or two for halls, two or three for detached houses, three to six for
/// houses that share walls in densely covered blocks.
pub fn levels(likeness: &Likeness, quantile: f64) -> f64 {
    let [ln_area, _, coverage, _, touches] = *likeness;
    let between = |low: f64, high: f64| (low + (high - low) * quantile).round();
    match trig::exp(ln_area) {
        area if area < SHED_M2 => 1.0,
        area if area > HALL_M2 && coverage < 0.5 => between(1.0, 2.0),
        _ if touches > 0.5 && coverage > 0.35 => between(3.0, 6.0),
        _ if touches > 0.5 => between(2.0, 4.0),
        area if area > 400.0 => between(2.0, 4.0),
        _ => between(1.0, 3.0),
    }
}

/// Flat over sheds, halls and what is high and deep; pitched over houses, hipped over compact ones.
pub fn roof(likeness: &Likeness, levels: f64) -> Roof {
    let [ln_area, ln_short, _, _, touches] = *likeness;
    let (area, short_m) = (trig::exp(ln_area), trig::exp(ln_short));
    let aspect = area / (short_m * short_m).max(1.0);
    if area < SHED_M2 || short_m > 18.0 || levels > 6.0 {
        Roof::Flat
    } else if touches < 0.5 && aspect < 1.25 {
        Roof::Hipped
    } else {
        Roof::Gabled
    }
}

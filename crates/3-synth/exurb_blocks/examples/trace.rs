use exurb_blocks::database::BlockDatabase;
use exurb_blocks::retarget::*;
use exurb_geom::*;
use exurb_match::*;
use exurb_operation::*;
fn ring(r: &[Vec2]) -> String {
    format!(
        "[{}]",
        r.iter().map(|p| format!("[{:.2},{:.2}]", p.x, p.y)).collect::<Vec<_>>().join(",")
    )
}
fn poly(p: &Polygon) -> String {
    ring(&polyline::to_m(p.exterior()))
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let open = |p: &str| {
        exurb_gis::read_geopackage(std::path::Path::new(p), &Default::default()).unwrap().city
    };
    let (target, example) = (open(&a[1]), open(&a[2]));
    let run = Run::new(1);
    let db = BlockDatabase::of(&[Example::new(example)], &run).unwrap();
    let settings = Settings::default();
    let mut out = vec![];
    for id in a[3].split(',') {
        let id: u32 = id.parse().unwrap();
        let block = target.blocks.iter().find(|b| b.id == id).unwrap();
        let ring0 = exurb_blocks::plain_outline(&block.polygon);
        let outline = Outline::of(&ring0);
        let at = Attributes::default();
        let m = &db.query(&Query::new(&outline, &at), |_| true)[0];
        let layout = &db.layouts[m.entry as usize];
        let polygons: Vec<Polygon> =
            layout.footprints.iter().map(|f| f.building.polygon.clone()).collect();
        let t = std::time::Instant::now();
        let source = Source::of(&layout.outline, polygons.clone(), &settings);
        let t1 = t.elapsed();
        let link = Correspondence::by_warp_polygons(&m.warp, &layout.outline, &ring0);
        let placed = source.retarget(&block.polygon, &ring0, &link, &settings);
        eprintln!(
            "{id}: {} footprints, groups {:?}, {:?} {:?} cost {:.3}",
            polygons.len(),
            source.groups().groups.iter().map(|g| g.elements.len()).collect::<Vec<_>>(),
            t1,
            t.elapsed() - t1,
            m.cost
        );
        let mut group = vec![-1i32; polygons.len()];
        for (k, g) in source.groups().groups.iter().enumerate() {
            for e in &g.elements {
                for i in &e.members {
                    group[*i] = if e.kind == Kind::Fixed { 100 } else { k as i32 };
                }
            }
        }
        let map = source.guidance_map(&block.polygon, &ring0, &link, 1.0);
        let pl: Vec<String> = placed
            .iter()
            .flat_map(|p| {
                p.members
                    .iter()
                    .map(|i| {
                        format!(
                            "[{},{}]",
                            group[*i],
                            poly(&p.motion.apply_polygon(&polygons[*i]).unwrap())
                        )
                    })
                    .collect::<Vec<_>>()
            })
            .collect();
        let src: Vec<String> = polygons
            .iter()
            .enumerate()
            .map(|(i, p)| format!("[{},{}]", group[i], poly(p)))
            .collect();
        out.push(format!("{{\"id\":{id},\"source\":{},\"target\":{},\"elements\":[{}],\"map\":[{}],\"placed\":[{}]}}",ring(&polyline::to_m(&layout.outline)),ring(&polyline::to_m(&ring0)),src.join(","),map.iter().map(|r| ring(r)).collect::<Vec<_>>().join(","),pl.join(",")));
    }
    println!("[{}]", out.join(","));
}

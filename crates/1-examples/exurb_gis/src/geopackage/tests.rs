use super::write_geopackage;
use crate::sample;

#[test]
fn equal_cities_are_equal_files() {
    let folder = tempfile::tempdir().unwrap();
    let city = sample::grid_city(6);
    let bytes = ["a.gpkg", "b.gpkg"].map(|name| {
        write_geopackage(&city, &folder.path().join(name)).unwrap();
        std::fs::read(folder.path().join(name)).unwrap()
    });
    assert_eq!(bytes[0], bytes[1]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is left beside");
}

//! Files of other programs on the command line: they are understood, or it is said what is not.

use crate::common::{Workplace, at, column, house_in_a_field, remarks};

const FIELD: &str = "field.laz --orient given --scene-config ../tau.json";

fn place() -> Workplace {
    let place = Workplace::new();
    place.write_cloud("field.laz", &house_in_a_field());
    place
}

fn has_unused(run: &serde_json::Value, names: &str) -> bool {
    let ways = [format!("not used: {names};"), format!("not used for this question: {names}")];
    remarks(run).iter().any(|text| !names.is_empty() && ways.iter().any(|way| text.contains(way)))
}

#[test]
fn eyes_of_qgis_and_arcgis_stand_where_they_say() {
    let place = place();
    let [x, y, _] = at(20.0, 3.0, 0.0);
    let point = format!("\"geometry\": {{\"type\": \"Point\", \"coordinates\": [{x}, {y}]}}");
    let feature = |properties: &str| format!("{{\"type\": \"Feature\", \"properties\": {{{properties}}}, {point}}}");
    let utf16 = |text: &str| format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    place.write("own.csv", format!("x,y,height\n{x},{y},25\n"));
    place.write("qgis.csv", format!("x,y,observ_hgt,radius\n{x},{y},25,500\n"));
    place.write("arcgis.csv", format!("X,Y,OFFSETA,AZIMUTH1,AZIMUTH2\n{x},{y},25,0,90\n"));
    place.write("excel.txt", utf16(&format!("x\ty\theight\n{x}\t{y}\t25\n")));
    place.write("height.geojson", feature("\"HEIGHT\": 25"));
    place.summary(&format!("isovist {FIELD} --observers own.csv -o own_out.csv"));
    let expected = column(&place, "own_out.csv", "z")[0];
    for (name, unused) in [
        ("qgis.csv", Some("radius")),
        ("arcgis.csv", Some("AZIMUTH1, AZIMUTH2")),
        ("excel.txt", None),
        ("height.geojson", None),
    ] {
        let run = place.summary(&format!("isovist {FIELD} --observers {name} -o out.csv"));
        let z = column(&place, "out.csv", "z")[0];
        assert!((z - expected).abs() < 1e-3, "{name}: {z} {expected}");
        assert_eq!(unused.is_some(), has_unused(&run, unused.unwrap_or_default()), "{name}: {:?}", remarks(&run));
    }
    place.write("z.geojson", feature(&format!("\"z\": {expected}")));
    place.summary(&format!("isovist {FIELD} --observers z.geojson -o out.csv"));
    assert!((column(&place, "out.csv", "z")[0] - expected).abs() < 1e-3);
    // a viewshed uses the limits, and has no use for the height of targets
    place.write("both.csv", format!("X,Y,OFFSETA,OFFSETB,AZIMUTH1,AZIMUTH2\n{x},{y},25,2,0,90\n"));
    let run = place.summary(&format!("viewshed {FIELD} --observers both.csv --cell 2 -o seen.tif"));
    assert!(has_unused(&run, "OFFSETB"), "{:?}", remarks(&run));
}

#[test]
fn heights_of_both_ends_of_a_line_are_those_of_arcgis() {
    let place = place();
    let ([ax, ay, _], [bx, by, _]) = (at(14.0, 3.0, 0.0), at(20.0, 3.0, 0.0));
    place.write("pairs.csv", format!("ax,ay,bx,by,OFFSETA,OFFSETB\n{ax},{ay},{bx},{by},25,12\n"));
    let line = format!("\"geometry\": {{\"type\": \"LineString\", \"coordinates\": [[{ax}, {ay}], [{bx}, {by}]]}}");
    let text = format!("{{\"type\": \"Feature\", \"properties\": {{\"OffsetA\": 25, \"OffsetB\": 12}}, {line}}}");
    place.write("pairs.geojson", text);
    for name in ["pairs.csv", "pairs.geojson"] {
        place.summary(&format!("line-of-sight {FIELD} --pairs {name} -o out.csv"));
        let [az, bz] = ["az", "bz"].map(|end| column(&place, "out.csv", end)[0]);
        // the field is level
        assert!((az - bz - 13.0).abs() < 0.3, "{name}: {az} {bz}");
    }
}

#[test]
fn a_face_that_turns_around_in_itself_is_said() {
    let place = place();
    let corners = [[12.0, 0.0, 5.0], [12.0, 4.0, 5.0], [12.0, 0.0, 9.0]].map(|[x, y, z]| at(x, y, z));
    let vertices: String = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    place.write("wall.obj", format!("{vertices}f {}\n", "1 2 3 ".repeat(1000)));
    let run = place.summary(&format!("shadow {FIELD} --add wall.obj --sun 235,30 --cell 4 -o s.tif"));
    assert!(remarks(&run).iter().any(|text| text.contains("1 faces turn around")), "{:?}", remarks(&run));
    assert_eq!(run["plan"]["triangles"], 1);
}

//! Tables come back with every cell as it was given, and results behind.

use crate::common::{EAST, NORTH, Workplace};

/// A place without balls around it, as text with fewer decimals than the program would print.
const PLACE: [&str; 3] = ["85000.5", "446010.25", "3.87"];

/// Cells of a table that has no quotation marks.
fn rows(text: &str) -> Vec<Vec<&str>> {
    text.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn targets_keep_their_columns_and_coordinates() {
    let place = Workplace::with_house();
    let [x, y, z] = PLACE;
    let lines = [
        format!("7,\"Smith, John\",{x},{y},{z},1e-3"),
        format!("8,,{x},+446010.250,{z}0000,"),
        "0009,\"\"\"roof\"\"\",85000,446000.0,43.59,x y".to_owned(),
    ];
    let table = format!("id,Owner,x,y,z,note\n{}\n", lines.join("\n"));
    place.write("targets.csv", &table);
    place.summary("query house.laz --sun 180,20 --targets targets.csv -o answers.csv");
    let answers = place.text("answers.csv");
    let mut written = answers.lines();
    assert_eq!(written.next(), Some("id,Owner,x,y,z,note,answer"));
    // a roof in front of the first two, nothing above the last
    for (line, answer) in lines.iter().zip(["0", "0", "1"]) {
        let written = written.next().unwrap();
        let (cells, own) = written.rsplit_once(',').unwrap();
        assert_eq!(
            (cells.replace("\"\"\"roof\"\"\"", "roof"), own),
            (line.replace("\"\"\"roof\"\"\"", "roof"), answer)
        );
    }
    // a second run replaces its own column and no other
    place.summary("query house.laz --sun 180,20 --targets answers.csv -o again.csv");
    assert_eq!(place.text("again.csv"), answers);
    place.write("targets.txt", format!("{x} {y} {z} 0.50\n"));
    place.summary("query house.laz --direction 0,0,-1 --targets targets.txt -o down.xyz");
    assert_eq!(place.text("down.xyz"), format!("x y z column_4 answer\n{x} {y} {z} 0.50 1\n"));
    let run = place.summary("query house.laz --sun 180,45 --targets targets.csv -o answers.laz");
    assert_eq!(run["attributes_not_written"], serde_json::json!(["id", "Owner", "note"]));
}

#[test]
fn a_cloud_that_is_a_table_keeps_its_rows_too() {
    let place = Workplace::with_house();
    place.summary("query house.laz --sun 180,45 --self -o points.csv");
    let text = place.text("points.csv");
    let numbered = text
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{},{line}\n", if i == 0 { "id".into() } else { i.to_string() }));
    place.write("numbered.csv", numbered.collect::<String>());
    place.summary("query numbered.csv --crs EPSG:28992 --sun 180,45 --self -o again.csv");
    let again = place.text("again.csv");
    let [before, after] = [&place.text("numbered.csv"), &again].map(|text| {
        rows(text)
            .into_iter()
            .map(|mut row| row.drain(..row.len() - 1).map(str::to_owned).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    });
    assert!(before == after && before.len() > 1000);
}

#[test]
fn every_command_with_a_row_for_each_row_of_a_table_carries_it() {
    let place = Workplace::with_house();
    let [x, y, z] = PLACE;
    place.write("places.csv", format!("name,x,y,z,azimuth,remark\nfirst,{x},{y},{z},0,\nsecond,{x},{y},,90,b c\n"));
    place.write("full.csv", format!("name,x,y,z,azimuth,remark\nfirst,{x},{y},{z},180.0,\nsecond,{x},{y},4,90,b c\n"));
    place.write("pairs.csv", format!("pair,ax,ay,az,bx,by,bz,k\np1,{x},{y},{z},{EAST},{NORTH},30,0.10\n"));
    place.write("wall.obj", "v 85000 446000 12\nv 85001 446000 12\nv 85001 446000 14\nf 1 2 3\n");
    let cell = |name: &str, row: usize, column: &str| -> String {
        let text = place.text(name);
        let rows = rows(&text);
        let at = rows[0].iter().position(|own| *own == column).unwrap_or_else(|| panic!("{column} in {text}"));
        assert_eq!(rows[0].iter().filter(|own| **own == column).count(), 1);
        rows[row][at].to_owned()
    };
    for (arguments, output) in [
        ("isovist house.laz --observers places.csv --ground found --angle-step-deg 5", "isovists.csv"),
        ("landmark house.laz --observers places.csv --ground found --targets wall.obj", "views.csv"),
        ("comfort house.laz --windows full.csv --date 2024-06-21 --directions 100", "windows.csv"),
        ("sky-view house.laz --targets full.csv --directions 100", "skies.csv"),
        ("shadow house.laz --targets full.csv --sun 180,45", "shadows.csv"),
    ] {
        place.summary(&format!("{arguments} -o {output}"));
        for (row, name, remark) in [(1, "first", ""), (2, "second", "b c")] {
            assert_eq!((cell(output, row, "name").as_str(), cell(output, row, "x").as_str()), (name, x), "{output}");
            assert_eq!(
                (cell(output, row, "y").as_str(), cell(output, row, "remark").as_str()),
                (y, remark),
                "{output}"
            );
        }
        assert_eq!(cell(output, 1, "z"), z, "{output}");
    }
    // the height of an eye that the table leaves open
    assert!((cell("isovists.csv", 2, "z").parse::<f64>().unwrap() - 1.7).abs() < 0.3);
    place.summary("line-of-sight house.laz --pairs pairs.csv -o lines.csv");
    for (column, text) in [("pair", "p1"), ("ax", x), ("az", z), ("bz", "30"), ("k", "0.10"), ("answer", "1")] {
        assert_eq!(cell("lines.csv", 1, column), text, "{column}");
    }
}

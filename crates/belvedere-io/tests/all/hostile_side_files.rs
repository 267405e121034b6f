//! Damaged files of everything that is read beside clouds: meshes, city models, tables, shapes, trajectories, weather,
//! matrices.

use std::io::Cursor;
use std::time::Instant;

use belvedere_data::crs::Crs;
use belvedere_data::trajectory::Trajectory;
use belvedere_data::{GpsTimeKind, Mesh, Result};
use belvedere_io::{
    Output, RowsAre, Source, VehicleHeading, read_features, read_mesh, read_observers, read_table, read_text_rows,
    read_trajectory, read_weather, write_mesh, write_trajectory,
};

/// Number of damaged variants of each file.
const SEEDS: u64 = 200;
/// Duration that only work without end reaches, on any machine, in seconds: most files take milliseconds.
const SECONDS: f64 = 120.0;

/// A valid file, and its reader, which gives all that it read as text.
struct Format {
    name: &'static str,
    valid: Vec<u8>,
    read: fn(Source<'_>) -> Result<String>,
}

fn dutch() -> Crs {
    Crs::from_epsg(28_992).unwrap()
}

fn written(name: &str, write: impl FnOnce(Output<'_>) -> Result<()>) -> Vec<u8> {
    let mut cursor = Cursor::new(Vec::new());
    write(Output::writer(name, &mut cursor)).unwrap();
    cursor.into_inner()
}

fn mesh(name: &str) -> Vec<u8> {
    let vertices: Vec<[f64; 3]> = (0..20).map(|i| [f64::from(i), f64::from(i % 3), f64::from(i % 5)]).collect();
    let mesh = Mesh { vertices, triangles: (0..18).map(|i| [i, i + 1, i + 2]).collect(), ..Mesh::default() };
    written(name, |output| write_mesh(output, &mesh, [1.0; 3]))
}

fn trajectory(name: &str) -> Vec<u8> {
    let times: Vec<f64> = (0..30).map(|i| 250_000_000.0 + f64::from(i)).collect();
    let positions = (0..30).map(|i| [155_000.0 + 60.0 * f64::from(i), 463_000.0, 900.0]).collect();
    let crs = dutch();
    written(name, |output| {
        write_trajectory(
            output,
            &Trajectory { times, positions },
            GpsTimeKind::AdjustedStandard,
            &crs,
            VehicleHeading::Course,
        )
    })
}

/// A year of a weather file of EnergyPlus, every hour alike.
fn weather() -> Vec<u8> {
    let mut text = "LOCATION,Here,-,NLD,-,1,52.1,5.2,1.0,2.0\nDESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\n\
                    HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1\nCOMMENTS 2\nDATA PERIODS,1,1,Data,Sunday,1/1,12/31\n"
        .to_owned();
    for (month, days) in (1..).zip([31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31]) {
        for day in 1..=days {
            for hour in 1..=24 {
                let sun = if (9..=16).contains(&hour) { "300,400,120" } else { "0,0,0" };
                text.push_str(&format!(
                    "2023,{month},{day},{hour},60,?,10.0,5.0,70,101300,0,0,300,{sun},0,0,0,0,180,3\n"
                ));
            }
        }
    }
    text.into_bytes()
}

const CITY: &str = r#"{"type":"CityJSON","version":"1.1","transform":{"scale":[0.001,0.001,0.001],"translate":[85000,447000,0]},
"CityObjects":{"house":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2.2","boundaries":[[[0,1,2]],[[0,2,3]]]}]}},
"vertices":[[0,0,0],[9000,0,0],[9000,9000,0],[0,0,5000]]}"#;
const SHAPES: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"a","height":1.7},
"geometry":{"type":"LineString","coordinates":[[5.38,52.15],[5.39,52.16]]}},{"type":"Feature","properties":{},
"geometry":{"type":"Polygon","coordinates":[[[5.38,52.15],[5.39,52.15],[5.39,52.16],[5.38,52.15]]]}}]}"#;
const TABLE: &str = "id,x,y,z,height,azimuth_from\n1,155000.5,463000.25,3.87,,10\n\"b, c\",155010,463000,4,1.7,\n3,155020,463000,,1.7,350\n";

fn formats() -> Vec<Format> {
    vec![
        Format {
            name: "mesh.obj",
            valid: mesh("mesh.obj"),
            read: |source| read_mesh(source).map(|m| format!("{m:?}")),
        },
        Format {
            name: "mesh.ply",
            valid: mesh("mesh.ply"),
            read: |source| read_mesh(source).map(|m| format!("{m:?}")),
        },
        Format { name: "city.json", valid: CITY.into(), read: |source| read_mesh(source).map(|m| format!("{m:?}")) },
        Format {
            name: "shapes.geojson",
            valid: SHAPES.into(),
            read: |source| read_features(source, &dutch()).map(|shapes| format!("{shapes:?}")),
        },
        Format {
            name: "observers.csv",
            valid: TABLE.into(),
            read: |source| read_observers(source, &dutch(), RowsAre::Places).map(|rows| format!("{rows:?}")),
        },
        Format { name: "table.csv", valid: TABLE.into(), read: |source| read_table(source).map(|t| format!("{t:?}")) },
        Format {
            name: "rows.csv",
            valid: TABLE.into(),
            read: |source| read_text_rows(source).map(|t| format!("{t:?}")),
        },
        Format {
            name: "path.csv",
            valid: trajectory("path.csv"),
            read: |source| read_trajectory(source, &dutch()).map(|t| format!("{t:?}")),
        },
        Format {
            name: "path.sbet",
            valid: trajectory("path.sbet"),
            read: |source| read_trajectory(source, &dutch()).map(|t| format!("{t:?}")),
        },
        Format {
            name: "weather.epw",
            valid: weather(),
            read: |source| read_weather(source).map(|weather| weather.hours().to_string()),
        },
    ]
}

/// Numbers that repeat from run to run.
fn random(state: &mut u64, below: usize) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    usize::try_from(*state >> 33).unwrap() % below.max(1)
}

#[test]
fn damaged_files_beside_clouds_are_read_or_refused_by_name_in_time() {
    for format in formats() {
        let Format { name, valid, read } = format;
        read(Source::bytes(name, &valid)).unwrap_or_else(|e| panic!("{e}"));
        let mut refused = 0;
        for seed in 0..SEEDS {
            let mut state = seed;
            let mut bytes = valid.clone();
            match seed % 4 {
                0 => bytes.truncate(random(&mut state, valid.len())),
                1 => {
                    let start = random(&mut state, valid.len());
                    let end = (start + 1 + random(&mut state, 16)).min(valid.len());
                    bytes[start..end].fill(*[0x00, 0xff, b'9', b'('].get(random(&mut state, 4)).unwrap());
                }
                _ => {
                    // headers are at the beginning
                    let range = if seed % 8 < 4 { valid.len().min(400) } else { valid.len() };
                    for _ in 0..=random(&mut state, 3) {
                        bytes[random(&mut state, range)] ^= 1 << random(&mut state, 8);
                    }
                }
            }
            let start = Instant::now();
            if let Err(error) = read(Source::bytes(name, &bytes)) {
                assert!(error.to_string().starts_with(name), "seed {seed}: {error}");
                refused += 1;
            }
            assert!(start.elapsed().as_secs_f64() < SECONDS, "{name}, seed {seed}");
        }
        // rows that stay text are seldom wrong
        assert!(refused > 10, "{name}: only {refused} refused");
    }
}

#[test]
fn counts_and_depths_that_files_lie_about_are_refused() {
    let deep = "[".repeat(200_000);
    for (name, text) in [
        ("deep.geojson", deep.clone()),
        ("deep.json", format!("{{\"type\":\"CityJSON\",\"vertices\":{deep}")),
        ("wild.json", CITY.replace("[0,2,3]", "[0,2,4000000000]")),
        ("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n".to_owned()),
        ("negative.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n".to_owned()),
    ] {
        let error = match name.ends_with("geojson") {
            true => read_features(Source::bytes(name, text.as_bytes()), &Crs::default()).map(|_| ()),
            false => read_mesh(Source::bytes(name, text.as_bytes())).map(|_| ()),
        };
        assert!(error.is_err_and(|error| error.to_string().starts_with(name)), "{name}");
    }
    // a header without an end must not fill the memory
    let endless = "x,".repeat(5_000_000);
    assert!(
        read_observers(Source::bytes("endless.csv", endless.as_bytes()), &Crs::default(), RowsAre::Places).is_err()
    );
}

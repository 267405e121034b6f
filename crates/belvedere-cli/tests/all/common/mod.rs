//! Runs the program in a folder of its own, and a house to run it on.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests stop at the first surprise")]

pub(crate) mod page;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use belvedere::crs::Crs;
use belvedere::io::{ExtraColumn, ExtraValues, MasbcppFolder, write_cloud, write_masbcpp};
use belvedere::{Attributes, Frame, PointCloud};
use serde_json::Value;
use tempfile::TempDir;

/// A folder in which the program runs, removed at the end. Beside it lie files for `--scene-config`: [`SCENE_CONFIGS`].
pub(crate) struct Workplace(TempDir);

/// Files of parameters of balls, as `../NAME`: for commands that have no flags for them.
const SCENE_CONFIGS: [(&str, &str); 5] = [
    ("tau.json", r#"{"method": "tau"}"#),
    ("carved.json", r#"{"method": "carved"}"#),
    ("balls_alone.json", r#"{"without": ["planes"]}"#),
    ("angles.json", r#"{"method": "angles"}"#),
    ("keeping.json", r#"{"keep_isolated": true, "keep_duplicates": true}"#),
];

/// Result of a run.
#[derive(Debug)]
pub(crate) struct FinishedRun {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Workplace {
    pub(crate) fn new() -> Self {
        let place = Self(TempDir::new().unwrap());
        fs::create_dir(place.folder()).unwrap();
        SCENE_CONFIGS.iter().for_each(|(name, text)| place.write(&format!("../{name}"), text));
        place
    }

    /// A folder with a house in `house.laz`.
    pub(crate) fn with_house() -> Self {
        let place = Self::new();
        place.write_cloud("house.laz", &house());
        place
    }

    /// A folder with a house in a field in `house.laz`.
    pub(crate) fn with_field() -> Self {
        let place = Self::new();
        place.write_cloud("house.laz", &house_in_a_field());
        place
    }

    fn folder(&self) -> PathBuf {
        self.0.path().join("place")
    }

    /// Returns the folder of caches.
    pub(crate) fn cache(&self) -> PathBuf {
        self.0.path().join("cache")
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// The program with arguments parted by blanks.
    pub(crate) fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_belvedere"));
        command.current_dir(self.folder()).args(arguments.split_ascii_whitespace()).stdin(Stdio::null());
        // drivers of graphics processors complain on computers that set none
        command.env("XDG_RUNTIME_DIR", self.folder());
        // commands of one test share scenes, as those of a user do
        command.env("XDG_CACHE_HOME", self.cache());
        command
    }

    /// Runs with arguments parted by blanks.
    pub(crate) fn run(&self, arguments: &str) -> FinishedRun {
        self.run_with(arguments, &[])
    }

    /// Runs with more arguments, which may hold blanks.
    pub(crate) fn run_with(&self, arguments: &str, more: &[&str]) -> FinishedRun {
        let output = self.command(arguments).args(more).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let run = FinishedRun {
            status: output.status.code().unwrap_or_else(|| panic!("{arguments}: killed by a signal")),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        };
        assert!(!run.stderr.contains("panicked"), "{arguments}: {run:?}");
        run
    }

    /// Runs what must succeed, and gives its summary.
    pub(crate) fn summary(&self, arguments: &str) -> Value {
        self.summary_with(arguments, &[])
    }

    pub(crate) fn summary_with(&self, arguments: &str, more: &[&str]) -> Value {
        let run = self.run_with(&format!("--json {arguments}"), more);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments}");
        serde_json::from_str(&run.stdout).unwrap()
    }

    /// Runs what must fail with `status`; its message must hold each of `words`.
    pub(crate) fn refusal(&self, status: i32, arguments: &str, words: &[&str]) -> FinishedRun {
        self.refusal_with(status, arguments, &[], words)
    }

    pub(crate) fn refusal_with(&self, status: i32, arguments: &str, more: &[&str], words: &[&str]) -> FinishedRun {
        let run = self.run_with(arguments, more);
        assert_eq!(run.status, status, "{arguments}: {run:?}");
        assert_eq!(run.stdout, "", "{arguments}");
        for word in words {
            assert!(run.stderr.contains(word), "{arguments}: {word:?} is not in {}", run.stderr);
        }
        run
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The bits of the values of all bands of a raster, whatever command its metadata name.
    pub(crate) fn pixels(&self, name: &str) -> Vec<Vec<u32>> {
        let raster = belvedere::io::read_tif(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let further = raster.further_bands.into_iter().map(|band| band.values);
        let bands = std::iter::once(raster.values).chain(further);
        bands.map(|band| band.values().iter().map(|value| value.to_bits()).collect()).collect()
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Names in the folder, hidden ones too, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(self.folder()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub(crate) fn npy<T: npyz::Deserialize>(&self, name: &str) -> (Vec<u64>, Vec<T>) {
        npy(&self.path(name))
    }

    /// Values of an array of a ball file.
    pub(crate) fn npz<T: npyz::Deserialize>(&self, name: &str, array: &str) -> Vec<T> {
        let mut archive = zip::ZipArchive::new(fs::File::open(self.path(name)).unwrap()).unwrap();
        let entry = archive.by_name(&format!("{array}.npy")).unwrap_or_else(|_| panic!("{name} has no {array}"));
        npyz::NpyFile::new(entry).unwrap().into_vec().unwrap()
    }

    /// Writes a table of places around the middle of the house.
    pub(crate) fn write_places(&self, name: &str, places: &[[f64; 3]]) {
        let rows = places.iter().map(|&[x, y, z]| at(x, y, z)).map(|[x, y, z]| format!("{x},{y},{z}\n"));
        self.write(name, format!("x,y,z\n{}", rows.collect::<String>()));
    }

    /// Writes (N, 3) f64.
    pub(crate) fn write_targets(&self, name: &str, targets: &[[f64; 3]]) {
        use npyz::WriterBuilder;
        let shape = [targets.len() as u64, 3];
        let file = fs::File::create(self.path(name)).unwrap();
        let mut writer = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd().unwrap();
        writer.extend(targets.iter().flatten().copied()).unwrap();
        writer.finish().unwrap();
    }

    /// Writes a cloud; LAS and LAZ get its normals as columns.
    pub(crate) fn write_cloud(&self, name: &str, cloud: &PointCloud) {
        let path = self.path(name);
        let is_las = path.extension().is_some_and(|e| e == "las" || e == "laz");
        let axes = [0, 1, 2].map(|axis| {
            let normals = cloud.attributes.normals.as_deref().unwrap_or_default();
            normals.iter().map(|n| n[axis]).collect::<Vec<f32>>()
        });
        let column =
            |axis: usize, name| ExtraColumn { name, description: "normal", values: ExtraValues::F32(&axes[axis]) };
        let columns = [column(0, "NormalX"), column(1, "NormalY"), column(2, "NormalZ")];
        let has_columns = is_las && !axes[0].is_empty();
        write_cloud(&path, cloud, if has_columns { &columns } else { &[] }).unwrap();
    }

    /// Writes a folder with `coords.npy`, f64, and `normals.npy` where the cloud has normals.
    pub(crate) fn write_folder(&self, name: &str, cloud: &PointCloud) {
        let folder = self.path(name);
        let normals = MasbcppFolder { normals: cloud.attributes.normals.as_deref(), ..MasbcppFolder::default() };
        write_masbcpp(&folder, &normals).unwrap();
        write_cloud(&folder.join("coords.npy"), cloud, &[]).unwrap();
    }
}

/// Shape and values of an array.
pub(crate) fn npy<T: npyz::Deserialize>(path: &Path) -> (Vec<u64>, Vec<T>) {
    let file = fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let array = npyz::NpyFile::new(file).unwrap();
    (array.shape().to_vec(), array.into_vec().unwrap())
}

/// The texts of the remarks of a run.
pub(crate) fn remarks(summary: &Value) -> Vec<String> {
    let remarks = summary["remarks"].as_array().into_iter().flatten();
    remarks.map(|remark| remark["text"].as_str().unwrap().to_owned()).collect()
}

/// Easting and northing of the middle of the house, metres.
pub(crate) const EAST: f64 = 85_000.0;
pub(crate) const NORTH: f64 = 446_000.0;

/// Amplitude of the ground around the house above and below height 0, metres: an exact plane has no inside.
pub(crate) const ROUGHNESS: f32 = 0.08;

/// A gabled house on level ground at height 0, in the Dutch grid, with its outward normals, points half a metre apart.
///
/// The house spans 10 m from west to east and 8 m from south to north around (EAST, NORTH). Its eaves are 6 m high and
/// run along the south and north sides, its ridge is 9 m high. There is ground 15 m around its middle, and none below
/// it.
pub(crate) fn house() -> PointCloud {
    let mut points: Vec<([f32; 3], [f32; 3])> = Vec::new();
    let steps = |from: f32, to: f32| (0..).map(move |i| from + 0.5 * i as f32).take_while(move |v| *v <= to);
    for x in steps(-15.0, 15.0) {
        for y in steps(-15.0, 15.0).filter(|y| x.abs() > 5.0 || y.abs() > 4.0) {
            // like the black and white squares of a board: balls need something to touch below the ground
            let is_high = ((x + y) * 2.0).rem_euclid(2.0) < 0.5;
            points.push(([x, y, if is_high { ROUGHNESS } else { -ROUGHNESS }], [0.0, 0.0, 1.0]));
        }
    }
    for x in steps(-4.75, 4.75) {
        for z in steps(0.25, 5.75) {
            points.push(([x, -4.0, z], [0.0, -1.0, 0.0]));
            points.push(([x, 4.0, z], [0.0, 1.0, 0.0]));
        }
        for y in steps(-3.75, 3.75) {
            points.push(([x, y, 9.0 - 0.75 * y.abs()], [0.0, 0.6 * y.signum(), 0.8]));
        }
    }
    for y in steps(-3.75, 3.75) {
        for z in steps(0.25, 8.9 - 0.75 * y.abs()) {
            points.push(([-5.0, y, z], [-1.0, 0.0, 0.0]));
            points.push(([5.0, y, z], [1.0, 0.0, 0.0]));
        }
    }
    PointCloud {
        frame: Frame { origin: [EAST, NORTH, 0.0], crs: Crs::from_epsg(28992).unwrap() },
        positions: points.iter().map(|p| p.0).collect(),
        attributes: Attributes { normals: Some(points.iter().map(|p| p.1).collect()), ..Attributes::default() },
        ..PointCloud::default()
    }
}

/// The same house with ground 45 m around its middle, for those who look at it from farther away.
pub(crate) fn house_in_a_field() -> PointCloud {
    let mut cloud = house();
    for x in -45..=45_i16 {
        for y in (-45..=45_i16).filter(|y| x.abs() > 15 || y.abs() > 15) {
            let height = if (x + y) % 2 == 0 { ROUGHNESS } else { -ROUGHNESS };
            cloud.positions.push([f32::from(x), f32::from(y), height]);
            cloud.attributes.normals.get_or_insert_default().push([0.0, 0.0, 1.0]);
        }
    }
    cloud
}

/// A position relative to the middle of the house in the coordinates of its file.
pub(crate) fn at(x: f64, y: f64, z: f64) -> [f64; 3] {
    [EAST + x, NORTH + y, z]
}

/// Returns true if the line from a place in a direction meets the house, the part of space below all of its walls and
/// roofs.
pub(crate) fn is_hidden(place: [f64; 3], direction: [f64; 3]) -> bool {
    let sides: [([f64; 3], f64); 6] = [
        ([1.0, 0.0, 0.0], 5.0),
        ([-1.0, 0.0, 0.0], 5.0),
        ([0.0, 1.0, 0.0], 4.0),
        ([0.0, -1.0, 0.0], 4.0),
        ([0.0, 0.75, 1.0], 9.0),
        ([0.0, -0.75, 1.0], 9.0),
    ];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
    for (normal, limit) in sides {
        let (toward, room) = (dot(normal, direction), limit - dot(normal, place));
        if toward > 0.0 {
            leaves = leaves.min(room / toward);
        } else if toward < 0.0 {
            enters = enters.max(room / toward);
        } else if room < 0.0 {
            return false;
        }
    }
    enters < leaves
}

/// Cells of a column of a table.
pub(crate) fn cells(text: &str, column: &str) -> Vec<String> {
    let mut lines = text.lines().map(|line| line.split(','));
    let at = lines.next().unwrap().position(|own| own == column).unwrap_or_else(|| panic!("{column} in {text}"));
    lines.map(|mut line| line.nth(at).unwrap().to_owned()).collect()
}

/// Numbers of a column of a table; NaN for what is none.
pub(crate) fn numbers(text: &str, column: &str) -> Vec<f64> {
    cells(text, column).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
}

/// [`numbers`] of a file.
pub(crate) fn column(place: &Workplace, name: &str, column: &str) -> Vec<f64> {
    numbers(&place.text(name), column)
}

/// Corners around the middle of the house, as flags take them.
pub(crate) fn corners(places: &[[f64; 2]]) -> String {
    places.iter().map(|[x, y]| format!("{},{}", EAST + x, NORTH + y)).collect::<Vec<_>>().join(" ")
}

/// The reference data, or `None` with a line that says so.
pub(crate) fn shared_data(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("BELVEDERE_TEST_DATA").map_or(beside, PathBuf::from);
    if folder.join("reference").is_dir() {
        return Some(folder);
    }
    skipped(&format!("{test}: there is no reference data; name its folder in BELVEDERE_TEST_DATA"));
    None
}

/// Says that a test, or a part of one, did not run. The test runner captures what `eprintln!` prints and shows it for
/// failed tests only, so this writes to standard error itself.
pub(crate) fn skipped(what: &str) {
    let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
}

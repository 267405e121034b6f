//! Opens files as a scene and answers questions, for a host that may be a browser.

use belvedere::apps::ask::{remark_on_faces, remark_on_mesh, remarks_on_reading};
use belvedere::cache::CloudKey;
use belvedere::control::{Control, StageEnd, Watcher};
use belvedere::io::{
    CatalogueTile, ReadOptions, Source, UpAxis, Within, has_point_results, is_mesh, read_catalogue, read_cloud,
    read_kept_model, read_las_head, read_mesh_in,
};
use belvedere::model::{ModelParams, SceneModel};
use belvedere::shown::ShownPath;
use belvedere::{Error, PointCloud, Result};
use belvedere_viewer::{PointsOf, ReadingChoice, Refusal, SceneText, Session, UpAxisChoice, are_results, quoted};
use serde::{Deserialize, Serialize};
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::Arc;

/// Interface that the host of an engine provides.
pub trait Host: Sync {
    /// Reader of a file.
    type File: Read + Seek + Send + 'static;
    /// A file at its first byte.
    fn open(&self, file: &OpenedFile) -> Self::File;
    /// A stage has begun, of `total` items or 0.
    fn begin(&self, stage: &'static str, total: usize);
    /// More items of it are done.
    fn advance(&self, count: usize);
}

/// A file that was chosen.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenedFile {
    /// Its name, or its address; the extension tells its format.
    pub name: String,
    /// Identifier of the file at the host.
    pub id: u32,
    /// Bytes.
    pub size: u64,
}

/// Files to open.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenRequest {
    /// Clouds, which are read as one, and meshes and results of commands, which are shown beside it.
    pub files: Vec<OpenedFile>,
    /// Up axis, unit and reference system of files that do not name them.
    #[serde(default)]
    pub reading: ReadingChoice,
    /// Only points between these corners of the map are read: west, south, east, north in the coordinates of the file,
    /// turned where y is up.
    #[serde(default)]
    pub window: Option<[f64; 4]>,
    /// Maximum number of points that the memory has room for.
    pub max_points: u64,
}

/// A session that is filled from files of a host.
#[derive(Debug, Default)]
pub struct Engine {
    session: Session,
    /// Points whose balls are not built yet.
    cloud: Option<Arc<PointCloud>>,
}

impl Engine {
    /// Reads the points and shows them; [`Engine::build`] builds the scene.
    ///
    /// # Errors
    /// Those of reading; words where no point is there, or more than fit.
    pub fn open<H: Host>(request: &OpenRequest, host: &H) -> std::result::Result<Self, Refusal> {
        let chosen = Chosen::of(&request.files, host);
        let none = || Refusal::from("Meshes, rasters and shapes are shown with a cloud: choose one too.".to_owned());
        let first = *chosen.clouds.first().ok_or_else(none)?;
        // of a window the headers do not tell
        if request.window.is_none() {
            refuse_too_many(Announced::of(&request.files, host).map(|announced| announced.points), request)?;
        }
        let input = chosen.clouds.iter().map(|file| quoted(&file.name)).collect::<Vec<_>>().join(" ");
        let text = SceneText { input, cloud_beside: None };
        let session = Session::new(first.name.clone(), text);
        let sources = chosen.clouds.iter().map(|file| source(file, host));
        let mut options = ReadOptions::new();
        let reading = &request.reading;
        options.crs = reading.crs();
        if reading.up == UpAxisChoice::Y {
            options.up = UpAxis::Y;
        }
        session.loading().offer_reading(reading.clone());
        let far = f64::INFINITY;
        // of the axes that files have
        options.within = request.window.map(|[west, south, east, north]| match request.reading.up {
            UpAxisChoice::Z => Within::File { low: [west, south, -far], high: [east, north, far] },
            UpAxisChoice::Y => Within::File { low: [west, -far, -north], high: [east, far, -south] },
        });
        let reporting = Reporting(host);
        let control = Control::new(&reporting);
        let (cloud, report) = control.stage("reading", 0, || read_cloud(sources, &options, &control))?;
        refuse_too_many(Some(cloud.len() as u64), request)?;
        if cloud.is_empty() {
            return Err(Error::NoPoints { what: format!("{} has none", first.name) }.into());
        }
        let cloud = Arc::new(cloud);
        let missing = report.files.iter().map(|file| (file.path.display().to_string(), file.missing_points));
        session.loading().remark(&remarks_on_reading(report.doubt.as_deref(), missing, report.contradictions()));
        session.loading().show(&cloud);
        chosen.show(&session, &cloud, host, &control)?;
        Ok(Self { session, cloud: Some(cloud) })
    }

    /// A name for the scene of the files read, under which it can be kept: of the contents, how scenes are built, and
    /// the program.
    #[must_use]
    pub fn scene_name(&self) -> Option<String> {
        Some(CloudKey::of(self.cloud.as_deref()?).of_scene(&ModelParams::default(), true))
    }

    /// Builds the scene: questions are answered from now on.
    ///
    /// # Errors
    /// Those of [`SceneModel::build`].
    pub fn build<H: Host>(&mut self, host: &H) -> Result<()> {
        let Some(cloud) = self.cloud.take() else { return Ok(()) };
        let reporting = Reporting(host);
        let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &Control::new(&reporting))?;
        self.session.loading().finish(model);
        Ok(())
    }

    /// The same with a scene that was built before ([`Session::scene_file`]) from the same points.
    ///
    /// # Errors
    /// Those of [`read_kept_model`]; of a scene that is not one of these points.
    pub fn build_from<H: Host>(&mut self, kept: &OpenedFile, host: &H) -> Result<()> {
        let Some(cloud) = &self.cloud else { return Ok(()) };
        let (parts, derived, _) = read_kept_model(source(kept, host))?;
        let model = SceneModel::from_kept(parts, derived)?;
        if model.frame().origin != cloud.frame.origin {
            return Err(Error::malformed(kept.name.as_ref(), "is the scene of another cloud"));
        }
        self.cloud = None;
        self.session.loading().finish(model);
        Ok(())
    }

    /// The session that answers the page.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }
}

/// Summary of the headers of files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Announced {
    /// Number of points.
    pub points: u64,
    /// Lowest and highest corner on the map, in the coordinates of the files.
    pub low: [f64; 2],
    /// The highest.
    pub high: [f64; 2],
}

impl Announced {
    /// Summarises the headers, if all files have complete ones.
    pub fn of<H: Host>(files: &[OpenedFile], host: &H) -> Option<Self> {
        let mut all: Option<Self> = None;
        for file in Chosen::of(files, host).clouds {
            let head = read_las_head(source(file, host)).ok()?;
            let [low, high] = head.bounds.map(|corner| [corner[0], corner[1]]);
            let before = all.unwrap_or(Self { points: 0, low, high });
            all = Some(Self {
                points: before.points + head.points,
                low: [before.low[0].min(low[0]), before.low[1].min(low[1])],
                high: [before.high[0].max(high[0]), before.high[1].max(high[1])],
            });
        }
        all
    }
}

/// Chosen files by their contents.
struct Chosen<'a> {
    clouds: Vec<&'a OpenedFile>,
    meshes: Vec<&'a OpenedFile>,
    results: Vec<&'a OpenedFile>,
}

impl<'a> Chosen<'a> {
    /// The first LAS file is the cloud, also where it has columns of results.
    fn of<H: Host>(files: &'a [OpenedFile], host: &H) -> Self {
        let mut chosen = Self { clouds: Vec::new(), meshes: Vec::new(), results: Vec::new() };
        for file in files {
            let is_cloud = chosen.clouds.is_empty() && is_las(file, host);
            let kind = match () {
                () if is_mesh(source(file, host)) => &mut chosen.meshes,
                () if !is_cloud && are_results(|| source(file, host)) => &mut chosen.results,
                () => &mut chosen.clouds,
            };
            kind.push(file);
        }
        chosen
    }

    /// Shows the data beside the cloud, and columns of results of its own.
    fn show<H: Host>(&self, session: &Session, cloud: &PointCloud, host: &H, control: &Control<'_>) -> Result<()> {
        let (loading, frame, bounds) = (session.loading(), &cloud.frame, cloud.bounds().unwrap_or_default());
        for &file in &self.meshes {
            let (mesh, report) = control.stage("reading mesh", 0, || read_mesh_in(source(file, host), &frame.crs))?;
            loading.remark(remark_on_faces(&file.name, report.repeated_polygon_count).as_slice());
            loading.remark(remark_on_mesh(&mesh, &file.name, frame, &bounds).as_slice());
            loading.show_mesh(&mesh, frame);
        }
        let own = self.clouds.first().filter(|file| is_las(file, host));
        let own = own.filter(|file| has_point_results(source(file, host)).unwrap_or(false));
        let beside = self.results.iter().map(|file| (file, PointsOf::Other));
        for (file, points_of) in beside.chain(own.map(|file| (file, PointsOf::Cloud))) {
            control
                .stage("reading results", 0, || loading.show_results(source(file, host), points_of, frame, &bounds))?;
        }
        Ok(())
    }
}

fn source<'a, H: Host>(file: &'a OpenedFile, host: &H) -> Source<'a> {
    Source::reader(&file.name, host.open(file))
}

fn is_las<H: Host>(file: &OpenedFile, host: &H) -> bool {
    ["las", "laz"].contains(&source(file, host).extension().as_str())
}

/// A tile of a catalogue, for the page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tile {
    /// Its address.
    pub address: String,
    /// Lowest corner on the map, in the coordinates of its file.
    pub low: [f64; 2],
    /// The highest.
    pub high: [f64; 2],
    /// Number of points, where the catalogue has it.
    pub points: Option<u64>,
}

/// The tiles of a catalogue, whose name is its address.
///
/// # Errors
/// Those of [`read_catalogue`]; words for a tile of which it does not say where it lies.
pub fn tiles_of<H: Host>(file: &OpenedFile, host: &H) -> std::result::Result<Vec<Tile>, Refusal> {
    let placed = |tile: CatalogueTile| {
        let address = tile.path.to_string_lossy().into_owned();
        let on_map = |corner: [f64; 3]| [corner[0], corner[1]];
        match tile.bounds {
            Some((low, high)) if [low[0], low[1], high[0], high[1]].iter().all(|v| v.is_finite()) => {
                Ok(Tile { address, low: on_map(low), high: on_map(high), points: tile.point_count })
            }
            _ => {
                let [catalogue, tile] = [Path::new(&file.name), &tile.path].map(ShownPath);
                Err(Refusal::from(format!("{catalogue} does not say where {tile} lies (proj:bbox).")))
            }
        }
    };
    read_catalogue(source(file, host))?.into_iter().map(placed).collect()
}

fn refuse_too_many(points: Option<u64>, request: &OpenRequest) -> std::result::Result<(), Refusal> {
    match points {
        Some(points) if points > request.max_points => Err(Refusal::from(format!(
            "{points} points are more than this browser has memory for ({}). Open a smaller part, or use the program.",
            request.max_points
        ))),
        _ => Ok(()),
    }
}

/// Reports progress to a host.
struct Reporting<'a, H>(&'a H);

impl<H: Host> Watcher for Reporting<'_, H> {
    fn begin(&self, stage: &'static str, total: usize) {
        self.0.begin(stage, total);
    }
    fn advance(&self, count: usize) {
        self.0.advance(count);
    }
    fn end(&self, _stage: &'static str, _end: StageEnd) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};
    use std::io::Cursor;
    use std::sync::Mutex;

    /// Text files in memory, and the stages that were reported.
    #[derive(Default)]
    struct Memory {
        files: Vec<Vec<u8>>,
        stages: Mutex<Vec<&'static str>>,
    }

    impl Host for Memory {
        type File = Cursor<Vec<u8>>;
        fn open(&self, file: &OpenedFile) -> Self::File {
            Cursor::new(self.files[file.id as usize].clone())
        }
        fn begin(&self, stage: &'static str, _total: usize) {
            self.stages.lock().unwrap().push(stage);
        }
        fn advance(&self, _count: usize) {}
    }

    const MESH: &str = "v 155002 463002 0\nv 155003 463002 0\nv 155002 463003 2\nf 1 2 3\n";

    /// West edge of the floor, in a system of the Netherlands.
    const WEST: f64 = 155_000.0;
    const SOUTH: f64 = 463_000.0;

    /// A floor of 12 m with a block of 4 m by 4 m and 3 m, as text.
    fn block() -> Memory {
        let mut text = String::from("x y z\n");
        for i in 0..60 {
            for j in 0..60 {
                let (x, y) = (f64::from(i) * 0.2 + 0.01 * f64::from(j % 3), f64::from(j) * 0.2);
                let is_block = (4.0..8.0).contains(&x) && (4.0..8.0).contains(&y);
                let [east, north] = [WEST + x, SOUTH + y];
                text.push_str(&format!("{east:.2} {north:.2} {}\n", if is_block { 3.0 } else { 0.0 }));
            }
        }
        Memory { files: vec![text.into_bytes()], ..Memory::default() }
    }

    fn request(max_points: u64) -> OpenRequest {
        let file = OpenedFile { name: "block.xyz".to_owned(), id: 0, size: 0 };
        let reading = serde_json::from_value(json!({ "crs": "EPSG:7415" })).unwrap();
        OpenRequest { files: vec![file], reading, window: None, max_points }
    }

    fn head(reply: &[u8]) -> Value {
        let length = u32::from_le_bytes(reply[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&reply[4..4 + length]).unwrap()
    }

    #[test]
    fn meshes_and_shapes_are_shown_beside_the_cloud() {
        let mut host = block();
        let shapes = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":
            {"type":"LineString","coordinates":[[155001,463001],[155009,463002]]}}]}"#;
        host.files.extend([
            MESH.as_bytes().to_vec(),
            shapes.as_bytes().to_vec(),
            MESH.replace("1550", "1650").into_bytes(),
        ]);
        let named = |id, name: &str| OpenedFile { name: name.to_owned(), id, size: 0 };
        let mut wanted = request(10_000);
        // in any order
        wanted.files = vec![named(1, "b.obj"), named(0, "block.xyz"), named(2, "walk.geojson"), named(3, "far.obj")];
        let engine = Engine::open(&wanted, &host).unwrap();
        let state: Value = serde_json::from_slice(&engine.session().state()).unwrap();
        assert_eq!((&state["title"], &state["mesh_count"]), (&json!("block.xyz"), &json!(2)));
        assert_eq!(state["results"].as_array().unwrap().len(), 1);
        assert_eq!(state["remarks"][0]["key"], "mesh-beside-cloud");
        assert!(engine.session().part("meshes/0").unwrap().len() == 36);
        wanted.files = vec![named(1, "b.obj")];
        assert!(Engine::open(&wanted, &host).unwrap_err().to_string().contains("with a cloud"));
    }

    #[test]
    fn tiles_of_a_catalogue_are_at_addresses_beside_it() {
        let tile = r#"{"properties":{"proj:bbox":[1,2,0,3,4,9],"pc:count":7},"assets":{"data":{"href":"./a.laz"}}}"#;
        let without = r#"{"assets":{"data":{"href":"b.laz"}}}"#;
        let text = |tiles: &[&str]| format!(r#"{{"features":[{}]}}"#, tiles.join(",")).into_bytes();
        let host = Memory { files: vec![text(&[tile]), text(&[tile, without]), b"{}".to_vec()], ..Memory::default() };
        let file = |id| OpenedFile { name: "https://a.example/b/all.vpc?key=1".to_owned(), id, size: 0 };
        let address = "https://a.example/b/a.laz?key=1".to_owned();
        let expected = Tile { address, low: [1.0, 2.0], high: [3.0, 4.0], points: Some(7) };
        assert_eq!(tiles_of(&file(0), &host).unwrap(), [expected]);
        let refused = |id| tiles_of(&file(id), &host).unwrap_err().to_string();
        assert!(refused(1).contains("does not say where https://a.example/b/b.laz"), "{}", refused(1));
        assert!(refused(2).contains("no catalogue"), "{}", refused(2));
    }

    #[test]
    fn files_become_a_scene_that_answers() {
        let host = block();
        let mut engine = Engine::open(&request(10_000), &host).unwrap();
        let state: Value = serde_json::from_slice(&engine.session().state()).unwrap();
        assert_eq!(state["remarks"], json!([]));
        assert_eq!((&state["title"], &state["shown"]["point_count"]), (&json!("block.xyz"), &json!(3600)));
        let question = json!({ "observer": [WEST + 1.0, SOUTH + 6.0, 1.0], "target": [WEST + 11.0, SOUTH + 6.0, 1.0] })
            .to_string();
        let refused = engine.session().ask("ask/line", question.as_bytes(), &Control::none()).unwrap_err();
        assert_eq!(refused, Refusal::NotReady);

        engine.build(&host).unwrap();
        engine.session().prepare();
        let line = |z: f64| {
            let question = json!({ "observer": [WEST + 1.0, SOUTH + 6.0, z], "target": [WEST + 11.0, SOUTH + 6.0, z] })
                .to_string();
            let reply = engine.session().ask("ask/line", question.as_bytes(), &Control::none()).unwrap();
            head(&reply)
        };
        // through the block, and above it
        assert_eq!((&line(1.0)["answer"], &line(4.0)["answer"]), (&json!("blocked"), &json!("visible")));
        assert!(line(1.0)["command"].as_str().unwrap().contains("block.xyz --crs EPSG:7415"));
        assert_eq!(host.stages.lock().unwrap()[0], "reading");
    }

    #[test]
    fn what_the_files_do_not_say_is_chosen() {
        let mut host = block();
        // the block on its side, in millimetres: y is up
        let text = String::from_utf8(host.files.remove(0)).unwrap();
        let turned = text.lines().skip(1).map(|line| {
            let v: Vec<f64> = line.split(' ').map(|v| 1000.0 * v.parse::<f64>().unwrap()).collect();
            format!("{:.0} {:.0} {:.0}\n", v[0] - 1000.0 * WEST, v[2], 1000.0 * SOUTH - v[1])
        });
        host.files.push(format!("x y z\n{}", turned.collect::<String>()).into_bytes());
        let state = |engine: &Engine| -> Value { serde_json::from_slice(&engine.session().state()).unwrap() };
        let request = OpenRequest { reading: ReadingChoice::default(), ..request(10_000) };
        let mut engine = Engine::open(&request, &host).unwrap();
        engine.build(&host).unwrap();
        let said = state(&engine);
        assert_eq!((&said["reading"]["up"], &said["shown"]["tells_unit"]), (&json!("z"), &json!(false)));
        assert!(said["remarks"].as_array().unwrap().iter().any(|remark| remark["key"] == "y-looks-up"), "{said}");

        let reading = serde_json::from_value(json!({ "up": "y", "unit": "millimetre" })).unwrap();
        let mut engine = Engine::open(&OpenRequest { reading, ..request }, &host).unwrap();
        engine.build(&host).unwrap();
        let said = state(&engine);
        assert_eq!((&said["remarks"], &said["shown"]["tells_unit"]), (&json!([]), &json!(true)));
        let size =
            |axis: usize| said["shown"]["high"][axis].as_f64().unwrap() - said["shown"]["low"][axis].as_f64().unwrap();
        assert!(
            [11.8, 11.8, 3.0].into_iter().enumerate().all(|(axis, side)| (size(axis) - side).abs() < 0.05),
            "{said}"
        );
        let question = json!({ "observer": [1000, 6000, 1000], "target": [11000, 6000, 1000] }).to_string();
        let answer = head(&engine.session().ask("ask/line", question.as_bytes(), &Control::none()).unwrap());
        assert_eq!(answer["answer"], "blocked");
        assert!(answer["command"].as_str().unwrap().contains("--up y --crs 'LOCAL_CS"), "{answer}");
    }

    #[test]
    fn more_points_than_fit_are_refused_with_both_numbers() {
        let refusal = Engine::open(&request(3599), &block()).unwrap_err().to_string();
        assert!(refusal.contains("3600 points") && refusal.contains("(3599)"), "{refusal}");
    }

    #[test]
    fn only_the_window_is_read() {
        let window = Some([WEST, SOUTH, WEST + 5.95, SOUTH + 12.0]);
        let engine = Engine::open(&OpenRequest { window, ..request(10_000) }, &block()).unwrap();
        let state: Value = serde_json::from_slice(&engine.session().state()).unwrap();
        assert_eq!(state["shown"]["point_count"], 30 * 60);
    }

    #[test]
    fn a_kept_scene_answers_as_the_one_that_was_built() {
        let mut host = block();
        let mut built = Engine::open(&request(10_000), &host).unwrap();
        built.build(&host).unwrap();
        let question = json!({ "place": [WEST + 1.0, SOUTH + 6.0, 1.6] }).to_string();
        let seen = |engine: &Engine| engine.session().ask("ask/seen", question.as_bytes(), &Control::none()).unwrap();
        host.files.push(built.session().scene_file().unwrap());
        let kept = OpenedFile { name: "scene.npz".to_owned(), id: 1, size: 0 };
        let mut found = Engine::open(&request(10_000), &host).unwrap();
        found.build_from(&kept, &host).unwrap();
        assert!(seen(&found) == seen(&built));

        host.files[1] = b"no scene".to_vec();
        let mut broken = Engine::open(&request(10_000), &host).unwrap();
        assert!(broken.build_from(&kept, &host).is_err());
        // and is then built
        broken.build(&host).unwrap();
        assert!(seen(&broken) == seen(&built));
    }
}

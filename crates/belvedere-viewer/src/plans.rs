//! Scenarios: plans that were drawn on the page, and the scenes with them.

use crate::replies::Refusal;
use crate::scene::PageScene;
use crate::scene_text::{SceneText, named_for_maps};
use crate::shell_words::quoted;
use belvedere::control::Control;
use belvedere::io::{Source, read_mesh_in};
use belvedere::model::{ClearReport, ClearedArea};
use belvedere::{Frame, Mesh};
use serde::Deserialize;
use serde_json::json;
use std::fmt::Write;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Plans that are kept: one for each of a few tabs. Each holds as much as the scene.
const MAX_PLANS: usize = 4;
/// Meshes that are kept.
const MAX_MESHES: usize = 16;
/// File in which the drawn buildings are saved, and that in which the cleared areas are.
const BUILDINGS: &str = "planned.obj";
const AREAS: &str = "cleared.geojson";

/// Drawn plan, in the coordinates of the file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct DrawnPlan {
    /// Corners of areas to be cleared.
    clear: Vec<Vec<[f64; 2]>>,
    buildings: Vec<Building>,
    /// Numbers of meshes that were loaded.
    meshes: Vec<usize>,
}

impl DrawnPlan {
    /// Returns true if it clears areas.
    pub(crate) fn is_clearing(&self) -> bool {
        !self.clear.is_empty()
    }
}

/// A building with upright walls and a flat roof.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Building {
    corners: Vec<[f64; 2]>,
    /// Height of its foot in the file.
    base: f64,
    /// Height of its roof above that, metres.
    height_m: f64,
}

/// A plan and the scene with it.
pub(crate) struct Planned {
    pub(crate) number: usize,
    plan: DrawnPlan,
    pub(crate) scene: Arc<PageScene>,
    /// The scene on command lines.
    pub(crate) text: SceneText,
    pub(crate) report: ClearReport,
    /// Name and content of the files that the command lines need beside those of the scene.
    pub(crate) files: Vec<(&'static str, String)>,
    /// All that was added, metres.
    pub(crate) added: Vec<Arc<Mesh>>,
}

/// Plans and loaded meshes of all tabs.
#[derive(Default)]
pub(crate) struct Plans(Mutex<KeptPlans>);

#[derive(Default)]
struct KeptPlans {
    made: usize,
    plans: Vec<Arc<Planned>>,
    meshes: Vec<(String, Arc<Mesh>)>,
}

impl Plans {
    /// The plan of a number, if it is still kept.
    pub(crate) fn get(&self, number: usize) -> Result<Arc<Planned>, Refusal> {
        let found = self.lock_kept().plans.iter().find(|planned| planned.number == number).cloned();
        found.ok_or_else(|| {
            Refusal::Unanswerable("The plan is not kept any more: change it, or load the page again.".to_owned())
        })
    }

    /// Forgets all of them: their scene is another one.
    pub(crate) fn forget(&self) {
        let mut kept = self.lock_kept();
        kept.plans.clear();
        kept.meshes.clear();
    }

    /// Takes a mesh file; returns its number. Reading ends when nobody waits for it any more.
    pub(crate) fn load(
        &self,
        name: &str,
        bytes: &[u8],
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<usize, Refusal> {
        let reader = WatchedBytes { bytes: Cursor::new(bytes), control };
        let (mesh, _) = read_mesh_in(Source::reader(name, reader), &frame.crs)?;
        control.check()?;
        let mut kept = self.lock_kept();
        if kept.meshes.len() >= MAX_MESHES {
            return Err(Refusal::Unanswerable(format!(
                "No more than {MAX_MESHES} meshes can be loaded: start the program again."
            )));
        }
        kept.meshes.push((name.to_owned(), Arc::new(mesh)));
        Ok(kept.meshes.len() - 1)
    }

    /// The scene with a plan.
    pub(crate) fn make(
        &self,
        plan: DrawnPlan,
        scene: &PageScene,
        text: &SceneText,
        control: &Control<'_>,
    ) -> Result<Arc<Planned>, Refusal> {
        if let Some(planned) = self.lock_kept().plans.iter().find(|planned| planned.plan == plan) {
            return Ok(Arc::clone(planned));
        }
        if !plan.clear.is_empty() {
            check_can_clear(scene, text)?;
        }
        let frame = scene.model().frame();
        let areas = plan.clear.iter().map(|corners| area(corners, frame)).collect::<Result<Vec<_>, _>>()?;
        let (mut files, mut input, mut meshes) = (Vec::new(), text.input.clone(), Vec::new());
        if !areas.is_empty() {
            files.push((AREAS, geojson(&plan.clear, frame)));
            input.push_str(&format!(" --clear {AREAS}"));
        }
        if !plan.buildings.is_empty() {
            let obj = obj(&plan.buildings, frame)?;
            // read as the command will read it
            let (mesh, _) = read_mesh_in(Source::bytes(BUILDINGS, &obj), &frame.crs)?;
            meshes.push((BUILDINGS.to_owned(), Arc::new(mesh)));
            files.push((BUILDINGS, obj));
        }
        for &number in &plan.meshes {
            let mesh = self.lock_kept().meshes.get(number).cloned();
            meshes.push(
                mesh.ok_or_else(|| Refusal::Unanswerable("The mesh is not kept any more: load it again.".to_owned()))?,
            );
        }
        for (name, _) in &meshes {
            input.push_str(&format!(" --add {}", quoted(name)));
        }
        let (scene, report) = scene.planned(&areas, &meshes, control)?;
        let scene = Arc::new(scene);
        let mut kept = self.lock_kept();
        kept.made += 1;
        let planned = Arc::new(Planned {
            number: kept.made,
            plan,
            scene: Arc::clone(&scene),
            text: SceneText { input, cloud_beside: text.cloud_beside.clone() },
            report,
            files,
            added: meshes.into_iter().map(|(_, mesh)| mesh).collect(),
        });
        if kept.plans.len() >= MAX_PLANS {
            kept.plans.remove(0);
        }
        kept.plans.push(Arc::clone(&planned));
        drop(kept);
        scene.prepare_aside();
        Ok(planned)
    }

    fn lock_kept(&self) -> MutexGuard<'_, KeptPlans> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Refuses to clear areas of a scene whose points are not known any more.
fn check_can_clear(scene: &PageScene, text: &SceneText) -> Result<(), Refusal> {
    let reason = if text.cloud_beside.is_some() {
        "Areas can be cleared only where the balls are built from the cloud: start the program with the cloud alone."
    } else if scene.model().added().is_some() {
        "Areas are cleared before meshes are added: start Belvedere without the mesh, and load the mesh here."
    } else {
        return Ok(());
    };
    Err(Refusal::Unanswerable(reason.to_owned()))
}

/// Bytes that cannot be read any more once the work is cancelled.
struct WatchedBytes<'a> {
    bytes: Cursor<&'a [u8]>,
    control: &'a Control<'a>,
}

impl Read for WatchedBytes<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.control.check().map_err(std::io::Error::other)?;
        self.bytes.read(buffer)
    }
}

impl Seek for WatchedBytes<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.bytes.seek(to)
    }
}

fn check(corners: &[[f64; 2]]) -> Result<(), Refusal> {
    if corners.len() < 3 || !corners.as_flattened().iter().all(|v| v.is_finite()) {
        return Err(Refusal::Unanswerable("A building or an area needs at least three corners.".to_owned()));
    }
    Ok(())
}

/// An area in local metres, as `--clear` takes it.
fn area(corners: &[[f64; 2]], frame: &Frame) -> Result<ClearedArea, Refusal> {
    check(corners)?;
    let local = |&[x, y]: &[f64; 2]| {
        let [x, y, _] = frame.local_from_file([x, y, 0.0]);
        [x, y]
    };
    Ok(ClearedArea::Polygon(vec![corners.iter().map(local).collect()]))
}

/// Areas in the system of the cloud, which the file names: GeoJSON promises another.
fn geojson(areas: &[Vec<[f64; 2]>], frame: &Frame) -> String {
    let feature = |corners: &Vec<[f64; 2]>| {
        let ring: Vec<&[f64; 2]> = corners.iter().chain(corners.first()).collect();
        json!({ "type": "Feature", "properties": {}, "geometry": { "type": "Polygon", "coordinates": [ring] } })
    };
    let crs = json!({ "type": "name", "properties": { "name": named_for_maps(&frame.crs) } });
    let features = areas.iter().map(feature).collect::<Vec<_>>();
    json!({ "type": "FeatureCollection", "crs": crs, "features": features }).to_string()
}

/// Buildings as an OBJ file: floor, roof and walls.
fn obj(buildings: &[Building], frame: &Frame) -> Result<String, Refusal> {
    let mut text = "# planned buildings, in the coordinates of the cloud\n".to_owned();
    let mut first = 1;
    for (number, Building { corners, base, height_m }) in buildings.iter().enumerate() {
        check(corners)?;
        if !(base.is_finite() && height_m.is_finite() && *height_m > 0.0) {
            return Err(Refusal::Unanswerable("A building needs a height above 0 m.".to_owned()));
        }
        let count = corners.len();
        let _ = writeln!(text, "o building_{}", number + 1);
        for z in [*base, base + height_m / frame.crs.vertical_metres_per_unit] {
            for [x, y] in corners {
                let _ = writeln!(text, "v {x} {y} {z}");
            }
        }
        let words = |places: &mut dyn Iterator<Item = usize>| {
            places.map(|place| (first + place).to_string()).collect::<Vec<_>>().join(" ")
        };
        let _ = writeln!(text, "f {}", words(&mut (0..count).rev()));
        let _ = writeln!(text, "f {}", words(&mut (count..2 * count)));
        for corner in 0..count {
            let next = (corner + 1) % count;
            let _ = writeln!(text, "f {}", words(&mut [corner, next, count + next, count + corner].into_iter()));
        }
        first += 2 * count;
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere::control::Watcher;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Gives up after some looks at whether to go on.
    struct Impatient(AtomicUsize);

    impl Watcher for Impatient {
        fn is_cancelled(&self) -> bool {
            self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
        }
    }

    #[test]
    fn reading_a_mesh_ends_when_nobody_waits_for_it() {
        let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
        (0..100_000).for_each(|_| text.push_str("f 1 2 3\n"));
        let (plans, frame) = (Plans::default(), Frame::default());
        let load = |looks: usize| {
            let watcher = Impatient(AtomicUsize::new(looks));
            let loaded = plans.load("a.obj", text.as_bytes(), &frame, &Control::new(&watcher));
            (loaded.is_ok(), watcher.0.into_inner())
        };
        assert_eq!(load(5), (false, 0));
        let (is_loaded, left) = load(100);
        assert!(is_loaded && left < 95, "{left}");
        assert_eq!(plans.lock_kept().meshes.len(), 1);
    }
}

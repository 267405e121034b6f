//! Where the published method fails, by means that need no trust in it.

use crate::Tables;
use crate::experiment::parallel_to;
use crate::model::{NormalMethod, PaperModel, unlimited_tau};
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::medial::{NO_TOUCH, ShrinkParams};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::Orientation;
use belvedere::query::{Answer, query_points, random_targets};
use belvedere::trajectory::Trajectory;
use belvedere::view::to_sun;
use belvedere::{Mesh, PointCloud, Result};
use belvedere_scenes::{AirborneParams, Material, TownParams, TriangleScene, Truth, scan_airborne, town};

/// A point this deep inside a ball cannot be noise, metres.
const SURELY_INSIDE: f32 = 0.3;
/// A ball that a point enters this far is not empty in any sense, metres.
const BULGING: f32 = 0.1;
/// No building of these scenes holds a ball of this radius, metres.
const HUGE: f32 = 10.0;
/// Below this |n_z| a surface is a wall or pretends to be one.
const STEEP_NZ: f32 = 0.5;
/// Eyes of people on the ground, metres.
const EYE_HEIGHT: f64 = 1.5;

/// A way of working to be judged.
struct JudgedMethod {
    name: &'static str,
    model: PaperModel,
    profile: Profile,
    /// Depth bias, or `None` for the default.
    bias: Option<f32>,
}

impl JudgedMethod {
    /// Whether each target is visible from the sun; every target lies in the view.
    fn sunlit(&self, targets: &[[f32; 3]], to_sun: [f64; 3]) -> Result<Vec<bool>> {
        let view = parallel_to(&self.model, to_sun.map(|v| -v), SUN_PIXELS_PER_METRE)?;
        let map = depth_map(&self.model.balls, &view, self.profile, ItemBuffer::Without, &Control::none())?;
        let bias = self.bias.unwrap_or(map.default_depth_bias());
        Ok(query_points(&map, targets, bias).into_iter().map(|a| a != Answer::Blocked).collect())
    }
}

/// Random targets with exact truth.
const RANDOM_COUNT: usize = 300_000;
/// Finer than the spacing of the points.
const SUN_PIXELS_PER_METRE: f64 = 4.0;

fn percent(count: usize, of: usize) -> f64 {
    100.0 * count as f64 / of.max(1) as f64
}

/// Balls that hold points of their own cloud or air that a pulse went through, and what people on the ground would see
/// of the sun, for the real tile.
pub(crate) fn delft(published: PaperModel, cloud: &PointCloud, mesh: &Mesh, tables: &mut Tables) -> Result<()> {
    let six = NormalMethod { neighbors: 6, mesh };
    let sixteen = NormalMethod { neighbors: 16, mesh };
    let tau_six = PaperModel::of_scan(cloud, &six, unlimited_tau())?;
    let tau_sixteen = PaperModel::of_scan(cloud, &sixteen, unlimited_tau())?;
    let default = PaperModel::of_scan(cloud, &sixteen, ShrinkParams::tau())?;
    let published_again = PaperModel::of_scan(cloud, &six, ShrinkParams::angles())?;
    let methods = [
        JudgedMethod {
            name: "published (k 6, angles, cone)",
            model: published,
            profile: Profile::PaperCone,
            bias: Some(0.0),
        },
        JudgedMethod { name: "angles, k 6, sphere", model: published_again, profile: Profile::Sphere, bias: None },
        JudgedMethod { name: "τ-balls, k 6, sphere", model: tau_six, profile: Profile::Sphere, bias: None },
        JudgedMethod { name: "τ-balls, k 16, sphere", model: tau_sixteen, profile: Profile::Sphere, bias: None },
        JudgedMethod { name: "default: the same, 0.5 m at most", model: default, profile: Profile::Sphere, bias: None },
    ];
    let scene = TriangleScene {
        vertices: mesh.vertices.clone(),
        triangles: mesh.triangles.clone(),
        materials: vec![Material::Roof; mesh.triangles.len()],
        objects: vec![0; mesh.triangles.len()],
        object_names: vec!["city model".to_owned()],
        ..TriangleScene::default()
    };
    let truth = Truth::new(&scene);
    let people = people(&methods[0].model.cloud, &truth);

    tables.line("### Points and people inside balls\n");
    tables.line(
        "| balls | number | entered by a point over 0.1 m | deepest point | over 10 m | of all points inside | \
         of ground points inside | hold people | of people inside |",
    );
    tables.line("|---|---|---|---|---|---|---|---|---|");
    let inside: Vec<Inside> = methods.iter().map(|m| Inside::of(&m.model, &people.all)).collect::<Result<_>>()?;
    for (method, inside) in methods.iter().zip(&inside) {
        inside.line(method, tables);
    }
    tables.line("\nThe published balls by the point they were made for:\n");
    inside[0].by_source(tables);

    tables.line("\n### People on the ground, sun at azimuth 235° and elevation 35°\n");
    let sun = to_sun(235f64.to_radians(), 35f64.to_radians());
    let shaded = truth.occluded_towards_each(&people.modelled, sun);
    tables.line("| method | of all ground in the sun | of ground in the model's area in the sun |");
    tables.line("|---|---|---|");
    for method in &methods {
        let all = method.sunlit(&people.all, sun)?;
        let origin = method.model.cloud.frame.origin;
        let local: Vec<[f32; 3]> = people.modelled.iter().map(|&p| to_local(p, origin)).collect();
        let modelled = method.sunlit(&local, sun)?;
        let lit = |answers: &[bool]| percent(answers.iter().filter(|&&v| v).count(), answers.len());
        tables.line(&format!("| {} | {:.1} % | {:.1} % |", method.name, lit(&all), lit(&modelled)));
    }
    let lit = percent(shaded.iter().filter(|&&v| !v).count(), shaded.len());
    tables.line(&format!("| city model, no trees (exact rays) | – | {lit:.1} % |"));
    tables.line(&format!("\npeople: {} in all, {} in the area of the model", people.all.len(), people.modelled.len()));
    Ok(())
}

/// Ground points raised to the eyes of a person.
struct People {
    /// Local positions.
    all: Vec<[f32; 3]>,
    /// Coordinates of those where the city model knows the surroundings.
    modelled: Vec<[f64; 3]>,
}

/// How far around a person the city model must reach to know its sun, metres: the shadow of a 15 m roof at 35°.
const REACH: f64 = 21.0;

fn people(cloud: &PointCloud, city: &Truth) -> People {
    let classes = cloud.attributes.classification.as_deref().unwrap_or(&[]);
    let ground = cloud.positions.iter().zip(classes).filter(|&(_, &class)| class == 2);
    let all: Vec<[f32; 3]> = ground.map(|(p, _)| [p[0], p[1], p[2] + EYE_HEIGHT as f32]).collect();
    // the model stores no outline; looking down on it from well above shows where it is
    let has_model = |[x, y, z]: [f64; 3], (dx, dy): (f64, f64)| {
        city.first_hit([x + REACH * dx, y + REACH * dy, z + 100.0], [0.0, 0.0, -1.0], f64::INFINITY).is_some()
    };
    let around: Vec<(f64, f64)> = (0..8).map(|i| (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos()).collect();
    let modelled = all
        .iter()
        .map(|&p| cloud.frame.to_file_coordinates(p))
        .filter(|&p| has_model(p, (0.0, 0.0)) && around.iter().all(|&d| has_model(p, d)))
        // the model's ground must not lie above the person
        .filter(|&p| city.first_hit(p, [0.0, 0.0, -1.0], 3.0).is_some())
        .collect();
    People { all, modelled }
}

/// Kinds of points that balls are made for: class groups, gentle and steep.
const KINDS: [&str; 8] = [
    "ground, gentle",
    "ground, steep",
    "building, gentle",
    "building, steep",
    "plants and unclassified, gentle",
    "plants and unclassified, steep",
    "other, gentle",
    "other, steep",
];

fn kind(model: &PaperModel, point: u32) -> usize {
    let group = match model.class(point) {
        2 => 0,
        6 => 1,
        1 | 3..=5 => 2,
        _ => 3,
    };
    let steep = model.oriented.normals().get(point as usize).is_some_and(|n| n[2].abs() < STEEP_NZ);
    2 * group + usize::from(steep)
}

/// Which points of a cloud, and which people on its ground, lie inside its own balls.
struct Inside {
    bulging_count: usize,
    huge_count: usize,
    holding_people_count: usize,
    /// Depth of the deepest point below the surface of a ball, metres.
    deepest: f32,
    /// For each point the kinds of balls it lies deeper than [`SURELY_INSIDE`] in, as bits.
    points: Vec<u8>,
    /// The same for each person.
    people: Vec<u8>,
    balls_by_kind: [usize; KINDS.len()],
    guilty_by_kind: [usize; KINDS.len()],
}

impl Inside {
    /// Every ball against every point and person it may hold: exact.
    fn of(model: &PaperModel, people: &[[f32; 3]]) -> Result<Self> {
        let people_index = NeighborIndex::new(people, &Control::none())?;
        let mut inside = Self {
            bulging_count: 0,
            huge_count: 0,
            holding_people_count: 0,
            deepest: 0.0,
            points: vec![0; model.cloud.len()],
            people: vec![0; people.len()],
            balls_by_kind: [0; KINDS.len()],
            guilty_by_kind: [0; KINDS.len()],
        };
        let balls = &model.balls;
        for ((&center, &radius), &source) in balls.centers.iter().zip(&balls.radii).zip(&balls.source) {
            let kind = kind(model, source);
            inside.balls_by_kind[kind] += 1;
            inside.huge_count += usize::from(radius > HUGE);
            let nearest = model.index.nearest_within(center, radius * radius);
            let depth = nearest.map_or(0.0, |n| radius - n.distance_squared.sqrt());
            inside.deepest = inside.deepest.max(depth);
            inside.bulging_count += usize::from(depth > BULGING);
            let core = radius - SURELY_INSIDE;
            if core <= 0.0 {
                continue;
            }
            if depth > SURELY_INSIDE {
                model.index.within_radius(center, core, |n| inside.points[n.index as usize] |= 1 << kind);
            }
            let mut held = 0;
            people_index.within_radius(center, core, |n| {
                inside.people[n.index as usize] |= 1 << kind;
                held += 1;
            });
            inside.holding_people_count += usize::from(held > 0);
            inside.guilty_by_kind[kind] += usize::from(held > 0);
        }
        Ok(inside)
    }

    fn line(&self, method: &JudgedMethod, tables: &mut Tables) {
        let count = method.model.balls.len();
        let held = |kinds: &[u8]| percent(kinds.iter().filter(|&&k| k != 0).count(), kinds.len());
        let ground: Vec<u8> =
            (0..).zip(&self.points).filter(|&(i, _)| method.model.class(i) == 2).map(|(_, &k)| k).collect();
        tables.line(&format!(
            "| {} | {count} | {:.2} % | {:.2} m | {:.1} % | {:.3} % | {:.3} % | {:.1} % | **{:.1} %** |",
            method.name,
            percent(self.bulging_count, count),
            self.deepest,
            percent(self.huge_count, count),
            held(&self.points),
            held(&ground),
            percent(self.holding_people_count, count),
            held(&self.people)
        ));
    }

    fn by_source(&self, tables: &mut Tables) {
        tables.line("| made for | balls | of them hold people | of all people inside |");
        tables.line("|---|---|---|---|");
        for (kind, name) in KINDS.iter().enumerate() {
            let people = self.people.iter().filter(|&&k| k >> kind & 1 == 1).count();
            tables.line(&format!(
                "| {name} | {} | {:.1} % | {:.1} % |",
                self.balls_by_kind[kind],
                percent(self.guilty_by_kind[kind], self.balls_by_kind[kind]),
                percent(people, self.people.len())
            ));
        }
    }
}

/// Whether each ball's centre lies outside every solid and above the ground. The first surface straight above tells: it
/// is seen from behind by what is inside.
fn free_centers(model: &PaperModel, scene: &TriangleScene, truth: &Truth) -> Vec<bool> {
    let up = [0.0, 0.0, 1.0];
    let faces_up = |triangle: u32| {
        scene
            .corners(triangle as usize)
            .is_some_and(|[a, b, c]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0)
    };
    let centers = model.balls.centers.iter().map(|&c| model.cloud.frame.to_file_coordinates(c));
    centers.map(|c| truth.first_hit(c, up, f64::INFINITY).is_none_or(|hit| !faces_up(hit.triangle))).collect()
}

/// The model as an oracle would have it: without balls in free air that were made for points of these classes.
fn without_free_centers(mut model: PaperModel, classes: &[u8], scene: &TriangleScene, truth: &Truth) -> PaperModel {
    let free = free_centers(&model, scene, truth);
    for (ball, free) in free.into_iter().enumerate() {
        if free && classes.contains(&model.class(model.balls.source[ball])) {
            // depth maps leave these out
            model.balls.touch[ball] = NO_TOUCH;
        }
    }
    model
}

/// The published method against exact answers in a simulated town.
pub(crate) fn simulated_town(tables: &mut Tables) -> Result<()> {
    tables.line("\n## A simulated town\n");
    let scene = town(&TownParams::default());
    let scan = scan_airborne(&scene, &AirborneParams::default());
    let truth = Truth::new(&scene);
    let coordinates: Vec<[f64; 3]> = scan.x.iter().zip(&scan.y).zip(&scan.z).map(|((&x, &y), &z)| [x, y, z]).collect();
    let (mut cloud, _) = PointCloud::from_coordinates(&coordinates);
    cloud.attributes.classification = Some(scan.classification.clone());
    cloud.attributes.gps_time = Some(scan.gps_time.clone());
    cloud.attributes.gps_time_kind = belvedere::GpsTimeKind::AdjustedStandard;
    let path = &scan.sensor_path;
    let (trajectory, _) =
        Trajectory::from_records(path.times.iter().copied().zip(path.positions.iter().copied()).collect());
    let by = Orientation::Trajectory(&trajectory);
    let make = |k, params| PaperModel::of_oriented_scan(&cloud, k, &by, params);
    let (angles, tau) = (ShrinkParams::angles, unlimited_tau);
    let sphere = |name, model| JudgedMethod { name, model, profile: Profile::Sphere, bias: None };
    let methods = [
        JudgedMethod {
            name: "published (k 6, angles, cone, no bias)",
            model: make(6, angles())?,
            profile: Profile::PaperCone,
            bias: Some(0.0),
        },
        sphere("k 6, angles, sphere", make(6, angles())?),
        sphere("k 16, angles, sphere", make(16, angles())?),
        sphere("k 6, τ-balls, sphere", make(6, tau())?),
        sphere("k 16, τ-balls, sphere", make(16, tau())?),
        sphere("default: the same, 0.5 m at most", make(16, ShrinkParams::tau())?),
    ];
    methods[0].model.report(tables);
    let cured_of = |model, classes: &[u8]| without_free_centers(model, classes, &scene, &truth);
    let cured = [
        sphere("k 6, angles, sphere, without wrong balls of plants", cured_of(make(6, angles())?, &[5])),
        sphere("k 6, angles, sphere, without wrong balls of buildings", cured_of(make(6, angles())?, &[6])),
        sphere("k 6, angles, sphere, without any wrong ball", cured_of(make(6, angles())?, &[2, 5, 6])),
        sphere("k 6, τ-balls, sphere, without any wrong ball", cured_of(make(6, tau())?, &[2, 5, 6])),
        sphere("k 16, τ-balls, sphere, without any wrong ball", cured_of(make(16, tau())?, &[2, 5, 6])),
    ];
    tables.line("Balls whose centre lies in free air, in truth:\n");
    tables.line("| made for | published balls | in free air | τ-balls, k 16 | in free air |");
    tables.line("|---|---|---|---|---|");
    let free = [&methods[1].model, &methods[4].model].map(|model| free_centers(model, &scene, &truth));
    for (i, name) in KINDS.iter().enumerate() {
        let mut line = format!("| {name} |");
        for (model, free) in [&methods[1].model, &methods[4].model].into_iter().zip(&free) {
            let of_kind = model.balls.source.iter().zip(free).filter(|&(&source, _)| kind(model, source) == i);
            let (count, free) = of_kind.fold((0, 0), |(count, free), (_, &f)| (count + 1, free + usize::from(f)));
            line += &format!(" {count} | {:.1} % |", percent(free, count));
        }
        tables.line(&line);
    }
    tables.line("");

    let sun = to_sun(235f64.to_radians(), 30f64.to_radians());
    let people: Vec<[f64; 3]> = scan
        .exact_positions
        .iter()
        .zip(&scan.classification)
        .filter(|&(_, &class)| class == 2)
        .map(|(p, _)| [p[0], p[1], p[2] + EYE_HEIGHT])
        .collect();
    let people_lit: Vec<bool> = truth.occluded_towards_each(&people, sun).into_iter().map(|v| !v).collect();
    let own_lit: Vec<bool> = truth.occluded_towards_each(&scan.exact_positions, sun).into_iter().map(|v| !v).collect();
    let local_people: Vec<[f32; 3]> = people.iter().map(|&p| to_local(p, cloud.frame.origin)).collect();
    let random = random_targets(methods[0].model.low, methods[0].model.high, RANDOM_COUNT, 1);
    let random_exact: Vec<[f64; 3]> = random.iter().map(|&p| cloud.frame.to_file_coordinates(p)).collect();
    let random_lit: Vec<bool> = truth.occluded_towards_each(&random_exact, sun).into_iter().map(|v| !v).collect();
    let lit_share = |lit: &[bool]| percent(lit.iter().filter(|&&v| v).count(), lit.len());
    tables.line(&format!(
        "in the sun in truth: {:.1} % of {} people, {:.1} % of {} own points, {:.1} % of {} random targets\n",
        lit_share(&people_lit),
        people.len(),
        lit_share(&own_lit),
        own_lit.len(),
        lit_share(&random_lit),
        random_lit.len()
    ));
    tables.line(
        "| method | people: sunlit called blocked | shaded called visible | own points: sunlit called blocked | \
         shaded called visible | random targets: sunlit called blocked | shaded called visible |",
    );
    tables.line("|---|---|---|---|---|---|---|");
    for method in methods.iter().chain(&cured) {
        let mut line = format!("| {} |", method.name);
        for (targets, lit) in [(&local_people, &people_lit), (&cloud.positions, &own_lit), (&random, &random_lit)] {
            let answers = method.sunlit(targets, sun)?;
            let wrong = |truly: bool| {
                let of = lit.iter().filter(|&&l| l == truly).count();
                let wrong = lit.iter().zip(&answers).filter(|&(&l, &a)| l == truly && a != truly).count();
                percent(wrong, of)
            };
            line += &format!(" {:.1} % | {:.1} % |", wrong(true), wrong(false));
        }
        tables.line(&line);
    }
    Ok(())
}

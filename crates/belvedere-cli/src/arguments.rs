//! What can be typed: flags as entered. What they build is made in `pipeline` and in each command.

mod envelope;
mod irradiance;
mod observers;
mod shadow;
mod sky;
mod sun;
mod surroundings;
mod towns;
mod vegetation;
mod view;

pub(crate) use envelope::{Comfort, Corners, Envelope};
pub(crate) use irradiance::{ClearSkyChoice, Irradiance};
pub(crate) use observers::{Earth, GivingWay, GroundChoice, LineOfSight, Place, Shell, Viewshed};
pub(crate) use shadow::Shadow;
pub(crate) use sky::{FacingChoice, PatchesChoice, SkyOutputs, SkyPlaces, SkyView};
pub(crate) use sun::{ElevationChoice, SunHours, SunPeriod, SunPlace};
pub(crate) use surroundings::{BelowChoice, Eyes, Horizon, Isovist, Landmark, MeshTargets, NorthChoice};
pub(crate) use towns::{Compare, PatternChoice, ScannerChoice, Simulate};
pub(crate) use vegetation::{LeavesChoice, ThroughTrees, ThroughTreesChoice};
pub(crate) use view::{SizeChoice, ViewChoice};

use belvedere::crs::Crs;
use belvedere::medial::Rule;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// Wrong usage that only shows once arguments are combined: exit status 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Visibility analysis directly on point clouds.
///
/// A point cloud becomes a union of medial balls; the balls block lines of sight; a depth map answers what is visible.
/// No city model, no raster of heights: balconies, trees, bridges and facades count.
///
/// Start with `belvedere demo`, then `belvedere info FILE` on a cloud of your own.
#[derive(Parser)]
#[command(name = "belvedere", version, max_term_width = 110, arg_required_else_help = true, propagate_version = true)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) global: Global,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Args)]
#[command(next_help_heading = "Everywhere")]
pub(crate) struct Global {
    /// Threads to work with; results are the same for any number [default: all processors]
    #[arg(long, global = true, value_name = "N", value_parser = at_least_one)]
    pub(crate) threads: Option<usize>,
    /// Seed of everything random
    #[arg(long, global = true, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Print the summary as one JSON object: the same figures, under names without blanks
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Say how long each stage takes, on standard error
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Print nothing but errors
    #[arg(long, global = true, conflicts_with_all = ["verbose", "json"])]
    pub(crate) quiet: bool,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Simulate a small town and run everything on it; needs no input
    #[command(after_help = "Example:\n  belvedere demo -o demo")]
    Demo(Demo),
    /// Simulate a town and its laser survey: cloud, trajectory, exact mesh and exact answers, to test any method against
    #[command(
        after_help = "What DIR gets:\n  cloud.laz        LAZ 1.4 in EPSG:7415: class, GPS time, scan angle, returns, strip or station, and lit_110_20,\n                   lit_180_65, lit_240_35: 1 where the sun at that azimuth and elevation reaches the point, by the mesh\n  trajectory.csv   time,x,y,z of the scanner, 20 a second\n  trajectory.sbet  the same as SBET, with velocities and headings\n  stations.csv     tripod positions (terrestrial only)\n  mesh.obj         the exact town: an object each for ground, buildings, trees, with materials\n  mesh.city.json   the same as CityJSON 2.0, with parts of buildings and kinds of surfaces\n  blocks.obj       the same town as LoD1 blocks, as a coarse city model has it\n\nExamples:\n  belvedere simulate -o town --extent 100\n  belvedere simulate village -o village --extent 100 --pattern conical --density 4\n  belvedere simulate old-town -o streets --extent 100 --scanner terrestrial --stations 2 --angular-step 0.5"
    )]
    Simulate(Simulate),
    /// Tell what is in a point cloud, what is missing, and what can be done with it
    #[command(after_help = "Example:\n  belvedere demo -o demo\n  belvedere info demo/town.laz")]
    Info(Info),
    /// Find where the scanner was from the pulses of a cloud, and write its path
    #[command(
        after_help = "The path follows from pulses with several returns, else from scan angles where these can be trusted. OUT gets the columns time, x, y, z, sd_x, sd_y, sd_z (standard deviations), residual_deg (median angle between pulses and the directions to the path) and line, in the system and unit of the cloud, and can be given back as --orient trajectory=OUT.\n\nExample:\n  belvedere trajectory demo/town.laz -o demo/found.csv"
    )]
    Trajectory(Trajectory),
    /// Estimate normals and turn them outward
    #[command(
        after_help = "Examples:\n  belvedere normals demo/town.laz --orient trajectory=demo/trajectory.csv -o demo/normals.laz\n  belvedere normals FOLDER --neighbors 10 -o FOLDER      coords.npy to normals.npy, as masbcpp's compute_normals"
    )]
    Normals(Normals),
    /// Shrink medial balls: the solid parts of a scene as a union of balls, for use in other commands
    #[command(
        after_help = "Examples:\n  belvedere balls demo/town.laz --orient trajectory=demo/trajectory.csv -o demo/balls.npz\n  belvedere balls FOLDER -o FOLDER                 coords.npy and normals.npy to ma_*.npy, as masbcpp's compute_ma\n  belvedere balls FOLDER --simplify 0.4 -o FOLDER  also lfs.npy and decimate_lfs.npy, as masbcpp's simplify"
    )]
    Balls(Balls),
    /// Draw how far one sees along each pixel of a view
    #[command(
        name = "depth-map",
        after_help = "A ball file of `belvedere balls` may stand in place of the clouds; nothing is then left to clean, orient or shrink.\n\nExamples:\n  belvedere depth-map demo/town.laz --sun 235,30 -o demo/seen-from-the-sun.png\n  belvedere depth-map demo/balls.npz --eye 154950,462950,40 --look-at 155000,463000,0 -o demo/seen-by-a-camera.png\n  belvedere depth-map demo/balls.npz --panorama 155000,463000,30 --size 1200 -o demo/all-around.png\n  belvedere depth-map demo/balls.npz --viewport \"154940,463060,60 120,0,0 0,-120,0 4\" -o demo/from-above.tif"
    )]
    DepthMap(DepthMap),
    /// Answer which targets are visible in a view
    #[command(
        after_help = "Answers: 0 blocked, 1 visible, 3 outside the view: beside the picture, behind the plane of a --viewport, or beyond the limits of depth of an --eye.\n\nCarved balls are asked by exact lines of sight, and so are all in a view from --eye or --panorama, others through a depth map. Where targets are many for each pixel, a certified depth map settles most of them; the answers are the same. Where carved balls know their pulses (a cloud, or an .npz of `belvedere balls`) there is one answer more, 2 unproven: nothing blocks the target, but more than half a metre of its line of sight runs through space that no pulse came within 0.7 m of. The project's docs/accuracy.md says how often each answer is right. Of space beside the survey nothing is asked.\n\nTargets that are a mesh (.obj, CityJSON, .ply with faces) are answered face by face: a table (.csv) with a row for each object and then for each triangle, with area, visible and unproven area in square metres, share, and standard error of sampling; or the mesh coloured by the share (.ply).\n\nA ball file of `belvedere balls` may stand in place of the clouds; nothing is then left to clean, orient or shrink.\n\nExamples:\n  belvedere query demo/town.laz --sun 235,30 --self -o demo/lit.laz\n  belvedere query demo/town.laz --method carved --orient trajectory=demo/trajectory.csv --sun 235,30 --self -o demo/lit.laz\n  belvedere query demo/town.laz --method carved --orient trajectory=demo/trajectory.csv --sun 235,30 --self --unproven as-blocked -o demo/proven-lit.laz\n  belvedere query demo/balls.npz --sun 235,30 --random 10000 -o demo/answers.csv\n  belvedere query demo/balls.npz --direction 0,0,-1 --targets demo/answers.csv -o demo/open-to-the-sky.csv\n  belvedere query demo/balls.npz --panorama 155000,463000,30 --random 10000 -o demo/seen-from-the-middle.csv\n  belvedere query demo/balls.npz --sun 235,30 --targets demo/town.obj -o demo/lit-faces.csv\n  belvedere query demo/balls.npz --panorama 154980,462970,5 --targets demo/town.obj --back-faces left-out -o demo/seen-faces.ply"
    )]
    Query(Query),
    /// Answer lines of sight between pairs of points: what blocks each first, and where
    #[command(
        name = "line-of-sight",
        after_help = "A ball file of `belvedere balls` may stand in place of the clouds; nothing is then left to clean, orient or shrink. Balls that hold A are left out; those near B give way by --shell.\n\nOn lines of more than 2 km the earth's curvature and refraction count: the line is a parabola over the map, cut into chords of 500 m.\n\nThe profile has the columns distance_m, ground, line (heights in the unit of the file), blocked (1 where a ball lies on the line) and blocks (the ranges of heights that lie in balls there).\n\nExamples:\n  belvedere line-of-sight demo/balls.npz --from 155000,462985,3 --to 155020,463030,12\n  belvedere line-of-sight demo/town.laz --from 155000,462985,3 --to 155020,463030,12 --profile-out demo/profile.png\n  belvedere line-of-sight demo/balls.npz --random 10000 -o demo/sights.csv\n  belvedere line-of-sight demo/balls.npz --pairs demo/sights.csv --unproven as-blocked -o demo/proven-sights.csv"
    )]
    LineOfSight(LineOfSight),
    /// Map what observers see, or from where a target is seen, on the ground and on the points of a cloud
    #[command(
        after_help = "Cells have their targets on the ground, --target-height above it. What lies beyond --max-distance or is not looked at is nodata, as are cells without ground. An observer inside something solid or below the ground is reported.\n\nWhere carved balls know their pulses, unproven marks what nothing blocks but whose line of sight runs for more than half a metre through space that no pulse came near to; --heights asks the balls alone.\n\nA ball file of `belvedere balls` may stand in place of the clouds, with --ground cloud=FILE.\n\nExamples:\n  belvedere viewshed demo/town.laz --observer 155000,462985 --max-distance 50 -o demo/seen.tif -o demo/seen.png\n  belvedere viewshed demo/balls.npz --ground cloud=demo/town.laz --observer 155000,462985 --heights demo/hidden-below.tif -o demo/seen.geojson\n  belvedere viewshed demo/balls.npz --ground cloud=demo/town.laz --target 155000,462985 --target-height 10 --cell 1 -o demo/seen-from.tif"
    )]
    Viewshed(Viewshed),
    /// Tell how much of a landmark is seen from every place, and how large it stands before it
    #[command(
        after_help = "A landmark is a mesh, or points of the cloud, which stand for the surface around them. For each observer: area seen in square metres, share of the whole surface, of which half and more is always turned away, solid angle in steradians, share of all azimuths in which some of it is seen, angles between its outermost, and between its lowest and highest parts seen, in degrees, and range of the nearest and of the farthest part. Cells whose eye would be inside something solid are nodata.\n\nExamples:\n  belvedere landmark demo/town.laz --target demo/town.obj --object building_10 -o demo/landmark.png -o demo/landmark.tif\n  belvedere landmark demo/town.laz --target-class 6 --cell 12 --measures demo/buildings -o demo/buildings.csv"
    )]
    Landmark(Landmark),
    /// Measure the space that an eye sees: volume, area, openness, occlusivity, drift
    #[command(
        after_help = "Rays run in equal steps of azimuth and elevation, each counting by its solid angle. The plan is the level plane through the eye; it has more rays where ranges jump. Occlusivity is the length of these jumps: edges behind which something hides. Balls that hold the eye are left out, and such eyes reported.\n\nExample:\n  belvedere isovist demo/town.laz --eye 154980,462970 -o demo/isovist.csv -o demo/isovist.png"
    )]
    Isovist(Isovist),
    /// Find above which elevation the sky is free around a place, in each direction
    #[command(
        after_help = "Exact for the balls: what floats above a gap counts. The elevation is that above which nothing stands up to the zenith. The eye may lie on a surface: balls give way to it by 0.2 m. Beyond the rim of the cloud nothing is known.\n\nPVGIS reads .txt (one height a line, from north clockwise, equal steps); pvlib's users read .csv. Both count from true north: --north true.\n\nExamples:\n  belvedere horizon demo/town.laz --eye 154980,462970 -o demo/horizon.csv -o demo/horizon.png\n  belvedere horizon demo/balls.npz --eye 154980,462970,12 --step 7.5 --north true -o demo/horizon.txt"
    )]
    Horizon(Horizon),
    /// Find what lies in the shadow at an instant, for a sun, or through a day
    #[command(
        after_help = "Column lit: the share of the sun that a place sees, 1 lit, 0 in shadow, between with --soft or through trees; of several suns a column each, named by date and time. A sun below the horizon lights nothing. Where carved balls know their pulses, and for one sun with hard edges, column unproven marks what nothing shades but whose line of sight runs for more than half a metre through space that no pulse came near to.\n\nTimes need an offset or a zone. Azimuths of the sun count from true north and are turned into the grid of the reference system, which stands up to some degrees askew; --sun counts from grid north.\n\nExamples:\n  belvedere shadow demo/town.laz --time 2026-06-21T15:00+02:00 -o demo/shadow.png -o demo/shadow.tif\n  belvedere shadow demo/town.laz --sun 235,30 --soft --cell 1 -o demo/soft-shadow.tif\n  belvedere shadow demo/town.laz --date 2026-03-21 --zone Europe/Amsterdam --step 60 --cell 1 -o demo/shadows.csv --film demo/day.png"
    )]
    Shadow(Shadow),
    /// Measure how much of the sky places see: the sky view factor and sky openness
    #[command(
        name = "sky-view",
        after_help = "Two measures that are often mixed up, both 0 to 1. sky_view_factor is weighted by the cosine to the surface, (1/π) ∫ cos θ dΩ: the share of the light of an even sky that arrives, as energy models want it. sky_openness is the plain share of the hemisphere above the horizon, (1/2π) ∫ dΩ. Before a free wall both are ½.\n\nBalls alone are asked. Beyond the rim of the cloud nothing stands in the way.\n\nExamples:\n  belvedere sky-view demo/town.laz --cell 2 -o demo/sky.tif -o demo/sky.png\n  belvedere sky-view demo/town.laz --self --directions 48 -o demo/sky.laz\n  belvedere sky-view demo/balls.npz --targets demo/town.obj --spacing 2 --directions 145 -o demo/sky-of-faces.csv"
    )]
    SkyView(SkyView),
    /// Sum up the energy of sun and sky over a year, and what shading takes of it: for cells, points, meshes, and the planes of roofs
    #[command(
        after_help = "Of the ground or a surface the energy is that of a level plane; points and meshes may be --facing normals. The sun's part is lost where balls hide the sun; the sky's part patch by patch. kwh_m2 is the total of the period, loss the share that shading takes of what would arrive without obstacles.\n\nOf a plane of a roof least_loss is the loss of radiation, the mean of its cells: what a plant loses whose panels each work for themselves. most_loss is that of a plant whose rows are strings in which the worst panel counts. Real plants lie between.\n\nWith --through-trees the parts of the year in leaf and bare are summed up apart; --horizons show trees as opaque.\n\nRows of weather get the sun of the middle of their interval (EPW, TMY3: local standard time, the hour ends) or of their instant (PVGIS: UTC; NSRDB), and are cut into --parts.\n\nExamples:\n  belvedere irradiance demo/town.laz --clear-sky ineichen --surface --cell 4 --sun-cell 3 --through-trees seasons -o demo/energy.tif -o demo/energy.png\n  belvedere irradiance demo/town.laz --clear-sky ineichen --linke 4 --sun-cell 4 --patch-division 1 --panel 2 --planes demo/roofs.csv --planes demo/roofs.geojson --horizons demo/horizons"
    )]
    Irradiance(Irradiance),
    /// Measure how long the sun reaches each place, on a day, over a period, or by a rule
    #[command(
        name = "sun-hours",
        after_help = "Measures: sun_hours (a day; over several days their mean), sun_share of what a flat horizon would leave, first_light and last_light (hours on the clocks of --zone; over several days the earliest and the latest), longest (hours on end); over several days also least_day (hours on the darkest) and total_hours; for each rule 1 where it is met on all its days.\n\nA day runs from midnight to midnight of the sun, so that it holds the whole light of the place whatever the zone. The middle of the sun counts, above a flat horizon. Surfaces that are turned by their normals are not lit from behind. Clouds of the sky are not known: these are possible hours. With --through-trees hours behind crowns alone count by the share of their day; first_light, last_light and longest stay those of the open sun.\n\nRules: nl-light, 2 h a day from 19 February to 21 October, and nl-strict, 3 h from 21 January to 22 November (TNO, the Netherlands); the-hague, as nl-light with the sun above 10 degrees; bre-equinox, 2 h on 21 March (BRE 209, United Kingdom).\n\nExamples:\n  belvedere sun-hours demo/town.laz --date 2026-06-21 --cell 1 --through-trees seasons -o demo/sun.tif -o demo/sun.png\n  belvedere sun-hours demo/town.laz --rule bre-equinox --zone Europe/Amsterdam --cell 2 -o demo/rule.csv\n  belvedere sun-hours demo/balls.npz --from 2026-03-01 --to 2026-03-07 --step 30 --targets demo/town.obj --spacing 2 -o demo/sun-of-faces.csv"
    )]
    SunHours(SunHours),
    /// Find the largest volume over a parcel that takes no sun from its neighbours
    #[command(
        after_help = "The solar envelope of Knowles: nothing built within it casts a shadow on what is protected, at any of the suns. Heights are those of columns, each bounded over its whole square, in closed form: lines are not sampled against the sun. Between two instants the shadow's edge may pass a little further; take shorter steps where that matters.\n\nShadows may lie on a --fence and below its top. Rims of polygons are protected as lines, so that a neighbour's parcel stays free; facades count for the suns they face. With --credit-shade what the cloud shades already bounds nothing, the parcel's own buildings included: leave their points out where they will go.\n\nWhere no sun bounds a column the envelope is infinitely high: give --ceiling for volumes and solids.\n\nExamples:\n  belvedere envelope demo/town.laz --parcel \"154970,462985 154990,462985 154990,463000 154970,463000\" --protect \"154960,463004 155000,463004\" --fence 1.8 --date shortest-day --between 10:00,14:00 --ceiling 30 -o demo/envelope.tif -o demo/envelope.png -o demo/envelope.obj\n  belvedere envelope demo/town.laz --parcel \"154970,462985 154990,462985 154990,463000\" --protect \"154960,463004 155000,463004\" --sun 180,30 --sun 210,20 --ceiling 20 --tops demo/tops.tif -o demo/envelope.ply"
    )]
    Envelope(Envelope),
    /// Measure sun and sky along walking routes and at windows, for studies of comfort, daylight and value
    #[command(
        after_help = "Of a route each place stands for the way around it, 1.1 m above the ground, level: sky_view_factor (cosine-weighted), sky_openness (solid angle), sun_hours a day and sun_share of what a flat horizon leaves, first_light and last_light (hours on the clocks of --zone), longest (hours on end). --routes sums them up, weighted by length; --times tells the share of each route in shade at each sun.\n\nOf a window the same, tilted, and sky_component: the light straight from an overcast sky (CIE) as a share of that on a free level plane; upright it is the vertical sky component of BRE 209, 0.396 before a free wall. Windows that have a width and a height are asked at nine places, the mean of which counts; faces of a mesh at one of each piece.\n\nClouds of the sky are not known: hours are possible hours. Temperature, wind and humidity are not either: PET and UTCI need them besides.\n\nExamples:\n  belvedere comfort demo/town.laz --route \"154965,462985 155000,462985 155000,463020\" --date 2026-06-21 --step 30 -o demo/route.csv --routes demo/routes.csv --times demo/times.csv\n  belvedere comfort demo/balls.npz --windows demo/town.obj --spacing 2 --directions 145 --date equinox --step 30 -o demo/windows.csv"
    )]
    Comfort(Comfort),
    /// Hold every method against exact answers on the same places: how right each is, and what it costs
    #[command(
        after_help = "Places are simulated towns, or a cloud of your own with an exact mesh of the same place (--scene with --mesh). Each result is kept in a file below OUT/results; a run that was interrupted goes on where it stopped.\n\nRates: of the targets that are visible in truth the share called blocked (false-blocked), of the blocked the share called visible (false-visible), and the mean of the two shares that are right (balanced), averaged over three suns, over two observers, or over 40 people in streets (4 for methods that build a hull or draw shadow maps for each eye), with 95 % intervals from resampled tiles of 25 m.\n\nMethods: paper-cone, paper-sphere, union, hidden-points, hidden-points-robust, surfels, depth-splats, elliptical-splats, implicit-surface, voxels-05, voxels-10, dsm, tin, tau, carved (and, only when named, carved-without-RULE); for each model also mesh-NAME, shadow-map-NAME and dsm-NAME, and for the first paper-cone-NAME. Simulated places have the models blocks (LoD1), no-trees and exact. The project's docs/methods has a page on each.\n\nA thorough comparison takes several places and seeds, such as --presets village,old-town,towers --seeds 1,2,3.\n\nExample:\n  belvedere compare --extent 100 --targets 2000 --methods paper-cone,carved -o compared"
    )]
    Compare(Compare),
    /// Print a completion script for a shell
    #[command(after_help = "Example:\n  belvedere completions bash > belvedere.bash")]
    Completions {
        /// Shell to complete for
        shell: clap_complete::Shell,
    },
    /// Print the manual page
    #[command(after_help = "Example:\n  belvedere man > belvedere.1")]
    Man,
}

#[derive(Args)]
pub(crate) struct Demo {
    /// Folder for clouds, balls, maps and pictures; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "demo")]
    pub(crate) output: PathBuf,
    /// Side of the town in metres
    #[arg(long, value_name = "M", default_value_t = 120.0)]
    pub(crate) extent: f64,
}

#[derive(Args)]
pub(crate) struct Info {
    #[command(flatten)]
    pub(crate) input: CloudInput,
}

#[derive(Args)]
pub(crate) struct Trajectory {
    #[command(flatten)]
    pub(crate) input: CloudInput,
    /// Seconds between positions, 0.01 to 2
    #[arg(long, value_name = "S", default_value_t = 0.5, help_heading = "Result", allow_negative_numbers = true)]
    pub(crate) step: f64,
    /// Table for the path (.csv .txt)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
}

#[derive(Args)]
pub(crate) struct Normals {
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) cleaning: Cleaning,
    #[command(flatten)]
    pub(crate) orienting: Orienting,
    /// Cloud with normals as attributes (.laz .las .ply .csv), or a folder for coords.npy and normals.npy
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
}

#[derive(Args)]
pub(crate) struct Balls {
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) cleaning: Cleaning,
    #[command(flatten)]
    pub(crate) orienting: Orienting,
    #[command(flatten)]
    pub(crate) shrinking: Shrinking,
    /// Side to make balls on; a folder always gets both [default: interior]
    #[arg(long, value_enum, default_value_t = SideChoice::Interior, hide_default_value = true)]
    pub(crate) side: SideChoice,
    /// Ball file: .npz keeps all that later commands use, the pulses of --method carved among it; .ply .laz .las are for
    /// looking at, with the radius as the size of a point, and hold the balls alone. Or a folder for masbcpp's ma_coords_*.npy and ma_qidx_*.npy (one row per input
    /// point: nothing is cleaned away, and the method is `angles` unless said otherwise)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// In a folder: write NaN as centre of balls that never shrank
    #[arg(long, help_heading = "Result")]
    pub(crate) nan: bool,
    /// In a folder: also write the local feature size (lfs.npy) and which points a thinning to this share of it keeps
    /// (decimate_lfs.npy)
    #[arg(long, value_name = "EPSILON", help_heading = "Result", value_parser = above_zero::<f32>, allow_negative_numbers = true)]
    pub(crate) simplify: Option<f32>,
    /// Side of the cells that thinning counts points in, in metres
    #[arg(long, value_name = "M", default_value_t = 0.5, requires = "simplify", help_heading = "Result",
        value_parser = above_zero::<f32>, allow_negative_numbers = true)]
    pub(crate) cell_size: f32,
}

#[derive(Args)]
pub(crate) struct DepthMap {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) view: ViewChoice,
    /// Depth in metres from the picture plane, or from --eye along the axis of its camera, or straight from the place of a --panorama,
    /// as .tif or .npy (rows from the top; nothing hit: nodata -9999 in .tif, infinity in .npy), or a picture with a legend as
    /// .png. A .tif of a view straight down lies on the map. A panorama has a column for each azimuth, north in the middle
    /// and east right of it, and a row for each elevation from the zenith to the nadir
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also write which ball each pixel shows (.tif or .npy): its row in the ball file, counted from 0, or in the one that
    /// `belvedere balls` writes from the same cloud with the same flags; 4294967295 where none
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) balls_id: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct Query {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) view: ViewChoice,
    #[command(flatten)]
    pub(crate) targets: Targets,
    #[command(flatten)]
    pub(crate) mesh: MeshTargets,
    /// Metres a target may lie behind the depth of its pixel, or, with carved balls and from an eye, inside a ball along its line of
    /// sight, and still count as visible [default: what noise and half a pixel are deep on a slope of 63 degrees, 0.58 at
    /// pixels of 0.25 m and 0.22 from an eye; 0 with --profile paper-cone and with carved balls]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = finite, help_heading = "Result")]
    pub(crate) bias: Option<f32>,
    /// Metres that carved balls give way to targets near their surface, since balls bulge between the points of walls and roofs; 0
    /// for targets that do not lie on surfaces [default: 0.2]
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length, help_heading = "Result")]
    pub(crate) shell: Option<f32>,
    /// What to make of targets that nothing blocks, but of whose line of sight more than half a metre runs through space that no
    /// pulse came near to; needs carved balls with their pulses (from a cloud, or from an .npz) [default: report]
    #[arg(long, value_enum, help_heading = "Result")]
    pub(crate) unproven: Option<UnprovenChoice>,
    /// Targets with a column `answer` (.csv .xyz .txt .laz .las .ply), or the answers alone (.npy, u8); one row per target
    /// in their order
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
}

#[derive(Args)]
pub(crate) struct CloudInput {
    /// Point clouds (.las .laz .copc.laz .ply .xyz .txt .csv .pcd .e57 .ptx .npy): several files, or a folder, make one cloud; a
    /// folder with coords.npy is masbcpp's
    #[arg(value_name = "CLOUD", required = true)]
    pub(crate) clouds: Vec<PathBuf>,
    /// Reference system in place of the file's, as EPSG:CODE or WKT
    #[arg(long, value_name = "CRS", value_parser = known_crs)]
    pub(crate) crs: Option<String>,
}

#[derive(Args)]
#[command(next_help_heading = "Cleaning")]
pub(crate) struct Cleaning {
    /// Keep noise (classes 7 and 18) and withheld points
    #[arg(long)]
    pub(crate) keep_noise: bool,
    /// Keep points at or within a millimetre of another
    #[arg(long)]
    pub(crate) keep_duplicates: bool,
    /// Keep points that are alone
    #[arg(long)]
    pub(crate) keep_isolated: bool,
}

#[derive(Args)]
#[command(next_help_heading = "Normals")]
pub(crate) struct Orienting {
    /// Neighbours that make a normal, 3 to 256, or `adaptive` (the paper: 6, masbcpp: 10)
    #[arg(long, value_name = "K", default_value = "16", allow_negative_numbers = true)]
    pub(crate) neighbors: NeighborChoice,
    /// How normals know what is outside: auto (the file's normals, else its scanner positions, else up; `normals` always
    /// estimates anew), given, up,
    /// scanner (from the file), scanner=X,Y,Z, trajectory=FILE (.csv .txt .sbet), pulses (where the scanner was follows from
    /// pulses with several returns), mesh=FILE (.obj .ply .json)
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub(crate) orient: OrientChoice,
}

fn rule(name: &str) -> Result<Rule, String> {
    Rule::ALL
        .into_iter()
        .find(|rule| rule.name() == name)
        .ok_or_else(|| format!("there is no such rule; there are {}", Rule::ALL.map(Rule::name).join(", ")))
}

#[derive(Args)]
#[command(next_help_heading = "Balls")]
pub(crate) struct Shrinking {
    /// carved: neither a point nor a pulse on its way lies deeper in a ball than --penetration; tau: no point does, and balls are
    /// cut to half a metre; angles: the paper's (masbcpp's) heuristics [default: carved, but tau where pulses cannot carve
    /// (scans from the ground) and with --side exterior, angles when a folder is written]
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodChoice>,
    /// What crowns of trees are for carved balls: solid (in leaf), twigs (in winter), or as the pulses found each
    #[arg(long, value_enum, value_name = "TREES")]
    pub(crate) trees: Option<TreesChoice>,
    /// Rules of carved balls to leave out, for research; docs/methods/carving.md says what each does
    #[arg(long, value_name = "RULE,...", value_delimiter = ',', value_parser = rule)]
    pub(crate) without: Vec<Rule>,
    /// Radius balls start with, in metres [default: 30 for tau, 5 for carved, 200 for angles]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) initial_radius: Option<f32>,
    /// Most radius a ball is left with, in metres [default: 0.5 for tau, otherwise no limit]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) max_radius: Option<f32>,
    /// Depth to which a point or a pulse may enter a ball, in metres [default: 0.05 for tau, 0.02 for carved]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) penetration: Option<f32>,
    /// The paper's t_a in degrees [default: 32]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) first_angle: Option<f64>,
    /// The paper's t_b in degrees [default: 20]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) next_angle: Option<f64>,
}

/// A cloud to make balls from, or a ball file.
#[derive(Args)]
pub(crate) struct SceneInput {
    #[command(flatten)]
    pub(crate) input: CloudInput,
    #[command(flatten)]
    pub(crate) cleaning: Cleaning,
    #[command(flatten)]
    pub(crate) orienting: Orienting,
    #[command(flatten)]
    pub(crate) shrinking: Shrinking,
    /// Surface that stands for a ball: the sphere, or the cone of the paper's Algorithm 1
    #[arg(long, value_enum, default_value_t = ProfileChoice::Sphere, help_heading = "Balls")]
    pub(crate) profile: ProfileChoice,
}

#[derive(Args)]
#[command(next_help_heading = "Targets (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct Targets {
    /// Points from a file of any cloud format, in the coordinates of the scene's file; a table needs columns x, y and z
    #[arg(long, value_name = "FILE")]
    pub(crate) targets: Option<PathBuf>,
    /// Points spread evenly at random over the bounding box of the cloud, up to 1000000000; other --seed, other points
    #[arg(long, value_name = "N", value_parser = target_count)]
    pub(crate) random: Option<usize>,
    /// The points of the cloud themselves, all of them and in their order
    #[arg(long = "self")]
    pub(crate) own: bool,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum SideChoice {
    /// Inside the scene: these block lines of sight
    Interior,
    /// In free space
    Exterior,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TreesChoice {
    /// Solid down to the lowest return
    Opaque,
    /// Twigs with gaps between them
    Porous,
    /// Each piece by the share of pulses that got through it [the default]
    Measured,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum MethodChoice {
    /// Bounded penetration
    Tau,
    /// Bounded penetration by points and by the pulses that passed
    Carved,
    /// The paper's separation angles
    Angles,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum UnprovenChoice {
    /// An answer of its own: 2
    Report,
    /// Visible: 1
    AsVisible,
    /// Blocked: 0
    AsBlocked,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum ProfileChoice {
    /// The sphere itself
    Sphere,
    /// The paper's Algorithm 1 to the letter
    PaperCone,
}

#[derive(Clone, Copy)]
pub(crate) enum NeighborChoice {
    Fixed(usize),
    Adaptive,
}

impl FromStr for NeighborChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "adaptive" => Ok(Self::Adaptive),
            _ => text.parse().map(Self::Fixed).map_err(|_| "not a number of neighbours or `adaptive`".to_owned()),
        }
    }
}

#[derive(Clone)]
pub(crate) enum OrientChoice {
    Auto,
    Given,
    Up,
    Scanner,
    ScannerAt([f64; 3]),
    Trajectory(PathBuf),
    Pulses,
    Mesh(PathBuf),
}

impl FromStr for OrientChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            None => match text {
                "auto" => Ok(Self::Auto),
                "given" => Ok(Self::Given),
                "up" => Ok(Self::Up),
                "scanner" => Ok(Self::Scanner),
                "pulses" => Ok(Self::Pulses),
                _ => {
                    Err("use auto, given, up, scanner, scanner=X,Y,Z, trajectory=FILE, pulses or mesh=FILE".to_owned())
                }
            },
            Some(("scanner", position)) => Ok(Self::ScannerAt(position.parse::<Numbers<3>>()?.0)),
            Some(("trajectory", file)) => Ok(Self::Trajectory(file.into())),
            Some(("mesh", file)) => Ok(Self::Mesh(file.into())),
            Some(_) => Err("use scanner=X,Y,Z, trajectory=FILE or mesh=FILE".to_owned()),
        }
    }
}

fn known_crs(text: &str) -> Result<String, String> {
    Crs::parse(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("must be a whole number of at least 1".to_owned()),
        Ok(count) => Ok(count),
    }
}

/// More targets than this fill the memory of most machines, so that a slipped digit is an error and not a crash.
const MOST_TARGETS: usize = 1_000_000_000;

fn target_count(text: &str) -> Result<usize, String> {
    at_least_one(text)
        .ok()
        .filter(|&count| count <= MOST_TARGETS)
        .ok_or_else(|| format!("must be a whole number from 1 to {MOST_TARGETS}"))
}

fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "must be a finite number".to_owned())
}

fn length(text: &str) -> Result<f32, String> {
    finite(text)?;
    text.parse().ok().filter(|v: &f32| *v >= 0.0).ok_or_else(|| "must be a number of metres, 0 or more".to_owned())
}

fn above_zero<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    text.parse()
        .ok()
        .filter(|&v: &T| v.into() > 0.0 && v.into().is_finite())
        .ok_or_else(|| "must be a number above zero".to_owned())
}

/// Numbers separated by commas.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<const N: usize>(pub(crate) [f64; N]);

impl<const N: usize> FromStr for Numbers<N> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map(|part| part.trim().parse().map_err(|_| format!("{part:?} is not a number")))
            .collect::<Result<_, _>>()?;
        if let Some(bad) = numbers.iter().find(|v| !v.is_finite()) {
            return Err(format!("{bad} is not finite"));
        }
        numbers.try_into().map(Self).map_err(|_| format!("expected {N} numbers separated by commas"))
    }
}

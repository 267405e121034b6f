//! Command-line arguments: flags as entered. `pipeline` and each command convert them. Texts longer than a line are in
//! `help/`.

mod ask;
mod balls;
mod cameras;
mod city;
mod difference;
mod envelope;
mod fetch;
mod glare;
mod heat;
mod irradiance;
mod numbers;
mod observers;
mod query;
mod scene;
mod shadow;
mod sky;
mod sun;
mod sunlight;
mod surroundings;
mod survey_plan;
mod towers;
mod towns;
mod vegetation;
mod view;
#[cfg(feature = "view")]
mod view_page;
mod window_views;

pub(crate) use ask::AskArguments;
pub(crate) use balls::{
    BallsArguments, Cleaning, MethodChoice, NeighborChoice, NormalsArguments, OrientedPoints, Orienting, Shrinking,
    SideChoice, SurfacesArguments,
};
pub(crate) use cameras::{CameraLensArguments, CameraTargetsArguments, CamerasArguments};
pub(crate) use city::{CellFor, City, CityMerge, CityPlan, CityRun, CityStatus, CityStep, CityTaskStep, CityTasks};
pub(crate) use difference::DifferenceArguments;
pub(crate) use envelope::{ComfortArguments, CornersArgument, EnvelopeArguments};
pub(crate) use fetch::FetchArguments;
pub(crate) use glare::GlareArguments;
pub(crate) use heat::HeatArguments;
pub(crate) use irradiance::{ClearSkyChoice, IrradianceArguments, PvArguments, RadiationModel};
pub(crate) use numbers::{Numbers, Rectangle};
pub(crate) use numbers::{above_zero, at_least_one, at_most, finite, height, known_crs, length, location, rectangle};
pub(crate) use observers::{
    Earth, GivingWay, GroundChoice, HowSureArguments, IntervalArgument, LineOfSightArguments, LinesArguments,
    MapPosition, Radio, Shell, UnprovenChoice, ViewshedArguments,
};
pub(crate) use query::{DepthMapArguments, Query};
pub(crate) use scene::{
    AreaChoice, BallShape, CalibrateArguments, CloudInput, MemoryAmount, MemoryArgument, OrientChoice, PlanArguments,
    ProfileChoice, SceneBalls, SceneConfig, SceneInput, TilesArguments, UpChoice,
};
pub(crate) use shadow::ShadowArguments;
pub(crate) use sky::{
    AreaOutputs, FacingChoice, FarTerrainArguments, PatchesChoice, SkyOutputs, SkyPlaces, SkyViewArguments,
};
pub(crate) use sun::{ElevationChoice, SunHoursArguments, SunPeriod, SunPlaceArguments, SunPositionArguments};
pub(crate) use sunlight::{ReportArguments, SunCalendarArguments};
pub(crate) use surroundings::{
    BelowChoice, EyesArguments, HorizonArguments, IsovistArguments, LandmarkArguments, LandmarkShapeArguments,
    MeshTargets, ProtectedViewArguments,
};
pub(crate) use survey_plan::SurveyPlanArguments;
pub(crate) use towers::TowersArguments;
pub(crate) use towns::{PatternChoice, ScannerChoice, Simulate};
pub(crate) use vegetation::{LeavesChoice, ThroughTreesArguments, ThroughTreesChoice};
pub(crate) use view::{NorthArguments, SizeChoice, ViewChoice};
#[cfg(feature = "view")]
pub(crate) use view_page::ViewPage;
pub(crate) use window_views::WindowViewsArguments;

use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Wrong usage that only shows once arguments are combined: exit status 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Refuses what was typed.
pub(crate) fn refuse<T>(what: impl Into<String>) -> anyhow::Result<T> {
    Err(Usage(what.into()).into())
}

/// Refuses the first of `flags` that was given; `why` follows its name.
pub(crate) fn refuse_given(flags: &[(&str, bool)], why: &str) -> anyhow::Result<()> {
    match flags.iter().find(|(_, is_given)| *is_given) {
        Some((flag, _)) => refuse(format!("{flag} {why}")),
        None => Ok(()),
    }
}

/// Visibility analysis directly on point clouds
#[derive(Parser)]
#[command(
    name = "belvedere",
    version,
    max_term_width = 110,
    arg_required_else_help = true,
    propagate_version = true,
    disable_help_flag = true,
    disable_version_flag = true
)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) global: Global,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// Most threads.
pub(crate) const MAX_THREADS: usize = 1024;

#[derive(Args)]
#[command(next_help_heading = "Global options")]
pub(crate) struct Global {
    /// Number of threads, at most 1024; it does not change results [default: all processors]
    #[arg(long, global = true, value_name = "N", value_parser = at_most::<MAX_THREADS>)]
    pub(crate) threads: Option<usize>,
    /// What tests many lines of sight and draws depth maps; it does not change answers: auto, cpu, gpu, or the number
    /// of a device
    #[arg(long, global = true, value_name = "DEVICE", default_value = "auto", allow_negative_numbers = true)]
    pub(crate) device: DeviceChoice,
    /// Seed of the random numbers
    #[arg(long, global = true, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Folder where scenes are kept for the next command [default: the user's folder for such files]
    #[arg(long, global = true, value_name = "DIR", conflicts_with = "no_cache")]
    pub(crate) cache: Option<PathBuf>,
    /// Build scenes anew, and keep none
    #[arg(long, global = true)]
    pub(crate) no_cache: bool,
    /// Print the summary as one JSON object on standard output
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// How progress is shown on standard error
    #[arg(long, global = true, value_enum, value_name = "HOW", default_value_t = ProgressChoice::Bar)]
    pub(crate) progress: ProgressChoice,
    /// Print all figures, and the duration of each stage on standard error
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Print help: the usual flags with -h, all of them and what they mean with --help
    #[arg(short, long, global = true, action = ArgAction::Help)]
    help: Option<bool>,
    /// Print the version
    #[arg(short = 'V', long, global = true, action = ArgAction::Version)]
    version: Option<bool>,
    /// Print only errors
    #[arg(long, global = true, conflicts_with_all = ["verbose", "json"])]
    pub(crate) quiet: bool,
    /// The command as it was typed, for files.
    #[arg(skip)]
    pub(crate) command: String,
}

/// Device for tests of many directions at many places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DeviceChoice {
    Automatic,
    Cpu,
    Gpu,
    Number(usize),
}

impl std::str::FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Automatic),
            "cpu" => Ok(Self::Cpu),
            "gpu" => Ok(Self::Gpu),
            number => number.parse().map(Self::Number).map_err(|_| {
                let numbers = ", or the number of a device as `belvedere info` lists them";
                let is_of_gpu = cfg!(feature = "gpu");
                let known = if is_of_gpu { ["auto, cpu, gpu", numbers].concat() } else { "auto or cpu".to_owned() };
                format!("give {known}")
            }),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressChoice {
    /// A bar, if standard error is a terminal
    Bar,
    /// Lines of JSON for each stage: stage, done, total (null if unknown), seconds, finished
    Json,
    /// Nothing
    None,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Simulate a small town and its laser scan, and run the main commands on it
    Demo(Demo),
    /// Simulate a town and its laser scan, with the exact mesh as ground truth
    Simulate(Simulate),
    /// Find the open surveys of a place, and take their points
    Fetch(FetchArguments),
    /// Report what a point cloud contains, what it lacks, and which commands can use it
    Info(Info),
    /// Estimate the scanner positions from the pulses of a cloud
    Trajectory(TrajectoryArguments),
    /// Estimate normals and orient them outward
    Normals(NormalsArguments),
    /// Find roofs, their edges and ridges, and walls, with how well each is known
    Surfaces(SurfacesArguments),
    /// Build the medial balls of a scene and save them for other commands
    Balls(BallsArguments),
    /// Measure how reliable answers on a survey are, with pulses kept out
    Calibrate(CalibrateArguments),
    /// List the scenes that are kept for the next command, or remove them
    Cache(CacheArguments),
    /// Measure how long each stage takes on this machine
    Bench(BenchArguments),
    /// Compute a depth map: the distance to the first surface for each pixel of a view
    #[command(name = "depth-map")]
    DepthMap(DepthMapArguments),
    /// Classify targets as visible or blocked from the sun, a direction or a camera
    Query(Query),
    /// Test lines of sight between pairs of points, and report the first obstacle
    #[command(name = "line-of-sight")]
    LineOfSight(LineOfSightArguments),
    /// Map what observers see, or from where a target is seen
    Viewshed(ViewshedArguments),
    /// Measure how many metres of wind turbines and masts are visible
    Towers(TowersArguments),
    /// Measure how much of a landmark observers see
    Landmark(LandmarkArguments),
    /// Map how high one may build without entering the view of a landmark
    #[command(name = "protected-view")]
    ProtectedView(ProtectedViewArguments),
    /// Choose where to put cameras, so that few of them cover much
    Cameras(CamerasArguments),
    /// Choose where to scan again, so that unproven lines of sight become proven
    #[command(name = "survey-plan")]
    SurveyPlan(SurveyPlanArguments),
    /// Measure the space that is visible from a point: volume, area, openness
    Isovist(IsovistArguments),
    /// Compute the horizon elevation angle in each direction around a point
    Horizon(HorizonArguments),
    /// Map shadows at an instant, for a given sun direction, or through a day
    Shadow(ShadowArguments),
    /// Compute the sky view factor and the sky openness
    #[command(name = "sky-view")]
    SkyView(SkyViewArguments),
    /// Compute yearly solar irradiation and shading loss, also for each roof plane
    Irradiance(IrradianceArguments),
    /// Compute when panels and glass reflect the sun to observers
    Glare(GlareArguments),
    /// Compute heat stress of people from weather: UTCI and mean radiant temperature
    Heat(HeatArguments),
    /// Compute the hours of direct sun on a day, over a period, or for a daylight rule
    #[command(name = "sun-hours")]
    SunHours(SunHoursArguments),
    /// Compute where the sun stands at given times
    #[command(name = "sun-position")]
    SunPosition(SunPositionArguments),
    /// Compute the largest volume on a parcel that casts no shadow on its neighbours
    Envelope(EnvelopeArguments),
    /// Write a sunlight report for windows and gardens, before and after a plan
    Report(ReportArguments),
    /// List from when to when the sun shines at windows and places, and what shades them
    #[command(name = "sun-calendar")]
    SunCalendar(SunCalendarArguments),
    /// Measure sun, shade and sky along walking routes and at windows
    Comfort(ComfortArguments),
    /// Measure what is seen from windows: sky, vegetation, water, buildings, ground
    #[command(name = "window-views")]
    WindowViews(WindowViewsArguments),
    /// Compute what changes between two rasters: gains and losses before and after a plan
    Difference(DifferenceArguments),
    /// Show clouds in the browser, and ask there what is seen, lit and shaded
    #[cfg(feature = "view")]
    View(ViewPage),
    /// Map shadow and sky view of a whole city, tile by tile
    City(City),
    /// Ask a question in JSON, or that of a raster, with the answer as JSON or files
    Ask(AskArguments),
    /// List all commands with their parameters, types, defaults and texts
    Describe(DescribeArguments),
    /// Print a completion script for a shell
    Completions {
        /// Shell to complete for
        shell: clap_complete::Shell,
    },
    /// Print the manual page
    Man,
}

#[derive(Args)]
pub(crate) struct Demo {
    /// Folder for the results; created if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "demo")]
    pub(crate) output: PathBuf,
    /// Side of the simulated town in metres
    #[arg(long, value_name = "M", default_value_t = 120.0)]
    pub(crate) extent: f64,
}

#[derive(Args)]
pub(crate) struct DescribeArguments {
    /// Print the JSON schema of the questions of `belvedere ask` instead
    ///
    /// Draft 2020-12, with the text, unit and default of each field.
    #[arg(long)]
    pub(crate) json_schema: bool,
}

#[derive(Args)]
pub(crate) struct CacheArguments {
    /// Remove all of them
    #[arg(long)]
    pub(crate) clear: bool,
}

#[derive(Args)]
pub(crate) struct BenchArguments {
    /// Point cloud to measure with [default: a simulated town]
    #[arg(value_name = "CLOUD")]
    pub(crate) cloud: Option<PathBuf>,
    /// Side of the simulated town in metres, 60 to 2000
    #[arg(long, value_name = "M", default_value_t = 300, value_parser = clap::value_parser!(u32).range(60..=2000), conflicts_with = "cloud")]
    pub(crate) extent: u32,
    /// Flags of belvedere shadow that the cloud needs
    #[arg(last = true, value_name = "FLAGS", requires = "cloud")]
    pub(crate) flags: Vec<OsString>,
}

#[derive(Args)]
pub(crate) struct Info {
    #[command(flatten)]
    pub(crate) input: CloudInput,
}

#[derive(Args)]
pub(crate) struct TrajectoryArguments {
    /// Time between two positions in seconds, 0.01 to 2
    #[arg(
        long = "time-step-s",
        value_name = "S",
        default_value_t = 0.5,
        help_heading = "Result",
        allow_negative_numbers = true
    )]
    pub(crate) step: f64,
    /// Table of scanner positions (.csv .txt)
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) input: CloudInput,
}

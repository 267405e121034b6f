//! Flags of `simulate`, and what towns are given by.

use belvedere_scenes::{EXTENT, PointOrder, Preset};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Simulate {
    /// Type of town
    #[arg(value_name = "SCENE", default_value = "town", value_parser = presets())]
    pub(crate) scene: Preset,
    /// Folder for cloud, trajectory and meshes; created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Side of the town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = EXTENT, value_parser = parse_within::<60, 5000>, allow_negative_numbers = true)]
    pub(crate) extent: f64,
    /// Type of laser scanner
    #[arg(long, value_enum, default_value_t = ScannerChoice::Airborne)]
    pub(crate) scanner: ScannerChoice,
    /// Order of the points in the cloud
    ///
    /// flight: as they were measured. squares: in squares of 20 m, row by row, as tiles are delivered. shuffled: at
    /// random.
    #[arg(long, value_name = "ORDER", default_value = "flight", value_parser = orders())]
    pub(crate) order: PointOrder,
    #[command(flatten)]
    pub(crate) airborne: AirborneFlags,
    #[command(flatten)]
    pub(crate) terrestrial: TerrestrialFlags,
    #[command(flatten)]
    pub(crate) pulses: PulseFlags,
}

#[derive(Args)]
#[command(next_help_heading = "Airborne scanner")]
pub(crate) struct AirborneFlags {
    /// Scan pattern on the ground [default: rotating]
    #[arg(long, value_enum)]
    pub(crate) pattern: Option<PatternChoice>,
    /// Pulses per square metre of ground, all strips together, 0.1 to 200 [default: 10]
    #[arg(long, value_name = "PULSES_PER_M2", value_parser = density, allow_negative_numbers = true)]
    pub(crate) density: Option<f64>,
    /// Flying height above ground in metres, 50 to 5000 [default: 450]
    #[arg(long, value_name = "M", value_parser = parse_within::<50, 5000>, allow_negative_numbers = true)]
    pub(crate) flying_height: Option<f64>,
    /// Speed over ground in metres per second, 10 to 150 [default: 60]
    #[arg(long, value_name = "M_PER_S", value_parser = parse_within::<10, 150>, allow_negative_numbers = true)]
    pub(crate) speed: Option<f64>,
    /// Maximum scan angle from nadir in degrees, 1 to 60 [default: 25; conical: a constant 20]
    #[arg(long, value_name = "DEG", value_parser = parse_within::<1, 60>, allow_negative_numbers = true)]
    pub(crate) scan_angle: Option<f64>,
    /// Number of parallel flight strips [default: enough to see every place from both sides]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) strips: Option<u16>,
    /// Number of additional strips at right angles [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=1000))]
    pub(crate) cross_strips: Option<u16>,
}

#[derive(Args)]
#[command(next_help_heading = "Terrestrial scanner")]
pub(crate) struct TerrestrialFlags {
    /// Number of scanner positions, chosen on open ground far from each other [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) stations: Option<u16>,
    /// Angle between two pulses in degrees, 0.01 to 5 [default: 0.25]
    #[arg(long = "angle-step-deg", value_name = "DEG", value_parser = angular_step, allow_negative_numbers = true)]
    pub(crate) angular_step: Option<f64>,
    /// Maximum range in metres, 1 to 5000 [default: 120]
    #[arg(long, value_name = "M", value_parser = parse_within::<1, 5000>, allow_negative_numbers = true)]
    pub(crate) max_range: Option<f64>,
    /// Write scans.ptx too: a grid for each scanner position, with the pulses that returned nothing
    ///
    /// A cell for each pulse holds its first return, or zeros. Only such a file tells which pulses met nothing.
    #[arg(long)]
    pub(crate) ptx: bool,
}

#[derive(Args)]
#[command(next_help_heading = "Pulses")]
pub(crate) struct PulseFlags {
    /// Standard deviation of ranges in metres, 0 to 1 [default: 0.02; terrestrial: 0.005]
    #[arg(long, value_name = "M", value_parser = parse_within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) noise: Option<f64>,
    /// Share of pulses that get lost, 0 to 1 [default: 0.01]
    #[arg(long, value_name = "SHARE", value_parser = parse_within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) dropout: Option<f64>,
    /// Full beam divergence in milliradians, 0 to 10 [default: 0.4; terrestrial: 0.3]
    #[arg(long, value_name = "MRAD", value_parser = parse_within::<0, 10>, allow_negative_numbers = true)]
    pub(crate) divergence: Option<f64>,
    /// Mean depth of pulses in tree crowns in metres, 0 to 100 [default: 1.5]
    ///
    /// With 0 all points lie on the mesh.
    #[arg(long, value_name = "M", value_parser = parse_within::<0, 100>, allow_negative_numbers = true)]
    pub(crate) foliage_depth: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum ScannerChoice {
    /// On an aircraft, in strips
    Airborne,
    /// On a tripod, at several positions
    Terrestrial,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum PatternChoice {
    /// Parallel lines of a rotating mirror
    Rotating,
    /// Zigzag of an oscillating mirror, denser at the edges of a strip
    Oscillating,
    /// Circles: every place is seen from two directions
    Conical,
}

/// Presets by their names.
fn presets() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).map(|name| {
        // the parser lets no other name through
        Preset::ALL.into_iter().find(|preset| preset.name() == name).unwrap_or(Preset::Town)
    })
}

/// Orders of points by their names.
fn orders() -> impl TypedValueParser<Value = PointOrder> {
    PossibleValuesParser::new(PointOrder::ALL.map(PointOrder::name)).map(|name| {
        // the parser lets no other name through
        PointOrder::ALL.into_iter().find(|order| order.name() == name).unwrap_or_default()
    })
}

/// A number from `LOW` to `HIGH`, both included.
fn parse_within<const LOW: u16, const HIGH: u16>(text: &str) -> Result<f64, String> {
    parse_between(text, f64::from(LOW), f64::from(HIGH))
}

fn density(text: &str) -> Result<f64, String> {
    parse_between(text, 0.1, 200.0)
}

fn angular_step(text: &str) -> Result<f64, String> {
    parse_between(text, 0.01, 5.0)
}

fn parse_between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (low..=high).contains(v))
        .ok_or_else(|| format!("must be a number from {low} to {high}"))
}

//! Flags of the commands that make towns: `simulate` and `compare`.

use super::{Usage, target_count};
use belvedere_baselines::methods::Listing;
use belvedere_scenes::Preset;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub(crate) struct Simulate {
    /// Kind of town
    #[arg(value_name = "SCENE", default_value = "town", value_parser = presets())]
    pub(crate) scene: Preset,
    /// Folder for cloud, trajectory and meshes; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Side of the town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = 150.0, value_parser = within::<60, 5000>, allow_negative_numbers = true)]
    pub(crate) extent: f64,
    /// What scans
    #[arg(long, value_enum, default_value_t = ScannerChoice::Airborne)]
    pub(crate) scanner: ScannerChoice,
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
    /// Path of the pulses over the ground [default: rotating]
    #[arg(long, value_enum)]
    pub(crate) pattern: Option<PatternChoice>,
    /// Pulses per square metre of ground, all strips together, 0.1 to 200 [default: 10]
    #[arg(long, value_name = "PULSES_PER_M2", value_parser = density, allow_negative_numbers = true)]
    pub(crate) density: Option<f64>,
    /// Height above ground in metres, 50 to 5000 [default: 450]
    #[arg(long, value_name = "M", value_parser = within::<50, 5000>, allow_negative_numbers = true)]
    pub(crate) flying_height: Option<f64>,
    /// Speed over ground in metres per second, 10 to 150 [default: 60]
    #[arg(long, value_name = "M_PER_S", value_parser = within::<10, 150>, allow_negative_numbers = true)]
    pub(crate) speed: Option<f64>,
    /// Greatest angle from nadir in degrees, 1 to 60 [default: 25; conical: 20, all round]
    #[arg(long, value_name = "DEG", value_parser = within::<1, 60>, allow_negative_numbers = true)]
    pub(crate) scan_angle: Option<f64>,
    /// Parallel strips, spread over the town [default: as many as let every place be seen from both sides]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) strips: Option<u16>,
    /// Further strips at right angles to the others [default: 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=1000))]
    pub(crate) cross_strips: Option<u16>,
}

#[derive(Args)]
#[command(next_help_heading = "Terrestrial scanner")]
pub(crate) struct TerrestrialFlags {
    /// Tripod positions, chosen on open ground far from each other [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) stations: Option<u16>,
    /// Angle between pulses in degrees, 0.01 to 5 [default: 0.25]
    #[arg(long, value_name = "DEG", value_parser = angular_step, allow_negative_numbers = true)]
    pub(crate) angular_step: Option<f64>,
    /// Farthest point in metres, 1 to 5000 [default: 120]
    #[arg(long, value_name = "M", value_parser = within::<1, 5000>, allow_negative_numbers = true)]
    pub(crate) max_range: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Pulses")]
pub(crate) struct PulseFlags {
    /// Standard deviation of a range in metres, 0 to 1 [default: 0.02; terrestrial: 0.005]
    #[arg(long, value_name = "M", value_parser = within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) noise: Option<f64>,
    /// Share of the pulses that get lost, 0 to 1 [default: 0.01]
    #[arg(long, value_name = "SHARE", value_parser = within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) dropout: Option<f64>,
    /// Full width of a pulse in milliradians, 0 to 10 [default: 0.4; terrestrial: 0.3]
    #[arg(long, value_name = "MRAD", value_parser = within::<0, 10>, allow_negative_numbers = true)]
    pub(crate) divergence: Option<f64>,
    /// How deep pulses get into crowns, on the mean, in metres, 0 to 100; with 0 all points lie on the mesh [default: 1.5]
    #[arg(long, value_name = "M", value_parser = within::<0, 100>, allow_negative_numbers = true)]
    pub(crate) foliage_depth: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum ScannerChoice {
    /// From an aircraft, in strips
    Airborne,
    /// From a tripod, at several places
    Terrestrial,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub(crate) enum PatternChoice {
    /// Parallel lines of a rotating mirror
    Rotating,
    /// Zig-zag of an oscillating mirror, denser at the edges of a strip
    Oscillating,
    /// Circles: every place is seen from ahead and from behind
    Conical,
}

#[derive(Args)]
pub(crate) struct Compare {
    /// Kinds of simulated towns, separated by commas [default: town]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = presets(),
        help_heading = "Simulated places")]
    pub(crate) presets: Vec<Preset>,
    /// Seeds of the towns and their scans
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1", help_heading = "Simulated places")]
    pub(crate) seeds: Vec<u64>,
    /// Side of a town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = 150.0, value_parser = within::<60, 5000>, help_heading = "Simulated places")]
    pub(crate) extent: f64,
    /// Pulses per m², all flight strips together, 0.1 to 200
    #[arg(long, value_name = "N", default_value_t = 10.0, value_parser = density, help_heading = "Simulated places")]
    pub(crate) density: f64,
    /// Point clouds of a place of your own, in place of simulated ones
    #[arg(long, value_name = "CLOUD", num_args = 1.., help_heading = "A place of your own")]
    pub(crate) scene: Vec<PathBuf>,
    /// Its exact surface, triangles counter-clockwise seen from outside (.obj .ply .json)
    #[arg(long, value_name = "MESH", requires = "scene", help_heading = "A place of your own")]
    pub(crate) mesh: Option<PathBuf>,
    /// Where the scanner was, for --scene or --held-out (.csv .txt .sbet). Without it normals of --scene are turned upward and its
    /// own points are not asked; for --held-out the scanner is found from pulses with several returns
    #[arg(long, value_name = "FILE", help_heading = "A place of your own")]
    pub(crate) trajectory: Option<PathBuf>,
    /// A city model, or a surface reconstructed elsewhere, to trace as another method; may be repeated
    #[arg(long, value_name = "NAME=MESH", requires = "scene", help_heading = "A place of your own")]
    pub(crate) model: Vec<NamedFile>,
    /// Point clouds, each of which is judged by its own laser pulses: a tenth is kept from the methods, which are then asked
    /// whether the way of each was free and what lies behind it is hidden. Needs GPS times, return numbers and pulses with
    /// several returns
    #[arg(long, value_name = "CLOUD", num_args = 1.., help_heading = "Real clouds")]
    pub(crate) held_out: Vec<PathBuf>,
    /// Only these methods, by the beginnings of their names [default: all but variants, which want their full name]
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Questions")]
    pub(crate) methods: Vec<String>,
    /// Targets of each kind
    #[arg(long, value_name = "N", default_value_t = 50_000, value_parser = target_count, help_heading = "Questions")]
    pub(crate) targets: usize,
    /// Folder for report.html, report.md, results and pictures; made if it is not there
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also put the tables into this Markdown page, between its lines `<!-- tables -->` and `<!-- end of tables -->`
    #[arg(long, value_name = "FILE", help_heading = "Result")]
    pub(crate) page: Option<PathBuf>,
}

impl Compare {
    /// Whether a method was asked for: by a beginning of its key, or, if it runs when named only, by all of it.
    pub(crate) fn wants(&self, key: &str, listing: Listing) -> bool {
        match listing {
            Listing::Always => {
                self.methods.is_empty() || self.methods.iter().any(|start| key.starts_with(start.as_str()))
            }
            Listing::WhenNamed | Listing::OnHeldOutPulses => self.methods.iter().any(|name| name == key),
        }
    }

    /// Refuses names that no method of `keys` begins with.
    pub(crate) fn check_methods(&self, keys: &[String]) -> Result<(), Usage> {
        match self.methods.iter().find(|start| !keys.iter().any(|key| key.starts_with(start.as_str()))) {
            Some(unknown) => {
                let keys = keys.join(", ");
                Err(Usage(format!("--methods: no method begins with {unknown:?}; there are {keys}")))
            }
            None => Ok(()),
        }
    }
}

/// A file under a name of the user's choice.
#[derive(Clone)]
pub(crate) struct NamedFile {
    pub(crate) name: String,
    pub(crate) file: PathBuf,
}

impl FromStr for NamedFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, file) = text.split_once('=').ok_or("use NAME=FILE")?;
        let plain = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
        let named = plain.then(|| Self { name: name.to_owned(), file: file.into() });
        named.ok_or_else(|| "the name may have lower-case letters, digits and hyphens".to_owned())
    }
}

/// Presets by their names.
fn presets() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).map(|name| {
        // the parser lets no other name through
        Preset::ALL.into_iter().find(|preset| preset.name() == name).unwrap_or(Preset::Town)
    })
}

/// A number from `LOW` to `HIGH`, both included.
fn within<const LOW: u16, const HIGH: u16>(text: &str) -> Result<f64, String> {
    between(text, f64::from(LOW), f64::from(HIGH))
}

fn density(text: &str) -> Result<f64, String> {
    between(text, 0.1, 200.0)
}

fn angular_step(text: &str) -> Result<f64, String> {
    between(text, 0.01, 5.0)
}

fn between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (low..=high).contains(v))
        .ok_or_else(|| format!("must be a number from {low} to {high}"))
}

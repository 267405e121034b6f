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
    /// Type of town
    #[arg(value_name = "SCENE", default_value = "town", value_parser = presets())]
    pub(crate) scene: Preset,
    /// Folder for cloud, trajectory and meshes; created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Side of the town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = 150.0, value_parser = within::<60, 5000>, allow_negative_numbers = true)]
    pub(crate) extent: f64,
    /// Type of laser scanner
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
    /// Scan pattern on the ground [default: rotating]
    #[arg(long, value_enum)]
    pub(crate) pattern: Option<PatternChoice>,
    /// Pulses per square metre of ground, all strips together, 0.1 to 200 [default: 10]
    #[arg(long, value_name = "PULSES_PER_M2", value_parser = density, allow_negative_numbers = true)]
    pub(crate) density: Option<f64>,
    /// Flying height above ground in metres, 50 to 5000 [default: 450]
    #[arg(long, value_name = "M", value_parser = within::<50, 5000>, allow_negative_numbers = true)]
    pub(crate) flying_height: Option<f64>,
    /// Speed over ground in metres per second, 10 to 150 [default: 60]
    #[arg(long, value_name = "M_PER_S", value_parser = within::<10, 150>, allow_negative_numbers = true)]
    pub(crate) speed: Option<f64>,
    /// Maximum scan angle from nadir in degrees, 1 to 60 [default: 25; conical: a constant 20]
    #[arg(long, value_name = "DEG", value_parser = within::<1, 60>, allow_negative_numbers = true)]
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
    #[arg(long, value_name = "M", value_parser = within::<1, 5000>, allow_negative_numbers = true)]
    pub(crate) max_range: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Pulses")]
pub(crate) struct PulseFlags {
    /// Standard deviation of ranges in metres, 0 to 1 [default: 0.02; terrestrial: 0.005]
    #[arg(long, value_name = "M", value_parser = within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) noise: Option<f64>,
    /// Share of pulses that get lost, 0 to 1 [default: 0.01]
    #[arg(long, value_name = "SHARE", value_parser = within::<0, 1>, allow_negative_numbers = true)]
    pub(crate) dropout: Option<f64>,
    /// Full beam divergence in milliradians, 0 to 10 [default: 0.4; terrestrial: 0.3]
    #[arg(long, value_name = "MRAD", value_parser = within::<0, 10>, allow_negative_numbers = true)]
    pub(crate) divergence: Option<f64>,
    /// Mean depth of pulses in tree crowns in metres, 0 to 100 [default: 1.5]
    ///
    /// With 0 all points lie on the mesh.
    #[arg(long, value_name = "M", value_parser = within::<0, 100>, allow_negative_numbers = true)]
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

#[derive(Args)]
pub(crate) struct Compare {
    /// Types of simulated towns, separated by commas [default: town]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = presets(),
        help_heading = "Simulated towns")]
    pub(crate) presets: Vec<Preset>,
    /// Seeds of the towns and their scans, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1", help_heading = "Simulated towns")]
    pub(crate) seeds: Vec<u64>,
    /// Side of a town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = 150.0, value_parser = within::<60, 5000>, help_heading = "Simulated towns")]
    pub(crate) extent: f64,
    /// Pulses per square metre, all strips together, 0.1 to 200
    #[arg(long, value_name = "N", default_value_t = 10.0, value_parser = density, help_heading = "Simulated towns")]
    pub(crate) density: f64,
    /// Point clouds of a real place, instead of simulated towns; needs --mesh
    #[arg(long = "clouds", value_name = "CLOUD", num_args = 1.., help_heading = "Real place with ground truth")]
    pub(crate) scene: Vec<PathBuf>,
    /// Exact surface of the real place, as ground truth (.obj .ply .json)
    ///
    /// Triangles are counter-clockwise seen from outside.
    #[arg(long, value_name = "MESH", requires = "scene", help_heading = "Real place with ground truth")]
    pub(crate) mesh: Option<PathBuf>,
    /// Scanner positions for --clouds or --held-out (.csv .txt .sbet)
    ///
    /// Without it, normals of --clouds are oriented upward and their own points are not queried. For --held-out, scanner positions are estimated
    /// from pulses with several returns.
    #[arg(long, value_name = "FILE", help_heading = "Real place with ground truth")]
    pub(crate) trajectory: Option<PathBuf>,
    /// City model or reconstructed surface that is compared as another method; repeatable
    #[arg(long, value_name = "NAME=MESH", requires = "scene", help_heading = "Real place with ground truth")]
    pub(crate) model: Vec<NamedFile>,
    /// Point clouds that are tested with their own laser pulses
    ///
    /// A tenth of the pulses is kept from the methods. The path of each such pulse was free, and what lies behind its return is hidden; the
    /// methods must answer both. Needs GPS times, return numbers and pulses with several returns.
    #[arg(long, value_name = "CLOUD", num_args = 1.., help_heading = "Real clouds without ground truth")]
    pub(crate) held_out: Vec<PathBuf>,
    /// Methods to compare, by the start of their names [default: all except variants, which need their full names]
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Methods and targets")]
    pub(crate) methods: Vec<String>,
    /// Number of targets of each type
    #[arg(long = "target-count", value_name = "N", default_value_t = 50_000, value_parser = target_count, help_heading = "Methods and targets")]
    pub(crate) targets: usize,
    /// Folder for report.html, report.md, results and pictures; created if it does not exist
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also insert the tables into this Markdown file
    ///
    /// The tables go between the lines `<!-- tables -->` and `<!-- end of tables -->`.
    #[arg(long, value_name = "FILE", help_heading = "Result")]
    pub(crate) page: Option<PathBuf>,
}

impl Compare {
    /// Whether a method is selected: by the start of its key, or by its whole key if it runs only when named.
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

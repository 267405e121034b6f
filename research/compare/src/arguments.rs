//! Flags of `compare`.

use belvedere_baselines::methods::Listing;
use belvedere_scenes::{Preset, Regime};
use clap::Parser;
use clap::builder::{PossibleValuesParser, TypedValueParser};
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

/// Compare the accuracy and cost of visibility methods with exact answers
#[derive(Parser)]
#[command(name = "compare", version, max_term_width = 110, after_long_help = include_str!("help.txt"))]
pub(crate) struct Compare {
    /// Types of simulated towns, separated by commas [default: town]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = presets(),
        help_heading = "Simulated towns")]
    pub(crate) presets: Vec<Preset>,
    /// Seeds of the towns and their scans, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1", help_heading = "Simulated towns")]
    pub(crate) seeds: Vec<u64>,
    /// Side of a town in metres, 60 to 5000
    #[arg(long, value_name = "M", default_value_t = 150.0, value_parser = extent, help_heading = "Simulated towns")]
    pub(crate) extent: f64,
    /// Pulses per square metre, all strips together, 0.1 to 200, separated by commas [default: 10]
    ///
    /// For scanners that fly; others are refused, or compared once beside these.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = density, help_heading = "Simulated towns")]
    pub(crate) density: Vec<f64>,
    /// Simulated scanners, separated by commas
    ///
    /// Each but the first differs from it in one way. room is two furnished rooms instead of a town, with a tripod in
    /// each. tripods, car and room have no density. A car needs a street: --extent 100 or more.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "air", value_parser = regimes(), help_heading = "Simulated towns")]
    pub(crate) regimes: Vec<Regime>,
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
    /// Without it, normals of --clouds are oriented upward and their own points are not queried. For --held-out,
    /// scanner positions are estimated from pulses with several returns.
    #[arg(long, value_name = "FILE", help_heading = "Real place with ground truth")]
    pub(crate) trajectory: Option<PathBuf>,
    /// City model or reconstructed surface that is compared as another method; repeatable
    #[arg(long, value_name = "NAME=MESH", requires = "scene", help_heading = "Real place with ground truth")]
    pub(crate) model: Vec<NamedFile>,
    /// Point clouds that are tested with their own laser pulses
    ///
    /// A tenth of the pulses is kept from the methods. The path of each such pulse was free, and what lies behind its
    /// return is hidden; the methods must answer both. Needs GPS times, return numbers and pulses with several returns.
    #[arg(long, value_name = "CLOUD", num_args = 1.., help_heading = "Real clouds without ground truth")]
    pub(crate) held_out: Vec<PathBuf>,
    /// Methods to compare, by the start of their names [default: all except variants, which need their full names]
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Methods and targets")]
    pub(crate) methods: Vec<String>,
    /// Number of targets of each type
    #[arg(long = "target-count", value_name = "N", default_value_t = 50_000, value_parser = at_most::<10_000_000>, help_heading = "Methods and targets")]
    pub(crate) targets: usize,
    /// Folder for report.html, report.md, results and pictures; created if it does not exist
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    /// Also insert the tables into this Markdown file
    ///
    /// The tables go between the lines `<!-- tables -->` and `<!-- end of tables -->`.
    #[arg(long, value_name = "FILE", help_heading = "Result")]
    pub(crate) page: Option<PathBuf>,
    /// Number of threads, at most 1024; it does not change results [default: all processors]
    #[arg(long, value_name = "N", value_parser = at_most::<1024>, help_heading = "Other")]
    pub(crate) threads: Option<usize>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Other")]
    pub(crate) seed: u64,
    /// Print the results as one JSON object on standard output
    #[arg(long, help_heading = "Other")]
    pub(crate) json: bool,
    /// Print the duration of each stage on standard error
    #[arg(short, long, help_heading = "Other")]
    pub(crate) verbose: bool,
    /// Print only errors
    #[arg(long, conflicts_with_all = ["verbose", "json"], help_heading = "Other")]
    pub(crate) quiet: bool,
}

/// Pulses per square metre of scanners that fly, by default.
const DENSITY: f64 = 10.0;

impl Compare {
    /// Pulses per square metre.
    pub(crate) fn densities(&self) -> &[f64] {
        if self.density.is_empty() { &[DENSITY] } else { &self.density }
    }

    /// Whether towns are simulated, and not only real places compared.
    pub(crate) fn has_towns(&self) -> bool {
        self.mesh.is_none() && (self.held_out.is_empty() || !self.presets.is_empty())
    }

    /// Names of the scanners that have no density of their own choice.
    fn scanners_without_density(&self) -> Vec<&'static str> {
        self.regimes.iter().filter(|regime| !regime.flies()).map(|regime| regime.name()).collect()
    }

    /// Refuses densities that no scanner has, and gives a warning for scanners that have none beside others.
    pub(crate) fn check_density(&self) -> Result<Option<String>, Usage> {
        let without = self.scanners_without_density();
        if self.density.is_empty() {
            return Ok(None);
        }
        if !self.has_towns() {
            let what = "--density applies to simulated towns only, and there are none: leave it out";
            return Err(Usage(what.to_owned()));
        }
        let names = without.join(", ");
        if without.len() == self.regimes.len() {
            return Err(Usage(format!("--density applies to scanners that fly only, not to {names}: leave it out")));
        }
        let is_one = without.len() == 1;
        Ok((!without.is_empty()).then(|| {
            format!(
                "--density does not apply to {names}, which {} compared once, with {} own number of pulses",
                if is_one { "is" } else { "are" },
                if is_one { "its" } else { "their" }
            )
        }))
    }

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

/// Scanners by their names.
fn regimes() -> impl TypedValueParser<Value = Regime> {
    PossibleValuesParser::new(Regime::ALL.map(Regime::name)).map(|name| {
        // the parser lets no other name through
        Regime::ALL.into_iter().find(|regime| regime.name() == name).unwrap_or(Regime::Air)
    })
}

fn extent(text: &str) -> Result<f64, String> {
    between(text, 60.0, 5000.0)
}

fn density(text: &str) -> Result<f64, String> {
    between(text, 0.1, 200.0)
}

fn between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (low..=high).contains(v))
        .ok_or_else(|| format!("must be a number from {low} to {high}"))
}

/// A whole number from 1 to `MAX`.
fn at_most<const MAX: usize>(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX).contains(count));
    count.ok_or_else(|| format!("must be a whole number from 1 to {MAX}"))
}

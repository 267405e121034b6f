//! Flags of shadows.

use super::{GivingWay, Numbers, SceneInput, SkyOutputs, SkyPlaces, SunPeriod, SunPlace, ThroughTrees, above_zero};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Shadow {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) suns: Suns,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) sun: SunPlace,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    #[command(flatten)]
    pub(crate) trees: ThroughTrees,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    /// Also write a film of a grid's shadows (.png or .apng, which browsers play): a frame for each sun
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) film: Option<PathBuf>,
    /// Also write the frames as pictures of their own into this folder, made if it is not there
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) frames: Option<PathBuf>,
    /// Seconds that a frame of the film stays
    #[arg(long, value_name = "S", default_value_t = 0.25, requires = "film", help_heading = "Result",
        value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) seconds: f64,
}

#[derive(Args)]
#[command(next_help_heading = "When")]
pub(crate) struct Suns {
    /// An instant, with its offset or in --zone: 2026-06-21T15:00+02:00, or 2026-06-21T15:00[Europe/Amsterdam]. May be given several
    /// times; --date and --from with --to make suns in steps of a day or a period instead
    #[arg(long, value_name = "TIME", conflicts_with_all = ["date", "from", "to"])]
    pub(crate) time: Vec<String>,
    /// A sun by its azimuth clockwise from grid north and its elevation, in degrees, wherever the scene lies. May be given several times
    #[arg(long = "sun", value_name = "AZ,EL", allow_hyphen_values = true, conflicts_with_all = ["time", "date", "from", "to"])]
    pub(crate) direction: Vec<Numbers<2>>,
    /// Take the sun as a disc of half a degree: edges of shadows are soft, and places see a share of it, in 64ths
    #[arg(long)]
    pub(crate) soft: bool,
}

//! Flags of shadows.

use super::{
    GivingWay, HowSureArguments, NorthArguments, Numbers, SceneInput, SkyOutputs, SkyPlaces, SunPeriod,
    SunPlaceArguments, ThroughTreesArguments, TilesArguments, above_zero,
};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct ShadowArguments {
    #[command(flatten)]
    pub(crate) suns: SunsArguments,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) places: SkyPlaces,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    #[command(flatten)]
    pub(crate) how_sure: HowSureArguments,
    #[command(flatten)]
    pub(crate) trees: ThroughTreesArguments,
    #[command(flatten)]
    pub(crate) outputs: SkyOutputs,
    /// Also say what casts each shadow: building, trees, plan and so on
    ///
    /// The first obstacle between the target and the sun. 0 sun, 1 building, 2 trees, 3 ground, 4 water, 5 other
    /// things, 6 terrain beyond the cloud, 7 the surface of the target itself, 8 and more the meshes of --add. Needs
    /// classes of points.
    #[arg(long, help_heading = "Result")]
    pub(crate) casters: bool,
    /// Also write the shadows on a grid as areas (.geojson .gpkg): one for each sun; with --casters for each caster
    ///
    /// Its area, the caster, and the time and position of the sun are properties. Light of less than a half counts as
    /// shadow.
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) outlines: Option<PathBuf>,
    /// Also write an animation of the shadows on a grid: one frame for each sun (.png .apng)
    ///
    /// Browsers play animated PNG files.
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) film: Option<PathBuf>,
    /// Also write the frames of the animation as pictures into this folder; created if it does not exist
    #[arg(long, value_name = "DIR", help_heading = "Result")]
    pub(crate) frames: Option<PathBuf>,
    /// Duration of a frame in seconds
    #[arg(long = "frame-duration-s", value_name = "S", default_value_t = 0.25, requires = "film", help_heading = "Result",
        value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) seconds: f64,
    #[command(flatten)]
    pub(crate) tiles: TilesArguments,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Period")]
pub(crate) struct SunsArguments {
    /// An instant: 2026-06-21T15:00, or 2026-06-21T15:00+02:00; repeatable
    ///
    /// Without an offset it is on the clocks of the place, or of --zone. For instants in equal steps use --date, or
    /// --from and --to.
    #[arg(long, value_name = "TIME", conflicts_with_all = ["date", "from", "to"])]
    pub(crate) time: Vec<String>,
    /// A sun direction: azimuth clockwise from true north and elevation, in degrees; repeatable
    ///
    /// See --grid-north.
    #[arg(long = "sun", value_name = "AZ,EL", allow_hyphen_values = true, conflicts_with_all = ["time", "date", "from", "to"])]
    pub(crate) direction: Vec<Numbers<2>>,
    /// Take the sun as a disc of half a degree, which gives soft shadow edges
    ///
    /// Results are the visible share of the disc, in steps of 1/64.
    #[arg(long)]
    pub(crate) soft: bool,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
}

//! Flags of glare.

use super::{
    EyesArguments, FarTerrainArguments, NorthArguments, SceneInput, Shell, SunPeriod, SunPlaceArguments, finite,
};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct GlareArguments {
    /// Panels and panes that reflect: a table (.csv) with the columns x, y, z, azimuth, width and height
    ///
    /// x, y and z are the middle of the rectangle, azimuth is the direction that it faces, in degrees from true north
    /// (see --grid-north). It may have tilt (90, the default, is upright, 0 is level) and name. The width is level.
    #[arg(long, value_name = "FILE", required = true, help_heading = "Reflectors")]
    pub(crate) reflectors: PathBuf,
    /// Angle by which a surface spreads the beam to each side, in degrees, 0 to 11 [default: 0.75, smooth glass]
    ///
    /// 0 is a perfect mirror. Panels with a textured surface spread more, and dazzle less.
    #[arg(long = "scatter-deg", value_name = "DEG", value_parser = finite::<f64>, allow_negative_numbers = true,
        help_heading = "Reflectors")]
    pub(crate) scatter: Option<f64>,
    /// Count only reflections that lie at least so far from the sun itself, in degrees, 0 to 180 [default: 0]
    ///
    /// Nearer to the sun, it dazzles anyway. German authorities take 10.
    #[arg(long = "from-sun-deg", value_name = "DEG", value_parser = finite::<f64>, allow_negative_numbers = true,
        help_heading = "Reflectors")]
    pub(crate) from_sun: Option<f64>,
    #[command(flatten, next_help_heading = "Reflectors")]
    pub(crate) north: NorthArguments,
    #[command(flatten)]
    pub(crate) eyes: EyesArguments,
    #[command(flatten)]
    pub(crate) when: SunPeriod,
    #[command(flatten)]
    pub(crate) sun: SunPlaceArguments,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    #[command(flatten)]
    pub(crate) shell: Shell,
    /// Table with a row for each observer and reflector (.csv), or a chart of the year (.png); repeatable
    ///
    /// .png: one observer, days across and hours up. A period longer than two years is too wide for it.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Minutes of glare by month and hour of the clock: a table (.csv) with a row for each observer and month
    #[arg(long = "by-hour", value_name = "OUT", help_heading = "Result")]
    pub(crate) by_hour: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

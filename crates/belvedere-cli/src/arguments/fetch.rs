//! Flags of open surveys.

use super::{Numbers, above_zero, location};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct FetchArguments {
    /// Place as LATITUDE,LONGITUDE in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = location, allow_hyphen_values = true, required = true, help_heading = "Place")]
    pub(crate) at: Numbers<2>,
    /// Distance to the sides of the square around the place, in metres, 1 to 1000, with a folder 1 to 5000
    ///
    /// What shades or hides the place must lie in it: 200 m are enough for a garden among houses.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, default_value_t = 200.0,
        help_heading = "Place")]
    pub(crate) radius: f64,
    /// Survey to take, by the name that the list shows [default: the first that covers the square]
    #[arg(long, value_name = "NAME", help_heading = "Surveys")]
    pub(crate) survey: Option<String>,
    /// Table of surveys (.json) instead of the table of the program
    #[arg(long = "surveys", value_name = "FILE", help_heading = "Surveys")]
    pub(crate) surveys: Option<PathBuf>,
    /// Points of the square as one cloud (.laz .las), or a folder for whole tiles [default: list the surveys only]
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: Option<PathBuf>,
}

//! Flags of light through trees.

use clap::{Args, ValueEnum};
use std::str::FromStr;

/// The share of light that passes through trees.
#[derive(Args)]
#[command(next_help_heading = "Trees")]
pub(crate) struct ThroughTreesArguments {
    /// Light that passes through tree crowns: measured, none, seasons, pulses, or a number from 0 to 1
    ///
    /// measured: as far as laser pulses passed each cubic metre of the crown, and none where that is not known; a place
    /// behind crowns is lit where half or more passes, and sums count the share. Leaves are those of the date of the
    /// question: crowns measured without leaves are five times as dense in leaf. none: crowns are solid. seasons: as
    /// measured, and shadow is a share of light; 0.03 in leaf and 0.5 without leaves where nothing was measured
    /// (Konarska et al. 2014). pulses: as measured, and an error where nothing was. A number: this share, through any
    /// crown.
    #[arg(long, value_name = "SHARE", default_value = "none", allow_negative_numbers = true)]
    pub(crate) through_trees: ThroughTreesChoice,
    /// Whether trees have leaves [default: auto with a date, else as they were measured]
    ///
    /// auto: from 7 April to 27 October in the north, half a year later in the south, always in the tropics.
    #[arg(long, value_enum, value_name = "LEAVES")]
    pub(crate) leaves: Option<LeavesChoice>,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ThroughTreesChoice {
    Measured,
    None,
    Seasons,
    Pulses,
    Share(f64),
}

impl FromStr for ThroughTreesChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "measured" => Ok(Self::Measured),
            "none" => Ok(Self::None),
            "seasons" => Ok(Self::Seasons),
            "pulses" => Ok(Self::Pulses),
            _ => match text.parse() {
                Ok(share) if (0.0..=1.0).contains(&share) => Ok(Self::Share(share)),
                _ => Err("use measured, none, seasons, pulses, or a number from 0 (opaque) to 1".to_owned()),
            },
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LeavesChoice {
    /// By the date
    Auto,
    /// In leaf
    On,
    /// Without leaves
    Off,
}

//! Flags of the page in the browser.

use super::{MapPosition, SceneInput};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct ViewPage {
    /// Port to listen on, on 127.0.0.1 only [default: any that is free]
    #[arg(long, value_name = "N", help_heading = "Page", allow_negative_numbers = true, conflicts_with = "export")]
    pub(crate) port: Option<u16>,
    /// Print the address only, and open no browser
    #[arg(long, help_heading = "Page", conflicts_with = "export")]
    pub(crate) no_browser: bool,
    /// Write the page as one file that needs no server (.html), and end
    ///
    /// The file holds at most 3 million points. It answers no other questions than the shadows of --date and the views
    /// of --observer.
    #[arg(long, value_name = "OUT", help_heading = "File")]
    pub(crate) export: Option<PathBuf>,
    /// Day whose shadows are in the file, at each full hour
    #[arg(long, value_name = "DAY", help_heading = "File", requires = "export")]
    pub(crate) date: Option<String>,
    /// Time zone of --date: Europe/Amsterdam, +01:00, or solar [default: that of the place]
    #[arg(long, value_name = "ZONE", help_heading = "File", requires = "date", allow_hyphen_values = true)]
    pub(crate) zone: Option<String>,
    /// Viewpoint whose view is in the file, in file coordinates or as LAT,LON; without Z at eye level; repeatable
    #[arg(long, value_name = "X,Y[,Z]", help_heading = "File", requires = "export", allow_hyphen_values = true)]
    pub(crate) observer: Vec<MapPosition>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

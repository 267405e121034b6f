//! Flags of views: the sun, directions, cameras and panoramas.

use super::{Numbers, above_zero, at_least_one, length};
use clap::Args;
use std::str::FromStr;

#[derive(Args)]
#[command(next_help_heading = "View (one of)")]
#[group(required = true, multiple = false, id = "view")]
pub(crate) struct ViewKind {
    /// The viewport of the paper: "p0 v_x v_y s", corner, row vector, column vector, pixels per unit
    ///
    /// p0 is the upper left corner; v_x runs along the rows and v_y down the columns; all in file coordinates. The
    /// lengths of the vectors are the size of the picture. The view direction is v_x x v_y. Points behind the plane of
    /// the picture are outside the view.
    #[arg(long, value_name = "\"X,Y,Z X,Y,Z X,Y,Z S\"", allow_hyphen_values = true)]
    pub(crate) viewport: Option<ViewportChoice>,
    /// Parallel view from the sun: azimuth clockwise from true north and elevation, in degrees
    ///
    /// 90 is east. The elevation is above the horizon, 0 to 90. The view covers the whole scene. See --grid-north.
    #[arg(long, value_name = "AZ,EL", allow_hyphen_values = true)]
    pub(crate) sun: Option<Numbers<2>>,
    /// Parallel view along a direction in file coordinates; 0,0,-1 looks straight down
    ///
    /// The vector may have any length. The view covers the whole scene.
    #[arg(long, value_name = "DX,DY,DZ", allow_hyphen_values = true)]
    pub(crate) direction: Option<Numbers<3>>,
    /// Position of a camera in file coordinates; needs --look-at
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "look_at")]
    pub(crate) eye: Option<Numbers<3>>,
    /// Position of a panorama in file coordinates: all directions around it
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) panorama: Option<Numbers<3>>,
}

/// The north that azimuths are counted from.
#[derive(Args)]
pub(crate) struct NorthArguments {
    /// Count azimuths clockwise from grid north instead of true north
    ///
    /// Azimuths are also from grid north if the scene has no coordinate reference system. The summary states which
    /// north was used.
    #[arg(long)]
    pub(crate) grid_north: bool,
}

#[derive(Args)]
pub(crate) struct ViewChoice {
    #[command(flatten)]
    pub(crate) kind: ViewKind,
    #[command(flatten)]
    pub(crate) north: NorthArguments,
    /// Pixel size with --sun and --direction, in metres [default: 0.25, smaller for small objects]
    #[arg(long, value_name = "M", conflicts_with_all = ["viewport", "eye", "panorama"], value_parser = above_zero::<f64>,
        allow_negative_numbers = true)]
    pub(crate) pixel: Option<f64>,
    /// Point in the middle of the camera picture, in file coordinates
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, conflicts_with_all = ["viewport", "sun", "direction", "panorama"])]
    pub(crate) look_at: Option<Numbers<3>>,
    /// Horizontal field of view of the camera in degrees, up to 175 [default: 60]
    #[arg(long, value_name = "DEG", conflicts_with_all = ["viewport", "sun", "direction", "panorama"], allow_negative_numbers = true, value_parser = above_zero::<f64>)]
    pub(crate) fov: Option<f64>,
    /// Size of the camera picture in pixels [default: 1280x720], or width of a panorama [default: 2048]
    ///
    /// A panorama is half as high as it is wide.
    #[arg(long, value_name = "WxH|N", conflicts_with_all = ["viewport", "sun", "direction"])]
    pub(crate) size: Option<SizeChoice>,
    /// Minimum depth that the camera sees, in metres [default: 0]
    ///
    /// In a depth map, balls that cross this depth block from there on.
    #[arg(long, value_name = "M", conflicts_with_all = ["viewport", "sun", "direction", "panorama"], allow_negative_numbers = true, value_parser = length)]
    pub(crate) near: Option<f32>,
    /// Maximum depth that the camera sees, in metres [default: no limit]
    #[arg(long, value_name = "M", conflicts_with_all = ["viewport", "sun", "direction", "panorama"], allow_negative_numbers = true, value_parser = above_zero::<f64>)]
    pub(crate) far: Option<f64>,
}

/// Size of a picture in pixels.
#[derive(Clone, Copy)]
pub(crate) enum SizeChoice {
    Width(usize),
    WidthAndHeight([usize; 2]),
}

impl FromStr for SizeChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| at_least_one(text).map_err(|_| "use two numbers as 1280x720, or one".to_owned());
        match text.split_once(['x', 'X']) {
            Some((width, height)) => Ok(Self::WidthAndHeight([number(width)?, number(height)?])),
            None => number(text).map(Self::Width),
        }
    }
}

/// The paper's viewport in file coordinates.
#[derive(Clone, Copy)]
pub(crate) struct ViewportChoice {
    pub(crate) p0: [f64; 3],
    pub(crate) vx: [f64; 3],
    pub(crate) vy: [f64; 3],
    pub(crate) pixels_per_unit: f64,
}

impl FromStr for ViewportChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split_whitespace().collect();
        let [p0, vx, vy, s] = parts[..] else {
            return Err("expected four parts separated by blanks: px,py,pz vx,vy,vz wx,wy,wz s".to_owned());
        };
        let triple = |text: &str| text.parse::<Numbers<3>>().map(|n| n.0);
        let [pixels_per_unit] = s.parse::<Numbers<1>>()?.0;
        Ok(Self { p0: triple(p0)?, vx: triple(vx)?, vy: triple(vy)?, pixels_per_unit })
    }
}

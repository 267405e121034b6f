//! From where one looks, as typed.

use super::{Numbers, above_zero, at_least_one, length};
use clap::Args;
use std::str::FromStr;

#[derive(Args)]
#[command(next_help_heading = "View (one of)")]
#[group(required = true, multiple = false, id = "view")]
pub(crate) struct ViewKind {
    /// The paper's p0, v_x, v_y and s in one quoted text: upper left corner, vector along the rows, vector down the columns,
    /// all in file coordinates, and pixels per unit. The lengths of the vectors are the size of the picture; one looks along
    /// v_x x v_y, and what lies behind the corner's plane is not seen
    #[arg(long, value_name = "\"X,Y,Z X,Y,Z X,Y,Z S\"", allow_hyphen_values = true)]
    pub(crate) viewport: Option<ViewportChoice>,
    /// Parallel view from the sun onto the whole scene: azimuth clockwise from grid north (90 is east), elevation above the
    /// horizon, 0 to 90, in degrees
    #[arg(long, value_name = "AZ,EL", allow_hyphen_values = true)]
    pub(crate) sun: Option<Numbers<2>>,
    /// Parallel view onto the whole scene along a direction, of any length: 0,0,-1 looks straight down
    #[arg(long, value_name = "DX,DY,DZ", allow_hyphen_values = true)]
    pub(crate) direction: Option<Numbers<3>>,
    /// What a camera at this place sees, in file coordinates and their height; say where to with --look-at
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "look_at")]
    pub(crate) eye: Option<Numbers<3>>,
    /// Everything around this place, in file coordinates and their height
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub(crate) panorama: Option<Numbers<3>>,
}

#[derive(Args)]
pub(crate) struct ViewChoice {
    #[command(flatten)]
    pub(crate) kind: ViewKind,
    /// Pixel size of --sun and --direction in metres [default: 0.25, finer for small objects]
    #[arg(long, value_name = "M", conflicts_with_all = ["viewport", "eye", "panorama"], value_parser = above_zero::<f64>,
        allow_negative_numbers = true)]
    pub(crate) pixel: Option<f64>,
    /// Place in the middle of the picture of --eye, in file coordinates
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, conflicts_with_all = ["viewport", "sun", "direction", "panorama"])]
    pub(crate) look_at: Option<Numbers<3>>,
    /// Angle from the left to the right edge of the picture of --eye in degrees, up to 175 [default: 60]
    #[arg(long, value_name = "DEG", conflicts_with_all = ["viewport", "sun", "direction", "panorama"], allow_negative_numbers = true, value_parser = above_zero::<f64>)]
    pub(crate) fov: Option<f64>,
    /// Width and height of the picture of --eye in pixels [default: 1280x720], or width of a --panorama, which is half as
    /// high [default: 2048]
    #[arg(long, value_name = "WxH|N", conflicts_with_all = ["viewport", "sun", "direction"])]
    pub(crate) size: Option<SizeChoice>,
    /// Least depth that --eye sees in metres; balls that it cuts block from there on in a depth map [default: 0]
    #[arg(long, value_name = "M", conflicts_with_all = ["viewport", "sun", "direction", "panorama"], allow_negative_numbers = true, value_parser = length)]
    pub(crate) near: Option<f32>,
    /// Most depth that --eye sees in metres [default: no limit]
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

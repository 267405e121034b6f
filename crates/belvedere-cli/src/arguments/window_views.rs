//! Flags of the view from windows.

use super::{FarTerrainArguments, GivingWay, NorthArguments, SceneInput, above_zero, at_least_one};
use belvedere::apps::window_views::SeenKind;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub(crate) struct WindowViewsArguments {
    /// Windows: a table (.csv), or a mesh whose faces are facades (.obj .json .ply)
    ///
    /// The table has the columns x, y, z of the middle and azimuth in degrees from true north (see --grid-north). It
    /// may have tilt (90: vertical), width and height in metres, and name: the building that the window belongs to. Of
    /// a mesh each face is a window; roofs and floors (nearer to horizontal than to vertical) are left out.
    #[arg(long, value_name = "FILE", help_heading = "Windows")]
    pub(crate) windows: PathBuf,
    /// Name of an object of the mesh whose faces are windows; repeatable [default: all]
    #[arg(long, value_name = "NAME", help_heading = "Windows")]
    pub(crate) object: Vec<String>,
    /// Maximum side of the triangles that the faces of a mesh are cut into, in metres [default: 2]
    ///
    /// Each triangle has one sample point.
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Windows")]
    pub(crate) spacing: Option<f64>,
    #[command(flatten, next_help_heading = "Windows")]
    pub(crate) north: NorthArguments,
    /// Number of directions in front of each sample point, 1 to 100000 [default: 1000]
    #[arg(long, value_name = "N", value_parser = at_least_one, help_heading = "View", allow_negative_numbers = true)]
    pub(crate) directions: Option<usize>,
    /// What a class of points is: vegetation, water, building, ground or other; repeatable
    ///
    /// Default: the classes of ASPRS. 2, 10 and 11 are ground, 3 to 5 vegetation, 6 building, 9 water. Points of class
    /// 0 or 1 are vegetation if the pulses show that; all others are other. Example: --class 26=ground.
    #[arg(long = "class", value_name = "N=KIND", help_heading = "View")]
    pub(crate) classes: Vec<ClassMeaning>,
    /// Cloud from which a ball file was built, for the classes of its points
    #[arg(long = "classes-of", value_name = "FILE", help_heading = "View")]
    pub(crate) classes_of: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    #[command(flatten)]
    pub(crate) far: FarTerrainArguments,
    /// Table (.csv), points (.geojson .gpkg .laz .las .ply) or a map (.png); repeatable
    ///
    /// A row or a point for each window. The map shows the share of --map-of.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a table with the mean view of the windows of each building (.csv)
    ///
    /// Windows of a table need the column name: windows of one building have the same name. Of a mesh each object is a
    /// building, and its windows count by their area.
    #[arg(long, value_name = "OUT", help_heading = "Result")]
    pub(crate) buildings: Option<PathBuf>,
    /// What the map shows: sky, vegetation, water, building, ground or other [default: vegetation]
    #[arg(long, value_name = "KIND", value_parser = kind, help_heading = "Result")]
    pub(crate) map_of: Option<SeenKind>,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

/// A class of points, and what it is.
#[derive(Clone, Copy)]
pub(crate) struct ClassMeaning(pub(crate) u8, pub(crate) SeenKind);

impl FromStr for ClassMeaning {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected a class (0 to 255) and vegetation, water, building, ground or other, such as 26=ground".to_owned()
        };
        let (class, name) = text.split_once('=').ok_or_else(expected)?;
        let (class, seen) = (class.trim().parse().ok(), SeenKind::thing_called(name.trim()));
        class.zip(seen).map(|(class, seen)| Self(class, seen)).ok_or_else(expected)
    }
}

fn kind(text: &str) -> Result<SeenKind, String> {
    let found = SeenKind::thing_called(text).or_else(|| (text == SeenKind::Sky.name()).then_some(SeenKind::Sky));
    found.ok_or_else(|| "must be sky, vegetation, water, building, ground or other".to_owned())
}

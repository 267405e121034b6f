//! Flags of mesh targets, landmarks, isovists and horizons.

use super::{Earth, GivingWay, GroundChoice, Place, SceneInput, above_zero};
use belvedere::query::BackFaces;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Flags of targets that are meshes.
#[derive(Args)]
#[command(next_help_heading = "Targets that are a mesh")]
pub(crate) struct MeshTargets {
    /// Longest side of the pieces that faces are cut into, each asked at a place drawn on it, in metres [default: 0.5]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true)]
    pub(crate) spacing: Option<f64>,
    /// What to make of faces turned away from the viewer [default: not-visible]
    #[arg(long, value_enum)]
    pub(crate) back_faces: Option<BackFacesChoice>,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum BackFacesChoice {
    /// They count as not visible
    NotVisible,
    /// They are not counted
    LeftOut,
    /// They are asked as others: for open surfaces, and meshes that do not know their outside
    BothSides,
}

impl From<BackFacesChoice> for BackFaces {
    fn from(choice: BackFacesChoice) -> Self {
        match choice {
            BackFacesChoice::NotVisible => Self::NotVisible,
            BackFacesChoice::LeftOut => Self::LeftOut,
            BackFacesChoice::BothSides => Self::BothSides,
        }
    }
}

#[derive(Args)]
pub(crate) struct Landmark {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) what: What,
    /// Object of the mesh that is the landmark, by its name; may be given several times [default: all]
    #[arg(long, value_name = "NAME", requires = "target", help_heading = "Landmark (one of)")]
    pub(crate) object: Vec<String>,
    /// Longest side of the pieces that a mesh is cut into, in metres [default: what makes about 1000 pieces, 0.25 at least]
    #[arg(long, value_name = "M", requires = "target", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Landmark (one of)")]
    pub(crate) spacing: Option<f64>,
    /// What to make of faces of a mesh turned away from the observer [default: not-visible, so that shares are those of the
    /// whole landmark]
    #[arg(long, value_enum, requires = "target", help_heading = "Landmark (one of)")]
    pub(crate) back_faces: Option<BackFacesChoice>,
    /// Observers from a table with columns x and y (.csv), which may have z and height, or from GeoJSON [default: one in the
    /// middle of each cell of a grid over the scene]
    #[arg(long, value_name = "FILE", help_heading = "Who looks")]
    pub(crate) observers: Option<PathBuf>,
    /// Side of the cells that observers stand in, in metres [default: 2, doubled until there are at most 40000]
    #[arg(long, value_name = "M", conflicts_with = "observers", value_parser = above_zero::<f64>, allow_negative_numbers = true,
        help_heading = "Who looks")]
    pub(crate) cell: Option<f64>,
    /// Height of eyes above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", allow_negative_numbers = true, help_heading = "Who looks")]
    pub(crate) observer_height: Option<f64>,
    /// Where the ground comes from: auto (class 2 where there is one, else found), classed, found, or cloud=FILE, which a ball file
    /// needs
    #[arg(long, value_name = "HOW", default_value = "auto", help_heading = "Who looks")]
    pub(crate) ground: GroundChoice,
    /// Greatest distance at which the landmark counts, in metres
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Who looks")]
    pub(crate) max_distance: Option<f64>,
    #[command(flatten)]
    pub(crate) earth: Earth,
    #[command(flatten)]
    pub(crate) giving_way: GivingWay,
    /// What is seen: every measure for every observer (.csv), or of a grid the share of the landmark's surface that is seen, 0 to 1,
    /// as a raster (.tif, nodata -9999) or a map with a legend (.png). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write a raster for each measure of a grid into this folder, made if it is not there
    #[arg(long, value_name = "DIR", conflicts_with = "observers", help_heading = "Result")]
    pub(crate) measures: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Landmark (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct What {
    /// Mesh (.obj .ply .json .city.json) in the coordinates of the scene's file
    #[arg(long, value_name = "MESH")]
    pub(crate) target: Option<PathBuf>,
    /// Points of this ASPRS class
    #[arg(long, value_name = "N")]
    pub(crate) target_class: Option<u8>,
    /// Points above a polygon that are not ground: GeoJSON, or a table (.csv) with the corners of a ring in columns x and y
    #[arg(long, value_name = "FILE")]
    pub(crate) target_polygon: Option<PathBuf>,
}

#[derive(Args)]
#[command(next_help_heading = "Eyes")]
pub(crate) struct Eyes {
    /// An eye in the coordinates of the scene's file; without Z it is --height above the ground. May be given several times
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, required_unless_present = "eyes")]
    pub(crate) eye: Vec<Place>,
    /// Eyes from a table with columns x and y (.csv) or from GeoJSON; columns, or properties, z and height go before the flags
    #[arg(long, value_name = "FILE", conflicts_with = "eye")]
    pub(crate) eyes: Option<PathBuf>,
    /// Height of eyes above the ground in metres [default: 1.7]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) height: Option<f64>,
    /// Where the ground comes from, for eyes without Z: auto (class 2 where there is one, else found), classed, found, or
    /// cloud=FILE, which a ball file needs
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub(crate) ground: GroundChoice,
}

#[derive(Args)]
pub(crate) struct Isovist {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) eyes: Eyes,
    /// Range at which sight ends where nothing blocks, in metres [default: 100]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) max_distance: Option<f64>,
    /// Angle between rays in degrees [default: 1]
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) step: Option<f64>,
    /// Least jump in range that counts as an edge of the plan, in metres [default: 0.25]
    #[arg(long, value_name = "M", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Rays")]
    pub(crate) jump: Option<f64>,
    /// Measures, a row for each eye (.csv) or an object for each (.json, which also has the corners of the plan), or the ranges
    /// around a single eye as a picture (.png). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
}

#[derive(Args)]
pub(crate) struct Horizon {
    #[command(flatten)]
    pub(crate) scene: SceneInput,
    #[command(flatten)]
    pub(crate) eyes: Eyes,
    #[command(flatten)]
    pub(crate) earth: Earth,
    /// Degrees between azimuths, a part of 360 [default: 1]
    #[arg(long, value_name = "DEG", value_parser = above_zero::<f64>, allow_negative_numbers = true, help_heading = "Result")]
    pub(crate) step: Option<f64>,
    /// North that azimuths count from
    #[arg(long, value_enum, default_value_t = NorthChoice::Grid, help_heading = "Result")]
    pub(crate) north: NorthChoice,
    /// What stands below the level of the eye
    #[arg(long, value_enum, default_value_t = BelowChoice::Zero, help_heading = "Result")]
    pub(crate) below: BelowChoice,
    /// Horizon (.csv): azimuth and elevation in degrees, clockwise from north, a column of elevations for each eye; the elevations of a
    /// single eye alone, one a line, as PVGIS takes them (.txt); or a diagram of them (.png). May be given several times
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum NorthChoice {
    /// That of the coordinates
    Grid,
    /// That of the earth, as PVGIS and pvlib have it; needs the reference system
    True,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BelowChoice {
    /// Elevations below zero are written as zero, as PVGIS takes them
    Zero,
    /// They stay; -90 where nothing stands at all
    Keep,
}

//! Flags of depth maps and of targets in a view.

use super::{BallShape, MeshTargets, SceneInput, UnprovenChoice, ViewChoice, at_most, finite, length};
use belvedere::query::MAX_RANDOM_TARGETS;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct DepthMapArguments {
    #[command(flatten)]
    pub(crate) view: ViewChoice,
    /// Depth in metres (.tif .npy), or a picture with a legend (.png); repeatable
    ///
    /// Rows run from the top. Pixels without a surface are nodata (-9999) in .tif and infinity in .npy.
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Result")]
    pub(crate) output: Vec<PathBuf>,
    /// Also write the index of the ball that each pixel shows (.tif .npy)
    ///
    /// The index is the row in the ball file, counted from 0; 4294967295 for none. For a cloud, it is the row in the
    /// file that `belvedere balls` writes with the same flags.
    #[arg(long = "ball-ids", value_name = "OUT", help_heading = "Result")]
    pub(crate) balls_id: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) shape: BallShape,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
pub(crate) struct Query {
    #[command(flatten)]
    pub(crate) view: ViewChoice,
    #[command(flatten)]
    pub(crate) targets: TargetsArguments,
    #[command(flatten)]
    pub(crate) mesh: MeshTargets,
    /// Depth tolerance: how far behind the depth map a target is still visible, in metres
    /// [default: from the pixel size]
    ///
    /// With carved balls and from an eye it is the length of the line of sight that may lie inside a ball. Default:
    /// depth noise plus half a pixel on a slope of 63 degrees, 0.58 for pixels of 0.25 m and 0.22 from an eye; 0 with
    /// carved balls and with --ball-profile paper-cone.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = finite::<f32>, help_heading = "Result")]
    pub(crate) bias: Option<f32>,
    /// Surface tolerance: how far carved balls are reduced near an end of a line, in metres [default: 0.2]
    ///
    /// Balls bulge between the points of walls and roofs. Use 0 for targets that do not lie on surfaces.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = length, help_heading = "Result")]
    pub(crate) shell: Option<f32>,
    /// How unproven targets are reported [default: report]
    ///
    /// Nothing blocks an unproven target, but more than 0.5 m of its line of sight runs through space that no pulse
    /// came near. This needs carved balls with their pulses: a cloud, or an .npz file.
    #[arg(long, value_enum, help_heading = "Result")]
    pub(crate) unproven: Option<UnprovenChoice>,
    /// Also write the probability that a target is visible, 0 to 1, as a column `probability`
    ///
    /// docs/methods/confidence.md says how well it is calibrated. Needs pulses, as --unproven does.
    #[arg(long, help_heading = "Result")]
    pub(crate) probability: bool,
    /// Targets with a column `answer` (.csv .xyz .txt .laz .las .ply), or the answers only (.npy, u8)
    ///
    /// One row for each target, in the order of the input.
    #[arg(short, long, value_name = "OUT", help_heading = "Result")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) shape: BallShape,
    #[command(flatten)]
    pub(crate) scene: SceneInput,
}

#[derive(Args)]
#[command(next_help_heading = "Targets (one of)")]
#[group(required = true, multiple = false)]
pub(crate) struct TargetsArguments {
    /// Points or a mesh to query, in the coordinates of the scene; a table needs columns x, y and z
    #[arg(long, value_name = "FILE")]
    pub(crate) targets: Option<PathBuf>,
    /// Query N random points, at most 50 million, uniform in the bounding box of the cloud (see --seed)
    #[arg(long, value_name = "N", value_parser = at_most::<MAX_RANDOM_TARGETS>)]
    pub(crate) random: Option<usize>,
    /// Query all points of the cloud, in their order
    #[arg(long = "self")]
    pub(crate) own: bool,
}

//! Formats of text: tables, clouds of points, trajectories, graphs.

pub(crate) mod graphml;
pub(crate) mod horizon_profile;
pub(crate) mod observers;
pub(crate) mod pcd;
pub(crate) mod ptx;
pub(crate) mod scan_pose;
pub(crate) mod stations;
pub(crate) mod table;
pub(crate) mod text_rows;
pub(crate) mod towers;
pub(crate) mod trajectory;
pub(crate) mod write_table;
pub(crate) mod write_trajectory;
pub(crate) mod xyz;

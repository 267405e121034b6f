//! Surveys of towns with canals; tests and an example share it.

use belvedere::PointCloud;

/// Canals run north: how far it is from one to the next and how wide each is, metres.
const CANALS_EACH: f32 = 36.0;
const CANAL_WIDTH: f32 = 12.0;

/// What a survey would be if the ground were water in canals: pulses that end there do not return.
pub(crate) fn without_returns_from_water(cloud: &PointCloud, scanner: &[[f32; 3]]) -> (PointCloud, Vec<[f32; 3]>) {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let is_water =
        |row: usize| classes.get(row) == Some(&2) && cloud.positions[row][0].rem_euclid(CANALS_EACH) < CANAL_WIDTH;
    let (rows, scanner): (Vec<u32>, Vec<_>) = (0..).zip(scanner).filter(|(row, _)| !is_water(*row as usize)).unzip();
    (cloud.select(&rows), scanner)
}

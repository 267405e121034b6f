//! Contradictions between a model and its input: findings of its construction, and added meshes off the level of the
//! ground.

use super::remark::Remark;
use super::viewer::remark_on_axis;
use belvedere_core::model::SceneModel;
use belvedere_data::cast::to_index;
use belvedere_data::contradiction::{FoundContradiction, MESH_FLOATS, MESH_IS_HUGE, MESH_SINKS};
use belvedere_data::report::rounded;

/// Radius around a mesh within which ground counts, metres.
const AROUND: f64 = 10.0;
/// Fewer places show no ground.
const MIN_PLACES: usize = 20;
/// Parts of the places around, by height, that show the ground: roofs and crowns are higher, and noise is lower.
const LOWEST: f64 = 0.05;
const GROUND: f64 = 0.3;
/// Meshes lower than this are no buildings, metres: paths, decks, roofs on their own.
const MIN_HEIGHT: f64 = 2.0;
/// Minimum share of the places below it at the base of a mesh that stands on a roof, within a tolerance in metres.
const MIN_SUPPORT: f64 = 0.02;
const SUPPORT: f64 = 1.0;

/// Remarks on contradictions in a model, such as a cloud on its side.
#[must_use]
pub fn remarks_on_model(model: &SceneModel) -> Vec<Remark> {
    let noted = FoundContradiction::noted_in(&model.parts().provenance);
    let found = noted.chain(levels_of_meshes(model)).filter_map(Remark::of_contradiction);
    remark_on_axis(model.looks_y_up()).into_iter().chain(found).collect()
}

/// Lowest and highest corner of a mesh, local metres.
type MeshBox = [[f64; 3]; 2];

fn levels_of_meshes(model: &SceneModel) -> Vec<FoundContradiction> {
    let Some(added) = model.added() else { return Vec::new() };
    let mut boxes = vec![[[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]; added.names().len()];
    for (corners, blocker) in added.triangles() {
        let Some([low, high]) = blocker.mesh().and_then(|mesh| boxes.get_mut(mesh)) else { continue };
        for axis in 0..3 {
            low[axis] = corners.iter().fold(low[axis], |least, corner| least.min(corner[axis]));
            high[axis] = corners.iter().fold(high[axis], |most, corner| most.max(corner[axis]));
        }
    }
    let balls = model.balls();
    let found = boxes.iter().zip(added.names()).filter_map(|(own, name)| {
        let mut tops: Vec<[f64; 3]> = Vec::new();
        for (center, radius) in balls.centers.iter().zip(&balls.radii) {
            let [x, y, z] = center.map(f64::from);
            if is_around(own, [x, y], AROUND) {
                // the top of a ball in the ground lies in its surface
                tops.push([x, y, z + f64::from(*radius)]);
            }
        }
        level_of_mesh(own, tops, name)
    });
    found.collect()
}

fn is_around([low, high]: &MeshBox, place: [f64; 2], by: f64) -> bool {
    (0..2).all(|axis| (low[axis] - by..=high[axis] + by).contains(&place[axis]))
}

/// Returns the contradiction between the level of a mesh and places on surfaces below and around it.
fn level_of_mesh(own: &MeshBox, mut tops: Vec<[f64; 3]>, name: &str) -> Option<FoundContradiction> {
    let [base, top] = own.map(|corner| corner[2]);
    if MESH_IS_HUGE.is_exceeded_by(top - base) {
        let height = rounded(top - base, 1);
        let text = format!("{name} is {height} m high: is its unit that of the cloud?");
        return Some(MESH_IS_HUGE.found(text).with("height_m", height));
    }
    if tops.len() < MIN_PLACES || top - base < MIN_HEIGHT {
        return None;
    }
    tops.sort_by(|a, b| a[2].total_cmp(&b[2]));
    let at = |share: f64| tops.get(to_index(tops.len() as f64 * share)).map(|place| place[2]);
    let (lowest, ground) = (at(LOWEST)?, at(GROUND)?);
    let below: Vec<f64> = tops.iter().filter(|p| is_around(own, [p[0], p[1]], 0.0)).map(|p| p[2]).collect();
    let supporting = below.iter().filter(|&&level| (level - base).abs() <= SUPPORT).count();
    let stands_on_something = supporting > 0 && supporting as f64 >= MIN_SUPPORT * below.len() as f64;
    let rise = rounded(base - ground, 1);
    if MESH_FLOATS.is_exceeded_by((base - ground).max(0.0)) && !stands_on_something {
        let text = format!(
            "{name} floats: its base lies {rise} m above the ground around it, and nothing is below it there; are its heights those of the cloud?"
        );
        return Some(MESH_FLOATS.found(text).with("above_ground_m", rise));
    }
    if top < lowest || MESH_SINKS.is_exceeded_by((lowest - base).max(0.0)) {
        let depth = rounded(lowest - base, 1);
        let how = if top < lowest { "lies under the ground" } else { "sinks into the ground" };
        let text = format!(
            "{name} {how}: its base lies {depth} m below the ground around it; are its heights those of the cloud, or does it have cellars?"
        );
        return Some(MESH_SINKS.found(text).with("below_ground_m", depth));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places every metre on ground that rises to the east, and on the roof of a house 9 m high.
    fn places(slope: f64) -> Vec<[f64; 3]> {
        let on_ground = (0..60).flat_map(|x| (0..60).map(move |y| [f64::from(x), f64::from(y)]));
        let place = |[x, y]: [f64; 2]| {
            let is_house = (40.0..50.0).contains(&x) && (20.0..40.0).contains(&y);
            [x, y, slope * x + if is_house { 9.0 } else { 0.0 }]
        };
        on_ground.map(place).collect()
    }

    /// Returns the contradiction for a building of 12 by 12 m and 10 m, with its base at a height above the lowest
    /// ground below it.
    fn contradiction(slope: f64, west: f64, rise: f64) -> Option<(&'static str, f64)> {
        let base = slope * west + rise;
        let own = [[west, 15.0, base], [west + 12.0, 27.0, base + 10.0]];
        let tops = places(slope).into_iter().filter(|p| is_around(&own, [p[0], p[1]], AROUND)).collect();
        let found = level_of_mesh(&own, tops, "house.obj")?;
        Some((found.row.key, found.numbers[0].1))
    }

    #[test]
    fn buildings_stand_on_the_ground_float_or_sink() {
        for slope in [0.0, 0.05, 0.15] {
            // on the ground, dug in, and on a cellar
            for rise in [0.0, 0.5, -1.0, -3.0] {
                assert_eq!(contradiction(slope, 15.0, rise), None, "{slope} {rise}");
            }
            assert_eq!(contradiction(slope, 15.0, 6.0).map(|found| found.0), Some("mesh-floats"), "{slope}");
            assert_eq!(contradiction(slope, 15.0, -8.0).map(|found| found.0), Some("mesh-sinks"), "{slope}");
        }
        assert_eq!(contradiction(0.0, 15.0, 3.0), Some(("mesh-floats", 3.0)));
        assert_eq!(contradiction(0.0, 15.0, -12.0), Some(("mesh-sinks", 12.0)));
    }

    #[test]
    fn storeys_on_a_roof_float_over_the_street_and_stand_on_the_roof() {
        assert_eq!(contradiction(0.0, 39.0, 9.0), None);
        assert_eq!(contradiction(0.0, 39.0, 14.0).map(|found| found.0), Some("mesh-floats"));
    }
}

//! Polygons that cross the meridian of 180 degrees, as GeoJSON wants them: cut in two.
//!
//! # Source
//! RFC 7946, section 3.1.9.

/// A polygon in degrees: its outer ring and its holes, each closed.
pub(crate) type DegreeRings = Vec<Vec<[f64; 2]>>;

/// Cuts a polygon, longitude and latitude in degrees, at 180 degrees. Returns the polygon itself if it does not cross,
/// else its parts west and east of the meridian, each between -180 and 180.
pub(crate) fn cut(rings: DegreeRings) -> Vec<DegreeRings> {
    let crosses = rings.iter().any(|ring| ring.windows(2).any(|pair| (pair[1][0] - pair[0][0]).abs() > 180.0));
    if !crosses {
        return vec![rings];
    }
    // east of the meridian, longitudes run on from 180
    let unwrapped: DegreeRings =
        rings.into_iter().map(|ring| ring.into_iter().map(east_of_greenwich).collect()).collect();
    let west = side(&unwrapped, |x| x < 180.0);
    let east = side(&unwrapped, |x| x >= 180.0);
    let turned = east.into_iter().map(|polygon| {
        let back = |[x, y]: [f64; 2]| [x - 360.0, y];
        polygon.into_iter().map(|ring| ring.into_iter().map(back).collect()).collect()
    });
    west.into_iter().chain(turned).collect()
}

fn east_of_greenwich([x, y]: [f64; 2]) -> [f64; 2] {
    [x.rem_euclid(360.0), y]
}

/// A piece of a ring on one side, with the latitudes where it comes in and goes out.
struct Chain {
    corners: Vec<[f64; 2]>,
    from: f64,
    to: f64,
}

/// The polygons of the part on one side of the meridian.
fn side(rings: &[Vec<[f64; 2]>], is_inside: impl Fn(f64) -> bool) -> Vec<DegreeRings> {
    let (mut chains, mut whole): (Vec<Chain>, Vec<Vec<[f64; 2]>>) = (Vec::new(), Vec::new());
    for ring in rings {
        let corners = ring.split_last().map_or(&[][..], |(_, corners)| corners);
        let Some(start) = corners.iter().position(|corner| !is_inside(corner[0])) else {
            whole.push(ring.clone());
            continue;
        };
        let mut open: Option<Chain> = None;
        for step in 0..corners.len() {
            let [a, b] = [step, step + 1].map(|step| corners[(start + step) % corners.len()]);
            let crossing = || a[1] + (180.0 - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
            match (is_inside(a[0]), is_inside(b[0])) {
                (false, true) => {
                    open = Some(Chain { corners: vec![[180.0, crossing()], b], from: crossing(), to: 0.0 });
                }
                (true, true) => open.iter_mut().for_each(|chain| chain.corners.push(b)),
                (true, false) => {
                    chains.extend(open.take().map(|mut chain| {
                        chain.to = crossing();
                        chain.corners.push([180.0, chain.to]);
                        chain
                    }));
                }
                (false, false) => {}
            }
        }
    }
    let mut polygons: Vec<DegreeRings> = joined(chains).into_iter().map(|ring| vec![ring]).collect();
    // a ring that lies here alone is the outline, or a hole of the part around it
    for ring in whole {
        let inside = |polygon: &&mut DegreeRings| {
            ring.first().is_some_and(|&corner| belvedere_data::polygon::is_inside(&polygon[..1], corner))
        };
        match polygons.iter_mut().find(inside) {
            Some(polygon) => polygon.push(ring),
            None => polygons.push(vec![ring]),
        }
    }
    polygons
}

/// Joins chains that begin and end on the meridian to closed rings. Along the meridian the polygon lies between the
/// first and the second crossing, between the third and the fourth and so on. A chain therefore continues where its
/// partner begins.
fn joined(chains: Vec<Chain>) -> Vec<Vec<[f64; 2]>> {
    let mut crossings: Vec<f64> = chains.iter().flat_map(|chain| [chain.from, chain.to]).collect();
    crossings.sort_unstable_by(f64::total_cmp);
    let place = |latitude: f64| crossings.partition_point(|own| *own < latitude);
    let next_of = |chain: &Chain| {
        let partner = place(chain.to) ^ 1;
        chains.iter().position(|other| place(other.from) == partner)
    };
    let mut is_used = vec![false; chains.len()];
    let mut rings = Vec::new();
    for start in 0..chains.len() {
        let (mut ring, mut at) = (Vec::new(), Some(start));
        while let Some(number) = at.filter(|&number| !is_used[number]) {
            is_used[number] = true;
            ring.extend_from_slice(&chains[number].corners);
            at = next_of(&chains[number]);
        }
        if let Some(&first) = ring.first() {
            ring.push(first);
            rings.push(ring);
        }
    }
    rings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygons: &[DegreeRings]) -> f64 {
        let ring = |ring: &Vec<[f64; 2]>| {
            ring.windows(2).map(|pair| (pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]) / 2.0).sum::<f64>()
        };
        polygons.iter().flatten().map(ring).sum()
    }

    fn ring(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let wrapped = |&[x, y]: &[f64; 2]| [if x > 180.0 { x - 360.0 } else { x }, y];
        corners.iter().chain(&corners[..1]).map(wrapped).collect()
    }

    #[test]
    fn polygons_are_cut_at_180_degrees_and_keep_their_area() {
        let square = ring(&[[179.0, -17.0], [181.0, -17.0], [181.0, -16.0], [179.0, -16.0]]);
        let hole = ring(&[[179.5, -16.8], [179.5, -16.2], [180.5, -16.2], [180.5, -16.8]]);
        let small = ring(&[[180.6, -16.6], [180.6, -16.4], [180.8, -16.4], [180.8, -16.6]]);
        // a U, open to the east, of which the west is one part and the east two
        let u = ring(&[
            [179.0, 0.0],
            [181.0, 0.0],
            [181.0, 1.0],
            [179.5, 1.0],
            [179.5, 2.0],
            [181.0, 2.0],
            [181.0, 3.0],
            [179.0, 3.0],
        ]);
        for (rings, expected, count) in [
            (vec![square.clone()], 2.0, 2),
            (vec![square.clone(), small], 2.0 - 0.04, 2),
            // the hole opens to the meridian on both sides
            (vec![square, hole], 2.0 - 0.6, 2),
            (vec![u], 6.0 - 1.5, 3),
        ] {
            let parts = cut(rings);
            assert_eq!(parts.len(), count, "{parts:?}");
            assert!((area(&parts) - expected).abs() < 1e-9, "{} {expected}", area(&parts));
            for corner in parts.iter().flatten().flatten() {
                assert!(corner[0].abs() <= 180.0);
            }
            let spans = |ring: &Vec<[f64; 2]>| ring.windows(2).any(|pair| (pair[0][0] - pair[1][0]).abs() > 2.0);
            assert!(!parts.iter().flatten().any(spans), "{parts:?}");
            assert!(parts.iter().flatten().all(|ring| ring.first() == ring.last()));
        }
        let plain = vec![ring(&[[4.0, 52.0], [5.0, 52.0], [5.0, 53.0]])];
        assert_eq!(cut(plain.clone()), [plain]);
    }
}

//! Angular width and height of pieces before an eye.

use std::f64::consts::{PI, TAU};

/// Directions and ranges that a piece takes up, or several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SkyBox {
    /// Azimuth from and to, clockwise from north, radians; the second is the first plus the width, 0 to 2π.
    pub(super) azimuths: [f64; 2],
    /// Minimum and maximum elevation, radians.
    pub(super) elevations: [f64; 2],
    /// Minimum and maximum range of corners, metres.
    pub(super) ranges: [f64; 2],
}

impl SkyBox {
    /// The box around both, but for azimuths, which stay this one's.
    pub(super) fn union(&self, other: &Self) -> Self {
        let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self {
            azimuths: self.azimuths,
            elevations: join(self.elevations, other.elevations),
            ranges: join(self.ranges, other.ranges),
        }
    }
}

/// The box of a small triangle with its corners and the place on it given from the eye.
pub(super) fn sky_box(corners: [[f64; 3]; 3], place: [f64; 3]) -> SkyBox {
    let azimuth = |v: [f64; 3]| v[0].atan2(v[1]);
    let middle = azimuth(place);
    let mut sky =
        SkyBox { azimuths: [0.0; 2], elevations: [f64::INFINITY, f64::NEG_INFINITY], ranges: [f64::INFINITY, 0.0] };
    for v in corners {
        let turn = (azimuth(v) - middle + PI).rem_euclid(TAU) - PI;
        sky.azimuths = [sky.azimuths[0].min(turn), sky.azimuths[1].max(turn)];
        let elevation = v[2].atan2(v[0].hypot(v[1]));
        sky.elevations = [sky.elevations[0].min(elevation), sky.elevations[1].max(elevation)];
        let range = belvedere_data::vector::length(v);
        sky.ranges = [sky.ranges[0].min(range), sky.ranges[1].max(range)];
    }
    if sky.azimuths[1] - sky.azimuths[0] > PI {
        // the vertical through the eye runs through it: all azimuths, and straight up or down
        sky.azimuths = [0.0, TAU];
        let pole = PI / 2.0 * place[2].signum();
        sky.elevations = [sky.elevations[0].min(pole), sky.elevations[1].max(pole)];
    } else {
        sky.azimuths = sky.azimuths.map(|turn| middle + turn);
    }
    sky
}

/// Arcs of the circle of azimuths.
#[derive(Clone, Debug, Default)]
pub(super) struct Arcs(Vec<[f64; 2]>);

impl Arcs {
    /// Adds the arc from the first to the second azimuth, radians, not before it.
    pub(super) fn add(&mut self, [from, to]: [f64; 2]) {
        let width = (to - from).clamp(0.0, TAU);
        let start = from.rem_euclid(TAU);
        let end = start + width;
        self.0.push([start, end.min(TAU)]);
        if end > TAU {
            self.0.push([0.0, end - TAU]);
        }
    }

    /// Length of the circle that arcs cover, and of the shortest arc that holds them all, radians.
    pub(super) fn measure(mut self) -> (f64, f64) {
        self.0.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let (Some(first), Some(_)) = (self.0.first().copied(), self.0.last()) else { return (0.0, 0.0) };
        let (mut covered, mut widest_gap) = (0.0, 0.0_f64);
        let mut end = first[0];
        for [from, to] in self.0 {
            widest_gap = widest_gap.max(from - end);
            covered += (to - from.max(end)).max(0.0);
            end = end.max(to);
        }
        widest_gap = widest_gap.max(first[0] + TAU - end);
        (covered, TAU - widest_gap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(arcs: &[[f64; 2]]) -> (f64, f64) {
        let mut all = Arcs::default();
        arcs.iter().for_each(|&arc| all.add(arc));
        all.measure()
    }

    #[test]
    fn arcs_join_across_north_and_count_once_where_they_overlap() {
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-12;
        assert!(near(measured(&[[-0.1, 0.2]]), (0.3, 0.3)));
        assert!(near(measured(&[[6.2, 6.4], [-0.3, 0.0], [0.5, 0.6]]), (0.3 + (6.4 - TAU) + 0.1, 0.9)));
        assert!(near(measured(&[[1.0, 2.0], [1.5, 1.7], [3.0, 3.5]]), (1.5, 2.5)));
        assert!(near(measured(&[[0.0, TAU], [1.0, 2.0]]), (TAU, TAU)));
        assert_eq!(measured(&[]), (0.0, 0.0));
    }

    #[test]
    fn a_piece_overhead_takes_every_azimuth_and_the_zenith() {
        let corners = [[-1.0, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, 2.0, 5.0]];
        let sky = sky_box(corners, [0.1, 0.1, 5.0]);
        assert!((sky.azimuths[1] - sky.azimuths[0] - TAU).abs() < 1e-12);
        assert!((sky.elevations[1] - PI / 2.0).abs() < 1e-12);
    }
}

//! Towers such as wind turbines and masts: how much of each is seen from many places, in visible metres.

use crate::targets::{Measure, ResultKind};
use belvedere_core::query::{Answer, EarthParams, MedialScene, VerticalLine};
use belvedere_data::control::Control;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Places handed to a thread at once: neighbours, which the same obstacles hide towers from.
const CHUNK: usize = 512;
/// Maximum number of schemes: a number of f32 holds as many bits.
pub const MAX_SCHEMES: usize = 24;

/// A tower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tower {
    /// Line from its foot to its tip, local metres.
    pub line: VerticalLine,
    /// Height of its hub above the foot, metres; `None` where it has none.
    pub hub: Option<f64>,
    /// Number of the scheme that it belongs to, below [`MAX_SCHEMES`].
    pub scheme: usize,
}

/// Parameters of views of towers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TowersParams {
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Horizontal distance up to which a tower counts, metres, above 0. Default: infinite.
    pub max_distance: f64,
    /// Test of pulses. Default: true.
    pub tests_proof: bool,
}

belvedere_data::setters!(TowersParams {
    with_earth(earth: EarthParams),
    with_max_distance(max_distance: f64),
    with_tests_proof(tests_proof: bool),
});

impl Default for TowersParams {
    fn default() -> Self {
        Self { earth: EarthParams::default(), max_distance: f64::INFINITY, tests_proof: true }
    }
}

/// The view of all towers from one place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TowersView {
    /// Number of towers of which a part is visible, of visible tips, and of visible hubs.
    pub counts: [u32; 3],
    /// Visible metres of all towers.
    pub metres: f64,
    /// Visible metres of the tower of which most is visible.
    pub max_metres: f64,
    /// Greatest angle between the lowest and the highest visible place of a tower, radians.
    pub angle: f64,
    /// Horizontal distance of the nearest visible tower, metres; 0 where none is visible.
    pub nearest: f64,
    /// Bit i: a part of a tower of scheme i is visible.
    pub schemes: u32,
    /// True if pulses do not prove the line of sight to the tower of which most is visible, to the middle of its
    /// highest visible part.
    pub is_unproven: bool,
}

/// Views of towers from many places.
#[derive(Clone, Debug, PartialEq)]
pub struct TowersSeen {
    /// The view from each place; `None` from one that is not finite.
    pub views: Vec<Option<TowersView>>,
    /// Number of places that see a part of each tower, its tip, and its hub.
    pub place_counts: Vec<[usize; 3]>,
}

/// The views of `towers` from `eyes`, (M, 3) local metres. An eye that is not finite sees nothing and has no view.
/// Progress counts eyes.
///
/// Visible metres are exact for the model ([`MedialScene::vertical_sight`]), over the terrain beyond the cloud where it
/// is known.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range, and [`Error::Cancelled`].
pub fn towers_seen(
    scene: &MedialScene,
    towers: &[Tower],
    eyes: &[[f32; 3]],
    params: &TowersParams,
    control: &Control<'_>,
) -> Result<TowersSeen> {
    params.earth.validate()?;
    if !(params.max_distance > 0.0) {
        return Err(Error::invalid(Parameter::MaxDistance, params.max_distance, "above zero metres"));
    }
    let of_chunk = |eyes: &[[f32; 3]]| {
        let mut part = PlacesPart::new(eyes, towers.len());
        for (number, tower) in towers.iter().enumerate() {
            control.check()?;
            part.look_at(scene, (number, tower), params);
        }
        if params.tests_proof && scene.proof().is_some() {
            part.test_proof(scene, &params.earth);
        }
        control.advance(eyes.len());
        Ok(part)
    };
    let parts: Vec<PlacesPart> = eyes.par_chunks(CHUNK).map(of_chunk).collect::<Result<_>>()?;
    let mut seen = TowersSeen { views: Vec::with_capacity(eyes.len()), place_counts: vec![[0; 3]; towers.len()] };
    for part in parts {
        for (sum, counts) in seen.place_counts.iter_mut().zip(&part.place_counts) {
            (0..3).for_each(|i| sum[i] += counts[i]);
        }
        seen.views.extend(part.places.into_iter().map(|place| Some(place?.view)));
    }
    Ok(seen)
}

/// Some of the places.
struct PlacesPart {
    /// `None` for an eye that is not finite.
    places: Vec<Option<SeeingPlace>>,
    /// Counts as those of [`TowersSeen`].
    place_counts: Vec<[usize; 3]>,
}

/// A place that looks at towers.
struct SeeingPlace {
    eye: [f64; 3],
    view: TowersView,
    /// Middle of the highest visible part of the tower of which most is visible, local metres.
    tested: [f64; 3],
}

impl PlacesPart {
    fn new(eyes: &[[f32; 3]], towers: usize) -> Self {
        let place = |eye: &[f32; 3]| {
            let (eye, view, tested) = (eye.map(f64::from), TowersView::default(), [f64::NAN; 3]);
            eye.iter().all(|v| v.is_finite()).then_some(SeeingPlace { eye, view, tested })
        };
        Self { places: eyes.iter().map(place).collect(), place_counts: vec![[0; 3]; towers] }
    }

    fn look_at(&mut self, scene: &MedialScene, (number, tower): (usize, &Tower), params: &TowersParams) {
        let VerticalLine { foot, height } = tower.line;
        let mut sight = scene.vertical_sight(tower.line, &params.earth);
        for SeeingPlace { eye, view, tested } in self.places.iter_mut().flatten() {
            let distance = (eye[0] - foot[0]).hypot(eye[1] - foot[1]);
            if distance > params.max_distance {
                continue;
            }
            let spans = sight.seen_from(*eye);
            let (Some(&[lowest, _]), Some(&[from, top])) = (spans.first(), spans.last()) else { continue };
            let metres: f64 = spans.iter().map(|[from, to]| to - from).sum();
            let hub = tower.hub.is_some_and(|hub| spans.iter().any(|[from, to]| *from <= hub && hub <= *to));
            for (i, is_seen) in [true, top >= height, hub].into_iter().enumerate() {
                view.counts[i] += u32::from(is_seen);
                self.place_counts[number][i] += usize::from(is_seen);
            }
            view.metres += metres;
            if metres > view.max_metres {
                view.max_metres = metres;
                *tested = [foot[0], foot[1], foot[2] + f64::midpoint(from, top)];
            }
            let elevation = |height: f64| (foot[2] + height - eye[2]).atan2(distance);
            view.angle = view.angle.max(elevation(top) - elevation(lowest));
            view.nearest = if view.nearest > 0.0 { view.nearest.min(distance) } else { distance };
            view.schemes |= 1 << tower.scheme.min(MAX_SCHEMES - 1);
        }
    }

    fn test_proof(&mut self, scene: &MedialScene, earth: &EarthParams) {
        for SeeingPlace { eye, view, tested } in self.places.iter_mut().flatten() {
            if view.max_metres > 0.0 {
                view.is_unproven = scene.far_sight_answer(*eye, *tested, earth) == Answer::Unproven;
            }
        }
    }
}

impl TowersSeen {
    /// The measures of all places, in the order in which they are written; `is_tested` where pulses were.
    #[must_use]
    pub fn measures(&self, towers: &[Tower], is_tested: bool) -> Vec<Measure> {
        let height: f64 = towers.iter().map(|tower| tower.line.height).sum();
        let column = |value: &dyn Fn(&TowersView) -> f64| -> Vec<f32> {
            self.views.iter().map(|view| view.as_ref().map_or(f32::NAN, |view| to_f32(value(view)))).collect()
        };
        let count = |name, i: usize, description| {
            let values = column(&|view| f64::from(view.counts[i]));
            Measure::new(name, values).with_description(description).with_decimals(0)
        };
        let length = |name, value: &dyn Fn(&TowersView) -> f64, description| {
            Measure::new(name, column(value)).with_description(description).with_unit("m").with_decimals(1)
        };
        let of_seen = |value: fn(&TowersView) -> f64| {
            move |view: &TowersView| if view.counts[0] > 0 { value(view) } else { f64::NAN }
        };
        let mut measures = vec![
            length("metres", &|view| view.metres, "visible metres of all towers"),
            Measure::new("share", column(&|view| view.metres / height))
                .with_description("visible share of all towers")
                .with_decimals(3)
                .with_range(Some([0.0, 1.0])),
            count("towers", 0, "towers with a visible part"),
            count("tips", 1, "visible tips"),
        ];
        if towers.iter().any(|tower| tower.hub.is_some()) {
            measures.push(count("hubs", 2, "visible hubs"));
        }
        measures.push(length("max_metres", &|view| view.max_metres, "most visible metres of a tower"));
        measures.push(
            Measure::new("angle_deg", column(&|view| view.angle.to_degrees()))
                .with_description("greatest vertical angle, deg")
                .with_unit("deg")
                .with_decimals(2),
        );
        measures.push(length("nearest_m", &of_seen(|view| view.nearest), "nearest visible tower, m"));
        if towers.iter().any(|tower| tower.scheme > 0) {
            let values = column(&|view| f64::from(view.schemes));
            measures.push(Measure::new("schemes", values).with_description("bits of visible schemes").with_decimals(0));
        }
        if is_tested {
            let values = column(&|view| f64::from(u8::from(view.is_unproven)));
            let measure = Measure::new("unproven", values).with_description("1: visible, but unproven");
            measures.push(measure.with_decimals(0).with_kind(ResultKind::Answer));
        }
        measures
    }
}

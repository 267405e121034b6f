//! Proof by pulses between their returns, on a crown whose shape is known.

use belvedere::control::Control;
use belvedere::medial::{CarvedParams, Rule};
use belvedere::model::{BallParams, BuildReport, ModelParams, OrientBy, SceneModel};
use belvedere::query::{Answer, UnprovenAs, Viewer, Visibility};
use belvedere::{Attributes, PointCloud};

/// Between pulses, metres; they fall straight down on 30 m by 30 m.
const SPACING: f32 = 0.5;
/// Middle, radius and height of the top of the crown.
const MIDDLE: [f32; 2] = [15.0, 15.0];
const RADIUS: f32 = 5.0;
const TOP: f32 = 8.0;

/// Fate of the second return of a pulse below the crown.
#[derive(Clone, Copy, PartialEq)]
enum Second {
    Kept,
    /// It is there, at a time of its own: nobody can say which pulse it is of.
    OfUnknownPulse,
    Missing,
}

/// Level ground below a dome of leaves that lets every pulse through.
fn survey(second: Second) -> PointCloud {
    let mut cloud = PointCloud::default();
    let mut columns = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut add = |p: [f32; 3], class: u8, [number, count]: [u8; 2], time: f64| {
        cloud.positions.push(p);
        columns.0.push(class);
        columns.1.push(number);
        columns.2.push(count);
        columns.3.push(time);
    };
    for row in 0..60_u16 {
        for column in 0..60_u16 {
            let [x, y] = [column, row].map(|step| (f32::from(step) + 0.5) * SPACING);
            let time = 1000.0 + f64::from(row * 60 + column) * 1e-3;
            let from_middle = (x - MIDDLE[0]).hypot(y - MIDDLE[1]);
            if from_middle < RADIUS {
                let count = if second == Second::Missing { 1 } else { 2 };
                add([x, y, TOP - 0.05 * from_middle * from_middle], 5, [1, count], time);
                let time = if second == Second::OfUnknownPulse { time + 100.0 } else { time };
                if second != Second::Missing {
                    add([x, y, 0.0], 2, [2, 2], time);
                }
            } else {
                add([x, y, 0.0], 2, [1, 1], time);
            }
        }
    }
    cloud.attributes = Attributes {
        classification: Some(columns.0),
        return_number: Some(columns.1),
        return_count: Some(columns.2),
        gps_time: Some(columns.3),
        ..Attributes::default()
    };
    cloud
}

/// The model of a survey from straight above.
fn built(cloud: &PointCloud, carved: CarvedParams) -> (SceneModel, BuildReport) {
    let scanner = cloud.positions.iter().map(|p| [p[0], p[1], 500.0]).collect();
    let params = ModelParams::default()
        .with_orient(OrientBy::ScannerOfEachPoint(scanner))
        .with_balls(BallParams::Carved(carved));
    SceneModel::build(cloud, &params, &Control::none()).unwrap()
}

/// Returns the answer for an eye that looks east below the crown, 1.5 m above the ground, along the line at `north`.
fn looking_east(model: &SceneModel, north: f32) -> Answer {
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    scene.visible(Viewer::Eye([8.0, f64::from(north), 1.5]), &[[22.0, north, 1.5]]).unwrap()[0]
}

#[test]
fn ways_between_returns_prove_what_lies_below_a_crown_but_not_where_its_stem_stands() {
    let answers = |second| {
        let (model, _) = built(&survey(second), CarvedParams::default());
        // beside the crown, 4 m from its middle, 2 m from it, and through it
        [22.0, 19.0, 17.0, 15.0].map(|north| looking_east(&model, north))
    };
    use Answer::{Unproven, Visible};
    assert_eq!(answers(Second::Missing), [Visible, Unproven, Unproven, Unproven]);
    assert_eq!(answers(Second::OfUnknownPulse), [Visible, Unproven, Unproven, Unproven]);
    assert_eq!(answers(Second::Kept), [Visible, Visible, Visible, Unproven]);
}

#[test]
fn ways_between_returns_do_not_carve() {
    // crowns are measured by the same pulses, so that their rule has to rest
    let carved = CarvedParams::default().without(Rule::Crowns);
    let [(with, of_with), (without, of_without)] =
        [Second::Kept, Second::OfUnknownPulse].map(|second| built(&survey(second), carved));
    let [with_count, without_count] = [of_with, of_without].map(|report| report.pulses.unwrap().between_returns);
    // about the top, 1.2 m in all directions, none is used
    assert!(without_count == 0 && (250..300).contains(&with_count), "{with_count}");
    assert_eq!(with.pulses().unwrap().starts.len(), without.pulses().unwrap().starts.len() + with_count);
    assert_eq!(with.balls().centers, without.balls().centers);
    assert_eq!(with.balls().radii, without.balls().radii);
}

#[test]
fn single_returns_are_saved_as_they_were() {
    let (model, report) = built(&survey(Second::Missing), CarvedParams::default());
    let pulses = model.pulses().unwrap();
    assert_eq!((report.pulses.unwrap().between_returns, pulses.starts.len()), (0, 3600));
    // columns that are needed only where pulses end below the top
    assert!(pulses.lengths.is_empty() && pulses.ways.is_empty());
}

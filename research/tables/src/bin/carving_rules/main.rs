//! What each rule of carved balls is worth: the same towns and questions with all rules, and with each left out.
//!
//! ```sh
//! cargo research carving_rules -- village,town,old-town,towers 1,2,3 [VARIANT,…] \
//!     [SCANNER] [unclassified] [water] [blame]
//! ```
//!
//! prints the table of docs/methods/carving.md. With a scanner of `cargo research compare -- --regimes`, such as
//! `leaves` or `bare`, the town and its survey are those of the comparison, and `unclassified` takes away the classes
//! of vegetation. With `water` pulses do not return from the ground in strips of 12 m. With `blame` it says which
//! surfaces hide what is called visible, at which surfaces the balls sit that hide what is visible, and what share of
//! these errors lies at edges or in space that no pulse came near. `-- figures FOLDER` draws its pictures.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod figures;
mod place;

use belvedere::Result;
use belvedere::control::Control;
use belvedere::medial::{CarvedParams, CrownParams, Rule, Trees};
use belvedere::model::BallParams;
use belvedere::query::{Answer, BlockRule, UnprovenAs, Visibility};
use belvedere_baselines::agreement::{Rate, TruthCounts};
use belvedere_baselines::medial::{MedialBaseline, MedialParams, Outward, scene_model};
use belvedere_baselines::simulated::preset;
use belvedere_scenes::{Preset, Regime};
use place::{CarvingSite, Missing, ViewerTargets};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

/// Everything, everything but one rule, and other ways to treat trees and targets near surfaces.
fn variants() -> Vec<(String, MedialParams)> {
    let all = MedialParams::carved();
    let carving = CarvedParams::default();
    let with = |name: &str, carving: CarvedParams| {
        (name.to_owned(), MedialParams { making: BallParams::Carved(carving), ..all })
    };
    let trees =
        |trees: Trees| CarvedParams { crowns: carving.crowns.map(|crowns| CrownParams { trees, ..crowns }), ..carving };
    let blocked = |name: &str, depth_bias: f64, shell: f64| {
        (name.to_owned(), MedialParams { blocking: BlockRule { bias: depth_bias, shell, ..all.blocking }, ..all })
    };
    let mut variants = vec![with("all", carving)];
    variants.extend(Rule::ALL.map(|rule| with(&format!("without {}", rule.name()), carving.without(rule))));
    let bare = Rule::ALL.into_iter().fold(carving, CarvedParams::without);
    variants.extend([
        with("carving alone", bare),
        with("trees opaque", trees(Trees::Opaque)),
        with("trees porous", trees(Trees::Porous)),
        blocked("a bias of 0.25 m instead of the shell", 0.25, 0.0),
        blocked("neither", 0.0, 0.0),
    ]);
    variants
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [command, folder] = &arguments[..]
        && command == "figures"
    {
        return figures::draw(Path::new(folder));
    }
    let has = |switch: &str| arguments.iter().any(|argument| argument == switch);
    let blames = has("blame");
    let missing = Missing { vegetation: has("unclassified"), water: has("water") };
    let named = |argument: &String| Regime::ALL.into_iter().find(|regime| regime.name() == argument);
    let regime = arguments.iter().find_map(named);
    let switches = ["blame", "unclassified", "water"];
    let is_switch = |argument: &String| switches.contains(&argument.as_str()) || named(argument).is_some();
    let lists: Vec<&String> = arguments.iter().filter(|argument| !is_switch(argument)).collect();
    let list = |index: usize, usual: &str| -> Vec<String> {
        let text = lists.get(index).map_or(usual, |list| list.as_str());
        text.split(',').filter(|part| !part.is_empty()).map(str::to_owned).collect()
    };
    let presets: Vec<Preset> =
        list(0, "village,town,old-town,towers").iter().map(|name| preset(name)).collect::<Result<_>>()?;
    let seeds: Vec<u64> = list(1, "7").iter().filter_map(|seed| seed.parse().ok()).collect();
    let wanted = list(2, "");

    let mut sums: BTreeMap<usize, Vec<Scores>> = BTreeMap::new();
    for &preset in &presets {
        for &seed in &seeds {
            let place = CarvingSite::simulated(preset, seed, regime, missing)?;
            for (number, (name, params)) in variants().into_iter().enumerate() {
                if !wanted.is_empty() && !wanted.contains(&name) {
                    continue;
                }
                let start = Instant::now();
                let model = MedialBaseline::new(&place.survey(), Outward::Survey, &params)?;
                let seconds = start.elapsed().as_secs_f64();
                let scores = judge(&place, &model, seconds)?;
                println!("{}-{seed} {name}: {scores}", preset.name());
                if blames {
                    let with_pulses = scene_model(&place.survey(), Outward::Survey, &params)?;
                    let with_pulses = with_pulses.scene(&params.blocking, UnprovenAs::Reported, &Control::none())?;
                    place.blame(&model, &with_pulses)?;
                }
                sums.entry(number).or_default().push(scores);
            }
        }
    }
    println!("\n| variant | {} |", Scores::HEADER);
    for (number, scores) in sums {
        println!("| {} | {} |", variants()[number].0, Scores::mean(&scores));
    }
    Ok(())
}

/// One line of the table.
#[derive(Clone, Default)]
struct Scores {
    values: Vec<f64>,
}

impl Scores {
    const HEADER: &str = "PED sun | fb | fv | AIR sun IoU | AIR eye IoU | ROOF | FACADE | PED eye | fb | fv | street mean | p10 | fb | fv | balls k | s";

    fn mean(all: &[Self]) -> Self {
        let count = all.len() as f64;
        let columns = all.first().map_or(0, |first| first.values.len());
        Self { values: (0..columns).map(|c| all.iter().map(|s| s.values[c]).sum::<f64>() / count).collect() }
    }
}

impl std::fmt::Display for Scores {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let values: Vec<String> = self.values.iter().map(|value| format!("{value:.1}")).collect();
        write!(f, "{}", values.join(" | "))
    }
}

/// Counts of one question.
fn counts(question: &ViewerTargets, answers: &[Answer]) -> TruthCounts {
    let mut counts = TruthCounts::default();
    question.visible.iter().zip(answers).for_each(|(&visible, &answer)| counts.add(visible, answer));
    counts
}

fn judge(place: &CarvingSite, model: &MedialBaseline, seconds: f64) -> Result<Scores> {
    let mean = |set: &str, views: &str, rate: Rate| -> Result<f64> {
        let mut values = Vec::new();
        for question in place.questions.iter().filter(|q| q.set == set && q.views == views) {
            let answers = model.visible(question.viewer, &place.targets[question.set])?;
            values.extend(rate.of(&counts(question, &answers)).map(|value| 100.0 * value));
        }
        Ok(values.iter().sum::<f64>() / values.len().max(1) as f64)
    };
    let mut street: Vec<[f64; 3]> = Vec::new();
    for question in place.questions.iter().filter(|q| q.views == "street") {
        let answers = model.visible(question.viewer, &place.targets[question.set])?;
        let counts = counts(question, &answers);
        let rates = [Rate::Balanced, Rate::FalseBlocked, Rate::FalseVisible];
        street.push(rates.map(|rate| rate.of(&counts).map_or(f64::NAN, |value| 100.0 * value)));
    }
    street.retain(|values| values[0].is_finite());
    street.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let over =
        |k: usize| street.iter().map(|values| values[k]).filter(|v| v.is_finite()).sum::<f64>() / street.len() as f64;
    Ok(Scores {
        values: vec![
            mean("PED", "suns", Rate::Balanced)?,
            mean("PED", "suns", Rate::FalseBlocked)?,
            mean("PED", "suns", Rate::FalseVisible)?,
            mean("AIR", "suns", Rate::BlockedIou)?,
            mean("AIR", "eyes", Rate::BlockedIou)?,
            mean("ROOF", "suns", Rate::Balanced)?,
            mean("FACADE", "suns", Rate::Balanced)?,
            mean("PED", "eyes", Rate::Balanced)?,
            mean("PED", "eyes", Rate::FalseBlocked)?,
            mean("PED", "eyes", Rate::FalseVisible)?,
            over(0),
            street.get(street.len() / 10).map_or(f64::NAN, |values| values[0]),
            over(1),
            over(2),
            model.scene().ball_count() as f64 / 1000.0,
            seconds,
        ],
    })
}

//! How likely answers are right: fits the scores of evidence, and measures what probabilities are worth.
//!
//! ```sh
//! cargo research confidence -- fit crates/belvedere-core/src/query/lines/confidence_scores.csv
//! cargo research confidence -- fit-sums crates/belvedere-apps/src/sum_errors.csv
//! cargo research confidence -- judge village,town,old-town,towers 201,202 10 air
//! cargo research confidence -- judge-sums village,town,old-town,towers 201 10 air
//! cargo research confidence -- judge-ways village,town,old-town,towers 201 10 air
//! ```
//!
//! `fit` and `fit-sums` write the scores and the errors of sums that the program uses; `fit-ground` writes new scores
//! of surveys from the ground alone. `judge`, `judge-sums` and
//! `judge-ways` (horizons and isovists) print the tables of docs/methods/confidence.md: kinds of towns, seeds, pulses
//! per m², scanners. No town of the tables was fitted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for tables talks")]

mod cases;
mod energies;
mod fit;
mod sums;
mod ways;

use belvedere::apps::calibration::Calibration;
use belvedere_baselines::simulated;
use belvedere_scenes::Regime;
use cases::{Case, SETS, TownSurvey};

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> AnyResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["fit", file] => {
            let [flown, from_ground] = [fit::flown_surveys(), fit::ground_surveys()];
            let cases = all_cases(&[flown, from_ground].concat())?;
            let scores = fit::scores(&cases)?;
            Ok(std::fs::write(file, fit::with_ground_scores(&scores, &cases))?)
        }
        ["fit-ground", file] => {
            let scores = std::fs::read_to_string(file)?;
            Ok(std::fs::write(file, fit::with_ground_scores(&scores, &all_cases(&fit::ground_surveys())?))?)
        }
        ["fit-sums", file] => {
            let cases = all(&fit::flown_surveys(), sums::cases)?;
            Ok(std::fs::write(file, sums::errors(&cases))?)
        }
        ["judge-sums", presets, seeds, densities, regimes] => {
            sums::judge(&all(&surveys(presets, seeds, densities, regimes)?, sums::cases)?);
            Ok(())
        }
        ["judge-ways", presets, seeds, densities, regimes] => {
            ways::judge(&all(&surveys(presets, seeds, densities, regimes)?, ways::cases)?);
            Ok(())
        }
        ["judge", presets, seeds, densities, regimes] => judge(presets, seeds, densities, regimes),
        _ => {
            Err("use: fit FILE, fit-ground FILE, fit-sums FILE, or judge, judge-sums or judge-ways PRESETS SEEDS DENSITIES SCANNERS"
                .into())
        }
    }
}

/// The cases of all surveys, one after the other.
fn all<T>(surveys: &[TownSurvey], cases: impl Fn(&TownSurvey) -> AnyResult<Vec<T>>) -> AnyResult<Vec<T>> {
    let mut found = Vec::new();
    for survey in surveys {
        eprintln!("{survey:?}");
        found.extend(cases(survey)?);
    }
    Ok(found)
}

fn all_cases(surveys: &[TownSurvey]) -> AnyResult<Vec<Case>> {
    all(surveys, |survey| Ok(survey.cases()?))
}

/// Every kind of town with every seed, density and scanner.
fn surveys(presets: &str, seeds: &str, densities: &str, regimes: &str) -> AnyResult<Vec<TownSurvey>> {
    let mut surveys = Vec::new();
    for density in densities.split(',') {
        for regime in regimes.split(',') {
            let regime = Regime::ALL.into_iter().find(|known| known.name() == regime).ok_or("no such scanner")?;
            for preset in presets.split(',') {
                let preset = simulated::preset(preset)?;
                for seed in seeds.split(',') {
                    surveys.push(TownSurvey { preset, seed: seed.parse()?, regime, pulses_per_m2: density.parse()? });
                }
            }
        }
    }
    Ok(surveys)
}

fn judge(presets: &str, seeds: &str, densities: &str, regimes: &str) -> AnyResult<()> {
    println!(
        "| pulses per m² | scanner | set | unknown | wrong | Brier: answer | probability | ECE | most certain: answer | probability |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut whole: Vec<Case> = Vec::new();
    for density in densities.split(',') {
        for regime in regimes.split(',') {
            let cases = all_cases(&surveys(presets, seeds, density, regime)?)?;
            print_rows(&format!("{density} | {regime}"), &cases);
            whole.extend(cases);
        }
    }
    print_rows("all | all", &whole);
    println!(
        "\n| set | {} |",
        (0..10).map(|tenth| format!("{:.1}", f64::from(tenth) / 10.0)).collect::<Vec<_>>().join(" | ")
    );
    for set in SETS {
        let tenths =
            calibration(&whole, |case| case.set == set && !case.evidence.is_unknown(), Case::probability).tenths();
        let cells = tenths.map(|t| format!("{:.1} → {:.1} ({})", 100.0 * t.expected, 100.0 * t.found, t.count));
        println!("| {} | {} |", set.name(), cells.join(" | "));
    }
    Ok(())
}

fn print_rows(name: &str, cases: &[Case]) {
    let known: Vec<Case> = cases.iter().filter(|case| !case.evidence.is_unknown()).cloned().collect();
    for set in SETS {
        let [all, with_probability] =
            [cases, &known].map(|cases| cases.iter().filter(|case| case.set == set).count() as f64);
        let [hard, found] = [Case::hard as fn(&Case) -> f32, Case::probability]
            .map(|probability| calibration(&known, |case| case.set == set, probability));
        println!(
            "| {name} | {} | {:.1} | {:.2} | {:.4} | {:.4} ({:+.0} %) | {:.2} | {:.2} | {:.2} |",
            set.name(),
            100.0 * (1.0 - with_probability / all),
            100.0 * hard.brier(),
            hard.brier(),
            found.brier(),
            100.0 * (found.brier() / hard.brier() - 1.0),
            100.0 * found.expected_error(),
            100.0 * hard.error_of_most_certain(),
            100.0 * found.error_of_most_certain()
        );
    }
}

fn calibration(cases: &[Case], counts: impl Fn(&Case) -> bool, probability: fn(&Case) -> f32) -> Calibration {
    let mut sums = Calibration::default();
    cases.iter().filter(|case| counts(case)).for_each(|case| sums.add(probability(case), case.is_visible));
    sums
}

impl Case {
    /// 1 where the answer is visible or unproven, 0 where it is blocked.
    fn hard(&self) -> f32 {
        f32::from(u8::from(self.evidence.lines.is_free))
    }

    fn probability(&self) -> f32 {
        self.evidence.probability()
    }
}

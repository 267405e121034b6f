//! Colours for numbers and classes.

use belvedere_data::cast::to_index;

/// Colour of a value between 0 and 1: dark violet over green to yellow, even in lightness and readable by the
/// colour-blind (viridis).
pub fn ramp(value: f64) -> [u8; 3] {
    let color = colorous::VIRIDIS.eval_continuous(value.clamp(0.0, 1.0));
    [color.r, color.g, color.b]
}

/// Colours of `values`, (N), such as heights: the lowest hundredth dark violet, the highest yellow, grey where a value
/// is not finite.
#[must_use]
pub fn ramp_colors(values: &[f32]) -> Vec<[u8; 3]> {
    let Some((low, high)) = percentiles(values, 0.01, 0.99) else { return vec![[128; 3]; values.len()] };
    let span = f64::from(high) - f64::from(low);
    values
        .iter()
        .map(|&v| match v.is_finite() {
            true if span > 0.0 => ramp((f64::from(v) - f64::from(low)) / span),
            true => ramp(0.5),
            false => [128; 3],
        })
        .collect()
}

/// Colour of an ASPRS class: ground brown, vegetation green, buildings red, water blue, others shades of grey and
/// violet.
#[must_use]
pub fn class_color(class: u8) -> [u8; 3] {
    match class {
        2 => [160, 120, 75],
        3 => [150, 200, 110],
        4 => [95, 170, 75],
        5 => [40, 125, 50],
        6 => [205, 80, 60],
        7 | 18 => [225, 0, 225],
        9 => [60, 130, 210],
        10 => [120, 105, 130],
        11 => [95, 95, 105],
        13..=16 => [230, 190, 60],
        17 => [140, 100, 170],
        _ => [165, 165, 170],
    }
}

/// The same colour in shadow: darker and bluer, as under a clear sky.
#[must_use]
pub fn in_shadow([red, green, blue]: [u8; 3]) -> [u8; 3] {
    // quarters in integers: 1/4 red, 1/4 green, 3/8 blue, and a little of the sky
    [red / 4 + 10, green / 4 + 12, blue / 4 + blue / 8 + 40]
}

/// The finite values at two shares of their order, or `None` without finite values.
pub fn percentiles(values: &[f32], low: f64, high: f64) -> Option<(f32, f32)> {
    let mut finite: Vec<f32> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let last = finite.len().checked_sub(1)?;
    let mut at = |share: f64| *finite.select_nth_unstable_by(to_index(last as f64 * share), f32::total_cmp).1;
    Some((at(low), at(high)))
}

//! Colours of what is uncertain.

use belvedere::cast::to_u8;

/// Colour of unproven answers, which are always uncertain.
pub(crate) const UNPROVEN_COLOR: [u8; 3] = [90, 150, 240];
/// Colour that others fade to, and the share of fading.
const PALE: [f32; 3] = [236.0, 236.0, 236.0];
const SHARE: f32 = 0.45;

/// The mixture of two colours, with a share of the second.
pub(crate) fn mixed(first: [u8; 3], second: [f32; 3], share: f32) -> [u8; 3] {
    std::array::from_fn(|i| to_u8((f32::from(first[i]) * (1.0 - share) + second[i] * share).round().into()))
}

/// The colour of an answer that is uncertain.
pub(crate) fn faded(color: [u8; 3]) -> [u8; 3] {
    mixed(color, PALE, SHARE)
}

/// Fades the colours of what is uncertain, but for what is unproven.
pub(crate) fn fade(colors: &mut [Option<[u8; 3]>], uncertain: &[f32]) {
    let of_uncertain = colors.iter_mut().zip(uncertain).filter(|(_, uncertain)| **uncertain > 0.0);
    of_uncertain.filter(|(color, _)| **color != Some(UNPROVEN_COLOR)).for_each(|(color, _)| *color = color.map(faded));
}

//! Colours of what is uncertain.

/// Colour of unproven answers, which are always uncertain.
pub(crate) const UNPROVEN_COLOR: [u8; 3] = [90, 150, 240];
/// Colour that others fade to, and the share of fading.
const PALE: [f32; 3] = [236.0, 236.0, 236.0];
const SHARE: f32 = 0.45;

/// The colour of an answer that is uncertain.
pub(crate) fn faded(color: [u8; 3]) -> [u8; 3] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two colours")]
    std::array::from_fn(|i| (f32::from(color[i]) * (1.0 - SHARE) + PALE[i] * SHARE).round() as u8)
}

/// Fades the colours of what is uncertain, but for what is unproven.
pub(crate) fn fade(colors: &mut [Option<[u8; 3]>], uncertain: &[f32]) {
    let of_uncertain = colors.iter_mut().zip(uncertain).filter(|(_, uncertain)| **uncertain > 0.0);
    of_uncertain.filter(|(color, _)| **color != Some(UNPROVEN_COLOR)).for_each(|(color, _)| *color = color.map(faded));
}

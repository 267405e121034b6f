//! Text in pictures, in Roboto.
//!
//! The font is built in, so that legends need no font file. It has Latin, Greek and Cyrillic letters and common signs.
//! A character that it lacks, such as an Arabic or a Chinese one, is drawn as a box.

use crate::picture::Picture;
use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};

/// Rows of a line of text at scale 1, pixels: capitals and what hangs below them.
pub(crate) const HEIGHT: usize = 8;

/// Roboto, see `fonts/LICENSE`.
const FONT: &[u8] = include_bytes!("../fonts/Roboto-Regular.ttf");
/// Height of the font at scale 1, from the top of the highest letters to the bottom of the lowest, pixels: its capitals
/// are then 7 pixels high.
const FONT_HEIGHT: f32 = 11.5;
/// Where letters stand at scale 1, pixels below the upper edge of a line.
const BASELINE: f32 = 7.0;

/// The glyphs of `text` at `scale`, from `x` and `y` on, and where the next would begin.
fn set(text: &str, x: f32, y: f32, scale: usize) -> (Vec<Glyph>, f32) {
    // the font was parsed by the tests
    let Ok(font) = FontRef::try_from_slice(FONT) else { return (Vec::new(), x) };
    let size = PxScale::from(FONT_HEIGHT * scale as f32);
    let font = font.as_scaled(size);
    let (mut glyphs, mut at, mut before) = (Vec::new(), x, None);
    for c in text.chars().filter(|c| !c.is_control()) {
        let id = font.glyph_id(c);
        at += before.map_or(0.0, |before| font.kern(before, id));
        glyphs.push(id.with_scale_and_position(size, point(at, y + BASELINE * scale as f32)));
        at += font.h_advance(id);
        before = Some(id);
    }
    (glyphs, at)
}

/// Width in pixels of `text` at `scale`.
pub(crate) fn text_width(text: &str, scale: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, `as` saturates")]
    let width = set(text, 0.0, 0.0, scale).1.ceil() as usize;
    width
}

/// Draws `text` with the upper left corner of its line at (`x`, `y`); what lies outside the picture is cut off.
pub(crate) fn draw_text(picture: &mut Picture, x: usize, y: usize, text: &str, scale: usize, color: [u8; 3]) {
    let Ok(font) = FontRef::try_from_slice(FONT) else { return };
    for outline in set(text, x as f32, y as f32, scale).0.into_iter().filter_map(|glyph| font.outline_glyph(glyph)) {
        let corner = outline.px_bounds().min;
        outline.draw(|column, row, cover| {
            let (column, row) = (corner.x + column as f32, corner.y + row as f32);
            if column < 0.0 || row < 0.0 {
                return;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, pixels")]
            let place = [column as usize, row as usize];
            let Some(paper) = picture.get(place[0], place[1]) else { return };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
            let mixed = |i: usize| {
                let cover = cover.clamp(0.0, 1.0);
                (f32::from(paper[i]) * (1.0 - cover) + f32::from(color[i]) * cover).round() as u8
            };
            picture.fill_rectangle(place, [1, 1], [0, 1, 2].map(mixed));
        });
    }
}

/// `text` cut with an ellipsis at the end so that it fits into `width` pixels.
pub(crate) fn fitted(text: &str, width: usize, scale: usize) -> String {
    if text_width(text, scale) <= width {
        return text.to_owned();
    }
    let mut kept = text.to_owned();
    while kept.pop().is_some() {
        let cut = format!("{}…", kept.trim_end());
        if text_width(&cut, scale) <= width {
            return cut;
        }
    }
    String::new()
}

/// `text` in lines that fit into `width` pixels, broken between words; a single word that does not fit is cut.
pub(crate) fn wrapped(text: &str, width: usize, scale: usize) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split_whitespace() {
        let Some(line) = lines.last_mut() else { break };
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if line.is_empty() || text_width(&longer, scale) <= width {
            *line = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.iter().map(|line| fitted(line, width, scale)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(text: &str) -> Picture {
        let mut picture = Picture::filled(400, 40, [255; 3]);
        draw_text(&mut picture, 2, 4, text, 3, [0; 3]);
        picture
    }

    #[test]
    fn letters_of_many_scripts_differ_and_what_the_font_lacks_is_a_box() {
        // letters of Latin, Greek and Cyrillic, and signs
        let letters = ["A", "É", "ß", "ő", "ệ", "Ω", "Ж", "ї", "°", "²", "€", "−"];
        let pictures = letters.map(drawn);
        let boxed = drawn("\u{4e2d}");
        for (i, picture) in pictures.iter().enumerate() {
            assert!(*picture != boxed && pictures[..i].iter().all(|other| other != picture), "{}", letters[i]);
        }
        assert_eq!(boxed, drawn("\u{6587}"));
        assert!(boxed.rgb.iter().any(|&v| v < 128) && drawn(" ").rgb.iter().all(|&v| v == 255));
    }

    #[test]
    fn text_stays_within_its_width_and_is_cut_to_fit() {
        for text in ["Sun hours, 21 June", "Stadtstraße 4", "Солнце", ""] {
            let width = text_width(text, 3);
            let picture = drawn(text);
            let inked = |column: usize| (0..40).any(|row| picture.get(column, row) != Some([255; 3]));
            assert!((width + 4..400).all(|column| !inked(column)), "{text}");
            assert!(text.is_empty() || (2..width + 2).any(inked), "{text}");
            // within the line of HEIGHT rows and a little above and below
            assert!((0..400).all(|column| picture.get(column, 0) == Some([255; 3])));
        }
        let cut = fitted("a title that is too long", 60, 2);
        assert!(cut.ends_with('…') && text_width(&cut, 2) <= 60, "{cut}");
        assert_eq!(fitted("short", 600, 2), "short");
        assert_eq!(fitted("anything", 0, 1), "");
        let title = "Sun hours, mean of days (Europe/Amsterdam)";
        let lines = wrapped(title, 200, 2);
        assert!(lines.len() > 1 && lines.iter().all(|line| text_width(line, 2) <= 200), "{lines:?}");
        assert_eq!(lines.join(" "), title);
        assert_eq!(wrapped("", 200, 2), [""]);
    }
}

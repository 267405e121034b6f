//! Text in pictures, in Roboto.
//!
//! The font is built in, so that legends need no font file. It has Latin, Greek and Cyrillic letters and common signs.
//! A character that it lacks, such as an Arabic or a Chinese one, is drawn as a box.

use crate::picture::Picture;
use ab_glyph_rasterizer::{Point, Rasterizer, point};
use belvedere_data::cast::{to_index, to_u8};
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::BoundingBox;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};

/// Rows of a line of text at scale 1, pixels: capitals and the descenders below them.
pub(crate) const HEIGHT: usize = 8;

/// Roboto, see `fonts/LICENSE`.
const FONT: &[u8] = include_bytes!("../fonts/Roboto-Regular.ttf");
/// Height of the font at scale 1, from the top of the highest letters to the bottom of the lowest, pixels: its capitals
/// are then 7 pixels high.
const FONT_HEIGHT: f32 = 11.5;
/// Baseline of letters at scale 1, pixels below the upper edge of a line.
const BASELINE: f32 = 7.0;

/// The font at a scale.
struct ScaledFont {
    font: FontRef<'static>,
    /// Pixels per unit of its outlines.
    pixels_per_unit: f32,
}

/// A letter of a line of text.
struct PlacedGlyph {
    id: GlyphId,
    /// Position on the line, pixels.
    x: f32,
}

impl ScaledFont {
    fn new(scale: usize) -> Option<Self> {
        // the font was parsed by the tests
        let font = FontRef::new(FONT).ok()?;
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        Some(Self { font, pixels_per_unit: FONT_HEIGHT * scale as f32 / (metrics.ascent - metrics.descent) })
    }

    /// The glyphs of `text` from `x` on, and where the next would begin.
    fn set(&self, text: &str, x: f32) -> (Vec<PlacedGlyph>, f32) {
        let (letters, metrics) =
            (self.font.charmap(), self.font.glyph_metrics(Size::unscaled(), LocationRef::default()));
        let (mut glyphs, mut x) = (Vec::new(), x);
        for c in text.chars().filter(|c| !c.is_control()) {
            // number 0 is the box
            let id = letters.map(c).unwrap_or_default();
            glyphs.push(PlacedGlyph { id, x });
            x += metrics.advance_width(id).unwrap_or(0.0) * self.pixels_per_unit;
        }
        (glyphs, x)
    }

    /// Returns the coverage of each pixel by a glyph on a line at `y`; `None` for one without ink.
    fn drawn(&self, glyph: &PlacedGlyph, y: f32) -> Option<GlyphPixels> {
        let outline = self.font.outline_glyphs().get(glyph.id)?;
        let bounds = self.font.glyph_metrics(Size::unscaled(), LocationRef::default()).bounds(glyph.id)?;
        let mut pen = GlyphPixels::around(bounds, [glyph.x, y], self.pixels_per_unit);
        outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), &mut pen).ok()?;
        Some(pen)
    }
}

/// The pixels of a glyph while its outline is drawn.
struct GlyphPixels {
    cover: Rasterizer,
    /// The upper left corner of the pixels in the picture.
    corner: [f32; 2],
    /// Position of the glyph in its pixels, and pixels per unit of the outline.
    place: [f32; 2],
    pixels_per_unit: f32,
    start: Point,
    last: Point,
}

impl GlyphPixels {
    /// Creates empty pixels around `bounds` of a glyph at `place`.
    fn around(bounds: BoundingBox, place: [f32; 2], pixels_per_unit: f32) -> Self {
        // y grows downwards in pictures; a pixel of room on all sides holds what is rounded
        let low = [place[0] + bounds.x_min * pixels_per_unit, place[1] - bounds.y_max * pixels_per_unit];
        let high = [place[0] + bounds.x_max * pixels_per_unit, place[1] - bounds.y_min * pixels_per_unit];
        let corner = low.map(|v| v.floor() - 1.0);
        let [width, height] = [0, 1].map(|i| to_index(f64::from(high[i].ceil() + 1.0 - corner[i])));
        Self {
            cover: Rasterizer::new(width, height),
            corner,
            place: [place[0] - corner[0], place[1] - corner[1]],
            pixels_per_unit,
            start: point(0.0, 0.0),
            last: point(0.0, 0.0),
        }
    }

    fn point(&self, x: f32, y: f32) -> Point {
        point(self.place[0] + x * self.pixels_per_unit, self.place[1] - y * self.pixels_per_unit)
    }
}

impl OutlinePen for GlyphPixels {
    fn move_to(&mut self, x: f32, y: f32) {
        self.start = self.point(x, y);
        self.last = self.start;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let end = self.point(x, y);
        self.cover.draw_line(self.last, end);
        self.last = end;
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        let end = self.point(x, y);
        self.cover.draw_quad(self.last, self.point(cx0, cy0), end);
        self.last = end;
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let end = self.point(x, y);
        self.cover.draw_cubic(self.last, self.point(cx0, cy0), self.point(cx1, cy1), end);
        self.last = end;
    }

    fn close(&mut self) {
        self.cover.draw_line(self.last, self.start);
        self.last = self.start;
    }
}

/// Width in pixels of `text` at `scale`.
pub(crate) fn text_width(text: &str, scale: usize) -> usize {
    to_index(f64::from(ScaledFont::new(scale).map_or(0.0, |font| font.set(text, 0.0).1).ceil()))
}

/// Draws `text` with the upper left corner of its line at (`x`, `y`); parts outside the picture are cut off.
pub(crate) fn draw_text(picture: &mut Picture, x: usize, y: usize, text: &str, scale: usize, color: [u8; 3]) {
    let Some(font) = ScaledFont::new(scale) else { return };
    let line = y as f32 + BASELINE * scale as f32;
    for glyph in font.set(text, x as f32).0.iter().filter_map(|glyph| font.drawn(glyph, line)) {
        let corner = glyph.corner;
        glyph.cover.for_each_pixel_2d(|column, row, cover| {
            let (column, row) = (corner[0] + column as f32, corner[1] + row as f32);
            if column < 0.0 || row < 0.0 {
                return;
            }
            let place = [to_index(f64::from(column)), to_index(f64::from(row))];
            let Some(paper) = picture.get(place[0], place[1]) else { return };
            let mixed = |i: usize| {
                let cover = cover.clamp(0.0, 1.0);
                to_u8(f64::from((f32::from(paper[i]) * (1.0 - cover) + f32::from(color[i]) * cover).round()))
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

//! Results as rasters: bands with names, of one pixel type and one value for no data for each kind of result, whoever
//! writes them.

use crate::apps::difference::described;
use crate::apps::targets::{Measure, ResultKind};
use crate::cast::to_u32;
use crate::error::check_length;
use crate::io::{
    BandLabel, BandValues, Bands, Georeference, MetadataTag, ReadBands, Source, read_tif_bands, write_cog,
    write_tif_bands,
};
use crate::raster::Raster;
use crate::{Error, Result};
use std::path::Path;

/// Name of the band of unproven answers. For one observer it is 1 where the first band is 1 without proof by pulses, 0
/// where it is proven or blocked. For several observers it is the number of counted ones that are not proven.
pub const UNPROVEN_BAND: &str = crate::apps::ask::UNPROVEN;

/// Name of the band that is 1 where a cell stands on an added mesh, and 0 elsewhere: there is no such place in the
/// scene as it is.
pub const ADDED_BAND: &str = "added";

/// The bands of a result, all of one kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Values of [`ResultKind::Answer`].
    Answers(Vec<Raster<u8>>),
    /// Values of [`ResultKind::Count`].
    Counts(Vec<Raster<u16>>),
    /// Values of [`ResultKind::Number`].
    Numbers(Vec<Raster<f32>>),
}

/// A result on the cells of a grid, as files hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultRaster {
    /// The values.
    pub pixels: Pixels,
    /// Labels of the bands.
    pub labels: Vec<BandLabel>,
    /// Metadata of the whole, such as the question.
    pub tags: Vec<MetadataTag>,
    /// Description of the values; may be empty.
    pub description: String,
}

impl Pixels {
    /// Returns the kind of the values.
    #[must_use]
    pub fn kind(&self) -> ResultKind {
        match self {
            Self::Answers(_) => ResultKind::Answer,
            Self::Counts(_) => ResultKind::Count,
            Self::Numbers(_) => ResultKind::Number,
        }
    }

    /// Bands without any value.
    #[must_use]
    pub fn nothing(kind: ResultKind, band_count: usize, [width, height]: [usize; 2]) -> Self {
        match kind {
            ResultKind::Answer => Self::Answers(vec![Raster::filled(width, height, ResultKind::NO_ANSWER); band_count]),
            ResultKind::Count => Self::Counts(vec![Raster::filled(width, height, ResultKind::NO_COUNT); band_count]),
            ResultKind::Number => Self::Numbers(vec![Raster::filled(width, height, ResultKind::NO_NUMBER); band_count]),
        }
    }

    /// A band for each measure; of different kinds all are numbers.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless each measure has a value for each cell.
    pub fn of_measures(measures: &[Measure], [width, height]: [usize; 2]) -> Result<Self> {
        let kind = measures.first().map_or(ResultKind::Number, |measure| measure.kind);
        let bands = measures.iter().map(|measure| measure.values.clone());
        let count = |value: f32| ResultKind::count(value.is_finite().then(|| to_u32(value.into())));
        let answer = |value: f32| ResultKind::answer(value.is_finite().then_some(value > 0.0));
        match kind {
            ResultKind::Answer if measures.iter().all(|measure| measure.kind == kind) => {
                Self::answers(bands.map(|band| band.into_iter().map(answer).collect()), [width, height])
            }
            ResultKind::Count if measures.iter().all(|measure| measure.kind == kind) => {
                Self::counts(bands.map(|band| band.into_iter().map(count).collect()), [width, height])
            }
            _ => Self::numbers(bands, [width, height]),
        }
    }

    /// Bands of answers, as [`ResultKind::answer`] makes them.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless each band has a value for each cell.
    pub fn answers(bands: impl IntoIterator<Item = Vec<u8>>, size: [usize; 2]) -> Result<Self> {
        Ok(Self::Answers(rasters(bands, size)?))
    }

    /// Bands of counts, as [`ResultKind::count`] makes them.
    ///
    /// # Errors
    /// Those of [`Pixels::answers`].
    pub fn counts(bands: impl IntoIterator<Item = Vec<u16>>, size: [usize; 2]) -> Result<Self> {
        Ok(Self::Counts(rasters(bands, size)?))
    }

    /// Bands of numbers; those that are not finite are none.
    ///
    /// # Errors
    /// Those of [`Pixels::answers`].
    pub fn numbers(bands: impl IntoIterator<Item = Vec<f32>>, size: [usize; 2]) -> Result<Self> {
        let stored = |band: Vec<f32>| band.into_iter().map(ResultKind::number).collect();
        Ok(Self::Numbers(rasters(bands.into_iter().map(stored), size)?))
    }

    /// Reads the bands of a raster of results.
    ///
    /// # Errors
    /// Those of [`read_tif_bands`].
    pub fn read(source: Source<'_>) -> Result<Self> {
        Ok(match read_tif_bands(source)? {
            ReadBands::U8(bands) => Self::Answers(bands),
            ReadBands::U16(bands) => Self::Counts(bands),
            ReadBands::F32(bands) => Self::Numbers(bands),
        })
    }

    /// Returns true if no band has a value.
    #[must_use]
    pub fn are_nothing(&self) -> bool {
        match self {
            Self::Answers(bands) => are_all(bands, ResultKind::NO_ANSWER),
            Self::Counts(bands) => are_all(bands, ResultKind::NO_COUNT),
            Self::Numbers(bands) => are_all(bands, ResultKind::NO_NUMBER),
        }
    }

    /// The bands as numbers, NaN where there is no value.
    ///
    /// # Errors
    /// Those of [`Raster::from_values`].
    pub fn to_numbers(&self) -> Result<Vec<Raster<f32>>> {
        match self {
            Self::Answers(bands) => bands.iter().map(|band| in_f32(band, ResultKind::NO_ANSWER)).collect(),
            Self::Counts(bands) => bands.iter().map(|band| in_f32(band, ResultKind::NO_COUNT)).collect(),
            Self::Numbers(bands) => bands.iter().map(|band| in_f32(band, ResultKind::NO_NUMBER)).collect(),
        }
    }

    /// Puts the values of a square tile at a column and row of these, which may lie beside them: what does is left out.
    /// `side` is that of the tile in cells.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for a tile of another kind, size or number of bands.
    pub fn put(&mut self, tile: &Self, place: [i64; 2], side: usize) -> Result<()> {
        match (self, tile) {
            (Self::Answers(all), Self::Answers(tile)) => put(all, tile, place, side),
            (Self::Counts(all), Self::Counts(tile)) => put(all, tile, place, side),
            (Self::Numbers(all), Self::Numbers(tile)) => put(all, tile, place, side),
            _ => Err(Error::LengthMismatch { what: "values of a tile", expected: side, found: 0 }),
        }
    }

    fn band_values(&self) -> BandValues<'_> {
        match self {
            Self::Answers(bands) => BandValues::U8(bands, ResultKind::NO_ANSWER),
            Self::Counts(bands) => BandValues::U16(bands, ResultKind::NO_COUNT),
            Self::Numbers(bands) => BandValues::F32(bands, ResultKind::NO_NUMBER),
        }
    }
}

impl ResultRaster {
    /// The measures of cells as bands: the first, and those that are further bands of it.
    ///
    /// # Errors
    /// Those of [`Pixels::of_measures`].
    pub fn of_measures(measures: &[Measure], size: [usize; 2]) -> Result<Self> {
        let description = measures.first().map(|first| described(first.description, &first.subject));
        let pixels = Pixels::of_measures(measures, size)?;
        let labels = measures.iter().map(label).collect();
        Ok(Self { pixels, labels, tags: Vec::new(), description: description.unwrap_or_default() })
    }

    /// This with metadata of the whole.
    #[must_use]
    pub fn with_tags(self, tags: &[MetadataTag]) -> Self {
        Self { tags: tags.to_vec(), ..self }
    }

    /// Writes it as a GeoTIFF.
    ///
    /// # Errors
    /// Those of [`write_tif_bands`].
    pub fn write(&self, path: &Path, place: Option<&Georeference>) -> Result<()> {
        write_tif_bands(path, &self.bands(), place)
    }

    /// Writes it as a cloud-optimised GeoTIFF.
    ///
    /// # Errors
    /// Those of [`write_cog`].
    pub fn write_cog(&self, path: &Path, place: &Georeference) -> Result<()> {
        write_cog(path, &self.bands(), place)
    }

    fn bands(&self) -> Bands<'_> {
        let description = (!self.description.is_empty()).then_some(self.description.as_str());
        Bands { values: self.pixels.band_values(), labels: &self.labels, tags: &self.tags, description }
    }
}

/// The label of the band of a measure.
fn label(measure: &Measure) -> BandLabel {
    BandLabel { tags: measure.tags.clone(), ..BandLabel::new(&measure.name, measure.unit) }
}

fn rasters<T: Copy>(bands: impl IntoIterator<Item = Vec<T>>, [width, height]: [usize; 2]) -> Result<Vec<Raster<T>>> {
    bands.into_iter().map(|band| Raster::from_values(width, height, band)).collect()
}

fn are_all<T: Copy + PartialEq>(bands: &[Raster<T>], nothing: T) -> bool {
    bands.iter().flat_map(Raster::values).all(|&value| value == nothing)
}

fn in_f32<T: Copy + PartialEq + Into<f32>>(raster: &Raster<T>, nothing: T) -> Result<Raster<f32>> {
    let number = |&value: &T| if value == nothing { f32::NAN } else { value.into() };
    Raster::from_values(raster.width(), raster.height(), raster.values().iter().map(number).collect())
}

fn put<T: Copy>(all: &mut [Raster<T>], tile: &[Raster<T>], [column, row]: [i64; 2], side: usize) -> Result<()> {
    check_length("bands of a tile", all.len(), tile.len())?;
    let count = |number: i64| usize::try_from(number).unwrap_or(0);
    for (all, tile) in all.iter_mut().zip(tile) {
        if tile.width() != side || tile.height() != side {
            return Err(Error::LengthMismatch { what: "columns of a tile", expected: side, found: tile.width() });
        }
        let width = all.width();
        // columns and rows of the tile that lie to the left of these and above
        let (left, above) = (count(-column), count(-row));
        for (number, values) in tile.values().chunks(side.max(1)).enumerate().skip(above) {
            let length = side.saturating_sub(left).min(width.saturating_sub(count(column)));
            let from = (count(row) + number - above) * width + count(column);
            let values = values.get(left..left + length).unwrap_or_default();
            if let Some(place) = all.values_mut().get_mut(from..from + values.len()) {
                place.copy_from_slice(values);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_of_a_tile_lies_beside_is_left_out() {
        let tile = Pixels::answers([(1..=9).collect()], [3, 3]).unwrap();
        for (place, expected) in [
            ([0, 0], [1, 2, 3, 255, 4, 5, 6, 255]),
            ([2, 1], [255, 255, 255, 255, 255, 255, 1, 2]),
            ([-2, -1], [6, 255, 255, 255, 9, 255, 255, 255]),
            ([-3, 0], [255; 8]),
            ([4, 0], [255; 8]),
            ([0, 2], [255; 8]),
            ([0, -3], [255; 8]),
        ] {
            let mut all = Pixels::nothing(ResultKind::Answer, 1, [4, 2]);
            all.put(&tile, place, 3).unwrap();
            assert_eq!(all, Pixels::answers([expected.to_vec()], [4, 2]).unwrap(), "{place:?}");
        }
    }
}

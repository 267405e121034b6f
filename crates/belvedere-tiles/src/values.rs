//! The values of a result, in a tile and in all.

use crate::question::ValueKind;
use belvedere::io::{
    CogValues, Georeference, Source, read_tif_f32, read_tif_u8, read_tif_u16, write_cog, write_tif_f32, write_tif_u8,
    write_tif_u16,
};
use belvedere::raster::Raster;
use belvedere::results::NO_VALUE;
use belvedere::{Error, Result};
use std::path::Path;

/// Code of a line of sight that missing tiles may block, beside 1 for lit or visible and 0 for not.
pub(crate) const UNPROVEN: u8 = 2;
const NO_CODE: u8 = u8::MAX;
const NO_COUNT: u16 = u16::MAX;

/// The values of the cells of a raster.
pub(crate) enum Values {
    Codes(Raster<u8>),
    Counts(Raster<u16>),
    Numbers(Raster<f32>),
}

impl ValueKind {
    /// How the format VRT calls it, and its value for no data.
    pub(crate) fn in_vrt(self) -> (&'static str, f64) {
        match self {
            Self::Codes => ("Byte", NO_CODE.into()),
            Self::Counts => ("UInt16", NO_COUNT.into()),
            Self::Numbers => ("Float32", NO_VALUE.into()),
        }
    }

    /// A raster without any value.
    pub(crate) fn nothing(self, width: usize, height: usize) -> Values {
        match self {
            Self::Codes => Values::Codes(Raster::filled(width, height, NO_CODE)),
            Self::Counts => Values::Counts(Raster::filled(width, height, NO_COUNT)),
            Self::Numbers => Values::Numbers(Raster::filled(width, height, NO_VALUE)),
        }
    }

    /// Reads the raster of a tile.
    ///
    /// # Errors
    /// Those of [`read_tif_u8`].
    pub(crate) fn read(self, tile: Source<'_>) -> Result<Values> {
        Ok(match self {
            Self::Codes => Values::Codes(read_tif_u8(tile)?),
            Self::Counts => Values::Counts(read_tif_u16(tile)?),
            Self::Numbers => Values::Numbers(read_tif_f32(tile)?),
        })
    }
}

impl Values {
    pub(crate) fn of_codes(width: usize, height: usize, codes: impl Iterator<Item = Option<u8>>) -> Result<Self> {
        let codes = codes.map(|code| code.unwrap_or(NO_CODE)).collect();
        Ok(Self::Codes(Raster::from_values(width, height, codes)?))
    }

    pub(crate) fn of_counts(width: usize, height: usize, counts: impl Iterator<Item = Option<u32>>) -> Result<Self> {
        let stored = |count: u32| u16::try_from(count).unwrap_or(NO_COUNT).min(NO_COUNT - 1);
        let counts = counts.map(|count| count.map_or(NO_COUNT, stored)).collect();
        Ok(Self::Counts(Raster::from_values(width, height, counts)?))
    }

    /// Numbers that are not finite have no value.
    pub(crate) fn of_numbers(width: usize, height: usize, numbers: impl Iterator<Item = f32>) -> Result<Self> {
        let numbers = numbers.map(|number| if number.is_finite() { number } else { NO_VALUE }).collect();
        Ok(Self::Numbers(Raster::from_values(width, height, numbers)?))
    }

    /// Whether no cell has a value.
    pub(crate) fn are_nothing(&self) -> bool {
        match self {
            Self::Codes(raster) => raster.values().iter().all(|&code| code == NO_CODE),
            Self::Counts(raster) => raster.values().iter().all(|&count| count == NO_COUNT),
            Self::Numbers(raster) => raster.values().iter().all(|&number| number == NO_VALUE),
        }
    }

    /// As numbers, NaN where there is no value.
    ///
    /// # Errors
    /// Those of [`Raster::from_values`].
    pub(crate) fn numbers(&self) -> Result<Raster<f32>> {
        match self {
            Self::Codes(raster) => numbers(raster, NO_CODE),
            Self::Counts(raster) => numbers(raster, NO_COUNT),
            Self::Numbers(raster) => numbers(raster, NO_VALUE),
        }
    }

    /// Puts the values of a tile at a column and row of this.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for a tile of other values or of another size than `side`.
    pub(crate) fn put(&mut self, tile: &Self, [column, row, side]: [usize; 3]) -> Result<()> {
        match (self, tile) {
            (Self::Codes(all), Self::Codes(tile)) => put(all, tile, [column, row, side]),
            (Self::Counts(all), Self::Counts(tile)) => put(all, tile, [column, row, side]),
            (Self::Numbers(all), Self::Numbers(tile)) => put(all, tile, [column, row, side]),
            _ => Err(Error::LengthMismatch { what: "values of a tile", expected: side, found: 0 }),
        }
    }

    /// Writes them as a cloud-optimised GeoTIFF; `what` says what they are.
    ///
    /// # Errors
    /// Those of [`write_cog`].
    pub(crate) fn write_cog(&self, path: &Path, place: &Georeference, what: &str) -> Result<()> {
        let values = match self {
            Self::Codes(raster) => CogValues::U8(raster, NO_CODE),
            Self::Counts(raster) => CogValues::U16(raster, NO_COUNT),
            Self::Numbers(raster) => CogValues::F32(raster, NO_VALUE),
        };
        write_cog(path, values, place, Some(what))
    }

    /// Writes them as a GeoTIFF; `what` says what they are.
    ///
    /// # Errors
    /// Those of [`write_tif_u8`].
    pub(crate) fn write(&self, path: &Path, place: &Georeference, what: &str) -> Result<()> {
        match self {
            Self::Codes(raster) => write_tif_u8(path, raster, Some(place), Some(NO_CODE), Some(what)),
            Self::Counts(raster) => write_tif_u16(path, raster, Some(place), Some(NO_COUNT), Some(what)),
            Self::Numbers(raster) => write_tif_f32(path, raster, Some(place), Some(NO_VALUE), Some(what)),
        }
    }
}

fn numbers<T: Copy + PartialEq + Into<f32>>(raster: &Raster<T>, nothing: T) -> Result<Raster<f32>> {
    let number = |&value: &T| if value == nothing { f32::NAN } else { value.into() };
    Raster::from_values(raster.width(), raster.height(), raster.values().iter().map(number).collect())
}

fn put<T: Copy>(all: &mut Raster<T>, tile: &Raster<T>, [column, row, side]: [usize; 3]) -> Result<()> {
    if tile.width() != side || tile.height() != side {
        return Err(Error::LengthMismatch { what: "columns of a tile", expected: side, found: tile.width() });
    }
    let width = all.width();
    for (number, values) in tile.values().chunks(side.max(1)).enumerate() {
        let from = (row + number) * width + column;
        if let Some(place) = all.values_mut().get_mut(from..from + values.len()) {
            place.copy_from_slice(values);
        }
    }
    Ok(())
}

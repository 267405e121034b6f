//! GPS times of LAZ points, decoded by a loop: the laz crate (0.13) decodes them by recursion, which damaged files
//! drive through the end of the stack (`docs/upstream.md`).
//!
//! Source: M. Isenburg, LASzip: lossless compression of LiDAR data, PE&RS 79(2), 2013, and files of LASzip 3. Times
//! follow up to four sequences, and each continues by about a multiple of its last difference.

use std::io::{self, Read};

use ::laz::decoders::ArithmeticDecoder;
use ::laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use ::laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use ::laz::record::FieldDecompressor;

/// Maximum and minimum multiple of the last difference that has a symbol of its own; symbols count from 0 to 500, then
/// from −1 to −10.
const GREATEST_MULTIPLE: i32 = 500;
const MIN_MULTIPLE: i32 = -10;
/// The first symbol behind those of multiples.
const AFTER_MULTIPLES: u32 = 511;
/// A sequence takes over a new difference after so many differences that no multiple describes well.
const MAX_EXTREMES: u32 = 3;

/// Coding of an unchanged time: formats 6 to 10 store it elsewhere.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SameTime {
    HasSymbol,
    IsStoredElsewhere,
}

/// Decoder of the times of one stream of points.
pub(super) struct GpsTimeDecoder {
    /// Times are the bits of a double, compared as integers.
    sequences: [TimeSequence; 4],
    current: usize,
    newest: usize,
    first_differences: ArithmeticModel,
    multiples: ArithmeticModel,
    differences: IntegerDecompressor,
    same_time: SameTime,
}

#[derive(Clone, Copy, Default)]
struct TimeSequence {
    time: i64,
    difference: i32,
    extremes: u32,
}

/// Meaning of a symbol for the next time.
enum Step {
    Same,
    /// The first difference of a sequence.
    First,
    /// About so many times the last difference.
    Multiple(i32),
    /// The time itself, which begins a sequence.
    Whole,
    /// The next symbol is about the sequence so many places on.
    Switch(usize),
}

impl GpsTimeDecoder {
    /// Times that go on from `first`.
    pub(super) fn new(first: i64, same_time: SameTime) -> Self {
        let mut sequences = [TimeSequence::default(); 4];
        sequences[0].time = first;
        let more = u32::from(same_time == SameTime::HasSymbol);
        Self {
            sequences,
            current: 0,
            newest: 0,
            first_differences: ArithmeticModelBuilder::new(5 + more).build(),
            multiples: ArithmeticModelBuilder::new(AFTER_MULTIPLES + 4 + more).build(),
            differences: IntegerDecompressorBuilder::new().bits(32).contexts(9).build_initialized(),
            same_time,
        }
    }

    /// The next time.
    ///
    /// # Errors
    ///
    /// Where the stream ends, or where it switches between sequences more often than there are any.
    pub(super) fn next<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<i64> {
        for _ in 0..self.sequences.len() {
            match self.step(decoder)? {
                Step::Switch(places) => {
                    self.current = (self.current + places) % self.sequences.len();
                    continue;
                }
                Step::Same => {}
                Step::First => {
                    let difference = self.differences.decompress(decoder, 0, 0)?;
                    let sequence = &mut self.sequences[self.current];
                    let time = sequence.time.wrapping_add(i64::from(difference));
                    *sequence = TimeSequence { time, difference, extremes: 0 };
                }
                Step::Multiple(multiple) => self.add_multiple(decoder, multiple)?,
                Step::Whole => {
                    let last = (self.sequences[self.current].time >> 32) as i32;
                    let upper = self.differences.decompress(decoder, last, 8)?;
                    let time = (i64::from(upper) << 32) | i64::from(decoder.read_int()?);
                    self.newest = (self.newest + 1) % self.sequences.len();
                    self.current = self.newest;
                    self.sequences[self.current] = TimeSequence { time, ..TimeSequence::default() };
                }
            }
            return Ok(self.sequences[self.current].time);
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "GPS times switch between sequences without end"))
    }

    fn step<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>) -> io::Result<Step> {
        let more = u32::from(self.same_time == SameTime::IsStoredElsewhere);
        if self.sequences[self.current].difference == 0 {
            return Ok(match decoder.decode_symbol(&mut self.first_differences)? + more {
                0 => Step::Same,
                1 => Step::First,
                2 => Step::Whole,
                symbol => Step::Switch(symbol as usize - 2),
            });
        }
        let symbol = decoder.decode_symbol(&mut self.multiples)?;
        let Some(other) = symbol.checked_sub(AFTER_MULTIPLES) else {
            let symbol = symbol as i32;
            return Ok(Step::Multiple(if symbol > GREATEST_MULTIPLE { GREATEST_MULTIPLE - symbol } else { symbol }));
        };
        Ok(match other + more {
            0 => Step::Same,
            1 => Step::Whole,
            symbol => Step::Switch(symbol as usize - 1),
        })
    }

    /// Goes on by `multiple` of the last difference and a correction, whose model depends on the multiple.
    fn add_multiple<R: Read>(&mut self, decoder: &mut ArithmeticDecoder<R>, multiple: i32) -> io::Result<()> {
        let context = match multiple {
            0 => 7,
            1 => 1,
            2..10 => 2,
            10..GREATEST_MULTIPLE => 3,
            GREATEST_MULTIPLE => 4,
            MIN_MULTIPLE => 6,
            _ => 5,
        };
        let sequence = &mut self.sequences[self.current];
        let expected = multiple.wrapping_mul(sequence.difference);
        let difference = self.differences.decompress(decoder, expected, context)?;
        sequence.time = sequence.time.wrapping_add(i64::from(difference));
        match multiple {
            1 => sequence.extremes = 0,
            0 | GREATEST_MULTIPLE | MIN_MULTIPLE if sequence.extremes == MAX_EXTREMES => {
                sequence.difference = difference;
                sequence.extremes = 0;
            }
            0 | GREATEST_MULTIPLE | MIN_MULTIPLE => sequence.extremes += 1,
            _ => {}
        }
        Ok(())
    }
}

/// The field of GPS times of point formats 1 and 3 to 5, in its second version (the first one has one sequence and no
/// recursion).
pub(super) struct GpsTimeField(GpsTimeDecoder);

impl GpsTimeField {
    pub(super) fn new() -> Self {
        Self(GpsTimeDecoder::new(0, SameTime::HasSymbol))
    }
}

impl<R: Read> FieldDecompressor<R> for GpsTimeField {
    fn size_of_field(&self) -> usize {
        8
    }

    fn decompress_first(&mut self, src: &mut R, first_point: &mut [u8]) -> io::Result<()> {
        let mut first = [0; 8];
        src.read_exact(&mut first)?;
        first_point.copy_from_slice(&first);
        self.0 = GpsTimeDecoder::new(i64::from_le_bytes(first), SameTime::HasSymbol);
        Ok(())
    }

    fn decompress_with(&mut self, decoder: &mut ArithmeticDecoder<R>, buf: &mut [u8]) -> io::Result<()> {
        buf.copy_from_slice(&self.0.next(decoder)?.to_le_bytes());
        Ok(())
    }
}

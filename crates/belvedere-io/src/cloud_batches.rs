//! Clouds too large for memory, some points at a time.

use std::collections::VecDeque;
use std::path::PathBuf;

use crate::files::source::Source;
#[cfg(feature = "las")]
use crate::las::{self, LasPoints};
use crate::points::assemble::assemble;
use crate::points::file_part::FilePart;
use crate::points::read_options::{ReadOptions, Reading, UpAxis};
use crate::read_cloud::{Systems, files_of, read_one};
use belvedere_data::cloud::PointCloud;
use belvedere_data::control::Control;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Frame, Parameter, Result};

/// Some points of a source.
#[derive(Clone, Debug)]
pub struct CloudBatch {
    /// The points.
    pub cloud: PointCloud,
    /// Path or name of the source that they come from.
    pub source: PathBuf,
    /// Row of each point among the points of its source, from 0, where [`ReadOptions::row_numbers`] requests it; empty
    /// otherwise.
    pub rows: Vec<u64>,
}

/// The points of sources, some at a time, all in one frame. Made by [`read_batches`].
pub struct CloudBatches<'a> {
    pending: VecDeque<Source<'a>>,
    options: ReadOptions,
    forced: Option<Crs>,
    control: Control<'a>,
    systems: Systems,
    #[cfg(feature = "las")]
    open: Option<(FilePart, LasPoints<'a>)>,
    failed: bool,
}

/// The points of `sources` in clouds of at most about a million points, in the order of the sources and their points.
///
/// All clouds have the frame of [`ReadOptions::frame`]. Without it, the first cloud sets the origin for all. Only LAS
/// and LAZ files are read in pieces; a source in another format is read whole and becomes one cloud.
///
/// Attributes are those of the file. [`crate::read_cloud`] decides from all points whether colours have 8 bits and
/// whether GPS times are of use; for LAS and LAZ files this is not decided here.
///
/// Batches without a point that the options ask for are skipped.
///
/// # Errors
/// Those of [`crate::read_cloud`], as the last item where they are found while reading.
pub fn read_batches<'a, S: Into<Source<'a>>>(
    sources: impl IntoIterator<Item = S>,
    options: &ReadOptions,
    control: &Control<'a>,
) -> Result<CloudBatches<'a>> {
    if options.up != UpAxis::Z {
        let value = "y".to_owned();
        return Err(Error::invalid(Parameter::UpAxis, value, "z for clouds in batches"));
    }
    let forced = options.forced_crs()?;
    let reading = Reading { options, forced: forced.as_ref(), control };
    let pending = files_of(sources.into_iter().map(Into::into), &reading)?.sources.into();
    Ok(CloudBatches {
        pending,
        forced,
        systems: Systems::new(options),
        options: options.clone(),
        control: *control,
        #[cfg(feature = "las")]
        open: None,
        failed: false,
    })
}

impl CloudBatches<'_> {
    /// The frame of all clouds; `None` before the first where the options give none.
    #[must_use]
    pub fn frame(&self) -> Option<&Frame> {
        self.options.frame.as_ref()
    }

    /// The next points, possibly none, or `None` at the end.
    fn next_part(&mut self) -> Result<Option<FilePart>> {
        self.control.check()?;
        let reading = Reading { options: &self.options, forced: self.forced.as_ref(), control: &self.control };
        #[cfg(feature = "las")]
        if let Some((whole, points)) = &mut self.open {
            if let Some(some) = points.next(&reading)? {
                let mut part = FilePart::new(&whole.report.path, whole.report.format.clone());
                part.crs = whole.crs.clone();
                part.row_count = whole.row_count;
                part.other_attributes = whole.other_attributes.clone();
                part.records = whole.records.clone();
                (part.coordinates, part.attributes, part.rows) = (some.coordinates, some.attributes, Some(some.rows));
                return Ok(Some(part));
            }
            self.open = None;
        }
        let Some(source) = self.pending.pop_front() else { return Ok(None) };
        #[cfg(feature = "las")]
        if matches!(source.extension().as_str(), "las" | "laz") && source.folder().is_none() {
            let (mut whole, points) = las::open(source, &reading)?;
            self.systems.accept(&mut whole, &reading)?;
            self.open = Some((whole, points));
            return self.next_part();
        }
        let mut part = read_one(source, &reading)?;
        self.systems.accept(&mut part, &reading)?;
        part.check_attributes();
        Ok(Some(part))
    }

    fn next_batch(&mut self) -> Result<Option<CloudBatch>> {
        while let Some(part) = self.next_part()? {
            if part.coordinates.len() == 0 {
                continue;
            }
            let source = part.report.path.clone();
            match assemble(vec![part], &self.options) {
                Ok((cloud, report)) => {
                    if self.options.frame.as_ref().is_none_or(|frame| *frame != cloud.frame) {
                        self.options.frame = Some(cloud.frame.clone());
                    }
                    return Ok(Some(CloudBatch { cloud, source, rows: report.rows }));
                }
                // every point of the batch was far away or not finite
                Err(Error::NoPoints { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }
}

impl Iterator for CloudBatches<'_> {
    type Item = Result<CloudBatch>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let next = self.next_batch().transpose();
        self.failed = matches!(next, None | Some(Err(_)));
        next
    }
}

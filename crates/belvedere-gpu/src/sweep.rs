//! Sweeps on a device: layers, places and headings as words, and the words that come back. The arithmetic is in `sweep.wgsl`.

use crate::device::Device;
use belvedere_core::query::cpu::{Heading, Place, SpaceLayers, Swept};
use belvedere_data::control::Control;
use belvedere_data::{Error, Result};

/// Targets of a group of threads.
const GROUP: usize = 64;
/// Steps of lines of sight in a piece of work: below a tenth of a second on a small device, so that its picture does not freeze and no driver
/// gives it up; a large one does as many in a millisecond.
const MOST_STEPS: usize = 1 << 29;
/// Bytes of a table, or of results, that are made at a time.
const MOST_BYTES: usize = 1 << 25;
/// Bytes of a place.
const PLACE_BYTES: usize = 20;
/// Bytes of `Space` in the shader.
const SPACE_BYTES: usize = 32;
/// Height of a place that is too far from the layers, as in the shader.
const NOWHERE: i32 = -i32::MAX;
/// Most layers: with more, moves of lines of sight would not fit.
const MOST_LAYERS: usize = 4096;

/// A device with the shader.
#[derive(Debug)]
pub(crate) struct Sweeper {
    pub(crate) device: Device,
    pipeline: wgpu::ComputePipeline,
}

/// Layers in the memory of a device.
#[derive(Debug)]
pub(crate) struct Loaded {
    reached: wgpu::Buffer,
    filled: wgpu::Buffer,
}

/// Headings that are swept together, as the shader reads them.
#[derive(Default)]
struct Tables {
    headings: Vec<u8>,
    starts: Vec<u8>,
    moves: Vec<u8>,
    /// Moves of each heading.
    counts: Vec<usize>,
}

impl Sweeper {
    /// # Errors
    /// [`Error::Device`] where the device cannot run the shader.
    pub(crate) fn new(device: Device) -> Result<Self> {
        let module = device.device.create_shader_module(wgpu::include_wgsl!("sweep.wgsl"));
        let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("sweep"),
            layout: None,
            module: &module,
            entry_point: Some("sweep"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        device.trouble.check()?;
        Ok(Self { device, pipeline })
    }

    /// Brings layers into the memory of the device.
    ///
    /// # Errors
    /// [`Error::Device`] where they do not fit.
    pub(crate) fn load(&self, space: &SpaceLayers) -> Result<Loaded> {
        let bytes = 8 * space.reached.len() as u64;
        let most = self.device.info.most_bytes;
        if bytes > most {
            let what = format!("the scene takes {bytes} bytes of a device that allows {most}");
            return Err(Error::Device { what });
        }
        if space.size[2] > MOST_LAYERS {
            let what = format!("the scene is too high for the device: {} layers", space.size[2]);
            return Err(Error::Device { what });
        }
        let words = |bits: &[u64]| self.filled_buffer(8 * bits.len(), bits.iter().flat_map(|word| word.to_le_bytes()));
        let loaded = Loaded { reached: words(&space.reached), filled: words(&space.filled) };
        self.device.trouble.check()?;
        Ok(loaded)
    }

    /// Sweeps `headings`: the same bits as [`sweep_all`](belvedere_core::query::cpu::sweep_all). What is finished goes to `done` heading by heading.
    ///
    /// # Errors
    /// [`Error::Cancelled`], and [`Error::Device`] where the device fails: what was handed to `done` before is right.
    pub(crate) fn sweep(
        &self,
        space: &SpaceLayers,
        loaded: &Loaded,
        places: &[Option<Place>],
        headings: &[Heading],
        control: &Control<'_>,
        done: &mut dyn FnMut(Swept),
    ) -> Result<()> {
        if places.is_empty() {
            headings.iter().for_each(|_| done(Swept { free: Vec::new(), blocked: Vec::new() }));
            return Ok(());
        }
        let place_bytes = places.iter().flat_map(|place| of_place(*place));
        if PLACE_BYTES * places.len() > self.limit() {
            return Err(Error::Device {
                what: format!("{} targets at once are too many for the device", places.len()),
            });
        }
        let on_device = self.filled_buffer(PLACE_BYTES * places.len(), place_bytes);
        let word_count = 2 * places.len().div_ceil(GROUP);
        let mut rest = headings;
        while !rest.is_empty() {
            let tables = Tables::of(rest, space.size[2], MOST_BYTES.min(self.limit()), 4 * word_count);
            let count = tables.counts.len();
            let [free, blocked] = self.run(space, loaded, &on_device, places.len(), &tables, control)?;
            for (free, blocked) in free.chunks(word_count).zip(blocked.chunks(word_count)) {
                done(Swept { free: joined(free, places.len()), blocked: joined(blocked, places.len()) });
            }
            rest = rest.get(count..).unwrap_or_default();
        }
        Ok(())
    }

    fn limit(&self) -> usize {
        usize::try_from(self.device.info.most_bytes).unwrap_or(usize::MAX)
    }

    /// The words of free and of blocked lines, heading after heading.
    fn run(
        &self,
        space: &SpaceLayers,
        loaded: &Loaded,
        places: &wgpu::Buffer,
        place_count: usize,
        tables: &Tables,
        control: &Control<'_>,
    ) -> Result<[Vec<u32>; 2]> {
        let device = &self.device.device;
        let word_count = 2 * place_count.div_ceil(GROUP);
        let bytes = 4 * (word_count * tables.counts.len()) as u64;
        let result = || {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("results"),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        };
        let [free, blocked] = [result(), result()];
        let read_back = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("results on their way back"),
            size: 2 * bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("space"),
            size: SPACE_BYTES as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let table = |bytes: &[u8]| self.filled_buffer(bytes.len(), bytes.iter().copied());
        let [headings, starts, moves] = [&tables.headings, &tables.starts, &tables.moves].map(|bytes| table(bytes));
        self.device.trouble.check()?;
        let buffers = [&uniform, &loaded.reached, &loaded.filled, places, &headings, &starts, &moves, &free, &blocked];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("sweep"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut before = None;
        for piece in pieces(place_count, &tables.counts) {
            control.check()?;
            self.device.queue.write_buffer(&uniform, 0, &space_words(space, place_count, word_count, &piece));
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &bindings, &[]);
                pass.dispatch_workgroups(whole(piece.group_count), whole(piece.heading_count), 1);
            }
            let this = self.device.queue.submit([encoder.finish()]);
            // two pieces are under way at a time, so that the device does not wait
            if let Some(before) = before.replace(this) {
                self.wait_for(Some(before))?;
            }
            self.device.trouble.check()?;
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&free, 0, &read_back, 0, bytes);
        encoder.copy_buffer_to_buffer(&blocked, 0, &read_back, bytes, bytes);
        self.device.queue.submit([encoder.finish()]);
        read_back.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.wait_for(None)?;
        self.device.trouble.check()?;
        let words = |from: u64| -> Result<Vec<u32>> {
            let bytes = read_back
                .slice(from..from + bytes)
                .get_mapped_range()
                .map_err(|error| Error::Device { what: format!("no results come back: {error}") })?;
            Ok(bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
        };
        Ok([words(0)?, words(bytes)?])
    }

    fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let until = wgpu::PollType::Wait { submission_index, timeout: None };
        match self.device.device.poll(until) {
            Ok(_) => self.device.trouble.check(),
            Err(error) => Err(Error::Device { what: format!("the device does not answer: {error}") }),
        }
    }

    /// A buffer of `size` bytes that shaders read. On a device without memory left it holds nothing, and the trouble is noted.
    fn filled_buffer(&self, size: usize, bytes: impl Iterator<Item = u8>) -> wgpu::Buffer {
        let buffer = self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            // none is empty
            size: size.next_multiple_of(16).max(16) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut bytes = bytes.peekable();
        let mut at = 0;
        while bytes.peek().is_some() {
            let part: Vec<u8> = bytes.by_ref().take(MOST_BYTES).collect();
            self.device.queue.write_buffer(&buffer, at, &part);
            at += part.len() as u64;
        }
        buffer
    }
}

impl Tables {
    /// As many of `headings` as fit into tables of `most` bytes where each has `result_bytes` of results; one at least.
    fn of(headings: &[Heading], depth: usize, most: usize, result_bytes: usize) -> Self {
        let mut tables = Self::default();
        let mut of_layer = Vec::new();
        for heading in headings {
            let is_full = (tables.counts.len() + 1) * result_bytes > most || tables.moves.len() > most / 2;
            if !tables.counts.is_empty() && is_full {
                break;
            }
            let first = tables.moves.len() / 8;
            let first_start = whole(tables.starts.len() / 4).cast_signed();
            let numbers = [heading.slope[0], heading.slope[1], heading.rise, first_start];
            tables.headings.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            for layer in 0..=depth {
                tables.starts.extend(whole(tables.moves.len() / 8).to_le_bytes());
                if layer < depth {
                    heading.moves_in(layer, &mut of_layer);
                    tables.moves.extend(of_layer.iter().flatten().flat_map(|by| near(*by).to_le_bytes()));
                }
            }
            tables.counts.push(tables.moves.len() / 8 - first);
        }
        tables
    }
}

/// A piece of work: some groups of places and some headings.
struct Piece {
    first_group: usize,
    group_count: usize,
    first_heading: usize,
    heading_count: usize,
}

/// Work in pieces of at most [`MOST_STEPS`], or of one group and one heading.
fn pieces(place_count: usize, counts: &[usize]) -> Vec<Piece> {
    /// Groups along an axis that every device allows.
    const MOST_GROUPS: usize = 65_535;
    let group_count = place_count.div_ceil(GROUP);
    let mut pieces = Vec::new();
    let mut first_heading = 0;
    while first_heading < counts.len() {
        let mut steps = 0;
        let fitting = counts[first_heading..].iter().take(MOST_GROUPS).take_while(|count| {
            steps += **count * place_count;
            steps <= MOST_STEPS
        });
        let heading_count = fitting.count().max(1);
        let steps: usize = counts[first_heading..first_heading + heading_count].iter().sum();
        let most = MOST_STEPS.div_ceil(GROUP * steps.max(1)).min(MOST_GROUPS);
        for first_group in (0..group_count).step_by(most) {
            let group_count = most.min(group_count - first_group);
            pieces.push(Piece { first_group, group_count, first_heading, heading_count });
        }
        first_heading += heading_count;
    }
    pieces
}

/// `Space` of the shader.
fn space_words(space: &SpaceLayers, place_count: usize, word_count: usize, piece: &Piece) -> Vec<u8> {
    let [x, y, z] = space.size;
    let words = [x, y, z, 2 * space.width, place_count, piece.first_heading, word_count, 2 * piece.first_group];
    words.iter().flat_map(|word| whole(*word).to_le_bytes()).collect()
}

/// `Place` of the shader.
fn of_place(place: Option<Place>) -> [u8; PLACE_BYTES] {
    let Place { across, height } = place.unwrap_or(Place { across: [0; 2], height: NOWHERE });
    let mut bytes = [0; PLACE_BYTES];
    for (bytes, along) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(across) {
        // the high word first
        *bytes = along.rotate_right(32).to_le_bytes();
    }
    bytes[16..].copy_from_slice(&height.to_le_bytes());
    bytes
}

/// Words of 32 bits as words of 64, as many as `bit_count` bits need.
fn joined(words: &[u32], bit_count: usize) -> Vec<u64> {
    let pairs = words.as_chunks::<2>().0.iter();
    pairs.map(|[low, high]| u64::from(*low) | u64::from(*high) << 32).take(bit_count.div_ceil(64)).collect()
}

/// A count that is known to be small: tables are bounded by [`MOST_BYTES`], places and cells by the size of buffers.
fn whole(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Cells that a line moves on in [`MOST_LAYERS`] layers.
fn near(cells: i64) -> i32 {
    i32::try_from(cells).unwrap_or(i32::MAX)
}

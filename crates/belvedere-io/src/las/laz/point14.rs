//! The common fields of LAZ points of formats 6 to 10, which are stored in nine layers.
//!
//! The laz crate (0.13) has the same decoder, but decodes GPS times by recursion (`gps_times.rs`). It cannot be
//! replaced separately: the first layer, with the coordinates, tells whether a point has a new time.
//!
//! Source: the output of LASzip 3 for the item "Point14", versions 3 and 4.

#![expect(
    clippy::cast_possible_truncation,
    reason = "symbols fit their fields, and 16-bit numbers wrap around as in LASzip"
)]

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use ::laz::DecompressionSelection;
use ::laz::decoders::ArithmeticDecoder;
use ::laz::decompressors::{IntegerDecompressor, IntegerDecompressorBuilder};
use ::laz::models::{ArithmeticModel, ArithmeticModelBuilder};
use ::laz::record::LayeredFieldDecompressor;

use super::gps_times::{GpsTimeDecoder, SameTime};

/// Bytes of the fields.
const SIZE: usize = 30;
const LAYERS: usize = 9;

/// Changes from one point of a channel to the next, besides coordinates: bits of the first symbol of a point. The
/// lowest two bits give the change of the return number.
const RETURN_COUNT: u32 = 1 << 2;
const SCAN_ANGLE: u32 = 1 << 3;
const TIME: u32 = 1 << 4;
const SOURCE: u32 = 1 << 5;
const CHANNEL: u32 = 1 << 6;

/// Index of the median of differences of coordinates for a point, by number of returns and return number.
const MEDIANS: [[u8; 16]; 16] = [
    [0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5],
    [1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3],
    [2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3],
    [3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4],
    [4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4],
    [5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4],
    [3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4],
    [4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4],
    [4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4],
    [5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4],
    [5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4],
    [5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4],
    [5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4],
    [5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4],
    [5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5],
    [5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5],
];

/// Decoder of the fields of the points of a chunk.
pub(super) struct Point14Field {
    version: u16,
    wanted: [bool; LAYERS],
    sizes: [u32; LAYERS],
    /// `None` where a layer is empty, as all points have the value of the first one, or is not wanted.
    layers: [Option<Layer>; LAYERS],
    /// Each channel of a scanner goes on from its own last point.
    channels: [Option<Box<Channel>>; 4],
    channel: usize,
}

type Layer = ArithmeticDecoder<Cursor<Vec<u8>>>;

struct Channel {
    last: Point,
    /// True if the last point had a new time.
    new_time: bool,
    x_medians: [Median; 12],
    y_medians: [Median; 12],
    heights: [i32; 8],
    intensities: [u16; 8],
    times: GpsTimeDecoder,
    changes: Models<8>,
    channel_steps: ArithmeticModel,
    return_counts: Models<16>,
    return_numbers: Models<16>,
    return_steps: ArithmeticModel,
    classes: Models<64>,
    flags: Models<64>,
    users: Models<64>,
    x: IntegerDecompressor,
    y: IntegerDecompressor,
    z: IntegerDecompressor,
    intensity: IntegerDecompressor,
    scan_angle: IntegerDecompressor,
    source: IntegerDecompressor,
}

/// The fields, in the order of LAS 1.4 R15, table 15.
#[derive(Clone, Copy)]
struct Point {
    x: i32,
    y: i32,
    z: i32,
    intensity: u16,
    return_number: u8,
    return_count: u8,
    /// Flags of the class, channel, direction of the mirror, edge of the flight line.
    flags: u8,
    class: u8,
    user: u8,
    scan_angle: i16,
    source: u16,
    /// Bits of a double.
    time: i64,
}

impl Point {
    fn from_bytes(bytes: &[u8; SIZE]) -> Self {
        let two = |at: usize| [bytes[at], bytes[at + 1]];
        let four = |at: usize| i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        let [.., a, b, c, d, e, f, g, h] = *bytes;
        Self {
            x: four(0),
            y: four(4),
            z: four(8),
            intensity: u16::from_le_bytes(two(12)),
            return_number: bytes[14] & 15,
            return_count: bytes[14] >> 4,
            flags: bytes[15],
            class: bytes[16],
            user: bytes[17],
            scan_angle: i16::from_le_bytes(two(18)),
            source: u16::from_le_bytes(two(20)),
            time: i64::from_le_bytes([a, b, c, d, e, f, g, h]),
        }
    }

    fn write(&self, bytes: &mut [u8]) {
        let Some(bytes) = bytes.first_chunk_mut::<SIZE>() else { return };
        bytes[..4].copy_from_slice(&self.x.to_le_bytes());
        bytes[4..8].copy_from_slice(&self.y.to_le_bytes());
        bytes[8..12].copy_from_slice(&self.z.to_le_bytes());
        bytes[12..14].copy_from_slice(&self.intensity.to_le_bytes());
        bytes[14] = self.return_count << 4 | self.return_number;
        bytes[15] = self.flags;
        bytes[16] = self.class;
        bytes[17] = self.user;
        bytes[18..20].copy_from_slice(&self.scan_angle.to_le_bytes());
        bytes[20..22].copy_from_slice(&self.source.to_le_bytes());
        bytes[22..].copy_from_slice(&self.time.to_le_bytes());
    }

    fn channel(&self) -> usize {
        usize::from(self.flags >> 4 & 3)
    }

    /// Sum of `first` for a first return and `last` for a last one; 0 for an intermediate return.
    fn place_of_return(&self, first: u8, last: u8) -> u8 {
        u8::from(self.return_number == 1) * first + u8::from(self.return_number >= self.return_count) * last
    }
}

impl Channel {
    /// A channel that goes on from `last`.
    fn new(last: Point) -> Self {
        let integers =
            |bits, contexts| IntegerDecompressorBuilder::new().bits(bits).contexts(contexts).build_initialized();
        Self {
            last,
            new_time: false,
            x_medians: [Median::default(); 12],
            y_medians: [Median::default(); 12],
            heights: [last.z; 8],
            intensities: [last.intensity; 8],
            times: GpsTimeDecoder::new(last.time, SameTime::IsStoredElsewhere),
            changes: Models::new(128),
            channel_steps: ArithmeticModelBuilder::new(3).build(),
            return_counts: Models::new(16),
            return_numbers: Models::new(16),
            return_steps: ArithmeticModelBuilder::new(13).build(),
            classes: Models::new(256),
            flags: Models::new(64),
            users: Models::new(256),
            x: integers(32, 2),
            y: integers(32, 22),
            z: integers(32, 20),
            intensity: integers(16, 4),
            scan_angle: integers(16, 2),
            source: integers(16, 1),
        }
    }

    /// Decodes the rest of a point, after its `changes` and its channel.
    fn decode(&mut self, changes: u32, layers: &mut [Option<Layer>; LAYERS]) -> io::Result<()> {
        let [first, z, classes, flags, intensities, scan_angles, users, sources, times] = layers;
        let first = first.as_mut().ok_or_else(no_coordinates)?;
        let new_time = changes & TIME != 0;
        self.decode_returns(changes, first)?;
        let last = &mut self.last;
        let (count, number) = (usize::from(last.return_count), usize::from(last.return_number));
        let single = u32::from(count == 1);
        let place = last.place_of_return(2, 1);

        let median = usize::from(MEDIANS[count][number]) * 2 + usize::from(new_time);
        let step = self.x.decompress(first, self.x_medians[median].get(), single)?;
        last.x = last.x.wrapping_add(step);
        self.x_medians[median].add(step);
        let context = single + (self.x.k() & !1).min(20);
        let step = self.y.decompress(first, self.y_medians[median].get(), context)?;
        last.y = last.y.wrapping_add(step);
        self.y_medians[median].add(step);

        if let Some(layer) = z {
            let context = single + (((self.x.k() + self.y.k()) / 2) & !1).min(18);
            let height = &mut self.heights[count.abs_diff(number).min(7)];
            *height = self.z.decompress(layer, *height, context)?;
            last.z = *height;
        }
        if let Some(layer) = classes {
            let context = usize::from(last.class & 31) * 2 + usize::from(place == 3);
            last.class = layer.decode_symbol(self.classes.get(context))? as u8;
        }
        if let Some(layer) = flags {
            // the channel stands between the flags
            let context = last.flags >> 2 & 0b11_0000 | last.flags & 15;
            let flags = layer.decode_symbol(self.flags.get(usize::from(context)))? as u8;
            last.flags = (flags & 0b11_0000) << 2 | last.flags & 0b11_0000 | flags & 15;
        }
        if let Some(layer) = intensities {
            let intensity = &mut self.intensities[usize::from(place) * 2 + usize::from(new_time)];
            *intensity = self.intensity.decompress(layer, i32::from(*intensity), u32::from(place))? as u16;
            last.intensity = *intensity;
        }
        if let (Some(layer), true) = (scan_angles, changes & SCAN_ANGLE != 0) {
            last.scan_angle =
                self.scan_angle.decompress(layer, i32::from(last.scan_angle), u32::from(new_time))? as i16;
        }
        if let Some(layer) = users {
            last.user = layer.decode_symbol(self.users.get(usize::from(last.user / 4)))? as u8;
        }
        if let (Some(layer), true) = (sources, changes & SOURCE != 0) {
            last.source = self.source.decompress(layer, i32::from(last.source), 0)? as u16;
        }
        if let (Some(layer), true) = (times, new_time) {
            last.time = self.times.next(layer)?;
        }
        self.new_time = new_time;
        Ok(())
    }

    fn decode_returns(&mut self, changes: u32, layer: &mut Layer) -> io::Result<()> {
        let last = &mut self.last;
        if changes & RETURN_COUNT != 0 {
            last.return_count = layer.decode_symbol(self.return_counts.get(usize::from(last.return_count)))? as u8;
        }
        let number = last.return_number;
        last.return_number = match changes & 3 {
            0 => number,
            1 => number + 1,
            2 => number + 15,
            _ if changes & TIME != 0 => layer.decode_symbol(self.return_numbers.get(usize::from(number)))? as u8,
            _ => number + 2 + layer.decode_symbol(&mut self.return_steps)? as u8,
        } % 16;
        Ok(())
    }
}

fn no_coordinates() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the layer of coordinates is empty")
}

impl Point14Field {
    pub(super) fn new(version: u16) -> Self {
        Self {
            version,
            wanted: [true; LAYERS],
            sizes: [0; LAYERS],
            layers: Default::default(),
            channels: Default::default(),
            channel: 0,
        }
    }

    /// The channel of the next point and its changed fields.
    fn next_changes(&mut self) -> io::Result<u32> {
        let layer = self.layers[0].as_mut().ok_or_else(no_coordinates)?;
        let Some(from) = &mut self.channels[self.channel] else { return Err(no_coordinates()) };
        let context = from.last.place_of_return(1, 2) + u8::from(from.new_time) * 4;
        let changes = layer.decode_symbol(from.changes.get(usize::from(context)))?;
        if changes & CHANNEL != 0 {
            let step = layer.decode_symbol(&mut from.channel_steps)?;
            let last = from.last;
            self.channel = (self.channel + 1 + step as usize) % self.channels.len();
            let channel = self.channels[self.channel].get_or_insert_with(|| Box::new(Channel::new(last)));
            channel.last.flags = channel.last.flags & !0b11_0000 | (self.channel as u8) << 4;
        }
        Ok(changes)
    }
}

impl<R: Read + Seek> LayeredFieldDecompressor<R> for Point14Field {
    fn size_of_field(&self) -> usize {
        SIZE
    }

    fn set_selection(&mut self, selection: DecompressionSelection) {
        self.wanted = [
            true,
            selection.should_decompress_z(),
            selection.should_decompress_classification(),
            selection.should_decompress_flags(),
            selection.should_decompress_intensity(),
            selection.should_decompress_scan_angle(),
            selection.should_decompress_user_data(),
            selection.should_decompress_point_source_id(),
            selection.should_decompress_gps_time(),
        ];
    }

    fn init_first_point(&mut self, src: &mut R, first_point: &mut [u8], context: &mut usize) -> io::Result<()> {
        let mut bytes = [0; SIZE];
        src.read_exact(&mut bytes)?;
        first_point.copy_from_slice(&bytes);
        let point = Point::from_bytes(&bytes);
        self.channels = Default::default();
        self.channel = point.channel();
        self.channels[self.channel] = Some(Box::new(Channel::new(point)));
        *context = self.channel;
        Ok(())
    }

    fn decompress_field_with(&mut self, current_point: &mut [u8], context: &mut usize) -> io::Result<()> {
        let changes = self.next_changes()?;
        // version 3 tells the other fields of a channel only when it begins, as LASzip did by mistake
        if self.version != 3 || changes & CHANNEL != 0 {
            *context = self.channel;
        }
        if let Some(channel) = &mut self.channels[self.channel] {
            channel.decode(changes, &mut self.layers)?;
            channel.last.write(current_point);
        }
        Ok(())
    }

    fn read_layers_sizes(&mut self, src: &mut R) -> io::Result<()> {
        for size in &mut self.sizes {
            let mut bytes = [0; 4];
            src.read_exact(&mut bytes)?;
            *size = u32::from_le_bytes(bytes);
        }
        Ok(())
    }

    fn read_layers(&mut self, src: &mut R) -> io::Result<()> {
        for ((layer, &size), wanted) in self.layers.iter_mut().zip(&self.sizes).zip(self.wanted) {
            *layer = None;
            if !wanted {
                src.seek(SeekFrom::Current(i64::from(size)))?;
            } else if size > 0 {
                let mut bytes = Vec::new();
                src.take(u64::from(size)).read_to_end(&mut bytes)?;
                let mut decoder = ArithmeticDecoder::new(Cursor::new(bytes));
                decoder.read_init_bytes()?;
                *layer = Some(decoder);
            }
        }
        Ok(())
    }
}

/// Models of one number of symbols, each made when it is needed first.
struct Models<const N: usize> {
    symbols: u32,
    models: [Option<ArithmeticModel>; N],
}

impl<const N: usize> Models<N> {
    fn new(symbols: u32) -> Self {
        Self { symbols, models: [const { None }; N] }
    }

    fn get(&mut self, context: usize) -> &mut ArithmeticModel {
        self.models[context].get_or_insert_with(|| ArithmeticModelBuilder::new(self.symbols).build())
    }
}

/// Running median of LASzip. Of five sorted values the largest or the smallest one makes room for a new one, in turn
/// when the new value lies on the other side of the median.
#[derive(Clone, Copy)]
struct Median {
    values: [i32; 5],
    drops_largest: bool,
}

impl Default for Median {
    fn default() -> Self {
        Self { values: [0; 5], drops_largest: true }
    }
}

impl Median {
    fn get(&self) -> i32 {
        self.values[2]
    }

    fn add(&mut self, value: i32) {
        let values = &mut self.values;
        let median = values[2];
        if self.drops_largest {
            let mut at = 4;
            while at > 0 && value < values[at - 1] {
                values[at] = values[at - 1];
                at -= 1;
            }
            values[at] = value;
            self.drops_largest = value < median;
        } else {
            let mut at = 0;
            while at < 4 && values[at + 1] < value {
                values[at] = values[at + 1];
                at += 1;
            }
            values[at] = value;
            self.drops_largest = median >= value;
        }
    }
}

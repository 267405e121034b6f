//! Columns decoded from LAS records.

use ::las::PointData;
use ::las::point::Format;
use belvedere_data::vector::to_f32;

use crate::las::extra::{ExtraField, ExtraNormals};
use crate::points::coordinates::Coordinates;
use belvedere_data::cloud::{Attributes, GpsTimeKind};

/// ASPRS class of overlap points in point formats 0 to 5, which have no flag for it.
const OVERLAP_CLASS: u8 = 12;

/// The columns as they grow batch by batch.
pub(crate) struct LasColumns {
    positions: Vec<[i32; 3]>,
    scale: [f64; 3],
    offset: [f64; 3],
    attributes: Attributes,
    extended: bool,
    extra_normals: Option<ExtraNormals>,
    unread: UnreadFields,
}

/// Fields of all records that are no attributes of a cloud, all bits of all points together.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct UnreadFields {
    user_data: u8,
    scan_bits: u8,
}

impl UnreadFields {
    pub(crate) fn add(&mut self, other: Self) {
        self.user_data |= other.user_data;
        self.scan_bits |= other.scan_bits;
    }

    /// Returns the fields that are set at any point, in words.
    pub(crate) fn in_words(self) -> impl Iterator<Item = String> {
        let fields = [
            ("user data", self.user_data != 0),
            ("scan direction flags", self.scan_bits & 1 << 6 != 0),
            ("edge of flight line flags", self.scan_bits & 1 << 7 != 0),
        ];
        fields.into_iter().filter(|(_, is_set)| *is_set).map(|(name, _)| name.to_owned())
    }
}

impl LasColumns {
    pub(crate) fn new(
        format: &Format,
        scale: [f64; 3],
        offset: [f64; 3],
        extra_normals: Option<ExtraNormals>,
        capacity: usize,
    ) -> Self {
        let extended = format.is_extended;
        let attributes = Attributes {
            normals: extra_normals.map(|_| Vec::with_capacity(capacity)),
            classification: Some(Vec::with_capacity(capacity)),
            gps_time: format.has_gps_time.then(|| Vec::with_capacity(capacity)),
            gps_time_kind: GpsTimeKind::default(),
            return_number: Some(Vec::with_capacity(capacity)),
            return_count: Some(Vec::with_capacity(capacity)),
            scan_angle: Some(Vec::with_capacity(capacity)),
            point_source_id: Some(Vec::with_capacity(capacity)),
            scanner_channel: extended.then(|| Vec::with_capacity(capacity)),
            flags: Some(Vec::with_capacity(capacity)),
            intensity: Some(Vec::with_capacity(capacity)),
            color: format.has_color.then(|| Vec::with_capacity(capacity)),
            scanner_index: None,
        };
        let positions = Vec::with_capacity(capacity);
        Self { positions, scale, offset, attributes, extended, extra_normals, unread: UnreadFields::default() }
    }

    /// Decodes a batch, one task per column.
    pub(crate) fn append(&mut self, batch: &PointData) {
        let extended = self.extended;
        let records = || batch.raw_bytes().chunks_exact(batch.record_len().max(1));
        // All formats keep the returns in byte 14 and flags in byte 15 of a record, which has at least 20 bytes.
        let byte = |record: &[u8], at: usize| record.get(at).copied().unwrap_or(0);
        let Attributes {
            normals,
            classification,
            gps_time,
            return_number,
            return_count,
            scan_angle,
            point_source_id,
            scanner_channel,
            flags,
            intensity,
            color,
            gps_time_kind: _,
            scanner_index: _,
        } = &mut self.attributes;
        let (positions, extra_normals, unread) = (&mut self.positions, self.extra_normals, &mut self.unread);
        rayon::scope(|scope| {
            scope.spawn(move |_| {
                // the direction of the mirror and the edge of a flight line are the highest bits of one byte
                let scan_bits_at = if extended { 15 } else { 14 };
                for record in records() {
                    unread.add(UnreadFields { user_data: byte(record, 17), scan_bits: byte(record, scan_bits_at) });
                }
            });
            scope.spawn(|_| {
                let xyz = batch.x_raw().zip(batch.y_raw()).zip(batch.z_raw());
                positions.extend(xyz.map(|((x, y), z)| [x, y, z]));
            });
            if let Some(column) = gps_time
                && let Some(times) = batch.gps_time()
            {
                scope.spawn(|_| column.extend(times));
            }
            if let Some(column) = color
                && let Some(colors) = batch.rgb()
            {
                scope.spawn(|_| column.extend(colors.map(|(r, g, b)| [r, g, b])));
            }
            if let (Some(column), Some([x, y, z])) = (normals, extra_normals) {
                scope.spawn(move |_| {
                    let value = |field: ExtraField, record: &[u8]| field.value(record).map_or(0.0, to_f32);
                    column.extend(records().map(|r| [value(x, r), value(y, r), value(z, r)]));
                });
            }
            scope.spawn(|_| extend(scan_angle, batch.scan_angle_degrees().map(f32::to_radians)));
            scope.spawn(|_| {
                extend(point_source_id, batch.point_source_id());
                extend(intensity, batch.intensity());
            });
            scope.spawn(|_| {
                extend(classification, batch.classification());
                extend(return_number, batch.return_number());
                extend(return_count, batch.number_of_returns());
            });
            scope.spawn(move |_| {
                if extended {
                    extend(flags, records().map(|r| byte(r, 15) & 0x0f));
                    extend(scanner_channel, records().map(|r| byte(r, 15) >> 4 & 3));
                } else {
                    extend(
                        flags,
                        records().map(|r| {
                            let overlap = u8::from(byte(r, 15) & 0x1f == OVERLAP_CLASS) << 3;
                            byte(r, 15) >> 5 | overlap
                        }),
                    );
                }
            });
        });
    }

    /// The columns, and the fields of the records without a column.
    pub(crate) fn finish(self) -> (Coordinates, Attributes, UnreadFields) {
        let coordinates = Coordinates::Quantised { values: self.positions, scale: self.scale, offset: self.offset };
        (coordinates, self.attributes, self.unread)
    }
}

fn extend<T>(column: &mut Option<Vec<T>>, values: impl Iterator<Item = T>) {
    if let Some(column) = column {
        column.extend(values);
    }
}

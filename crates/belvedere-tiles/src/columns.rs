//! Columns of points that tiles need.

use crate::inputs::PointColumns;
use belvedere::{Attributes, PointCloud};

/// Adds the points of `more`, with the columns that tiles need and all files have.
pub(crate) fn append(cloud: &mut PointCloud, more: PointCloud, columns: PointColumns) {
    let count = more.len();
    let attributes = needed(more.attributes, columns);
    cloud.attributes.append(cloud.positions.len(), attributes, count);
    cloud.positions.extend(more.positions);
    cloud.frame = more.frame;
}

/// Returns the columns that tiles need and all files have.
pub(crate) fn needed(attributes: Attributes, columns: PointColumns) -> Attributes {
    Attributes {
        classification: attributes.classification,
        gps_time: attributes.gps_time.filter(|_| columns.gps_times),
        gps_time_kind: attributes.gps_time_kind,
        return_number: attributes.return_number,
        return_count: attributes.return_count,
        scan_angle: attributes.scan_angle,
        point_source_id: attributes.point_source_id,
        scanner_channel: attributes.scanner_channel.filter(|_| columns.channels),
        flags: attributes.flags,
        ..Attributes::default()
    }
}

//! Columns of points that tiles need.

use crate::inputs::PointColumns;
use belvedere::{Attributes, PointCloud};

/// Adds the points of `more`, with the columns that tiles need and all files have.
pub(crate) fn append(cloud: &mut PointCloud, more: PointCloud, columns: PointColumns) {
    let (count, own) = (more.len(), more.attributes);
    let needed = Attributes {
        gps_time: own.gps_time.filter(|_| columns.gps_times),
        scanner_channel: own.scanner_channel.filter(|_| columns.channels),
        classification: own.classification,
        gps_time_kind: own.gps_time_kind,
        return_number: own.return_number,
        return_count: own.return_count,
        scan_angle: own.scan_angle,
        point_source_id: own.point_source_id,
        flags: own.flags,
        ..Attributes::default()
    };
    cloud.attributes.append(cloud.positions.len(), needed, count);
    cloud.positions.extend(more.positions);
    cloud.frame = more.frame;
}

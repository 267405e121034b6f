//! Maps of terrain beyond a cloud, and marks on them.

use belvedere::cast::to_index;
use belvedere::figures::MapMark;
use belvedere::io::Georeference;
use belvedere::raster::Raster;
use belvedere::results::terrain_georeference;
use belvedere::{ElevationGrid, Frame};

/// Maximum number of pixels of a map of terrain.
const MAX_PIXELS: f64 = 4e6;

/// Square pixels of a map.
pub(crate) struct Sheet {
    pub(crate) relief: Raster<f32>,
    pub(crate) colors: Vec<Option<[u8; 3]>>,
    /// Side of a pixel, metres, and the upper left corner, local metres.
    pub(crate) cell: f64,
    pub(crate) corner: [f64; 2],
    pub(crate) place: Georeference,
}

impl Sheet {
    /// Terrain with a colour for each node that has a height, of which a large map shows some.
    pub(crate) fn of_terrain(
        terrain: &ElevationGrid,
        colors: &[Option<[u8; 3]>],
        frame: &Frame,
    ) -> belvedere::Result<Self> {
        let ([west, north], sides) = (terrain.north_west(), terrain.cell());
        let size = [terrain.heights().width(), terrain.heights().height()];
        let extent = [0, 1].map(|i| size[i] as f64 * sides[i]);
        let usual = sides[0].max(sides[1]);
        let cell = usual.max((extent[0] * extent[1] / MAX_PIXELS).sqrt());
        let [width, height] = extent.map(|extent| to_index((extent / cell).round().max(1.0)));
        let node = |pixel: usize, axis: usize| {
            to_index((pixel as f64 + 0.5) * cell / sides[axis]).min(size[axis].saturating_sub(1))
        };
        let nodes = (0..width * height).map(|i| [node(i % width, 0), node(i / width, 1)]);
        let relief = nodes.clone().map(|[column, row]| terrain.heights().get(column, row).unwrap_or(f32::NAN));
        let relief = Raster::from_values(width, height, relief.collect())?;
        let color = |([column, row], height): ([usize; 2], &f32)| {
            colors.get(row * size[0] + column).copied().flatten().filter(|_| !height.is_nan())
        };
        let colors = nodes.zip(relief.values()).map(color).collect();
        let step = cell / frame.crs.metres_per_unit;
        let place =
            Georeference { column_step: [step, 0.0], row_step: [0.0, -step], ..terrain_georeference(terrain, frame) };
        let corner = [west - sides[0] / 2.0, north + sides[1] / 2.0];
        Ok(Self { relief, colors, cell, corner, place })
    }

    /// Marks of those places, local metres, that lie on it.
    pub(crate) fn marks(&self, places: &[[f64; 3]]) -> Vec<MapMark> {
        let size = [self.relief.width() as f64, self.relief.height() as f64];
        let mark = |[x, y, _]: &[f64; 3]| {
            let place = [(x - self.corner[0]) / self.cell, (self.corner[1] - y) / self.cell];
            let is_inside = (0..2).all(|i| (0.0..=size[i]).contains(&place[i]));
            is_inside.then(|| MapMark { place, ..MapMark::default() })
        };
        places.iter().filter_map(mark).collect()
    }
}

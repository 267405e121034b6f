//! Plan of a town: rows of blocks, streets between them, a canal.

use crate::solids::PlanPlacement;
use crate::town::TownParams;
use crate::town::terrain::Canal;

/// Half the side of the square within a block for which the block plans are drawn, metres.
const PLAN_HALF_SIDE: f64 = 20.0;
/// Width of the edge of the scene that is free of buildings, metres.
const EDGE: f64 = 4.0;
/// Minimum side of the ground for two by two blocks, metres.
const MIN_EXTENT_OF_FOUR: f64 = 100.0;
/// Width of the ground of a canal between two rows of blocks, besides the street, and width of its trench, metres.
const CANAL_STRIP: f64 = 15.0;
const CANAL_WIDTH: f64 = 12.0;
/// Minimum side of a block next to a canal, metres; with smaller blocks there is no canal.
const MIN_BLOCK_AT_CANAL: f64 = 33.0;
/// Length of a bridge beyond each bank, metres.
const BRIDGE_END: f64 = 1.2;

/// Rectangle of a block: a square of ±[`PLAN_HALF_SIDE`] plan metres, stretched to the block.
pub(crate) struct BlockRectangle {
    pub(crate) centre: PlanPlacement,
    pub(crate) scale: [f64; 2],
}

impl BlockRectangle {
    /// Returns the placement at plan position (u, v), turned by `angle`. Only positions stretch; buildings keep their
    /// size.
    pub(crate) fn at(&self, u: f64, v: f64, angle: f64) -> PlanPlacement {
        self.centre.moved(u * self.scale[0], v * self.scale[1], angle)
    }

    /// Returns half the sides of the block, metres.
    pub(crate) fn half_sides(&self) -> [f64; 2] {
        self.scale.map(|scale| scale * PLAN_HALF_SIDE)
    }
}

/// Layout of the blocks, streets and the canal of a town.
pub(crate) struct TownLayout {
    pub(crate) extent: f64,
    /// Middle of the town, u along the streets of one direction.
    pub(crate) centre: PlanPlacement,
    /// Side of the turned square that blocks and streets fill, metres.
    pub(crate) side: f64,
    /// Middles of the columns and rows of blocks.
    pub(crate) columns: Vec<f64>,
    pub(crate) rows: Vec<f64>,
    /// Middles of the streets: streets along v by their u, and streets along u by their v.
    pub(crate) streets_along_v: Vec<f64>,
    pub(crate) streets_along_u: Vec<f64>,
    /// Middle line of the canal, which runs along u, by its v.
    pub(crate) canal: Option<f64>,
    canal_depth: f64,
    scale: [f64; 2],
}

impl TownLayout {
    /// Creates the layout from parameters within their limits.
    pub(crate) fn new(params: &TownParams) -> Self {
        let extent = params.extent;
        // The turned grid of blocks must fit into the upright square.
        let (sin, cos) = params.street_angle.sin_cos();
        let side = (extent - 2.0 * EDGE) / (sin.abs() + cos.abs());
        let street = params.street_width;
        let fewest = if extent < MIN_EXTENT_OF_FOUR { 1.0 } else { 2.0 };
        let across = ((side + street) / params.block_pitch).floor().max(fewest);
        let pitch = (side + street) / across;
        let pitch_at_canal = (side + street - CANAL_STRIP) / across;
        let with_canal = params.canal_depth > 0.0 && across > 1.0 && pitch_at_canal - street > MIN_BLOCK_AT_CANAL;

        let columns = centred_steps(across, pitch);
        let streets_along_v: Vec<f64> = columns.iter().skip(1).map(|&block| block - pitch / 2.0).collect();
        let (mut rows, mut streets_along_u) = (columns.clone(), streets_along_v.clone());
        let mut canal = None;
        if with_canal {
            rows = centred_steps(across, pitch_at_canal);
            streets_along_u = rows.iter().skip(1).map(|&block| block - pitch_at_canal / 2.0).collect();
            // The street keeps to the lower bank, the canal takes the rest of the widened gap.
            let middle = streets_along_u.len() / 2;
            canal = streets_along_u.get(middle).map(|gap| gap + street / 2.0);
            for (row, v) in rows.iter_mut().enumerate() {
                *v += if row <= middle { -CANAL_STRIP / 2.0 } else { CANAL_STRIP / 2.0 };
            }
            for (number, v) in streets_along_u.iter_mut().enumerate() {
                *v += if number <= middle { -CANAL_STRIP / 2.0 } else { CANAL_STRIP / 2.0 };
            }
        }
        let row_pitch = if with_canal { pitch_at_canal } else { pitch };
        let scale = [pitch, row_pitch].map(|pitch| (pitch - street) / 2.0 / PLAN_HALF_SIDE);
        let centre = PlanPlacement { origin: [params.origin[0], params.origin[1]], angle: params.street_angle };
        let canal_depth = params.canal_depth;
        Self { extent, centre, side, columns, rows, streets_along_v, streets_along_u, canal, canal_depth, scale }
    }

    /// Returns the blocks, row by row.
    pub(crate) fn plans(&self) -> Vec<BlockRectangle> {
        let positions = self.rows.iter().flat_map(|&v| self.columns.iter().map(move |&u| (u, v)));
        positions.map(|(u, v)| BlockRectangle { centre: self.centre.moved(u, v, 0.0), scale: self.scale }).collect()
    }

    /// Returns half the sides of a block, metres.
    pub(crate) fn block_half_sides(&self) -> [f64; 2] {
        self.scale.map(|scale| scale * PLAN_HALF_SIDE)
    }

    /// Returns the trench of the canal; `None` without a canal.
    pub(crate) fn trench(&self) -> Option<Canal> {
        let placement = self.centre.moved(0.0, self.canal?, 0.0);
        Some(Canal { placement, width: CANAL_WIDTH, depth: self.canal_depth })
    }

    /// Returns the placement of the ground of the canal, and its sides along u and v in metres.
    pub(crate) fn canal_ground(&self) -> Option<(PlanPlacement, [f64; 2])> {
        // Twice the extent is past the edge in any direction.
        Some((self.centre.moved(0.0, self.canal?, 0.0), [2.0 * self.extent, CANAL_WIDTH]))
    }

    /// Returns the ends of the bridges that carry the streets over the canal.
    pub(crate) fn bridges(&self) -> Vec<[[f64; 2]; 2]> {
        let reach = CANAL_WIDTH / 2.0 + BRIDGE_END;
        let ends = |u: f64, v: f64| [self.centre.at(u, v - reach), self.centre.at(u, v + reach)];
        self.canal.map_or(Vec::new(), |v| self.streets_along_v.iter().map(|&u| ends(u, v)).collect())
    }
}

/// Returns `count` positions `step` apart, symmetric about 0.
fn centred_steps(count: f64, step: f64) -> Vec<f64> {
    let first = -step * (count - 1.0) / 2.0;
    std::iter::successors(Some(first), |previous| Some(previous + step))
        .take_while(|p| *p < -first + step / 2.0)
        .collect()
}

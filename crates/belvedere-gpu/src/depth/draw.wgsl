// What each pixel shows: the twin of `depths` and `min_depth` in belvedere-core/src/depth/parallel.rs and central.rs,
// and of the tiles in tiles.rs. Or bounds of the depth over each pixel: the twin of both `Bound` there, and of
// bounds.rs.
//
// A group of threads draws a tile of four blocks of 8 x 8 pixels, a thread for each pixel. In f32 a depth is known
// between two bounds. Each pixel finds between which depths the nearest ball lies that the CPU would show. Where these
// are close together their middle is the depth. Else the pixel is marked, and a second turn lists the balls that may be
// its nearest: the CPU decides among them. The proof of the bounds is on the project's page on graphics processors.

struct Piece {
    // of this dispatch
    first_row: u32,
    // whether candidates of marked pixels are listed; else pixels are drawn
    is_listing: u32,
}

// What is known of a pixel.
struct KnownDepth {
    // the nearest depth is at most this
    upper: f32,
    // and at least this, which is that of a ball
    lower: f32,
    row: u32,
    // the least lower bound of all other balls
    second: f32,
}

@group(0) @binding(1) var<uniform> piece: Piece;
// Bits of depths, or of upper bounds; of marked pixels, with the sign set, those of the upper bound. The last part of a
// scene writes them.
@group(0) @binding(8) var<storage, read_write> pixels: array<u32>;
// which ball each pixel shows, or bits of lower bounds
@group(0) @binding(9) var<storage, read_write> rows: array<u32>;
// what is known of pixels between two parts of a scene
@group(0) @binding(10) var<storage, read_write> between: array<KnownDepth>;
// how many candidates there are; then a pixel and a ball for each
@group(0) @binding(11) var<storage, read_write> candidates: array<atomic<u32>>;

const NO_BALL: u32 = 0xffffffffu;
// Instead of infinity, which devices need not know.
const ENDLESS_DEPTH: f32 = 3e38;
// A lower bound of the depth of no ball: it is above every upper bound.
const NONE: f32 = 3.2e38;
// Two bounds may differ by this share of themselves, so that their middle errs by at most 10^-5.
const TOLERANCE: f32 = 1.96e-5;
// What f32 errs by, the CPU and a device together, with u = 2^-23. In a parallel view: 16 u of the square of the
// radius, 8 u of depth and radius.
const SQUARE_ROOM: f32 = 1.9073487e-6;
const MIN_SQUARE: f32 = 1e-30;
const PARALLEL_DEPTH_ROOM: f32 = 9.5367432e-7;
// In a view from an eye: the distance beside a centre by 5 u of its distance in a perspective view, 8 u in others, and
// 10 u of the radius; the square of the radius by 4 u; ranges by 13.4 u of distance and radius; the ratio of depth and
// range by 8 u.
const PERSPECTIVE_BESIDE_ROOM: f32 = 5.9604645e-7;
const HEMISPHERE_BESIDE_ROOM: f32 = 9.5367432e-7;
const RADIUS_BESIDE_ROOM: f32 = 1.1920929e-6;
const RADIUS_SQUARE_ROOM: f32 = 4.7683716e-7;
const RANGE_ROOM: f32 = 1.6e-6;
const RATIO_ROOM: f32 = 9.5367432e-7;
// The same of bounds over pixels.
const DEPTH_ROOM: f32 = 1.9073487e-6;
// Side of a block, pixels, and blocks of a tile.
const SIDE: u32 = 8u;
const BLOCKS: u32 = 4u;
// A cone around a block beyond this cosine is as good as everything.
const MIN_CONE_COSINE: f32 = 0.75;
// A cone around a pixel beyond this sine, too.
const MAX_SINE: f32 = 0.999;
// Of a pixel, in pixels, and a little more.
const HALF_DIAGONAL: f32 = 0.7072;
const HALF_SIDE: f32 = 0.50001;

// The directions of a block lie in this cone.
struct Cone {
    middle: vec3<f32>,
    cosine: f32,
    sine: f32,
    min_depth_per_range: f32,
}

// balls that some block has to look at, and which of them each block has to
var<workgroup> chunk: array<vec4<f32>, 256>;
var<workgroup> chunk_balls: array<u32, 256>;
var<workgroup> chosen: array<u32, 1024>;
var<workgroup> chosen_count: array<atomic<u32>, 4>;
// where the lists of each step and level begin and end
var<workgroup> spans: array<vec2<u32>, 224>;
// where steps begin among all entries of the tile, and the end
var<workgroup> step_begins: array<u32, 33>;
// the rank of the depth that no pixel of a block exceeds, and of the tile
var<workgroup> farthest_ranks: array<atomic<u32>, 4>;
var<workgroup> farthest_of_all: u32;
var<workgroup> cones: array<Cone, 4>;

// As `View::direction`. Offsets from the middle are exact; the common factor is rounded once for all components.
fn direction(place: vec2<f32>) -> vec3<f32> {
    let offset = place - view.middle;
    let square = dot(offset, offset);
    let pixels = view.pixels;
    if KIND == PERSPECTIVE {
        return vec3<f32>(offset, pixels) * inverseSqrt(square + pixels * pixels);
    }
    let of_pixels = pixels * pixels;
    return vec3<f32>(2.0 * pixels * offset, of_pixels - square) * (1.0 / (of_pixels + square));
}

fn cone_of(corner: vec2<f32>) -> Cone {
    let side = f32(SIDE);
    var found: Cone;
    found.middle = direction(corner + 0.5 * side);
    found.min_depth_per_range = 1.0;
    var cosine = 1.0;
    var sine = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let at = direction(corner + side * vec2<f32>(f32(i & 1u), f32(i >> 1u)));
        cosine = min(cosine, dot(found.middle, at));
        sine = max(sine, length(cross(found.middle, at)));
        // bounds are ranges
        if KIND == PERSPECTIVE && SHOWS != BOUNDS {
            found.min_depth_per_range = min(found.min_depth_per_range, 0.999 * at.z);
        }
    }
    found.sine = 1.01 * sine + 1e-5;
    found.cosine = select(sqrt(max(1.0 - found.sine * found.sine, 0.0)), 0.0, cosine < MIN_CONE_COSINE);
    return found;
}

// At most the depth of a ball at any place of a rectangle in a parallel view, above all limits where it is beside the
// rectangle.
fn nearest_parallel(splat: vec4<f32>, low: vec2<f32>, high: vec2<f32>) -> f32 {
    let radius = abs(splat.w);
    let beside = max(max(low - splat.xy, splat.xy - high) - misplaced(splat.xy), vec2<f32>(0.0));
    let offset = beside * view.metres_per_pixel;
    let square = radius * radius * (1.0 + SQUARE_ROOM) - dot(offset, offset) + MIN_SQUARE;
    let room = DEPTH_ROOM * (abs(splat.z) + radius) + MIN_ROOM;
    return select(NONE, max(splat.z - sqrt(max(square, 0.0)) - room, view.near), square > 0.0);
}

// Pixels by which f32 may misplace a ball of a parallel view. Depths are computed where the CPU places it; bounds hold
// for its true place.
fn misplaced(at: vec2<f32>) -> f32 {
    return select(0.0, PARALLEL_ROOM * (abs(at.x) + abs(at.y)), SHOWS == BOUNDS);
}

// At most the depth of a ball in any direction of a cone, above all limits where it is beside the cone.
fn nearest_central(splat: vec4<f32>, cone: Cone) -> f32 {
    let radius = abs(splat.w);
    let distance = length(splat.xyz);
    let room = CENTRAL_ROOM * (distance + radius) + MIN_ROOM;
    let middle_along = dot(splat.xyz, cone.middle);
    let middle_beside = length(cross(splat.xyz, cone.middle));
    let beside = middle_beside * cone.cosine - middle_along * cone.sine - room;
    if cone.cosine == 0.0 || beside <= 0.0 {
        return max((distance - radius - room) * cone.min_depth_per_range, view.near);
    }
    let along = middle_along * cone.cosine + middle_beside * cone.sine + room;
    let half_chord = sqrt(max((radius - beside) * (radius + beside), 0.0));
    if beside >= radius || along + half_chord < 0.0 {
        return NONE;
    }
    return max((along - half_chord - 2.0 * room) * cone.min_depth_per_range, view.near);
}

// At most the depth of a ball anywhere in a block.
fn min_depth(splat: vec4<f32>, corner: vec2<f32>, block: u32) -> f32 {
    if KIND == PARALLEL {
        // bounds are those of whole pixels, depths those of their centres
        let inward = select(0.5, 0.0, SHOWS == BOUNDS);
        return nearest_parallel(splat, corner + inward, corner + f32(SIDE) - inward);
    }
    return nearest_central(splat, cones[block]);
}

// The cone around the directions of a pixel: the twin of `angle_per_pixel` in central.rs.
fn cone_of_pixel(place: vec2<f32>) -> Cone {
    let off_middle = max(length(place - view.middle) - HALF_DIAGONAL, 0.0) / view.pixels;
    let square = 1.0 + off_middle * off_middle;
    let steepness = select(2.0 / square, 1.0 / sqrt(square), KIND == PERSPECTIVE);
    var found: Cone;
    found.middle = direction(place);
    // the angle itself: more than its sine, so that the cone is wider than the pixel
    found.sine = 1.001 * HALF_DIAGONAL * steepness / view.pixels;
    found.cosine = select(sqrt(max(1.0 - found.sine * found.sine, 0.0)), 0.0, found.sine > MAX_SINE);
    found.min_depth_per_range = 1.0;
    return found;
}

// At least the depth of a ball of a parallel view at every place of a pixel, however far it gives way; without end
// where it does not cover the pixel.
fn farthest_parallel(splat: vec4<f32>, low: vec2<f32>, high: vec2<f32>) -> f32 {
    let offset = (max(abs(low - splat.xy), abs(high - splat.xy)) + misplaced(splat.xy)) * view.metres_per_pixel;
    let beside = dot(offset, offset) + MIN_SQUARE;
    let radius = splat.w;
    if radius <= 0.0 || beside >= radius * radius * (1.0 - SQUARE_ROOM) {
        return ENDLESS_DEPTH;
    }
    let room = DEPTH_ROOM * (abs(splat.z) + radius) + MIN_ROOM;
    let left = min_radius(radius);
    let square = left * left * (1.0 - SQUARE_ROOM) - beside;
    let whole = splat.z + radius + view.shell + 2.0 * room;
    return select(whole, min(whole, splat.z - sqrt(max(square, 0.0)) + room), square > 0.0);
}

// The same in all directions of a cone.
fn farthest_central(splat: vec4<f32>, cone: Cone) -> f32 {
    let radius = splat.w;
    let distance = length(splat.xyz);
    let room = CENTRAL_ROOM * (distance + radius) + MIN_ROOM;
    let middle_along = dot(splat.xyz, cone.middle);
    let middle_beside = length(cross(splat.xyz, cone.middle));
    let beside = middle_beside * cone.cosine + middle_along * cone.sine + room;
    let along = middle_along * cone.cosine - middle_beside * cone.sine;
    if radius <= 0.0 || cone.cosine == 0.0 || along <= room || beside >= radius - room {
        return ENDLESS_DEPTH;
    }
    let left = min_radius(radius) - room;
    let whole = distance + radius + view.shell + room;
    let half_chord = sqrt(max((left - beside) * (left + beside), 0.0));
    return select(whole, min(whole, along - half_chord + 2.0 * room), beside < left);
}

// The radius that is left of a ball for any target, however near to its surface: the twin of `BlockRule::min_radius`.
fn min_radius(radius: f32) -> f32 {
    return radius - min(view.shell, view.shell_share * radius);
}

// A depth that a ball at a pixel exceeds, if it is there, and one that it does not exceed, if it certainly is; else
// above all limits.
fn depth_bounds(splat: vec4<f32>, place: vec2<f32>, sight: vec3<f32>) -> vec2<f32> {
    let nowhere = vec2<f32>(NONE, ENDLESS_DEPTH);
    let radius = splat.w;
    var along = splat.z;
    var square: f32;
    var square_room: f32;
    var room: f32;
    // in a perspective view depths are a share of ranges
    var ratio = vec2<f32>(1.0);
    if KIND == PARALLEL {
        let offset = (place - splat.xy) * view.metres_per_pixel;
        square = radius * radius - dot(offset, offset);
        square_room = radius * radius * SQUARE_ROOM + MIN_SQUARE;
        room = PARALLEL_DEPTH_ROOM * (abs(along) + radius) + MIN_ROOM;
    } else {
        // the distance beside the centre by the vector product, which does not cancel
        let distance = length(splat.xyz);
        let beside = cross(splat.xyz, sight);
        let far_room = select(HEMISPHERE_BESIDE_ROOM, PERSPECTIVE_BESIDE_ROOM, KIND == PERSPECTIVE);
        let beside_room = far_room * distance + RADIUS_BESIDE_ROOM * radius + MIN_ROOM;
        square = radius * radius - dot(beside, beside);
        square_room = 2.0 * beside_room * (radius + beside_room) + RADIUS_SQUARE_ROOM * radius * radius;
        along = dot(splat.xyz, sight);
        room = RANGE_ROOM * (distance + radius) + MIN_ROOM;
        if KIND == PERSPECTIVE {
            ratio = sight.z * vec2<f32>(1.0 - RATIO_ROOM, 1.0 + RATIO_ROOM);
        }
    }
    if square + square_room <= 0.0 {
        return nowhere;
    }
    // half the chord
    let longest = sqrt(square + square_room);
    let shortest = sqrt(max(square - square_room, 0.0));
    let lower = max((along - longest - room) * ratio.x, view.near);
    if (along + longest + room) * ratio.y < view.near || lower > view.far {
        return nowhere;
    }
    let upper = max((along - shortest + room) * ratio.y, view.near);
    let back = (along + shortest - room) * ratio.x;
    let is_hit = square > square_room && back > view.near && upper <= view.far;
    return vec2<f32>(lower, select(ENDLESS_DEPTH, upper, is_hit));
}

// A lower and an upper bound of the depth of a ball over a whole pixel.
fn bounds_over_pixel(splat: vec4<f32>, place: vec2<f32>, cone: Cone) -> vec2<f32> {
    if KIND == PARALLEL {
        let low = place - HALF_SIDE;
        let high = place + HALF_SIDE;
        return vec2<f32>(nearest_parallel(splat, low, high), farthest_parallel(splat, low, high));
    }
    return vec2<f32>(nearest_central(splat, cone), farthest_central(splat, cone));
}

// The bits of a depth, those of infinity where it is without end.
fn bits_of(depth: f32) -> u32 {
    return select(bitcast<u32>(depth), INFINITE, depth >= ENDLESS_DEPTH);
}

// Where the list of a step and level of the tile begins and ends.
fn span(at: u32, tile: vec2<u32>) -> vec2<u32> {
    let level = at / STEPS;
    let side = TILE << (2u * level);
    let columns = (view.width + side - 1u) / side;
    let of_level = tile >> vec2<u32>(2u * level);
    let list = (view.tiles_before[level] + of_level.y * columns + of_level.x) * STEPS + at % STEPS;
    let end = before[list / BLOCK] + atomicLoad(&counters[list]);
    if list == 0u {
        return vec2<u32>(0u, end);
    }
    return vec2<u32>(before[(list - 1u) / BLOCK] + atomicLoad(&counters[list - 1u]), end);
}

// The step of an entry of the tile.
fn step_of(entry: u32) -> u32 {
    var step = 0u;
    for (var half = STEPS / 2u; half > 0u; half /= 2u) {
        step += select(0u, half, step_begins[step + half] <= entry);
    }
    return step;
}

// A whole number that ascends as f32 does, and the number of a rank.
fn rank(v: f32) -> u32 {
    let bits = bitcast<u32>(v);
    return select(bits | SIGN, ~bits, (bits & SIGN) != 0u);
}

fn of_rank(rank: u32) -> f32 {
    return bitcast<f32>(select(~rank, rank & ~SIGN, (rank & SIGN) != 0u));
}

// Shares the depths that no pixel of each block exceeds, and returns that of the tile.
fn farthest(lane: u32, upper: f32) -> f32 {
    if lane < BLOCKS {
        atomicStore(&farthest_ranks[lane], 0u);
    }
    workgroupBarrier();
    atomicMax(&farthest_ranks[lane / 64u], rank(upper));
    workgroupBarrier();
    if lane == 0u {
        var most = 0u;
        for (var block = 0u; block < BLOCKS; block++) {
            most = max(most, atomicLoad(&farthest_ranks[block]));
        }
        farthest_of_all = most;
    }
    return of_rank(workgroupUniformLoad(&farthest_of_all));
}

// What is known of a pixel after another ball.
fn nearer(known: KnownDepth, of_ball: vec2<f32>, row: u32) -> KnownDepth {
    var found = known;
    found.upper = min(known.upper, of_ball.y);
    found.second = min(known.second, max(known.lower, of_ball.x));
    found.lower = min(known.lower, of_ball.x);
    found.row = select(known.row, row, of_ball.x < known.lower);
    return found;
}

fn store(pixel: u32, known: KnownDepth) {
    if view.is_last == 0u {
        between[pixel] = known;
        return;
    }
    if SHOWS == BOUNDS {
        pixels[pixel] = bits_of(known.upper);
        rows[pixel] = bits_of(known.lower);
        return;
    }
    let width = known.upper - known.lower;
    var bits = bitcast<u32>(known.lower + 0.5 * width);
    if known.lower >= ENDLESS_DEPTH {
        bits = INFINITE;
    } else if width > TOLERANCE * known.lower || (SHOWS == BALLS && known.second <= known.upper) {
        bits = SIGN | bits_of(known.upper);
    }
    pixels[pixel] = bits;
    if SHOWS == BALLS {
        rows[pixel] = known.row;
    }
}

// Lists a ball that may be the nearest at a marked pixel. There may be more of them than room; their number counts on.
fn list_candidate(pixel: u32, row: u32) {
    let at = 2u * atomicAdd(&candidates[0], 1u) + 1u;
    if at + 1u < arrayLength(&candidates) {
        atomicStore(&candidates[at], pixel);
        atomicStore(&candidates[at + 1u], row);
    }
}

// Lists an entry of the tile for the blocks in which its ball may be as near as what is there.
fn choose(lane: u32, entry_of_tile: u32, corner: vec2<f32>) {
    let step = step_of(entry_of_tile);
    var entry = entry_of_tile - step_begins[step];
    var level = 0u;
    var of_level = spans[step];
    while entry >= of_level.y - of_level.x {
        entry -= of_level.y - of_level.x;
        level++;
        of_level = spans[level * STEPS + step];
    }
    let ball = listed[of_level.x + entry];
    let splat = splats[ball];
    chunk[lane] = splat;
    chunk_balls[lane] = ball;
    for (var block = 0u; block < BLOCKS; block++) {
        let of_block = corner + vec2<f32>(f32((block & 1u) * SIDE), f32((block >> 1u) * SIDE));
        let limit = of_rank(atomicLoad(&farthest_ranks[block]));
        // of equal depths the lowest row is shown
        if min_depth(splat, of_block, block) <= limit {
            chosen[block * 256u + atomicAdd(&chosen_count[block], 1u)] = lane;
        }
    }
}

@compute @workgroup_size(256)
fn draw(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let tile = vec2<u32>(group.x, group.y + piece.first_row);
    for (var at = lane; at < STEPS * LEVELS; at += 256u) {
        spans[at] = span(at, tile);
    }
    workgroupBarrier();
    if lane <= STEPS {
        // of all steps before this one
        var sum = 0u;
        for (var at = 0u; at < STEPS * LEVELS; at++) {
            if at % STEPS < lane {
                sum += spans[at].y - spans[at].x;
            }
        }
        step_begins[lane] = sum;
    }
    let block = lane / 64u;
    let column = tile.x * TILE + (block & 1u) * SIDE + (lane & 7u);
    let row = tile.y * TILE + (block >> 1u) * SIDE + ((lane >> 3u) & 7u);
    let is_inside = column < view.width && row < view.height;
    let pixel = row * view.width + column;
    let is_listing = piece.is_listing != 0u;
    // pixels beside the picture are full, and so are those without a mark
    var known = KnownDepth(select(-ENDLESS_DEPTH, ENDLESS_DEPTH, is_inside), NONE, NO_BALL, NONE);
    if is_inside && is_listing {
        let bits = pixels[pixel];
        let of_mark = bitcast<f32>(select(bits & ~SIGN, bitcast<u32>(ENDLESS_DEPTH), bits == (SIGN | INFINITE)));
        known.upper = select(-ENDLESS_DEPTH, of_mark, (bits & SIGN) != 0u);
    } else if is_inside && view.first_ball > 0u {
        known = between[pixel];
    }
    let total = workgroupUniformLoad(&step_begins[STEPS]);
    let corner = vec2<f32>(f32(tile.x * TILE), f32(tile.y * TILE + view.top));
    let of_part = vec2<f32>(0.0, f32(view.top));
    let place = vec2<f32>(f32(column) + 0.5, f32(row + view.top) + 0.5);
    var sight = vec3<f32>(0.0);
    var of_pixel: Cone;
    if KIND != PARALLEL {
        if SHOWS == BOUNDS {
            of_pixel = cone_of_pixel(place - of_part);
        } else {
            sight = direction(place - of_part);
        }
        if lane < BLOCKS {
            let of_block = vec2<f32>(f32((lane & 1u) * SIDE), f32((lane >> 1u) * SIDE));
            cones[lane] = cone_of(corner + of_block - of_part);
        }
    }
    var limit = farthest(lane, known.upper);
    for (var first = 0u; first < total; first += 256u) {
        // steps begin at 0, but parallel views have bounds before that
        if limit == -ENDLESS_DEPTH || bitcast<f32>(steps[RANGES + step_of(first)]) > max(limit, 0.0) {
            break;
        }
        if lane < BLOCKS {
            atomicStore(&chosen_count[lane], 0u);
        }
        workgroupBarrier();
        if first + lane < total {
            choose(lane, first + lane, corner);
        }
        workgroupBarrier();
        let count = atomicLoad(&chosen_count[block]);
        for (var i = 0u; i < count; i++) {
            let at = chosen[block * 256u + i];
            let splat = chunk[at];
            let row_of_ball = view.first_ball + chunk_balls[at];
            if SHOWS == BOUNDS {
                known = nearer(known, bounds_over_pixel(splat, place, of_pixel), row_of_ball);
                continue;
            }
            let of_ball = depth_bounds(splat, place, sight);
            if !is_listing {
                known = nearer(known, of_ball, row_of_ball);
            } else if of_ball.x <= known.upper {
                list_candidate(pixel, row_of_ball);
            }
        }
        workgroupBarrier();
        if !is_listing {
            limit = farthest(lane, known.upper);
        }
    }
    if is_inside && !is_listing {
        store(pixel, known);
    }
}

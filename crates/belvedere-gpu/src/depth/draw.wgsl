// The nearest ball at each pixel: the twin of `depths` and `least_depth` in belvedere-core/src/depth/parallel.rs and central.rs, and of the tiles in tiles.rs. Or bounds of
// the depth over each pixel: the twin of both `Bound` there, and of bounds.rs. They need not have the same bits, so that they are computed with room only.
//
// A group of threads draws a tile of four blocks of 8 x 8 pixels, a thread for each pixel. Each pixel finds, with room for what f32 rounds, a depth that the nearest ball
// does not exceed, and keeps the balls that may come as near. Then these are computed exactly, in whole numbers. A second turn finds those of pixels that could not keep
// all. The proof of the room is on the project's page on graphics processors.

struct Piece {
    // of this dispatch
    first_row: u32,
}

@group(0) @binding(1) var<uniform> piece: Piece;
// bits of depths, or of upper bounds
@group(0) @binding(8) var<storage, read_write> pixels: array<u32>;
// which ball each pixel shows, or bits of lower bounds
@group(0) @binding(9) var<storage, read_write> rows: array<u32>;
// what a pixel's direction is made of: doubles for each column, then for each row
@group(0) @binding(13) var<storage, read> offsets: array<vec2<u32>>;

const NO_BALL: u32 = 0xffffffffu;
// Instead of infinity, which devices need not know.
const ENDLESS_DEPTH: f32 = 3e38;
// What f32 errs by, the CPU and a device together: squares in a parallel view as a share of the radius's, the distance beside a centre as a share of distance and
// radius in a view from an eye, and depths as a share of both.
const SQUARE_ROOM: f32 = 1.9073487e-6;
const LEAST_SQUARE: f32 = 1e-30;
const BESIDE_ROOM: f32 = 9.5367432e-7;
const DEPTH_ROOM: f32 = 1.9073487e-6;
const ONE: vec2<u32> = vec2<u32>(0u, 0x3ff00000u);
// Side of a block, pixels, and blocks of a tile.
const SIDE: u32 = 8u;
const BLOCKS: u32 = 4u;
// A lower bound of the depth of no ball: it is above every upper bound.
const NONE: f32 = 3.2e38;
// A cone around a block beyond this cosine is as good as everything.
const WIDEST: f32 = 0.75;
// A cone around a pixel beyond this sine, too.
const WIDEST_SINE: f32 = 0.999;
// Of a pixel, in pixels, and a little more.
const HALF_DIAGONAL: f32 = 0.7072;
const HALF_SIDE: f32 = 0.50001;

// What a pixel shows.
struct Shown {
    // bits; for bounds those of the upper and of the lower one
    depth: u32,
    row: u32,
}

// A direction of sight in a view from an eye.
struct Sight {
    direction: vec3<f32>,
    depth_per_range: f32,
}

// The directions of a block lie in this cone.
struct Cone {
    middle: vec3<f32>,
    cosine: f32,
    sine: f32,
    least_depth_per_range: f32,
}

// balls that some block has to look at, and which of them each block has to
var<workgroup> chunk: array<vec4<u32>, 256>;
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
var<workgroup> is_again: atomic<u32>;
var<workgroup> is_again_shared: u32;
var<workgroup> cones: array<Cone, 4>;

// As `View::direction`, in f64.
fn exact_sight(column: u32, row: u32) -> Sight {
    let x = offsets[column];
    let y = offsets[view.width + row];
    let square = add_double(multiply_double(x, x), multiply_double(y, y));
    var sight: Sight;
    if KIND == PERSPECTIVE {
        let length = root_double(add_double(square, ONE));
        let forward = single_of(divide_double(ONE, length));
        let across = vec2<u32>(single_of(divide_double(x, length)), single_of(divide_double(y, length)));
        sight.direction = bitcast<vec3<f32>>(vec3<u32>(across, forward));
        sight.depth_per_range = bitcast<f32>(forward);
    } else {
        let divisor = add_double(ONE, square);
        let forward = single_of(divide_double(subtract_double(ONE, square), divisor));
        let across = single_of(divide_double(add_double(x, x), divisor));
        let down = single_of(divide_double(add_double(y, y), divisor));
        sight.direction = bitcast<vec3<f32>>(vec3<u32>(across, down, forward));
        sight.depth_per_range = 1.0;
    }
    return sight;
}

// The same in f32, for what has room.
fn direction(place: vec2<f32>) -> vec3<f32> {
    let offset = (place - view.middle) / view.pixels;
    let square = dot(offset, offset);
    if KIND == PERSPECTIVE {
        return vec3<f32>(offset, 1.0) / sqrt(square + 1.0);
    }
    return vec3<f32>(2.0 * offset, 1.0 - square) / (1.0 + square);
}

fn cone_of(corner: vec2<f32>) -> Cone {
    let side = f32(SIDE);
    var found: Cone;
    found.middle = direction(corner + 0.5 * side);
    found.least_depth_per_range = 1.0;
    var cosine = 1.0;
    var sine = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let at = direction(corner + side * vec2<f32>(f32(i & 1u), f32(i >> 1u)));
        cosine = min(cosine, dot(found.middle, at));
        sine = max(sine, length(cross(found.middle, at)));
        // bounds are ranges
        if KIND == PERSPECTIVE && SHOWS != BOUNDS {
            found.least_depth_per_range = min(found.least_depth_per_range, 0.999 * at.z);
        }
    }
    found.sine = 1.01 * sine + 1e-5;
    found.cosine = select(sqrt(max(1.0 - found.sine * found.sine, 0.0)), 0.0, cosine < WIDEST);
    return found;
}

// At most the depth of a ball at any place of a rectangle in a parallel view, above all limits where it is beside the rectangle.
fn nearest_parallel(splat: vec4<f32>, low: vec2<f32>, high: vec2<f32>) -> f32 {
    let radius = abs(splat.w);
    let beside = max(max(low - splat.xy, splat.xy - high) - misplaced(splat.xy), vec2<f32>(0.0));
    let offset = beside * view.metres_per_pixel;
    let square = radius * radius * (1.0 + SQUARE_ROOM) - dot(offset, offset) + LEAST_SQUARE;
    let room = DEPTH_ROOM * (abs(splat.z) + radius) + LEAST_ROOM;
    return select(NONE, max(splat.z - sqrt(max(square, 0.0)) - room, view.near), square > 0.0);
}

// Pixels by which f32 may misplace a ball of a parallel view. Depths are computed where the CPU places it; bounds hold for its true place.
fn misplaced(at: vec2<f32>) -> f32 {
    return select(0.0, PARALLEL_ROOM * (abs(at.x) + abs(at.y)), SHOWS == BOUNDS);
}

// At most the depth of a ball in any direction of a cone, above all limits where it is beside the cone.
fn nearest_central(splat: vec4<f32>, cone: Cone) -> f32 {
    let radius = abs(splat.w);
    let distance = length(splat.xyz);
    let room = CENTRAL_ROOM * (distance + radius) + LEAST_ROOM;
    let middle_along = dot(splat.xyz, cone.middle);
    let middle_beside = length(cross(splat.xyz, cone.middle));
    let beside = middle_beside * cone.cosine - middle_along * cone.sine - room;
    if cone.cosine == 0.0 || beside <= 0.0 {
        return max((distance - radius - room) * cone.least_depth_per_range, view.near);
    }
    let along = middle_along * cone.cosine + middle_beside * cone.sine + room;
    let half_chord = sqrt(max((radius - beside) * (radius + beside), 0.0));
    if beside >= radius || along + half_chord < 0.0 {
        return NONE;
    }
    return max((along - half_chord - 2.0 * room) * cone.least_depth_per_range, view.near);
}

// At most the depth of a ball anywhere in a block.
fn least_depth(splat: vec4<f32>, corner: vec2<f32>, block: u32) -> f32 {
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
    found.cosine = select(sqrt(max(1.0 - found.sine * found.sine, 0.0)), 0.0, found.sine > WIDEST_SINE);
    found.least_depth_per_range = 1.0;
    return found;
}

// At least the depth of a ball of a parallel view at every place of a pixel, however far it gives way; without end where it does not cover the pixel.
fn farthest_parallel(splat: vec4<f32>, low: vec2<f32>, high: vec2<f32>) -> f32 {
    let offset = (max(abs(low - splat.xy), abs(high - splat.xy)) + misplaced(splat.xy)) * view.metres_per_pixel;
    let beside = dot(offset, offset) + LEAST_SQUARE;
    let radius = splat.w;
    if radius <= 0.0 || beside >= radius * radius * (1.0 - SQUARE_ROOM) {
        return ENDLESS_DEPTH;
    }
    let room = DEPTH_ROOM * (abs(splat.z) + radius) + LEAST_ROOM;
    let left = least_radius(radius);
    let square = left * left * (1.0 - SQUARE_ROOM) - beside;
    let whole = splat.z + radius + view.shell + 2.0 * room;
    return select(whole, min(whole, splat.z - sqrt(max(square, 0.0)) + room), square > 0.0);
}

// The same in all directions of a cone.
fn farthest_central(splat: vec4<f32>, cone: Cone) -> f32 {
    let radius = splat.w;
    let distance = length(splat.xyz);
    let room = CENTRAL_ROOM * (distance + radius) + LEAST_ROOM;
    let middle_along = dot(splat.xyz, cone.middle);
    let middle_beside = length(cross(splat.xyz, cone.middle));
    let beside = middle_beside * cone.cosine + middle_along * cone.sine + room;
    let along = middle_along * cone.cosine - middle_beside * cone.sine;
    if radius <= 0.0 || cone.cosine == 0.0 || along <= room || beside >= radius - room {
        return ENDLESS_DEPTH;
    }
    let left = least_radius(radius) - room;
    let whole = distance + radius + view.shell + room;
    let half_chord = sqrt(max((left - beside) * (left + beside), 0.0));
    return select(whole, min(whole, along - half_chord + 2.0 * room), beside < left);
}

// The radius that is left of a ball for any target, however near to its surface: the twin of `BlockRule::least_radius`.
fn least_radius(radius: f32) -> f32 {
    return radius - min(view.shell, view.shell_share * radius);
}

// A depth that a ball at a pixel exceeds, if it is there, and one that it does not exceed, if it certainly is; both without end else.
fn bounds(splat: vec4<f32>, place: vec2<f32>, sight: Sight) -> vec2<f32> {
    let radius = splat.w;
    var along = splat.z;
    var square: f32;
    var square_room: f32;
    var room: f32;
    if KIND == PARALLEL {
        let offset = (place - splat.xy) * view.metres_per_pixel;
        square = radius * radius - dot(offset, offset);
        square_room = radius * radius * SQUARE_ROOM + LEAST_SQUARE;
        if square + square_room <= 0.0 {
            return vec2<f32>(ENDLESS_DEPTH);
        }
        room = DEPTH_ROOM * (abs(along) + radius) + LEAST_ROOM;
    } else {
        let size = length(splat.xyz) + radius;
        let beside = cross(splat.xyz, sight.direction);
        let beside_room = BESIDE_ROOM * size + LEAST_ROOM;
        square = radius * radius - dot(beside, beside);
        square_room = 4.0 * beside_room * (radius + beside_room);
        if square + square_room <= 0.0 {
            return vec2<f32>(ENDLESS_DEPTH);
        }
        along = dot(splat.xyz, sight.direction);
        room = DEPTH_ROOM * size + LEAST_ROOM;
    }
    let most = sqrt(square + square_room);
    if along + most + room < 0.0 {
        return vec2<f32>(ENDLESS_DEPTH);
    }
    let lower = max((along - most - room) * sight.depth_per_range, view.near);
    let least = sqrt(max(square - square_room, 0.0));
    let back = (along + least - room) * sight.depth_per_range;
    let upper = max((along - least + room) * sight.depth_per_range, view.near);
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
    return select(bitcast<u32>(depth), INFINITE_SINGLE, depth >= ENDLESS_DEPTH);
}

// The bits of the depth of a ball at a pixel, as the CPU computes it.
fn exact_parallel(splat: vec4<u32>, place: vec2<f32>) -> u32 {
    let to_metres = bitcast<u32>(view.metres_per_pixel);
    let across = multiply_single(subtract_single(bitcast<u32>(place.x), splat.x), to_metres);
    let down = multiply_single(subtract_single(bitcast<u32>(place.y), splat.y), to_metres);
    let rest = subtract_single(multiply_single(splat.w, splat.w), multiply_single(down, down));
    let square = subtract_single(rest, multiply_single(across, across));
    if order_single(square) <= 0 {
        return INFINITE_SINGLE;
    }
    let half_chord = root_single(square);
    if order_single(add_single(splat.z, half_chord)) < 0 {
        return INFINITE_SINGLE;
    }
    let front = subtract_single(splat.z, half_chord);
    return select(front, 0u, order_single(front) <= 0);
}

// a b - c d
fn cross_single(a: u32, b: u32, c: u32, d: u32) -> u32 {
    return subtract_single(multiply_single(a, b), multiply_single(c, d));
}

// The scalar product.
fn dot_single(a: vec3<u32>, b: vec3<u32>) -> u32 {
    let first = add_single(multiply_single(a.x, b.x), multiply_single(a.y, b.y));
    return add_single(first, multiply_single(a.z, b.z));
}

fn exact_central(splat: vec4<u32>, sight: Sight) -> u32 {
    let towards = bitcast<vec3<u32>>(sight.direction);
    let beside = vec3<u32>(
        cross_single(splat.y, towards.z, splat.z, towards.y),
        cross_single(splat.z, towards.x, splat.x, towards.z),
        cross_single(splat.x, towards.y, splat.y, towards.x),
    );
    let square = subtract_single(multiply_single(splat.w, splat.w), dot_single(beside, beside));
    if order_single(square) <= 0 {
        return INFINITE_SINGLE;
    }
    let half_chord = root_single(square);
    let along = dot_single(splat.xyz, towards);
    let scale = bitcast<u32>(sight.depth_per_range);
    let near = bitcast<u32>(view.near);
    let back = multiply_single(add_single(along, half_chord), scale);
    let begin = multiply_single(subtract_single(along, half_chord), scale);
    let front = select(near, begin, order_single(begin) > order_single(near));
    let is_hit = order_single(back) >= order_single(near) && order_single(back) > 0
        && order_single(front) <= order_single(bitcast<u32>(view.far));
    return select(INFINITE_SINGLE, front, is_hit);
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

// A whole number that ascends as f32 does, and the number that it stands for.
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

// What a pixel shows, a ball more considered; of equally near ones the ball with the lowest row.
fn nearer(shown: Shown, splat: vec4<u32>, ball: u32, place: vec2<f32>, sight: Sight) -> Shown {
    var depth: u32;
    if KIND == PARALLEL {
        depth = exact_parallel(splat, place);
    } else {
        depth = exact_central(splat, sight);
    }
    let row = view.first_ball + ball;
    let is_nearer = depth < shown.depth || (depth == shown.depth && depth != INFINITE_SINGLE && row < shown.row);
    if is_nearer {
        return Shown(depth, row);
    }
    return shown;
}

fn store(pixel: u32, shown: Shown) {
    pixels[pixel] = shown.depth;
    if SHOWS == BALLS || SHOWS == BOUNDS {
        rows[pixel] = shown.row;
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
        // a depth equal to the limit may be that of a lower row
        if least_depth(bitcast<vec4<f32>>(splat), of_block, block) <= limit {
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
    if lane == 0u {
        atomicStore(&is_again, 0u);
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
    let place = vec2<f32>(f32(column) + 0.5, f32(row + view.top) + 0.5);
    // pixels beside the picture are full
    var shown = Shown(select(0u, INFINITE_SINGLE, is_inside), select(NO_BALL, INFINITE_SINGLE, SHOWS == BOUNDS));
    if is_inside && view.first_ball > 0u {
        shown.depth = pixels[pixel];
        if SHOWS == BALLS || SHOWS == BOUNDS {
            shown.row = rows[pixel];
        }
    }
    let total = workgroupUniformLoad(&step_begins[STEPS]);
    if total == 0u {
        if is_inside {
            store(pixel, shown);
        }
        return;
    }
    var sight = Sight(vec3<f32>(0.0), 1.0);
    let corner = vec2<f32>(f32(tile.x * TILE), f32(tile.y * TILE + view.top));
    var of_pixel: Cone;
    let of_part = vec2<f32>(0.0, f32(view.top));
    if KIND != PARALLEL {
        if SHOWS == BOUNDS {
            of_pixel = cone_of_pixel(place - of_part);
        } else if is_inside {
            sight = exact_sight(column, row);
        }
        if lane < BLOCKS {
            let of_block = vec2<f32>(f32((lane & 1u) * SIDE), f32((lane >> 1u) * SIDE));
            cones[lane] = cone_of(corner + of_block - of_part);
        }
    }
    var upper = select(bitcast<f32>(shown.depth), ENDLESS_DEPTH, shown.depth == INFINITE_SINGLE);
    var lower = select(bitcast<f32>(shown.row), ENDLESS_DEPTH, shown.row == INFINITE_SINGLE);
    var limit = farthest(lane, upper);
    var computed = 0u;
    // up to three balls, and bounds of their depths; the least of those that found no room
    var kept = vec3<u32>(0u);
    var kept_lower = vec3<f32>(NONE);
    var missed = NONE;
    for (var turn = 0u; turn < 2u; turn++) {
        if turn == 1u {
            if missed <= upper {
                atomicStore(&is_again, 1u);
            }
            workgroupBarrier();
            if lane == 0u {
                is_again_shared = atomicLoad(&is_again);
            }
            if workgroupUniformLoad(&is_again_shared) == 0u {
                break;
            }
        }
        for (var first = 0u; first < total; first += 256u) {
            // steps begin at 0, but parallel views have bounds before that
            if bitcast<f32>(steps[RANGES + step_of(first)]) > max(limit, 0.0) {
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
            if IS_COUNTED && lane % 64u == 0u {
                atomicAdd(&left_out[2], min(total - first, 256u) / BLOCKS);
                atomicAdd(&left_out[3], count);
            }
            for (var i = 0u; i < count; i++) {
                let at = chosen[block * 256u + i];
                let splat = chunk[at];
                if SHOWS == BOUNDS {
                    let found = bounds_over_pixel(bitcast<vec4<f32>>(splat), place, of_pixel);
                    lower = min(lower, found.x);
                    upper = min(upper, found.y);
                    continue;
                }
                let depths = bounds(bitcast<vec4<f32>>(splat), place, sight);
                if !is_inside || depths.x > upper || depths.x >= ENDLESS_DEPTH {
                    continue;
                }
                if turn == 1u {
                    if missed <= upper {
                        computed += 1u;
                        shown = nearer(shown, splat, chunk_balls[at], place, sight);
                    }
                    continue;
                }
                upper = min(upper, depths.y);
                // in the place of one that is certainly behind
                if kept_lower.x > upper {
                    kept.x = chunk_balls[at];
                    kept_lower.x = depths.x;
                } else if kept_lower.y > upper {
                    kept.y = chunk_balls[at];
                    kept_lower.y = depths.x;
                } else if kept_lower.z > upper {
                    kept.z = chunk_balls[at];
                    kept_lower.z = depths.x;
                } else {
                    missed = min(missed, depths.x);
                }
            }
            workgroupBarrier();
            if turn == 0u {
                limit = farthest(lane, upper);
            }
        }
    }
    if missed > upper {
        // all pixels together, so that they do not wait for each other
        for (var i = 0u; i < 3u; i++) {
            if kept_lower[i] <= upper {
                computed += 1u;
                shown = nearer(shown, splats[kept[i]], kept[i], place, sight);
            }
        }
    }
    if IS_COUNTED {
        atomicAdd(&left_out[4], computed);
    }
    if SHOWS == BOUNDS {
        shown = Shown(bits_of(upper), bits_of(lower));
    }
    if is_inside {
        store(pixel, shown);
    }
}

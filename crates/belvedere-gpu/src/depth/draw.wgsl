// The nearest ball at each pixel: the twin of `depths` and `least_depth` in belvedere-core/src/depth/parallel.rs and central.rs, and of the tiles in tiles.rs.
//
// A group of threads draws a tile of 16 x 16 pixels, a thread for each. First each pixel finds, with room for what f32 rounds, a depth that the nearest ball does not
// exceed. Then the balls that may come as near are computed exactly, in whole numbers. The proof of the room is on the project's page on graphics processors.

struct Piece {
    // of this dispatch
    first_row: u32,
}

@group(0) @binding(1) var<uniform> piece: Piece;
// bits of depths, which ascend as these do
@group(0) @binding(8) var<storage, read_write> pixels: array<u32>;
@group(0) @binding(9) var<storage, read_write> rows: array<u32>;
// what a pixel's direction is made of: doubles for each column, then for each row
@group(0) @binding(13) var<storage, read> offsets: array<vec2<u32>>;

override WITH_ROWS: bool;

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
// A cone around a tile beyond this cosine is as good as everything.
const WIDEST: f32 = 0.75;

// Balls that a pixel keeps to compute them when all pixels do, so that these do not wait for each other: mostly there are one or two.
const KEPT: u32 = 4u;

// What a pixel shows.
struct Shown {
    // bits
    depth: u32,
    row: u32,
}

// A direction of sight in a view from an eye.
struct Sight {
    direction: vec3<f32>,
    depth_per_range: f32,
}

// The directions of a tile lie in this cone.
struct Cone {
    middle: vec3<f32>,
    cosine: f32,
    sine: f32,
    least_depth_per_range: f32,
}

var<workgroup> chunk: array<vec4<u32>, 256>;
var<workgroup> chunk_balls: array<u32, 256>;
var<workgroup> chunk_size: atomic<u32>;
var<workgroup> chunk_count: u32;
// where the lists of each step and level begin and end
var<workgroup> spans: array<vec2<u32>, 224>;
// where steps begin among all entries of the tile, and the end
var<workgroup> step_begins: array<u32, 33>;
var<workgroup> farthest_bits: atomic<u32>;
var<workgroup> farthest_shared: u32;
var<workgroup> cone: Cone;

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
    let side = f32(TILE);
    var found: Cone;
    found.middle = direction(corner + 0.5 * side);
    found.least_depth_per_range = 1.0;
    var cosine = 1.0;
    var sine = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let at = direction(corner + side * vec2<f32>(f32(i & 1u), f32(i >> 1u)));
        cosine = min(cosine, dot(found.middle, at));
        sine = max(sine, length(cross(found.middle, at)));
        if KIND == PERSPECTIVE {
            found.least_depth_per_range = min(found.least_depth_per_range, 0.999 * at.z);
        }
    }
    found.sine = 1.01 * sine + 1e-5;
    found.cosine = select(sqrt(max(1.0 - found.sine * found.sine, 0.0)), 0.0, cosine < WIDEST);
    return found;
}

// At most the depth of a ball anywhere in a tile.
fn least_depth(splat: vec4<f32>, corner: vec2<f32>) -> f32 {
    let radius = splat.w;
    if KIND == PARALLEL {
        let beside = max(max(corner + 0.5 - splat.xy, splat.xy - corner - (f32(TILE) - 0.5)), vec2<f32>(0.0));
        let offset = beside * view.metres_per_pixel;
        let square = radius * radius * (1.0 + SQUARE_ROOM) - dot(offset, offset) + LEAST_SQUARE;
        let room = DEPTH_ROOM * (abs(splat.z) + radius) + LEAST_ROOM;
        return select(ENDLESS_DEPTH, max(splat.z - sqrt(max(square, 0.0)) - room, 0.0), square > 0.0);
    }
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
        return ENDLESS_DEPTH;
    }
    return max((along - half_chord - 2.0 * room) * cone.least_depth_per_range, view.near);
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

// The depth that no pixel of the tile exceeds.
fn farthest(lane: u32, upper: f32) -> f32 {
    if lane == 0u {
        atomicStore(&farthest_bits, 0u);
    }
    workgroupBarrier();
    atomicMax(&farthest_bits, bitcast<u32>(upper));
    workgroupBarrier();
    if lane == 0u {
        farthest_shared = atomicLoad(&farthest_bits);
    }
    return bitcast<f32>(workgroupUniformLoad(&farthest_shared));
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
    if WITH_ROWS {
        rows[pixel] = shown.row;
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
    let column = tile.x * TILE + lane % TILE;
    let row = tile.y * TILE + lane / TILE;
    let is_inside = column < view.width && row < view.height;
    let pixel = row * view.width + column;
    let place = vec2<f32>(f32(column) + 0.5, f32(row + view.top) + 0.5);
    // pixels beside the picture are full
    var shown = Shown(select(0u, INFINITE_SINGLE, is_inside), NO_BALL);
    if is_inside && view.first_ball > 0u {
        shown.depth = pixels[pixel];
        if WITH_ROWS {
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
    if KIND != PARALLEL {
        if is_inside {
            sight = exact_sight(column, row);
        }
        if lane == 0u {
            cone = cone_of(corner - vec2<f32>(0.0, f32(view.top)));
        }
    }
    var upper = select(bitcast<f32>(shown.depth), ENDLESS_DEPTH, shown.depth == INFINITE_SINGLE);
    var limit = farthest(lane, upper);
    var computed = 0u;
    var kept: array<u32, KEPT>;
    var kept_count = 0u;
    for (var turn = 0u; turn < 2u; turn++) {
        for (var first = 0u; first < total; first += 256u) {
            if bitcast<f32>(steps[RANGES + step_of(first)]) > limit {
                break;
            }
            if lane == 0u {
                atomicStore(&chunk_size, 0u);
            }
            workgroupBarrier();
            var entry = first + lane;
            if entry < total {
                let step = step_of(entry);
                entry -= step_begins[step];
                var level = 0u;
                var of_level = spans[step];
                while entry >= of_level.y - of_level.x {
                    entry -= of_level.y - of_level.x;
                    level++;
                    of_level = spans[level * STEPS + step];
                }
                let ball = listed[of_level.x + entry];
                let splat = splats[ball];
                // a depth equal to the limit may be that of a lower row
                if least_depth(bitcast<vec4<f32>>(splat), corner) <= limit {
                    let at = atomicAdd(&chunk_size, 1u);
                    chunk[at] = splat;
                    chunk_balls[at] = ball;
                }
            }
            workgroupBarrier();
            if lane == 0u {
                chunk_count = atomicLoad(&chunk_size);
            }
            let count = workgroupUniformLoad(&chunk_count);
            if IS_COUNTED && lane == 0u {
                atomicAdd(&left_out[2], min(total - first, 256u));
                atomicAdd(&left_out[3], count);
            }
            for (var at = 0u; at < count; at++) {
                let splat = chunk[at];
                let depths = bounds(bitcast<vec4<f32>>(splat), place, sight);
                if turn == 0u {
                    upper = min(upper, depths.y);
                } else if is_inside && depths.x <= upper && depths.x < ENDLESS_DEPTH {
                    computed += 1u;
                    if kept_count < KEPT {
                        kept[kept_count] = chunk_balls[at];
                        kept_count += 1u;
                    } else {
                        shown = nearer(shown, splat, chunk_balls[at], place, sight);
                    }
                }
            }
            workgroupBarrier();
            if turn == 0u {
                limit = farthest(lane, upper);
            }
        }
        limit = farthest(lane, upper);
    }
    for (var at = 0u; at < kept_count; at++) {
        shown = nearer(shown, splats[kept[at]], kept[at], place, sight);
    }
    if IS_COUNTED {
        atomicAdd(&left_out[4], computed);
    }
    if is_inside {
        store(pixel, shown);
    }
}

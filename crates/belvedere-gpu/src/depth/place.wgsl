// Balls of a view: the twin of `place` in belvedere-core/src/depth/parallel.rs and central.rs, and of the outlines in outline.rs.
//
// Centres are exact: the whole-number arithmetic of floats.wgsl repeats that of the CPU. Everything else decides only with room: a ball of which f32 cannot tell
// whether it is drawn goes to a list, and the CPU draws it.

struct View {
    // doubles, one axis after the other
    right: array<vec2<u32>, 3>,
    down: array<vec2<u32>, 3>,
    forward: array<vec2<u32>, 3>,
    eye: array<vec2<u32>, 3>,
    // pixels per metre, a double
    scale: vec2<u32>,
    // the same, or pixels to what is seen 45 degrees off the axis, or at right angles to it
    pixels: f32,
    // metres in a pixel of a parallel view, as the CPU has it
    metres_per_pixel: f32,
    // limits of depth
    near: f32,
    far: f32,
    // a quarter of the diagonal of the smallest pixel, radians
    least_pixel: f32,
    ball_count: u32,
    // of the picture, or the part of it that is drawn now
    width: u32,
    height: u32,
    // rows of the picture above that part
    top: u32,
    // of the whole picture, pixels from the upper left corner of the part
    middle: vec2<f32>,
    // before each level
    tiles_before: array<u32, 7>,
    // of balls among those of the scene
    first_ball: u32,
    // for bounds: where lines of sight end on the viewer's side, the nearest and the farthest of them
    start: vec2<f32>,
    // for bounds: how far a ball may give way to a target, metres, and as a share of its radius
    shell: f32,
    shell_share: f32,
}

override KIND: u32;
// What pixels show: depths at their centres, the ball of each as well, or bounds of the depth over all of a pixel.
override SHOWS: u32;
// Whether work is counted: entries looked at, balls that all pixels of a block are tested with, exact depths, and all entries.
override IS_COUNTED: bool;
const PARALLEL: u32 = 0u;
const PERSPECTIVE: u32 = 1u;
const BALLS: u32 = 1u;
const BOUNDS: u32 = 2u;

@group(0) @binding(0) var<storage, read> view: View;
// centre and radius, local metres; a ball that is left out has radius 0
@group(0) @binding(2) var<storage, read> balls: array<vec4<u32>>;
// centre and radius as the CPU has them: along right, down and forward; pixels, pixels and metres in a parallel view. For bounds a radius below zero is that of a ball
// that sets no upper one.
@group(0) @binding(3) var<storage, read_write> splats: array<vec4<u32>>;
// which tiles a ball touches, and at most its least depth
@group(0) @binding(4) var<storage, read_write> touched: array<vec2<u32>>;
// see HEAD
@group(0) @binding(10) var<storage, read_write> left_out: array<atomic<u32>>;
// how many balls begin at a depth, by the first bits of that
@group(0) @binding(11) var<storage, read_write> depths: array<atomic<u32>>;

const NO_TILES: u32 = 0xffffffffu;
// Sides of tiles: 16 pixels, and four times as many for each level.
const TILE: u32 = 16u;
const LEVELS: u32 = 7u;
// More than the CPU and a device together err by at a ball, as shares of its distance (or depth) and radius: 2^-19 in parallel views, 2^-17 from an eye.
const PARALLEL_ROOM: f32 = 1.9073487e-6;
const CENTRAL_ROOM: f32 = 7.6293946e-6;
// The same for numbers too small for f32, metres.
const LEAST_ROOM: f32 = 1e-9;
// The bits of 10^9: farther places, and balls of more pixels, are the CPU's.
const FARTHEST: u32 = 0x4e6e6b28u;
const MOST_PIXELS: f32 = 1048576.0;
// Nearer ones too, metres.
const NEAREST: f32 = 1e-15;
// Pixels that all outlines are widened by.
const BEYOND: f32 = 2.0;
// An outline that reaches farther off the axis has no end: the cosine of that angle, or what stands for it on a stereographic map.
const LEAST_COSINE: f32 = 0.02;
const ENDLESS: f32 = 1e9;
// Words before the list for the CPU: balls that hold the eye, balls of the list, and what `draw` counts.
const HEAD: u32 = 8u;
// Balls in the list for the CPU.
const MOST_LEFT: u32 = 65536u;
// Of so many balls one is counted by its depth.
const SAMPLE: u32 = 16u;
const DEPTH_SHIFT: u32 = 19u;

fn leave(ball: u32) {
    let at = atomicAdd(&left_out[1], 1u);
    if at < MOST_LEFT {
        atomicStore(&left_out[HEAD + at], view.first_ball + ball);
    }
}

// Whether f32 could overflow at it. Devices need not know infinity, so that its bits are compared.
fn is_far(splat: vec4<u32>) -> bool {
    return any((splat & vec4<u32>(~SIGN)) > vec4<u32>(FARTHEST));
}

// The scalar product of an axis of the view with an offset from its corner or eye.
fn along(axis: array<vec2<u32>, 3>, offset: array<vec2<u32>, 3>) -> vec2<u32> {
    let first = add_double(multiply_double(axis[0], offset[0]), multiply_double(axis[1], offset[1]));
    return add_double(first, multiply_double(axis[2], offset[2]));
}

// Least and most slope of a ball's outline along one axis of a perspective picture, in pixels from its middle.
fn span_of_slopes(across: f32, forward: f32, radius: f32) -> vec2<f32> {
    let square = across * across + forward * forward;
    let tangent = square - radius * radius;
    if tangent <= 0.01 * square {
        return vec2<f32>(-ENDLESS, ENDLESS);
    }
    let length = sqrt(tangent);
    var span = vec2<f32>(-ENDLESS, ENDLESS);
    for (var i = 0u; i < 2u; i++) {
        let side = select(-1.0, 1.0, i == 1u);
        let cosine = (forward * length - side * radius * across) / square;
        if cosine > LEAST_COSINE {
            let slope = (across * length + side * radius * forward) / square / cosine;
            span[i] = view.pixels * slope + side * (BEYOND + view.pixels * 4e-6 / (cosine * cosine));
        }
    }
    return span;
}

// Least and most column and row of a ball's outline, pixels from the middle of the picture.
fn outline(center: vec3<f32>, distance: f32, radius: f32) -> vec4<f32> {
    if KIND == PERSPECTIVE {
        let across = span_of_slopes(center.x, center.z, radius);
        let down = span_of_slopes(center.y, center.z, radius);
        return vec4<f32>(across, down);
    }
    // a circle on the sphere is a circle on the map
    let sine = radius / distance;
    let cosine = sqrt((1.0 - sine) * (1.0 + sine));
    let divisor = cosine + center.z / distance;
    if divisor <= LEAST_COSINE {
        return vec4<f32>(-ENDLESS, ENDLESS, -ENDLESS, ENDLESS);
    }
    let middle = view.pixels * (center.xy / distance) / divisor;
    let reach = view.pixels * sine / divisor + BEYOND + view.pixels * 8e-6 / (divisor * divisor);
    return vec4<f32>(middle.x - reach, middle.x + reach, middle.y - reach, middle.y + reach);
}

// The tiles that a rectangle touches, at most three by three of the smallest that suffice, or none where it lies beside the picture.
fn tiles_of(rectangle: vec4<f32>) -> u32 {
    let size = vec2<f32>(f32(view.width), f32(view.height));
    if rectangle.y < 0.0 || rectangle.w < 0.0 || rectangle.x >= size.x || rectangle.z >= size.y {
        return NO_TILES;
    }
    let low = vec2<u32>(max(rectangle.xz, vec2<f32>(0.0)));
    let high = vec2<u32>(min(rectangle.yw, size - 1.0));
    var level = 0u;
    var first = low >> vec2<u32>(4u);
    var more = (high >> vec2<u32>(4u)) - first;
    while any(more > vec2<u32>(2u)) && level < LEVELS - 1u {
        level++;
        let shift = vec2<u32>(4u + 2u * level);
        first = low >> shift;
        more = (high >> shift) - first;
    }
    return first.x | (first.y << 12u) | (more.x << 24u) | (more.y << 26u) | (level << 28u);
}

// The radius of a ball for bounds: below zero where lines of sight may end before all of its front, so that it sets no upper bound; zero where they end behind all of it, so
// that it blocks nothing. The twin of `BallBound::radius` in bounds.rs.
fn radius_for_bounds(radius: f32, nearest: f32, farthest: f32, room: f32) -> f32 {
    if farthest + room <= view.start.x {
        return 0.0;
    }
    return select(-radius, radius, nearest - room > view.start.y);
}

fn put(ball: u32, splat: vec4<u32>, rectangle: vec4<f32>, least_depth: f32) {
    let tiles = tiles_of(rectangle);
    if tiles == NO_TILES {
        return;
    }
    let nearest = bitcast<u32>(least_depth);
    splats[ball] = splat;
    touched[ball] = vec2<u32>(tiles, nearest);
    if ball % SAMPLE == 0u {
        atomicAdd(&depths[nearest >> DEPTH_SHIFT], 1u);
    }
}

fn place_parallel(ball: u32, center: array<vec2<u32>, 3>, radius_bits: u32) {
    // where f64 says that it ends before the picture plane
    let end = add_double(center[2], double_of(radius_bits));
    if SHOWS != BOUNDS && (end.y & SIGN) != 0u && !is_zero_double(end) {
        return;
    }
    var splat = vec4<u32>(
        single_of(multiply_double(center[0], view.scale)),
        single_of(multiply_double(center[1], view.scale)),
        single_of(center[2]),
        radius_bits,
    );
    if is_far(splat) {
        leave(ball);
        return;
    }
    let radius = bitcast<f32>(radius_bits);
    let at = bitcast<vec2<f32>>(splat.xy);
    let depth = bitcast<f32>(splat.z);
    let reach = BEYOND + radius * view.pixels * 1.0001 + 1e-6 * max(abs(at.x), abs(at.y));
    let top = f32(view.top);
    let rectangle = vec4<f32>(at.x - reach, at.x + reach, at.y - top - reach, at.y - top + reach);
    if tiles_of(rectangle) == NO_TILES {
        return;
    }
    if max(max(abs(at.x), abs(at.y)), reach) > MOST_PIXELS {
        leave(ball);
        return;
    }
    let room = PARALLEL_ROOM * (abs(depth) + radius) + LEAST_ROOM;
    if SHOWS == BOUNDS {
        // the front is deepest at the rim
        splat.w = bitcast<u32>(radius_for_bounds(radius, depth - radius, depth, room));
        if splat.w == 0u {
            return;
        }
    }
    put(ball, splat, rectangle, max(depth - radius - room, 0.0));
}

fn place_central(ball: u32, exact: array<vec2<u32>, 3>, radius_bits: u32) {
    var splat = vec4<u32>(single_of(exact[0]), single_of(exact[1]), single_of(exact[2]), radius_bits);
    let center = bitcast<vec3<f32>>(splat.xyz);
    let radius = bitcast<f32>(radius_bits);
    if is_far(splat) || max(max(abs(center.x), abs(center.y)), abs(center.z)) < NEAREST {
        leave(ball);
        return;
    }
    let distance = length(center);
    let room = CENTRAL_ROOM * (distance + radius + view.near) + LEAST_ROOM;
    if radius - distance > room {
        atomicAdd(&left_out[0], 1u);
        return;
    }
    let middle = select(distance, center.z, KIND == PERSPECTIVE);
    let is_at_eye = distance - radius <= room;
    if !is_at_eye && (middle + radius < view.near - room || middle - radius - room > view.far * 1.000001) {
        return;
    }
    // a ball at whose surface the eye or the near limit is, or of which a pixel is so small a part that f32 may misplace its rim by one
    let edge = sqrt(max((distance - radius) * (distance + radius), 0.0));
    let rim = 0.125 * CENTRAL_ROOM * (distance + radius);
    if is_at_eye || middle + radius <= view.near + room || rim > 0.25 * view.least_pixel * edge {
        leave(ball);
        return;
    }
    let rectangle = outline(center, distance, radius) + view.middle.xxyy;
    var least = middle - radius - room;
    if SHOWS == BOUNDS {
        // bounds are ranges; the front is farthest where a line of sight grazes the ball
        least = distance - radius - room;
        let silhouette = sqrt(max((distance - radius + room) * (distance + radius + room), 0.0));
        splat.w = bitcast<u32>(radius_for_bounds(radius, distance - radius, silhouette, room));
        if splat.w == 0u {
            return;
        }
    }
    put(ball, splat, rectangle, max(least, view.near));
}

@compute @workgroup_size(256)
fn place(@builtin(global_invocation_id) thread: vec3<u32>) {
    let ball = thread.x;
    if ball >= view.ball_count {
        return;
    }
    touched[ball] = vec2<u32>(NO_TILES, 0u);
    let given = balls[ball];
    let is_finite = all((given & vec4<u32>(INFINITE_SINGLE)) != vec4<u32>(INFINITE_SINGLE));
    // above zero
    if !is_finite || given.w == 0u || (given.w & SIGN) != 0u {
        return;
    }
    var offset: array<vec2<u32>, 3>;
    for (var axis = 0u; axis < 3u; axis++) {
        offset[axis] = subtract_double(double_of(given[axis]), view.eye[axis]);
    }
    let center = array<vec2<u32>, 3>(along(view.right, offset), along(view.down, offset), along(view.forward, offset));
    if KIND == PARALLEL {
        place_parallel(ball, center, given.w);
    } else {
        place_central(ball, center, given.w);
    }
}

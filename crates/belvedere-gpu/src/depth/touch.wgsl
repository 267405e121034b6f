// Which tiles of the picture balls touch. The CPU has placed them (place.rs); here all is decided with room for what
// f32 rounds.

struct View {
    // pixels per metre, or pixels to what is seen 45 degrees off the axis, or at right angles to it
    pixels: f32,
    // metres in a pixel of a parallel view, as the CPU has it
    metres_per_pixel: f32,
    // limits of depth
    near: f32,
    far: f32,
    ball_count: u32,
    // of the picture, or the part of it that is drawn now
    width: u32,
    height: u32,
    // rows of the picture above that part
    top: u32,
    // of the whole picture, pixels from the upper left corner of the part
    middle: vec2<f32>,
    // of balls among those of the scene
    first_ball: u32,
    // whether no balls of the scene come after these
    is_last: u32,
    // for bounds: where lines of sight end on the viewer's side, the nearest and the farthest of them
    start: vec2<f32>,
    // for bounds: how far a ball may give way to a target, metres, and as a share of its radius
    shell: f32,
    shell_share: f32,
    // before each level
    tiles_before: array<u32, 7>,
}

override KIND: u32;
// What pixels show: depths at their centres, the ball of each as well, or bounds of the depth over all of a pixel.
override SHOWS: u32;
const PARALLEL: u32 = 0u;
const PERSPECTIVE: u32 = 1u;
const BALLS: u32 = 1u;
const BOUNDS: u32 = 2u;

@group(0) @binding(0) var<storage, read> view: View;
// Centre and radius as the CPU has them: along right, down and forward; pixels, pixels and metres in a parallel view.
// The radius of a ball that is left out is 0. For bounds a radius below zero is that of a ball that sets no upper one.
@group(0) @binding(2) var<storage, read_write> splats: array<vec4<f32>>;
// which tiles a ball touches, and at most its least depth
@group(0) @binding(3) var<storage, read_write> touched: array<vec2<u32>>;
// how many balls begin at a depth, by the first bits of that
@group(0) @binding(4) var<storage, read_write> depths: array<atomic<u32>>;

const SIGN: u32 = 0x80000000u;
const INFINITE: u32 = 0x7f800000u;
const NO_TILES: u32 = 0xffffffffu;
// Sides of tiles: 16 pixels, and four times as many for each level.
const TILE: u32 = 16u;
const LEVELS: u32 = 7u;
// More than the CPU and a device together err by at a ball, as shares of its distance (or depth) and radius: 2^-19 in
// parallel views, 2^-17 from an eye.
const PARALLEL_ROOM: f32 = 1.9073487e-6;
const CENTRAL_ROOM: f32 = 7.6293946e-6;
// The same for numbers too small for f32, metres.
const MIN_ROOM: f32 = 1e-9;
// Pixels that all outlines are widened by.
const BEYOND: f32 = 2.0;
// An outline that reaches farther off the axis has no end: the cosine of that angle, or what is in its place on a
// stereographic map.
const MIN_COSINE: f32 = 0.02;
const ENDLESS: f32 = 1e9;
// Of so many balls one is counted by its depth.
const SAMPLE: u32 = 16u;
const DEPTH_SHIFT: u32 = 19u;

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
        if cosine > MIN_COSINE {
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
    let cosine = sqrt(max((1.0 - sine) * (1.0 + sine), 0.0));
    let divisor = cosine + center.z / distance;
    if divisor <= MIN_COSINE {
        return vec4<f32>(-ENDLESS, ENDLESS, -ENDLESS, ENDLESS);
    }
    let middle = view.pixels * (center.xy / distance) / divisor;
    let reach = view.pixels * sine / divisor + BEYOND + view.pixels * 8e-6 / (divisor * divisor);
    return vec4<f32>(middle.x - reach, middle.x + reach, middle.y - reach, middle.y + reach);
}

// The tiles that a rectangle touches, at most three by three of the smallest that suffice, or none where it lies beside
// the picture.
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

// The radius of a ball for bounds: below zero where lines of sight may end before all of its front, so that it sets no
// upper bound; zero where they end behind all of it, so that it blocks nothing. The twin of `BallBound::radius` in
// bounds.rs.
fn radius_for_bounds(radius: f32, nearest: f32, farthest: f32, room: f32) -> f32 {
    if farthest + room <= view.start.x {
        return 0.0;
    }
    return select(-radius, radius, nearest - room > view.start.y);
}

fn put(ball: u32, rectangle: vec4<f32>, min_depth: f32) {
    let tiles = tiles_of(rectangle);
    if tiles == NO_TILES {
        return;
    }
    let nearest = bitcast<u32>(min_depth);
    touched[ball] = vec2<u32>(tiles, nearest);
    if ball % SAMPLE == 0u {
        atomicAdd(&depths[nearest >> DEPTH_SHIFT], 1u);
    }
}

fn touch_parallel(ball: u32, splat: vec4<f32>) {
    let radius = splat.w;
    let at = splat.xy - vec2<f32>(0.0, f32(view.top));
    let reach = BEYOND + radius * view.pixels * 1.0001 + 1e-6 * max(abs(splat.x), abs(splat.y));
    let room = PARALLEL_ROOM * (abs(splat.z) + radius) + MIN_ROOM;
    if SHOWS == BOUNDS {
        // the front is deepest at the outline
        splats[ball].w = radius_for_bounds(radius, splat.z - radius, splat.z, room);
        if splats[ball].w == 0.0 {
            return;
        }
    }
    let rectangle = vec4<f32>(at.x - reach, at.x + reach, at.y - reach, at.y + reach);
    put(ball, rectangle, max(splat.z - radius - room, 0.0));
}

fn touch_central(ball: u32, splat: vec4<f32>) {
    let radius = splat.w;
    let distance = length(splat.xyz);
    let room = CENTRAL_ROOM * (distance + radius + view.near) + MIN_ROOM;
    var nearest = select(distance, splat.z, KIND == PERSPECTIVE) - radius - room;
    if SHOWS == BOUNDS {
        // bounds are ranges; the front is farthest where a line of sight grazes the ball
        nearest = distance - radius - room;
        let silhouette = sqrt(max((distance - radius + room) * (distance + radius + room), 0.0));
        splats[ball].w = radius_for_bounds(radius, distance - radius, silhouette, room);
        if splats[ball].w == 0.0 {
            return;
        }
    }
    put(ball, outline(splat.xyz, distance, radius) + view.middle.xxyy, max(nearest, view.near));
}

@compute @workgroup_size(256)
fn touch(@builtin(global_invocation_id) thread: vec3<u32>) {
    let ball = thread.x;
    if ball >= view.ball_count {
        return;
    }
    touched[ball] = vec2<u32>(NO_TILES, 0u);
    let splat = splats[ball];
    if splat.w <= 0.0 {
        return;
    }
    if KIND == PARALLEL {
        touch_parallel(ball, splat);
    } else {
        touch_central(ball, splat);
    }
}

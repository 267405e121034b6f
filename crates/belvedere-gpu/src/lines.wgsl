// Lines of sight past balls in a tree of boxes: the twin of `BlockRule::blocks_line` in
// belvedere-core/src/blocking.rs.
//
// The CPU decides in f64. Here numbers are f32, and each comparison leaves room for what f32 rounds: a ball that blocks
// or does not block only within that room leaves the line open, and the CPU decides it. The proof of the room is on the
// project's page on graphics processors.

struct Scene {
    // middle of the tree, local metres, as the sum of two
    center: vec3<f32>,
    shell: f32,
    center_rest: vec3<f32>,
    // how much farther than their sides boxes reach, metres: more than f32 misplaces them
    widening: f32,
    // bounds of the bias, metres
    bias_low: f32,
    bias_high: f32,
    // farthest target from the middle along an axis that is looked at, metres
    farthest: f32,
    place_count: u32,
    // of this dispatch
    first_viewer: u32,
    // words of results for each viewer
    word_count: u32,
    // of this dispatch among the words of results, 32 places each
    first_word: u32,
}

struct Viewer {
    // the unit vector to one infinitely far away, or an eye, local metres
    at: vec3<f32>,
    kind: u32,
    // of an eye, what was rounded
    rest: vec3<f32>,
}

// Towards a viewer.
struct Sight {
    towards: vec3<f32>,
    // what f32 may misplace it by, as a share
    room: f32,
    // bounds of the range of the viewer
    reach: vec2<f32>,
}

@group(0) @binding(0) var<uniform> scene: Scene;
// five to a node
@group(0) @binding(1) var<storage, read> nodes: array<vec4<u32>>;
// centre and radius, local metres
@group(0) @binding(2) var<storage, read> balls: array<vec4<f32>>;
// x, y, z one after the other
@group(0) @binding(3) var<storage, read> targets: array<f32>;
@group(0) @binding(4) var<storage, read> viewers: array<Viewer>;
@group(0) @binding(5) var<storage, read_write> free: array<u32>;
@group(0) @binding(6) var<storage, read_write> blocked: array<u32>;

const FREE: u32 = 0u;
const BLOCKED: u32 = 1u;
const OPEN: u32 = 2u;

// Kinds of viewers; all others are eyes.
const NOBODY: u32 = 0u;
const DIRECTION: u32 = 1u;

// What f32 may misplace a line beside a ball by, as a share of the distance of the centre plus the radius: 2^-19, and
// thrice that for a line to an eye, whose direction is computed in f32.
const ROOM: f32 = 1.9073487e-6;
const EYE_ROOM: f32 = 5.7220459e-6;
// Range of a viewer infinitely far away.
const ENDLESS: f32 = 3e38;
// Room for numbers that are too small for f32, metres.
const MIN_ROOM: f32 = 1e-9;
// Targets nearer to an eye are left to the CPU, metres.
const MIN_RANGE: f32 = 1e-3;
const NO_SIGHT: f32 = 1.0;
// More than a square root may err by, as a share.
const ROOT_ROOM: f32 = 1e-5;
// Nodes above a node, at most.
const STACK: u32 = 32u;

var<workgroup> free_words: array<atomic<u32>, 2>;
var<workgroup> blocked_words: array<atomic<u32>, 2>;

// Bounds of `BlockRule::radius_for` for an end that lies this far outside a ball, within `room`.
fn counted(radius: f32, shell: f32, outside: f32, room: f32) -> vec2<f32> {
    var bounds = vec2<f32>(radius);
    if outside + room > -shell {
        bounds.x = radius - (shell - clamp(outside - room, 0.0, shell));
        if outside - room > -shell {
            bounds.y = radius - (shell - clamp(outside + room, 0.0, shell));
        }
    }
    return bounds;
}

fn block(ball: vec4<f32>, place: vec3<f32>, sight: Sight) -> u32 {
    let offset = ball.xyz - place;
    let radius = ball.w;
    let distance = length(offset);
    let along = dot(offset, sight.towards);
    let beside = length(offset - along * sight.towards);
    let room = sight.room * (distance + radius) + MIN_ROOM;
    if beside >= radius + room {
        return FREE;
    }
    let shell = min(scene.shell, 0.5 * radius);
    var bounds = counted(radius, shell, distance - radius, room);
    let is_to_eye = sight.reach.x < ENDLESS;
    if is_to_eye {
        // the other end, whose place along the line is known within the bounds of its range
        let from_eye = length(vec2<f32>(beside, 0.5 * (sight.reach.x + sight.reach.y) - along));
        let eye_room = 2.0 * room + (sight.reach.y - sight.reach.x);
        bounds = min(bounds, counted(radius, shell, from_eye - radius, eye_room));
    }
    let least = bounds.x;
    let most = bounds.y;
    if beside >= most + room {
        return FREE;
    }
    let half_most = (1.0 + ROOT_ROOM) * sqrt(max(most - beside + room, 0.0) * (most + beside + room)) + room;
    if along + half_most <= scene.bias_low {
        return FREE;
    }
    if is_to_eye && along - half_most >= sight.reach.y - scene.bias_low {
        return FREE;
    }
    let inside = least - beside - room;
    if inside <= 0.0 {
        return OPEN;
    }
    let half_least = (1.0 - ROOT_ROOM) * sqrt(inside * (least + beside)) - room;
    if along + half_least <= scene.bias_high {
        return OPEN;
    }
    if is_to_eye && along - half_least >= sight.reach.x - scene.bias_high {
        return OPEN;
    }
    return BLOCKED;
}

// Bytes as numbers.
fn bytes_of(word: u32) -> vec4<f32> {
    return vec4<f32>(vec4<u32>(word, word >> 8u, word >> 16u, word >> 24u) & vec4<u32>(0xffu));
}

fn along_axis(direction: f32) -> f32 {
    // a direction this flat does not leave a box's margin within any scene
    return select(1.0 / direction, select(-1e12, 1e12, direction >= 0.0), abs(direction) < 1e-12);
}

fn sight_of(place: vec3<f32>, viewer: Viewer) -> Sight {
    if viewer.kind == DIRECTION {
        return Sight(viewer.at, ROOM, vec2<f32>(ENDLESS));
    }
    let offset = (viewer.at - place) + viewer.rest;
    let range = length(offset);
    if range < MIN_RANGE {
        return Sight(vec3<f32>(0.0), NO_SIGHT, vec2<f32>(0.0));
    }
    let room = EYE_ROOM * (1.0 + length(viewer.rest) / range);
    return Sight(offset / range, room, range * vec2<f32>(1.0 - ROOT_ROOM, 1.0 + ROOT_ROOM));
}

fn line(place: vec3<f32>, sight: Sight) -> u32 {
    let origin = (place - scene.center) - scene.center_rest;
    if sight.room == NO_SIGHT || any(abs(origin) > vec3<f32>(scene.farthest)) {
        return OPEN;
    }
    let inverse = vec3<f32>(along_axis(sight.towards.x), along_axis(sight.towards.y), along_axis(sight.towards.z));
    let widening = scene.widening * abs(inverse);
    // ranges nearer to an end than the bias do not count, beyond both ends where it is below zero; a metre more does
    // not matter
    let begin = scene.bias_low - 1.0;
    let end = sight.reach.y + 1.0 - min(scene.bias_low, 0.0);
    var state = FREE;
    var stack: array<vec2<u32>, STACK>;
    var height = 0u;
    // the first of the nodes below a node; which of its parts are met, and which are nodes
    var group = vec2<u32>(0u, 0x101u);
    loop {
        if (group.y & 0xffu) == 0u {
            if height == 0u {
                break;
            }
            height--;
            group = stack[height];
        }
        let part = firstTrailingBit(group.y & 0xffu);
        group.y &= ~(1u << part);
        let node = 5u * (group.x + countOneBits((group.y >> 8u) & ((1u << part) - 1u)));
        if (group.y & 0xffu) != 0u {
            if height == STACK {
                return OPEN;
            }
            stack[height] = group;
            height++;
        }
        let head = nodes[node];
        let parts = nodes[node + 1u];
        let x_sides = nodes[node + 2u];
        let y_sides = nodes[node + 3u];
        let z_sides = nodes[node + 4u];
        let corner = (bitcast<vec3<f32>>(head.xyz) - origin) * inverse;
        let exponents = (vec3<u32>(head.w, head.w >> 8u, head.w >> 16u) & vec3<u32>(0xffu)) << vec3<u32>(23u);
        let step = bitcast<vec3<f32>>(exponents) * inverse;
        let near = corner - widening;
        let far = corner + widening;
        let are_nodes = head.w >> 24u;
        var met = 0u;
        var rows = 0u;
        for (var half = 0u; half < 2u; half++) {
            let x_low = select(x_sides.x, x_sides.y, half == 1u);
            let x_high = select(x_sides.z, x_sides.w, half == 1u);
            let y_low = select(y_sides.x, y_sides.y, half == 1u);
            let y_high = select(y_sides.z, y_sides.w, half == 1u);
            let z_low = select(z_sides.x, z_sides.y, half == 1u);
            let z_high = select(z_sides.z, z_sides.w, half == 1u);
            // the side that the line comes to first
            let enter_x = bytes_of(select(x_high, x_low, inverse.x >= 0.0)) * step.x + near.x;
            let leave_x = bytes_of(select(x_low, x_high, inverse.x >= 0.0)) * step.x + far.x;
            let enter_y = bytes_of(select(y_high, y_low, inverse.y >= 0.0)) * step.y + near.y;
            let leave_y = bytes_of(select(y_low, y_high, inverse.y >= 0.0)) * step.y + far.y;
            let enter_z = bytes_of(select(z_high, z_low, inverse.z >= 0.0)) * step.z + near.z;
            let leave_z = bytes_of(select(z_low, z_high, inverse.z >= 0.0)) * step.z + far.z;
            let enter = max(max(enter_x, enter_y), max(enter_z, vec4<f32>(begin)));
            let leave = min(min(leave_x, leave_y), leave_z);
            let meets = (enter <= leave) & (enter <= vec4<f32>(end));
            let kinds = select(parts.z, parts.w, half == 1u);
            for (var i = 0u; i < 4u; i++) {
                if meets[i] {
                    let bit = 1u << (4u * half + i);
                    let kind = (kinds >> (8u * i)) & 0xffu;
                    if (are_nodes & bit) != 0u {
                        met |= bit;
                    } else {
                        // a bit for each row, from the offset on
                        rows |= (kind >> 5u) << (kind & 31u);
                    }
                }
            }
        }
        group = vec2<u32>(parts.x, met | (are_nodes << 8u));
        while rows != 0u {
            let row = parts.y + firstTrailingBit(rows);
            rows &= rows - 1u;
            let by_ball = block(balls[row], place, sight);
            if by_ball == BLOCKED {
                return BLOCKED;
            }
            state |= by_ball;
        }
    }
    return state;
}

@compute @workgroup_size(64)
fn lines(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = scene.first_word * 32u + group.x * 64u + lane;
    let viewer_number = scene.first_viewer + group.y;
    if number < scene.place_count {
        let place = vec3<f32>(targets[3u * number], targets[3u * number + 1u], targets[3u * number + 2u]);
        let viewer = viewers[viewer_number];
        var state = OPEN;
        if viewer.kind != NOBODY {
            state = line(place, sight_of(place, viewer));
        }
        if state == FREE {
            atomicOr(&free_words[lane >> 5u], 1u << (lane & 31u));
        } else if state == BLOCKED {
            atomicOr(&blocked_words[lane >> 5u], 1u << (lane & 31u));
        }
    }
    workgroupBarrier();
    if lane < 2u {
        let word = viewer_number * scene.word_count + scene.first_word + group.x * 2u + lane;
        free[word] = atomicLoad(&free_words[lane]);
        blocked[word] = atomicLoad(&blocked_words[lane]);
    }
}

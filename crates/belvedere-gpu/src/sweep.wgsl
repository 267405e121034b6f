// Many directions swept through the layers of space: the twin of `sweep` in belvedere-core/src/query/cpu/sweep.rs.
//
// The CPU moves whole layers over a grid of lines, 64 lines a word. Here each invocation follows one line of sight through the same layers,
// by the same moves, and looks at the same bits; what it finds is the same by construction, because there are only whole numbers.
// `cell_of` is the twin of `Place::cell`, and the layer where a line starts that of `Place::layer` (belvedere-core/src/query/cpu/whole_cells.rs).

struct Space {
    // cells along x and y, and layers
    size: vec3<i32>,
    // words of a row
    width: u32,
    place_count: u32,
    // of this dispatch
    first_heading: u32,
    // words of results for each heading
    word_count: u32,
    // of this dispatch among the words of results, 32 places each
    first_word: u32,
}

// in cells, x and y with 44 bits of fraction, the height with 18
struct Place {
    x_high: i32,
    x_low: u32,
    y_high: i32,
    y_low: u32,
    height: i32,
}

// slopes with 26 bits of fraction, the rise with 18
struct Heading {
    slope_x: i32,
    slope_y: i32,
    rise: i32,
    // of its first layer among the starts
    first_start: u32,
}

// A whole number of 64 bits.
struct Wide {
    high: i32,
    low: u32,
}

@group(0) @binding(0) var<uniform> space: Space;
@group(0) @binding(1) var<storage, read> reached: array<u32>;
@group(0) @binding(2) var<storage, read> filled: array<u32>;
@group(0) @binding(3) var<storage, read> places: array<Place>;
@group(0) @binding(4) var<storage, read> headings: array<Heading>;
// for each heading and layer the first of its moves, and the one after the last
@group(0) @binding(5) var<storage, read> starts: array<u32>;
@group(0) @binding(6) var<storage, read> moves: array<vec2<i32>>;
@group(0) @binding(7) var<storage, read_write> free: array<u32>;
@group(0) @binding(8) var<storage, read_write> blocked: array<u32>;

// height of a place that is too far from the layers
const NOWHERE: i32 = -2147483647;
const HEIGHT_BITS: u32 = 18u;
const BORDER_BITS: u32 = 12u;

var<workgroup> free_words: array<atomic<u32>, 2>;
var<workgroup> blocked_words: array<atomic<u32>, 2>;

fn product(a: i32, b: i32) -> Wide {
    let x = u32(abs(a));
    let y = u32(abs(b));
    let low = (x & 0xffffu) * (y & 0xffffu);
    let cross_a = (x & 0xffffu) * (y >> 16u);
    let cross_b = (x >> 16u) * (y & 0xffffu);
    let middle = (low >> 16u) + (cross_a & 0xffffu) + (cross_b & 0xffffu);
    var result_low = (middle << 16u) | (low & 0xffffu);
    var result_high = (x >> 16u) * (y >> 16u) + (cross_a >> 16u) + (cross_b >> 16u) + (middle >> 16u);
    if (a < 0) != (b < 0) {
        result_low = ~result_low + 1u;
        result_high = ~result_high + u32(result_low == 0u);
    }
    return Wide(i32(result_high), result_low);
}

// Where a line meets the lowest level, with 12 bits of fraction.
fn line_of(high: i32, low: u32, height: i32, slope: i32) -> i32 {
    let moved = product(height, slope);
    return high - moved.high - i32(low < moved.low);
}

@compute @workgroup_size(64)
fn sweep(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = space.first_word * 32u + group.x * 64u + lane;
    let heading = headings[space.first_heading + group.y];
    var is_free = false;
    var is_blocked = false;
    if number < space.place_count {
        let place = places[number];
        let x_line = line_of(place.x_high, place.x_low, place.height, heading.slope_x);
        let y_line = line_of(place.y_high, place.y_low, place.height, heading.slope_y);
        let last = (1 << BORDER_BITS) - 1;
        let x_part = x_line & last;
        let y_part = y_line & last;
        if place.height != NOWHERE && x_part > 0 && x_part < last && y_part > 0 && y_part < last {
            let cell = vec2<i32>(x_line >> BORDER_BITS, y_line >> BORDER_BITS);
            let own = min((place.height + heading.rise) >> HEIGHT_BITS, space.size.z - 1);
            let first = max(own, 0);
            is_free = true;
            // moves of layers up to the place's own only tell whether a ball reaches the line
            let after_own = starts[heading.first_start + u32(own + 1)];
            let end = starts[heading.first_start + u32(space.size.z)];
            var layer = first;
            var layer_end = starts[heading.first_start + u32(first) + 1u];
            for (var step = starts[heading.first_start + u32(first)]; step < end; step++) {
                while step >= layer_end {
                    layer++;
                    layer_end = starts[heading.first_start + u32(layer) + 1u];
                }
                let at = cell + moves[step];
                // lines do not come back; one cell of play, because moves are rounded
                if (heading.slope_x >= 0 && at.x > space.size.x) || (heading.slope_x <= 0 && at.x < -1)
                    || (heading.slope_y >= 0 && at.y > space.size.y) || (heading.slope_y <= 0 && at.y < -1) {
                    break;
                }
                if any(at < vec2<i32>(0)) || any(at >= space.size.xy) {
                    continue;
                }
                let word = u32(layer * space.size.y + at.y) * space.width + (u32(at.x) >> 5u);
                let bit = u32(at.x) & 31u;
                if ((reached[word] >> bit) & 1u) == 1u {
                    is_free = false;
                    if step >= after_own && ((filled[word] >> bit) & 1u) == 1u {
                        is_blocked = true;
                        break;
                    }
                }
            }
        }
    }
    if is_free {
        atomicOr(&free_words[lane >> 5u], 1u << (lane & 31u));
    }
    if is_blocked {
        atomicOr(&blocked_words[lane >> 5u], 1u << (lane & 31u));
    }
    workgroupBarrier();
    if lane < 2u {
        let word = (space.first_heading + group.y) * space.word_count + space.first_word + group.x * 2u + lane;
        free[word] = atomicLoad(&free_words[lane]);
        blocked[word] = atomicLoad(&blocked_words[lane]);
    }
}

// Which tiles have to look at which balls, nearest balls first, as far as steps of depth tell.
//
// A list of balls for each step of depth of each tile of each level: counted, summed up and filled. The order within a
// list is left to chance; pixels do not depend on it.

// entries of each list, then where it begins, then where it ends, within a block
@group(0) @binding(5) var<storage, read_write> counters: array<atomic<u32>>;
// entries before each block of lists
@group(0) @binding(6) var<storage, read_write> before: array<u32>;
@group(0) @binding(7) var<storage, read_write> listed: array<u32>;
// the step of each range of depths, and the least depth of the balls of a step and all after it
@group(0) @binding(12) var<storage, read_write> steps: array<u32>;

// Steps of depth.
const STEPS: u32 = 32u;
// Ranges of depth with the same first bits.
const RANGES: u32 = 4096u;
// Lists whose entries a group of threads sums up.
const BLOCK: u32 = 2048u;

var<workgroup> sums: array<u32, 256>;
var<workgroup> nearest_of_steps: array<atomic<u32>, 32>;

// What the threads before this one have together. The last of the sums is that of all threads.
fn sum_before(lane: u32, own: u32) -> u32 {
    sums[lane] = own;
    workgroupBarrier();
    for (var by = 1u; by < 256u; by *= 2u) {
        var sum = sums[lane];
        if lane >= by {
            sum += sums[lane - by];
        }
        workgroupBarrier();
        sums[lane] = sum;
        workgroupBarrier();
    }
    return sums[lane] - own;
}

// Steps with about as many balls each, from the balls that were counted by their depth.
@compute @workgroup_size(256)
fn share_depths(@builtin(local_invocation_index) lane: u32) {
    if lane < STEPS {
        atomicStore(&nearest_of_steps[lane], INFINITE);
    }
    let of_thread = RANGES / 256u;
    var own = 0u;
    for (var i = 0u; i < of_thread; i++) {
        own += atomicLoad(&depths[lane * of_thread + i]);
    }
    var sum = sum_before(lane, own);
    let of_step = max(sums[255] / STEPS, 1u);
    for (var i = 0u; i < of_thread; i++) {
        let range = lane * of_thread + i;
        let step = min(sum / of_step, STEPS - 1u);
        steps[range] = step;
        atomicMin(&nearest_of_steps[step], range << DEPTH_SHIFT);
        sum += atomicLoad(&depths[range]);
    }
    workgroupBarrier();
    if lane < STEPS {
        var nearest = INFINITE;
        for (var step = lane; step < STEPS; step++) {
            nearest = min(nearest, atomicLoad(&nearest_of_steps[step]));
        }
        steps[RANGES + lane] = nearest;
    }
}

// The number of the list of a tile of a ball.
fn list_of(touch: vec2<u32>, column: u32, row: u32) -> u32 {
    let level = touch.x >> 28u;
    let side = TILE << (2u * level);
    let columns = (view.width + side - 1u) / side;
    let first = vec2<u32>(touch.x, touch.x >> 12u) & vec2<u32>(0xfffu);
    let tile = view.tiles_before[level] + (first.y + row) * columns + first.x + column;
    return tile * STEPS + steps[touch.y >> DEPTH_SHIFT];
}

@compute @workgroup_size(256)
fn count(@builtin(global_invocation_id) thread: vec3<u32>) {
    if thread.x >= view.ball_count {
        return;
    }
    let touch = touched[thread.x];
    if touch.x == NO_TILES {
        return;
    }
    for (var row = 0u; row <= ((touch.x >> 26u) & 3u); row++) {
        for (var column = 0u; column <= ((touch.x >> 24u) & 3u); column++) {
            atomicAdd(&counters[list_of(touch, column, row)], 1u);
        }
    }
}

// Where lists begin within their block.
@compute @workgroup_size(256)
fn sum_lists(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let of_thread = BLOCK / 256u;
    let first = group.x * BLOCK + lane * of_thread;
    var own = 0u;
    for (var i = 0u; i < of_thread; i++) {
        own += atomicLoad(&counters[first + i]);
    }
    var sum = sum_before(lane, own);
    for (var i = 0u; i < of_thread; i++) {
        let count = atomicLoad(&counters[first + i]);
        atomicStore(&counters[first + i], sum);
        sum += count;
    }
    if lane == 255u {
        before[group.x] = sum;
    }
}

// Where blocks begin.
@compute @workgroup_size(256)
fn sum_blocks(@builtin(local_invocation_index) lane: u32) {
    let of_thread = BLOCK / 256u;
    var own = 0u;
    for (var i = 0u; i < of_thread; i++) {
        own += before[lane * of_thread + i];
    }
    var sum = sum_before(lane, own);
    for (var i = 0u; i < of_thread; i++) {
        let count = before[lane * of_thread + i];
        before[lane * of_thread + i] = sum;
        sum += count;
    }
}

@compute @workgroup_size(256)
fn fill(@builtin(global_invocation_id) thread: vec3<u32>) {
    if thread.x >= view.ball_count {
        return;
    }
    let touch = touched[thread.x];
    if touch.x == NO_TILES {
        return;
    }
    for (var row = 0u; row <= ((touch.x >> 26u) & 3u); row++) {
        for (var column = 0u; column <= ((touch.x >> 24u) & 3u); column++) {
            let list = list_of(touch, column, row);
            listed[before[list / BLOCK] + atomicAdd(&counters[list], 1u)] = thread.x;
        }
    }
}

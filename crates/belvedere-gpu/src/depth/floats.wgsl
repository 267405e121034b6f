// Arithmetic of IEEE 754 in whole numbers: the same bits as the CPU's on every device.
//
// Devices may join a product and a sum, flush small numbers to zero, and err in quotients and roots. Whole numbers they compute alike. Here a number of single
// precision is its bits in a word, one of double precision its bits in two, the low one first. Results are rounded to the nearest, ties to even, small numbers kept;
// every NaN is one of two constants.

const NAN_SINGLE: u32 = 0x7fc00000u;
const INFINITE_SINGLE: u32 = 0x7f800000u;
const SIGN: u32 = 0x80000000u;
const NAN_DOUBLE: vec2<u32> = vec2<u32>(0u, 0x7ff80000u);
const INFINITE_DOUBLE: u32 = 0x7ff00000u;

// Sixty-four bits in two words.

fn sum_64(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn difference_64(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}

fn is_less_64(a: vec2<u32>, b: vec2<u32>) -> bool {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

fn left_64(a: vec2<u32>, by: u32) -> vec2<u32> {
    if by == 0u {
        return a;
    }
    if by >= 32u {
        return vec2<u32>(0u, a.x << (by & 31u));
    }
    return vec2<u32>(a.x << by, (a.y << by) | (a.x >> (32u - by)));
}

// What is shifted out is kept in the lowest bit, which says that the number is a little larger.
fn right_64(a: vec2<u32>, by: u32) -> vec2<u32> {
    if by == 0u {
        return a;
    }
    if by >= 64u {
        return vec2<u32>(select(0u, 1u, (a.x | a.y) != 0u), 0u);
    }
    if by == 32u {
        return vec2<u32>(a.y | select(0u, 1u, a.x != 0u), 0u);
    }
    if by > 32u {
        let lost = a.x | (a.y << (64u - by));
        return vec2<u32>((a.y >> (by & 31u)) | select(0u, 1u, lost != 0u), 0u);
    }
    let lost = a.x << (32u - by);
    return vec2<u32>((a.x >> by) | (a.y << (32u - by)) | select(0u, 1u, lost != 0u), a.y >> by);
}

fn right_32(a: u32, by: u32) -> u32 {
    if by == 0u {
        return a;
    }
    if by >= 32u {
        return select(0u, 1u, a != 0u);
    }
    return (a >> by) | select(0u, 1u, (a << (32u - by)) != 0u);
}

fn leading_zeros_64(a: vec2<u32>) -> u32 {
    return select(countLeadingZeros(a.y), 32u + countLeadingZeros(a.x), a.y == 0u);
}

fn product_64(a: u32, b: u32) -> vec2<u32> {
    let a_low = a & 0xffffu;
    let a_high = a >> 16u;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let low = a_low * b_low;
    let one = a_high * b_low + (low >> 16u);
    let other = a_low * b_high + (one & 0xffffu);
    return vec2<u32>((other << 16u) | (low & 0xffffu), a_high * b_high + (one >> 16u) + (other >> 16u));
}

// Single precision.

fn is_nan_single(a: u32) -> bool {
    return (a & ~SIGN) > INFINITE_SINGLE;
}

// Bits in the order of the numbers, for all but NaN: both zeros are equal.
fn order_single(a: u32) -> i32 {
    let size = bitcast<i32>(a & ~SIGN);
    return select(size, -size, (a & SIGN) != 0u);
}

// A number of a sign, whose significand has its highest bit at 30, or less where the exponent is one.
fn rounded_single(sign: u32, exponent: i32, significand: u32) -> u32 {
    var left = significand;
    var at = exponent;
    if at < 1 {
        left = right_32(left, u32(1 - at));
        at = 1;
    }
    if at >= 255 {
        return sign | INFINITE_SINGLE;
    }
    let rest = left & 127u;
    var kept = left >> 7u;
    kept += select(0u, 1u, rest > 64u || (rest == 64u && (kept & 1u) == 1u));
    // the highest bit counts the exponent up by one; from the largest numbers on that is infinity
    return sign | (kept + (u32(at - 1) << 23u));
}

// The significand of a number that is neither zero nor infinite, with its highest bit at 23, and the exponent.
fn normal_single(a: u32) -> vec2<u32> {
    let exponent = (a >> 23u) & 255u;
    let fraction = a & 0x7fffffu;
    if exponent != 0u {
        return vec2<u32>(fraction | 0x800000u, exponent);
    }
    let by = countLeadingZeros(fraction) - 8u;
    return vec2<u32>(fraction << by, 1u - by);
}

fn add_single(a: u32, b: u32) -> u32 {
    let is_ordered = (a & ~SIGN) >= (b & ~SIGN);
    let large = select(b, a, is_ordered);
    let small = select(a, b, is_ordered);
    let sign = large & SIGN;
    let is_sum = ((large ^ small) & SIGN) == 0u;
    if (large & ~SIGN) >= INFINITE_SINGLE {
        let is_nan = is_nan_single(large) || (!is_sum && (small & ~SIGN) == INFINITE_SINGLE);
        return select(large, NAN_SINGLE, is_nan);
    }
    let large_field = (large >> 23u) & 255u;
    let small_field = (small >> 23u) & 255u;
    var exponent = max(large_field, 1u);
    var significand = ((large & 0x7fffffu) | select(0u, 0x800000u, large_field != 0u)) << 7u;
    var other = ((small & 0x7fffffu) | select(0u, 0x800000u, small_field != 0u)) << 7u;
    other = right_32(other, exponent - max(small_field, 1u));
    if is_sum {
        significand += other;
        if (significand & SIGN) != 0u {
            significand = right_32(significand, 1u);
            exponent += 1u;
        }
    } else {
        significand -= other;
        if significand == 0u {
            return 0u;
        }
        let by = min(countLeadingZeros(significand) - 1u, exponent - 1u);
        significand <<= by;
        exponent -= by;
    }
    return rounded_single(sign, i32(exponent), significand);
}

fn subtract_single(a: u32, b: u32) -> u32 {
    return add_single(a, b ^ SIGN);
}

fn multiply_single(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    let a_size = a & ~SIGN;
    let b_size = b & ~SIGN;
    if max(a_size, b_size) >= INFINITE_SINGLE {
        let is_nan = max(a_size, b_size) > INFINITE_SINGLE || min(a_size, b_size) == 0u;
        return select(sign | INFINITE_SINGLE, NAN_SINGLE, is_nan);
    }
    if min(a_size, b_size) == 0u {
        return sign;
    }
    let x = normal_single(a);
    let y = normal_single(b);
    let product = product_64(x.x << 8u, y.x << 7u);
    let significand = product.y | select(0u, 1u, product.x != 0u);
    let exponent = bitcast<i32>(x.y) + bitcast<i32>(y.y) - 127;
    if (product.y & 0x40000000u) != 0u {
        return rounded_single(sign, exponent + 1, significand);
    }
    return rounded_single(sign, exponent, significand << 1u);
}

struct Root {
    // two bits of what the root is taken of for each of the root's
    waiting: u32,
    rest: u32,
    root: u32,
}

fn next_bit(so_far: Root) -> Root {
    let rest = (so_far.rest << 2u) | (so_far.waiting >> 30u);
    let next = (so_far.root << 2u) | 1u;
    let is_one = rest >= next;
    return Root(so_far.waiting << 2u, select(rest, rest - next, is_one), (so_far.root << 1u) | select(0u, 1u, is_one));
}

fn next_six_bits(so_far: Root) -> Root {
    return next_bit(next_bit(next_bit(next_bit(next_bit(next_bit(so_far))))));
}

// Without a loop: depths need many roots, and software devices end loops that turn too often.
fn root_single(a: u32) -> u32 {
    if (a & ~SIGN) == 0u || a == INFINITE_SINGLE {
        return a;
    }
    if a > INFINITE_SINGLE {
        return NAN_SINGLE;
    }
    let x = normal_single(a);
    let exponent = bitcast<i32>(x.y) - 127;
    let begin = Root(x.x << (7u + (u32(exponent) & 1u)), 0u, 0u);
    let all = next_bit(next_bit(next_six_bits(next_six_bits(next_six_bits(next_six_bits(begin))))));
    return rounded_single(0u, (exponent >> 1u) + 127, (all.root << 5u) | select(0u, 1u, all.rest != 0u));
}

// Double precision.

fn rounded_double(sign: u32, exponent: i32, significand: vec2<u32>) -> vec2<u32> {
    var left = significand;
    var at = exponent;
    if at < 1 {
        left = right_64(left, u32(1 - at));
        at = 1;
    }
    if at >= 2047 {
        return vec2<u32>(0u, sign | INFINITE_DOUBLE);
    }
    let rest = left.x & 1023u;
    let kept = vec2<u32>((left.x >> 10u) | (left.y << 22u), left.y >> 10u);
    let up = select(0u, 1u, rest > 512u || (rest == 512u && (kept.x & 1u) == 1u));
    let rounded = sum_64(kept, vec2<u32>(up, 0u));
    return vec2<u32>(rounded.x, sign | (rounded.y + (u32(at - 1) << 20u)));
}

struct NormalDouble {
    // the highest bit at 52
    significand: vec2<u32>,
    exponent: i32,
}

fn normal_double(a: vec2<u32>) -> NormalDouble {
    let exponent = (a.y >> 20u) & 2047u;
    let fraction = vec2<u32>(a.x, a.y & 0xfffffu);
    if exponent != 0u {
        return NormalDouble(fraction | vec2<u32>(0u, 0x100000u), i32(exponent));
    }
    let by = leading_zeros_64(fraction) - 11u;
    return NormalDouble(left_64(fraction, by), 1 - i32(by));
}

fn size_double(a: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x, a.y & ~SIGN);
}

fn is_nan_double(a: vec2<u32>) -> bool {
    return is_less_64(vec2<u32>(0u, INFINITE_DOUBLE), size_double(a));
}

fn is_zero_double(a: vec2<u32>) -> bool {
    return (a.x | (a.y & ~SIGN)) == 0u;
}

fn add_double(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let is_swapped = is_less_64(size_double(a), size_double(b));
    let large = select(a, b, is_swapped);
    let small = select(b, a, is_swapped);
    let sign = large.y & SIGN;
    let is_sum = ((large.y ^ small.y) & SIGN) == 0u;
    if (large.y & ~SIGN) >= INFINITE_DOUBLE {
        let is_nan = is_nan_double(large) || (!is_sum && (small.y & ~SIGN) == INFINITE_DOUBLE);
        return select(large, NAN_DOUBLE, is_nan);
    }
    let large_field = (large.y >> 20u) & 2047u;
    let small_field = (small.y >> 20u) & 2047u;
    var exponent = max(large_field, 1u);
    let top = vec2<u32>(select(0u, 0x100000u, large_field != 0u), select(0u, 0x100000u, small_field != 0u));
    var significand = left_64(vec2<u32>(large.x, (large.y & 0xfffffu) | top.x), 10u);
    var other = left_64(vec2<u32>(small.x, (small.y & 0xfffffu) | top.y), 10u);
    other = right_64(other, exponent - max(small_field, 1u));
    if is_sum {
        significand = sum_64(significand, other);
        if (significand.y & SIGN) != 0u {
            significand = right_64(significand, 1u);
            exponent += 1u;
        }
    } else {
        significand = difference_64(significand, other);
        if (significand.x | significand.y) == 0u {
            return vec2<u32>(0u);
        }
        let by = min(leading_zeros_64(significand) - 1u, exponent - 1u);
        significand = left_64(significand, by);
        exponent -= by;
    }
    return rounded_double(sign, i32(exponent), significand);
}

fn subtract_double(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return add_double(a, vec2<u32>(b.x, b.y ^ SIGN));
}

fn multiply_double(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let sign = (a.y ^ b.y) & SIGN;
    let has_zero = is_zero_double(a) || is_zero_double(b);
    if max(a.y & ~SIGN, b.y & ~SIGN) >= INFINITE_DOUBLE {
        let is_nan = has_zero || is_nan_double(a) || is_nan_double(b);
        return select(vec2<u32>(0u, sign | INFINITE_DOUBLE), NAN_DOUBLE, is_nan);
    }
    if has_zero {
        return vec2<u32>(0u, sign);
    }
    let x = normal_double(a);
    let y = normal_double(b);
    let one = left_64(x.significand, 11u);
    let other = left_64(y.significand, 10u);
    let lowest = product_64(one.x, other.x);
    let cross = product_64(one.x, other.y);
    let across = product_64(one.y, other.x);
    let middle = sum_64(sum_64(vec2<u32>(lowest.y, 0u), vec2<u32>(cross.x, 0u)), vec2<u32>(across.x, 0u));
    var high = product_64(one.y, other.y);
    high = sum_64(sum_64(high, vec2<u32>(cross.y, 0u)), sum_64(vec2<u32>(across.y, 0u), vec2<u32>(middle.y, 0u)));
    high.x |= select(0u, 1u, (lowest.x | middle.x) != 0u);
    let exponent = x.exponent + y.exponent - 1023;
    if (high.y & 0x40000000u) != 0u {
        return rounded_double(sign, exponent + 1, high);
    }
    return rounded_double(sign, exponent, left_64(high, 1u));
}

struct Division {
    digit: u32,
    rest: vec2<u32>,
}

// Sixteen bits more of a quotient: how often a divisor, whose highest bit is at 63, goes into 2^16 times a number below it.
fn next_digit(number: vec2<u32>, divisor: vec2<u32>) -> Division {
    // from the first words only: the digit, or one or two more (Knuth 1997, section 4.3.1, theorem B)
    var digit = min(number.y / (divisor.y >> 16u), 0xffffu);
    let low = product_64(digit, divisor.x);
    let high = sum_64(product_64(digit, divisor.y), vec2<u32>(low.y, 0u));
    let taken = vec2<u32>(low.x, high.x);
    let given = vec2<u32>(number.x << 16u, (number.y << 16u) | (number.x >> 16u));
    var rest = difference_64(given, taken);
    var top = (number.y >> 16u) - high.y - select(0u, 1u, is_less_64(given, taken));
    for (var i = 0u; i < 2u; i++) {
        if (top & SIGN) != 0u {
            digit -= 1u;
            rest = sum_64(rest, divisor);
            top += select(0u, 1u, is_less_64(rest, divisor));
        }
    }
    return Division(digit, rest);
}

fn divide_double(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let sign = (a.y ^ b.y) & SIGN;
    let is_a_infinite = (a.y & ~SIGN) >= INFINITE_DOUBLE;
    let is_b_infinite = (b.y & ~SIGN) >= INFINITE_DOUBLE;
    let is_a_zero = is_zero_double(a);
    let is_b_zero = is_zero_double(b);
    if is_nan_double(a) || is_nan_double(b) || (is_a_infinite && is_b_infinite) || (is_a_zero && is_b_zero) {
        return NAN_DOUBLE;
    }
    if is_a_infinite || is_b_zero {
        return vec2<u32>(0u, sign | INFINITE_DOUBLE);
    }
    if is_a_zero || is_b_infinite {
        return vec2<u32>(0u, sign);
    }
    let x = normal_double(a);
    let y = normal_double(b);
    let divisor = left_64(y.significand, 11u);
    let first = next_digit(left_64(x.significand, 10u), divisor);
    let second = next_digit(first.rest, divisor);
    let third = next_digit(second.rest, divisor);
    let fourth = next_digit(third.rest, divisor);
    var quotient = vec2<u32>((third.digit << 16u) | fourth.digit, (first.digit << 16u) | second.digit);
    var exponent = x.exponent - y.exponent + 1023;
    if (quotient.y & SIGN) != 0u {
        quotient = right_64(quotient, 1u);
    } else {
        exponent -= 1;
    }
    quotient.x |= select(0u, 1u, (fourth.rest.x | fourth.rest.y) != 0u);
    return rounded_double(sign, exponent, quotient);
}

fn root_double(a: vec2<u32>) -> vec2<u32> {
    if is_zero_double(a) || (a.y == INFINITE_DOUBLE && a.x == 0u) {
        return a;
    }
    if a.y >= INFINITE_DOUBLE {
        return NAN_DOUBLE;
    }
    let x = normal_double(a);
    let exponent = x.exponent - 1023;
    var waiting = left_64(x.significand, 10u + (u32(exponent) & 1u));
    var rest = vec2<u32>(0u);
    var root = vec2<u32>(0u);
    for (var i = 0u; i < 55u; i++) {
        rest = vec2<u32>((rest.x << 2u) | (waiting.y >> 30u), (rest.y << 2u) | (rest.x >> 30u));
        waiting = vec2<u32>(waiting.x << 2u, (waiting.y << 2u) | (waiting.x >> 30u));
        let next = vec2<u32>((root.x << 2u) | 1u, (root.y << 2u) | (root.x >> 30u));
        root = vec2<u32>(root.x << 1u, (root.y << 1u) | (root.x >> 31u));
        if !is_less_64(rest, next) {
            rest = difference_64(rest, next);
            root.x |= 1u;
        }
    }
    root = left_64(root, 8u);
    root.x |= select(0u, 1u, (rest.x | rest.y) != 0u);
    return rounded_double(0u, (exponent >> 1u) + 1023, root);
}

fn double_of(a: u32) -> vec2<u32> {
    let sign = a & SIGN;
    let size = a & ~SIGN;
    if size == 0u {
        return vec2<u32>(0u, sign);
    }
    if size >= INFINITE_SINGLE {
        return select(vec2<u32>(0u, sign | INFINITE_DOUBLE), NAN_DOUBLE, size > INFINITE_SINGLE);
    }
    let x = normal_single(a);
    let fraction = x.x & 0x7fffffu;
    let exponent = bitcast<u32>(bitcast<i32>(x.y) + 896);
    return vec2<u32>(fraction << 29u, sign | (exponent << 20u) | (fraction >> 3u));
}

fn single_of(a: vec2<u32>) -> u32 {
    let sign = a.y & SIGN;
    if is_nan_double(a) {
        return NAN_SINGLE;
    }
    let field = (a.y >> 20u) & 2047u;
    // what is smaller than any number of single precision, small numbers of double precision among them
    if field < 870u {
        return sign;
    }
    let significand = left_64(vec2<u32>(a.x, (a.y & 0xfffffu) | 0x100000u), 10u);
    return rounded_single(sign, i32(field) - 896, significand.y | select(0u, 1u, significand.x != 0u));
}

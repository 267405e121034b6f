//! The arithmetic of floats.wgsl is that of the CPU, bit by bit: on random and on hostile numbers, on every device of the computer.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crate::device::{Device, devices};
use belvedere_data::random::uniform;
use bytemuck::cast_slice;
use std::io::Write;

/// What each operation is on the CPU, for two numbers in 64 bits each; numbers of single precision have the lower half.
type Twin = fn(u64, u64) -> u64;

/// The call in the shader, and its twin. Both work on `a` and `b`, pairs of words.
const OPERATIONS: [(&str, Twin); 13] = [
    ("vec2<u32>(add_single(a.x, b.x), 0u)", |a, b| single(of_single(a) + of_single(b))),
    ("vec2<u32>(subtract_single(a.x, b.x), 0u)", |a, b| single(of_single(a) - of_single(b))),
    ("vec2<u32>(multiply_single(a.x, b.x), 0u)", |a, b| single(of_single(a) * of_single(b))),
    ("vec2<u32>(root_single(a.x), 0u)", |a, _| single(of_single(a).sqrt())),
    ("vec2<u32>(select(0u, 1u, order_single(a.x) < order_single(b.x)), 0u)", |a, b| {
        // its places are not compared where a number is none
        u64::from(of_single(a) < of_single(b))
    }),
    ("vec2<u32>(select(0u, 1u, order_single(a.x) == order_single(b.x)), 0u)", |a, b| {
        u64::from(of_single(a) == of_single(b))
    }),
    ("double_of(a.x)", |a, _| double(f64::from(of_single(a)))),
    ("add_double(a, b)", |a, b| double(of_double(a) + of_double(b))),
    ("subtract_double(a, b)", |a, b| double(of_double(a) - of_double(b))),
    ("multiply_double(a, b)", |a, b| double(of_double(a) * of_double(b))),
    ("divide_double(a, b)", |a, b| double(of_double(a) / of_double(b))),
    ("root_double(a)", |a, _| double(of_double(a).sqrt())),
    ("vec2<u32>(single_of(a), 0u)", |a, _| {
        #[expect(clippy::cast_possible_truncation, reason = "rounding is what is tested")]
        single(of_double(a) as f32)
    }),
];
/// The number of the first operation on numbers of double precision, and those of comparisons.
const FIRST_OF_DOUBLES: usize = 7;
const COMPARISONS: std::ops::Range<usize> = 4..6;

#[expect(clippy::cast_possible_truncation, reason = "the lower half")]
fn of_single(bits: u64) -> f32 {
    f32::from_bits(bits as u32)
}

fn of_double(bits: u64) -> f64 {
    f64::from_bits(bits)
}

/// Bits, with one NaN for all.
fn single(v: f32) -> u64 {
    u64::from(if v.is_nan() { 0x7fc0_0000 } else { v.to_bits() })
}

fn double(v: f64) -> u64 {
    if v.is_nan() { 0x7ff8_0000_0000_0000 } else { v.to_bits() }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number below 2^32")]
fn random_word(i: u64) -> u64 {
    (uniform(77, i) * 4_294_967_296.0) as u64
}

fn random_bits(i: u64) -> u64 {
    random_word(2 * i) | random_word(2 * i + 1) << 32
}

/// Bits of numbers at whose edges arithmetic changes, and their neighbours: with `digits` after the point and exponents up to `most`.
fn hostile(digits: u32, most: u64) -> Vec<u64> {
    let exponents = [0, 1, 2, digits.into(), most / 2 - 1, most / 2, most / 2 + u64::from(digits), most - 1, most];
    let fractions = [0, 1, 2, (1 << digits) - 1, 1 << (digits - 1), (1 << (digits - 1)) + 1, 0x5a5a5 % (1 << digits)];
    let sign = 1 << (if digits == 23 { 31 } else { 63 });
    let all = exponents.iter().flat_map(|exponent| fractions.map(|fraction| exponent << digits | fraction));
    all.flat_map(|bits| [bits, bits | sign]).collect()
}

/// Pairs of numbers: hostile ones with each other, random bits, numbers close to each other, and numbers as they occur in scenes.
fn pairs(digits: u32, most: u64) -> Vec<[u64; 2]> {
    let hostile = hostile(digits, most);
    let mut pairs: Vec<[u64; 2]> = hostile.iter().flat_map(|&a| hostile.iter().map(move |&b| [a, b])).collect();
    let sign_bit = if digits == 23 { 31 } else { 63 };
    for i in 0..40_000 {
        let (a, b) = (random_bits(3 * i), random_bits(3 * i + 1));
        // the exponent of the second is at most a few steps from that of the first, or the fractions differ in few bits
        let near = match i % 4 {
            0 => b,
            1 => a ^ (b >> (64 - (digits + 4))),
            2 => a ^ (b & 7) ^ (b & 1 << sign_bit),
            _ => {
                let usual = |bits: u64| (bits & ((1 << digits) - 1)) | (most / 2 - 8 + (bits >> 40) % 20) << digits;
                pairs.push([usual(a), usual(b) | (b & 1 << sign_bit)]);
                b ^ 1 << sign_bit
            }
        };
        pairs.push([a, near]);
    }
    pairs
}

/// What the device makes of pairs.
fn on_device(device: &Device, call: &str, pairs: &[[u64; 2]]) -> Vec<u64> {
    let shader = format!(
        "{}
@group(0) @binding(0) var<storage, read> given: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> results: array<vec2<u32>>;
@compute @workgroup_size(64)
fn check(@builtin(global_invocation_id) thread: vec3<u32>) {{
    if thread.x < arrayLength(&results) {{
        let a = given[thread.x].xy;
        let b = given[thread.x].zw;
        results[thread.x] = {call};
    }}
}}",
        include_str!("floats.wgsl")
    );
    let wgpu = &device.device;
    let module = wgpu.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    let pipeline = wgpu.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("check"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let size = 8 * pairs.len() as u64;
    let buffer =
        |usage| wgpu.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let results = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let staging = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let given = device.filled_buffer(cast_slice(pairs));
    let bindings = wgpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: given.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: results.as_entire_binding() },
        ],
    });
    let mut encoder = wgpu.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(u32::try_from(pairs.len().div_ceil(64)).unwrap_or(0), 1, 1);
    }
    encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, size);
    device.queue.submit([encoder.finish()]);
    staging.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.wait_for(None).unwrap();
    let bytes = staging.slice(..).get_mapped_range().unwrap();
    bytes.as_chunks::<8>().0.iter().map(|word| u64::from_le_bytes(*word)).collect()
}

#[test]
fn whole_numbers_give_the_same_bits_as_floating_point() {
    let found = devices();
    if found.is_empty() {
        let what = "this computer has no device with a driver for Vulkan, Metal or DirectX 12";
        let _ =
            writeln!(std::io::stderr().lock(), "SKIPPED whole_numbers_give_the_same_bits_as_floating_point: {what}");
    }
    let [singles, doubles] = [pairs(23, 255), pairs(52, 2047)];
    for info in found {
        let device = Device::open(info.number).unwrap();
        for (number, (call, twin)) in OPERATIONS.iter().enumerate() {
            let pairs = if number < FIRST_OF_DOUBLES { &singles } else { &doubles };
            let results = on_device(&device, call, pairs);
            assert_eq!(results.len(), pairs.len());
            for (&[a, b], result) in pairs.iter().zip(results) {
                if COMPARISONS.contains(&number) && (of_single(a).is_nan() || of_single(b).is_nan()) {
                    continue;
                }
                assert_eq!(result, twin(a, b), "{call} of {a:#x} and {b:#x} on {}", device.info.name);
            }
        }
    }
}

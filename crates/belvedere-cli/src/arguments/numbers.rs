//! Parsers of numbers that are typed, with their limits.

use belvedere::crs::Crs;
use std::str::FromStr;

pub(super) fn known_crs(text: &str) -> Result<String, String> {
    Crs::parse(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

pub(super) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("must be a whole number of at least 1".to_owned()),
        Ok(count) => Ok(count),
    }
}

/// More targets than this fill the memory of most machines, so that a slipped digit is an error and not a crash.
const MOST_TARGETS: usize = 1_000_000_000;

pub(super) fn target_count(text: &str) -> Result<usize, String> {
    at_least_one(text)
        .ok()
        .filter(|&count| count <= MOST_TARGETS)
        .ok_or_else(|| format!("must be a whole number from 1 to {MOST_TARGETS}"))
}

pub(super) fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "must be a finite number".to_owned())
}

pub(super) fn length(text: &str) -> Result<f32, String> {
    finite(text)?;
    text.parse().ok().filter(|v: &f32| *v >= 0.0).ok_or_else(|| "must be a number of metres, 0 or more".to_owned())
}

pub(super) fn above_zero<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    text.parse()
        .ok()
        .filter(|&v: &T| v.into() > 0.0 && v.into().is_finite())
        .ok_or_else(|| "must be a number above zero".to_owned())
}

/// Numbers separated by commas.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<const N: usize>(pub(crate) [f64; N]);

impl<const N: usize> FromStr for Numbers<N> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map(|part| part.trim().parse().map_err(|_| format!("{part:?} is not a number")))
            .collect::<Result<_, _>>()?;
        if let Some(bad) = numbers.iter().find(|v| !v.is_finite()) {
            return Err(format!("{bad} is not finite"));
        }
        numbers.try_into().map(Self).map_err(|_| format!("expected {N} numbers separated by commas"))
    }
}

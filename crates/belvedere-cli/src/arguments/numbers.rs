//! Parsers of numbers that are typed, with their limits.

use belvedere::crs::Crs;
use std::str::FromStr;

pub(crate) fn known_crs(text: &str) -> Result<String, String> {
    Crs::parse(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

pub(crate) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err("must be a whole number of at least 1".to_owned()),
        Ok(count) => Ok(count),
    }
}

/// A whole number from 1 to `MAX`.
pub(crate) fn at_most<const MAX: usize>(text: &str) -> Result<usize, String> {
    let count = at_least_one(text).ok().filter(|&count| count <= MAX);
    count.ok_or_else(|| format!("must be a whole number from 1 to {MAX}"))
}

/// Latitude and longitude in degrees.
pub(crate) fn location(text: &str) -> Result<Numbers<2>, String> {
    let place: Numbers<2> = text.parse()?;
    let [latitude, longitude] = place.0;
    let is_on_earth = latitude.abs() <= 90.0 && longitude.abs() <= 360.0;
    is_on_earth.then_some(place).ok_or_else(|| "must be a latitude (-90 to 90) and a longitude in degrees".to_owned())
}

pub(crate) fn finite<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    text.parse().ok().filter(|&v: &T| v.into().is_finite()).ok_or_else(|| "must be a finite number".to_owned())
}

pub(crate) fn length(text: &str) -> Result<f32, String> {
    finite::<f32>(text)?;
    text.parse().ok().filter(|v: &f32| *v >= 0.0).ok_or_else(|| "must be a number of metres, 0 or more".to_owned())
}

/// A height above the ground: below it nothing can be seen.
pub(crate) fn height<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    text.parse()
        .ok()
        .filter(|&v: &T| v.into() >= 0.0 && v.into().is_finite())
        .ok_or_else(|| "must be a height above the ground of 0 metres or more".to_owned())
}

pub(crate) fn above_zero<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    text.parse()
        .ok()
        .filter(|&v: &T| v.into() > 0.0 && v.into().is_finite())
        .ok_or_else(|| "must be a number above zero".to_owned())
}

/// A part of the map: its south-west and north-east corner.
#[derive(Clone, Copy)]
pub(crate) struct Rectangle(pub(crate) [[f64; 2]; 2]);

pub(crate) fn rectangle(text: &str) -> Result<Rectangle, String> {
    let Numbers([west, south, east, north]) = text.parse()?;
    match west < east && south < north {
        true => Ok(Rectangle([[west, south], [east, north]])),
        false => Err("must be the west, south, east and north side, in this order".to_owned()),
    }
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

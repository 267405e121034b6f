//! Poses of scans: a pose must be a rotation from scan to file coordinates.

/// Maximum deviation of lengths and products of the axes of a rotation from one and zero: some programs write four
/// digits.
const TOLERANCE: f64 = 2e-3;

/// Why the rows of `matrix` are not the axes of a rotation; `None` where they are. Points turned by anything else would
/// have wrong distances, or left and right exchanged.
pub(crate) fn fault_of_rotation(matrix: [[f64; 3]; 3]) -> Option<String> {
    let [a, b, c] = matrix;
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
    let determinant = dot(a, cross);
    let lengths = [a, b, c].map(|v| dot(v, v).sqrt());
    let is_near = |v: f64, expected: f64| (v - expected).abs() <= TOLERANCE;
    if !determinant.is_finite() {
        return Some("has numbers that are not finite".to_owned());
    }
    if lengths.iter().all(|v| *v == 0.0) {
        return Some("is zero".to_owned());
    }
    if determinant.abs() <= TOLERANCE * lengths.iter().product::<f64>() {
        return Some("is flat: it has no volume".to_owned());
    }
    if lengths.iter().any(|v| !is_near(*v, 1.0)) {
        return Some(format!("scales by {:.4}, {:.4} and {:.4}", lengths[0], lengths[1], lengths[2]));
    }
    if [dot(a, b), dot(b, c), dot(c, a)].into_iter().any(|v| !is_near(v, 0.0)) {
        return Some("shears: its axes are not at right angles".to_owned());
    }
    (determinant < 0.0).then(|| "mirrors: left and right are exchanged".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_have_no_fault_and_all_else_has_one() {
        let (s, c) = 0.4_f64.sin_cos();
        let turned = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(fault_of_rotation(turned), None);
        // four digits
        assert_eq!(fault_of_rotation(turned.map(|row| row.map(|v| (v * 1e4).round() / 1e4))), None);
        let changed = |change: &dyn Fn(&mut [[f64; 3]; 3])| {
            let mut matrix = turned;
            change(&mut matrix);
            fault_of_rotation(matrix).unwrap_or_default()
        };
        for (word, fault) in [
            ("not finite", changed(&|m| m[1][1] = f64::NAN)),
            ("zero", changed(&|m| *m = [[0.0; 3]; 3])),
            ("flat", changed(&|m| m[2] = m[1])),
            ("flat", changed(&|m| m[2] = [0.0; 3])),
            ("scales by 0.3048", changed(&|m| *m = m.map(|row| row.map(|v| 0.3048 * v)))),
            ("shears", changed(&|m| m[1] = [0.6, 0.8, 0.0])),
            ("mirrors", changed(&|m| m[0] = m[0].map(|v| -v))),
        ] {
            assert!(fault.contains(word), "{word}: {fault}");
        }
    }
}

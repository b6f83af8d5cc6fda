//! The steps of `to_world` as one affine map.

use glam::{DAffine3, DMat3, DVec3};

use super::tree::Node;
use super::trouble::{Outcome, Trouble};
use crate::description::{LookAt, Rotate, Step, Transform, Vector};

/// Composes the steps; the first listed acts first. `node` is the list.
pub(crate) fn to_affine(transform: &Transform, node: &Node) -> Outcome<DAffine3> {
    let mut total = DAffine3::IDENTITY;
    for (index, step) in transform.0.iter().enumerate() {
        let place = node.element_or_self(index);
        total = step_to_affine(step, place)? * total;
    }
    if !is_invertible(&total) {
        return Err(Trouble::new("the steps together are degenerate: their map is not invertible")
            .at(node)
            .hint("look for numbers that are very large or very small"));
    }
    Ok(total)
}

/// The same, for what can be turned and moved but not scaled.
pub(crate) fn to_rigid(transform: &Transform, node: &Node) -> Outcome<DAffine3> {
    let map = to_affine(transform, node)?;
    let metric = map.matrix3.transpose() * map.matrix3;
    if !metric.abs_diff_eq(DMat3::IDENTITY, 1e-4) {
        return Err(Trouble::new("this transform scales or shears, which is not allowed here")
            .at(node)
            .hint("use `translate`, `rotate` and `look_at` only"));
    }
    Ok(map)
}

/// The factor of a map that turns, moves and scales all axes alike; negative where it mirrors.
pub(crate) fn uniform_scale(map: &DAffine3, node: &Node) -> Outcome<f64> {
    let determinant = map.matrix3.determinant();
    let factor = determinant.cbrt();
    let metric = map.matrix3.transpose() * map.matrix3 * (factor * factor).recip();
    if !metric.abs_diff_eq(DMat3::IDENTITY, 1e-6) {
        return Err(Trouble::new("only a uniform scale is allowed here")
            .at(node)
            .hint("a mesh (`obj`, `ply`) can be stretched along one axis"));
    }
    Ok(factor)
}

fn step_to_affine(step: &Step, node: &Node) -> Outcome<DAffine3> {
    let mut maps = Vec::new();
    if let Some(offset) = step.translate {
        maps.push(DAffine3::from_translation(offset.into()));
    }
    if let Some(rotate) = &step.rotate {
        maps.push(rotation(rotate, node.get_or_self("rotate"))?);
    }
    if let Some(scale) = step.scale {
        maps.push(scaling(scale.0, node.get_or_self("scale"))?);
    }
    if let Some(look_at) = &step.look_at {
        maps.push(looking(look_at, node.get_or_self("look_at"))?);
    }
    if let Some(rows) = step.matrix {
        maps.push(matrix(rows, node.get_or_self("matrix"))?);
    }
    match maps.as_slice() {
        [map] => Ok(*map),
        found => Err(Trouble::new(format!(
            "expected one transform in this step, found {}",
            found.len()
        ))
        .at(node)
        .hint(
            "write each step as an object of its own: [{\"scale\": 2}, {\"translate\": [0, 1, 0]}]",
        )),
    }
}

fn rotation(rotate: &Rotate, node: &Node) -> Outcome<DAffine3> {
    let Some(axis) = DVec3::from(rotate.axis).try_normalize() else {
        return Err(Trouble::new("the axis of a rotation needs a length greater than 0")
            .at(node.get_or_self("axis")));
    };
    Ok(DAffine3::from_axis_angle(axis, rotate.angle.to_radians()))
}

fn scaling(factors: Vector, node: &Node) -> Outcome<DAffine3> {
    if factors.contains(&0.0) {
        return Err(Trouble::new("a scale of 0 is degenerate")
            .at(node)
            .hint("flat shapes (`rectangle`, `disk`) have no extent along z: use 1 there"));
    }
    Ok(DAffine3::from_scale(factors.into()))
}

fn looking(look_at: &LookAt, node: &Node) -> Outcome<DAffine3> {
    let [origin, target, up] = [look_at.origin, look_at.target, look_at.up].map(DVec3::from);
    let Some(forward) = (target - origin).try_normalize() else {
        return Err(
            Trouble::new("`origin` and `target` are the same point").at(node.get_or_self("target"))
        );
    };
    let left = up.try_normalize().map(|up| up.cross(forward));
    // Below this the direction of `left` is rounding noise.
    let Some(left) = left.filter(|l| l.length() > 1e-9).and_then(DVec3::try_normalize) else {
        return Err(Trouble::new("`up` is zero or parallel to the view")
            .at(node.get_or_self("up"))
            .hint("choose a direction that appears upwards, for example [0, 1, 0]"));
    };
    let axes = DMat3::from_cols(left, forward.cross(left), forward);
    Ok(DAffine3::from_mat3_translation(axes, origin))
}

fn matrix(rows: [[f64; 4]; 4], node: &Node) -> Outcome<DAffine3> {
    if rows[3] != [0.0, 0.0, 0.0, 1.0] {
        return Err(Trouble::new("the last row of a matrix must be 0, 0, 0, 1")
            .at(node.element_or_self(3))
            .hint("only affine maps are supported; the matrix is written row by row"));
    }
    let column = |j: usize| DVec3::new(rows[0][j], rows[1][j], rows[2][j]);
    let map = DAffine3::from_cols(column(0), column(1), column(2), column(3));
    if !is_invertible(&map) {
        return Err(Trouble::new("this matrix is degenerate: it is not invertible")
            .at(node)
            .hint("flat shapes (`rectangle`, `disk`) have no extent along z: keep that column"));
    }
    Ok(map)
}

/// Whether the map and its inverse are finite and not mere rounding.
fn is_invertible(map: &DAffine3) -> bool {
    let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
    let volume = x.length() * y.length() * z.length();
    let determinant = map.matrix3.determinant();
    map.is_finite()
        && volume.is_normal()
        && determinant.is_normal()
        && determinant.abs() > 1e-12 * volume
        && map.inverse().is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::de::read;
    use crate::load::scan::scan;
    use crate::load::source::Source;

    fn affine(text: &str) -> Result<DAffine3, String> {
        let root = scan(&Source::new("t", text.to_owned())).map_err(|t| t.message)?;
        let transform: Transform = read(&root).map_err(|t| t.message)?;
        to_affine(&transform, &root).map_err(|t| t.message)
    }

    #[test]
    fn the_first_step_acts_first() {
        let map = affine(r#"[{"scale": 2}, {"translate": [1, 0, 0]}]"#).expect("valid");
        assert_eq!(map.transform_point3(DVec3::X), DVec3::new(3.0, 0.0, 0.0));
    }

    #[test]
    fn rotations_are_counter_clockwise_and_matrices_row_by_row() {
        let map = affine(r#"[{"rotate": {"axis": [0, 0, 2], "angle": 90}}]"#).expect("valid");
        assert!((map.transform_point3(DVec3::X) - DVec3::Y).length() < 1e-15);
        let text = r#"[{"matrix": [[1, 0, 0, 5], [0, 0, 1, -1], [0, -1, 0, 0], [0, 0, 0, 1]]}]"#;
        let map = affine(text).expect("valid");
        assert_eq!(map.transform_point3(DVec3::Z), DVec3::new(5.0, 0.0, 0.0));
        assert_eq!(map.transform_vector3(DVec3::Z), DVec3::Y);
    }

    #[test]
    fn look_at_has_plus_x_on_the_left() {
        let text = r#"[{"look_at": {"origin": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0]}}]"#;
        let map = affine(text).expect("valid");
        assert_eq!(map.transform_point3(DVec3::ZERO), DVec3::new(0.0, 0.0, 4.0));
        assert_eq!(map.transform_vector3(DVec3::Z), -DVec3::Z);
        // Looking along -z with +y up, the left hand points along -x.
        assert_eq!(map.transform_vector3(DVec3::X), -DVec3::X);
        assert_eq!(map.transform_vector3(DVec3::Y), DVec3::Y);
    }

    #[test]
    fn degenerate_steps_are_refused() {
        for text in [
            r#"[{"scale": 0}]"#,
            r#"[{"scale": [1, 1, 0]}]"#,
            r#"[{"scale": 1e308}, {"scale": 1e308}]"#,
            r#"[{"scale": 1e-200}]"#,
            r#"[{"rotate": {"axis": [0, 0, 0], "angle": 90}}]"#,
            r#"[{"look_at": {"origin": [1, 1, 1], "target": [1, 1, 1], "up": [0, 1, 0]}}]"#,
            r#"[{"look_at": {"origin": [0, 0, 0], "target": [0, 2, 0], "up": [0, 1, 0]}}]"#,
            r#"[{"matrix": [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]"#,
            r#"[{"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]}]"#,
            r"[{}]",
            r#"[{"scale": 2, "translate": [1, 2, 3]}]"#,
            r#"[{"translate": [1, 2]}]"#,
            r#"[{"translate": [1, 2, 3, 4]}]"#,
        ] {
            assert!(affine(text).is_err(), "{text}");
        }
    }
}

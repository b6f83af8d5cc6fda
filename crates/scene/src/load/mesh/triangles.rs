//! From the polygons of a file to triangles in the world.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::{Corner, Polygons, Reading};
use crate::geometry::VertexData;

/// Meshes with more triangles are refused.
const MOST_TRIANGLES: usize = 50_000_000;

/// Normals nearer than this to that of their triangle are taken for it.
const FLAT: f64 = 1e-9;

/// A triangle in the world, its corners in the order of the right-hand rule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [DVec3; 3],
    pub(crate) vertices: VertexData,
}

impl Polygons {
    pub(super) fn triangles(&self, reading: &Reading) -> Result<Vec<Triangle>, String> {
        if self.faces.is_empty() {
            return Err("the mesh has no faces".to_owned());
        }
        let count = self.corners.len().saturating_sub(2 * self.faces.len());
        if count > MOST_TRIANGLES {
            return Err(format!("the mesh has more than {MOST_TRIANGLES} triangles"));
        }
        let placed = Placed::new(self, reading);
        // A mirrored mesh keeps its normals on the same side of its surface.
        let turn = reading.flip != (reading.to_world.matrix3.determinant() < 0.0);
        let mut triangles = Vec::with_capacity(count);
        let mut corners = self.corners.as_slice();
        for (index, &(length, line)) in self.faces.iter().enumerate() {
            let (face, rest) = corners.split_at(length.min(corners.len()));
            corners = rest;
            fan(face, &placed, turn, &mut triangles).map_err(|problem| match line {
                Some(line) => format!("face {} (line {line}): {problem}", index + 1),
                None => format!("face {}: {problem}", index + 1),
            })?;
        }
        let data = self.vertex_data(reading, &placed, &triangles)?;
        Ok(triangles
            .iter()
            .zip(data)
            .map(|(cut, vertices)| Triangle { corners: cut.places, vertices })
            .collect())
    }

    /// Normals and texture coordinates of the corners of each triangle.
    fn vertex_data(
        &self,
        reading: &Reading,
        placed: &Placed,
        triangles: &[Cut],
    ) -> Result<Vec<VertexData>, String> {
        let normals = if reading.face_normals {
            None
        } else if let Some(given) = of_all(triangles, "normal", |corner| corner.normal)? {
            Some(look_up(&given, &placed.normals, "normal")?)
        } else {
            Some(smooth_normals(self.vertices.len(), triangles))
        };
        if let Some(normals) = &normals {
            check_sides(triangles, normals)?;
        }
        let uvs = match of_all(triangles, "texture coordinate", |corner| corner.uv)? {
            Some(given) => Some(look_up(&given, &placed.uvs, "texture coordinate")?),
            None => None,
        };
        let of = |index: usize| VertexData {
            normals: normals
                .as_ref()
                .map(|all| all[index])
                .filter(|n| is_bent(&triangles[index], n)),
            uv: uvs.as_ref().map(|all| all[index]),
        };
        Ok((0..triangles.len()).map(of).collect())
    }
}

/// The lists of the file in the world.
struct Placed {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<DVec2>,
}

impl Placed {
    fn new(polygons: &Polygons, reading: &Reading) -> Self {
        let Reading { to_world, flip, flip_uv, .. } = *reading;
        let to_normals = normal_matrix(to_world) * if flip { -1.0 } else { 1.0 };
        let uv = |uv: &DVec2| if flip_uv { DVec2::new(uv.x, 1.0 - uv.y) } else { *uv };
        Self {
            vertices: polygons.vertices.iter().map(|&v| to_world.transform_point3(v)).collect(),
            normals: polygons
                .normals
                .iter()
                .map(|&n| (to_normals * n).normalize_or_zero())
                .collect(),
            uvs: polygons.uvs.iter().map(uv).collect(),
        }
    }
}

/// Normals go with the inverse transpose.
fn normal_matrix(to_world: &DAffine3) -> DMat3 {
    to_world.matrix3.inverse().transpose()
}

/// A triangle cut from a face.
struct Cut {
    places: [DVec3; 3],
    corners: [Corner; 3],
}

impl Cut {
    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.places;
        (b - a).cross(c - a).normalize()
    }
}

fn fan(face: &[Corner], placed: &Placed, turn: bool, cuts: &mut Vec<Cut>) -> Result<(), String> {
    if face.len() < 3 {
        return Err(format!("it has {} vertices, at least 3 are needed", face.len()));
    }
    let place = |corner: Corner| {
        let (index, count) = (corner.vertex, placed.vertices.len());
        let found = placed.vertices.get(index).copied();
        found.ok_or_else(|| format!("there is no vertex {index} (counted from 0) among {count}"))
    };
    for pair in face[1..].windows(2) {
        let corners = if turn { [face[0], pair[1], pair[0]] } else { [face[0], pair[0], pair[1]] };
        let places = [place(corners[0])?, place(corners[1])?, place(corners[2])?];
        if !places.iter().all(|place| place.is_finite()) {
            return Err("a vertex is not finite".to_owned());
        }
        if is_degenerate(&places) {
            return Err("it has a triangle without area".to_owned());
        }
        cuts.push(Cut { places, corners });
    }
    Ok(())
}

/// Whether the normal of a triangle is mere rounding.
fn is_degenerate([a, b, c]: &[DVec3; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    let scale = u.length().max(v.length());
    if !scale.is_normal() {
        return true;
    }
    let sine = (u / scale).cross(v / scale).length();
    sine.is_nan() || sine <= 1e-12
}

/// An index of every corner, or of none.
fn of_all(
    triangles: &[Cut],
    what: &str,
    index: impl Fn(&Corner) -> Option<usize>,
) -> Result<Option<Vec<[usize; 3]>>, String> {
    let all: Vec<[Option<usize>; 3]> =
        triangles.iter().map(|cut| cut.corners.map(|corner| index(&corner))).collect();
    if all.iter().flatten().all(Option::is_none) {
        return Ok(None);
    }
    let given = all.iter().map(|&[a, b, c]| Some([a?, b?, c?])).collect::<Option<Vec<_>>>();
    given.map(Some).ok_or_else(|| format!("some corners have a {what}, others have none"))
}

fn look_up<T: Copy>(
    indices: &[[usize; 3]],
    values: &[T],
    what: &str,
) -> Result<Vec<[T; 3]>, String> {
    let one = |index: usize| {
        let missing = || format!("there is no {what} {index} (counted from 0)");
        values.get(index).copied().ok_or_else(missing)
    };
    indices.iter().map(|&[a, b, c]| Ok([one(a)?, one(b)?, one(c)?])).collect()
}

/// Means of the faces' normals around each vertex, weighted by angles.
fn smooth_normals(vertices: usize, triangles: &[Cut]) -> Vec<[DVec3; 3]> {
    let mut sums = vec![DVec3::ZERO; vertices];
    for cut in triangles {
        let (Cut { places, corners }, normal) = (cut, cut.normal());
        for i in 0..3 {
            let (u, v) = (places[(i + 1) % 3] - places[i], places[(i + 2) % 3] - places[i]);
            sums[corners[i].vertex] += u.angle_between(v) * normal;
        }
    }
    let normals: Vec<_> = sums.into_iter().map(DVec3::normalize_or_zero).collect();
    triangles.iter().map(|cut| cut.corners.map(|corner| normals[corner.vertex])).collect()
}

/// Whether some normal of a triangle is not its own.
fn is_bent(cut: &Cut, normals: &[DVec3; 3]) -> bool {
    let face = cut.normal();
    normals.iter().any(|normal| (normal - face).length() > FLAT)
}

/// Refuses normals that are not finite, and meshes whose faces are oriented against their vertices'
/// normals: which side is which, nobody could say.
fn check_sides(triangles: &[Cut], normals: &[[DVec3; 3]]) -> Result<(), String> {
    let mut against = 0;
    for (cut, normals) in triangles.iter().zip(normals) {
        if !normals.iter().all(|normal| normal.is_finite()) {
            return Err("a normal is not finite".to_owned());
        }
        let sum: DVec3 = normals.iter().copied().sum();
        against += usize::from(sum.dot(cut.normal()) < 0.0);
    }
    if 2 * against > triangles.len() {
        return Err(format!(
            "the vertices' normals of {against} of {} triangles point to the back of their faces, \
             which are oriented by the right-hand rule: give `face_normals`, or mend the file",
            triangles.len()
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Reading =
        Reading { to_world: &DAffine3::IDENTITY, flip: false, face_normals: false, flip_uv: false };

    /// An octahedron: its computed normals point away from the middle, whatever is done to it.
    #[test]
    fn smooth_normals_of_a_round_mesh_point_outwards() {
        let mut mesh = Polygons::default();
        for axis in DVec3::AXES {
            mesh.vertices.extend([axis, -axis]);
        }
        for (x, y, z) in
            [0, 1].into_iter().flat_map(|x| [(x, 2, 4), (x, 2, 5), (x, 3, 4), (x, 3, 5)])
        {
            let odd = (x + y + z) % 2 == 1;
            let face = if odd { [x, z, y] } else { [x, y, z] };
            mesh.corners.extend(face.map(|vertex| Corner { vertex, ..Corner::default() }));
            mesh.faces.push((3, None));
        }
        for mirror in [1.0, -1.0] {
            let to_world = DAffine3::from_scale(DVec3::new(2.0 * mirror, 1.0, 1.0));
            for flip in [false, true] {
                let reading = Reading { to_world: &to_world, flip, ..PLAIN };
                for Triangle { corners, vertices } in mesh.triangles(&reading).unwrap() {
                    let sign = if flip { -1.0 } else { 1.0 };
                    let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                    assert!(sign * face.dot(corners[0]) > 0.0);
                    for (corner, normal) in corners.iter().zip(vertices.normals.unwrap()) {
                        assert!((sign * normal - corner.normalize()).length() < 1e-12);
                    }
                }
            }
        }
        let flat = Reading { face_normals: true, ..PLAIN };
        assert!(mesh.triangles(&flat).unwrap().iter().all(|t| t.vertices == VertexData::default()));
    }

    #[test]
    fn normals_against_the_faces_are_refused() {
        let corner = |vertex| Corner { vertex, normal: Some(0), uv: None };
        let mesh = |normal| Polygons {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            normals: vec![normal],
            faces: vec![(3, None)],
            corners: vec![corner(0), corner(1), corner(2)],
            ..Polygons::default()
        };
        assert!(mesh(DVec3::new(0.5, 0.0, 1.0)).triangles(&PLAIN).is_ok());
        let error = mesh(DVec3::NEG_Z).triangles(&PLAIN).unwrap_err();
        assert!(error.contains("right-hand rule"), "{error}");
        let mut part = mesh(DVec3::Z);
        part.corners[1].normal = None;
        assert!(part.triangles(&PLAIN).unwrap_err().contains("others have none"));
        part.corners[1].normal = Some(7);
        assert!(part.triangles(&PLAIN).unwrap_err().contains("no normal 7"));
    }
}

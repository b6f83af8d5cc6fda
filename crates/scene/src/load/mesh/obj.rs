//! Wavefront OBJ: vertices (`v`), normals (`vn`), texture coordinates (`vt`) and faces (`f`);
//! everything else is passed over.

use glam::{DVec2, DVec3};

use super::{Corner, Polygons};

pub(super) fn parse(bytes: &[u8]) -> Result<Polygons, String> {
    // Names in comments and materials may be in any encoding; numbers are ASCII.
    let text = String::from_utf8_lossy(bytes);
    let mut mesh = Polygons::default();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => mesh.vertices.push(three(words, number, "v")?),
            Some("vn") => mesh.normals.push(three(words, number, "vn")?),
            Some("vt") => {
                let [u, v] = numbers(words, number, "vt", "two")?;
                mesh.uvs.push(DVec2::new(u, v));
            }
            Some("f") => face(words, number, &mut mesh)?,
            _ => {}
        }
    }
    Ok(mesh)
}

fn three<'a>(
    words: impl Iterator<Item = &'a str>,
    line: usize,
    key: &str,
) -> Result<DVec3, String> {
    Ok(DVec3::from(numbers::<3>(words, line, key, "three")?))
}

/// The first numbers after a key; more are passed over.
fn numbers<'a, const N: usize>(
    words: impl Iterator<Item = &'a str>,
    line: usize,
    key: &str,
    many: &str,
) -> Result<[f64; N], String> {
    let numbers: Option<Vec<f64>> = words.take(N).map(|word| word.parse().ok()).collect();
    let found = numbers.and_then(|numbers| numbers.try_into().ok());
    found.ok_or_else(|| format!("line {line}: expected {many} numbers after `{key}`"))
}

fn face<'a>(
    words: impl Iterator<Item = &'a str>,
    line: usize,
    mesh: &mut Polygons,
) -> Result<(), String> {
    let first = mesh.corners.len();
    for word in words.take_while(|word| !word.starts_with('#')) {
        // `vertex/texture/normal`, of which only the first must be there.
        let mut parts = word.split('/');
        let vertex = parts.next().unwrap_or_default();
        let vertex = index(vertex, line, mesh.vertices.len(), "vertex")?;
        let mut further = |count: usize, what: &str| match parts.next() {
            None | Some("") => Ok(None),
            Some(word) => index(word, line, count, what).map(Some),
        };
        let uv = further(mesh.uvs.len(), "texture coordinate")?;
        let normal = further(mesh.normals.len(), "normal")?;
        mesh.corners.push(Corner { vertex, normal, uv });
    }
    mesh.faces.push((mesh.corners.len() - first, Some(line)));
    Ok(())
}

/// Indices count from 1, or backwards from the last of their list when negative.
fn index(word: &str, line: usize, count: usize, what: &str) -> Result<usize, String> {
    let index: i64 = word
        .parse()
        .map_err(|_| format!("line {line}: expected the number of a {what}, found `{word}`"))?;
    let from_zero = match index {
        1.. => usize::try_from(index - 1).ok(),
        0 => None,
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| count.checked_sub(back)),
    };
    from_zero.ok_or_else(|| format!("line {line}: there is no {what} {index}"))
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::load::mesh::{Reading, Triangle};

    fn read(text: &str) -> Result<Vec<Triangle>, String> {
        let to_world = &DAffine3::IDENTITY;
        let reading = Reading { to_world, flip: false, face_normals: false, flip_uv: true };
        parse(text.as_bytes())?.triangles(&reading)
    }

    fn triangles(text: &str) -> Result<usize, String> {
        read(text).map(|triangles| triangles.len())
    }

    #[test]
    fn normals_and_texture_coordinates_are_read() {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.25 0.75 0\nvn 0 0 2\nvn 0.6 0 0.8\n";
        let triangles = read(&format!("{corners}f 1/1/1 2/1/-1 3/1/1\n")).unwrap();
        let normals = triangles[0].vertices.normals.unwrap();
        assert_eq!(normals, [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::Z]);
        assert_eq!(triangles[0].vertices.uv.unwrap(), [DVec2::splat(0.25); 3]);
        for (face, part) in [
            ("f 1//1 2 3", "some corners have a normal"),
            ("f 1//3 2//1 3//1", "no normal 2"),
            ("f 1/x 2 3", "expected the number of a texture coordinate"),
            ("f 1//0 2 3", "there is no normal 0"),
        ] {
            let error = triangles_of(&format!("{corners}{face}\n"));
            assert!(error.contains(part), "{error}");
        }
    }

    fn triangles_of(text: &str) -> String {
        read(text).expect_err(text)
    }

    #[test]
    fn polygons_become_fans_and_indices_may_count_backwards() {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 # last\n";
        assert_eq!(triangles(&format!("{corners}f 1/ 2// 3 4\n")), Ok(2));
        assert_eq!(triangles(&format!("# a\n{corners}vn 0 0 1\nf -4 -3 -2\ns off\n")), Ok(1));
    }

    #[test]
    fn broken_meshes_name_the_line_and_the_face() {
        let corners = "v 0 0 0\nv 1 0 0\nv 2 0 0\n";
        for (text, part) in [
            ("", "no faces"),
            (corners, "no faces"),
            ("v 1 2\n", "line 1"),
            ("v 1 2 x\n", "line 1"),
            (&format!("{corners}f 1 2 4\n"), "face 1 (line 4): there is no vertex"),
            (&format!("{corners}f 0 1 2\n"), "line 4"),
            (&format!("{corners}f -9 1 2\n"), "line 4"),
            (&format!("{corners}f a b c\n"), "line 4"),
            (&format!("{corners}f 1 2\n"), "2 vertices"),
            (&format!("{corners}f 1 2 3\n"), "without area"),
            ("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n", "not finite"),
        ] {
            let error = triangles(text).expect_err(text);
            assert!(error.contains(part), "{error}");
        }
    }
}

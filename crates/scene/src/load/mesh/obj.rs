//! Wavefront OBJ: vertices (`v`) and faces (`f`); everything else is passed over.

use glam::DVec3;

use super::Polygons;

pub(super) fn parse(bytes: &[u8]) -> Result<Polygons, String> {
    // Names in comments and materials may be in any encoding; numbers are ASCII.
    let text = String::from_utf8_lossy(bytes);
    let mut mesh = Polygons::default();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => mesh.vertices.push(vertex(words, number)?),
            Some("f") => face(words, number, &mut mesh)?,
            _ => {}
        }
    }
    Ok(mesh)
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>, line: usize) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = words.take(3).map(|word| word.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err(format!("line {line}: expected three numbers after `v`")),
    }
}

fn face<'a>(
    words: impl Iterator<Item = &'a str>,
    line: usize,
    mesh: &mut Polygons,
) -> Result<(), String> {
    let first = mesh.corners.len();
    for word in words.take_while(|word| !word.starts_with('#')) {
        // `vertex/texture/normal`, of which only the first counts here.
        let vertex = word.split('/').next().unwrap_or_default();
        mesh.corners.push(corner(vertex, line, mesh.vertices.len())?);
    }
    mesh.faces.push((mesh.corners.len() - first, Some(line)));
    Ok(())
}

/// Indices count from 1, or backwards from the last vertex when negative.
fn corner(word: &str, line: usize, vertices: usize) -> Result<usize, String> {
    let index: i64 = word
        .parse()
        .map_err(|_| format!("line {line}: expected the number of a vertex, found `{word}`"))?;
    let from_zero = match index {
        1.. => usize::try_from(index - 1).ok(),
        0 => None,
        _ => usize::try_from(index.unsigned_abs()).ok().and_then(|back| vertices.checked_sub(back)),
    };
    from_zero.ok_or_else(|| format!("line {line}: there is no vertex {index}"))
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;

    fn triangles(text: &str) -> Result<usize, String> {
        parse(text.as_bytes())?.triangles(&DAffine3::IDENTITY).map(|triangles| triangles.len())
    }

    #[test]
    fn polygons_become_fans_and_indices_may_count_backwards() {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 # last\n";
        assert_eq!(triangles(&format!("{corners}f 1/1/1 2//2 3 4\n")), Ok(2));
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

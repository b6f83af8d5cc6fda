//! PLY, as text or binary: the elements `vertex` (x, y, z; normals nx, ny, nz; texture coordinates
//! u, v or s, t) and `face` (vertex_indices).

use glam::{DVec2, DVec3};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult, PropertyType};

use super::{Corner, Polygons};

/// One element of the file: whatever of a vertex or of a face it has.
#[derive(Debug)]
struct Element {
    position: DVec3,
    normal: DVec3,
    uv: DVec2,
    indices: Vec<i64>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { position: DVec3::NAN, normal: DVec3::NAN, uv: DVec2::NAN, indices: Vec::new() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        match name {
            "x" => self.position.x = number(&property),
            "y" => self.position.y = number(&property),
            "z" => self.position.z = number(&property),
            "nx" => self.normal.x = number(&property),
            "ny" => self.normal.y = number(&property),
            "nz" => self.normal.z = number(&property),
            "u" | "s" => self.uv.x = number(&property),
            "v" | "t" => self.uv.y = number(&property),
            "vertex_indices" | "vertex_index" => self.indices = whole_numbers(property),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn number(property: &Property) -> f64 {
    match *property {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => f64::NAN,
    }
}

fn whole_numbers(property: Property) -> Vec<i64> {
    fn all<T: Into<i64>>(values: Vec<T>) -> Vec<i64> {
        values.into_iter().map(Into::into).collect()
    }
    match property {
        Property::ListChar(v) => all(v),
        Property::ListUChar(v) => all(v),
        Property::ListShort(v) => all(v),
        Property::ListUShort(v) => all(v),
        Property::ListInt(v) => all(v),
        Property::ListUInt(v) => all(v),
        _ => Vec::new(),
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<Polygons, String> {
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(|error| brief(&error))?;
    let mut mesh = Polygons::default();
    for (name, element) in &header.elements {
        if element.count > bytes.len() {
            return Err(format!("the header announces {} of `{name}`", element.count));
        }
        require_properties(name, |property| {
            element.properties.get(property).map(|p| &p.data_type)
        })?;
        let elements = parser
            .read_payload_for_element(&mut reader, element, &header)
            .map_err(|error| brief(&error))?;
        let has = |names: &[&str]| names.iter().all(|name| element.properties.contains_key(*name));
        match name.as_str() {
            "vertex" => {
                mesh.vertices = elements.iter().map(|vertex| vertex.position).collect();
                if has(&["nx", "ny", "nz"]) {
                    mesh.normals = elements.iter().map(|vertex| vertex.normal).collect();
                }
                if has(&["u", "v"]) || has(&["s", "t"]) {
                    mesh.uvs = elements.iter().map(|vertex| vertex.uv).collect();
                }
            }
            "face" => elements.iter().for_each(|face| push(face, &mut mesh)),
            _ => {}
        }
    }
    Ok(mesh)
}

fn require_properties<'a>(
    element: &str,
    data_type: impl Fn(&str) -> Option<&'a PropertyType>,
) -> Result<(), String> {
    let is_list = |name| matches!(data_type(name), Some(PropertyType::List(..)));
    match element {
        "vertex" => {
            let missing = ["x", "y", "z"].into_iter().find(|name| data_type(name).is_none());
            missing.map_or(Ok(()), |name| Err(format!("its vertices have no `{name}`")))
        }
        "face" if !is_list("vertex_indices") && !is_list("vertex_index") => {
            Err("its faces have no list `vertex_indices`".to_owned())
        }
        _ => Ok(()),
    }
}

fn push(face: &Element, mesh: &mut Polygons) {
    // A negative index is as wrong as one that is too large, and is reported like it.
    let corner = |&index: &i64| {
        let vertex = usize::try_from(index).unwrap_or(usize::MAX);
        let of = |there: bool| there.then_some(vertex);
        let (normal, uv) = (of(!mesh.normals.is_empty()), of(!mesh.uvs.is_empty()));
        Corner { vertex, normal, uv }
    };
    let corners: Vec<_> = face.indices.iter().map(corner).collect();
    mesh.corners.extend(corners);
    mesh.faces.push((face.indices.len(), None));
}

/// The first line of a message of the parser, which goes on with its internals.
fn brief(error: &ply_rs_bw::parser::ParseError) -> String {
    let text = error.to_string();
    format!("not a valid PLY file: {}", text.lines().next().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::load::mesh::Reading;

    const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n\
        property float y\nproperty double z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n";

    fn triangles(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, String> {
        let to_world = &DAffine3::IDENTITY;
        let reading = Reading { to_world, flip: false, face_normals: false, flip_uv: false };
        let triangles = parse(bytes)?.triangles(&reading)?;
        Ok(triangles.iter().map(|triangle| triangle.corners).collect())
    }

    #[test]
    fn normals_and_texture_coordinates_are_read() {
        let more = "property float nx\nproperty float ny\nproperty float nz\nproperty float s\n\
            property float t\nelement face";
        let header = HEADER.replace("element face", more).replace("vertex 4", "vertex 3");
        let vertices = "0 0 0 0 0 1 0 0\n1 0 0 0.6 0 0.8 1 0\n1 1 0 0 0 1 1 0.5\n";
        let mesh = parse(format!("{header}{vertices}3 0 1 2\n").as_bytes()).expect("valid");
        assert!((mesh.normals[1] - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-7);
        assert_eq!(mesh.uvs[2], DVec2::new(1.0, 0.5));
        assert!(mesh.corners.iter().all(|c| c.normal == Some(c.vertex) && c.uv == c.normal));
    }

    #[test]
    fn text_and_binary_files_give_the_same_triangles() {
        let text = format!("{HEADER}0 0 0\n1 0 0\n1 1 0\n0 1 0.1\n4 0 1 2 3\n");
        let from_text = triangles(text.as_bytes()).expect("a valid file");
        assert_eq!(from_text.len(), 2);
        assert_eq!(from_text[1][2], DVec3::new(0.0, 1.0, 0.1));

        let mut binary = HEADER.replace("ascii", "binary_little_endian").into_bytes();
        for [x, y, z] in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.1]] {
            binary.extend((x as f32).to_le_bytes());
            binary.extend((y as f32).to_le_bytes());
            binary.extend(f64::to_le_bytes(z));
        }
        binary.push(4);
        (0..4).for_each(|index: i32| binary.extend(index.to_le_bytes()));
        assert_eq!(triangles(&binary).expect("a valid file"), from_text);
        binary.pop();
        assert!(triangles(&binary).is_err());
    }

    #[test]
    fn broken_files_are_errors() {
        let huge = HEADER.replace("vertex 4", "vertex 99999999999");
        for text in [
            "",
            "ply\n",
            "hello\n",
            HEADER,
            huge.as_str(),
            &format!("{HEADER}0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 4\n"),
            &format!("{HEADER}0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 -1\n"),
            &format!("{HEADER}0 0 0\n1 0 0\n2 0 0\n0 1 0\n3 0 1 2\n"),
            &format!("{HEADER}0 0 x\n"),
            &HEADER.replace("float x", "float u"),
            &HEADER.replace("list uchar int vertex_indices", "int vertex_indices"),
        ] {
            assert!(triangles(text.as_bytes()).is_err(), "{text}");
        }
    }
}

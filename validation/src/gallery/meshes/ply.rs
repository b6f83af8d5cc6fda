//! Binary PLY (little endian): float positions and normals, faces of 16-bit indices.

use std::fmt::Write as _;

use super::Mesh;

impl Mesh {
    /// The bytes of the file.
    pub fn to_ply(&self) -> Vec<u8> {
        let mut bytes = self.header().into_bytes();
        for vertex in &self.vertices {
            for value in vertex.position.to_array().into_iter().chain(vertex.normal.to_array()) {
                // + 0 turns −0, whose sign is an accident of rounding, into 0.
                bytes.extend((value as f32 + 0.0).to_le_bytes());
            }
        }
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        }
        bytes
    }

    fn header(&self) -> String {
        let mut text = String::from("ply\nformat binary_little_endian 1.0\n");
        // Writing to a text cannot fail.
        let _ = writeln!(text, "element vertex {}", self.vertices.len());
        for name in ["x", "y", "z", "nx", "ny", "nz"] {
            let _ = writeln!(text, "property float {name}");
        }
        let _ = writeln!(text, "element face {}", self.triangles.len());
        text.push_str("property list uchar ushort vertex_indices\nend_header\n");
        text
    }
}

//! Shapes: primitives in world coordinates, material, media and emission.

use glam::{DAffine3, DMat3, DVec3};
use tpb_optics::Frame;

use super::Builder;
use crate::description::{self as words, Attributes, ShapeEmitter};
use crate::geometry::{Cylinder, Outline, Planar, Sphere};
use crate::load::tree::{Member, Node};
use crate::load::trouble::{Outcome, Trouble};
use crate::load::{mesh, names, transform};
use crate::texture::Coordinates;
use crate::{Bsdf, MediumBoundary, MediumId, Primitive, Reflector, ShapePart};

/// Coordinates and radii must not exceed this \[m\], so that their fourth powers stay finite, also
/// with the largest powers and coefficients. (A light-year is 1e16 m.)
const LARGEST_LENGTH: f64 = 1e20;

/// Nor be below this \[m\].
const SMALLEST_LENGTH: f64 = 1e-20;

impl<'a> Builder<'a> {
    pub(super) fn shape(&mut self, shape: &words::Shape, member: &'a Member) -> Outcome<ShapePart> {
        let node = &member.value;
        let attributes = shape.attributes();
        let to_world = transform::to_affine(attributes.to_world, node.get_or_self("to_world"))?;
        let primitives = self.primitives(shape, &to_world, attributes.flip_normals, node)?;
        let coordinates = coordinates(shape, &to_world);
        let bsdf = self.shape_bsdf(&attributes, node, &coordinates)?;
        check_uv(&bsdf, &coordinates, &primitives, node)?;
        let radiance = attributes.emitter.map(|ShapeEmitter::Area(area)| area.radiance.rgb());
        if radiance.is_some() && bsdf == Bsdf::Null {
            return Err(Trouble::new("a `null` surface cannot shine")
                .at(node.get_or_self("emitter"))
                .hint("give the shape another BSDF: without `bsdf` an emitter is black"));
        }
        let boundary = self.boundary(&attributes, member)?;
        Ok(ShapePart { name: member.key.clone(), primitives, bsdf, boundary, radiance })
    }

    /// As in Mitsuba, a shape without a BSDF is diffuse, and black if it shines.
    fn shape_bsdf(
        &mut self,
        attributes: &Attributes,
        node: &Node,
        coordinates: &Coordinates,
    ) -> Outcome<Bsdf> {
        let front = match attributes.bsdf {
            Some(bsdf) => return self.bsdf(bsdf, node.get_or_self("bsdf"), Some(coordinates)),
            None if attributes.emitter.is_some() => Reflector::Black,
            None => self.diffuse(&words::Diffuse::default().reflectance, node, None)?,
        };
        Ok(Bsdf::Opaque { front, back: Reflector::Black })
    }

    fn boundary(
        &mut self,
        attributes: &Attributes,
        member: &'a Member,
    ) -> Outcome<Option<MediumBoundary>> {
        if attributes.interior.is_none() && attributes.exterior.is_none() {
            return Ok(None);
        }
        Ok(Some(MediumBoundary {
            interior: self.side_medium(attributes.interior, member, "interior")?,
            exterior: self.side_medium(attributes.exterior, member, "exterior")?,
        }))
    }

    fn side_medium(
        &mut self,
        medium: Option<&words::Medium>,
        member: &'a Member,
        key: &str,
    ) -> Outcome<Option<MediumId>> {
        match medium {
            None => Ok(self.background),
            Some(medium) => {
                let name = || format!("{}.{key}", member.key);
                self.medium(medium, member.value.get_or_self(key), name).map(Some)
            }
        }
    }

    fn primitives(
        &self,
        shape: &words::Shape,
        to_world: &DAffine3,
        flip: bool,
        node: &Node,
    ) -> Outcome<Vec<Primitive>> {
        match shape {
            words::Shape::Rectangle(_) => planar(to_world, Outline::Parallelogram, flip, node),
            words::Shape::Disk(_) => planar(to_world, Outline::Ellipse, flip, node),
            words::Shape::Cube(_) => cube(to_world, flip, node),
            words::Shape::Sphere(sphere) => {
                let scale = transform::uniform_scale(to_world, node.get_or_self("to_world"))?;
                let centre = to_world.transform_point3(sphere.center.into());
                let radius = sphere.radius.get() * scale.abs();
                within_limits(&[centre], &[radius], node)?;
                Ok(vec![Primitive::Sphere(Sphere { centre, radius, flipped: flip })])
            }
            words::Shape::Cylinder(c) => cylinder(c, to_world, flip, node),
            words::Shape::Obj(file) => self.mesh(file, mesh::Format::Obj, to_world, node),
            words::Shape::Ply(file) => self.mesh(file, mesh::Format::Ply, to_world, node),
        }
    }

    fn mesh(
        &self,
        file: &words::Mesh,
        format: mesh::Format,
        to_world: &DAffine3,
        node: &Node,
    ) -> Outcome<Vec<Primitive>> {
        let path = self.directory.join(&file.filename);
        let place = node.get_or_self("filename");
        let fail = |problem: String| {
            let name = names::shortened(&file.filename);
            Trouble::new(format!("cannot use the mesh file `{name}`: {problem}")).at(place)
        };
        let reading = mesh::Reading {
            to_world,
            flip: file.flip_normals,
            face_normals: file.face_normals,
            flip_uv: file.flip_tex_coords.unwrap_or(format == mesh::Format::Obj),
        };
        let triangles =
            mesh::load(&path, format, &reading).map_err(|problem| {
                fail(problem).maybe_hint((!path.exists()).then(|| {
                    format!("mesh files are looked for in `{}`", self.directory.display())
                }))
            })?;
        let primitive = |triangle: mesh::Triangle| {
            let [a, b, c] = triangle.corners;
            let (u, v) = (b - a, c - a);
            within_limits(&[a, b, c], &[u.length().max(v.length())], place)?;
            let plane = Planar::new(a, u, v, Outline::Triangle).with_vertices(triangle.vertices);
            Ok(Primitive::Planar(plane))
        };
        triangles.into_iter().map(primitive).collect()
    }
}

/// The unit square or disc in the plane of x and y, with normal +z.
fn planar(
    to_world: &DAffine3,
    outline: Outline,
    flip: bool,
    node: &Node,
) -> Outcome<Vec<Primitive>> {
    let face = face(to_world, [DVec3::ZERO, DVec3::X, DVec3::Y], outline, flip, node)?;
    Ok(vec![face])
}

fn cube(to_world: &DAffine3, flip: bool, node: &Node) -> Outcome<Vec<Primitive>> {
    let [x, y, z] = DVec3::AXES;
    // Each with u × v pointing outwards.
    let faces = [[x, y, z], [-x, z, y], [y, z, x], [-y, x, z], [z, x, y], [-z, y, x]];
    let faces = faces.map(|frame| face(to_world, frame, Outline::Parallelogram, flip, node));
    faces.into_iter().collect()
}

/// A face from its centre and two edges in local coordinates.
fn face(
    to_world: &DAffine3,
    [centre, u, v]: [DVec3; 3],
    outline: Outline,
    flip: bool,
    node: &Node,
) -> Outcome<Primitive> {
    let centre = to_world.transform_point3(centre);
    let (u, v) = (to_world.transform_vector3(u), to_world.transform_vector3(v));
    within_limits(&[centre], &[u.length(), v.length()], node)?;
    // Normals go with the inverse transpose, which a mirror turns against u × v.
    let (u, v) = if flip == is_mirrored(to_world) { (u, v) } else { (v, u) };
    Ok(Primitive::Planar(Planar::new(centre, u, v, outline)))
}

fn cylinder(
    cylinder: &words::Cylinder,
    to_world: &DAffine3,
    flip: bool,
    node: &Node,
) -> Outcome<Vec<Primitive>> {
    let scale = transform::uniform_scale(to_world, node.get_or_self("to_world"))?;
    let [p0, p1] = [cylinder.p0, cylinder.p1].map(|p| to_world.transform_point3(p.into()));
    if cylinder.p0 == cylinder.p1 {
        return Err(Trouble::new("`p0` and `p1` are the same point: the cylinder has no length")
            .at(node.get_or_self("p1")));
    }
    let radius = cylinder.radius.get() * scale.abs();
    within_limits(&[p0, p1], &[radius, (p1 - p0).length()], node)?;
    Ok(vec![Primitive::Cylinder(Cylinder::new(p0, p1, radius, flip))])
}

/// A textured mesh needs texture coordinates.
fn check_uv(
    bsdf: &Bsdf,
    coordinates: &Coordinates,
    primitives: &[Primitive],
    node: &Node,
) -> Outcome<()> {
    let textured = |r: &Reflector| matches!(r, Reflector::Textured(_));
    let Bsdf::Opaque { front, back } = bsdf else { return Ok(()) };
    let flat = |p: &Primitive| matches!(p, Primitive::Planar(t) if !t.has_vertex_uv());
    let wanted = (textured(front) || textured(back)) && *coordinates == Coordinates::Vertices;
    if wanted && primitives.iter().any(flat) {
        return Err(Trouble::new("the mesh file has no texture coordinates for its texture")
            .at(node.get_or_self("filename"))
            .hint("`vt` in OBJ files; `u` and `v`, or `s` and `t`, in PLY files"));
    }
    Ok(())
}

/// Mitsuba's texture coordinates of a shape.
fn coordinates(shape: &words::Shape, to_world: &DAffine3) -> Coordinates {
    let local = |from_local: DAffine3| (*to_world * from_local).inverse();
    match shape {
        words::Shape::Rectangle(_) => Coordinates::Rectangle(to_world.inverse()),
        words::Shape::Cube(_) => Coordinates::Cube(to_world.inverse()),
        words::Shape::Disk(_) => Coordinates::Disk(to_world.inverse()),
        words::Shape::Sphere(sphere) => Coordinates::Sphere(local(
            DAffine3::from_translation(sphere.center.into())
                * DAffine3::from_scale(DVec3::splat(sphere.radius.get())),
        )),
        words::Shape::Cylinder(c) => {
            let (p0, p1) = (DVec3::from(c.p0), DVec3::from(c.p1));
            let frame = Frame::from_z((p1 - p0).normalize());
            let (r, length) = (c.radius.get(), (p1 - p0).length());
            let matrix = DMat3::from_cols(r * frame.x, r * frame.y, length * frame.z);
            Coordinates::Cylinder(local(DAffine3::from_mat3_translation(matrix, p0)))
        }
        words::Shape::Obj(_) | words::Shape::Ply(_) => Coordinates::Vertices,
    }
}

fn is_mirrored(to_world: &DAffine3) -> bool {
    to_world.matrix3.determinant() < 0.0
}

/// Refuses coordinates and lengths with which the arithmetic of intersections would overflow.
pub(super) fn within_limits(points: &[DVec3], lengths: &[f64], node: &Node) -> Outcome<()> {
    let near = |point: &DVec3| point.abs().max_element() <= LARGEST_LENGTH;
    if !points.iter().all(|point| point.is_finite() && near(point)) {
        return Err(Trouble::new(format!("a coordinate exceeds {LARGEST_LENGTH:e} m")).at(node));
    }
    let sized = |length: &f64| (SMALLEST_LENGTH..=LARGEST_LENGTH).contains(length);
    if !lengths.iter().all(sized) {
        let message =
            format!("a length is not between {SMALLEST_LENGTH:e} and {LARGEST_LENGTH:e} m");
        return Err(Trouble::new(message).at(node));
    }
    Ok(())
}

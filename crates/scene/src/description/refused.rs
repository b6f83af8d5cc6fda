//! Plugins and parameters that Mitsuba (or mitransient) has and this version does not.
//!
//! They are listed only to refuse them by name: a scene that uses one would otherwise get an
//! error about a misspelt word.

/// A plugin that is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused {
    /// What kind of plugin it is, with its article.
    pub kind: &'static str,
    /// What could be used instead.
    pub instead: &'static str,
}

struct Group {
    kind: &'static str,
    instead: &'static str,
    names: &'static [&'static str],
}

const GROUPS: &[Group] = &[
    Group {
        kind: "a BSDF",
        instead: "`diffuse`, `conductor`, `dielectric`, `roughconductor`, `roughdielectric`, \
            `thindielectric`, `null` and `twosided` are supported",
        names: &[
            "blendbsdf",
            "bumpmap",
            "circular",
            "hair",
            "mask",
            "measured",
            "measured_polarized",
            "normalmap",
            "plastic",
            "polarizer",
            "pplastic",
            "principled",
            "principledthin",
            "retarder",
            "roughplastic",
        ],
    },
    Group {
        kind: "a shape",
        instead: "write the mesh as `ply` or `obj`",
        names: &["blender", "serialized"],
    },
    Group {
        kind: "a shape",
        instead: "`rectangle`, `cube`, `disk`, `sphere`, `cylinder`, `obj` and `ply` are supported",
        names: &[
            "bsplinecurve",
            "ellipsoids",
            "ellipsoidsmesh",
            "instance",
            "linearcurve",
            "merge",
            "sdfgrid",
            "shapegroup",
        ],
    },
    Group {
        kind: "an emitter",
        instead: "`laser` (extension) sends a collimated beam of finite radius",
        names: &["directionalarea"],
    },
    Group {
        kind: "an emitter",
        instead: "`area` on a shape, `point`, `spot`, `directional` and `laser` are supported",
        names: &[
            "constant",
            "envmap",
            "projector",
            "sky",
            "sun",
            "sunsky",
            "timedsunsky",
            "volumelight",
        ],
    },
    Group { kind: "a medium", instead: "`homogeneous` is supported", names: &["heterogeneous"] },
    Group {
        kind: "a phase function",
        instead: "`isotropic` and `hg` are supported",
        names: &["blendphase", "rayleigh", "sggx", "tabphase"],
    },
    Group {
        kind: "a sensor",
        instead: "`perspective` is supported",
        names: &[
            "batch",
            "distant",
            "fluencemeter",
            "irradiancemeter",
            "nlos_capture_meter",
            "orthographic",
            "radiancemeter",
            "thinlens",
        ],
    },
    Group {
        kind: "a film",
        instead: "`transient_hdr_film` and `hdrfilm` are supported",
        names: &["phasor_hdr_film", "specfilm"],
    },
    Group {
        kind: "a reconstruction filter",
        instead: "`box` is supported",
        names: &["catmullrom", "gaussian", "lanczos", "mitchell", "tent"],
    },
    Group {
        kind: "a sampler",
        instead: "leave it out: passes and seed are options of the command line",
        names: &["independent", "ldsampler", "multijitter", "orthogonal", "stratified"],
    },
    Group {
        kind: "a texture in this place",
        instead: "textures are for the `reflectance` of `diffuse`, and stand there in place; \
            elsewhere write a number, or linear RGB as a list of 3 numbers",
        names: &["bitmap", "checkerboard"],
    },
    Group {
        kind: "a texture",
        instead: "write a number, or linear RGB as a list of 3 numbers; `diffuse` takes \
            `checkerboard` and `bitmap` as `reflectance`",
        names: &[
            "blackbody",
            "d65",
            "discrete",
            "irregular",
            "mesh_attribute",
            "rawconstant",
            "regular",
            "srgb",
            "volume",
        ],
    },
    Group {
        kind: "a volume",
        instead: "write a number, or linear RGB as a list of 3 numbers",
        names: &["constvolume", "gridvolume"],
    },
    Group {
        kind: "an integrator",
        instead: "`path` (or `transient_path`), `photon_beams` and `ptracer` are supported",
        names: &[
            "aov",
            "depth",
            "direct",
            "direct_projective",
            "moment",
            "prb",
            "prb_basic",
            "prb_projective",
            "prbvolpath",
            "stokes",
            "transient_nlos_path",
            "volpathmis",
            "volprim_rf_basic",
        ],
    },
];

/// What is known of a Mitsuba plugin that is not supported.
pub fn refused_plugin(type_name: &str) -> Option<Refused> {
    let group = GROUPS.iter().find(|group| group.names.contains(&type_name))?;
    Some(Refused { kind: group.kind, instead: group.instead })
}

const PARAMETERS: &[(&str, &str)] = &[
    ("alpha", "`roughconductor` and `roughdielectric` have a roughness"),
    ("camera_unwarp", "unwarping is an option of the output"),
    ("component_format", "the output's formats are options of the command line"),
    ("crop_height", "change `height` and `fov`"),
    ("crop_offset_x", "change `width` and `fov`"),
    ("crop_offset_y", "change `height` and `fov`"),
    ("crop_width", "change `width` and `fov`"),
    ("eta", "glass has `int_ior` and `ext_ior`; `roughconductor` takes `eta` and `k`"),
    ("far_clip", "nothing is clipped: leave it out"),
    ("file_format", "the output's formats are options of the command line"),
    ("focal_length", "write the field of view as `fov`, in degrees"),
    ("hide_emitters", "leave it out; `min_depth` 2 leaves out all directly seen light"),
    ("id", "the key of an object in the scene is its id: leave it out"),
    ("k", "only `material` `none`, a perfect mirror; `roughconductor` takes `eta` and `k`"),
    ("near_clip", "nothing is clipped: leave it out"),
    ("principal_point_offset_x", "turn the camera instead"),
    ("principal_point_offset_y", "turn the camera instead"),
    ("sample_border", "leave it out"),
    ("sample_emitters", "leave it out: the method decides"),
    ("sample_visible", "leave it out: normals are always drawn as they are seen"),
    ("sampler", "leave it out: passes and seed are options of the command line"),
    ("shutter_close", "the scene stands still: leave it out"),
    ("shutter_open", "the scene stands still: leave it out"),
    ("silhouette_sampling_weight", "leave it out"),
    ("temporal_filter", "bins are integrated over their width: leave it out"),
    ("texture", "textures stand under the name of what they change: `reflectance`"),
];

/// What to do about a Mitsuba parameter that is not supported (where its plugin is).
pub fn refused_parameter(name: &str) -> Option<&'static str> {
    PARAMETERS.iter().find(|(parameter, _)| *parameter == name).map(|(_, instead)| *instead)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Kind;

    #[test]
    fn nothing_that_is_supported_is_refused() {
        let names = GROUPS.iter().flat_map(|group| group.names);
        for name in names {
            assert_eq!(Kind::of_type(name), None, "{name}");
        }
    }
}

//! The `.mtlx` file: the maps as a material of MaterialX 1.38, whose shader is Autodesk's standard surface.
//!
//! Source: "MaterialX Specification" 1.38, chapters on nodes and colour spaces; its standard node library.

use std::fmt::Write as _;

use crate::manifest::Described;
use crate::map::{ColorSpace, Map, NormalConvention};
use crate::set::file_name;

/// The document.
pub(crate) fn document(described: &Described) -> String {
    let mut graph = String::new();
    let mut inputs = String::new();
    let name = described.name();
    for &map in &described.bake.settings().maps {
        image(described, map, &mut graph);
        let input = |input: &str, kind: &str, output: &str| {
            format!("    <input name=\"{input}\" type=\"{kind}\" nodegraph=\"NG_{name}\" output=\"{output}\" />\n")
        };
        match map {
            Map::Color => inputs += &input("base_color", "color3", "color_out"),
            Map::Roughness => inputs += &input("specular_roughness", "float", "roughness_out"),
            Map::Normal => inputs += &input("normal", "vector3", "normal_out"),
            Map::Emission if described.bake.texture().finish().emission > 0.0 => {
                inputs += "    <input name=\"emission\" type=\"float\" value=\"1\" />\n";
                inputs += &input("emission_color", "color3", "emission_out");
            }
            // The shader has no place for occlusion, nor for emission where there is none; heights move the surface.
            Map::Emission | Map::Occlusion | Map::Height => {}
        }
    }
    let has_height = described.bake.settings().maps.contains(&Map::Height);
    let (mut displacement, mut displaces) = (String::new(), String::new());
    if has_height {
        let scale = described.height_scale();
        let _ = write!(
            displacement,
            "  <displacement name=\"D_{name}\" type=\"displacementshader\">\n    \
             <input name=\"displacement\" type=\"float\" nodegraph=\"NG_{name}\" output=\"height_out\" />\n    \
             <input name=\"scale\" type=\"float\" value=\"{scale}\" />\n  </displacement>\n"
        );
        let _ = writeln!(
            displaces,
            "    <input name=\"displacementshader\" type=\"displacementshader\" nodename=\"D_{name}\" />"
        );
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n  \
         <nodegraph name=\"NG_{name}\">\n{graph}  </nodegraph>\n  \
         <standard_surface name=\"SR_{name}\" type=\"surfaceshader\">\n{inputs}  </standard_surface>\n{displacement}  \
         <surfacematerial name=\"{name}\" type=\"material\">\n    \
         <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"SR_{name}\" />\n{displaces}  \
         </surfacematerial>\n</materialx>\n"
    )
}

/// The nodes that read a map, and the output by which the shader takes it.
fn image(described: &Described, map: Map, graph: &mut String) {
    let file = file_name(described.bake, described.options, map, 0);
    let declaration = map.declaration();
    let name = map.name();
    let kind = match (declaration.color_space, declaration.channels) {
        (ColorSpace::Srgb, _) => "color3",
        (ColorSpace::Data, 1) => "float",
        (ColorSpace::Data, _) => "vector3",
    };
    // Numbers have no colour space; floats of colours are linear, as the document is.
    let encoded = declaration.color_space == ColorSpace::Srgb && !described.options.format_of(map).is_linear();
    let color_space = if encoded { " colorspace=\"srgb_texture\"" } else { "" };
    let _ = write!(
        graph,
        "    <image name=\"{name}\" type=\"{kind}\">\n      \
         <input name=\"file\" type=\"filename\" value=\"{file}\"{color_space} />\n    </image>\n"
    );
    let mut last = name.to_owned();
    if map == Map::Normal {
        if described.bake.settings().normal == NormalConvention::DirectX {
            // MaterialX wants green up: 1 − green.
            graph.push_str(
                "    <multiply name=\"normal_flipped\" type=\"vector3\">\n      \
                 <input name=\"in1\" type=\"vector3\" nodename=\"normal\" />\n      \
                 <input name=\"in2\" type=\"vector3\" value=\"1, -1, 1\" />\n    </multiply>\n    \
                 <add name=\"normal_up\" type=\"vector3\">\n      \
                 <input name=\"in1\" type=\"vector3\" nodename=\"normal_flipped\" />\n      \
                 <input name=\"in2\" type=\"vector3\" value=\"0, 1, 0\" />\n    </add>\n",
            );
            last = "normal_up".to_owned();
        }
        let _ = write!(
            graph,
            "    <normalmap name=\"normal_world\" type=\"vector3\">\n      \
             <input name=\"in\" type=\"vector3\" nodename=\"{last}\" />\n    </normalmap>\n"
        );
        last = "normal_world".to_owned();
    }
    let _ = writeln!(graph, "    <output name=\"{name}_out\" type=\"{kind}\" nodename=\"{last}\" />");
}

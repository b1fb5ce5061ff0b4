//! The `.gltf` file and its `.bin`: the surface that was baked, wearing the maps.
//!
//! Source: "glTF 2.0 Specification", The Khronos Group, ISO/IEC 12113:2022.

use serde_json::{Value as Json, json};

use crate::bake::Bake;
use crate::encode::MapFormat;
use crate::map::{Map, NormalConvention};
use crate::model::Model;
use crate::set::{SetOptions, file_name};

/// The files and their bytes; none where the maps are in a format that glTF cannot name.
pub(crate) fn files(bake: &Bake, options: &SetOptions) -> Vec<(String, Vec<u8>)> {
    let nameable =
        |map: &Map| options.format_of(*map) != MapFormat::ExrHalf && options.format_of(*map) != MapFormat::ExrFloat;
    if !bake.settings().maps.iter().filter(|&&map| map != Map::Height).all(nameable) {
        return Vec::new();
    }
    let name = bake.texture().declaration().name;
    let model = bake.settings().surface.model(bake.tile());
    let (buffer, views, accessors) = buffer(&model, bake.settings().normal);
    let binary = format!("{name}.bin");
    let (material, textures) = material(bake);
    let mut json = json!({
        "asset": { "version": "2.0", "generator": concat!("jaspe ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": name, "mesh": 0 }],
        "meshes": [{
            "name": bake.settings().surface.name(),
            "primitives": [{
                "attributes": { "POSITION": 1, "NORMAL": 2, "TANGENT": 3, "TEXCOORD_0": 4 },
                "indices": 0,
                "material": 0,
            }],
        }],
        "buffers": [{ "uri": binary, "byteLength": buffer.len() }],
        "bufferViews": views,
        "accessors": accessors,
        "materials": [material],
    });
    if !textures.is_empty() {
        let images: Vec<Json> = textures
            .iter()
            .map(|map| json!({ "name": map.name(), "uri": file_name(bake, options, *map, 0), "mimeType": options.format_of(*map).mime_type() }))
            .collect();
        let webp = options.format == MapFormat::WebP;
        let texture = |image: usize| match webp {
            true => json!({ "sampler": 0, "extensions": { "EXT_texture_webp": { "source": image } } }),
            false => json!({ "sampler": 0, "source": image }),
        };
        json["textures"] = (0..images.len()).map(texture).collect();
        json["images"] = json!(images);
        // Linear filters, and mipmaps; repeated (10497) or clamped (33071).
        let wrap = if bake.settings().surface.tiles() { 10497 } else { 33071 };
        json["samplers"] = json!([{ "magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap }]);
        if webp {
            json["extensionsUsed"] = json!(["EXT_texture_webp"]);
            json["extensionsRequired"] = json!(["EXT_texture_webp"]);
        }
    }
    vec![(format!("{name}.gltf"), format!("{json:#}\n").into_bytes()), (binary, buffer)]
}

/// The material, and the maps that its textures show, in their order.
fn material(bake: &Bake) -> (Json, Vec<Map>) {
    let mut textures = Vec::new();
    let mut material = json!({
        "name": bake.texture().declaration().name,
        "pbrMetallicRoughness": { "metallicFactor": 0.0 },
    });
    for &map in &bake.settings().maps {
        let index = textures.len();
        let texture = json!({ "index": index });
        match map {
            Map::Color => material["pbrMetallicRoughness"]["baseColorTexture"] = texture,
            // Green is the roughness, and blue the metalness, which the factor makes zero: a grey picture will do.
            Map::Roughness => material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture,
            Map::Normal => material["normalTexture"] = texture,
            Map::Occlusion => material["occlusionTexture"] = texture,
            Map::Emission if bake.texture().finish().emission > 0.0 => {
                material["emissiveTexture"] = texture;
                material["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
            }
            Map::Emission | Map::Height => continue,
        }
        textures.push(map);
    }
    (material, textures)
}

/// The bytes of a model, and what describes them: indices, points, normals, tangents, texture coordinates.
fn buffer(model: &Model, convention: NormalConvention) -> (Vec<u8>, Vec<Json>, Vec<Json>) {
    let (mut bytes, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
    let mut view = |bytes: &mut Vec<u8>, data: Vec<u8>, target: u32| {
        views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": data.len(), "target": target }));
        bytes.extend(data);
        views.len() - 1
    };
    let indices: Vec<u8> = model.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()).collect();
    let index_view = view(&mut bytes, indices, 34963);
    accessors.push(json!({
        "bufferView": index_view, "componentType": 5125, "count": 3 * model.triangles.len(), "type": "SCALAR",
    }));
    let points: Vec<[f32; 3]> = model.vertices.iter().map(|vertex| vertex.point.map(|part| part as f32)).collect();
    let end = |fold: fn(f32, f32) -> f32, start: f32| -> [f32; 3] {
        std::array::from_fn(|axis| points.iter().map(|point| point[axis]).fold(start, fold))
    };
    let (least, most) = (end(f32::min, f32::INFINITY), end(f32::max, f32::NEG_INFINITY));
    let flat = |rows: &mut dyn Iterator<Item = Vec<f32>>| -> Vec<u8> {
        rows.flatten().flat_map(|number| number.to_le_bytes()).collect()
    };
    // Green down is green up seen with the other hand.
    let hand = if convention == NormalConvention::OpenGl { 1.0 } else { -1.0 };
    let single = |v: [f64; 3]| v.map(|part| part as f32).to_vec();
    let rows: [(Vec<u8>, &str); 4] = [
        (flat(&mut points.iter().map(|point| point.to_vec())), "VEC3"),
        (flat(&mut model.vertices.iter().map(|vertex| single(vertex.normal))), "VEC3"),
        (
            flat(
                &mut model
                    .vertices
                    .iter()
                    .map(|vertex| [single(vertex.tangent), vec![hand * vertex.hand as f32]].concat()),
            ),
            "VEC4",
        ),
        // The picture's first row is at the top, where v is 1.
        (flat(&mut model.vertices.iter().map(|v| vec![v.uv[0] as f32, (1.0 - v.uv[1]) as f32])), "VEC2"),
    ];
    for (k, (data, kind)) in rows.into_iter().enumerate() {
        let at = view(&mut bytes, data, 34962);
        let mut accessor = json!({
            "bufferView": at, "componentType": 5126, "count": model.vertices.len(), "type": kind,
        });
        if k == 0 {
            accessor["min"] = json!(least);
            accessor["max"] = json!(most);
        }
        accessors.push(accessor);
    }
    (bytes, views, accessors)
}

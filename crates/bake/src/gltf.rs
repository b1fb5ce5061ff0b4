//! The `.gltf` file and its `.bin`: the surface that was baked, wearing the maps.
//!
//! Source: "glTF 2.0 Specification", The Khronos Group, ISO/IEC 12113:2022.

use serde_json::{Value as Json, json};

use crate::bake::Bake;
use crate::encode::MapFormat;
use crate::map::{Map, NormalConvention};
use crate::model::Model;
use crate::set::{SetOptions, file_name, numbered};

/// Whether there are such files: not where the maps are in a format that glTF cannot name.
pub(crate) fn can_name(bake: &Bake, options: &SetOptions) -> bool {
    let nameable =
        |map: &Map| options.format_of(*map) != MapFormat::ExrHalf && options.format_of(*map) != MapFormat::ExrFloat;
    bake.settings().maps.iter().filter(|&&map| map != Map::Height).all(nameable)
}

/// The files and their bytes. Each frame of a sequence is a material; the surface wears the first, and offers the others as
/// variants (extension KHR_materials_variants).
pub(crate) fn files(bake: &Bake, options: &SetOptions) -> Vec<(String, Vec<u8>)> {
    if !can_name(bake, options) {
        return Vec::new();
    }
    let name = bake.texture().declaration().name;
    let model = bake.settings().surface.model(bake.tile());
    let (buffer, views, accessors) = buffer(&model);
    let binary = format!("{name}.bin");
    let (mut materials, mut images) = (Vec::new(), Vec::new());
    for frame in 0..bake.frames() {
        let (mut material, maps) = material(bake, images.len());
        material["name"] = json!(numbered(bake, name, frame));
        materials.push(material);
        images.extend(maps.into_iter().map(|map| {
            let uri = if map == Map::Normal {
                green_up_file(bake, options, frame).unwrap_or_else(|| file_name(bake, options, map, frame))
            } else {
                file_name(bake, options, map, frame)
            };
            json!({ "name": numbered(bake, map.name(), frame), "uri": uri, "mimeType": options.format_of(map).mime_type() })
        }));
    }
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
        "materials": materials,
    });
    let mut extensions = Vec::new();
    if bake.settings().animation.is_some() {
        let variants = materials.iter().map(|material| json!({ "name": material["name"] }));
        json["extensions"] = json!({ "KHR_materials_variants": { "variants": variants.collect::<Vec<_>>() } });
        let mappings = (0..materials.len()).map(|frame| json!({ "material": frame, "variants": [frame] }));
        json["meshes"][0]["primitives"][0]["extensions"] =
            json!({ "KHR_materials_variants": { "mappings": mappings.collect::<Vec<_>>() } });
        extensions.push("KHR_materials_variants");
    }
    if !images.is_empty() {
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
            extensions.push("EXT_texture_webp");
            json["extensionsRequired"] = json!(["EXT_texture_webp"]);
        }
    }
    if !extensions.is_empty() {
        json["extensionsUsed"] = json!(extensions);
    }
    vec![(format!("{name}.gltf"), format!("{json:#}\n").into_bytes()), (binary, buffer)]
}

/// The normal map that glTF names where the set's own has green pointing down: in glTF it points up, and programs that make
/// tangents of their own, as Blender does, cannot be told otherwise.
pub(crate) fn green_up_file(bake: &Bake, options: &SetOptions, frame: u32) -> Option<String> {
    let is_down = bake.settings().normal == NormalConvention::DirectX;
    let wanted = is_down && bake.settings().maps.contains(&Map::Normal) && can_name(bake, options);
    wanted.then(|| format!("{}.{}", numbered(bake, "normal.gl", frame), options.format_of(Map::Normal).extension()))
}

/// The material of a frame whose textures begin at this index, and the maps that they show, in their order.
fn material(bake: &Bake, first: usize) -> (Json, Vec<Map>) {
    let mut maps = Vec::new();
    let mut material = json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0 } });
    for &map in &bake.settings().maps {
        let texture = json!({ "index": first + maps.len() });
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
        maps.push(map);
    }
    (material, maps)
}

/// The bytes of a model, and what describes them: indices, points, normals, tangents, texture coordinates.
fn buffer(model: &Model) -> (Vec<u8>, Vec<Json>, Vec<Json>) {
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
    let single = |v: [f64; 3]| v.map(|part| part as f32).to_vec();
    let rows: [(Vec<u8>, &str); 4] = [
        (flat(&mut points.iter().map(|point| point.to_vec())), "VEC3"),
        (flat(&mut model.vertices.iter().map(|vertex| single(vertex.normal))), "VEC3"),
        (
            flat(&mut model.vertices.iter().map(|vertex| [single(vertex.tangent), vec![vertex.hand as f32]].concat())),
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

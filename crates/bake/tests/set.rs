//! Sets in their folders: what the files hold, and that they are there whole or not at all.

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use jaspe_bake::{
    Bake, ColorSpace, Loop, Map, MapFormat, NormalConvention, SetError, SetFolder, SetOptions, Settings, Surface,
    Written, write_gallery, write_set,
};
use jaspe_render::{Observer, srgb_decode};
use jaspe_texture::Texture;
use serde_json::Value as Json;

const SIZE: u32 = 72;

fn bake_with(name: &str, settings: Settings) -> Bake {
    Bake::new(Texture::build(name, &[]).unwrap(), settings).unwrap()
}

fn settings() -> Settings {
    Settings { size: SIZE, maps: Map::ALL.to_vec(), ..Settings::default() }
}

fn write(bake: &Bake, format: MapFormat, path: &Path) -> Result<Written, SetError> {
    write_set(bake, &SetOptions::new(format), SetFolder::new(path)?, &())
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn json(path: &Path) -> Json {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Samples of a picture from 0 to 1, channels interleaved, and how many bits they had.
fn decoded(path: &Path) -> (Vec<f32>, u32) {
    let image = image::load_from_memory(&fs::read(path).unwrap()).unwrap();
    assert_eq!((image.width(), image.height()), (SIZE, SIZE));
    use image::DynamicImage::{ImageLuma8, ImageLuma16, ImageRgb8, ImageRgb16};
    let eight = |samples: &[u8]| samples.iter().map(|&sample| f32::from(sample) / 255.0).collect();
    let sixteen = |samples: &[u16]| samples.iter().map(|&sample| f32::from(sample) / 65535.0).collect();
    match &image {
        ImageLuma8(image) => (eight(image.as_raw()), 8),
        ImageRgb8(image) => (eight(image.as_raw()), 8),
        ImageLuma16(image) => (sixteen(image.as_raw()), 16),
        ImageRgb16(image) => (sixteen(image.as_raw()), 16),
        other => panic!("{:?}", other.color()),
    }
}

/// Samples of an OpenEXR file, channels interleaved as red, green, blue.
fn decoded_exr(path: &Path, channels: usize) -> Vec<f32> {
    use exr::prelude::*;
    let image = read_first_flat_layer_from_file(path).unwrap();
    let layer = image.layer_data;
    assert_eq!(layer.size, Vec2(SIZE as usize, SIZE as usize));
    let names: &[&str] = if channels == 1 { &["Y"] } else { &["R", "G", "B"] };
    let mut values = vec![0.0; layer.size.area() * channels];
    for (which, name) in names.iter().enumerate() {
        let channel = layer.channel_data.list.iter().find(|channel| channel.name == **name).unwrap();
        for (pixel, sample) in channel.sample_data.values_as_f32().enumerate() {
            values[pixel * channels + which] = sample;
        }
    }
    values
}

#[test]
fn every_format_holds_the_maps() {
    let bake = bake_with("fire", settings());
    let arrays = bake.arrays(0, &()).unwrap();
    let here = tempfile::tempdir().unwrap();
    for &format in MapFormat::ALL {
        let folder = here.path().join(format!("{format:?}"));
        let written = write(&bake, format, &folder).unwrap();
        let options = SetOptions::new(format);
        for array in &arrays.maps {
            let format = options.format_of(array.map);
            let path = folder.join(format!("{}.{}", array.map.name(), format.extension()));
            let channels = array.map.declaration().channels;
            if format.extension() == "exr" {
                let half = format.bits() == 16;
                for (found, &value) in decoded_exr(&path, channels).iter().zip(&array.values) {
                    let srgb = array.map.declaration().color_space == ColorSpace::Srgb;
                    let expected = if srgb { srgb_decode(f64::from(value)) as f32 } else { value };
                    assert!((found - expected).abs() <= if half { 6e-4 } else { 0.0 }, "{path:?}: {found} {expected}");
                }
                continue;
            }
            let (mut samples, bits) = decoded(&path);
            if format == MapFormat::WebP && channels == 1 {
                // WebP has no grey pictures.
                samples = samples.into_iter().step_by(3).collect();
            }
            assert_eq!((samples.len(), bits), (array.values.len(), format.bits()), "{path:?}");
            let step = if bits == 8 { 1.0 / 255.0 } else { 1.0 / 65535.0 };
            let (mut total, mut most) = (0.0, 0.0f32);
            for (found, value) in samples.iter().zip(&array.values) {
                most = most.max((found - value).abs());
                total += f64::from((found - value).abs());
            }
            let mean = total / samples.len() as f64;
            match format {
                MapFormat::Jpeg => assert!(mean < 0.02, "{path:?}: {mean}"),
                _ => assert!(most <= 0.502 * step, "{path:?}: {most}"),
            }
        }
        let sizes: u64 = written.files.iter().map(|(_, size)| size).sum();
        assert!(sizes > 1000 && written.files.len() == names(&folder).len());
    }
}

#[test]
fn heights_use_all_of_sixteen_bits_and_say_their_scale() {
    let here = tempfile::tempdir().unwrap();
    for format in [MapFormat::Png8, MapFormat::Jpeg, MapFormat::WebP, MapFormat::Png16] {
        let bake = bake_with("stone", Settings { maps: vec![Map::Height], ..settings() });
        let folder = here.path().join(format!("{format:?}"));
        write(&bake, format, &folder).unwrap();
        let image = image::open(folder.join("height.png")).unwrap().into_luma16();
        let samples = image.as_raw();
        assert_eq!((samples.iter().min(), samples.iter().max()), (Some(&0), Some(&65535)));
        let height = &json(&folder.join("material.json"))["height"];
        let [lowest, highest] = bake.height_range(&()).unwrap();
        for (member, expected) in [("lowest", lowest), ("highest", highest), ("scale", highest - lowest)] {
            assert!((height[member].as_f64().unwrap() - expected).abs() < 1e-15, "{member}");
        }
    }
}

#[test]
fn material_json_says_what_was_baked() {
    let here = tempfile::tempdir().unwrap();
    let folder = here.path().join("water");
    let animation = Some(Loop { frames: 3, first: 7, cells: 1 });
    let bake = bake_with("water", Settings { maps: vec![Map::Color, Map::Normal], animation, ..settings() });
    write(&bake, MapFormat::Png8, &folder).unwrap();
    let json = json(&folder.join("material.json"));
    assert_eq!((&json["material"], &json["surface"]["kind"]), (&"water".into(), &"plane".into()));
    assert_eq!(json["surface"]["repeats"], true);
    for parameter in bake.texture().declaration().parameters {
        let value = &json["parameters"][parameter.name];
        assert!(parameter.name == "space" || !value.is_null(), "{}", parameter.name);
    }
    let files: Vec<&str> =
        json["maps"]["color"]["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    assert_eq!(files, ["color.0007.png", "color.0008.png", "color.0009.png"]);
    assert_eq!(
        (&json["maps"]["color"]["color_space"], &json["maps"]["normal"]["color_space"]),
        (&"srgb".into(), &"data".into())
    );
    assert_eq!((&json["animation"]["frames"], &json["animation"]["first"]), (&3.into(), &7.into()));
    let listed: Vec<&str> = json["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    assert_eq!(listed, names(&folder));
}

#[test]
fn other_programs_find_the_maps() {
    let here = tempfile::tempdir().unwrap();
    for (k, surface) in [Surface::Plane, Surface::Sphere, Surface::Cube, Surface::Cylinder].into_iter().enumerate() {
        for normal in [NormalConvention::OpenGl, NormalConvention::DirectX] {
            let folder = here.path().join(format!("{k}-{}", normal.name()));
            let bake = bake_with("fire", Settings { surface: surface.clone(), normal, ..settings() });
            write(&bake, MapFormat::Png8, &folder).unwrap();
            check_gltf(&folder.join("fire.gltf"), normal, surface.tiles());
            check_materialx(&folder.join("fire.mtlx"), normal);
        }
    }
    // What glTF cannot name, it does not name.
    let folder = here.path().join("exr");
    write(&bake_with("fire", settings()), MapFormat::ExrHalf, &folder).unwrap();
    assert!(!folder.join("fire.gltf").exists() && !folder.join("fire.bin").exists());
    let text = fs::read_to_string(folder.join("fire.mtlx")).unwrap();
    assert!(text.contains("color.exr") && !text.contains("srgb_texture"));
}

/// The crate validates by the rules of the specification: indices, ranges, required members.
fn check_gltf(path: &Path, normal: NormalConvention, repeats: bool) {
    let gltf = gltf::Gltf::from_slice(&fs::read(path).unwrap()).unwrap();
    assert_eq!(gltf.materials().len(), 1);
    let buffer = fs::read(path.with_extension("bin")).unwrap();
    assert_eq!(gltf.buffers().next().unwrap().length(), buffer.len());
    let material = gltf.materials().next().unwrap();
    let pbr = material.pbr_metallic_roughness();
    let file = |texture: gltf::Texture| match texture.source().source() {
        gltf::image::Source::Uri { uri, mime_type } => {
            assert_eq!(mime_type, Some("image/png"));
            assert!(path.with_file_name(uri).exists(), "{uri}");
            let wrap = texture.sampler().wrap_s();
            assert_eq!(wrap == gltf::texture::WrappingMode::Repeat, repeats);
            uri.to_owned()
        }
        _ => panic!("the pictures lie beside"),
    };
    assert_eq!(file(pbr.base_color_texture().unwrap().texture()), "color.png");
    assert_eq!(file(pbr.metallic_roughness_texture().unwrap().texture()), "roughness.png");
    // Green points up in glTF, whatever the set's own map has.
    let names = if normal == NormalConvention::OpenGl { "normal.png" } else { "normal.gl.png" };
    assert_eq!(file(material.normal_texture().unwrap().texture()), names);
    if normal == NormalConvention::DirectX {
        let (down, up) = (decoded_any(&path.with_file_name("normal.png")), decoded_any(&path.with_file_name(names)));
        for (down, up) in down.pixels().zip(up.pixels()) {
            assert!((down[0], down[2]) == (up[0], up[2]) && down[1].abs_diff(255 - up[1]) <= 1);
        }
    }
    assert_eq!(file(material.occlusion_texture().unwrap().texture()), "ao.png");
    assert_eq!(file(material.emissive_texture().unwrap().texture()), "emission.png");
    assert_eq!((pbr.metallic_factor(), material.emissive_factor()), (0.0, [1.0; 3]));

    let primitive = gltf.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&buffer));
    let points: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert!(!indices.is_empty() && indices.iter().all(|&index| (index as usize) < points.len()));
    let normals: Vec<[f32; 3]> = reader.read_normals().unwrap().collect();
    let tangents: Vec<[f32; 4]> = reader.read_tangents().unwrap().collect();
    let uvs: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
    assert_eq!([normals.len(), tangents.len(), uvs.len()], [points.len(); 3]);
    let minus = |a: [f32; 3], b: [f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross =
        |a: [f32; 3], b: [f32; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    for corners in indices.chunks_exact(3) {
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(|index| index as usize);
        let face = cross(minus(points[b], points[a]), minus(points[c], points[a]));
        for i in [a, b, c] {
            let tangent = [tangents[i][0], tangents[i][1], tangents[i][2]];
            assert!((dot(tangent, tangent) - 1.0).abs() < 1e-5 && dot(tangent, normals[i]).abs() < 1e-5);
            assert_eq!(tangents[i][3], 1.0);
            // Triangles are seen from outside, where their normals point.
            assert!(dot(face, normals[i]) >= -1e-6);
        }
        // The tangent is the way in which u grows.
        let grows = |from: usize, to: usize| {
            let tangent = [tangents[from][0], tangents[from][1], tangents[from][2]];
            (uvs[to][0] - uvs[from][0]) * dot(minus(points[to], points[from]), tangent) >= -1e-6
        };
        assert!(grows(a, b) && grows(b, c));
    }
}

fn decoded_any(path: &Path) -> image::RgbImage {
    image::open(path).unwrap().into_rgb8()
}

#[test]
fn frames_are_variants_of_the_material() {
    let here = tempfile::tempdir().unwrap();
    for (normal, normals) in [(NormalConvention::OpenGl, "normal"), (NormalConvention::DirectX, "normal.gl")] {
        let folder = here.path().join(normals);
        let animation = Some(Loop { frames: 3, first: 7, cells: 1 });
        write(&bake_with("fire", Settings { animation, normal, ..settings() }), MapFormat::Png8, &folder).unwrap();
        let path = folder.join("fire.gltf");
        let gltf = gltf::Gltf::from_slice(&fs::read(&path).unwrap()).unwrap();
        let frames = ["0007", "0008", "0009"];
        let names: Vec<String> = gltf.materials().map(|material| material.name().unwrap().to_owned()).collect();
        assert_eq!(names, frames.map(|frame| format!("fire.{frame}")));
        for (material, frame) in gltf.materials().zip(frames) {
            let pbr = material.pbr_metallic_roughness();
            let textures = [
                (pbr.base_color_texture().unwrap().texture(), "color"),
                (pbr.metallic_roughness_texture().unwrap().texture(), "roughness"),
                (material.normal_texture().unwrap().texture(), normals),
                (material.occlusion_texture().unwrap().texture(), "ao"),
                (material.emissive_texture().unwrap().texture(), "emission"),
            ];
            for (texture, map) in textures {
                let gltf::image::Source::Uri { uri, .. } = texture.source().source() else { panic!("beside it") };
                assert_eq!(uri, format!("{map}.{frame}.png"));
                assert!(folder.join(uri).exists(), "{uri}");
            }
        }
        let json = json(&path);
        assert_eq!(json["extensionsUsed"], serde_json::json!(["KHR_materials_variants"]));
        let variants = &json["extensions"]["KHR_materials_variants"]["variants"];
        assert_eq!(
            *variants,
            serde_json::json!([{ "name": "fire.0007" }, { "name": "fire.0008" }, { "name": "fire.0009" }])
        );
        let primitive = &json["meshes"][0]["primitives"][0];
        assert_eq!(primitive["material"], 0);
        let mappings = serde_json::json!([
            { "material": 0, "variants": [0] }, { "material": 1, "variants": [1] }, { "material": 2, "variants": [2] }
        ]);
        assert_eq!(primitive["extensions"]["KHR_materials_variants"]["mappings"], mappings);
    }
}

fn check_materialx(path: &Path, normal: NormalConvention) {
    let text = fs::read_to_string(path).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!((root.tag_name().name(), root.attribute("version")), ("materialx", Some("1.38")));
    // Every name that is used is declared: nodes and outputs in their graph, graphs and shaders in the document.
    let named = |parent: roxmltree::Node, name: &str| {
        parent.children().filter(|child| child.is_element()).any(|child| child.attribute("name") == Some(name))
    };
    let graph = root.children().find(|node| node.has_tag_name("nodegraph")).unwrap();
    for node in document.descendants().filter(|node| node.is_element()) {
        let within = if node.ancestors().any(|ancestor| ancestor == graph) { graph } else { root };
        if let Some(name) = node.attribute("nodename") {
            assert!(named(within, name), "{name}");
        }
        if let Some(name) = node.attribute("nodegraph") {
            assert!(named(root, name) && named(graph, node.attribute("output").unwrap()));
        }
        if node.attribute("type") == Some("filename") {
            let file = node.attribute("value").unwrap();
            assert!(path.with_file_name(file).exists(), "{file}");
            let color = file.starts_with("color") || file.starts_with("emission");
            assert_eq!(node.attribute("colorspace"), color.then_some("srgb_texture"), "{file}");
        }
    }
    let shader = root.children().find(|node| node.has_tag_name("standard_surface")).unwrap();
    for input in ["base_color", "specular_roughness", "normal", "emission_color"] {
        assert!(named(shader, input), "{input}");
    }
    assert_eq!(text.contains("1, -1, 1"), normal == NormalConvention::DirectX);
}

/// Looks, and from some look on wants it stopped.
struct Impatient(AtomicU32);

impl Observer for Impatient {
    fn cancelled(&self) -> bool {
        let less = |looks: u32| Some(looks.saturating_sub(1));
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok_and(|looks| looks <= 1)
    }
}

#[test]
fn a_stopped_bake_leaves_nothing() {
    let here = tempfile::tempdir().unwrap();
    let bake = bake_with("marble", settings());
    for looks in [1, 40, 74] {
        let folder = here.path().join("set");
        let target = SetFolder::new(&folder).unwrap();
        let result = write_set(&bake, &SetOptions::new(MapFormat::Png8), target, &Impatient(AtomicU32::new(looks)));
        assert!(matches!(result, Err(SetError::Cancelled)), "{looks}: {result:?}");
        assert_eq!(names(here.path()), Vec::<String>::new());
    }
}

#[test]
fn a_stopped_gallery_leaves_nothing() {
    let here = tempfile::tempdir().unwrap();
    for looks in [1, 40, 74] {
        let target = SetFolder::new(&here.path().join("gallery")).unwrap();
        let result = write_gallery(Texture::ALL, target, &Impatient(AtomicU32::new(looks)));
        assert!(matches!(result, Err(SetError::Cancelled)), "{looks}: {result:?}");
        assert_eq!(names(here.path()), Vec::<String>::new());
    }
}

#[test]
fn a_set_replaces_a_set_and_nothing_else() {
    let here = tempfile::tempdir().unwrap();
    let folder = here.path().join("set");
    let one = bake_with("marble", Settings { maps: vec![Map::Color, Map::Height], ..settings() });
    write(&one, MapFormat::Png8, &folder).unwrap();
    let two = bake_with("stone", Settings { maps: vec![Map::Normal], ..settings() });
    write(&two, MapFormat::Png8, &folder).unwrap();
    assert_eq!(names(&folder), ["material.json", "normal.png", "stone.bin", "stone.gltf", "stone.mtlx"]);
    assert_eq!(names(here.path()), ["set"]);

    fs::write(folder.join("notes.txt"), "mine").unwrap();
    let refused = write(&one, MapFormat::Png8, &folder);
    assert!(matches!(&refused, Err(SetError::Occupied { file, .. }) if file == "notes.txt"), "{refused:?}");
    assert_eq!(names(here.path()), ["set"]);
    assert_eq!(names(&folder).len(), 6);
}

#[test]
fn places_that_cannot_be_written_are_told_before_any_work() {
    let here = tempfile::tempdir().unwrap();
    fs::write(here.path().join("file"), "").unwrap();
    for place in ["file", "missing/set", "file/set"] {
        let error = SetFolder::new(&here.path().join(place)).unwrap_err();
        assert!(matches!(error, SetError::Write { .. }), "{place}: {error:?}");
    }
    assert_eq!(names(here.path()), ["file"]);
}

#[test]
fn an_empty_folder_is_used() {
    let here = tempfile::tempdir().unwrap();
    let bake = bake_with("wood", Settings { maps: vec![Map::Color], ..settings() });
    write(&bake, MapFormat::Png8, here.path()).unwrap();
    assert!(here.path().join("color.png").exists());
    // What was written is what is in memory.
    let array = &bake.arrays(0, &()).unwrap().maps[0];
    let image = image::load(Cursor::new(fs::read(here.path().join("color.png")).unwrap()), image::ImageFormat::Png);
    let bytes: Vec<u8> = array.values.iter().map(|value| (255.0 * value + 0.5) as u8).collect();
    assert_eq!(image.unwrap().into_rgb8().into_raw(), bytes);
}

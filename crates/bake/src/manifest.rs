//! `material.json`: what was baked, with everything that one needs to use it, or to bake it again.

use jaspe_texture::declare::Value;
use serde_json::{Map as Object, Value as Json, json};

use crate::bake::{Bake, Loop};
use crate::map::{ColorSpace, Map};
use crate::set::{SetOptions, file_name};

/// A bake, how it was written, and what was found meanwhile.
pub(crate) struct Described<'a> {
    pub bake: &'a Bake,
    pub options: &'a SetOptions,
    /// In units of the texture.
    pub height_range: [f64; 2],
}

impl Described<'_> {
    /// The material's name, which is also that of its files.
    pub fn name(&self) -> &'static str {
        self.bake.texture().declaration().name
    }

    /// How high the relief is in units of the texture, from black to white.
    pub fn height_scale(&self) -> f64 {
        self.height_range[1] - self.height_range[0]
    }

    /// The text of the file.
    pub fn json(&self, files: &[String]) -> String {
        let bake = self.bake;
        let texture = bake.texture();
        let parameters: Object<String, Json> = texture
            .arguments()
            .iter()
            .filter_map(|(name, value)| Some(((*name).to_owned(), value_json(*value)?)))
            .collect();
        let maps: Object<String, Json> =
            bake.settings().maps.iter().map(|&map| (map.name().to_owned(), self.map_json(map))).collect();
        let [lowest, highest] = self.height_range;
        let mut json = json!({
            "generator": concat!("jaspe ", env!("CARGO_PKG_VERSION")),
            "material": self.name(),
            "parameters": parameters,
            "surface": {
                "kind": bake.settings().surface.name(),
                "repeats": bake.settings().surface.tiles(),
                "width_in_units": bake.tile(),
                "width_in_noise_cells": bake.cells(),
                "octaves_shown": octaves(bake),
            },
            "size": [bake.width(), bake.height()],
            "height": {
                "lowest": lowest,
                "highest": highest,
                "scale": self.height_scale(),
                "scale_for_width_1": self.height_scale() / bake.tile(),
                "unit": "texture units; the map's 0 is the lowest point, its 1 the highest",
            },
            "maps": maps,
            "files": files,
        });
        if bake.settings().maps.contains(&Map::Normal) {
            json["normal"] = json!({
                "convention": bake.settings().normal.name(),
                "green_points": if bake.settings().normal.name() == "gl" { "up" } else { "down" },
            });
        }
        if let Some(bands) = bake.bands_across() {
            json["surface"]["bands"] = json!(bands);
        }
        if let Some(Loop { frames, first, cells }) = bake.settings().animation {
            json["animation"] =
                json!({ "frames": frames, "first": first, "noise_cells_of_time": cells, "loops": true });
        }
        format!("{json:#}\n")
    }

    fn map_json(&self, map: Map) -> Json {
        let format = self.options.format_of(map);
        let declaration = map.declaration();
        let color_space = match (declaration.color_space, format.is_linear()) {
            (ColorSpace::Srgb, false) => "srgb",
            (ColorSpace::Srgb, true) => "linear",
            (ColorSpace::Data, _) => "data",
        };
        let mut json = json!({
            "color_space": color_space,
            "channels": declaration.channels,
            "format": format.to_string(),
            "summary": declaration.summary,
        });
        let names: Vec<String> =
            (0..self.bake.frames()).map(|frame| file_name(self.bake, self.options, map, frame)).collect();
        match &names[..] {
            [name] if self.bake.settings().animation.is_none() => json["file"] = json!(name),
            _ => json["files"] = json!(names),
        }
        json
    }
}

/// The octaves that the maps show, with a part of one that fades in.
fn octaves(bake: &Bake) -> u32 {
    bake.shown().sum().octaves()
}

/// A parameter's value; none where it follows from the surroundings, of which a map has none.
fn value_json(value: Value) -> Option<Json> {
    match value {
        Value::Int(value) => Some(json!(value)),
        Value::Float(value) => Some(json!(value)),
        Value::Color(value) => Some(json!(value)),
        Value::Choice(value) => Some(json!(value)),
        Value::Auto => None,
    }
}

//! The maps that can be baked, each declared once.

/// A map: what a pixel of it tells about the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Map {
    /// The material's colour.
    Color,
    /// The height of the surface.
    Height,
    /// The direction of the surface.
    Normal,
    /// How matte it is.
    Roughness,
    /// How much of the sky it sees.
    Occlusion,
    /// The light it gives off.
    Emission,
}

/// What the numbers of a map mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Colours, encoded for display by the curve of sRGB. (Files of linear light hold them decoded.)
    Srgb,
    /// Numbers that no curve may touch.
    Data,
}

/// What a map is called and what it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MapDeclaration {
    /// The word for it on the command line, and the name of its file.
    pub name: &'static str,
    /// 1 or 3.
    pub channels: usize,
    /// What its numbers mean.
    pub color_space: ColorSpace,
    /// One sentence for lists and help texts.
    pub summary: &'static str,
}

impl Map {
    /// Every map, in the order of the reference page.
    pub const ALL: &[Map] = &[Map::Color, Map::Height, Map::Normal, Map::Roughness, Map::Occlusion, Map::Emission];

    /// What it declares.
    pub fn declaration(self) -> &'static MapDeclaration {
        use ColorSpace::{Data, Srgb};
        macro_rules! declare {
            ($name:literal, $channels:literal, $color_space:ident, $summary:literal) => {
                &MapDeclaration { name: $name, channels: $channels, color_space: $color_space, summary: $summary }
            };
        }
        match self {
            Map::Color => declare!("color", 3, Srgb, "The material's colour, without light or shadow."),
            Map::Height => declare!("height", 1, Data, "Height from the lowest point (0) to the highest (1)."),
            Map::Normal => declare!("normal", 3, Data, "Direction in tangent space, from -1…1 mapped to 0…1."),
            Map::Roughness => declare!("roughness", 1, Data, "From 0, a mirror, to 1, matte."),
            Map::Occlusion => declare!("ao", 1, Data, "The share of the sky that the relief leaves free."),
            Map::Emission => declare!("emission", 3, Srgb, "The light that the material gives off."),
        }
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The map of this name.
    pub fn from_name(name: &str) -> Option<Map> {
        Map::ALL.iter().copied().find(|map| map.name() == name)
    }
}

/// Which way green points in a normal map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum NormalConvention {
    /// Up in the picture: OpenGL, glTF, Blender, Godot, Unity.
    #[default]
    OpenGl,
    /// Down in the picture: DirectX, Unreal.
    DirectX,
}

impl NormalConvention {
    /// The word for it on the command line.
    pub fn name(self) -> &'static str {
        match self {
            NormalConvention::OpenGl => "gl",
            NormalConvention::DirectX => "dx",
        }
    }
}

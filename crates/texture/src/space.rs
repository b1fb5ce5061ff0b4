//! Where the points of a texture live.

/// The space in which a texture's points are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Space {
    /// The object's own coordinates: on a sphere those of the unit sphere, on a mesh those of its file.
    Local,
    /// The scene's coordinates.
    World,
    /// The surface's texture coordinates u and v; the noise has two dimensions there.
    Uv,
}

impl Space {
    /// Every space.
    pub const ALL: &[Space] = &[Space::Local, Space::World, Space::Uv];
    /// The words for them, in the same order.
    pub const NAMES: &[&str] = &["local", "world", "uv"];

    /// The word for it in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Space::Local => "local",
            Space::World => "world",
            Space::Uv => "uv",
        }
    }

    /// The space of this name.
    pub fn from_name(name: &str) -> Option<Space> {
        Space::ALL.iter().copied().find(|space| space.name() == name)
    }
}

/// The noise cells per unit of each space, so that a material looks alike in all of them: the report's figures fix one,
/// the others follow from the unit sphere, along whose meridian v runs from 0 to 1 over the length π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frequencies {
    /// Per unit of the object's coordinates.
    pub local: f32,
    /// Per unit of the scene's coordinates.
    pub world: f32,
    /// Per unit of u and v.
    pub uv: f32,
}

impl Frequencies {
    /// That of a space.
    pub fn of(self, space: Space) -> f32 {
        match space {
            Space::Local => self.local,
            Space::World => self.world,
            Space::Uv => self.uv,
        }
    }
}

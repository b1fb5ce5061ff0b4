//! A baked material on a ball and a cloth, under a sky, by the project's own renderer. Any surface but a plane wears its maps itself.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use jaspe_noise::math::{cos, sin};
use jaspe_render::{
    Cancelled, CompileOptions, Encoding, Film, Format, Observer, RenderOptions, compile, encode, render,
};
use jaspe_scene::{MemoryLoader, parse};

use crate::bake::{Arrays, Bake, Settings};
use crate::map::{Map, NormalConvention};
use crate::model::Model;
use crate::set::Work;
use crate::surface::sheet;

/// Pixels of a preview, unless something else is asked for.
pub const PREVIEW_SIZE: [u32; 2] = [960, 600];

/// The longest side of the maps that a preview wears.
const MAPS: u32 = 1024;

/// How much of the day is left where something glows.
const DUSK: f32 = 0.3;

/// The preview of a frame of a bake (0 where there is one only), in pixels. What glows is seen at dusk, and lights the floor.
///
/// # Errors
/// [`Cancelled`] when the observer asked for it.
pub fn preview(bake: &Bake, frame: u32, size: [u32; 2], observer: &dyn Observer) -> Result<Film, Cancelled> {
    let glows = bake.texture().finish().emission > 0.0;
    let with = |size: u32| {
        let maps = Map::ALL.iter().copied().filter(|&map| match map {
            Map::Color | Map::Normal | Map::Roughness => true,
            Map::Emission => glows,
            Map::Height | Map::Occlusion => false,
        });
        let settings =
            Settings { size, maps: maps.collect(), normal: NormalConvention::OpenGl, ..bake.settings().clone() };
        Bake::new(bake.texture().clone(), settings)
    };
    // (Smaller maps may be too coarse for the material.)
    let small = with(bake.settings().size.min(MAPS)).or_else(|_| with(bake.settings().size));
    let small = small.expect("what could be baked can be baked with these maps");
    let arrays = small.arrays(frame, &Silent(observer))?;
    let mut loader = MemoryLoader::default();
    for array in &arrays.maps {
        loader = loader.with(format!("{}.png", array.map.name()), png(&film(&arrays, array.map)));
    }
    let render = |lit: &str, most: [u64; 2]| {
        let text = scene(&small, size, lit);
        let (scene, diagnostics) = parse("preview.sc".as_ref(), text.as_bytes(), &loader);
        debug_assert!(diagnostics.is_empty(), "{diagnostics:?}");
        let compiled = compile(&scene, &loader, &CompileOptions::default()).scene;
        let compiled = compiled.expect("the scene of the preview has no mistakes");
        let options = RenderOptions { threads: Some(rayon::current_num_threads()), ..RenderOptions::default() };
        let [before, most] = most;
        let work = Work { observer, before, most, total: 100 };
        Ok(render(&compiled, &options, &Growing { work, first: AtomicU64::new(u64::MAX) })?.0)
    };
    let day = by_day(mean(&arrays, Map::Roughness));
    if !glows {
        return render(&day, [0, 100]);
    }
    // Light adds up: that of the sky, and that of the surface itself.
    let mut sum = render(&day, [0, 50])?;
    let glow = render(BY_NIGHT, [50, 50])?;
    for (pixel, glow) in sum.pixels.iter_mut().zip(&glow.pixels) {
        pixel.iter_mut().zip(glow).take(3).for_each(|(light, glow)| *light = DUSK * *light + glow);
    }
    Ok(sum)
}

/// Tells of a rendering whose total is known only when its first pass is over, as those of previews are.
struct Growing<'a> {
    work: Work<'a>,
    /// The first total: that of the first pass.
    first: AtomicU64,
}

impl Observer for Growing<'_> {
    fn progress(&self, done: u64, total: u64) {
        let first = self.first.fetch_min(total, Ordering::Relaxed).min(total);
        // The second pass has taken one and a half times as long as the first.
        self.work.progress(done, total.max(first * 5 / 2));
    }

    fn cancelled(&self) -> bool {
        self.work.cancelled()
    }
}

/// Stops as another observer does, and tells it nothing.
pub(crate) struct Silent<'a>(pub &'a dyn Observer);

impl Observer for Silent<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// A map as a picture of display values.
pub(crate) fn film(arrays: &Arrays, map: Map) -> Film {
    let mut film = Film::new(arrays.width, arrays.height, Encoding::Display);
    if let Some(array) = arrays.maps.iter().find(|array| array.map == map) {
        let pixels = array.values.chunks_exact(map.declaration().channels);
        for (pixel, values) in film.pixels.iter_mut().zip(pixels) {
            *pixel = [values[0], values[values.len() / 2], values[values.len() - 1], 1.0];
        }
    }
    film
}

fn png(film: &Film) -> Vec<u8> {
    encode(film, Format::Png(jaspe_render::Depth::Eight)).expect("maps fit PNG")
}

fn mean(arrays: &Arrays, map: Map) -> f64 {
    let array = arrays.maps.iter().find(|array| array.map == map);
    array.map_or(0.5, |array| {
        array.values.iter().map(|&value| f64::from(value)).sum::<f64>() / array.values.len() as f64
    })
}

/// Sun and sky, and the material as they show it.
fn by_day(roughness: f64) -> String {
    let shader = if roughness < 0.25 {
        "shiny texture color.png refl 0.06".to_owned()
    } else {
        // GGX's α is the square of the roughness, and Ward's width is close to it.
        let spread = (roughness * roughness).clamp(0.05, 0.6);
        format!("ward texture color.png spec 0.04 0.04 0.04 rough {spread} {spread} samples 4")
    };
    format!(
        "light {{ type sunsky up 0 0 1 east 0 1 0 sundir -0.65 -0.7 0.85 turbidity 3 samples 20 }}\n\
         shader {{ name material type {shader} }}\n"
    )
}

/// No light but the material's own.
const BY_NIGHT: &str = "gi { type path samples 8 }\nshader { name material type constant texture emission.png }\n";

/// The scene: a plane is worn by a ball and a cloth, any other surface by itself.
fn scene(bake: &Bake, [width, height]: [u32; 2], light_and_material: &str) -> String {
    let mut text = format!(
        "image {{ resolution {width} {height} aa 1 2 filter mitchell }}\n\
         trace-depths {{ diff 1 refl 3 refr 2 }}\n\
         camera {{ type pinhole eye 0 -8.2 2.6 target 0.1 0 1.12 up 0 0 1 fov 38 aspect {} }}\n\
         modifier {{ name relief type normalmap texture normal.png }}\n\
         shader {{ name floor type diffuse diff {{ \"sRGB nonlinear\" 0.58 0.56 0.53 }} }}\n\
         object {{ shader floor type plane p 0 0 0 n 0 0 1 }}\n{light_and_material}",
        f64::from(width) / f64::from(height)
    );
    if bake.settings().surface.tiles() {
        mesh(&mut text, &ball());
        mesh(&mut text, &cloth());
    } else {
        // Upright, its y upwards, on the floor and as high as the picture wants it.
        let own = bake.settings().surface.model(1.0);
        let points = || own.vertices.iter().map(|vertex| DVec3::from(vertex.point));
        let (least, most) =
            (points().fold(DVec3::INFINITY, DVec3::min), points().fold(DVec3::NEG_INFINITY, DVec3::max));
        let size = most - least;
        let factor = (2.2 / size.y.max(1e-9)).min(3.6 / size.x.max(size.z).max(1e-9));
        let (a, b) = (cos(0.6), sin(0.6));
        let turn = |v: [f64; 3]| [a * v[0] + b * v[2], b * v[0] - a * v[2], v[1]];
        let middle = 0.5 * (least + most);
        let mut model = own.clone();
        for vertex in &mut model.vertices {
            let point = (DVec3::from(vertex.point) - DVec3::new(middle.x, least.y, middle.z)) * factor;
            vertex.point = turn(point.to_array());
            vertex.normal = turn(vertex.normal);
        }
        mesh(&mut text, &model);
    }
    text
}

/// Adds a mesh that wears the material.
fn mesh(text: &mut String, model: &Model) {
    let _ =
        writeln!(text, "object {{ shader material modifier relief type generic-mesh points {}", model.vertices.len());
    let row = |text: &mut String, numbers: &[f64]| {
        numbers.iter().for_each(|&number| {
            let _ = write!(text, " {}", number as f32);
        });
        text.push('\n');
    };
    model.vertices.iter().for_each(|vertex| row(text, &vertex.point));
    let _ = writeln!(text, "triangles {}", model.triangles.len());
    for [a, b, c] in &model.triangles {
        let _ = writeln!(text, " {a} {b} {c}");
    }
    text.push_str("normals vertex\n");
    model.vertices.iter().for_each(|vertex| row(text, &vertex.normal));
    text.push_str("uvs vertex\n");
    model.vertices.iter().for_each(|vertex| row(text, &vertex.uv));
    text.push_str("}\n");
}

/// A ball of the radius 1 that stands on the floor, the material twice around its axis.
fn ball() -> Model {
    let mut ball = crate::surface::Surface::Sphere.model(2.0);
    for vertex in &mut ball.vertices {
        let stand = |[x, y, z]: [f64; 3]| [x, -z, y];
        let [x, y, z] = stand(vertex.point);
        vertex.point = [x - 1.35, y - 0.6, z + 1.0];
        vertex.normal = stand(vertex.normal);
        vertex.uv = [3.0 * vertex.uv[0], 1.5 * vertex.uv[1]];
    }
    ball
}

/// A cloth that hangs in folds.
fn cloth() -> Model {
    let folds = |u: f64, v: f64| {
        let sway = 0.1 * sin(2.0 * v + 1.0);
        let depth = 0.26 - 0.1 * v;
        let y = 0.7 + depth * sin(17.0 * u + sway * 6.0 + 0.7 * sin(5.0 * u)) + 0.04 * sin(41.0 * u + 3.0 * v);
        DVec3::new(-0.15 + 3.1 * u + sway * 0.4, y, 0.02 + 2.65 * v)
    };
    let mut cloth = sheet([160, 60], &|u, v| {
        let step = 1e-4;
        let (by_u, by_v) = (folds(u + step, v) - folds(u - step, v), folds(u, v + step) - folds(u, v - step));
        (folds(u, v), by_u.cross(by_v).normalize(), by_u.normalize())
    });
    // As much cloth as the folds take, at the ball's scale.
    cloth.vertices.iter_mut().for_each(|vertex| vertex.uv = [2.1 * vertex.uv[0], 1.27 * vertex.uv[1]]);
    cloth
}

//! What several tests share.
#![allow(dead_code, reason = "each test uses a part of it")]

use std::fs;
use std::path::{Path, PathBuf};

use jaspe_scene::{Diagnostics, MemoryLoader, Scene, parse};

/// A line of everything, in the order that Sunflow requires (format reference, §2.14).
pub const SKELETON: &str = r#"% comment
image { resolution 640 480 aa 0 2 samples 1 contrast 0.1 filter mitchell jitter false }
trace-depths { diff 1 refl 4 refr 4 }
background { color { "sRGB nonlinear" 0.2 0.3 0.5 } }
gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 5.0 global 100000 grid 50 0.5 }
photons { caustics 100000 kd 64 0.5 }
camera { type thinlens shutter 0 1 eye 0 -10 3 target 0 0 1 up 0 0 1 fov 45 aspect 1.333 shift 0 0 fdist 10 lensr 0.1 sides 6 rotation 15 }
shader { name "red" type shiny diff { "sRGB nonlinear" 0.8 0.1 0.1 } refl 0.2 }
shader { name tex type diffuse texture "textures/a b.png" }
modifier { name bump1 type bump texture textures/b.png scale 0.02 }
object { shader "red" type sphere name ball c 0 0 1 r 1 }
object { shader tex modifier bump1 transform { scaleu 0.02 rotatez 45 translate 3 0 0 } type teapot name pot subdivs 8 smooth true }
object { noinstance type generic-mesh name tri points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 normals none uvs vertex 0 0 1 0 0 1 }
instance { name t1 geometry tri transform steps 2 times 0 1 { translate 0 0 0 } { translate 0 0 1 } shaders 1 tex }
light { type point color 1 1 1 power 500 p 5 -5 8 }
"#;

/// What the skeleton leaves out.
pub const OTHERS: &str = r#"dialect report
bucket 32 "reverse hilbert"
filter gaussian 3 3
texturepath "textures" override none false
shader { name p type phong diff { "XYZ" .3 .4 .5 } spec { "sRGB nonlinear" 1 1 1 } 50 samples 4 }
shader { name g type glass eta 1.5 color 1 1 1 absorbtion.distance 2 absorbtion.color { "spectrum 400 700" 4 .1 .5 1 .5 } }
shader { name m type mirror refl { "sRGB linear" 1 1 1 } } shader { name c type constant 1 2 3 }
shader { name w type wood depth 5 diffuse_initial { "sRGB nonlinear" 0.4 0.2 0 } noise lattice sum plain seed 3 scale 2 space world }
shader { name j type janino <code>
  public Color getRadiance(ShadingState state) { return "}"; }
</code>
}
object { shaders 2 p w transform row 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 type generic-mesh
  points 4 0 0 0  1 0 0  0 1 0  1 1 0  triangles 2 0 1 2  2 1 3
  normals vertex 0 0 1 0 0 1 0 0 1 0 0 1  uvs facevarying 0 0 1 0 0 1 0 1 1 0 1 1  face_shaders 0 1 }
object { shader g type mesh name old 3 1
  v 0 0 0 0 0 1 0 0
  v 1 0 0 0 0 1 1 0
  v 0 1 0 0 0 1 0 1
  t 0 1 2
}
object { shader m type plane p 0 0 0 p 1 0 0 p 0 1 0 } object { shader c type box points 2 1 1 1 -1 -1 -1 }
camera { type spherical steps 2 times 0 1 { eye 0 0 5 target 0 0 0 up 0 1 0 } transform { rotate 0 1 0 90 } }
light { type directional source 0 0 4 target 0 0 0 radius 1 emit 1 0.5 0.25 intensity 2 }
light { type point power { "blackbody" 2000 } p 0 0 0 }
"#;

/// The blocks that the skeleton and the others name only in passing.
pub const REST: &str = r#"gi { type igi samples 64 sets 2 b 0.00003 bias-samples 1 }
gi { type ambocc bright 1 1 1 dark 0 0 0 samples 32 maxdist 3 }
gi { type fake up 0 1 0 sky 0.5 0.5 1 ground 0.1 0.1 0.1 }
gi { type path samples 16 bounces 4 }
photons { emit 1000 global grid 50 0.5 caustics kd 50 0.5 }
lightserver { shadows true direct-samples 3 glossy-samples 2 max-depth 4 global false 1 2 3 4 caustics true 1 0.5 2 0.5 irr-cache 1 2 3 4 }
image { sampler multipass samples 8 cache true show-aa false output a.png }
texture { name veins type marble depth 3 scale 2 }
modifier { name b type bump texture veins scale 0.5 }
modifier { name n type normalmap texture "n.png" }
modifier { name q type perlin function 1 size 2 scale 50 }
shader { name w type ward texture veins spec 0.5 0.5 0.5 rough 0.2 0.1 samples 8 }
shader { name a type amb-occ bright 1 1 1 dark 0.1 0 0 samples 16 dist 2 }
shader { name a2 type amb-occ2 texture "t.png" }
shader { name u type uber diff 0.5 0.5 0.5 diff.texture veins diff.blend 0.25 refl 0.1 0.1 0.1 spec.texture "s.png" glossy 0.1 samples 2 }
shader { name wf type wireframe line 1 0 0 fill 0 0 0 width 0.01 }
shader { name vc type view-caustics } shader { name vi type view-irradiance } shader { name vg type view-global } shader { name i type id }
light { type spherical color 1 1 1 radiance 10 center 3 0 3 radius 1 samples 16 }
light { type meshlight name lamp emit 1 1 1 radiance 5 samples 2 points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 }
light { type mesh name old emit 1 1 1 3 1 v 0 0 0 0 0 1 0 0 v 1 0 0 0 0 1 0 0 v 0 1 0 0 0 1 0 0 t 0 1 2 }
light { type sunsky up 0 0 1 east 0 1 0 sundir 1 1 1 turbidity 4 ground.extendsky true }
light { type ibl image "sky.hdr" center 0 -1 0 up 0 0 1 lock true lowsamples 5 }
light { type cornellbox corner0 -1 -1 0 corner1 1 1 2 left 0.8 0.2 0.2 right 0.2 0.2 0.8 top 0.7 0.7 0.7 bottom 0.7 0.7 0.7 back 0.7 0.7 0.7 emit 15 15 15 samples 32 }
object { shader w modifiers 2 b None type file-mesh name f filename "a.obj" smooth_normals true }
object { noinstance type bezier-mesh name z n 3 4 wrap true false points 0 0 0 1 0 0 1 1 0 0 0 1 1 0 1 1 1 1 0 0 2 1 0 2 1 1 2 0 0 3 1 0 3 1 1 3 subdivs 4 smooth false }
object { shader w modifier n type gumbo subdivs 3 } object { shader w type torus r 0.25 1 }
object { shader w type cylinder } object { shader w type banchoff }
object { shader w type sphereflake level 3 axis 0 1 0 radius 2 } object { shader w type julia q 0.1 0.2 0.3 0.4 iterations 8 epsilon 0.001 }
object { shader w type hair segments 1 width 0.1 points 12 0 0 0 0 0 1 1 0 0 1 0 1 }
object { shader w type particles filename "p.dat" little_endian num 10 radius 0.5 }
object { shader w type dlasurface points 2 0 0 0 1 1 1 radius 0.25 }
instance { name zz geometry z transform { } shader w modifier q }
bucket 64 "reverse spiral"
camera { type fisheye transform { } } camera { type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 shift 0.5 0 }
"#;

/// Reads a text that includes nothing.
pub fn read(text: &str) -> (Scene, Diagnostics) {
    parse(Path::new("test.sc"), text.as_bytes(), &MemoryLoader::default())
}

/// The scene of a text that gives rise to no remark at all.
#[track_caller]
pub fn clean(text: &str) -> Scene {
    let (scene, diagnostics) = read(text);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    scene
}

/// All messages about a text.
pub fn messages(text: &str) -> Vec<String> {
    read(text).1.iter().map(|diagnostic| format!("{}: {}", diagnostic.severity, diagnostic.message)).collect()
}

/// The scenes below a folder of the checkout, or beside it; none if it is absent.
pub fn scenes(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "sc") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

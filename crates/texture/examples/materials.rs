//! Nanoseconds a point of each material as figure 7 has it, for batches of several sizes:
//! `cargo run --release -p jaspe-texture --example materials`.

use std::hint::black_box;
use std::time::Instant;

use jaspe_texture::{Space, Texture};

/// The least time of a run of some dozen microseconds, in nanoseconds a point: what the machine can.
fn time(points: usize, mut work: impl FnMut()) -> f64 {
    let mut run = || {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e9 / points as f64
    };
    (0..4000).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn main() {
    const COUNTS: [usize; 6] = [48, 100, 256, 400, 1000, 4096];
    const MOST: usize = COUNTS[COUNTS.len() - 1];
    println!("{:8} {:6} {:?} points a batch", "", "octaves", COUNTS);
    for declaration in Texture::ALL {
        let depth = if declaration.name == "organic" { 20 } else { 0 };
        let arguments = if depth > 0 { vec![("depth", jaspe_texture::declare::Value::Int(depth))] } else { Vec::new() };
        let Ok(texture) = Texture::build(declaration.name, &arguments) else { continue };
        let texture = texture.in_figure_space();
        // Sixteen samples of each pixel in rows of a picture of a sphere.
        let x: Vec<f32> = (0..MOST).map(|i| (i / 16 % 64) as f32 / 64.0 - 0.5 + (i * 7 % 16) as f32 / 1024.0).collect();
        let y: Vec<f32> = (0..MOST).map(|i| 0.3 + (i / 1024) as f32 / 64.0 + (i * 11 % 16) as f32 / 1024.0).collect();
        let z: Vec<f32> = x.iter().zip(&y).map(|(x, y)| (1.0 - x * x - y * y).sqrt()).collect();
        let mut coefficients = vec![0.0; MOST];
        print!("{:8} {:6}", declaration.name, texture.sum().octaves());
        for count in COUNTS {
            let (x, y, z, out) = (&x[..count], &y[..count], &z[..count], &mut coefficients[..count]);
            let nanoseconds = time(count, || match texture.space() {
                Space::Uv => texture.evaluate([x, y], black_box(&mut *out)),
                Space::World | Space::Local => texture.evaluate([x, y, z], black_box(&mut *out)),
            });
            print!(" {nanoseconds:7.2}");
        }
        println!();
    }
}

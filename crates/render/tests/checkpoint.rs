//! A rendering that is interrupted and goes on gives the picture of one that is not.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use jaspe_render::{
    Checkpoint, CheckpointError, CompileOptions, CompiledScene, Film, Observer, RenderOptions, ResumeError, compile,
    render, resume,
};
use jaspe_scene::{Dialect, MemoryLoader, parse};

const SCENE: &str = "
image { resolution 75 50 aa 0 0 filter mitchell }
background { color 0.1 0.2 0.3 }
camera { type thinlens eye 1.5 2 6 target 0 0 0 up 0 1 0 fov 30 aspect 1.5 fdist 6 lensr 0.1 }
light { type point color 1 1 1 power 2600 p 5 7 6 }
light { type spherical color 1 1 1 radiance 40 center -3 6 2 radius 0.5 samples 4 }
shader { name floor type marble depth 3 }
shader { name clear type glass eta 1.5 color 1 1 1 }
shader { name silver type mirror refl 0.9 0.9 0.9 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader clear type sphere c -0.8 0 0.5 r 0.9 }
object { shader silver type sphere c 1 0 -0.5 r 0.9 }
";
const PHOTONS: &str = "photons { caustics 3000 kd 20 0.5 }
gi { type igi samples 8 sets 1 b 0.01 bias-samples 0 }
";

fn compiled(text: &str, options: &CompileOptions) -> CompiledScene {
    let loader = MemoryLoader::default();
    let (scene, diagnostics) = parse("a.sc".as_ref(), text.as_bytes(), &loader);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}");
    compile(&scene, &loader, options).scene.expect("no errors")
}

/// Has enough after some steps, and keeps the state.
struct Impatient {
    steps: u64,
    seen: AtomicU64,
    kept: Mutex<Option<Checkpoint>>,
}

impl Impatient {
    fn new(steps: u64) -> Self {
        Impatient { steps, seen: AtomicU64::new(0), kept: Mutex::new(None) }
    }
}

impl Observer for Impatient {
    fn progress(&self, done: u64, total: u64) {
        assert!(done <= total, "{done} of {total}");
        self.seen.fetch_add(1, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.seen.load(Ordering::Relaxed) >= self.steps
    }

    fn wants_checkpoint(&self) -> bool {
        self.cancelled()
    }

    fn checkpoint(&self, state: Checkpoint) {
        *self.kept.lock().expect("nobody panicked") = Some(state);
    }
}

/// Renders with an interruption after every few steps, each time going on with another number of threads; returns how often
/// it was interrupted, too.
fn in_parts(scene: &CompiledScene, options: &RenderOptions, steps: u64) -> (Film, u32) {
    let mut state: Option<Checkpoint> = None;
    for part in 0.. {
        let observer = Impatient::new(steps);
        let options = RenderOptions { threads: Some(1 + part as usize % 3), ..options.clone() };
        let result = match &state {
            None => render(scene, &options, &observer).map_err(Into::into),
            Some(state) => resume(scene, &options, state, &observer),
        };
        match result {
            Ok((film, _)) => return (film, part),
            Err(error) => assert_eq!(error, ResumeError::Cancelled),
        }
        let kept = observer.kept.into_inner().expect("nobody panicked").expect("the state was handed out");
        let bytes = kept.to_bytes("these tests");
        state = Some(Checkpoint::from_bytes(&bytes, "these tests").expect("it was just saved"));
    }
    unreachable!("it ends some day")
}

fn bits(film: &Film) -> Vec<[u32; 4]> {
    film.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[track_caller]
fn interruptions_leave_no_trace(text: &str, compile_options: CompileOptions, crop: Option<[u32; 4]>) {
    let scene = compiled(text, &compile_options);
    let options = RenderOptions { crop, seed: 3, ..RenderOptions::default() };
    let (whole, _) = render(&scene, &options, &()).expect("nobody cancels");
    for steps in [1, 4] {
        let (film, parts) = in_parts(&scene, &options, steps);
        assert!(parts >= 2, "{parts} interruptions prove little");
        assert!(bits(&film) == bits(&whole), "{compile_options:?}, crop {crop:?}, every {steps} steps");
    }
}

#[test]
fn a_single_pass_goes_on() {
    for samples in [4, 700, 2500] {
        let resolution = if samples > 100 { Some([9, 5]) } else { None };
        interruptions_leave_no_trace(
            SCENE,
            CompileOptions { samples: Some(samples), resolution, ..CompileOptions::default() },
            None,
        );
    }
}

#[test]
fn adaptive_passes_go_on() {
    for aa in [[0, 2], [1, 2], [-2, 1]] {
        interruptions_leave_no_trace(SCENE, CompileOptions { aa: Some(aa), ..CompileOptions::default() }, None);
    }
}

#[test]
fn crops_go_on() {
    for crop in [[3, 4, 70, 45], [33, 0, 75, 50]] {
        for aa in [[1, 1], [0, 1]] {
            interruptions_leave_no_trace(
                SCENE,
                CompileOptions { aa: Some(aa), ..CompileOptions::default() },
                Some(crop),
            );
        }
    }
}

#[test]
fn the_report_goes_on() {
    let options = CompileOptions { dialect: Some(Dialect::Report), aa: Some([0, 1]), ..CompileOptions::default() };
    interruptions_leave_no_trace(SCENE, options, None);
}

#[test]
fn photons_are_sent_again() {
    let options = CompileOptions { aa: Some([0, 1]), ..CompileOptions::default() };
    interruptions_leave_no_trace(&format!("{SCENE}{PHOTONS}"), options, None);
}

/// Never has enough of checkpoints, and rebuilds the picture from its tiles.
struct Curious {
    kept: Mutex<Vec<Checkpoint>>,
    film: Mutex<Film>,
}

impl Observer for Curious {
    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&self, state: Checkpoint) {
        self.kept.lock().expect("nobody panicked").push(state);
    }

    fn tile(&self, [x, y]: [u32; 2], part: &Film) {
        let mut film = self.film.lock().expect("nobody panicked");
        assert_eq!(film.encoding, part.encoding);
        let width = film.width;
        for (row, y) in part.pixels.chunks_exact(part.width as usize).zip(y..) {
            film.pixels[(y * width + x) as usize..][..row.len()].copy_from_slice(row);
        }
    }
}

#[test]
fn pauses_leave_no_trace_and_tiles_make_the_picture() {
    for (aa, crop) in [([1, 1], None), ([0, 2], None), ([0, 1], Some([5, 7, 71, 43]))] {
        // A box leaves the pixels as they are.
        let text = SCENE.replace("filter mitchell", "filter box");
        let scene = compiled(&text, &CompileOptions { aa: Some(aa), ..CompileOptions::default() });
        let options = RenderOptions { crop, threads: Some(2), ..RenderOptions::default() };
        let (whole, _) = render(&scene, &options, &()).expect("nobody cancels");
        let film = Film::new(whole.width, whole.height, whole.encoding);
        let observer = Curious { kept: Mutex::default(), film: Mutex::new(film) };
        let (paused, _) = render(&scene, &options, &observer).expect("nobody cancels");
        assert!(bits(&paused) == bits(&whole), "{aa:?}");
        assert!(bits(&observer.film.into_inner().expect("nobody panicked")) == bits(&whole), "{aa:?}");
        let kept = observer.kept.into_inner().expect("nobody panicked");
        assert!(kept.len() > 5, "{} checkpoints", kept.len());
        for state in kept.iter().step_by(kept.len() / 5) {
            let (film, _) = resume(&scene, &options, state, &()).expect("it fits");
            assert!(bits(&film) == bits(&whole), "{aa:?}");
        }
    }
}

#[test]
fn checkpoints_of_other_renderings_are_refused() {
    let of = |aa: [i32; 2], resolution: [u32; 2]| {
        let options = CompileOptions { aa: Some(aa), resolution: Some(resolution), ..CompileOptions::default() };
        compiled(SCENE, &options)
    };
    let scene = of([0, 1], [40, 40]);
    let observer = Impatient::new(2);
    assert!(render(&scene, &RenderOptions::default(), &observer).is_err());
    let state = observer.kept.into_inner().expect("nobody panicked").expect("the state was handed out");
    let refused = |scene: &CompiledScene, options: RenderOptions| {
        resume(scene, &options, &state, &()).is_err_and(|error| error == ResumeError::Unfit)
    };
    assert!(!refused(&scene, RenderOptions::default()));
    assert!(refused(&scene, RenderOptions { seed: 1, ..RenderOptions::default() }));
    assert!(refused(&scene, RenderOptions { crop: Some([0, 0, 20, 20]), ..RenderOptions::default() }));
    assert!(refused(&of([0, 2], [40, 40]), RenderOptions::default()));
    assert!(refused(&of([1, 1], [40, 40]), RenderOptions::default()));
    assert!(refused(&of([0, 1], [40, 41]), RenderOptions::default()));
}

/// A small generator, so that every run sees the same files.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }
}

#[test]
fn no_file_however_odd_makes_going_on_panic() {
    let mut random = Random(7);
    let mut fitting = 0;
    for aa in [[0, 0], [0, 2]] {
        let options = CompileOptions { aa: Some(aa), resolution: Some([40, 37]), ..CompileOptions::default() };
        let scene = compiled(SCENE, &options);
        for steps in [1, 3, 9] {
            let observer = Impatient::new(steps);
            let _ = render(&scene, &RenderOptions::default(), &observer);
            let Some(state) = observer.kept.into_inner().expect("nobody panicked") else { continue };
            let bytes = state.to_bytes("");
            for _ in 0..60 {
                let mut odd = bytes.clone();
                odd.truncate(odd.len() - 4);
                for _ in 0..=random.below(3) {
                    // The head of the state holds its counts, so it deserves more of the attention.
                    let at =
                        if random.below(2) == 0 { random.below(odd.len().min(200)) } else { random.below(odd.len()) };
                    odd[at] = [0, 1, 0x7f, 0x80, 0xff, random.below(256) as u8][random.below(6)];
                }
                if random.below(8) == 0 {
                    odd.truncate(random.below(odd.len()));
                }
                // Sealed again, so that only what it says can give it away.
                odd.extend(crc32fast::hash(&odd).to_le_bytes());
                match Checkpoint::from_bytes(&odd, "") {
                    Ok(state) => fitting += u32::from(resume(&scene, &RenderOptions::default(), &state, &()).is_ok()),
                    Err(error) => assert!(
                        matches!(error, CheckpointError::Foreign | CheckpointError::Damaged)
                            || matches!(error, CheckpointError::Version(_) | CheckpointError::Origin(_))
                    ),
                }
            }
        }
    }
    assert!(fitting > 20, "only {fitting} odd files got past the checks");
}

//! One picture, whatever computes it: any number of threads and any instruction set give the same file.

mod common;

use common::{SCENE, folder, jaspe, write_scene};
use std::path::Path;

fn render(folder: &Path, threads: &str, simd: &str) -> Vec<u8> {
    let output = jaspe()
        .args(["render", "a.sc", "-o", "x.exr", "--resolution", "97x61", "--threads", threads, "--quiet"])
        .env("JASPE_SIMD", simd)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::read(folder.join("x.exr")).expect("it was written")
}

#[test]
fn threads_and_instructions_leave_no_trace() {
    let here = folder();
    for dialect in ["sunflow", "report"] {
        write_scene(here.path(), "a.sc", &format!("dialect {dialect}\n{SCENE}"));
        let expected = render(here.path(), "1", "scalar");
        for threads in ["1", "2", "3"] {
            for simd in ["scalar", "sse", "avx2", "avx512"] {
                let same = render(here.path(), threads, simd) == expected;
                assert!(same, "{dialect}, {threads} threads, {simd}");
            }
        }
    }
}

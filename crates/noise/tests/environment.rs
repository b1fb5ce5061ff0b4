//! The environment variable that caps the instruction set. It is read once, so each case has a process of its own: this
//! test binary again.

use std::process::Command;

use jaspe_noise::simd::{Level, level, machine_level};

#[test]
fn the_variable_caps_the_level() {
    if std::env::var_os("JASPE_TEST_CHILD").is_some() {
        println!("level={}.", level().name());
        return;
    }
    for (word, cap) in Level::ALL.map(|level| (level.name(), level)).into_iter().chain([("fastest", Level::Avx512)]) {
        let mut child = Command::new(std::env::current_exe().unwrap());
        child.args(["--exact", "the_variable_caps_the_level", "--nocapture"]);
        let output = child.env("JASPE_TEST_CHILD", "1").env("JASPE_SIMD", word).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let expected = format!("level={}.", cap.min(machine_level()).name());
        assert!(text.contains(&expected), "JASPE_SIMD={word}: expected {expected}, found {text}");
    }
}

//! `jaspe noise`: values, points from standard input, and what is wrong with a point.

mod common;

use common::{jaspe, run, run_with_input};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::Stdio;

fn value(arguments: &[&str]) -> String {
    let run = run(&[&["noise"], arguments].concat());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments:?}");
    run.stdout
}

#[test]
fn published_values_are_printed_to_the_last_digit() {
    assert_eq!(value(&["improved", "0.5", "0.25", "0.5"]), "-0.262939453125\n");
    assert_eq!(value(&["improved", "-4.2", "10", "6"]), "0.14208000000000043\n");
    assert_eq!(value(&["improved", "3.14", "42", "7"]), "0.13691995878400012\n");
    assert_eq!(value(&["improved", "-3", "7", "11"]), "0\n");
}

#[test]
fn negative_numbers_may_stand_anywhere_and_in_any_form() {
    let plain = value(&["improved", "-0.5", "-0.25", "-0.001"]);
    assert_eq!(value(&["improved", "-.5", "-2.5e-1", "-1e-3"]), plain);
    assert_eq!(value(&["--seed", "0", "improved", "-0.5", "-0.25", "-0.001", "--octaves", "1"]), plain);
}

#[test]
fn two_coordinates_are_the_slice_at_zero() {
    assert_eq!(value(&["classic", "1.3", "-2.7"]), value(&["classic", "1.3", "-2.7", "0"]));
}

#[test]
fn options_change_the_value() {
    let plain = value(&["improved", "0.3", "0.4", "0.6"]);
    for options in [
        ["--seed", "7"],
        ["--octaves", "3"],
        ["--sum", "turbulence"],
        ["--sum", "fbm"],
        ["--sum", "ridged"],
        ["--sum", "hybrid"],
        ["--octaves", "1.5"],
    ] {
        assert_ne!(value(&[&["improved", "0.3", "0.4", "0.6"], &options[..]].concat()), plain, "{options:?}");
    }
    let here = value(&["lattice", "0.25", "0.5", "0.75", "--period", "4,4,4"]);
    assert_eq!(value(&["lattice", "4.25", "-3.5", "8.75", "--period", "4,4,4"]), here);
}

#[test]
fn footprints_even_out() {
    let turbulence = |more: &[&str]| value(&[&["improved", "0.3", "0.4", "0.6", "--sum", "turbulence"], more].concat());
    let sharp = turbulence(&[]);
    assert_eq!(turbulence(&["--footprint", "0"]), sharp);
    assert_ne!(turbulence(&["--footprint", "0.3"]), sharp);
    // Large footprints see the mean of the absolute value, and no slope.
    let [mean, x, y, z] = turbulence(&["--footprint", "1000", "--gradient"])
        .split_whitespace()
        .map(|number| number.parse::<f64>().expect("a number"))
        .collect::<Vec<_>>()[..]
    else {
        panic!("a value and three slopes")
    };
    assert!((mean - 0.428).abs() < 0.02 && [x, y, z] == [0.0; 3], "{mean} {x} {y} {z}");
    let refused = run(&["noise", "improved", "1", "2", "3", "--footprint", "1", "--warp", "0.5"]);
    assert_eq!(refused.status, 2);
}

#[test]
fn there_are_one_to_four_dimensions() {
    assert_eq!(value(&["improved", "1.3"]), value(&["improved", "1.3", "0", "0"]));
    assert_ne!(value(&["improved", "1.3", "0.2", "0.7", "0.4"]), value(&["improved", "1.3", "0.2", "0.7"]));
    assert_eq!(value(&["white", "1.3", "0.2", "0.7", "0.4", "--gradient"]).split_whitespace().count(), 5);
    // At the middle of a cell of feature points without jitter, F1 is 0 and F2 a whole cell, whatever the metric.
    let middle = |options: &[&str]| value(&[&["cellular", "0.5", "1.5", "-2.5", "--jitter", "0"], options].concat());
    assert_eq!((middle(&[]), middle(&["--feature", "f2"])), ("0\n".to_owned(), "1\n".to_owned()));
    assert_eq!(middle(&["--feature", "f2-f1", "--metric", "manhattan"]), "1\n");
}

#[test]
fn a_warp_of_nothing_changes_nothing() {
    let plain = value(&["simplex", "0.3", "0.4", "0.6"]);
    assert_eq!(value(&["simplex", "0.3", "0.4", "0.6", "--warp", "0"]), plain);
    let once = value(&["simplex", "0.3", "0.4", "0.6", "--warp", "0.5"]);
    assert_ne!(once, plain);
    assert_ne!(value(&["simplex", "0.3", "0.4", "0.6", "--warp", "0.5", "--warp", "0.5"]), once);
}

#[test]
fn gradients_follow_the_value() {
    let line = value(&["improved", "0.5", "0.25", "0.5", "--gradient"]);
    let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    assert_eq!((numbers.len(), numbers[0]), (4, -0.262939453125));
    let moved: f64 = value(&["improved", "0.500001", "0.25", "0.5"]).trim().parse().expect("a number");
    assert!(((moved - numbers[0]) / 1e-6 - numbers[1]).abs() < 1e-4, "{line}");
}

#[test]
fn a_dash_reads_points_line_by_line() {
    let run = run_with_input(&["noise", "improved", "-"], "0.5 0.25 0.5\n\n-4.2, 10, 6\r\n1.5 2.5\n0.5 0.25 0.5");
    let single = value(&["improved", "1.5", "2.5"]);
    assert_eq!(run.stdout, format!("-0.262939453125\n0.14208000000000043\n{single}-0.262939453125\n"));
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
}

#[test]
fn a_bad_line_is_named_after_the_good_ones_are_answered() {
    let run = run_with_input(&["noise", "improved", "-"], "0.5 0.25 0.5\n1 two 3\n");
    assert_eq!((run.status, run.stdout.as_str()), (2, "-0.262939453125\n"));
    assert!(run.stderr.contains("line 2: expected a number, found `two`"), "{}", run.stderr);
    let run = run_with_input(&["noise", "improved", "-"], &"1 ".repeat(1 << 20));
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
}

#[test]
fn each_point_is_answered_before_the_next_is_asked() {
    let mut child = jaspe()
        .args(["noise", "improved", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    let mut answers = BufReader::new(child.stdout.take().expect("it is piped"));
    for _ in 0..3 {
        stdin.write_all(b"0.5 0.25 0.5\n").expect("it reads");
        let mut answer = String::new();
        answers.read_line(&mut answer).expect("it answers");
        assert_eq!(answer, "-0.262939453125\n");
    }
    drop(stdin);
    assert!(child.wait().expect("it ends").success());
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = jaspe()
        .args(["noise", "improved", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let mut stdin = child.stdin.take().expect("it is piped");
    // It stops at the first flush; what it does not read any more is lost, as it should be.
    for _ in 0..100_000 {
        if stdin.write_all(b"0.5 0.25 0.5\n").is_err() {
            break;
        }
    }
    drop(stdin);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn wrong_points_and_names_are_usage_errors() {
    for (arguments, message) in [
        (&["improved", "1", "two", "3"][..], "found `two`"),
        (&["improved", "1", "2", "3", "4", "5"], "unexpected"),
        (&["improved", "1", "2", "3", "--gain", "-1"], "expected a number from 0 to 64"),
        (&["cellular", "1", "2", "3", "--feature", "f3"], "f2-f1"),
        (&["improoved", "1", "2", "3"], "improved"),
        (&["improved", "1", "2", "3", "--octaves", "0"], "--octaves"),
        (&["improved", "1", "2", "3", "--period", "4,x"], "PX,PY,PZ"),
    ] {
        let run = run(&[&["noise"], arguments].concat());
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
    }
}

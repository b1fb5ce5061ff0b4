//! `jaspe compare`.

use std::io::Write as _;
use std::path::PathBuf;

use clap::Args;
use jaspe_edge::file::Output;
use serde_json::json;

use crate::Outcome;
use crate::arguments::OutputFormat;
use crate::failure::Failure;
use crate::measure::{Comparison, Shown, compare, heat};
use crate::report;
use crate::show::{json_text, shortest};

/// Measure how far apart two pictures are.
///
/// Prints the size, the mean and the largest error in steps of 1/255, the PSNR in decibels, and FLIP: how visible the
/// difference is when one flips between the two, from 0 (not at all) to 1. Transparent pictures are laid on black;
/// files of linear light (EXR, HDR) are encoded for display first.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe compare before.png after.png
  jaspe compare expected.png actual.png --max-flip 0.02    exit status 1 if it is more
  jaspe compare a.png b.png -o difference.png              where they differ
  jaspe compare a.png b.exr --format json | jq .psnr_db")]
pub struct Compare {
    /// The first picture: the reference
    #[arg(value_name = "A")]
    a: PathBuf,

    /// The second picture: the one on trial
    #[arg(value_name = "B")]
    b: PathBuf,

    /// Write the FLIP error of every pixel as a picture, from black (none) to pale yellow
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Exit with status 1 when the mean FLIP error is larger than this
    #[arg(long, value_name = "T", value_parser = threshold)]
    max_flip: Option<f64>,

    /// How to print the result
    #[arg(long, value_enum, default_value_t = OutputFormat::Text)]
    format: OutputFormat,
}

fn threshold(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

impl Compare {
    /// Compares, prints, and says whether the pictures are too different.
    pub fn run(self) -> Result<Outcome, Failure> {
        let output = self.output.as_deref().map(|path| Output::new(path, None)).transpose()?;
        let (a, b) = (Shown::read(&self.a)?, Shown::read(&self.b)?);
        if (a.width, a.height) != (b.width, b.height) {
            return self.sizes_differ(&a, &b);
        }
        let (comparison, errors) = compare(&a, &b);
        let text = match self.format {
            OutputFormat::Text => text(&comparison),
            OutputFormat::Json => json_text(&comparison) + "\n",
        };
        std::io::stdout().write_all(text.as_bytes())?;
        if let Some(output) = output {
            output.write(&heat(&errors, a.width, a.height))?;
        }
        match self.max_flip {
            Some(limit) if comparison.flip > limit => {
                let found = shortest(comparison.flip);
                report::print_failure(&format!("FLIP is {found}, more than {}", shortest(limit)), &[]);
                Ok(Outcome::Found)
            }
            _ => Ok(Outcome::Done),
        }
    }

    fn sizes_differ(&self, a: &Shown, b: &Shown) -> Result<Outcome, Failure> {
        if self.format == OutputFormat::Json {
            let size = |shown: &Shown| json!({ "width": shown.width, "height": shown.height });
            writeln!(std::io::stdout(), "{:#}", json!({ "a": size(a), "b": size(b) }))?;
        }
        let (size_a, size_b) = (format!("{}x{}", a.width, a.height), format!("{}x{}", b.width, b.height));
        let (path_a, path_b) = (self.a.display(), self.b.display());
        report::print_failure(&format!("sizes differ: `{path_a}` is {size_a}, `{path_b}` is {size_b}"), &[]);
        Ok(Outcome::Found)
    }
}

fn text(comparison: &Comparison) -> String {
    let Comparison { width, height, pixels_past_one_step: past, .. } = comparison;
    let share = 100.0 * *past as f64 / (f64::from(*width) * f64::from(*height));
    let psnr = comparison.psnr_db.map_or("infinite, the pictures are equal".to_owned(), |psnr| format!("{psnr:.2} dB"));
    format!(
        "size           {width}x{height}\n\
         mean error     {} of 255\n\
         largest error  {} of 255; {past} pixels ({share:.2} %) are off by more than 1\n\
         PSNR           {psnr}\n\
         FLIP           {}\n",
        shortest(comparison.mean_error),
        shortest(comparison.max_error),
        shortest(comparison.flip),
    )
}

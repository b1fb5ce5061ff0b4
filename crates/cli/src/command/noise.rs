//! `jaspe noise`.

use std::io::{self, BufRead, BufReader, BufWriter, Read as _, Write};

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use jaspe_noise::{Basis, Combine, Noise as Lattice, Sum};

use crate::Outcome;
use crate::arguments::period;
use crate::failure::Failure;
use crate::show::shortest;

/// Print the value of a noise at a point, in double precision.
///
/// Two coordinates are the slice z = 0 of three. `-` in place of the point reads points from standard input, one per
/// line, and prints one line for each.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe noise improved 0.5 0.25 0.5                 prints -0.262939453125
  jaspe noise improved -4.2 10 6                    prints 0.14208000000000043
  jaspe noise classic 1.5 2.5 --seed 7
  jaspe noise improved 1.5 2.5 3.5 --sum turbulence --octaves 9
  jaspe noise lattice 0.3 0.3 0.3 --period 4,4,4 --gradient
  seq 0 0.1 10 | awk '{ print $1, 0, 0 }' | jaspe noise improved -")]
pub struct Noise {
    /// The noise
    #[arg(value_name = "BASIS", value_parser = PossibleValuesParser::new(Basis::ALL.iter().map(|basis| basis.name())))]
    basis: String,

    /// The point, or `-` to read points from standard input
    #[arg(value_name = "X Y [Z]", required = true, num_args = 1..=3, allow_negative_numbers = true)]
    point: Vec<String>,

    /// Add up octaves of doubling frequency and halving amplitude
    #[arg(long, value_enum, value_name = "SUM")]
    sum: Option<SumName>,

    /// How many octaves are added up [default: 9 with --sum]; without --sum, they are added as fbm
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    octaves: Option<u32>,

    /// Another seed gives another noise; 0 is the published table
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// Repeat after so many cells along x, y and z; 0 leaves an axis at the table's 256
    #[arg(long, value_name = "PX,PY,PZ", value_parser = period)]
    period: Option<[u32; 3]>,

    /// Print the exact derivatives along the axes after the value
    #[arg(long)]
    gradient: bool,
}

/// Ways to add octaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SumName {
    /// The noise itself: fractional Brownian motion
    #[value(alias = "plain")]
    Fbm,
    /// Its absolute value
    #[value(alias = "absolute")]
    Turbulence,
}

/// Octaves when there is a sum and nothing else is said: the default depth of the materials.
const DEFAULT_OCTAVES: u32 = 9;

/// Longer lines hold no point.
const LONGEST_LINE: u64 = 4096;

impl Noise {
    /// Prints the value, or the values.
    pub fn run(self) -> Result<Outcome, Failure> {
        let sum = self.evaluation()?;
        let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
        if self.point == ["-"] {
            self.stream(&sum, io::stdin().lock(), &mut out)?;
        } else {
            let line = self.line(&sum, self.point.iter().map(String::as_str)).map_err(|message| {
                Failure::new(message).hint("give X Y Z or X Y, or `-` to read points from standard input")
            })?;
            writeln!(out, "{line}")?;
        }
        out.flush()?;
        Ok(Outcome::Done)
    }

    /// A plain noise is a sum of one octave.
    fn evaluation(&self) -> Result<Sum, Failure> {
        let basis = Basis::from_name(&self.basis).expect("the parser accepts the names of bases only");
        let mut noise = Lattice::new(basis, self.seed);
        if let Some(period) = self.period {
            noise = noise.with_period(period).map_err(|error| Failure::new(format!("--period: {error}")))?;
        }
        let octaves = match (self.octaves, self.sum) {
            (Some(octaves), _) => octaves,
            (None, Some(_)) => DEFAULT_OCTAVES,
            (None, None) => 1,
        };
        let combine = match self.sum {
            Some(SumName::Turbulence) => Combine::Absolute,
            Some(SumName::Fbm) | None => Combine::Plain,
        };
        Ok(Sum::new(noise, combine, octaves))
    }

    fn stream(&self, sum: &Sum, input: impl io::Read, out: &mut impl Write) -> Result<(), Failure> {
        let mut input = BufReader::with_capacity(1 << 16, input);
        let mut line = Vec::new();
        for number in 1_u64.. {
            line.clear();
            let read = input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line);
            let read = read.map_err(|error| Failure::new(format!("cannot read standard input: {error}")))?;
            if read == 0 {
                break;
            }
            let text = String::from_utf8_lossy(&line);
            let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
            if words.clone().next().is_none() {
                continue;
            }
            let values = self.line(sum, words).map_err(|message| Failure::new(format!("line {number}: {message}")));
            let values = values.inspect_err(|_| _ = out.flush())?;
            writeln!(out, "{values}")?;
            // Whoever waits for each answer before asking again shall get it.
            if !input.buffer().contains(&b'\n') {
                out.flush()?;
            }
        }
        Ok(())
    }

    /// What is printed for a point.
    fn line<'a>(&self, sum: &Sum, words: impl Iterator<Item = &'a str>) -> Result<String, String> {
        let number = |word: &str| word.parse::<f64>().map_err(|_| format!("expected a number, found `{word}`"));
        let point: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
        match point[..] {
            [x, y] => Ok(self.print(sum, [x, y])),
            [x, y, z] => Ok(self.print(sum, [x, y, z])),
            _ => Err(format!("expected two or three coordinates, found {}", point.len())),
        }
    }

    fn print<const D: usize>(&self, sum: &Sum, point: [f64; D]) -> String {
        if self.gradient {
            let (value, gradient) = sum.value_and_gradient(point);
            let numbers = std::iter::once(value).chain(gradient);
            numbers.map(shortest).collect::<Vec<_>>().join(" ")
        } else {
            shortest(sum.value(point))
        }
    }
}

//! `jaspe noise`.

use std::io::{self, BufRead, BufReader, BufWriter, Read as _, Write};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use jaspe_noise::{Basis, Cellular, Combine, Feature, Field, Metric, Recipe, Sum};

use crate::Outcome;
use crate::arguments::period;
use crate::failure::Failure;
use crate::show::shortest;

/// Print the value of a noise at a point, in double precision.
///
/// One and two coordinates are slices of three at zero; four have noises of their own. `-` in place of the point reads points from standard input, one per
/// line, and prints one line for each.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe noise improved 0.5 0.25 0.5                 prints -0.262939453125
  jaspe noise improved -4.2 10 6                    prints 0.14208000000000043
  jaspe noise classic 1.5 2.5 --seed 7
  jaspe noise improved 1.5 2.5 3.5 --sum turbulence --octaves 9
  jaspe noise lattice 0.3 0.3 0.3 --period 4,4,4 --gradient
  jaspe noise cellular 0.3 0.7 1.9 --feature f2-f1 --metric manhattan --jitter 0.8
  jaspe noise simplex 0.3 0.7 1.9 0.2 --sum ridged --octaves 4.5 --lacunarity 2.1
  jaspe noise value 0.3 0.7 1.9 --warp 0.5 --warp 0.3
  jaspe noise improved 1.5 2.5 3.5 --sum turbulence --footprint 0.25
  seq 0 0.1 10 | awk '{ print $1, 0, 0 }' | jaspe noise improved -")]
pub struct Noise {
    /// The noise
    #[arg(value_name = "BASIS", value_parser = bases())]
    basis: Basis,

    /// The point, or `-` to read points from standard input
    #[arg(value_name = "X [Y [Z [W]]]", required = true, num_args = 1..=4, allow_negative_numbers = true)]
    point: Vec<String>,

    /// Add up octaves of rising frequency and falling amplitude
    #[arg(long, value_name = "SUM", value_parser = sums())]
    sum: Option<Combine>,

    /// How many octaves are added up [default: 9 with --sum]; without --sum, they are added as fbm. The last one fades in
    /// with the part past the point
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    octaves: Option<f64>,

    /// The ratio between the frequencies of neighbouring octaves
    #[arg(long, value_name = "L", default_value_t = 2.0)]
    lacunarity: f64,

    /// The ratio between the amplitudes of neighbouring octaves
    #[arg(long, value_name = "G", default_value_t = 0.5)]
    gain: f64,

    /// Another seed gives another noise; 0 is the published table
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// What cellular noise tells of its feature points
    #[arg(long, value_name = "FEATURE", default_value = "f1", value_parser = features())]
    feature: Feature,

    /// How cellular noise measures distances
    #[arg(long, value_name = "METRIC", default_value = "euclidean", value_parser = metrics())]
    metric: Metric,

    /// How far the feature points of cellular noise stray from the middles of their cells
    #[arg(long, value_name = "J", default_value_t = 1.0)]
    jitter: f64,

    /// Displace the point so far by the same field first; again for each time this is given
    #[arg(long, value_name = "AMOUNT", allow_negative_numbers = true)]
    warp: Vec<f64>,

    /// Repeat after so many cells along x, y and z; 0 leaves an axis at the table's 256
    #[arg(long, value_name = "PX,PY,PZ", value_parser = period)]
    period: Option<[u32; 3]>,

    /// Print the average over a square or cube with this side around the point, as filtered sums approximate it: what a
    /// sample of a picture sees
    #[arg(long, value_name = "SIDE", value_parser = side, allow_negative_numbers = true, conflicts_with = "warp")]
    footprint: Option<f64>,

    /// Print the exact derivatives along the axes after the value
    #[arg(long)]
    gradient: bool,
}

/// Ways to add octaves.
fn sums() -> impl TypedValueParser<Value = Combine> {
    let declarations = Combine::ALL.iter().map(|sum| sum.declaration());
    let words = declarations.map(|sum| PossibleValue::new(sum.term).alias(sum.name).help(sum.sentence));
    PossibleValuesParser::new(words).map(|name| Combine::from_name(&name).expect("the parser accepts sums only"))
}

/// What cellular noise tells.
fn features() -> impl TypedValueParser<Value = Feature> {
    let words = Feature::ALL.iter().map(|feature| {
        PossibleValue::new(feature.name()).help(match feature {
            Feature::First => "The distance to the nearest feature point",
            Feature::Second => "The distance to the second nearest one",
            Feature::Difference => "The difference of both",
            Feature::Cell => "A random number of the nearest one",
        })
    });
    PossibleValuesParser::new(words).map(|name| Feature::from_name(&name).expect("the parser accepts features only"))
}

/// How cellular noise measures.
fn metrics() -> impl TypedValueParser<Value = Metric> {
    let words = Metric::ALL.iter().map(|metric| {
        PossibleValue::new(metric.name()).help(match metric {
            Metric::Euclidean => "As the crow flies",
            Metric::Manhattan => "The sum of the distances along the axes",
            Metric::Chebyshev => "The largest of them",
        })
    });
    PossibleValuesParser::new(words).map(|name| Metric::from_name(&name).expect("the parser accepts metrics only"))
}

/// The noises.
fn bases() -> impl TypedValueParser<Value = Basis> {
    let declarations = Basis::ALL.iter().map(|basis| basis.declaration());
    let words = declarations.map(|basis| {
        let word = PossibleValue::new(basis.name);
        if basis.term == basis.name { word } else { word.alias(basis.term) }
    });
    PossibleValuesParser::new(words).map(|name| Basis::from_name(&name).expect("the parser accepts bases only"))
}

fn side(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(side) if (0.0..f64::INFINITY).contains(&side) => Ok(side),
        _ => Err("expected a number from 0 on".to_owned()),
    }
}

/// Longer lines hold no point.
const LONGEST_LINE: u64 = 4096;

impl Noise {
    /// Prints the value, or the values.
    pub fn run(self) -> Result<Outcome, Failure> {
        let evaluation = match (self.field()?, self.footprint) {
            (Field::Noise(noise), Some(footprint)) => Evaluation::Filtered(noise.into(), footprint),
            (Field::Sum(sum), Some(footprint)) => Evaluation::Filtered(sum, footprint),
            (field, _) => Evaluation::Field(field),
        };
        let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
        if self.point == ["-"] {
            self.stream(&evaluation, io::stdin().lock(), &mut out)?;
        } else {
            let line = self.line(&evaluation, self.point.iter().map(String::as_str)).map_err(|message| {
                Failure::new(message).hint("give one to four coordinates, or `-` to read points from standard input")
            })?;
            writeln!(out, "{line}")?;
        }
        out.flush()?;
        Ok(Outcome::Done)
    }

    fn field(&self) -> Result<Field, Failure> {
        let [x, y, z] = self.period.unwrap_or_default();
        let recipe = Recipe {
            basis: self.basis,
            seed: self.seed,
            period: [x, y, z, 0],
            cellular: Cellular { metric: self.metric, feature: self.feature, jitter: self.jitter },
            sum: self.sum,
            octaves: self.octaves,
            lacunarity: self.lacunarity,
            gain: self.gain,
            warp: self.warp.clone(),
        };
        recipe.field().map_err(|error| Failure::new(format!("--{error}")))
    }

    fn stream(&self, evaluation: &Evaluation, input: impl io::Read, out: &mut impl Write) -> Result<(), Failure> {
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
            let values =
                self.line(evaluation, words).map_err(|message| Failure::new(format!("line {number}: {message}")));
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
    fn line<'a>(&self, evaluation: &Evaluation, words: impl Iterator<Item = &'a str>) -> Result<String, String> {
        let number = |word: &str| word.parse::<f64>().map_err(|_| format!("expected a number, found `{word}`"));
        let point: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
        match point[..] {
            [x] => Ok(self.print(evaluation, [x])),
            [x, y] => Ok(self.print(evaluation, [x, y])),
            [x, y, z] => Ok(self.print(evaluation, [x, y, z])),
            [x, y, z, w] => Ok(self.print(evaluation, [x, y, z, w])),
            _ => Err(format!("expected one to four coordinates, found {}", point.len())),
        }
    }

    fn print<const D: usize>(&self, evaluation: &Evaluation, point: [f64; D]) -> String {
        let (value, gradient) = match (evaluation, self.gradient) {
            (Evaluation::Field(field), true) => field.value_and_gradient(point),
            (Evaluation::Field(field), false) => return shortest(field.value(point)),
            (Evaluation::Filtered(sum, footprint), true) => sum.value_and_gradient_filtered(point, *footprint),
            (Evaluation::Filtered(sum, footprint), false) => return shortest(sum.value_filtered(point, *footprint)),
        };
        std::iter::once(value).chain(gradient).map(shortest).collect::<Vec<_>>().join(" ")
    }
}

/// What is evaluated.
enum Evaluation {
    Field(Field),
    /// A sum seen through footprints of this side.
    Filtered(Sum, f64),
}

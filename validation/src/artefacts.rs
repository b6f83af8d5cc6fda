//! What an experiment that did not pass leaves on disk.
//!
//! | file | |
//! | --- | --- |
//! | `outcome.json` | everything it found, with seed and the command that repeats it |
//! | `contrasts.csv` | expectation, mean, standard error, z, interval, p of each contrast |
//! | `z-map.csv` | deviation of every bin of every pixel in standard errors |
//! | `z-map.png` | the same: a row for each pixel, a column for each bin; red above, blue below, full colour at 6 standard errors, grey where nothing varies |
//! | `bins.svg` | the sum over pixels, bin by bin, with 99 % bars, and its expectation |

use std::fs;
use std::path::PathBuf;

use serde::Serialize;
use tpb_plot::{Axis, Chart, Mark, Series};

use crate::error::{Result, ValidationError};
use crate::experiment::{BinPlot, Context, Outcome, ZMap};
use crate::statistics::Contrast;
use crate::suite::Record;

/// Deviation that has full colour.
const FULL_COLOUR: f64 = 6.0;
/// Standard errors on either side of a 99 % interval.
const BAR: f64 = 2.576;

/// Writes the tables and pictures of an experiment into a folder of its own below the output's.
pub(crate) fn leave(record: &Record, context: &Context) -> Result<Vec<PathBuf>> {
    let Some(outcome) = &record.outcome else { return Ok(Vec::new()) };
    let folder = context.out.join(record.name.replace('/', "-"));
    fs::create_dir_all(&folder).map_err(|error| ValidationError::io(&folder, error))?;
    let mut files = Vec::new();
    let mut write = |name: &str, bytes: Vec<u8>| -> Result<()> {
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(|error| ValidationError::io(&path, error))?;
        files.push(path);
        Ok(())
    };
    write("outcome.json", json(record, outcome, context)?)?;
    if !outcome.contrasts.is_empty() {
        write("contrasts.csv", contrasts(&outcome.contrasts).into_bytes())?;
    }
    if let Some(map) = &outcome.z_map {
        write("z-map.csv", z_map(map).into_bytes())?;
        write("z-map.png", z_picture(map)?)?;
    }
    if let Some(bins) = &outcome.bins {
        write("bins.svg", bin_plot(&record.name, bins)?.into_bytes())?;
    }
    Ok(files)
}

/// Writes a chart of an experiment into its folder.
pub(crate) fn leave_chart(context: &Context, name: &str, file: &str, chart: &Chart) -> Result<()> {
    let svg = chart.svg((900, 520)).map_err(|e| ValidationError::unusable("chart", e))?;
    let folder = context.out.join(name.replace('/', "-"));
    fs::create_dir_all(&folder).map_err(|error| ValidationError::io(&folder, error))?;
    let path = folder.join(file);
    fs::write(&path, svg).map_err(|error| ValidationError::io(&path, error))
}

fn json(record: &Record, outcome: &Outcome, context: &Context) -> Result<Vec<u8>> {
    #[derive(Serialize)]
    struct Left<'a> {
        name: &'a str,
        description: &'a str,
        repeat: &'a str,
        seed: u64,
        level: f64,
        outcome: &'a Outcome,
    }
    let left = Left {
        name: &record.name,
        description: &record.description,
        repeat: &record.repeat,
        seed: context.seed,
        level: context.level,
        outcome,
    };
    let text = serde_json::to_string_pretty(&left)
        .map_err(|error| ValidationError::unusable("outcome", error))?;
    Ok((text + "\n").into_bytes())
}

fn contrasts(contrasts: &[Contrast]) -> String {
    let header = "contrast,expected,expected_error,mean,standard_error,contributions,z,low,high,p,adjusted_p\n";
    let row = |c: &Contrast| {
        format!(
            "\"{}\",{:e},{:e},{:e},{:e},{},{:.3},{:e},{:e},{:e},{:e}\n",
            c.name,
            c.expected,
            c.expected_error,
            c.mean,
            c.standard_error,
            c.contributions.map_or(String::new(), |count| format!("{count:.0}")),
            c.z,
            c.interval[0],
            c.interval[1],
            c.p,
            c.adjusted_p
        )
    };
    contrasts.iter().fold(header.to_owned(), |text, c| text + &row(c))
}

fn z_map(map: &ZMap) -> String {
    let bins = map.rows.first().map_or(0, Vec::len);
    let header = (0..bins).fold("column,row".to_owned(), |text, bin| text + &format!(",bin {bin}"));
    let row = |(pixel, row): (usize, &Vec<f64>)| {
        let place = format!("\n{},{}", pixel % map.width, pixel / map.width);
        row.iter().fold(place, |text, z| text + &format!(",{z:.2}"))
    };
    map.rows.iter().enumerate().map(row).fold(header, |text, row| text + &row) + "\n"
}

fn z_picture(map: &ZMap) -> Result<Vec<u8>> {
    let failed = |reason: String| ValidationError::unusable("z map", reason);
    let side = |length: usize| u32::try_from(length).map_err(|error| failed(error.to_string()));
    let bins = map.rows.first().map_or(0, Vec::len);
    let pixels: Vec<u8> = map.rows.iter().flatten().flat_map(|&z| colour(z)).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side(bins)?, side(map.rows.len())?);
    encoder.set_color(png::ColorType::Rgb);
    encoder
        .write_header()
        .and_then(|mut writer| {
            writer.write_image_data(&pixels)?;
            writer.finish()
        })
        .map_err(|error| failed(error.to_string()))?;
    Ok(bytes)
}

/// White at 0, red above, blue below; grey where there is no noise.
fn colour(z: f64) -> [u8; 3] {
    if z.is_nan() {
        return [160; 3];
    }
    let share = (z / FULL_COLOUR).clamp(-1.0, 1.0);
    let rest = (255.0 * (1.0 - share.abs())) as u8;
    if share > 0.0 { [255, rest, rest] } else { [rest, rest, 255] }
}

fn bin_plot(name: &str, bins: &BinPlot) -> Result<String> {
    let line = |values: &[f64]| bins.opl.iter().copied().zip(values.iter().copied()).collect();
    let bar = |(mean, error): (&f64, &f64)| (mean - BAR * error, mean + BAR * error);
    let band = bins.mean.iter().zip(&bins.standard_error).map(bar).collect();
    let chart = Chart {
        title: name.into(),
        x: Axis::linear("optical path length [m]"),
        y: Axis::linear("sum over pixels of a bin [W m⁻² sr⁻¹]"),
        series: vec![
            Series::new("expected", Mark::Line, line(&bins.expected)),
            Series::new("measured", Mark::Points, line(&bins.mean)).with_band(band),
        ],
    };
    chart.svg((900, 520)).map_err(|error| ValidationError::unusable("bin plot", error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::{Effort, Verdict};
    use crate::statistics::{Batches, Criterion, Target, judge};

    #[test]
    fn all_files_are_left_and_pictures_are_pictures() {
        let out = std::env::temp_dir().join(format!("tpb-artefacts-{}", std::process::id()));
        let context = Context::new(Effort::Quick, 7, out.clone());
        let mut batches = Batches::new();
        for i in 0..32 {
            batches.push(vec![1.0 + 1e-3 * f64::from(i)]);
        }
        let target = Target { name: "all".into(), expected: 1.0, error: 0.0 };
        let criterion = Criterion { margin: 0.005, confidence: 0.99, level: 1e-8 };
        let mut outcome: Outcome = judge(&[target], &batches, &criterion).into();
        outcome.z_map = Some(ZMap { width: 2, rows: vec![vec![0.0, 9.0], vec![-3.0, f64::NAN]] });
        let ones = vec![1.0, 1.0];
        outcome.bins = Some(BinPlot {
            opl: vec![0.5, 1.5],
            expected: ones.clone(),
            mean: ones.clone(),
            standard_error: ones,
        });
        let record = Record {
            name: "a/b".into(),
            description: "test".into(),
            verdict: Verdict::Failed,
            seconds: 1.0,
            outcome: Some(outcome),
            error: None,
            repeat: "again".into(),
            files: vec![],
        };
        let files = leave(&record, &context).unwrap();
        let read = |index: usize| fs::read(&files[index]).unwrap();
        let text = |index: usize| String::from_utf8(read(index)).unwrap();
        assert_eq!(files.len(), 5);
        assert!(text(0).contains("\"seed\": 7") && text(0).contains("again"));
        assert!(text(1).lines().count() == 2 && text(1).contains("\"all\",1e0"));
        assert!(text(2).ends_with("1,0,-3.00,NaN\n"));
        let decoder = png::Decoder::new(std::io::Cursor::new(read(3)));
        assert_eq!(decoder.read_info().unwrap().info().size(), (2, 2));
        assert!(text(4).contains("<svg"));
        fs::remove_dir_all(&out).unwrap();
    }

    #[test]
    fn colours_saturate() {
        assert_eq!(colour(0.0), [255, 255, 255]);
        assert_eq!(colour(7.0), [255, 0, 0]);
        assert_eq!(colour(-7.0), [0, 0, 255]);
    }
}

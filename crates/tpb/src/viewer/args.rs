//! The command lines of `tpb view` and `tpb compare`.

use std::path::PathBuf;

use clap::Args;

/// `tpb view`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tpb view beams --open
  tpb view cube.npy -o cube.html
  tpb view beams path light            methods flipped in place; none judges the others

The page is one file and asks the network for nothing. Several results need equal shapes, pulses and
zeros of time; for error numbers against one of them, see `tpb compare`. Cubes that do not fit --budget are reduced by
means over pixels and sums over bins; the page says so.
Exit codes: 0 done; 1 done, but some cells are negative or not finite; 2 bad usage or files.")]
pub(crate) struct ViewArgs {
    /// Result folders, or cubes of any program (.npz, .npy); several are shown in one place
    #[arg(required = true, value_name = "RESULT")]
    pub(crate) results: Vec<PathBuf>,

    /// Names, in the order of the results [default: those of the files]
    #[arg(long = "label", value_name = "TEXT")]
    pub(crate) labels: Vec<String>,

    /// A remark for the page; may be given again
    #[arg(long = "note", value_name = "TEXT")]
    pub(crate) notes: Vec<String>,

    /// Title of the page [default: the scene, or the files]
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,

    #[command(flatten)]
    pub(crate) page: PageArgs,
}

/// `tpb compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  tpb compare path beams --open
  tpb compare beams other.npy --reference long --label beams --label other --label truth
  tpb compare path beams --reference long --json --no-page
  tpb compare path beams --reference long --mask fog.npy

Inputs are result folders, or cubes of other programs: .npz or .npy of (rows, columns, bins) or
(rows, columns, bins, channels). A cube without a time axis takes that of the others. All shapes,
pulses and zeros of time must agree. Where one knows no light outside its window, steady images are
of the window alone.

With sums over n cells, d = x - r, and e = 1 % of the mean of |r| over the reference's lit cells:
RMSE sqrt(sum d2/n); NMSE sum d2/sum r2; noise: what of NMSE the variances account for (render with
--variance), bias2: the rest; relMSE mean of d2/(r2 + e2); MAPE mean of |d|/(|r| + e); SMAPE mean of
2|d|/(|x| + |r| + e); bias sum d/sum r, with the half width of its 95 % interval (Student's t, by
the number of passes) if cells err independently, and in brackets its widest.

A render and its reference need different seeds: with the same method and seed they share passes.

Exit codes: 0 done; 1 done, but some cells are negative or not finite; 2 bad usage or files.")]
pub(crate) struct CompareArgs {
    /// A result folder or a cube; what the other is judged by, without --reference
    pub(crate) a: PathBuf,

    /// Another one
    pub(crate) b: PathBuf,

    /// What both are judged by
    #[arg(long, value_name = "RESULT")]
    pub(crate) reference: Option<PathBuf>,

    /// Also judge those pixels alone where this array of (rows, columns), .npy or .npz, is not 0: such
    /// as those that see no lamp, which else may outweigh all others
    #[arg(long, value_name = "FILE")]
    pub(crate) mask: Option<PathBuf>,

    /// Names, in the order A, B, reference [default: those of the files]
    #[arg(long = "label", value_name = "TEXT")]
    pub(crate) labels: Vec<String>,

    /// Title of the page [default: the scene, or the names]
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,

    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,

    /// Print the numbers only
    #[arg(long, conflicts_with_all = ["output", "open", "title"])]
    pub(crate) no_page: bool,

    #[command(flatten)]
    pub(crate) page: PageArgs,
}

/// The page.
#[derive(Debug, Args)]
pub(crate) struct PageArgs {
    /// The page [default: named after the results, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,

    /// Largest size of the page, in MB (10^6 bytes)
    #[arg(long, value_name = "MB", default_value_t = 20.0, value_parser = megabytes,
        allow_negative_numbers = true)]
    pub(crate) budget: f64,
}

impl PageArgs {
    /// The budget in bytes.
    pub(crate) fn budget_bytes(&self) -> usize {
        (self.budget * 1e6) as usize
    }
}

/// A size that a page may have.
fn megabytes(text: &str) -> Result<f64, String> {
    let size: Option<f64> = text.parse().ok();
    let possible = size.filter(|size| (0.1..=10_000.0).contains(size));
    possible.ok_or_else(|| "expected a number of MB from 0.1 to 10000".to_owned())
}

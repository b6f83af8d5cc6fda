//! How much memory there is, and how much was used.
//!
//! Linux overcommits: a film that is too large would be granted and the process killed once it
//! touches the pages. So the size is compared with what is free *before* the film is made. Other
//! systems say nothing here, and nothing is checked.

use std::fs;

use tpb_film::Layout;

use crate::RenderError;

/// Bytes that could be had now without swapping.
fn available() -> Option<u64> {
    field("/proc/meminfo", "MemAvailable:")
}

/// The most memory that this process ever held \[bytes\]; `None` where the system does not tell.
pub fn peak_memory() -> Option<u64> {
    field("/proc/self/status", "VmHWM:")
}

/// A line `name  123 kB` of one of the kernel's files.
fn field(file: &str, name: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

/// Bytes of a film with `kept` channels of statistics, which become its arrays with `written`
/// channels where they are; saturates.
fn needed(layout: &Layout, variance: bool, kept: usize, written: usize) -> u64 {
    let size = |cells: usize, channels: usize, bytes: u64| {
        let pixels = (layout.width as u64).saturating_mul(layout.height as u64);
        pixels.saturating_mul(cells as u64).saturating_mul(channels as u64).saturating_mul(bytes)
    };
    let arrays = if variance { 2 } else { 1 };
    [
        size(layout.bins(), kept.max(written), 4 * arrays),
        // Which pass reached which 16 cells.
        size(if variance { layout.bins() / 16 } else { 0 }, 1, 4),
        size(4, kept, 8),
        size(3, written, 8),
    ]
    .into_iter()
    .fold(0, u64::saturating_add)
}

/// Refuses a film that would not fit into what is free now.
pub(crate) fn check(
    layout: &Layout,
    variance: bool,
    kept: usize,
    written: usize,
) -> Result<(), RenderError> {
    let needed = needed(layout, variance, kept, written);
    match available() {
        Some(available) if needed > available => {
            let (Layout { width, height, .. }, bins) = (*layout, layout.bins());
            Err(RenderError::Memory { width, height, bins, needed, available })
        }
        _ => Ok(()),
    }
}

/// Bytes for people: `3.2 GiB`.
pub fn amount(bytes: u64) -> String {
    const UNITS: [&str; 7] = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let mut unit = 0;
    let mut value = bytes as f64;
    while value >= 1024.0 {
        value /= 1024.0;
        unit += 1;
    }
    let decimals = usize::from(unit > 0);
    format!("{value:.decimals$} {}", UNITS[unit])
}

#[cfg(test)]
mod tests {
    use tpb_film::TimeAxis;

    use super::*;

    fn layout(side: usize, bins: usize) -> Layout {
        let time = TimeAxis { start_opl: 0.0, bin_width_opl: 0.1, bins };
        Layout { width: side, height: side, time: Some(time) }
    }

    #[test]
    fn a_film_is_its_arrays() {
        let arrays = 64.0 * 64.0 * 1000.0 * 4.0;
        for (variance, kept, written, expected) in
            [(false, 1, 1, 1.0), (false, 1, 3, 3.0), (false, 3, 1, 3.0), (true, 3, 3, 6.0)]
        {
            let film = needed(&layout(64, 1000), variance, kept, written) as f64;
            assert!((film / (expected * arrays) - 1.0).abs() < 0.02, "{film} for {expected}");
        }
        assert_eq!(needed(&layout(usize::MAX, 10), true, 3, 3), u64::MAX);
    }

    #[test]
    fn what_cannot_fit_is_refused_with_its_size() {
        assert!(check(&layout(8, 10), true, 3, 3).is_ok());
        if available().is_some() {
            let error = check(&layout(1 << 20, 1 << 20), false, 1, 1).unwrap_err().to_string();
            assert!(error.contains("1048576") && error.contains("EiB"), "{error}");
        }
        assert_eq!(amount(512), "512 B");
        assert_eq!(amount(3 << 30), "3.0 GiB");
        assert!(amount(u64::MAX).ends_with("EiB"));
    }
}

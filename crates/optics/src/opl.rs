//! Optical path length (OPL) and its only meeting point with seconds.
//!
//! Inside the programs all time is OPL = ∫ η dx = c·t in metres (Marco et al. 2017, eq. 1 and 4).

/// The speed of light in vacuum \[m/s\], exact by the definition of the metre.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Seconds that light takes for an optical path length in metres.
#[inline]
pub fn seconds_from_opl(opl_m: f64) -> f64 {
    opl_m / SPEED_OF_LIGHT
}

/// The optical path length in metres that light covers in a number of seconds.
#[inline]
pub fn opl_from_seconds(time_s: f64) -> f64 {
    time_s * SPEED_OF_LIGHT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metre_takes_3_3_nanoseconds_and_comes_back() {
        assert!((seconds_from_opl(1.0) - 3.335_640_951_981_520_5e-9).abs() < 1e-24);
        let round_trip = opl_from_seconds(seconds_from_opl(0.07));
        assert!((round_trip - 0.07).abs() <= f64::EPSILON * 0.07);
    }
}

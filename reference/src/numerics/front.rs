//! Bins and instants counted from a wavefront.
//!
//! Behind a wavefront at the path length `front`, quantities depend on the offset v t − `front`.
//! One fused multiplication and subtraction rounds it once: the offset keeps all its digits
//! however close to the front it is.

/// v t − front, rounded once.
pub(crate) fn offset(speed: f64, time: f64, front: f64) -> f64 {
    speed.mul_add(time, -front)
}

/// The part of a bin of time that lies behind a wavefront, in path lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BehindFront {
    /// Where it starts, counted from the front; 0 if the front lies in the bin.
    pub(crate) start: f64,
    /// How wide it is.
    pub(crate) width: f64,
}

impl BehindFront {
    /// The part of t0 ≤ t < t1 behind the front, unless it is empty; the edges are finite.
    pub(crate) fn of_bin(speed: f64, t0: f64, t1: f64, front: f64) -> Option<Self> {
        let start = offset(speed, t0, front);
        let part = if start > 0.0 {
            // The difference of two edges close to each other is exact.
            Self { start, width: speed * (t1 - t0) }
        } else {
            Self { start: 0.0, width: offset(speed, t1, front) }
        };
        (part.width > 0.0).then_some(part)
    }

    /// The part before the offset `limit`, unless it is empty.
    pub(crate) fn before(self, limit: f64) -> Option<Self> {
        let width = self.width.min(limit - self.start);
        (width > 0.0).then_some(Self { width, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_keep_their_digits() {
        // 0.1 · 3 exceeds 0.3 by 2.8e-17, which the rounded product turns into 5.6e-17.
        assert!((offset(0.1, 3.0, 0.3) / 2.775_557_561_562_891_4e-17 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_bin_is_cut_at_the_front_and_at_the_limit() {
        let part = |t0, t1| BehindFront::of_bin(2.0, t0, t1, 3.0);
        assert_eq!(part(0.0, 1.5), None);
        assert_eq!(part(2.0, 2.0), None);
        assert_eq!(part(1.0, 2.0), Some(BehindFront { start: 0.0, width: 1.0 }));
        let behind = part(2.0, 4.0).unwrap();
        assert_eq!(behind, BehindFront { start: 1.0, width: 4.0 });
        assert_eq!(behind.before(2.0), Some(BehindFront { start: 1.0, width: 1.0 }));
        assert_eq!(behind.before(1.0), None);
    }
}

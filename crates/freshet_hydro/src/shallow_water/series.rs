//! Numbers that change with time.
use core::f64::consts::TAU;

/// A number as a function of the simulation's time, s.
#[derive(Clone, Debug, PartialEq)]
pub enum Series {
    /// Always the same.
    Constant(f32),
    /// Straight between pairs of time (s, ascending) and value; the first and the last value go on for ever.
    Table(Vec<(f64, f32)>),
    /// `mean + amplitude · cos(2π (time − high_water)/period)`.
    Tide {
        /// Mean value.
        mean: f32,
        /// Half the range.
        amplitude: f32,
        /// Time between two high waters, s, > 0.
        period: f64,
        /// Time of a high water, s.
        high_water: f64,
    },
}

impl From<f32> for Series {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}

impl Series {
    /// The value at `time` (s); 0 for an empty table.
    pub fn at(&self, time: f64) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(pairs) => in_table(pairs, time),
            Self::Tide { mean, amplitude, period, high_water } => {
                let phase = ((time - high_water) / period).rem_euclid(1.0);
                mean + amplitude * libm::cos(TAU * phase) as f32
            }
        }
    }

    /// Whether every value is finite, and times ascend.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Constant(value) => value.is_finite(),
            Self::Table(pairs) => {
                let finite = pairs.iter().all(|(time, value)| time.is_finite() && value.is_finite());
                finite && !pairs.is_empty() && pairs.windows(2).all(|pair| pair[0].0 < pair[1].0)
            }
            Self::Tide { mean, amplitude, period, high_water } => {
                mean.is_finite()
                    && amplitude.is_finite()
                    && high_water.is_finite()
                    && period.is_finite()
                    && *period > 0.0
            }
        }
    }
}

fn in_table(pairs: &[(f64, f32)], time: f64) -> f32 {
    let after = pairs.partition_point(|pair| pair.0 <= time);
    match (after.checked_sub(1).map(|before| pairs[before]), pairs.get(after)) {
        (None, None) => 0.0,
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (Some((start, from)), Some(&(end, to))) => from + (to - from) * ((time - start) / (end - start)) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_straight_between_and_constant_beyond() {
        let series = Series::Table(vec![(10.0, 1.0), (20.0, 3.0)]);
        assert_eq!([0.0, 10.0, 15.0, 20.0, 99.0].map(|time| series.at(time)), [1.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!(Series::Table(Vec::new()).at(5.0), 0.0);
    }

    #[test]
    fn a_tide_is_high_at_high_water() {
        let tide = Series::Tide { mean: 0.2, amplitude: 1.55, period: 44_640.0, high_water: 3600.0 };
        assert_eq!(tide.at(3600.0), 1.75);
        assert!((tide.at(3600.0 + 22_320.0) + 1.35).abs() < 1e-6);
    }

    #[test]
    fn what_is_not_finite_or_runs_backwards_is_invalid() {
        let table = |pairs: &[(f64, f32)]| Series::Table(pairs.to_vec());
        assert!(table(&[(0.0, 1.0), (1.0, 2.0)]).is_valid());
        assert!(!table(&[]).is_valid());
        assert!(!table(&[(1.0, 1.0), (1.0, 2.0)]).is_valid());
        assert!(!table(&[(0.0, f32::NAN)]).is_valid());
        assert!(!Series::from(f32::INFINITY).is_valid());
        assert!(!Series::Tide { mean: 0.0, amplitude: 1.0, period: 0.0, high_water: 0.0 }.is_valid());
    }
}

//! The book of volumes.

/// Volumes since the start, m³: `before + rain + sources − Σ left` is what there should be now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// What there was at the start.
    pub before: f64,
    /// What fell as rain.
    pub rain: f64,
    /// What point sources gave, less what they took.
    pub sources: f64,
    /// What left through the western, eastern, northern and southern side, less what entered there.
    pub left: [f64; 4],
}

impl Balance {
    /// What there should be now, m³.
    pub fn expected(&self) -> f64 {
        self.before + self.rain + self.sources - self.left.iter().sum::<f64>()
    }
}

//! Water that comes from above or below: rain, springs, drains.
use super::Series;
use glam::Vec2;

/// Water that enters or leaves at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct PointSource {
    /// Its centre in local (x, z), m.
    pub at: Vec2,
    /// Radius over which it is spread, m, ≥ 0; at least one cell gets it.
    pub radius: f32,
    /// Volume that enters, m³/s; leaves, if negative, as far as there is any.
    pub rate: Series,
}

/// The cells of a source and the share of each, summing to one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Footprint(pub Vec<(usize, f32)>);

impl Footprint {
    /// Cells within the source's radius, weighted by (1 − r²/R²)², so that its rim is smooth. Nothing if it is outside.
    pub fn new(source: &PointSource, (columns, rows): (usize, usize), cell_size: f32) -> Self {
        let middle = source.at / cell_size + Vec2::new(columns as f32, rows as f32) / 2.0;
        let radius = (source.radius / cell_size).max(0.0);
        let range = |centre: f32, count: usize| {
            let from = (centre - radius - 1.0).floor().max(0.0) as usize;
            from..((centre + radius + 1.0).ceil().max(0.0) as usize).min(count)
        };
        let mut cells = Vec::new();
        for row in range(middle.y, rows) {
            for column in range(middle.x, columns) {
                let offset = Vec2::new(column as f32, row as f32) + 0.5 - middle;
                let share = 1.0 - offset.length_squared() / (radius * radius).max(1e-12);
                if share > 0.0 {
                    cells.push((row * columns + column, f64::from(share * share)));
                }
            }
        }
        let inside = middle.cmpge(Vec2::ZERO).all() && middle.cmplt(Vec2::new(columns as f32, rows as f32)).all();
        if cells.is_empty() && inside {
            cells.push((middle.y as usize * columns + middle.x as usize, 1.0));
        }
        let sum: f64 = cells.iter().map(|cell| cell.1).sum();
        Self(cells.into_iter().map(|(cell, share)| (cell, (share / sum) as f32)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    fn footprint(at: Vec2, radius: f32) -> Footprint {
        Footprint::new(&PointSource { at, radius, rate: 1.0.into() }, (8, 6), 0.5)
    }

    #[test]
    fn shares_sum_to_one_and_the_middle_has_most() {
        let wide = footprint(vec2(0.1, 0.2), 1.2);
        let sum: f32 = wide.0.iter().map(|cell| cell.1).sum();
        assert!((sum - 1.0).abs() < 1e-6 && wide.0.len() > 10);
        let most = wide.0.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|cell| cell.0);
        assert_eq!(most, Some(3 * 8 + 4));
    }

    #[test]
    fn a_narrow_source_has_one_cell_and_one_outside_none() {
        assert_eq!(footprint(vec2(-1.9, -1.4), 0.0).0, [(0, 1.0)]);
        assert!(footprint(vec2(9.0, 0.0), 0.3).0.is_empty());
        let half_inside: f32 = footprint(vec2(2.1, 0.0), 1.0).0.iter().map(|cell| cell.1).sum();
        assert!((half_inside - 1.0).abs() < 1e-6);
    }
}

//! The cells around a cell.

use glam::UVec2;

/// The places in a list row by row of the up to eight cells around the one at `place`, always in the same order.
pub(crate) fn around(place: usize, size: UVec2) -> impl Iterator<Item = usize> {
    let (columns, rows) = (size.x as usize, size.y as usize);
    let (x, y) = (place % columns, place / columns);
    let xs = x.saturating_sub(1)..(x + 2).min(columns);
    (y.saturating_sub(1)..(y + 2).min(rows))
        .flat_map(move |y| xs.clone().map(move |x| y * columns + x))
        .filter(move |other| *other != place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::uvec2;

    #[test]
    fn corners_have_three_neighbours_and_cells_inside_eight() {
        let of = |place| around(place, uvec2(3, 3)).collect::<Vec<_>>();
        assert_eq!(of(0), [1, 3, 4]);
        assert_eq!(of(4), [0, 1, 2, 3, 5, 6, 7, 8]);
        assert_eq!(of(8), [4, 5, 7]);
        assert_eq!(around(0, uvec2(1, 1)).count(), 0);
    }
}

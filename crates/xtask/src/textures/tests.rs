use super::*;

/// The eight-bit values of a committed texture, in rows of four channels.
struct Committed {
    side: usize,
    rgba: Vec<u8>,
}

impl Committed {
    fn read(texture: &Texture) -> Self {
        let picture = image::open(texture.path()).expect(texture.file).into_rgba8();
        assert_eq!(picture.width(), picture.height(), "{} is square", texture.file);
        Self { side: picture.width() as usize, rgba: picture.into_raw() }
    }

    fn value(&self, column: usize, row: usize, channel: usize) -> f64 {
        f64::from(self.rgba[4 * (row * self.side + column) + channel])
    }

    /// Mean difference between a column and the one to its right, which of the last is the first.
    fn step_across(&self, column: usize, channel: usize) -> f64 {
        let right = (column + 1) % self.side;
        self.mean(|row| self.value(column, row, channel) - self.value(right, row, channel))
    }

    /// The same for a row and the one below.
    fn step_down(&self, row: usize, channel: usize) -> f64 {
        let below = (row + 1) % self.side;
        self.mean(|column| self.value(column, row, channel) - self.value(column, below, channel))
    }

    fn mean(&self, difference: impl Fn(usize) -> f64) -> f64 {
        (0..self.side).map(|index| difference(index).abs()).sum::<f64>() / self.side as f64
    }
}

#[test]
fn committed_files_are_what_the_command_paints() {
    for texture in TEXTURES {
        let committed = Committed::read(&texture);
        let painted = (texture.paint)();
        assert_eq!(painted.side, committed.side, "{}", texture.file);
        // Not `assert_eq`, which would print a million numbers.
        let same = painted.to_rgba(texture.step) == committed.rgba;
        assert!(same, "{} is outdated: run `cargo xtask assets` and look at it", texture.file);
    }
}

#[test]
fn tiles_have_no_seams() {
    for texture in TEXTURES.iter().filter(|texture| !is_cut_out(texture)) {
        let committed = Committed::read(texture);
        let last = committed.side - 1;
        for channel in 0..4 {
            // The step over the edge is like the largest of the steps inside, and no larger.
            let inside = |step: &dyn Fn(usize) -> f64| (0..last).map(step).fold(0.0, f64::max);
            let across = |column| committed.step_across(column, channel);
            let down = |row| committed.step_down(row, channel);
            for (edge, inside) in [(across(last), inside(&across)), (down(last), inside(&down))] {
                assert!(edge <= inside, "{} channel {channel}: {edge} over the edge, {inside} inside", texture.file);
            }
        }
    }
}

#[test]
fn cut_outs_keep_clear_of_all_edges_but_the_bottom() {
    for texture in TEXTURES.iter().filter(|texture| is_cut_out(texture)) {
        let committed = Committed::read(texture);
        let last = committed.side - 1;
        for index in 0..committed.side {
            let edges = [(index, 0), (0, index), (last, index)];
            let covered = edges.map(|(column, row)| committed.value(column, row, 3) > 0.0);
            assert_eq!(covered, [false; 3], "{} is cut off at {index}", texture.file);
        }
        assert!((0..=last).any(|column| committed.value(column, last, 3) == 255.0), "{} stands", texture.file);
    }
}

#[test]
fn files_are_small() {
    let size = |texture: &Texture| fs::metadata(texture.path()).expect(texture.file).len();
    assert!(TEXTURES.iter().all(|texture| size(texture) < 700 * 1024));
    assert!(TEXTURES.iter().map(size).sum::<u64>() < 3 * 1024 * 1024);
}

fn is_cut_out(texture: &Texture) -> bool {
    ["leaves.png", "reed.png"].contains(&texture.file)
}

//! Flow maps as this crate writes them, as painters make them, and as they should not be.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use freshet_flood::flow_map::{CELL_SIZE_KEY, Defaults, FlowMap, FlowMapError, LEVEL_KEY, MOST_CELLS, SCALE_KEY};
use freshet_hydro::grid::Grid;
use glam::{Vec2, uvec2, vec2};
use png::{BitDepth, ColorType};
use proptest::prelude::*;

const PAINTED: Defaults = Defaults { scale: Some(2.0), cell_size: Some(0.5) };

/// A picture of one row of pixels, as a painter's program would write it.
fn picture(color: ColorType, depth: BitDepth, width: u32, data: &[u8], text: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette(&[128, 128, 0, 255, 1, 0][..]);
    }
    for (key, text) in text {
        encoder.add_text_chunk(key.to_string(), text.to_string()).unwrap();
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

fn velocities(bytes: &[u8], defaults: Defaults) -> Vec<Vec2> {
    FlowMap::decode(bytes, defaults).unwrap().velocity.into_values()
}

fn message(bytes: &[u8], defaults: Defaults) -> String {
    FlowMap::decode(bytes, defaults).unwrap_err().to_string()
}

#[test]
fn red_flows_east_and_green_flows_south() {
    let east_south_still_least = [255, 128, 0, 128, 255, 0, 128, 128, 0, 0, 1, 0];
    let bytes = picture(ColorType::Rgb, BitDepth::Eight, 4, &east_south_still_least, &[]);
    let map = FlowMap::decode(&bytes, PAINTED).unwrap();
    assert_eq!((map.scale, map.level, map.velocity.cell_size()), (2.0, None, 0.5));
    let expected = [vec2(2.0, 0.0), vec2(0.0, 2.0), Vec2::ZERO, vec2(-2.0, -2.0)];
    assert_eq!(map.velocity.values(), expected);
}

#[test]
fn sixteen_bits_transparency_and_palettes() {
    let data = [0x80, 0, 0x80, 0, 0, 0, 0xff, 0xff, 0, 1, 0, 0];
    let bytes = picture(ColorType::Rgb, BitDepth::Sixteen, 2, &data, &[]);
    assert_eq!(velocities(&bytes, PAINTED), [Vec2::ZERO, vec2(2.0, -2.0)]);

    // Programs blacken what is fully transparent: that must not become a torrent to the north-west.
    let bytes = picture(ColorType::Rgba, BitDepth::Eight, 2, &[0, 0, 0, 0, 255, 128, 0, 9], &[]);
    assert_eq!(velocities(&bytes, PAINTED), [Vec2::ZERO, vec2(2.0, 0.0)]);
    let data = [0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0x80, 0, 0, 0, 0, 1];
    let bytes = picture(ColorType::Rgba, BitDepth::Sixteen, 2, &data, &[]);
    assert_eq!(velocities(&bytes, PAINTED), [Vec2::ZERO, vec2(2.0, 0.0)]);

    let bytes = picture(ColorType::Indexed, BitDepth::One, 2, &[0b0100_0000], &[]);
    assert_eq!(velocities(&bytes, PAINTED), [Vec2::ZERO, vec2(2.0, -2.0)]);
}

#[test]
fn the_file_has_precedence_over_the_defaults() {
    let text = [(SCALE_KEY, "4"), (CELL_SIZE_KEY, "8.5"), (LEVEL_KEY, "-1.25")];
    let bytes = picture(ColorType::Rgb, BitDepth::Eight, 1, &[255, 128, 0], &text);
    for defaults in [PAINTED, Defaults::default()] {
        let map = FlowMap::decode(&bytes, defaults).unwrap();
        assert_eq!((map.scale, map.level), (4.0, Some(-1.25)));
        assert_eq!(map.velocity.cell_size(), 8.5);
    }
}

#[test]
fn errors_name_what_is_wrong() {
    let painted = |text| picture(ColorType::Rgb, BitDepth::Eight, 1, &[255, 128, 0], text);
    let no_scale = Defaults { scale: None, ..PAINTED };
    assert_eq!(
        message(&painted(&[]), no_scale),
        "the flow map's “freshet scale m/s” must be a number above zero, in the file or given with it, not missing"
    );
    let no_cell_size = Defaults { cell_size: None, ..PAINTED };
    assert!(message(&painted(&[]), no_cell_size).contains("cell size m” must be a number above zero"));
    let backwards = Defaults { scale: Some(-1.0), ..PAINTED };
    assert!(message(&painted(&[]), backwards).ends_with("not -1"));
    assert!(message(&painted(&[(SCALE_KEY, "fast")]), PAINTED).ends_with("not “fast”"));
    assert!(message(&painted(&[(LEVEL_KEY, "inf")]), PAINTED).contains("finite number, not “inf”"));

    let grey = picture(ColorType::Grayscale, BitDepth::Eight, 1, &[128], &[]);
    assert!(matches!(FlowMap::decode(&grey, PAINTED), Err(FlowMapError::Grey)));
    assert!(message(b"GIF89a", PAINTED).starts_with("not an intact PNG picture"));
    let torn = painted(&[]);
    assert!(message(&torn[..torn.len() - 20], PAINTED).starts_with("not an intact PNG picture"));
    let wide = vec![0; 3 * (MOST_CELLS as usize + 1)];
    let wide = picture(ColorType::Rgb, BitDepth::Eight, MOST_CELLS + 1, &wide, &[]);
    assert!(message(&wide, PAINTED).starts_with("8193 × 1 cells are too many"));

    let velocity = Grid::new(uvec2(1, 1), 1.0, vec![Vec2::ONE]).unwrap();
    let map = FlowMap { velocity, scale: 0.0, level: None };
    assert!(map.encode().unwrap_err().to_string().contains("“freshet scale m/s”"));
    let map = FlowMap { scale: 1.0, level: Some(f32::NAN), ..map };
    assert!(map.encode().unwrap_err().to_string().contains("“freshet level m”"));
}

#[test]
fn still_water_out_of_range_and_nan_are_stored_sensibly() {
    let velocity = Grid::new(uvec2(3, 1), 1.0, vec![Vec2::ZERO, vec2(9.0, -9.0), vec2(f32::NAN, 0.0)]);
    let map = FlowMap { scale: 1.0, level: None, velocity: velocity.unwrap() };
    let expected = [Vec2::ZERO, vec2(1.0, -1.0), Vec2::ZERO];
    assert_eq!(velocities(&map.encode().unwrap(), Defaults::default()), expected);
    let still = Grid::new(uvec2(1, 1), 1.0, vec![Vec2::ZERO]).unwrap();
    assert_eq!(FlowMap::new(still, None).scale, 1.0);
}

#[test]
fn files_are_named_in_errors() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("flow_map.png");
    let velocity = Grid::new(uvec2(1, 2), 2.0, vec![Vec2::X, Vec2::Y]).unwrap();
    let map = FlowMap::new(velocity, Some(0.8));
    map.write(&path).unwrap();
    assert_eq!(FlowMap::read(&path, Defaults::default()).unwrap(), map);
    std::fs::write(&path, "no picture").unwrap();
    assert!(FlowMap::read(&path, PAINTED).unwrap_err().to_string().contains("flow_map.png: not an"));
    let error = FlowMap::read(folder.join("no_such.png"), PAINTED).unwrap_err();
    assert!(matches!(&error, FlowMapError::Io { .. }) && error.to_string().contains("no_such.png"));
    assert!(map.write(folder.join("no_such_folder/flow.png")).is_err());
}

proptest! {
    #[test]
    fn a_round_trip_errs_by_half_a_step(
        values in prop::collection::vec((-9.0_f32..9.0, -9.0_f32..9.0).prop_map(Vec2::from), 6),
        level in prop::option::of(-10.0_f32..10.0),
    ) {
        let map = FlowMap::new(Grid::new(uvec2(3, 2), 1.5, values).unwrap(), level);
        let again = FlowMap::decode(&map.encode().unwrap(), Defaults::default()).unwrap();
        prop_assert_eq!((again.scale, again.level), (map.scale, level));
        prop_assert_eq!(again.velocity.size(), map.velocity.size());
        for (again, value) in again.velocity.values().iter().zip(map.velocity.values()) {
            prop_assert!((*again - *value).abs().max_element() < map.scale / 60_000.0);
        }
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..200), at in 0_usize..120) {
        let _ = FlowMap::decode(&bytes, PAINTED);
        let mut spoilt = picture(ColorType::Rgb, BitDepth::Eight, 2, &[1, 2, 3, 4, 5, 6], &[(SCALE_KEY, "1")]);
        for (spoilt, noise) in spoilt.iter_mut().skip(at).zip(bytes.iter().take(4)) {
            *spoilt = *noise;
        }
        let _ = FlowMap::decode(&spoilt, PAINTED);
    }
}

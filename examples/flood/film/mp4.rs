//! Films as video: AV1 in MP4 (AV1 Codec ISO Media File Format Binding, 1.3.0).
use super::{
    Clip, Sink,
    av1::{Av1, Packet},
    named,
    whole::Whole,
};
use image::RgbImage;
use shiguredo_mp4::{
    BoxSize, BoxType, TrackKind,
    bitstream::av1::{
        Av1ObuParseContext, Av1ObuType, Av1SampleEntryConfig, build_av01_box_from_config_obus, parse_obus,
    },
    boxes::{SampleEntry, UnknownBox},
    mux::{Mp4FileMuxer, Mp4FileMuxerOptions, Sample, estimate_maximum_moov_box_size},
};
use std::{
    io::{Seek, SeekFrom, Write},
    num::NonZero,
    path::{Path, PathBuf},
};

/// An MP4 that is written frame by frame.
pub struct Mp4 {
    path: PathBuf,
    fps: u32,
    encoder: Av1,
    muxer: Mp4FileMuxer,
    file: Whole,
    /// Where the next frame goes.
    place: u64,
}

impl Mp4 {
    /// # Errors
    /// Why it cannot be written there.
    pub fn create(path: &Path, clip: Clip) -> Result<Self, String> {
        let named = named(path);
        let encoder = Av1::new(clip).map_err(|problem| named(&problem))?;
        // So that its index fits before its frames, and it can be played while it is loaded.
        let options = Mp4FileMuxerOptions {
            reserved_moov_box_size: estimate_maximum_moov_box_size(&[clip.frames]),
            ..Default::default()
        };
        let muxer = Mp4FileMuxer::with_options(options).map_err(|problem| named(&problem))?;
        let mut file = Whole::create(path)?;
        file.write_all(muxer.initial_boxes_bytes()).map_err(|problem| named(&problem))?;
        let place = muxer.initial_boxes_bytes().len() as u64;
        Ok(Self { path: path.into(), fps: clip.fps, encoder, muxer, file, place })
    }

    fn write(&mut self, packet: &Packet) -> Result<(), String> {
        let named = named(&self.path);
        let bytes = without_delimiter(&packet.data).map_err(|problem| named(&problem))?;
        // The first tells what all are.
        let first = self.is_empty().then(|| entry(bytes)).transpose().map_err(|problem| named(&problem))?;
        let sample = Sample {
            track_kind: TrackKind::Video,
            sample_entry: first,
            keyframe: packet.is_key,
            timescale: NonZero::new(self.fps).unwrap_or(NonZero::<u32>::MIN),
            duration: 1,
            composition_time_offset: None,
            data_offset: self.place,
            data_size: bytes.len(),
        };
        self.file.write_all(bytes).map_err(|problem| named(&problem))?;
        self.muxer.append_sample(&sample).map_err(|problem| named(&problem))?;
        self.place += bytes.len() as u64;
        Ok(())
    }

    /// Whether it has no frame yet.
    fn is_empty(&self) -> bool {
        self.place == self.muxer.initial_boxes_bytes().len() as u64
    }
}

impl Sink for Mp4 {
    fn add(&mut self, picture: &RgbImage) -> Result<(), String> {
        let packets = self.encoder.add(picture).map_err(|problem| named(&self.path)(&problem))?;
        packets.iter().try_for_each(|packet| self.write(packet))
    }

    fn finish(mut self: Box<Self>) -> Result<(), String> {
        let packets = self.encoder.finish().map_err(|problem| named(&self.path)(&problem))?;
        packets.iter().try_for_each(|packet| self.write(packet))?;
        let named = named(&self.path);
        let boxes = self.muxer.finalize().map_err(|problem| named(&problem))?;
        for (place, bytes) in boxes.offset_and_bytes_pairs() {
            self.file.seek(SeekFrom::Start(place)).map_err(|problem| named(&problem))?;
            self.file.write_all(bytes).map_err(|problem| named(&problem))?;
        }
        self.file.keep()
    }
}

/// What a player must know before the first frame, from that frame.
fn entry(first: &[u8]) -> shiguredo_mp4::Result<SampleEntry> {
    let parts = parse_obus(first, Av1ObuParseContext::Sample)?;
    let header = parts.iter().find(|part| part.obu_type == Av1ObuType::SequenceHeader);
    let header = header.map_or(&[][..], |part| part.obu);
    let mut entry =
        build_av01_box_from_config_obus(header, &Av1SampleEntryConfig { initial_presentation_delay_minus_one: None })?;
    entry.unknown_boxes.push(color());
    Ok(SampleEntry::Av01(entry))
}

/// `colr`, for players that do not ask the stream: BT.709 primaries, transfer and matrix, limited range (ISO 14496-12, 12.1.5).
fn color() -> UnknownBox {
    let payload = b"nclx\0\x01\0\x01\0\x01\0".to_vec();
    let size = 8 + payload.len() as u32;
    UnknownBox { box_type: BoxType::Normal(*b"colr"), box_size: BoxSize::U32(size), payload }
}

/// A packet as files have it: where it begins, they tell themselves.
fn without_delimiter(packet: &[u8]) -> shiguredo_mp4::Result<&[u8]> {
    let parts = parse_obus(packet, Av1ObuParseContext::Sample)?;
    let delimiter = parts.first().filter(|part| part.obu_type == Av1ObuType::TemporalDelimiter);
    Ok(&packet[delimiter.map_or(0, |part| part.obu.len())..])
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::{UVec2, uvec2};
    use image::Rgb;
    use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};

    /// The bytes of a film of a square that moves.
    fn film(size: UVec2, fps: u32, frames: usize) -> Vec<u8> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film.mp4");
        let mut film = Box::new(Mp4::create(&path, Clip { size, fps, frames }).expect("a film"));
        for frame in 0..frames as u32 {
            let is_square = |x: u32, y: u32| (frame..frame + 8).contains(&x) && (4..12).contains(&y);
            let color = |x, y| Rgb(if is_square(x, y) { [250, 200, 30] } else { [20, 60, (3 * y) as u8] });
            film.add(&RgbImage::from_fn(size.x, size.y, color)).expect("a frame");
        }
        film.finish().expect("its end");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1, "only the film is left");
        std::fs::read(path).expect("the film")
    }

    #[test]
    fn a_film_has_all_frames_at_their_times_and_some_to_go_to() {
        let (fps, frames) = (12, 30);
        let bytes = film(uvec2(65, 33), fps, frames);
        let mut demuxer = Mp4FileDemuxer::new();
        demuxer.handle_input(Input { position: 0, data: &bytes });
        let mut keys = Vec::new();
        for number in 0..frames as u64 {
            let sample = demuxer.next_sample().expect("an index").expect("a frame");
            assert_eq!((sample.timestamp, sample.duration, sample.track.timescale.get()), (number, 1, fps));
            if let Some(SampleEntry::Av01(entry)) = sample.sample_entry {
                assert_eq!((entry.visual.width, entry.visual.height), (65, 33));
                assert_eq!(entry.unknown_boxes, [color()]);
            }
            assert!(sample.data_offset as usize + sample.data_size <= bytes.len());
            keys.extend(sample.keyframe.then_some(number));
        }
        assert!(demuxer.next_sample().expect("an index").is_none());
        // One each 2 s.
        assert_eq!(keys, [0, 24]);
    }

    #[test]
    fn the_same_film_is_the_same_file_with_its_index_in_front() {
        let bytes = film(uvec2(64, 48), 30, 8);
        assert_eq!(bytes, film(uvec2(64, 48), 30, 8));
        let place = |name: &[u8; 4]| bytes.windows(4).position(|four| four == name).expect("a box");
        assert!(place(b"moov") < place(b"mdat"));
    }

    #[test]
    fn what_cannot_be_a_film_is_told() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film.mp4");
        let clip = Clip { size: uvec2(8, 64), fps: 30, frames: 1 };
        let problem = Mp4::create(&path, clip).err().expect("too narrow");
        assert!(problem.contains("film.mp4") && problem.contains("width 8 (expected >= 16"), "{problem}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
    }
}

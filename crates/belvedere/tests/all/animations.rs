//! Animated pictures, read back by the decoder of another crate's author and put together as the specification says.

use belvedere::figures::{Picture, write_apng};
use std::fs::File;
use std::io::BufReader;

/// Every frame as a viewer shows it: each rectangle laid over what was there before.
fn shown(path: &std::path::Path) -> (Vec<Vec<u8>>, Vec<(u16, u16)>) {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let count = reader.info().animation_control().unwrap().num_frames;
    assert_eq!(reader.info().animation_control().unwrap().num_plays, 0);
    let mut canvas = vec![0; width * height * 3];
    let (mut frames, mut delays) = (Vec::new(), Vec::new());
    let mut buffer = vec![0; canvas.len()];
    for _ in 0..count {
        reader.next_frame(&mut buffer).unwrap();
        let control = *reader.info().frame_control().unwrap();
        let [x, y, w, h] = [control.x_offset, control.y_offset, control.width, control.height].map(|v| v as usize);
        for row in 0..h {
            canvas[((y + row) * width + x) * 3..][..w * 3].copy_from_slice(&buffer[row * w * 3..][..w * 3]);
        }
        frames.push(canvas.clone());
        delays.push((control.delay_num, control.delay_den));
    }
    (frames, delays)
}

#[test]
fn frames_come_back_pixel_for_pixel_with_their_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("day.png");
    let mut frames = vec![Picture::filled(31, 17, [10, 20, 30])];
    // a change inside, one in two corners at once, none, and one pixel in the last corner
    for places in [&[[5, 6]][..], &[[0, 0], [30, 16]], &[], &[[30, 16]]] {
        let mut next = frames.last().unwrap().clone();
        for &place in places {
            next.fill_rectangle(place, [3, 2], [200, frames.len() as u8, 7]);
        }
        frames.push(next);
    }
    write_apng(&path, &frames, 0.25).unwrap();
    let (read, delays) = shown(&path);
    assert_eq!(read, frames.iter().map(|frame| frame.rgb.clone()).collect::<Vec<_>>());
    assert!(delays.iter().all(|delay| *delay == (250, 1000)));
}

#[test]
fn one_frame_is_an_animation_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("still.png");
    let frame = Picture::filled(2, 1, [1, 2, 3]);
    write_apng(&path, std::slice::from_ref(&frame), 65.535).unwrap();
    assert_eq!(shown(&path).0, [frame.rgb]);
}

#[test]
fn what_makes_no_animation_is_refused_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("no.png");
    let (a, b) = (Picture::filled(2, 2, [0; 3]), Picture::filled(2, 3, [0; 3]));
    let refused = |frames: &[Picture], seconds: f64| write_apng(&path, frames, seconds).unwrap_err().to_string();
    assert!(refused(&[], 1.0).contains("frames of a film"));
    assert!(refused(&[a.clone(), b], 1.0).contains("2 x 3 pixels after 2 x 2"));
    assert!(refused(&[Picture::filled(0, 2, [0; 3])], 1.0).contains("picture size"));
    assert!(refused(&[Picture { rgb: vec![0; 3], ..a.clone() }], 1.0).contains("picture size"));
    for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY, 65.6] {
        assert!(refused(std::slice::from_ref(&a), seconds).contains("time of a frame"), "{seconds}");
    }
    assert!(!path.exists());
}

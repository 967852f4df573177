//! The functions that a page calls, in the order in which it does.

use sinew_live::exports as live;

/// A text that `length` bytes of the module hold.
fn text(length: u32) -> String {
    // The module's texts live as long as the module.
    #[allow(unsafe_code)]
    let bytes = unsafe { core::slice::from_raw_parts(live::text(), length as usize) };
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn numbers(at: *const f32, count: u32) -> Vec<f32> {
    // As many numbers as the module says, which nothing in this test writes meanwhile.
    #[allow(unsafe_code)]
    let numbers = unsafe { core::slice::from_raw_parts(at, count as usize) };
    numbers.to_vec()
}

/// A disc of skin on a blue wall.
fn show(u: i32, v: i32) {
    let (width, height) = (320, 240);
    // The module's picture has room for 640 x 480 pixels.
    #[allow(unsafe_code)]
    let picture = unsafe { core::slice::from_raw_parts_mut(live::picture(), 4 * 320 * 240) };
    for (i, pixel) in picture.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let (x, y) = (i as i32 % width, i as i32 / width);
        let inside = (x - u).pow(2) + (y - v).pow(2) < 400 && y < height;
        *pixel = if inside { [200, 140, 110, 255] } else { [60, 90, 140, 255] };
    }
}

#[test]
fn a_page_gets_a_hand_and_hears_what_is_refused() {
    assert_eq!(text(live::see()), "no session was begun");
    assert_eq!((live::blob_count(), live::particle_count()), (0, 0));
    let nan = f32::NAN;
    let begin = |width, particles, distance_m| live::begin(width, 240, 0, particles, 1, distance_m, nan, nan);
    assert_eq!(text(begin(1000, 50, 0.9)), "`width` must lie from 1 to 640");
    assert_eq!(text(begin(320, 513, 0.9)), "`particles` must lie from 1 to 512");
    assert_eq!(text(begin(320, 50, 0.0)), "`distance_m` must be greater than zero");
    assert_eq!(begin(320, 50, 0.9), 0);
    for frame in 0..10 {
        show(140 + frame, 150);
        assert_eq!((live::see(), live::track(33_333.0 * f64::from(frame))), (0, 0));
    }
    assert_eq!((live::blob_count(), live::particle_count()), (1, 50));
    let answer = numbers(live::answer(), 16);
    assert_eq!(answer[0], 0.0, "tracking");
    assert!((answer[5] - 149.0).abs() < 8.0 && (answer[6] - 150.0).abs() < 8.0, "{answer:?}");
    let blob = numbers(live::blobs(), 7);
    assert!((blob[0] - 149.0).abs() < 0.5 && (blob[1] - 150.0).abs() < 0.5, "{blob:?}");
    let particles = numbers(live::particles(), 5 * 50);
    let weights: f32 = particles.as_chunks::<5>().0.iter().map(|particle| particle[4]).sum();
    assert!((weights - 1.0).abs() < 1.0e-4, "{weights}");
    // The page may give any number as time.
    assert_eq!((live::see(), live::track(f64::NAN), live::track(-1.0)), (0, 0, 0));
    calibration();
}

fn calibration() {
    assert_eq!(text(live::calibrate(320, 10)), "`u` must lie from 0 to 319");
    assert_eq!(live::calibrate(10, 10), 0, "the wall is taken for skin, as was asked for");
    assert_eq!((live::see(), live::track(1.0e6)), (0, 0));
    let painted = || {
        // As many bytes as pixels times four.
        #[allow(unsafe_code)]
        let pixels = unsafe { core::slice::from_raw_parts(live::skin(), 4 * 320 * 240) };
        pixels.as_chunks::<4>().0.iter().filter(|pixel| pixel[3] > 0).count()
    };
    assert!(painted() > 70_000, "{}", painted());
    assert_eq!((live::forget_calibration(), live::see()), (0, 0));
    assert!((1000..1500).contains(&painted()), "{}", painted());
}

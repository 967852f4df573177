//! Both hands over time, from lines of skin and brightness.

use crate::corners::Corners;
use crate::drive::{Recovery, Subject, drive, holds};
use sinew_core::camera::Pixel;
use sinew_core::saved_state::SavedState;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::objects::hands::{Candidates, HandFinder};
use sinew_core::vision::objects::head::HeadBox;

const SIZE: (usize, usize) = (160, 120);
/// Words of a line of skin.
const WORDS: usize = SIZE.0 / 32;
const FACE: HeadBox = HeadBox { centre_px: [80.0, 30.0], width_px: 16.0 };
/// The left hand of the twin, pixels: half a palm.
const MAX_APART_PX: f32 = 4.0;

struct Hands {
    finders: [HandFinder<80, 60>; 2],
    last: [Option<(Pixel, f32)>; 2],
    frame: usize,
}

impl Hands {
    fn new() -> Self {
        let finder = HandFinder::new(CellGrid::new(SIZE.0, SIZE.1).unwrap());
        Self { finders: [finder.clone(), finder], last: [None; 2], frame: 0 }
    }
}

/// A line in which the left hand moves up and down.
fn line(frame: usize, row: usize) -> ([u32; WORDS], [u8; SIZE.0]) {
    let top = 50 + (frame % 20).abs_diff(10);
    let is_hand = |column| (top..top + 12).contains(&row) && (96..108).contains(&column);
    let mut skin = [0; WORDS];
    (0..SIZE.0).filter(|column| is_hand(*column)).for_each(|column| skin[column / 32] |= 1 << (column % 32));
    (skin, core::array::from_fn(|column| if is_hand(column) { 160 } else { 80 }))
}

impl Subject for Hands {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let [centre_u, centre_v] = FACE.centre_px.map(|at| corners.number(at));
        let face = HeadBox { centre_px: [centre_u, centre_v], width_px: corners.number(FACE.width_px) };
        let finder = &mut self.finders[0];
        finder.add_face(face);
        finder.grid_mut().begin();
        for row in 0..corners.below(2 * SIZE.1) {
            let (skin, levels) = line(corners.below(100), row);
            let skin = skin.map(|word| if corners.one_in(3) { !word } else { word });
            let [words, pixels] = [WORDS, SIZE.0].map(|length| corners.below(length + 1));
            finder.grid_mut().line(row + corners.below(3), &skin[..words], &levels[..pixels], corners.below(4));
        }
        let hands = finder.step().clone();
        let is_sound = hands.iter().flatten().all(|candidate| {
            let numbers = candidate.moments_px2.iter().chain([&candidate.area_px]);
            let place = [candidate.centre.u_px, candidate.centre.v_px];
            (0.0..=1.0).contains(&candidate.likelihood) && numbers.chain(&place).all(|x| x.is_finite())
        });
        holds(is_sound, || format!("{hands:?} by {face:?}"))?;
        holds(finder.is_finite(), || format!("the state by {face:?}"))
    }

    fn clean(&mut self) {
        self.frame += 1;
        let left = |[left, _]: &[Candidates; 2]| left.first().map(|hand| (hand.centre, hand.likelihood));
        self.last = self.finders.each_mut().map(|finder| {
            finder.add_face(FACE);
            finder.grid_mut().begin();
            for row in 0..SIZE.1 {
                let (skin, levels) = line(self.frame, row);
                finder.grid_mut().line(row, &skin, &levels, 1);
            }
            left(finder.step())
        });
    }

    fn apart(&mut self) -> f32 {
        match self.last {
            [Some((one, p)), Some((twin, q))] => (one.distance_px(twin) / MAX_APART_PX).max((p - q).abs() / 0.2),
            _ => f32::INFINITY,
        }
    }
}

#[test]
fn hands_over_time_survive_hostile_frames() {
    drive("hands over time", 60, Recovery::FromAll, Hands::new);
}

//! Where tracked hands lie. Only frames with a reference palm count.

use super::reference::Reference;
use sinew_core::camera::Pixel;

/// Rows of one arm, and where those that say `tracking` lie.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ArmScore {
    /// All rows.
    pub rows: usize,
    /// Those that say `tracking`.
    pub sure: usize,
    /// Of these, on a palm.
    pub on_hand: usize,
    /// Of these, on the face and on no palm.
    pub on_face: usize,
}

/// The same for both arms, left first, and how many palms were found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct HandScore {
    /// Of each arm.
    pub arms: [ArmScore; 2],
    /// Palms of the reference.
    pub palms: usize,
    /// Those that a row which says `tracking` lies on.
    pub found: usize,
}

/// a of b, or zero of none.
fn share(a: usize, b: usize) -> f64 {
    if b == 0 { 0.0 } else { a as f64 / b as f64 }
}

impl ArmScore {
    fn add(&mut self, reference: &Reference, sure_hand: Option<Pixel>) {
        self.rows += 1;
        let Some(hand) = sure_hand else { return };
        let palms: Vec<_> = reference.palms().collect();
        let is_on_hand = palms.iter().any(|palm| palm.holds(hand));
        if let ([palm], false) = (palms.as_slice(), is_on_hand) {
            // The reference missed that hand.
            if reference.is_at_wrist_off(hand, palm) {
                self.rows -= 1;
                return;
            }
        }
        self.sure += 1;
        self.on_hand += usize::from(is_on_hand);
        self.on_face += usize::from(!is_on_hand && reference.is_on_face(hand));
    }

    /// Of the rows that say `tracking`, the share on a palm.
    #[must_use]
    pub fn on_hand_share(&self) -> f64 {
        share(self.on_hand, self.sure)
    }

    fn plus(&mut self, other: &Self) {
        self.rows += other.rows;
        self.sure += other.sure;
        self.on_hand += other.on_hand;
        self.on_face += other.on_face;
    }
}

impl HandScore {
    /// Adds a frame: the hands of the arms that say `tracking`, left first.
    pub fn add(&mut self, reference: &Reference, sure_hands: [Option<Pixel>; 2]) {
        if reference.palms().next().is_none() {
            return;
        }
        for (arm, hand) in self.arms.iter_mut().zip(sure_hands) {
            arm.add(reference, hand);
        }
        for palm in reference.palms() {
            self.palms += 1;
            self.found += usize::from(sure_hands.iter().flatten().any(|hand| palm.holds(*hand)));
        }
    }

    /// Adds those of another clip.
    pub fn plus(&mut self, other: &Self) {
        for (arm, others) in self.arms.iter_mut().zip(&other.arms) {
            arm.plus(others);
        }
        self.palms += other.palms;
        self.found += other.found;
    }

    /// Both arms as one.
    #[must_use]
    pub fn both(&self) -> ArmScore {
        let mut both = self.arms[0];
        both.plus(&self.arms[1]);
        both
    }

    /// Of all rows, the share that says `tracking`.
    #[must_use]
    pub fn sure_share(&self) -> f64 {
        share(self.both().sure, self.both().rows)
    }

    /// Of the rows that say `tracking`, the share on the face.
    #[must_use]
    pub fn on_face_share(&self) -> f64 {
        share(self.both().on_face, self.both().sure)
    }

    /// Of the palms, the share that was found.
    #[must_use]
    pub fn found_share(&self) -> f64 {
        share(self.found, self.palms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::people::reference::read;

    #[test]
    fn hands_count_where_the_reference_has_palms() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let columns = "frame,palm1_u_px,palm1_v_px,size1_px,palm2_u_px,palm2_v_px,size2_px,nose_u_px,nose_v_px,ears_px";
        let wrists = "l_wrist_u_px,l_wrist_v_px,r_wrist_u_px,r_wrist_v_px";
        let rows = "0,100,300,60,500,300,60,300,100,50,500,290,100,290\n1,100,300,60,,,,300,100,50,500,290,100,290\n\
                    2,,,,,,,300,100,50,500,290,100,290\n";
        std::fs::write(&path, format!("{columns},{wrists}\n{rows}")).unwrap();
        let frames = read(&path).unwrap();
        let mut score = HandScore::default();
        let [palm, face, wrist] = [[110.0, 300.0], [300.0, 110.0], [500.0, 295.0]].map(|[u, v]| Some(Pixel::new(u, v)));
        score.add(&frames[0], [face, palm]);
        assert_eq!(score.arms[0], ArmScore { rows: 1, sure: 1, on_hand: 0, on_face: 1 });
        assert_eq!((score.arms[1].on_hand, score.palms, score.found), (1, 2, 1));
        // The reference missed the left hand, and in the last frame both.
        score.add(&frames[1], [wrist, palm]);
        score.add(&frames[2], [wrist, palm]);
        assert_eq!((score.arms[0].rows, score.arms[1].rows, score.palms), (1, 2, 3));
        assert_eq!((score.both().on_hand_share(), score.sure_share()), (2.0 / 3.0, 1.0));
        assert_eq!((score.on_face_share(), score.found_share()), (1.0 / 3.0, 2.0 / 3.0));
    }
}

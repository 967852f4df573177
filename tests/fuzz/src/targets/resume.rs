//! What a run left: `resume.json` and the states in it.

use super::configuration::{body_filter, points, steps};
use super::cyclic::{angle_table, tracking_options, two_models};
use super::saved_states::sealed;
use crate::Target;
use crate::file::{file, folder};
use crate::numbers::{Numbers, seeds};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use sinew::config::Config;
use sinew::cyclic::tracking::TableRun;
use sinew::resume::{Begun, Left, List, RESUME_FILE, ResumeFile, from_text, long_real, optional, real, to_text};
use sinew::track::{ArmSet, SideChoice};
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};

/// The file, and the states of the three kinds of runs as text.
pub const TARGETS: &[Target] = &[
    Target { name: "resume_json", run: left, seeds: || vec![left_json()] },
    Target { name: "resume_list", run: list, seeds: || vec![list_words(3), list_words(0)] },
    Target { name: "resume_arm", run: arm, seeds: arm_seeds },
    Target { name: "resume_body", run: body, seeds: body_seeds },
    Target { name: "resume_cyclic", run: cyclic, seeds: cyclic_seeds },
];

const COMMAND: &str = "track arm";
/// Bytes of the numbers before a state's words.
const NUMBERS: usize = 40;

fn left_json() -> Vec<u8> {
    let begun = Begun::new(COMMAND, &Config::default(), &[]).expect("it is JSON").reading("the skin model", 7);
    serde_json::to_vec_pretty(&Left::new(begun, 12, 3.5, Some(7), Value::Null)).expect("it is JSON")
}

fn left(bytes: &[u8]) {
    let _ = file(RESUME_FILE, bytes);
    let resume = ResumeFile::in_folder(&folder(), COMMAND);
    let Ok(left) = resume.read::<Value>(&folder()) else { return };
    let now = Begun::new(COMMAND, &Config::default(), &[]).expect("it is JSON");
    let _ = left.begun.check_options(&now, &folder());
    let _ = left.begun.check_inputs(&now);
    resume.put(&left).expect("a temporary file");
    let again: Left<Value> = resume.read(&folder()).expect("it was written");
    assert_eq!((again.begun, again.finished, again.state), (left.begun, left.finished, left.state));
}

/// An entry of a list of any length.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    angle: Option<f32>,
    sum: f64,
    big: [f32; 30],
}

const FILL: Entry = Entry { angle: None, sum: 0.0, big: [0.0; 30] };

impl SavedState for Entry {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        optional(&mut self.angle, 0.0, visitor, real);
        long_real(&mut self.sum, visitor);
        self.big.iter_mut().for_each(|number| real(number, visitor));
    }
}

/// The words of a state that was saved as text.
fn words(text: &str) -> Vec<u8> {
    let bytes = STANDARD.decode(text).expect("it was written");
    bytes[16..bytes.len() - 4].to_vec()
}

/// A state as text with a sound envelope.
fn sealed_text(kind: StateKind, words: &[u8]) -> String {
    STANDARD.encode(sealed(kind, 0, words))
}

fn list_words(count: usize) -> Vec<u8> {
    let entries = vec![Entry { angle: Some(0.5), ..FILL }; count];
    words(&to_text(StateKind::Arm, &mut List::new(entries, FILL)).expect("it can be saved"))
}

fn list(bytes: &[u8]) {
    let mut list = List::new(Vec::new(), FILL);
    let _ = from_text(StateKind::Arm, &String::from_utf8_lossy(bytes), &mut list);
    if from_text(StateKind::Arm, &sealed_text(StateKind::Arm, bytes), &mut list).is_ok() {
        assert!(list.entries.len() <= bytes.len(), "more entries than bytes");
        let text = to_text(StateKind::Arm, &mut list).expect("it can be saved");
        from_text(StateKind::Arm, &text, &mut List::new(Vec::new(), FILL)).expect("it was saved");
    }
}

fn arms(side: SideChoice) -> ArmSet {
    ArmSet::new(&Config::default(), (640, 480), side, 1).expect("the defaults are legal")
}

fn arm_seeds() -> Vec<Vec<u8>> {
    [SideChoice::Left, SideChoice::Both]
        .into_iter()
        .map(|side| {
            let mut arms = arms(side);
            arms.step(0, None);
            words(&arms.saved().expect("it can be saved"))
        })
        .collect()
}

fn arm(bytes: &[u8]) {
    for (side, kind) in [(SideChoice::Left, StateKind::Arm), (SideChoice::Both, StateKind::ArmPair)] {
        let mut arms = arms(side);
        if arms.restore(&sealed_text(kind, bytes)).is_ok() {
            for view in arms.step(66_667, None) {
                let joints = view.estimate.joints;
                assert!(joints.hand_m.iter().all(|coordinate| coordinate.is_finite()), "{joints:?}");
            }
        }
    }
}

fn with_numbers(numbers: Vec<u8>, words: &[u8]) -> Vec<u8> {
    [numbers, words.to_vec()].concat()
}

fn body_seeds() -> Vec<Vec<u8>> {
    (0..5)
        .map(|kind| {
            let mut filter = body_filter(&mut Numbers::new(&[kind]));
            let blocks = filter.blocks(&mut points());
            steps(&mut filter, &blocks);
            with_numbers(vec![kind], &words(&filter.saved().expect("it can be saved")))
        })
        .collect()
}

fn body(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let mut filter = body_filter(&mut numbers);
    if filter.restore(&sealed_text(StateKind::Body, numbers.rest())).is_ok() {
        let blocks = filter.blocks(&mut points());
        steps(&mut filter, &blocks);
    }
}

fn cyclic_seeds() -> Vec<Vec<u8>> {
    let (table, models) = (angle_table(), two_models());
    let saved = |bytes: Vec<u8>| {
        let mut numbers = Numbers::new(&bytes);
        let (options, count) = (tracking_options(&mut numbers), 1 + numbers.below(2));
        let mut run = TableRun::begin(&table, &models[..count], &options).ok()?;
        run.run(&|| false, &mut |_| ()).ok()?;
        let words = words(&run.saved().ok()??);
        Some(with_numbers(bytes, &words))
    };
    let mut all = seeds(NUMBERS);
    for (filter, count) in [(1, 0), (2, 0), (3, 0), (0, 1)] {
        let mut bytes = vec![0; NUMBERS];
        (bytes[0], bytes[17]) = (filter, count);
        all.push(bytes);
    }
    all.into_iter().filter_map(saved).collect()
}

fn cyclic(bytes: &[u8]) {
    let (bytes, words) = bytes.split_at(bytes.len().min(NUMBERS));
    let mut numbers = Numbers::new(bytes);
    let options = tracking_options(&mut numbers);
    let (table, models) = (angle_table(), two_models());
    let models = &models[..1 + numbers.below(2)];
    let Ok(mut run) = TableRun::begin(&table, models, &options) else { return };
    let finished = numbers.below(table.rows().len() + 2);
    if run.restore(finished, Some(&sealed_text(StateKind::Cyclic, words))).is_ok() {
        run.run(&|| false, &mut |_| ()).expect("all rows are legal");
        let _ = run.answered();
    }
}

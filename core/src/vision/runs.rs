//! Runs of set pixels: found in a line of bits, kept in a pool that all components share.

/// Marks the end of a list of runs, and a list without any.
pub(super) const NO_RUN: u32 = u32::MAX;
/// Marks a run whose component was dropped.
pub(super) const NO_SLOT: u16 = u16::MAX;

/// Pixels `start..end` of one line, and the slot of their component.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LineRun {
    pub start: u16,
    pub end: u16,
    pub slot: u16,
}

/// Finds the runs of a line of bits and returns how many there are, and how many pixels found no
/// room.
///
/// When there are more runs than `runs` holds, only those of at least 2, 4, 8 ... pixels are taken,
/// until they fit.
pub(super) fn find_runs(bits: &[u32], runs: &mut [LineRun]) -> (usize, u32) {
    let mut shortest = 1_u16;
    loop {
        if let Some(count) = take_runs(bits, shortest, runs) {
            if shortest == 1 {
                return (count, 0);
            }
            let taken: u32 = runs.iter().take(count).map(|run| u32::from(run.end - run.start)).sum();
            return (count, bits.iter().map(|word| word.count_ones()).sum::<u32>() - taken);
        }
        if shortest > u16::MAX / 2 {
            return (0, bits.iter().map(|word| word.count_ones()).sum());
        }
        shortest *= 2;
    }
}

/// The runs of at least `shortest` pixels; `None` when there are more than `runs` holds.
fn take_runs(bits: &[u32], shortest: u16, runs: &mut [LineRun]) -> Option<usize> {
    let mut count = 0;
    let mut open: Option<u16> = None;
    for (i, &word) in bits.iter().enumerate() {
        let first = (32 * i) as u16;
        // The bits at which the line changes, the pixel before the word included.
        let mut changes = word ^ (word << 1 | u32::from(open.is_some()));
        while changes != 0 {
            let at = first + changes.trailing_zeros() as u16;
            changes &= changes - 1;
            match open.take() {
                None => open = Some(at),
                Some(start) => count = push(runs, count, start, at, shortest)?,
            }
        }
    }
    match open {
        None => Some(count),
        Some(start) => push(runs, count, start, (32 * bits.len()) as u16, shortest),
    }
}

#[inline]
fn push(runs: &mut [LineRun], count: usize, start: u16, end: u16, shortest: u16) -> Option<usize> {
    if end - start < shortest {
        return Some(count);
    }
    *runs.get_mut(count)? = LineRun { start, end, slot: NO_SLOT };
    Some(count + 1)
}

/// A run of one component, kept in a [`RunPool`].
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::{Run, RunPool};
///
/// // Pixels 4 to 7 of a row, and where the row is.
/// let (mut storage, mut found) = ([Run::default(); 8], Run::default());
/// ComponentScanner::<8, 8>::new().scan(
///     &Mask::new(&[0, 0xf0, 0], 32, 3)?,
///     &mut RunPool::new(&mut storage),
///     &mut |component, pool| found = component.runs(pool).next().expect("it has pixels"),
/// );
/// assert_eq!((found.start, found.end, found.row), (4, 8, 1), "the end is not part of it");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Run {
    /// First column, pixels.
    pub start: u16,
    /// Column after the last one, pixels.
    pub end: u16,
    /// Row, pixels.
    pub row: u16,
    next: u32,
}

/// Storage for the runs of all components that are still growing: linked lists in a slice.
///
/// Invariant: every run is in exactly one list, that of the free ones or that of one component.
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::{Run, RunPool};
///
/// // Room for two runs, and a component of three: its sums are exact, its shape lacks four pixels.
/// let mut storage = [Run::default(); 2];
/// let mut seen = (0, 0);
/// ComponentScanner::<8, 8>::new().scan(
///     &Mask::new(&[0xf0; 3], 32, 3)?,
///     &mut RunPool::new(&mut storage),
///     &mut |component, _| seen = (component.area_px(), component.unrecorded_px()),
/// );
/// assert_eq!(seen, (12, 4));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct RunPool<'a> {
    runs: &'a mut [Run],
    free: u32,
}

impl<'a> RunPool<'a> {
    /// An empty pool for as many runs as the slice holds; with an empty slice components have
    /// statistics but no shape.
    #[must_use]
    pub fn new(runs: &'a mut [Run]) -> Self {
        let len = runs.len().min(NO_RUN as usize);
        let runs = &mut runs[..len];
        for (i, run) in runs.iter_mut().enumerate() {
            run.next = if i + 1 < len { i as u32 + 1 } else { NO_RUN };
        }
        Self { free: if runs.is_empty() { NO_RUN } else { 0 }, runs }
    }

    /// Takes a run into the list that `head` and `tail` describe; false when the pool is used up.
    pub(super) fn append(&mut self, list: &mut RunList, start: u16, end: u16, row: u16) -> bool {
        let at = self.free;
        let Some(run) = self.runs.get_mut(at as usize) else { return false };
        self.free = run.next;
        *run = Run { start, end, row, next: NO_RUN };
        self.join(list, RunList { head: at, tail: at });
        true
    }

    /// Appends the list `other` to `list`.
    pub(super) fn join(&mut self, list: &mut RunList, other: RunList) {
        match self.runs.get_mut(list.tail as usize) {
            None => *list = other,
            Some(_) if other.head == NO_RUN => {}
            Some(last) => {
                last.next = other.head;
                list.tail = other.tail;
            }
        }
    }

    /// Makes a list's runs free again.
    pub(super) fn release(&mut self, list: RunList) {
        if let Some(last) = self.runs.get_mut(list.tail as usize) {
            last.next = self.free;
            self.free = list.head;
        }
    }

    pub(super) fn iter(&self, list: RunList) -> impl Iterator<Item = Run> + '_ {
        let mut at = list.head;
        // No list is longer than the pool: a bound that holds even if the links were wrong.
        (0..self.runs.len()).map_while(move |_| {
            let run = *self.runs.get(at as usize)?;
            at = run.next;
            Some(run)
        })
    }
}

/// First and last run of a list in a [`RunPool`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RunList {
    pub head: u32,
    pub tail: u32,
}

impl RunList {
    pub const EMPTY: Self = Self { head: NO_RUN, tail: NO_RUN };
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn naive(bits: &[u32]) -> Vec<(u16, u16)> {
        let get = |i: usize| bits.get(i / 32).is_some_and(|w| w >> (i % 32) & 1 == 1);
        let starts = (0..32 * bits.len()).filter(|&i| get(i) && (i == 0 || !get(i - 1)));
        starts.map(|s| (s as u16, (s..).find(|&i| !get(i)).unwrap() as u16)).collect()
    }

    proptest! {
        #[test]
        fn runs_equal_a_scan_by_pixel(bits in prop::collection::vec(prop_oneof![any::<u32>(), Just(u32::MAX), Just(0)], 0..5)) {
            let mut runs = [LineRun::default(); 80];
            let (count, lost) = find_runs(&bits, &mut runs);
            let found: Vec<_> = runs[..count].iter().map(|r| (r.start, r.end)).collect();
            prop_assert_eq!(found, naive(&bits));
            prop_assert_eq!(lost, 0);
        }

        #[test]
        fn too_many_runs_keep_the_longer_ones(bits in prop::collection::vec(any::<u32>(), 3)) {
            let mut runs = [LineRun::default(); 7];
            let (count, lost) = find_runs(&bits, &mut runs);
            let all = naive(&bits);
            let shortest = runs[..count].iter().map(|r| r.end - r.start).min();
            prop_assert!(count == all.len() || all.len() > 7);
            let left_out = all.iter().filter(|r| !runs[..count].iter().any(|k| k.start == r.0));
            let mut pixels = 0;
            for run in left_out {
                pixels += u32::from(run.1 - run.0);
                prop_assert!(shortest.is_none_or(|s| run.1 - run.0 < s));
            }
            prop_assert_eq!(lost, pixels);
        }
    }

    #[test]
    fn a_pool_gives_back_what_was_released() {
        let mut storage = [Run::default(); 3];
        let mut pool = RunPool::new(&mut storage);
        let (mut a, mut b) = (RunList::EMPTY, RunList::EMPTY);
        assert!(pool.append(&mut a, 0, 1, 0) && pool.append(&mut b, 2, 3, 0) && pool.append(&mut a, 0, 2, 1));
        assert!(!pool.append(&mut b, 5, 6, 1));
        pool.join(&mut b, a);
        assert_eq!(
            pool.iter(b).map(|r| (r.start, r.end, r.row)).collect::<Vec<_>>(),
            [(2, 3, 0), (0, 1, 0), (0, 2, 1)]
        );
        pool.release(b);
        let mut c = RunList::EMPTY;
        assert!((0..3).all(|i| pool.append(&mut c, i, i + 1, i)) && !pool.append(&mut c, 9, 10, 9));
        assert!(!RunPool::new(&mut []).append(&mut c, 0, 1, 0));
    }
}

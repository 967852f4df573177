//! 8-connected components in one pass over lines, as a camera delivers them.

use super::components::{Component, overlaps};
use super::mask::Mask;
use super::runs::{LineRun, NO_SLOT, RunPool, find_runs};
use crate::numeric::rolled::rolled;

/// A place of the table of components that are still growing; all zeros are one that is free.
#[derive(Debug, Clone, Copy)]
#[repr(u8)]
enum Slot {
    /// Not in use; the next free slot.
    Free { next: u16 },
    /// Holds a component, last seen in `row`.
    Root { row: u16, component: Component },
    /// Was found to be the same component as another slot's.
    Merged { into: u16 },
}

/// Finds components line by line; keeps only the last line's runs and the components that are still
/// growing.
///
/// `RUNS` is the number of runs a line may have; half of the width, rounded up, always suffices.
/// `OPEN` is the number of components that may grow at the same time, at most 65534; half of the
/// width always suffices. Where a line has more runs, its shortest are left out; where more
/// components grow, the smallest is dropped. Both are counted, and while both counts are zero the
/// result is exact. Work for a line: its runs, times at most `OPEN` + 2 `RUNS` for each component
/// dropped.
///
/// Invariant between lines: every run of the last line points at a root, or at nothing when it was
/// dropped. Every root is pointed at.
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::RunPool;
///
/// // Two fingers that join in the third line are one component; the separate pixels are another.
/// let mask = Mask::new(&[0b0_1001, 0b0_1001, 0b0_1111, 0, 0b1_1000], 32, 5)?;
/// let mut scanner = ComponentScanner::<16, 16>::new();
/// let (mut areas_px, mut count) = ([0; 4], 0);
/// scanner.scan(&mask, &mut RunPool::new(&mut []), &mut |component, _| {
///     areas_px[count] = component.area_px();
///     count += 1;
/// });
/// assert_eq!(areas_px[..count], [8, 2]);
/// assert_eq!(scanner.dropped_components(), 0, "all had room");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ComponentScanner<const RUNS: usize, const OPEN: usize> {
    lines: [[LineRun; RUNS]; 2],
    counts: [usize; 2],
    /// Which of the two lines is the one that was read last.
    last: usize,
    slots: [Slot; OPEN],
    free: u16,
    row: u16,
    /// No component in a full table is smaller than this.
    smallest_px: u32,
    dropped_components: u32,
    dropped_px: u32,
}

impl<const RUNS: usize, const OPEN: usize> Default for ComponentScanner<RUNS, OPEN> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const RUNS: usize, const OPEN: usize> ComponentScanner<RUNS, OPEN> {
    /// A scanner before its first line.
    #[must_use]
    pub fn new() -> Self {
        const { assert!(OPEN < NO_SLOT as usize, "at most 65534 components can be open") }
        let mut scanner = Self {
            lines: [[LineRun::default(); RUNS]; 2],
            counts: [0; 2],
            last: 0,
            slots: [Slot::Free { next: NO_SLOT }; OPEN],
            free: NO_SLOT,
            row: 0,
            smallest_px: 0,
            dropped_components: 0,
            dropped_px: 0,
        };
        scanner.restart();
        scanner
    }

    /// Forgets all lines and counts, to begin with another image (and an empty pool).
    pub fn restart(&mut self) {
        for (i, slot) in self.slots.iter_mut().enumerate() {
            *slot = Slot::Free { next: if i + 1 < OPEN { i as u16 + 1 } else { NO_SLOT } };
        }
        self.free = if OPEN == 0 { NO_SLOT } else { 0 };
        self.counts = [0; 2];
        self.row = 0;
        self.smallest_px = 0;
        self.dropped_components = 0;
        self.dropped_px = 0;
    }

    /// Components (or later parts of one that had been dropped) that found no room in the table.
    #[must_use]
    pub fn dropped_components(&self) -> u32 {
        self.dropped_components
    }

    /// Pixels of runs that found no room in a line, and of components that were dropped.
    #[must_use]
    pub fn dropped_px(&self) -> u32 {
        self.dropped_px
    }

    /// Scans all rows of `mask` and gives each component to `sink`, in the order of their last
    /// rows.
    pub fn scan(&mut self, mask: &Mask<'_>, pool: &mut RunPool<'_>, sink: &mut impl FnMut(&Component, &RunPool<'_>)) {
        self.restart();
        for row in mask.rows() {
            self.line(row, pool, sink);
        }
        self.finish(pool, sink);
    }

    /// Reads the next line of bits (those beyond the width zero) and gives the components that it
    /// ends to `sink`.
    ///
    /// At most [`super::mask::MAX_SIDE_PX`] pixels and lines are read, the rest is ignored.
    pub fn line(&mut self, bits: &[u32], pool: &mut RunPool<'_>, sink: &mut impl FnMut(&Component, &RunPool<'_>)) {
        const WORDS: usize = super::mask::MAX_SIDE_PX / 32;
        if usize::from(self.row) >= super::mask::MAX_SIDE_PX {
            return;
        }
        let (above, here) = (self.last & 1, (self.last + 1) & 1);
        let (count, lost_px) = find_runs(&bits[..bits.len().min(WORDS)], &mut self.lines[here]);
        self.dropped_px = self.dropped_px.saturating_add(lost_px);
        self.counts[here] = count;
        self.connect(pool);
        for i in 0..count.min(RUNS) {
            self.lines[here][i].slot = self.root(self.lines[here][i].slot);
        }
        self.close_ended(above, pool, sink);
        self.last = here;
        self.row += 1;
    }

    /// Ends the image: gives the components that touch its last line to `sink`.
    pub fn finish(&mut self, pool: &mut RunPool<'_>, sink: &mut impl FnMut(&Component, &RunPool<'_>)) {
        let last = self.last & 1;
        // No component has been seen in a row that does not exist, so all of them end.
        self.row = u16::MAX;
        self.close_ended(last, pool, sink);
        self.counts = [0; 2];
        self.row = 0;
    }

    /// Gives each run of the new line a slot, and merges what it connects.
    fn connect(&mut self, pool: &mut RunPool<'_>) {
        let (above, here) = (self.last & 1, (self.last + 1) & 1);
        // Counts never exceed the capacity; the explicit bound removes the checks of indices.
        let (count_above, count) = (self.counts[above].min(RUNS), self.counts[here].min(RUNS));
        let mut first = 0;
        for i in 0..count {
            let LineRun { start, end, .. } = self.lines[here][i];
            while first < count_above && self.lines[above][first].end < start {
                first += 1;
            }
            let mut pairs = [0; 3];
            let mut slot = NO_SLOT;
            let mut touches_dropped = false;
            let mut next = first;
            while next < count_above && self.lines[above][next].start <= end {
                let over = self.lines[above][next];
                next += 1;
                let root = self.root(over.slot);
                if root == NO_SLOT {
                    touches_dropped = true;
                    continue;
                }
                let more = overlaps((over.start, over.end), (start, end));
                pairs.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                if slot == NO_SLOT {
                    slot = root;
                } else if slot != root {
                    self.absorb(slot, root, pool);
                }
            }
            if slot == NO_SLOT {
                slot = self.take_slot(u32::from(end - start), touches_dropped, pool);
            }
            self.lines[here][i].slot = slot;
            self.grow(slot, (start, end), pairs, pool);
        }
    }

    /// Adds a run of the current row to the component in `slot`, or makes it the first of it.
    fn grow(&mut self, slot: u16, (start, end): (u16, u16), pairs: [u32; 3], pool: &mut RunPool<'_>) {
        let now = self.row;
        match self.slots.get_mut(usize::from(slot)) {
            Some(Slot::Root { component, row }) => {
                component.add_run(start, end, now, pairs);
                component.record(start, end, now, pool);
                *row = now;
            }
            Some(free) => {
                let mut component = Component::from_run(start, end, now);
                component.record(start, end, now, pool);
                *free = Slot::Root { component, row: now };
            }
            None => {}
        }
    }

    /// The root of a slot. Chains end, since each merge points from one root to another.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn root(&self, slot: u16) -> u16 {
        let mut at = slot;
        for _ in 0..rolled(OPEN) {
            match self.slots.get(usize::from(at)) {
                Some(Slot::Merged { into }) => at = *into,
                _ => break,
            }
        }
        at
    }

    /// Merges the component of root `from` into that of root `into`.
    fn absorb(&mut self, into: u16, from: u16, pool: &mut RunPool<'_>) {
        let Some(&Slot::Root { component: moved, .. }) = self.slots.get(usize::from(from)) else { return };
        if let Some(Slot::Root { component, .. }) = self.slots.get_mut(usize::from(into)) {
            component.merge(&moved, pool);
            if let Some(slot) = self.slots.get_mut(usize::from(from)) {
                *slot = Slot::Merged { into };
            }
        }
    }

    /// A free slot for a new component of `area_px`, taken from the smallest one if need be.
    ///
    /// [`NO_SLOT`] if none is smaller.
    fn take_slot(&mut self, area_px: u32, counted: bool, pool: &mut RunPool<'_>) -> u16 {
        if self.free == NO_SLOT && area_px > self.smallest_px {
            self.drop_smallest_below(area_px, pool);
        }
        let slot = self.free;
        match self.slots.get(usize::from(slot)) {
            Some(&Slot::Free { next }) => {
                self.free = next;
                self.smallest_px = 0;
            }
            _ => {
                self.dropped_components = self.dropped_components.saturating_add(u32::from(!counted));
                self.dropped_px = self.dropped_px.saturating_add(area_px);
            }
        }
        slot
    }

    /// Drops the smallest growing component if it is smaller than `area_px`.
    fn drop_smallest_below(&mut self, area_px: u32, pool: &mut RunPool<'_>) {
        let sizes = self.slots.iter().enumerate().filter_map(|(i, slot)| match slot {
            Slot::Root { component, .. } => Some((component.area_px(), i as u16)),
            _ => None,
        });
        let Some((smallest_px, victim)) = sizes.min() else { return };
        self.smallest_px = smallest_px;
        if smallest_px >= area_px {
            return;
        }
        for line in 0..2 {
            for i in 0..self.counts[line].min(RUNS) {
                let slot = self.lines[line][i].slot;
                if slot != NO_SLOT && self.root(slot) == victim {
                    self.lines[line][i].slot = NO_SLOT;
                }
            }
        }
        for i in 0..OPEN {
            if i != usize::from(victim) && matches!(self.slots[i], Slot::Merged { .. }) && self.root(i as u16) == victim
            {
                self.release(i as u16);
            }
        }
        if let Some(&Slot::Root { component, .. }) = self.slots.get(usize::from(victim)) {
            pool.release(component.runs);
        }
        self.release(victim);
        self.dropped_components = self.dropped_components.saturating_add(1);
        self.dropped_px = self.dropped_px.saturating_add(smallest_px);
    }

    fn release(&mut self, slot: u16) {
        if let Some(place) = self.slots.get_mut(usize::from(slot)) {
            *place = Slot::Free { next: self.free };
            self.free = slot;
        }
    }

    /// Ends the components of line `above` that the current row did not continue, and frees merged
    /// slots.
    fn close_ended(&mut self, above: usize, pool: &mut RunPool<'_>, sink: &mut impl FnMut(&Component, &RunPool<'_>)) {
        let above = above & 1;
        for i in 0..self.counts[above].min(RUNS) {
            let slot = self.lines[above][i].slot;
            match self.slots.get(usize::from(slot)) {
                Some(&Slot::Root { component, row }) if row != self.row => {
                    sink(&component, pool);
                    pool.release(component.runs);
                    self.release(slot);
                }
                Some(Slot::Merged { .. }) => self.release(slot),
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::components::BoundingBox;
    use crate::vision::mask::{MaskMut, words_per_row};
    use crate::vision::runs::Run;
    use proptest::prelude::*;

    /// Pixels of every 8-connected component, by flood fill, in the order of their first pixels.
    fn flood(mask: &Mask<'_>) -> Vec<Vec<(usize, usize)>> {
        let (width, height) = (mask.width(), mask.height());
        let mut seen = vec![false; width * height];
        let mut all = Vec::new();
        for at in 0..width * height {
            let mut stack = vec![(at % width, at / width)];
            let mut pixels = Vec::new();
            while let Some((u, v)) = stack.pop() {
                if u >= width || v >= height || seen[v * width + u] || !mask.get(u, v) {
                    continue;
                }
                seen[v * width + u] = true;
                pixels.push((u, v));
                for (du, dv) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1), (2, 2)] {
                    stack.push(((u + du).wrapping_sub(1), (v + dv).wrapping_sub(1)));
                }
            }
            if !pixels.is_empty() {
                all.push(pixels);
            }
        }
        all
    }

    type Summary = (u32, BoundingBox, [i64; 3], Vec<(u16, u16, u16)>);

    /// Area, box, rounded moments and runs; all that identifies a component.
    fn summary(component: &Component, pool: &RunPool<'_>) -> Summary {
        let mut runs: Vec<_> = component.runs(pool).map(|r| (r.row, r.start, r.end)).collect();
        runs.sort_unstable();
        (
            component.area_px(),
            component.bounding_box(),
            component.moments_px2().map(|m| (m * 64.0).round() as i64),
            runs,
        )
    }

    fn expected(pixels: &[(usize, usize)]) -> Summary {
        let n = pixels.len() as f64;
        let (mu, mv) = pixels.iter().fold((0.0, 0.0), |(a, b), p| (a + p.0 as f64 / n, b + p.1 as f64 / n));
        let mut moments = [0.0; 3];
        for &(u, v) in pixels {
            let (du, dv) = (u as f64 - mu, v as f64 - mv);
            moments[0] += du * du / n;
            moments[1] += du * dv / n;
            moments[2] += dv * dv / n;
        }
        let us = || pixels.iter().map(|p| p.0 as u16);
        let vs = || pixels.iter().map(|p| p.1 as u16);
        let bounds = BoundingBox {
            min_u: us().min().unwrap(),
            min_v: vs().min().unwrap(),
            max_u: us().max().unwrap(),
            max_v: vs().max().unwrap(),
        };
        let mut sorted: Vec<_> = pixels.iter().map(|&(u, v)| (v as u16, u as u16)).collect();
        sorted.sort_unstable();
        let mut runs: Vec<(u16, u16, u16)> = Vec::new();
        for (v, u) in sorted {
            match runs.last_mut() {
                Some(run) if run.0 == v && run.2 == u => run.2 += 1,
                _ => runs.push((v, u, u + 1)),
            }
        }
        (pixels.len() as u32, bounds, moments.map(|m| (m * 64.0).round() as i64), runs)
    }

    fn scanned<const RUNS: usize, const OPEN: usize>(mask: &Mask<'_>) -> (Vec<Summary>, u32, u32) {
        let mut storage = vec![Run::default(); mask.width() * mask.height()];
        let mut pool = RunPool::new(&mut storage);
        let mut scanner = ComponentScanner::<RUNS, OPEN>::new();
        let mut found = Vec::new();
        scanner.scan(mask, &mut pool, &mut |component, pool| found.push(summary(component, pool)));
        // Every run has gone back into the pool.
        let mut all = super::super::runs::RunList::EMPTY;
        let free = (0..).take_while(|_| pool.append(&mut all, 0, 1, 0)).count();
        assert_eq!(free, mask.width() * mask.height());
        (found, scanner.dropped_components(), scanner.dropped_px())
    }

    prop_compose! {
        fn any_mask()(width in 1_usize..75, height in 1_usize..24, dense in any::<bool>())
            (words in prop::collection::vec(any::<[u32; 2]>(), words_per_row(width) * height),
             width in Just(width), height in Just(height), dense in Just(dense)) -> (Vec<u32>, usize, usize) {
            let mut words: Vec<u32> = words.iter().map(|[a, b]| if dense { *a } else { a & b }).collect();
            MaskMut::new(&mut words, width, height).unwrap();
            (words, width, height)
        }
    }

    proptest! {
        #[test]
        fn components_equal_a_flood_fill((words, width, height) in any_mask()) {
            let mask = Mask::new(&words, width, height).unwrap();
            let (mut found, dropped, _) = scanned::<38, 38>(&mask);
            let mut wanted: Vec<_> = flood(&mask).iter().map(|pixels| expected(pixels)).collect();
            found.sort_by(|a, b| a.3.cmp(&b.3));
            wanted.sort_by(|a, b| a.3.cmp(&b.3));
            prop_assert_eq!(dropped, 0);
            prop_assert_eq!(found.len(), wanted.len());
            for (f, w) in found.iter().zip(&wanted) {
                prop_assert!((0..3).all(|i| (f.2[i] - w.2[i]).abs() <= 1), "{f:?} {w:?}");
                prop_assert_eq!((f.0, f.1, &f.3), (w.0, w.1, &w.3));
            }
        }

        #[test]
        fn a_full_table_drops_counted_pixels_only((words, width, height) in any_mask()) {
            let mask = Mask::new(&words, width, height).unwrap();
            let (found, dropped, dropped_px) = scanned::<9, 3>(&mask);
            let kept: u32 = found.iter().map(|f| f.0).sum();
            prop_assert_eq!(kept + dropped_px, mask.count() as u32);
            let exact = scanned::<38, 38>(&mask).0;
            prop_assert!(dropped > 0 || dropped_px > 0 || found == exact);
            if let (Some(best), Some(all)) = (found.iter().map(|f| f.0).max(), exact.iter().map(|f| f.0).max()) {
                prop_assert!(best <= all);
            }
        }
    }

    #[test]
    fn the_largest_survives_a_table_of_specks() {
        let (width, height) = (64, 12);
        let mut words = vec![0; 2 * height];
        let mut mask = MaskMut::new(&mut words, width, height).unwrap();
        for u in (0..40).step_by(2) {
            (0..2).for_each(|v| mask.set(u, v, true));
        }
        (1..12).for_each(|v| (45..60).for_each(|u| mask.set(u, v, true)));
        let (found, dropped, dropped_px) = scanned::<32, 2>(&mask.view());
        assert!(found.iter().any(|f| f.0 == 15 * 11));
        assert_eq!((found.len(), dropped), (2, 19));
        assert_eq!(dropped_px, 38);
    }

    #[test]
    fn scanners_without_any_room_do_not_panic() {
        let words = [u32::MAX; 4];
        let mask = Mask::new(&words, 32, 4).unwrap();
        assert_eq!(scanned::<0, 4>(&mask), (Vec::new(), 0, 128));
        assert_eq!(scanned::<4, 0>(&mask), (Vec::new(), 1, 128));
    }
}

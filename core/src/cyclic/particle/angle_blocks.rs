//! Angles in blocks of eight: loops over a block's numbers become vector instructions on any target
//! that has them.

use crate::cyclic::model::coupled_model::MAX_ANGLES;

/// Angles of a block.
pub(super) const BLOCK: usize = 8;
/// Most blocks.
pub(super) const MAX_BLOCKS: usize = MAX_ANGLES / BLOCK;

/// One number for each angle, zero beyond the last.
pub(super) type AngleBlocks = [[f32; BLOCK]; MAX_BLOCKS];

/// Blocks that `N` angles fill or begin.
pub(super) const fn used_blocks<const N: usize>() -> usize {
    assert!(N <= MAX_ANGLES, "at most MAX_ANGLES angles");
    N.div_ceil(BLOCK)
}

/// The numbers of `N` angles in blocks.
#[inline]
pub(super) fn blocks_of<const N: usize>(values: &[f32; N]) -> AngleBlocks {
    let mut blocks = AngleBlocks::default();
    for (slot, value) in blocks.as_flattened_mut().iter_mut().zip(values) {
        *slot = *value;
    }
    blocks
}

/// Writes the blocks' numbers back.
#[inline]
pub(super) fn write_back<const N: usize>(blocks: &AngleBlocks, values: &mut [f32; N]) {
    for (value, slot) in values.iter_mut().zip(blocks.as_flattened()) {
        *value = *slot;
    }
}

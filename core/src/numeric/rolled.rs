//! Loops by the target: over vectors, or one by one, and rolled where flash is scarcer than time.

/// Whether short loops over numbers run on vectors. Where not, what is not needed of them is left
/// out.
pub(crate) const HAS_VECTORS: bool = !cfg!(any(target_arch = "arm", target_arch = "riscv32"));

/// `count`, which the compiler does not know on microcontrollers: a loop over so many is not
/// written out for each of its rounds.
///
/// For code that runs once a recording, and for long loops whose rounds are long. On x86-64 the
/// compiler knows the number.
#[inline(always)]
pub(crate) fn rolled(count: usize) -> usize {
    if cfg!(target_arch = "x86_64") { count } else { core::hint::black_box(count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_stays_the_same() {
        assert_eq!([0, 1, 13].map(rolled), [0, 1, 13]);
    }
}

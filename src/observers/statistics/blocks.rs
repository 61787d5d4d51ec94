//! What was coated in each part of a run.

/// Counts gained in successive blocks of time, for [`crate::models::AsymptoteEstimate::from_blocks`].
///
/// Memory: 8 bytes per panel of every tablet and block, 10 MB a block for 770 tablets of 1700 panels.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CoatingBlocks {
    /// Counts at the end of the last block.
    total: Vec<u64>,
    gains: Vec<Vec<u64>>,
}

impl CoatingBlocks {
    /// Ends a block at which the running counts, of all panels of all tablets, are `counts`.
    ///
    /// # Panics
    /// When there are not as many counts as before, or one of them has fallen: counts of another coater.
    pub fn close(&mut self, counts: &[u64]) {
        self.total.resize(counts.len(), 0);
        assert!(self.gains.first().is_none_or(|gain| gain.len() == counts.len()), "counts of another bed");
        self.gains.push(counts.iter().zip(&self.total).map(|(now, before)| now - before).collect());
        self.total.copy_from_slice(counts);
    }

    /// Counts gained in each block.
    pub fn gains(&self) -> &[Vec<u64>] {
        &self.gains
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_add_up_to_the_total() {
        let mut blocks = CoatingBlocks::default();
        blocks.close(&[1, 0, 5]);
        blocks.close(&[4, 2, 5]);
        assert_eq!(blocks.gains(), [vec![1, 0, 5], vec![3, 2, 0]]);
    }
}

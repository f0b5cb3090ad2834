//! Which atoms of which cells there are. Slots are counted as if there were all of them; sites are the slots that are taken, in the
//! same order.

use std::ops::Range;
use std::sync::Arc;

/// What stands where there is no site.
const NONE: u32 = u32::MAX;

/// Which slots are sites; all, if nothing else is said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slots(Option<Arc<Taken>>);

/// Both ways from slots to sites.
#[derive(Debug, PartialEq)]
struct Taken {
    site_of: Vec<u32>,
    slot_of: Vec<u32>,
}

impl Slots {
    /// Those that are taken; there are less than 2³² of them.
    pub fn taken(taken: &[bool]) -> Slots {
        if taken.iter().all(|t| *t) {
            return Slots(None);
        }
        let slot_of: Vec<u32> = (0..taken.len()).filter(|k| taken[*k]).map(|k| k as u32).collect();
        let mut site_of = vec![NONE; taken.len()];
        slot_of.iter().enumerate().for_each(|(i, slot)| site_of[*slot as usize] = i as u32);
        Slots(Some(Arc::new(Taken { site_of, slot_of })))
    }

    /// Whether there is a site in every slot.
    pub fn are_all(&self) -> bool {
        self.0.is_none()
    }

    /// The site in a slot, if there is one.
    #[inline]
    pub fn site(&self, slot: usize) -> Option<usize> {
        match &self.0 {
            None => Some(slot),
            Some(some) => Some(some.site_of[slot]).filter(|i| *i != NONE).map(|i| i as usize),
        }
    }

    /// Where site i is.
    #[inline]
    pub fn slot(&self, i: usize) -> usize {
        self.0.as_ref().map_or(i, |some| some.slot_of[i] as usize)
    }

    /// Slots whose partners are all so many slots away, as runs of sites whose partners are all so many sites away.
    pub fn runs(&self, slots: Range<usize>, offset: isize) -> Vec<(Range<usize>, isize)> {
        if self.are_all() {
            return vec![(slots, offset)];
        }
        let mut runs: Vec<(Range<usize>, isize)> = Vec::new();
        for slot in slots {
            let (Some(i), Some(j)) = (self.site(slot), self.site(super::at(slot, offset))) else { continue };
            let apart = j as isize - i as isize;
            match runs.last_mut() {
                Some((run, by)) if run.end == i && *by == apart => run.end += 1,
                _ => runs.push((i..i + 1, apart)),
            }
        }
        runs
    }
}

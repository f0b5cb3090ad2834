//! A lattice in words.

use super::{Chain, Lattice};
use crate::registry::Described;
use crate::words::counted;

impl Lattice {
    /// What it is and how large: "square, 20 × 20 cells, open, 392 sites (8 left out), 9.5 × 9.5 × 0 nm from the first to the last".
    pub fn words(&self) -> String {
        let sites = counted(self.sites, "site", "sites");
        format!("{}, {}, {sites}{}", self.kind, self.words_of_cells(), self.words_of_extent())
    }

    /// What lengths without a unit count: "sites" of a chain, "cells" of a continuum, lattice constants "a".
    pub fn counted(&self) -> &'static str {
        match (self.kind == Chain::NAME, &self.sections_nm) {
            (true, _) => "sites",
            (false, Some(_)) => "cells",
            _ => "a",
        }
    }

    /// "20 × 20 cells, periodic along the first".
    fn words_of_cells(&self) -> String {
        let last = (0..3).rev().find(|d| self.grid.extends(*d)).unwrap_or(0);
        let size: Vec<String> = self.grid.size[..=last].iter().map(|n| n.to_string()).collect();
        let along = ["first", "second", "third"].into_iter().zip(self.grid.periodic).filter(|(_, periodic)| *periodic);
        let periodic: Vec<&str> = along.map(|(name, _)| name).collect();
        let border =
            if periodic.is_empty() { "open".into() } else { format!("periodic along the {}", periodic.join(" and ")) };
        let atoms = match self.atoms.len() {
            1 => String::new(),
            n => format!(" of {n} atoms"),
        };
        format!("{} cells{atoms}, {border}", size.join(" × "))
    }

    /// How large it is, and what is left out.
    fn words_of_extent(&self) -> String {
        let whole = self.grid.cells() * self.atoms.len();
        let left = if whole > self.sites { format!(" ({} left out)", whole - self.sites) } else { String::new() };
        let [low, high] = self.bounds();
        let scale = self.spacing_nm.unwrap_or(1.0);
        let length = |c: usize| format!("{:.4}", scale * (high[c] - low[c]));
        let size = [0, 1, 2].map(|c| length(c).trim_end_matches('0').trim_end_matches('.').to_string());
        let unit = if self.spacing_nm.is_some() { "nm" } else { "a" };
        format!("{left}, {} {unit} from the first to the last", size.join(" × "))
    }
}

//! What is said of a path beside its numbers.

use super::Verdict;
use super::heights::{height, prominent_maxima};
use super::outcome::{SaddlePoint, SearchReport};
use crate::band::Band;
use crate::landscape::{Doubt, Effort, Minimum, Pass, brings_news};
use crate::stationary::{LOWER, Spectrum};
use crate::words::counted;

/// A path, with what it should have and what was proven of it.
pub struct OfPath<'a> {
    pub band: &'a Band<'a>,
    /// So many images, if a number was given.
    pub asked_for: Option<usize>,
    pub ends: &'a [Minimum; 2],
    pub links: &'a [Pass],
}

impl OfPath<'_> {
    /// What is to be said of it, with the saddles as they are reported, what stands against a certificate, and what it came to.
    pub fn warnings(&self, saddles: &[SaddlePoint], doubts: &[Doubt], verdict: &Verdict) -> Vec<String> {
        let band = self.band;
        let more = self.asked_for.and_then(|asked| more_images(asked, band.images(), saddles.len()));
        let hidden = matches!(verdict, Verdict::BelowRounding { .. }).then(|| format!("not certified: {verdict}"));
        let doubtful = doubts.iter().map(Doubt::warning).chain(hidden);
        let images: Vec<usize> = saddles.iter().map(|saddle| saddle.image).collect();
        let lower = lower_maxima(band.energies_mev(), LOWER * height(band), &images);
        more.into_iter().chain(doubtful).chain(flat_warnings(self.ends, self.links)).chain(lower).collect()
    }
}

/// Says that a search for lower passes ended by its work alone, one of its last few searches having found something.
pub fn search_cut_short(search: &SearchReport) -> Option<String> {
    (search.spent && brings_news(search.quiet)).then(|| {
        let longer = if search.effort == Effort::Thorough { "" } else { "\"search\": {\"effort\": \"thorough\"} or " };
        format!(
            "the search for lower passes still found saddles when its work was spent ({} searches, {} minima): there may well be a lower \
             barrier; {longer}a guess of your own may find it",
            search.searches, search.minima
        )
    })
}

/// Modes under the noise floor are said, not guessed: of many saddles at once.
fn flat_warnings(ends: &[Minimum; 2], links: &[Pass]) -> Vec<String> {
    let say = |what: &str, s: &Spectrum| {
        format!("{what}: {} mode(s) flat to {:.1e} meV, counted with the zero modes", s.flat, s.floor_mev)
    };
    let of_ends = ends.iter().zip(["initial state", "final state"]).filter(|(end, _)| end.spectrum.flat > 0);
    let mut warnings: Vec<String> = of_ends.map(|(end, which)| say(which, &end.spectrum)).collect();
    let flat: Vec<usize> = (0..links.len()).filter(|k| links[*k].spectrum.flat > 0).collect();
    for alike in flat.chunk_by(|a, b| say("", &links[*a].spectrum) == say("", &links[*b].spectrum)) {
        let rows: Vec<String> = alike.chunk_by(|a, b| a + 1 == *b).map(row).collect();
        let saddles = if alike.len() == 1 { "saddle" } else { "saddles" };
        warnings.push(say(&format!("{saddles} {}", rows.join(", ")), &links[alike[0]].spectrum));
    }
    warnings
}

/// A row of numbers without a gap.
fn row(numbers: &[usize]) -> String {
    match numbers {
        [first, .., last] => format!("{first}–{last}"),
        _ => numbers.iter().map(usize::to_string).collect(),
    }
}

/// Says that a path over proven saddles has other maxima than at their images, higher than both sides by this much (meV): where a slope
/// forks, a relaxed path may leave the descent for another valley.
fn lower_maxima(e: &[f64], prominence: f64, saddles: &[usize]) -> Option<String> {
    let on_a_level = |k: usize, image: usize| e[k.min(image)..=k.max(image)].iter().all(|x| *x >= e[k] - prominence);
    let is_other = |k: &usize| saddles.iter().all(|image| image.abs_diff(*k) > 1 && !on_a_level(*k, *image));
    let others = prominent_maxima(e, prominence).into_iter().filter(is_other);
    let (count, highest) = others.fold((0, f64::NEG_INFINITY), |(n, high), k| (n + 1, f64::max(high, e[k] - e[0])));
    let barrier = saddles.iter().map(|image| e[*image] - e[0]).max_by(f64::total_cmp)?;
    (count > 0).then(|| {
        let (maxima, [highest, barrier]) = (counted(count, "more maximum", "more maxima"), [highest, barrier].map(six));
        let level = if highest == barrier { "as high as the barrier" } else { "below the barrier" };
        format!(
            "the path has {maxima} than the saddles that are told, the highest {highest} meV above the initial state: \
             {level}, and not refined"
        )
    })
}

/// An energy as the barrier is told.
fn six(mev: f64) -> String {
    format!("{mev:.6}")
}

/// That a path has more images than were asked for.
fn more_images(asked: usize, has: usize, saddles: usize) -> Option<String> {
    (has > asked).then(|| {
        format!(
            "path.images is {asked}: the lowest route that is known, over {saddles} saddles, needs more, and its path has {has}"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stationary::FEW;

    #[test]
    fn a_search_is_cut_short_where_its_work_is_spent_while_it_still_finds_saddles() {
        let search = |spent: bool, quiet: usize| SearchReport { spent, quiet, ..SearchReport::default() };
        let told = [(true, 1), (true, FEW), (false, 1)].map(|(spent, quiet)| search_cut_short(&search(spent, quiet)));
        assert_eq!(told.map(|warning| warning.is_some()), [true, false, false]);
    }

    #[test]
    fn maxima_of_a_path_that_are_no_saddles_are_told_with_the_highest() {
        let e = [1.0, 2.0, 9.0, 4.0, 4.5, 3.0, 3.000001, 0.0, 2.5, 0.0];
        let told = lower_maxima(&e, 1e-3, &[2]).unwrap();
        assert!(
            told.starts_with(
                "the path has 2 more maxima than the saddles that are told, the highest 3.500000 meV above"
            ),
            "{told}"
        );
        // images beside a saddle's are its own
        assert_eq!(lower_maxima(&e, 1.0, &[2]).map(|told| told.contains("has 1 more maximum than")), Some(true));
        // which differ by less than is shown are alike
        let twins = [0.0, 2.0, 4.0, 1.0, 3.999_999_9, 0.0];
        let told = lower_maxima(&twins, 1e-3, &[2]).unwrap();
        assert!(
            told.ends_with("4.000000 meV above the initial state: as high as the barrier, and not refined"),
            "{told}"
        );
        assert_eq!(lower_maxima(&e, 1e-3, &[1, 4, 8]), None);
        assert_eq!(lower_maxima(&e, 1e-3, &[]), None);
        // nor is what is level with it one more
        let level = [0.0, 5.0, 5.000_1, 5.0, 5.0, 5.000_2, 5.0, 0.0];
        assert_eq!(lower_maxima(&level, 1e-3, &[2]), None);
    }
}

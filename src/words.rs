//! Helping with words: the known word nearest to a misspelt one, and how text from outside is shown in a message.

/// Longest piece of a user's text that a message repeats, in characters.
const SHOWN: usize = 60;

/// Words longer than this are not compared: nobody misspells them by accident, and the work grows with the square.
const LONGEST: usize = 64;

/// The candidate nearest to `word` in Damerau–Levenshtein distance (insertions, deletions, substitutions and swaps of
/// neighbours count one each), case set aside; nothing where all are more than a third of the word's letters away. A candidate that
/// consists of whole parts of the word, as `zeeman` does of those of `zeeman_field`, is one edit away, and one of which the word is
/// such a part two.
///
/// The first of equally near candidates wins.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters = lowered(word);
    let allowed = match letters.len() {
        0 => return None,
        1..=2 => 1,
        n if n > LONGEST => return None,
        n => n.div_ceil(3),
    };
    let mut best: Option<(usize, &'a str)> = None;
    for candidate in candidates {
        let other = lowered(candidate);
        if other.len() > LONGEST {
            continue;
        }
        let distance = edits(&letters, &other).min(parts_left_out(&letters, &other));
        // A word of which no letter is left is not a misspelling.
        let usable = distance <= allowed && distance < letters.len().max(other.len());
        if usable && best.is_none_or(|(d, _)| distance < d) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

fn lowered(word: &str) -> Vec<char> {
    word.chars().flat_map(char::to_lowercase).collect()
}

/// What it counts that one word consists of some of the other's parts, which underscores, hyphens and blanks separate.
fn parts_left_out(word: &[char], candidate: &[char]) -> usize {
    let parts = |letters: &[char]| -> Vec<String> {
        letters.split(|c| matches!(c, '_' | '-' | ' ')).map(|part| part.iter().collect()).collect()
    };
    let [word, candidate] = [word, candidate].map(parts);
    let holds = |long: &[String], short: &[String]| long.windows(short.len()).any(|some| some == short);
    match () {
        () if holds(&word, &candidate) => 1,
        () if holds(&candidate, &word) => 2,
        () => usize::MAX,
    }
}

/// Damerau–Levenshtein distance in the restricted form (no letter is edited twice).
fn edits(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let same = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + same);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

/// So many of a thing: "1 evaluation", "2 evaluations".
pub fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// A user's text in quotes, control characters escaped and what is too long cut, fit for one line of a message.
pub fn quoted(text: &str) -> String {
    let mut chars = text.chars();
    let mut start: String = chars.by_ref().take(SHOWN).collect();
    if chars.next().is_some() {
        start.push('…');
    }
    format!("{start:?}")
}

/// A number as a person would write it: `0.25`, `1e-22`.
pub fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e15).contains(&x.abs()) || !x.is_finite() { format!("{x}") } else { format!("{x:e}") }
}

/// A number with so many significant digits: 0.3, and not the 0.30000000000000004 that rounding left.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_found_or_none_where_all_are_far() {
        let keys = ["sites", "spacing", "periodic", "cross_section", "K2", "K", "J"];
        for (word, expected) in [
            ("site", Some("sites")),
            ("Spacing", Some("spacing")),
            ("sties", Some("sites")),
            ("peridoic", Some("periodic")),
            ("crosssection", Some("cross_section")),
            ("k3", Some("K2")),
            ("A", None),
            ("colour", None),
            ("", None),
            ("sites_number", Some("sites")),
            ("section", Some("cross_section")),
            ("cross-section", Some("cross_section")),
        ] {
            assert_eq!(nearest(word, keys), expected, "{word}");
        }
    }

    #[test]
    fn a_word_of_which_another_is_a_part_is_nearer_than_one_that_looks_like_it() {
        let kinds = ["exchange", "anisotropy", "cubic_anisotropy", "dmi", "zeeman"];
        for (word, expected) in [
            ("uniaxial_anisotropy", Some("anisotropy")),
            ("cubic", Some("cubic_anisotropy")),
            ("Zeeman field", Some("zeeman")),
            ("bulk_dmi", Some("dmi")),
            ("exchanges", Some("exchange")),
            ("an", None),
            ("dmi.D_of_all", None),
        ] {
            assert_eq!(nearest(word, kinds), expected, "{word}");
        }
    }

    #[test]
    fn distances_count_swaps_once() {
        let d = |a: &str, b: &str| edits(&lowered(a), &lowered(b));
        assert_eq!(d("ab", "ba"), 1);
        assert_eq!(d("kitten", "sitting"), 3);
        assert_eq!(d("", "abc"), 3);
        assert_eq!(d("ca", "abc"), 3);
    }

    #[test]
    fn shown_text_stays_on_one_line() {
        assert_eq!(quoted("a\n\u{1b}[31mµ"), r#""a\n\u{1b}[31mµ""#);
        assert_eq!(quoted(&"x".repeat(100)).chars().count(), SHOWN + 3);
    }

    #[test]
    fn numbers_are_written_short() {
        for (x, expected) in [(0.0, "0"), (10.0, "10"), (-0.25, "-0.25"), (1e-22, "1e-22"), (1.3e20, "1.3e20")] {
            assert_eq!(number(x), expected);
        }
    }

    #[test]
    fn digits_that_rounding_left_are_cut_and_numbers_keep_their_size() {
        for (x, digits, expected) in [
            (0.1 + 0.2, 12, 0.3),
            (3.0 * 1.1e-22, 12, 3.3e-22),
            (1234.5678, 6, 1234.57),
            (-0.7, 1, -0.7),
            (0.0, 3, 0.0),
        ] {
            assert_eq!(rounded(x, digits), expected);
        }
        assert!(rounded(f64::NAN, 3).is_nan() && rounded(f64::INFINITY, 3) == f64::INFINITY);
    }
}

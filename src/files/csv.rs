//! Spins as tables: a row a site, three columns for the vector, perhaps one for the image and one for the site.
//!
//! Without a header there are just the three columns. Separators are commas, semicolons, or white space; `#` begins a comment.
//! The last line must have an end, since a number that is cut short is another number.

use super::numbers::parse;
use super::{Collector, FileFormat};
use crate::error::Result;
use crate::geometry::Vector;
use crate::words::quoted;
use std::fmt::Write;

pub(super) const FORMAT: FileFormat = FileFormat {
    name: "csv",
    summary: "a table with a row a site: columns m_x, m_y, m_z, and image and site if there are several images",
    extensions: &["csv", "txt", "dat", "tsv"],
    recognises: |_| false,
    read,
};

/// All images as a table; the first line, a comment, says how many there are.
pub fn write_csv<'a>(images: impl ExactSizeIterator<Item = &'a [Vector]> + Clone) -> Vec<u8> {
    let sites = images.clone().next().map_or(0, <[Vector]>::len);
    let mut text = format!("# images: {}, sites: {sites}\nimage,site,m_x,m_y,m_z\n", images.len());
    for (k, image) in images.enumerate() {
        for (i, [x, y, z]) in image.iter().enumerate() {
            // a String takes whatever is written to it
            let _ = writeln!(text, "{k},{i},{x:?},{y:?},{z:?}");
        }
    }
    text.into_bytes()
}

/// Which column is what.
struct Columns {
    count: usize,
    vector: [usize; 3],
    image: Option<usize>,
    site: Option<usize>,
}

impl Columns {
    /// As a header names them, if it names a vector.
    fn named(words: &[&str]) -> Option<Columns> {
        let plain = |w: &&str| w.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase();
        let words: Vec<String> = words.iter().map(plain).collect();
        let find = |name: &str| words.iter().position(|w| w == name);
        let vector = ["m", "s", "spin", ""].iter().find_map(|prefix| {
            let column = |c: &str| find(&format!("{prefix}{c}"));
            Some([column("x")?, column("y")?, column("z")?])
        })?;
        let image = ["image", "segment", "frame"].iter().find_map(|n| find(n));
        let site = ["site", "index", "atom", "node", "i"].iter().find_map(|n| find(n));
        Some(Columns { count: words.len(), vector, image, site })
    }
}

/// What has been read so far.
#[derive(Default)]
struct State {
    columns: Option<Columns>,
    /// Images and sites, as promised by the file itself.
    promised: Option<(usize, usize)>,
    /// The number of the image begun last, and of its first site.
    image: Option<usize>,
    first_site: Option<usize>,
    rows: usize,
}

fn read(bytes: &[u8], images: &mut Collector) -> Result<()> {
    if bytes.contains(&0) {
        return Err(images.wrong("neither a text nor a file of a known format (OVF 2.0, npz, npy, csv)"));
    }
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{feff}');
    let mut state = State::default();
    for (k, line) in text.split_inclusive('\n').enumerate() {
        let place = format!("line {}", k + 1);
        let body = line.trim();
        if let Some(comment) = body.strip_prefix('#') {
            state.comment(comment);
        } else if !body.is_empty() {
            if !line.ends_with('\n') {
                let message =
                    "the last line has no end, so that its last number may be cut short: end it with a newline";
                return Err(images.error(place, message));
            }
            state.row(&split(body), &place, images)?;
        }
    }
    let found = (images.count(), images.sites());
    match state.promised {
        Some((count, sites)) if found != (count, sites) => Err(images.wrong(format!(
            "the file ends with image {} at {} sites, but promises {count} images of {sites} sites: it is cut short",
            found.0.saturating_sub(1),
            found.1
        ))),
        _ => Ok(()),
    }
}

/// The fields of a line.
fn split(line: &str) -> Vec<&str> {
    let separator = [',', ';'].into_iter().find(|c| line.contains(*c));
    let marks = ['"', '\'', ' ', '\t'];
    match separator {
        Some(c) => line.split(c).map(|w| w.trim_matches(marks)).collect(),
        None => line.split_whitespace().map(|w| w.trim_matches(marks)).collect(),
    }
}

impl State {
    /// A comment may be the promise of [`write_csv`], or a header as NumPy writes it.
    fn comment(&mut self, comment: &str) {
        if self.rows > 0 {
            return;
        }
        let words = split(comment.trim());
        let count = |word: &str, key: &str| word.strip_prefix(key)?.trim_start().strip_prefix(':')?.trim().parse().ok();
        if let [first, second] = words[..]
            && let (Some(images), Some(sites)) = (count(first, "images"), count(second, "sites"))
        {
            self.promised = Some((images, sites));
        } else if self.columns.is_none() {
            self.columns = Columns::named(&words);
        }
    }

    fn row(&mut self, words: &[&str], place: &str, images: &mut Collector) -> Result<()> {
        let header = self.rows == 0 && words.iter().any(|w| parse(w).is_none());
        if header && words.iter().all(|w| parse(w).is_none()) {
            let columns = Columns::named(words).ok_or_else(|| {
                let found = words.iter().take(8).map(|w| quoted(w)).collect::<Vec<_>>().join(", ");
                images.error(place, format!("found the columns {found}, but no m_x, m_y and m_z"))
            })?;
            self.columns = Some(columns);
            self.rows = 1;
            return Ok(());
        }
        let columns = match &self.columns {
            Some(columns) => columns,
            None if words.len() == 3 => {
                self.columns.insert(Columns { count: 3, vector: [0, 1, 2], image: None, site: None })
            }
            None => {
                let message = format!(
                    "found {} columns without a header: a vector has 3; name the columns, such as image,site,m_x,m_y,m_z",
                    words.len()
                );
                return Err(images.error(place, message));
            }
        };
        if words.len() != columns.count {
            let message = format!("found {} columns, expected {}", words.len(), columns.count);
            return Err(images.error(place, message));
        }
        let number = |k: usize| {
            parse(words[k]).ok_or_else(|| images.error(place, format!("found {}, expected a number", quoted(words[k]))))
        };
        let index = |k: Option<usize>| match k.map(|k| (k, words[k].parse::<usize>())) {
            None => Ok(None),
            Some((_, Ok(n))) => Ok(Some(n)),
            Some((k, Err(_))) => {
                Err(images.error(place, format!("found {}, expected a whole number, not negative", quoted(words[k]))))
            }
        };
        let [x, y, z] = columns.vector;
        let v = [number(x)?, number(y)?, number(z)?];
        let (image, site) = (index(columns.image)?, index(columns.site)?);
        self.place(image, site, place, images)?;
        self.rows += 1;
        images.push(v, || place)
    }

    /// Begins the next image where the row does, and makes sure that rows are in order.
    fn place(&mut self, image: Option<usize>, site: Option<usize>, place: &str, images: &mut Collector) -> Result<()> {
        let begun = images.count() > 0;
        let begins = match image {
            _ if !begun => true,
            Some(k) => self.image != Some(k),
            None => site.is_some() && site == self.first_site,
        };
        if begins {
            if begun && image != self.image.and_then(|k| k.checked_add(1)) && image.is_some() {
                let (found, last) = (image.unwrap_or(0), self.image.unwrap_or(0));
                return Err(images.error(place, format!("image {found} follows image {last}: images are in order")));
            }
            let sites = self.promised.map_or(0, |(_, sites)| sites);
            if begun && sites > 0 && images.sites() != sites {
                let found = images.sites();
                return Err(
                    images.error(place, format!("the image before has {found} sites, but {sites} are promised"))
                );
            }
            images.begin(0);
            self.image = image;
            self.first_site = self.first_site.or(site.filter(|i| *i <= 1));
        }
        let expected = self.first_site.and_then(|first| first.checked_add(images.sites()));
        match site {
            Some(i) if Some(i) != expected => {
                let wanted = expected.map_or("0 or 1 first".into(), |n| n.to_string());
                Err(images.error(place, format!("found site {i}, expected {wanted}: sites are in order")))
            }
            _ => Ok(()),
        }
    }
}

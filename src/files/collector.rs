//! What every reader has to check: finite vectors with a direction, images of the same number of sites.

use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::geometry::vector::{dot, unit};
use crate::words::{counted, number};
use std::fmt::Display;

/// |m|² this near to 1 is 1 but for rounding: the vector is kept to the last bit, so that reading what was read changes nothing.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Lengths this near to 1 (or to each other) are equal: six digits of a text, or single precision, do not give more.
const EQUAL: f64 = 1e-5;

/// The images of a file, every vector of unit length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Images {
    /// One vector a node, image after image; all images have the same number of nodes. On a [`mesh`](Self::mesh), and where nodes
    /// have positions, a node without a spin has a zero vector; all other files list the sites.
    pub images: Vec<Vec<Vector>>,
    /// Nodes along x, y and z, x fastest, where the file has them in more than a row.
    pub mesh: Option<[usize; 3]>,
    /// Where the nodes of the first image stand, in the file's own unit; none where it does not say.
    pub places: Vec<Vector>,
    /// What the user should know of the file.
    pub warnings: Vec<String>,
}

/// A vector whose length is not 1.
struct OffUnit {
    length: f64,
    place: String,
}

/// Takes the vectors of a file, one after the other.
pub struct Collector<'a> {
    file: &'a str,
    images: Vec<Vec<Vector>>,
    mesh: Option<[usize; 3]>,
    places: Vec<Vector>,
    may_be_empty: bool,
    vectors: usize,
    off: usize,
    worst: Option<OffUnit>,
    shortest: f64,
    longest: f64,
}

impl<'a> Collector<'a> {
    /// Nothing read of this file yet.
    pub fn new(file: &'a str) -> Collector<'a> {
        let (shortest, longest) = (f64::INFINITY, 0.0);
        let (images, mesh, places, may_be_empty) = (Vec::new(), None, Vec::new(), false);
        Collector { file, images, mesh, places, may_be_empty, vectors: 0, off: 0, worst: None, shortest, longest }
    }

    /// An error at a place of the file.
    pub fn error(&self, place: impl Display, message: impl Display) -> Error {
        Error::invalid("", format!("{}: {place}: {message}", self.file))
    }

    /// An error about the whole file.
    pub fn wrong(&self, message: impl Display) -> Error {
        Error::invalid("", format!("{}: {message}", self.file))
    }

    /// The next image begins; `sites` are known to be in the file.
    pub fn begin(&mut self, sites: usize) {
        self.images.push(Vec::with_capacity(sites));
    }

    /// The next image begins, on a mesh if one is given; whether there may be nodes without a spin.
    pub fn begin_on(&mut self, nodes: usize, mesh: Option<[usize; 3]>, may_be_empty: bool) -> Result<()> {
        let image = self.images.len();
        if image > 0 && mesh != self.mesh {
            return Err(self.error(format!("image {image}"), "its mesh is not that of image 0"));
        }
        (self.mesh, self.may_be_empty) = (mesh, may_be_empty);
        self.begin(nodes);
        Ok(())
    }

    /// Images begun so far.
    pub fn count(&self) -> usize {
        self.images.len()
    }

    /// Sites of the image begun last.
    pub fn sites(&self) -> usize {
        self.images.last().map_or(0, Vec::len)
    }

    /// The vector of the next site of the image begun last; `place` is where in the file it stands.
    pub fn push<P: Display>(&mut self, v: Vector, place: impl Fn() -> P) -> Result<()> {
        if let Some(c) = (0..3).find(|c| !v[*c].is_finite()) {
            let message = format!("the {} component is {}, which is no direction", ["x", "y", "z"][c], v[c]);
            return Err(self.error(place(), message));
        }
        if self.may_be_empty && v == [0.0; 3] {
            self.keep(v);
            return Ok(());
        }
        let square = dot(v, v);
        let kept = if (square - 1.0).abs() <= ROUNDING { Some(v) } else { unit(v) };
        let Some(m) = kept else {
            let message = "the vector is zero and has no direction: is this cell outside the magnet?";
            return Err(self.error(place(), message));
        };
        // Only the smallest and largest numbers have squares that are no measure of them.
        let length = if square > 1e-200 && square < 1e200 { square.sqrt() } else { dot(v, m) };
        (self.shortest, self.longest) = (self.shortest.min(length), self.longest.max(length));
        if (length - 1.0).abs() > EQUAL {
            self.off += 1;
            let badness = |l: f64| if l > 1.0 { l } else { 1.0 / l };
            if self.worst.as_ref().is_none_or(|w| badness(length) > badness(w.length)) {
                self.worst = Some(OffUnit { length, place: place().to_string() });
            }
        }
        self.vectors += 1;
        self.keep(m);
        Ok(())
    }

    /// The position of the next node.
    pub fn stand(&mut self, at: Vector) {
        if self.images.len() == 1 {
            self.places.push(at);
        }
    }

    fn keep(&mut self, v: Vector) {
        if let Some(image) = self.images.last_mut() {
            image.push(v);
        }
    }

    /// All images; an error where there is none, or where they differ in their number of sites.
    pub fn finish(self) -> Result<Images> {
        let sites = self.images.first().map_or(0, Vec::len);
        if sites == 0 || self.vectors == 0 {
            return Err(self.wrong("there are no spins in this file"));
        }
        if let Some(k) = self.images.iter().position(|image| image.len() != sites) {
            let found = self.images[k].len();
            let found = counted(found, "site", "sites");
            return Err(self.wrong(format!("image {k} has {found}, but image 0 has {sites}")));
        }
        let warnings = self.warning().into_iter().collect();
        Ok(Images { warnings, images: self.images, mesh: self.mesh, places: self.places })
    }

    fn warning(&self) -> Option<String> {
        let worst = self.worst.as_ref()?;
        let (file, all, off) = (self.file, self.vectors, self.off);
        if off == all && self.longest - self.shortest <= EQUAL * self.longest {
            let length = number(worst.length);
            return Some(format!("{file}: all vectors are {length} long instead of 1: only their directions are used"));
        }
        let (place, length) = (&worst.place, number(worst.length));
        Some(format!(
            "{file}: {off} of {all} vectors are not of unit length and were normalised; the worst is {length} long, {place}"
        ))
    }
}

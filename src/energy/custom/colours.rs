//! Sites in classes so that none is beside two sites of one class, itself included.

/// The classes, by greedy colouring in the order of the sites; `neighbours` are those of every site, both ways.
pub(super) fn colours(neighbours: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let n = neighbours.len();
    let mut colour: Vec<usize> = vec![usize::MAX; n];
    let mut classes: Vec<Vec<usize>> = Vec::new();
    // which site has last seen a class taken
    let mut taken_for: Vec<usize> = Vec::new();
    for i in 0..n {
        let around = neighbours[i].iter().chain([&i]);
        for j in around.flat_map(|k| neighbours[*k].iter().chain([k])) {
            if colour[*j] != usize::MAX {
                taken_for[colour[*j]] = i;
            }
        }
        let free = taken_for.iter().position(|site| *site != i).unwrap_or(classes.len());
        if free == classes.len() {
            classes.push(Vec::new());
            taken_for.push(usize::MAX);
        }
        colour[i] = free;
        classes[free].push(i);
    }
    classes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_site_is_beside_two_of_one_colour() {
        for n in [1, 2, 5, 12, 13] {
            for reach in 0..4usize {
                let beside = |i: usize| (1..=reach).flat_map(move |k| [(i + k) % n, (i + n * k - k) % n]);
                let near: Vec<Vec<usize>> = (0..n)
                    .map(|i| {
                        let mut all: Vec<usize> = beside(i).filter(|j| *j != i).collect();
                        all.sort_unstable();
                        all.dedup();
                        all
                    })
                    .collect();
                let classes = colours(&near);
                assert_eq!(classes.iter().map(Vec::len).sum::<usize>(), n);
                for class in &classes {
                    for k in 0..n {
                        let seen = class.iter().filter(|i| **i == k || near[k].contains(i)).count();
                        assert!(seen <= 1, "{n} {reach} {class:?}");
                    }
                }
            }
        }
    }
}

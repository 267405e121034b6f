//! Networks of lines of sight: which of several places see each other.

use super::places::NetworkPlaces;
use super::remark::Remark;
use super::sections::NetworkSection;
use belvedere_core::query::{Answer, MedialScene};
use belvedere_data::control::Control;
use belvedere_data::report::{percent, rounded};
use belvedere_data::vector::{length, sub};
use belvedere_data::{Error, Parameter, Result};

/// Maximum number of pairs of a network: of 4472 places without a maximum distance.
const MAX_PAIRS: usize = 10_000_000;

/// Maximum number of places that a warning names.
const MAX_NAMED: usize = 10;

/// Places, and the pairs of them whose lines of sight were tested: they are the same in both directions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SightNetwork {
    /// The places, local metres; a height is NaN where it is not known.
    pub places: Vec<[f64; 3]>,
    /// Name of each place.
    pub names: Vec<String>,
    /// Rows of the two places of each pair, the lower one first.
    pub pairs: Vec<[usize; 2]>,
    /// Number of other places that each place sees.
    pub link_counts: Vec<usize>,
    /// Group of each place, from 0: places of a group see each other, directly or through others of it.
    pub groups: Vec<usize>,
}

impl NetworkPlaces {
    /// Checks the number of places and their maximum distance.
    pub(super) fn check(&self) -> Result<()> {
        if self.places.len() < 2 {
            let value = if self.places.is_empty() { "empty" } else { "of one place" };
            return Err(Error::invalid(Parameter::Network, value, "of two places or more"));
        }
        match self.max_distance {
            Some(limit) if !(limit > 0.0 && limit.is_finite()) => {
                Err(Error::invalid(Parameter::MaxDistance, limit, "finite and above zero metres"))
            }
            _ => Ok(()),
        }
    }
}

impl SightNetwork {
    /// The pairs of `places` within the maximum distance.
    pub(super) fn new(places: Vec<[f64; 3]>, given: &NetworkPlaces, control: &Control<'_>) -> Result<Self> {
        let limit = given.max_distance.unwrap_or(f64::INFINITY);
        let reach = [0, 1].map(|axis| {
            let values = || places.iter().map(|place| place[axis]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        });
        let long = usize::from(reach[1] > reach[0]);
        let mut in_order: Vec<usize> = (0..places.len()).collect();
        in_order.sort_by(|&a, &b| places[a][long].total_cmp(&places[b][long]));
        let mut pairs = Vec::new();
        for (rank, &a) in in_order.iter().enumerate() {
            control.check()?;
            let along = |b: usize, axis: usize| places[b][axis] - places[a][axis];
            let beside = in_order[rank + 1..].iter().take_while(|&&b| along(b, long) <= limit);
            let near = beside.filter(|&&b| along(b, 0).hypot(along(b, 1)) <= limit);
            pairs.extend(near.map(|&b| [a.min(b), a.max(b)]));
            if pairs.len() > MAX_PAIRS {
                let expected = "of at most 10 million pairs: give fewer places, or a maximum distance";
                return Err(Error::invalid(Parameter::Network, format!("of {} places", places.len()), expected));
            }
        }
        if let (true, Some(limit)) = (pairs.is_empty(), given.max_distance) {
            let expected = "at least the distance of the two nearest places, metres: no pair is nearer";
            return Err(Error::invalid(Parameter::MaxDistance, limit, expected));
        }
        pairs.sort_unstable();
        let name = |row: usize| match given.names.get(row).filter(|name| !name.is_empty()) {
            Some(name) => name.clone(),
            None => (row + 1).to_string(),
        };
        let names = (0..places.len()).map(name).collect();
        Ok(Self { places, names, pairs, ..Self::default() })
    }

    /// Both ends of each pair, local metres.
    pub(super) fn lines(&self) -> Vec<[[f64; 3]; 2]> {
        self.pairs.iter().map(|pair| pair.map(|row| self.places[row])).collect()
    }

    /// A warning of places inside an obstacle, which see nothing.
    pub(super) fn remark_on_inside(&self, blockers: &MedialScene) -> Option<Remark> {
        let is_inside = |row: &usize| blockers.is_inside_obstacle(self.places[*row]);
        let inside: Vec<usize> = (0..self.places.len()).filter(is_inside).collect();
        let mut named: Vec<&str> = inside.iter().take(MAX_NAMED).map(|&row| &self.names[row][..]).collect();
        if named.len() < inside.len() {
            named.push("…");
        }
        let so = format!("are inside an obstacle, and see no other: {}", named.join(", "));
        Remark::of_share("places-inside-obstacle", inside.len(), self.places.len(), "places", &so)
    }

    /// Counts the links of each place and finds the groups.
    pub(super) fn count_links(&mut self, answers: &[Answer]) {
        self.link_counts = vec![0; self.places.len()];
        let mut groups: Vec<usize> = (0..self.places.len()).collect();
        for (&[a, b], answer) in self.pairs.iter().zip(answers) {
            if *answer == Answer::Visible {
                self.link_counts[a] += 1;
                self.link_counts[b] += 1;
                let [a, b] = [root(&mut groups, a), root(&mut groups, b)];
                groups[a.max(b)] = a.min(b);
            }
        }
        // the root of a group is its first place
        let mut numbers = vec![0; groups.len()];
        let mut next = 0;
        for row in 0..groups.len() {
            let root = root(&mut groups, row);
            if root == row {
                numbers[row] = next;
                next += 1;
            }
            numbers[row] = numbers[root];
        }
        self.groups = numbers;
    }
}

/// The root of a place in a forest of parents, whose paths it halves.
fn root(parents: &mut [usize], mut row: usize) -> usize {
    while parents[row] != row {
        parents[row] = parents[parents[row]];
        row = parents[row];
    }
    row
}

impl NetworkSection {
    pub(super) fn of(network: &SightNetwork, answers: &[Answer]) -> Self {
        let lines = network.lines();
        let lengths: Vec<f64> = lines
            .iter()
            .zip(answers)
            .filter(|(_, answer)| **answer == Answer::Visible)
            .map(|(&[a, b], _)| length(sub(b, a)))
            .collect();
        let group_count = network.groups.iter().max().map_or(0, |last| last + 1);
        let mut sizes = vec![0; group_count];
        network.groups.iter().for_each(|&group| sizes[group] += 1);
        let most = (0..network.places.len()).rev().max_by_key(|&row| network.link_counts[row]);
        let most = most.map(|row| (network.names[row].clone(), network.link_counts[row]));
        Self {
            places: network.places.len(),
            links: lengths.len(),
            links_percent: percent(lengths.len(), answers.len()),
            groups: group_count,
            largest_group: sizes.iter().copied().max().unwrap_or(0),
            places_without_link: network.link_counts.iter().filter(|&&count| count == 0).count(),
            max_links: most.filter(|(_, count)| *count > 0),
            mean_link_m: (!lengths.is_empty()).then(|| rounded(lengths.iter().sum::<f64>() / lengths.len() as f64, 2)),
        }
    }

    pub(super) fn headline(&self) -> String {
        let Self { places, groups, largest_group, places_without_link, .. } = self;
        let most = match &self.max_links {
            Some((name, count)) => format!("; {name} sees the most: {count}"),
            None => String::new(),
        };
        let alone = match places_without_link {
            0 => String::new(),
            1 => ", 1 sees no other".to_owned(),
            count => format!(", {count} see no other"),
        };
        match groups {
            1 => format!("all {places} places are linked, directly or through others{most}"),
            _ => format!("{places} places in {groups} groups, the largest of {largest_group}{alone}{most}"),
        }
    }
}

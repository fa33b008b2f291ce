//! Divisions of many items by a binned surface area heuristic on each axis (I. Wald, *On fast Construction of SAH-based Bounding Volume
//! Hierarchies*, IEEE Symposium on Interactive Ray Tracing, 2007).

use super::item::{Extremes, Item, whole};
use super::left::{Left, Scratch};
use super::shape::Shape;

/// Bins of the sweep that looks for a split.
const BINS: usize = 8;

/// Bins in which items are marked, as many in each of [`BINS`].
const FINE: usize = 64;

/// Either part holds at least this part of the items, so that the depth stays logarithmic.
const MIN_PART: usize = 32;

/// A split is looked for among about so many items, and among twice as many of clusters and blocks, of which there are fewer; among more,
/// the best split changes little. The step from one to the next is odd, as meshes come in pairs and fours.
const SAMPLE: usize = 128;

/// Divides items as [`Shape::divide`] says.
#[inline(always)]
pub fn divide_many(shape: &Shape, items: &[Item], scratch: &mut Scratch, left: Left) -> usize {
    let len = items.len();
    let packet = if let Left::Whole(packet) = left { packet } else { 1 };
    let even = |left: usize| {
        let left = left.clamp(len / MIN_PART, len - len / MIN_PART);
        ((left + packet / 2) / packet * packet).clamp(packet, (len - 1) / packet * packet)
    };
    let sample = if packet > 1 { SAMPLE } else { 2 * SAMPLE };
    let Some((bins, split)) = best(shape, items, (len / sample) | 1, left) else {
        scratch.items[..len].copy_from_slice(items);
        return even(len / 2);
    };
    let marks = &mut scratch.marks[..len];
    let counts = bins.mark(items, marks);
    let wanted = even(match split {
        Some(Split { place: Place::Bin(bin), .. }) => {
            counts[..bin * (FINE / BINS)].iter().sum::<u32>() as usize
        }
        Some(Split { place: Place::Items(items), .. }) => items,
        None => len / 2,
    });
    partition(items, &mut scratch.items[..len], marks, &counts, wanted);
    wanted
}

/// The best split among every `stride`th item, and the bins on its axis; no split if all are in one bin, and no bins where their
/// centres coincide.
#[inline(always)]
fn best(shape: &Shape, items: &[Item], stride: usize, left: Left) -> Option<(Bins, Option<Split>)> {
    let mut all = Extremes::NONE;
    for item in items.iter().step_by(stride) {
        all.gather(&item.centers());
    }
    let bounds = all.bounds();
    let bins = |axis: usize| {
        let width = bounds.max[axis] - bounds.min[axis];
        (width > 1e-7).then(|| Bins { axis, from: bounds.min[axis], scale: (FINE - 1) as f32 / width })
    };
    let mut best: Option<(Bins, Option<Split>)> = None;
    for axis in 0..3 {
        let Some(bins) = bins(axis) else { continue };
        let split = bins.sweep(shape, items, stride, left);
        let cost = |split: &Option<Split>| split.as_ref().map_or(f32::INFINITY, |split| split.cost);
        if best.as_ref().is_none_or(|(_, best)| cost(&split) < cost(best)) {
            best = Some((bins, split));
        }
    }
    best
}

/// The best split on an axis.
struct Split {
    /// The parts' surfaces, each times what is in it.
    cost: f32,
    place: Place,
}

/// Where to split.
enum Place {
    /// Before a bin.
    Bin(usize),
    /// After so many items.
    Items(usize),
}

/// Bins of equal width over the range of centres on an axis.
struct Bins {
    axis: usize,
    from: f32,
    /// Bins per unit.
    scale: f32,
}

/// What is from a bin on.
#[derive(Clone, Copy)]
struct Rest {
    range: Extremes,
    weight: u32,
}

impl Bins {
    /// The bin of an item, the outermost for those beyond.
    #[inline(always)]
    fn of(&self, item: &Item) -> usize {
        let last = (FINE - 1) as f32;
        let place = (item.center(self.axis) - self.from) * self.scale;
        let place = if place > 0.0 { place } else { 0.0 };
        whole(if place < last { place } else { last }) as usize & (FINE - 1)
    }

    /// Marks each item with its bin and counts them.
    #[inline(always)]
    fn mark(&self, items: &[Item], marks: &mut [u8]) -> [u32; FINE] {
        let mut counts = [[0u32; FINE]; 2];
        for (i, (item, mark)) in items.iter().zip(marks).enumerate() {
            let bin = self.of(item);
            *mark = bin as u8;
            counts[i & 1][bin] += 1;
        }
        let [mut counts, others] = counts;
        counts.iter_mut().zip(others).for_each(|(count, other)| *count += other);
        counts
    }

    /// The best split among every `stride`th item; `None` if all are in one bin.
    #[inline(always)]
    fn sweep(&self, shape: &Shape, items: &[Item], stride: usize, left: Left) -> Option<Split> {
        // Items take turns between two sets, as neighbours tend to share a bin and would wait for each other.
        let mut ranges = [[Extremes::NONE; BINS]; 2];
        let mut weights = [[0u32; BINS]; 2];
        for (i, item) in items.iter().step_by(stride).enumerate() {
            let bin = (self.of(item) / (FINE / BINS)) & (BINS - 1);
            weights[i & 1][bin] += item.weight();
            ranges[i & 1][bin].gather(&item.extremes());
        }
        let [mut ranges, others] = ranges;
        let [mut weights, other_weights] = weights;
        let mut rests = [Rest { range: Extremes::NONE, weight: 0 }; BINS];
        let (mut range, mut weight) = (Extremes::NONE, 0u32);
        for bin in (0..BINS).rev() {
            ranges[bin].gather(&others[bin]);
            weights[bin] = (weights[bin] + other_weights[bin]) * stride as u32;
            range.gather(&ranges[bin]);
            weight += weights[bin];
            rests[bin] = Rest { range, weight };
        }
        let (mut range, mut weight) = (Extremes::NONE, 0u32);
        let mut best = Split { cost: f32::INFINITY, place: Place::Bin(0) };
        let mut offer = |cost: f32, place: Place| {
            if cost < best.cost {
                best = Split { cost, place };
            }
        };
        if let Left::Whole(packet) = left {
            let (packet, total) = (packet as u32, rests[0].weight);
            let cost = |[left, right]: [&Extremes; 2], cut: u32| {
                shape.area(&left.bounds()) * cut as f32 + shape.area(&right.bounds()) * (total - cut) as f32
            };
            for bin in 0..BINS {
                // A cut within the bin: what is in it counts for both parts.
                let cut = weight.max(1).next_multiple_of(packet);
                weight += weights[bin];
                range.gather(&ranges[bin]);
                if cut <= weight && cut < total {
                    offer(cost([&range, &rests[bin].range], cut), Place::Items(cut as usize));
                }
                // A cut at its end, as nearly as a sample can tell.
                let cut = (weight + packet / 2) / packet * packet;
                if cut.abs_diff(weight) <= packet / 8 && (1..total).contains(&cut) && bin + 1 < BINS {
                    offer(cost([&range, &rests[bin + 1].range], cut), Place::Items(cut as usize));
                }
            }
        } else {
            // In quarters of packets, so that splits within a few packets tell apart.
            let quarter = if let Left::Packed(packet) = left { packet.div_ceil(4) as u32 } else { 1 };
            let cost =
                |range: &Extremes, weight: u32| shape.area(&range.bounds()) * weight.div_ceil(quarter) as f32;
            for bin in 1..BINS {
                range.gather(&ranges[bin - 1]);
                weight += weights[bin - 1];
                let rest = &rests[bin];
                if weight > 0 && rest.weight > 0 {
                    offer(cost(&range, weight) + cost(&rest.range, rest.weight), Place::Bin(bin));
                }
            }
        }
        (best.cost < f32::INFINITY).then_some(best)
    }
}

/// Copies the items so that the first `left` in the order of marks are at the front, both parts in the order they
/// were; `counts` are those of the marks.
#[inline(always)]
fn partition(items: &[Item], out: &mut [Item], marks: &[u8], counts: &[u32; FINE], left: usize) {
    let (mut cut, mut rest) = (0, left as u32);
    while cut < FINE - 1 && counts[cut] <= rest {
        rest -= counts[cut];
        cut += 1;
    }
    let (len, cut) = (items.len(), cut as u8);
    // Of the bin that is cut, the items before `stop` belong left.
    let mut stop = 0;
    while rest > 0 {
        rest -= u32::from(marks[stop] == cut);
        stop += 1;
    }
    // The next place for each part: as many as came before belong to one or the other.
    let (mut first, mut at) = (0, 0);
    for (range, end) in [(0..stop, cut + 1), (stop..len, cut)] {
        for (item, mark) in items[range.clone()].iter().zip(&marks[range]) {
            // Chosen rather than branched on: which side it is can't be foreseen.
            let is_first = *mark < end;
            out[std::hint::select_unpredictable(is_first, first, left + at - first)] = *item;
            first += usize::from(is_first);
            at += 1;
        }
    }
}

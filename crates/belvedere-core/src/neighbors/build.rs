//! Building of the tree: split at the median of the longest extent down to full leaves, then boxes from the leaves up.

use super::lanes::{Child, LANES, LaneBlock, PointTree, WideNode};
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};

/// Points in a full leaf: four blocks, the most a [`Child`] names.
const LEAF_POINTS: usize = 32;
/// Below this many points a thread goes on alone.
const PARALLEL_POINTS: usize = 16_384;

#[derive(Clone, Copy)]
struct Item {
    point: [f32; 3],
    index: u32,
}

type BoxCorners = ([f32; 3], [f32; 3]);

/// Builds the tree of points.
pub(super) fn build(points: &[[f32; 3]], control: &Control<'_>) -> Result<PointTree> {
    let stop = Stop::new(control);
    let mut items: Vec<Item> = points.iter().zip(0..).map(|(&point, index)| Item { point, index }).collect();
    sort_to_leaves(&mut items, &stop, control);
    stop.check()?;
    let tree = fit(&items);
    control.check()?;
    Ok(tree)
}

/// Builds the tree of points that moved a little. It keeps `order`, that of the tree before.
pub(super) fn refit(points: &[[f32; 3]], order: &[u32]) -> PointTree {
    let items: Vec<Item> = order.iter().map(|&index| Item { point: points[index as usize], index }).collect();
    fit(&items)
}

/// The tree of points in its order.
fn fit(items: &[Item]) -> PointTree {
    let blocks = items
        .chunks(LANES)
        .map(|chunk| {
            // lanes without a point lie infinitely far away and pass no test
            let mut block = LaneBlock::filled(f32::INFINITY);
            chunk.iter().enumerate().for_each(|(lane, item)| block.set(lane, item.point));
            block
        })
        .collect();
    let mut nodes = Vec::with_capacity(items.len() / (LEAF_POINTS * 4) + 1);
    add_node(items, 0, &mut nodes);
    PointTree { nodes, blocks, order: items.iter().map(|item| item.index).collect() }
}

/// Returns the length of the first of two runs of whole leaves, as equal as possible.
fn cut(count: usize) -> usize {
    count.div_ceil(LEAF_POINTS) / 2 * LEAF_POINTS
}

/// Sorts points into leaves. If the work is cancelled, the result is in no order.
fn sort_to_leaves(items: &mut [Item], stop: &Stop<'_>, control: &Control<'_>) {
    if items.len() <= LEAF_POINTS || (items.len() > PARALLEL_POINTS && stop.is_set()) {
        return;
    }
    let (low, high) = bounds(items);
    let extent = |axis: usize| high[axis] - low[axis];
    let axis = (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest });
    let middle = cut(items.len());
    // ties by index make the tree independent of how the selection works
    items.select_nth_unstable_by(middle, |a, b| {
        a.point[axis].total_cmp(&b.point[axis]).then_with(|| a.index.cmp(&b.index))
    });
    let (left, right) = items.split_at_mut(middle);
    if left.len() + right.len() > PARALLEL_POINTS {
        rayon::join(|| sort_to_leaves(left, stop, control), || sort_to_leaves(right, stop, control));
    } else {
        sort_to_leaves(left, stop, control);
        sort_to_leaves(right, stop, control);
        if left.len() + right.len() > PARALLEL_POINTS / 2 {
            control.advance(left.len() + right.len());
        }
    }
}

fn bounds(items: &[Item]) -> BoxCorners {
    items.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), item| {
        (std::array::from_fn(|i| low[i].min(item.point[i])), std::array::from_fn(|i| high[i].max(item.point[i])))
    })
}

/// Appends the node over `items`, whose first point sits in slot `first`, and everything below it; returns its box.
fn add_node(items: &[Item], first: usize, nodes: &mut Vec<WideNode>) -> BoxCorners {
    let node_index = nodes.len();
    nodes.push(WideNode {
        low: LaneBlock::filled(f32::INFINITY),
        high: LaneBlock::filled(f32::NEG_INFINITY),
        children: [Child::node(0); LANES],
    });
    let mut runs = vec![items];
    // three rounds of halving make eight children
    for _ in 0..3 {
        runs = runs
            .into_iter()
            .flat_map(|run| {
                let (left, right) = run.split_at(if run.len() > LEAF_POINTS { cut(run.len()) } else { run.len() });
                [left, right]
            })
            .filter(|run| !run.is_empty())
            .collect();
    }
    let mut whole = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    let mut slot = first;
    for (lane, run) in runs.into_iter().enumerate() {
        let (child, (low, high)) = if run.len() > LEAF_POINTS {
            (Child::node(nodes.len()), add_node(run, slot, nodes))
        } else {
            (Child::leaf(slot / LANES, run.len().div_ceil(LANES)), bounds(run))
        };
        let node = &mut nodes[node_index];
        node.children[lane] = child;
        node.low.set(lane, low);
        node.high.set(lane, high);
        for i in 0..3 {
            whole.0[i] = whole.0[i].min(low[i]);
            whole.1[i] = whole.1[i].max(high[i]);
        }
        slot += run.len();
    }
    whole
}

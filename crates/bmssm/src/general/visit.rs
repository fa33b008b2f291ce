//! Rays at a node.

use super::scratch::Waiting;
use super::state::NodeView;
use super::tree::{Node, WIDTH};
use lanes::{Lists, ROW, SHARE, Simd, Task};

/// Sorts the rays to the children that they meet, and puts these on the stack, the one that they enter first on top.
pub(super) struct Visit<'a, W> {
    pub node: &'a Node,
    /// Which coordinates of the rays' directions are negative.
    pub negative: &'a [bool; 3],
    pub at: Waiting,
    pub ways: &'a [W],
    pub lists: &'a mut Vec<u16>,
    pub stack: &'a mut Vec<Waiting>,
}

impl<W: NodeView> Task for Visit<'_, W> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { node, negative, at, ways, lists, stack } = self;
        let (first, len, top) = (at.first as usize, at.len as usize, at.top as usize);
        let stride = len.next_multiple_of(SHARE) + SHARE;
        let end = top + WIDTH * stride;
        if lists.len() < end {
            lists.resize(2 * end, 0);
        }
        let (before, after) = lists.split_at_mut(top);
        let mut lens = [0; WIDTH];
        let mut sums = [0.0; ROW];
        for list in before[first..first + len].chunks(SHARE) {
            let (mut ids, mut marks) = ([0; SHARE], [0; SHARE]);
            ids[..list.len()].copy_from_slice(list);
            for lane in (0..WIDTH).step_by(S::LANES) {
                let side = |axis: usize, far: bool| if negative[axis] == far { axis } else { axis + 3 };
                let mut near = [s.splat(0.0); 3];
                let mut far = near;
                for axis in 0..3 {
                    near[axis] = s.load(&node.boxes[side(axis, false)].0[lane..]);
                    far[axis] = s.load(&node.boxes[side(axis, true)].0[lane..]);
                }
                let mut sum = s.load(&sums[lane..]);
                for (id, marks) in list.iter().zip(&mut marks) {
                    let way = &ways[usize::from(*id)];
                    let (first, last) = (way.near(), way.far());
                    let mut enter = s.splat(0.0);
                    let mut exit = s.splat(first.start[3]);
                    for axis in 0..3 {
                        let (start, inverse) = (s.splat(first.start[axis]), s.splat(first.inverse[axis]));
                        enter = s.max(enter, s.mul(s.sub(near[axis], start), inverse));
                        let (start, inverse) = (s.splat(last.start[axis]), s.splat(last.inverse[axis]));
                        exit = s.min(exit, s.mul(s.sub(far[axis], start), inverse));
                    }
                    let met = s.le(enter, exit);
                    *marks |= (s.bits(met) << lane) as u16;
                    sum = s.add(sum, s.select(met, enter, s.splat(0.0)));
                }
                s.store(sum, &mut sums[lane..]);
            }
            s.distribute(&ids, &marks, &mut Lists { ids: after, stride, lens: &mut lens });
        }
        // The last first.
        let begin = stack.len();
        for child in 0..WIDTH {
            if lens[child] > 0 {
                sums[child] /= lens[child] as f32;
                let waiting = Waiting {
                    what: child as u32,
                    first: (top + child * stride) as u32,
                    len: lens[child],
                    top: end as u32,
                };
                let mut place = stack.len();
                stack.push(waiting);
                while place > begin && sums[stack[place - 1].what as usize] < sums[child] {
                    stack[place] = stack[place - 1];
                    place -= 1;
                }
                stack[place] = waiting;
            }
        }
        for waiting in &mut stack[begin..] {
            waiting.what = node.children[waiting.what as usize];
        }
    }
}

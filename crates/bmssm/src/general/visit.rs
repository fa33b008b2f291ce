//! Rays at a node.

use super::scratch::Waiting;
use super::state::NodeView;
use super::tree::{Node, WIDTH};
use lanes::{Lists, ROW, SHARE, Simd, Task};

/// Sorts the rays to the children that they meet, and puts these on the stack, the one that they enter first on top; `MIXED` rays differ in octant.
pub(super) struct Visit<'a, W, const MIXED: bool> {
    pub node: &'a Node,
    /// Which coordinates of the rays' directions are negative, unless they are mixed.
    pub negative: &'a [bool; 3],
    pub at: Waiting,
    pub ways: &'a [W],
    pub lists: &'a mut Vec<u16>,
    pub stack: &'a mut Vec<Waiting>,
}

impl<W: NodeView, const MIXED: bool> Task for Visit<'_, W, MIXED> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { node, negative, at, ways, lists, stack } = self;
        let (first, len, top) = (at.first as usize, at.len as usize, at.top as usize);
        let stride = len.next_multiple_of(SHARE) + SHARE;
        let end = top + WIDTH * stride;
        if lists.len() < end {
            lists.resize(end + end / 4, 0);
        }
        let (before, after) = lists.split_at_mut(top);
        let mut lens = [0; WIDTH];
        let mut sums = [0.0; ROW];
        for list in before[first..first + len].chunks(SHARE) {
            let (mut ids, mut marks) = ([0; SHARE], [0; SHARE]);
            ids[..list.len()].copy_from_slice(list);
            for lane in (0..WIDTH).step_by(S::LANES) {
                let side = |axis: usize, far: bool| if negative[axis] == far { axis } else { axis + 3 };
                let mut nearer = [s.splat(0.0); 3];
                let mut farther = nearer;
                for axis in 0..3 {
                    nearer[axis] = s.load(&node.boxes[side(axis, false)].0[lane..]);
                    farther[axis] = s.load(&node.boxes[side(axis, true)].0[lane..]);
                }
                let mut sum = s.load(&sums[lane..]);
                for (id, marks) in list.iter().zip(&mut marks) {
                    let way = &ways[usize::from(*id)];
                    let (first, last) = (way.near(), way.far());
                    let mut enter = s.splat(0.0);
                    let mut exit = s.splat(first.start[3]);
                    for axis in 0..3 {
                        let (near, far) = if MIXED {
                            // Looked up by sign rather than branched on: which way a ray goes can't be foreseen.
                            let sides = [&node.boxes[axis], &node.boxes[axis + 3]];
                            let backwards = usize::from(first.inverse[axis].is_sign_negative());
                            (s.load(&sides[backwards].0[lane..]), s.load(&sides[1 - backwards].0[lane..]))
                        } else {
                            (nearer[axis], farther[axis])
                        };
                        let (start, inverse) = (s.splat(first.start[axis]), s.splat(first.inverse[axis]));
                        enter = s.max(enter, s.mul(s.sub(near, start), inverse));
                        let (start, inverse) = (s.splat(last.start[axis]), s.splat(last.inverse[axis]));
                        exit = s.min(exit, s.mul(s.sub(far, start), inverse));
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

//! Tracing rays through bit maps.

use super::detail::Detail;
use super::levels::Descent;
use super::{ImageMaps, SpaceMaps};
use accel::dda::Walk;
use accel::parallel::for_each_chunk;
use accel::{Accel, Count, Counters, Footprint, Hit, Nearest, NoCount, Objects, Ray, RaySet};
use lanes::{Level, Portable, Simd, Task};

/// Rays traced by one task of the thread pool.
const CHUNK: usize = 1024;

/// The maps a workload asked for, and the detail tests.
pub struct Built<O, D> {
    pub all: O,
    pub detail: D,
    pub image: Option<ImageMaps>,
    pub space: Option<SpaceMaps>,
    pub objects: usize,
    pub simd: Level,
    pub mailbox: bool,
    /// Whether rays of any kind are served, which takes no maps where there is no object.
    pub general: bool,
    pub plan: String,
}

/// What is asked of a ray.
trait Answer: Send + Sized {
    /// Any hit will do.
    const ANY: bool;
    type Count: Count;
    fn new(best: &Nearest, count: Self::Count) -> Self;
}

impl Answer for Option<Hit> {
    const ANY: bool = false;
    type Count = NoCount;
    fn new(best: &Nearest, _: NoCount) -> Self {
        best.hit()
    }
}

impl Answer for bool {
    const ANY: bool = true;
    type Count = NoCount;
    fn new(best: &Nearest, _: NoCount) -> Self {
        best.hit().is_some()
    }
}

#[derive(Clone, Copy, Default)]
struct Counted<const ANY: bool>(Counters);

impl<const ANY: bool> Answer for Counted<ANY> {
    const ANY: bool = ANY;
    type Count = Counters;
    fn new(_: &Nearest, count: Counters) -> Self {
        Self(count)
    }
}

/// Words of an image that are looked at together: most are empty, and one branch passes over all of them.
const GROUP: usize = 8;

/// Whether ⁱR & ʲS is empty in all words of a whole group.
#[inline(always)]
fn nothing(r: &[u64], s: &[u64]) -> bool {
    let (Some(r), Some(s)) = (r.first_chunk::<GROUP>(), s.first_chunk::<GROUP>()) else {
        return false;
    };
    let mut both = 0;
    for (r, s) in r.iter().zip(s) {
        both |= r & s;
    }
    both == 0
}

/// Which maps serve a set of rays.
#[derive(Clone, Copy)]
enum Route<'a> {
    Pixels(&'a ImageMaps),
    Cells(&'a SpaceMaps),
    Nothing,
}

/// A ray under way.
struct State<R, C> {
    ray: R,
    best: Nearest,
    count: C,
}

impl<O: Objects, D: Detail> Built<O, D> {
    /// Tests the candidates of a word; whether to go on.
    #[inline(always)]
    fn word<S: Simd, A: Answer>(
        &self,
        s: S,
        index: usize,
        word: u64,
        state: &mut State<D::Ray, A::Count>,
    ) -> bool {
        if word == 0 {
            return true;
        }
        state.count.tests(word.count_ones().into());
        if !A::ANY {
            self.detail.closest(s, index, word, &state.ray, &mut state.best);
        } else if self.detail.any(s, index, word, &state.ray, state.best.t) {
            state.best.object = 0;
            return false;
        }
        true
    }

    /// ⁱR & ʲS, word by word.
    #[inline(always)]
    fn pixel<S: Simd, A: Answer>(&self, s: S, maps: &ImageMaps, row: u32, col: u32) -> A {
        let ray = maps.raster.ray(row, col);
        let mut state =
            State { ray: self.detail.ray(&ray), best: Nearest::new(ray.t_max), count: A::Count::default() };
        let rows = maps.rows.slice(row).chunks(GROUP);
        let cols = maps.cols.slice(col).chunks(GROUP);
        'words: for (group, (r, s_words)) in rows.zip(cols).enumerate() {
            if nothing(r, s_words) {
                state.count.words(2 * GROUP as u64);
                continue;
            }
            for (i, (r, s_word)) in r.iter().zip(s_words).enumerate() {
                let word = r & s_word;
                state.count.words(2);
                state.count.candidates(word.count_ones().into());
                if !self.word::<S, A>(s, group * GROUP + i, word, &mut state) {
                    break 'words;
                }
            }
        }
        self.detail.resolve(&state.ray, &mut state.best);
        A::new(&state.best, state.count)
    }

    /// Tests the candidates of a word of ⁱR & ʲS & ᵏT; whether to go on.
    #[inline(always)]
    fn of_cell<S: Simd, A: Answer>(
        &self,
        s: S,
        index: usize,
        mut word: u64,
        state: &mut State<D::Ray, A::Count>,
        tested: &mut [u64],
    ) -> bool {
        state.count.words(3);
        state.count.candidates(word.count_ones().into());
        if self.mailbox {
            word &= !tested[index];
            tested[index] |= word;
        }
        self.word::<S, A>(s, index, word, state)
    }

    /// ⁱR & ʲS & ᵏT in every cell on the ray's way, until a hit comes before the next cell.
    #[inline(always)]
    fn cells<S: Simd, A: Answer>(&self, s: S, maps: &SpaceMaps, ray: &Ray, tested: &mut [u64]) -> A {
        let mut state =
            State { ray: self.detail.ray(ray), best: Nearest::new(ray.t_max), count: A::Count::default() };
        let Some(segment) = maps.grid.clip(ray) else {
            return A::new(&state.best, state.count);
        };
        tested.fill(0);
        let mut known = state.best.t;
        let mut limit = f32::INFINITY;
        'walk: for cell in Walk::new(&maps.grid, &segment) {
            if state.best.t != known {
                known = state.best.t;
                limit = segment.limit(known);
            }
            if cell.enter > limit {
                break;
            }
            state.count.cells(1);
            let [r, s_words, t] = maps.cell(cell.slice);
            if maps.above.is_empty() {
                for (index, ((r, s_word), t)) in r.iter().zip(s_words).zip(t).enumerate() {
                    if !self.of_cell::<S, A>(s, index, r & s_word & t, &mut state, tested) {
                        break 'walk;
                    }
                }
            } else {
                let mut descent = Descent::new(maps, cell.slice, &mut state.count);
                while let Some(index) = descent.next(&mut state.count) {
                    let word = r[index] & s_words[index] & t[index];
                    if !self.of_cell::<S, A>(s, index, word, &mut state, tested) {
                        break 'walk;
                    }
                }
            }
        }
        self.detail.resolve(&state.ray, &mut state.best);
        A::new(&state.best, state.count)
    }

    fn route(&self, rays: &RaySet) -> Route<'_> {
        match (&self.image, rays) {
            (Some(maps), RaySet::Raster(raster)) if maps.raster == *raster => Route::Pixels(maps),
            _ => self.general_route(),
        }
    }

    fn general_route(&self) -> Route<'_> {
        assert!(self.general, "built for the rays of one image only");
        self.space.as_ref().map_or(Route::Nothing, Route::Cells)
    }

    fn trace_all<A: Answer>(&self, rays: &RaySet, out: &mut [A]) {
        assert_eq!(rays.len(), out.len(), "one place for each ray");
        let route = self.route(rays);
        for_each_chunk(out, CHUNK, &|chunk, out| {
            self.detail.run(self.simd, Chunk { built: self, rays, route, first: chunk * CHUNK, out });
        });
    }

    fn count_all<const ANY: bool>(&self, rays: &RaySet) -> Counters {
        let mut counted = vec![Counted::<ANY>::default(); rays.len()];
        let route = self.route(rays);
        // The same steps at every level: one is enough.
        for_each_chunk(&mut counted, CHUNK, &|chunk, out| {
            Chunk { built: self, rays, route, first: chunk * CHUNK, out }.run(Portable);
        });
        let mut sum = Counters::default();
        counted.iter().for_each(|Counted(one)| sum.merge(one));
        sum
    }

    fn one<A: Answer + Copy>(&self, ray: &Ray, none: A) -> A {
        let mut out = [none];
        let route = self.general_route();
        let rays = RaySet::List(vec![*ray]);
        self.detail.run(self.simd, Chunk { built: self, rays: &rays, route, first: 0, out: &mut out });
        out[0]
    }
}

/// Rays `first ..` of a set, as many as there are answers to write.
struct Chunk<'a, O, D, A> {
    built: &'a Built<O, D>,
    rays: &'a RaySet,
    route: Route<'a>,
    first: usize,
    out: &'a mut [A],
}

impl<O: Objects, D: Detail, A: Answer> Task for Chunk<'_, O, D, A> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let Self { built, rays, route, first, out } = self;
        match route {
            Route::Pixels(maps) => {
                let cols = maps.raster.cols as usize;
                for (index, out) in (first..).zip(out) {
                    *out = built.pixel(s, maps, (index / cols) as u32, (index % cols) as u32);
                }
            }
            Route::Cells(maps) => {
                let mut tested = vec![0; if built.mailbox { built.objects.div_ceil(64) } else { 0 }];
                for (index, out) in (first..).zip(out) {
                    *out = built.cells(s, maps, &rays.ray(index), &mut tested);
                }
            }
            Route::Nothing => {
                for (index, out) in (first..).zip(out) {
                    let ray = rays.ray(index);
                    *out = A::new(&Nearest::new(ray.t_max), A::Count::default());
                }
            }
        }
    }
}

impl<O: Objects, D: Detail> Accel for Built<O, D> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.one(ray, None)
    }

    fn occluded(&self, ray: &Ray) -> bool {
        self.one(ray, false)
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        self.trace_all(rays, hits);
    }

    fn trace_occluded(&self, rays: &RaySet, occluded: &mut [bool]) {
        self.trace_all(rays, occluded);
    }

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        self.gather(ray, found);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.all, ray)
    }

    fn footprint(&self) -> Footprint {
        let mut footprint = Footprint::default();
        if let Some(maps) = &self.image {
            footprint = footprint
                .structure("row maps", maps.rows.bytes())
                .structure("column maps", maps.cols.bytes());
        }
        if let Some(maps) = &self.space {
            let [x, y, z] = [0, 1, 2].map(|axis| maps.axes[axis].bytes());
            footprint = footprint.structure("x maps", x).structure("y maps", y).structure("z maps", z);
        }
        match self.detail.bytes() {
            0 => footprint,
            bytes => footprint.geometry_copy("blocks", bytes),
        }
    }

    fn plan(&self) -> String {
        self.plan.clone()
    }

    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        Some(if occlusion { self.count_all::<true>(rays) } else { self.count_all::<false>(rays) })
    }
}

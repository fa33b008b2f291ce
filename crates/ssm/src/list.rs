//! `ssm-list`: a counter, a pointer and a list of ids in each cell (Skala 1993, §5).

use crate::register::{Limit, Word, register};
use crate::resolution::Resolution;
use crate::settings::Settings;
use accel::dda::Walk;
use accel::grid::Grid;
use accel::{
    Accel, Bounds, BuildError, BuildResult, Builder, Cancel, Count, Counters, Footprint, Hit, Nearest,
    NoCount, Objects, Ray, RaySet, Scene, Workload, for_each_ray,
};
use lanes::{PackedObjects, Simd, Task};
use primitives::WithObjects;

const ID: &str = "ssm-list";

/// Builds `ssm-list`, the paper's grid.
///
/// Counters and ids take 2 bytes each where all of them fit, else 4; a pointer is a
/// position among all ids and takes 4 bytes, since 2 (the paper's figure) would reach only 65,536 of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SsmList {
    /// The settings.
    pub settings: Settings,
    /// Whether a ray passes over objects that it tested lately. The paper tells of no such thing.
    pub mailbox: bool,
}

impl Default for SsmList {
    /// Four cells for each object.
    fn default() -> Self {
        Self::new(Settings::new(Resolution::Density(4.0)))
    }
}

impl SsmList {
    /// Names and meanings, for help texts.
    pub const NAMES: [(&str, &str); 6] = {
        let [kernel, simd, resolution, density, memory] = Settings::NAMES;
        let mailbox =
            ("mailbox", "on: test no object twice for a ray, as far as 16 places tell; off: as in the paper");
        [kernel, simd, resolution, density, mailbox, memory]
    };

    /// As in the paper, without a mailbox.
    pub fn new(settings: Settings) -> Self {
        Self { settings, mailbox: false }
    }

    /// Changes one setting, see [`SsmList::NAMES`].
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), BuildError> {
        if name == "mailbox" {
            let error = |problem| BuildError::Setting { structure: ID.into(), setting: name.into(), problem };
            self.mailbox = accel::settings::switch(value).map_err(error)?;
            return Ok(());
        }
        self.settings.set(ID, name, value)
    }
}

impl Builder for SsmList {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        format!("{} mailbox={}", self.settings.display(), if self.mailbox { "on" } else { "off" })
    }

    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> BuildResult<'s> {
        self.build_unless(scene, workload, Cancel::NEVER)
    }

    fn build_unless<'s>(&self, scene: &'s Scene, _: &Workload, cancel: Cancel) -> BuildResult<'s> {
        primitives::with_objects(scene, self.settings.kernel, Build(*self, cancel))
    }
}

struct Build<'c>(SsmList, Cancel<'c>);

impl<'s> WithObjects<'s> for Build<'_> {
    type Out = BuildResult<'s>;
    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        if objects.len() <= usize::from(u16::MAX) {
            Ok(Box::new(Built::<O, u16>::new(objects, &objects.shape(), &self.0, self.1)?))
        } else {
            Ok(Box::new(Built::<O, u32>::new(objects, &objects.shape(), &self.0, self.1)?))
        }
    }
}

/// An id, or a number of ids.
trait Id: Copy + Send + Sync {
    fn narrow(value: u32) -> Self;
    fn widen(self) -> u32;
}

impl Id for u16 {
    fn narrow(value: u32) -> Self {
        value as u16
    }
    #[inline(always)]
    fn widen(self) -> u32 {
        u32::from(self)
    }
}

impl Id for u32 {
    fn narrow(value: u32) -> Self {
        value
    }
    #[inline(always)]
    fn widen(self) -> u32 {
        self
    }
}

struct Built<O, I> {
    objects: O,
    settings: Settings,
    mailbox: bool,
    cells: Cells<I>,
}

/// The lists of the cells of a grid.
struct Cells<I> {
    grid: Grid,
    counters: Box<[I]>,
    pointers: Box<[u32]>,
    ids: Box<[I]>,
}

impl<I: Id> Cells<I> {
    fn new<B: Bounds>(objects: &B, settings: &Settings, cancel: Cancel) -> Result<Self, BuildError> {
        let bounds = crate::resolution::bounds(objects);
        let grid = crate::resolution::grid(ID, settings.resolution, bounds, objects.len())?;
        let limit = Limit::of(ID, settings);
        let cells = limit.cells(u128::from(grid.cells()), (size_of::<I>() + 4) as u128)?;
        // Ids of 2 bytes are made from those of 4, which is the most there is at a time.
        let while_made = if size_of::<I>() < 4 { 4 } else { 0 };
        let bytes = |ids: u64| {
            cells as u128 * (size_of::<I>() + 4) as u128
                + u128::from(ids) * (size_of::<I>() + while_made) as u128
        };
        let lists = register(cells, objects.len() as u32, limit, cancel, bytes, |object, found| {
            let bounds = objects.bounds(object);
            let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.slices(axis, &bounds));
            accel::make_room(ID, found, xs.len().div_ceil(64) * ys.len() * zs.len())?;
            for z in zs {
                for y in ys.clone() {
                    let row = grid.index([0, y, z]) as u32;
                    found.extend(
                        xs.clone()
                            .step_by(64)
                            .map(|x| Word { first: row + x, bits: u64::MAX >> (64 - (xs.end - x).min(64)) }),
                    );
                }
            }
            Ok(())
        })?;
        let mut counters = accel::reserved(ID, cells)?;
        counters.extend(lists.offsets.windows(2).map(|ends| I::narrow(ends[1] - ends[0])));
        let counters = counters.into_boxed_slice();
        let ids = if size_of::<I>() == size_of::<u32>() {
            // In the same memory.
            lists.references.into_iter().map(I::narrow).collect()
        } else {
            let mut ids = accel::reserved(ID, lists.references.len())?;
            ids.extend(lists.references.into_iter().map(I::narrow));
            ids.into_boxed_slice()
        };
        let mut pointers = lists.offsets;
        pointers.pop();
        cancel.check(ID)?;
        let pointers = pointers.into_boxed_slice();
        Ok(Self { grid, counters, pointers, ids })
    }
}

impl<I: Id> Cells<I> {
    /// The objects of a cell.
    #[inline(always)]
    fn ids(&self, cell: usize) -> &[I] {
        let first = self.pointers[cell] as usize;
        &self.ids[first..first + self.counters[cell].widen() as usize]
    }
}

impl<O: Objects, I: Id> Built<O, I> {
    fn new(objects: O, shape: &impl Bounds, list: &SsmList, cancel: Cancel) -> Result<Self, BuildError> {
        let SsmList { settings, mailbox } = *list;
        Ok(Self { objects, settings, mailbox, cells: Cells::new(shape, &settings, cancel)? })
    }

    #[inline(always)]
    fn nearest<C: Count, const ANY: bool>(&self, ray: &Ray, count: &mut C) -> Nearest {
        let mut best = Nearest::new(ray.t_max);
        let Some(segment) = self.cells.grid.clip(ray) else {
            return best;
        };
        let mut tested = Mailbox::default();
        let mut limit = f32::INFINITY;
        for cell in Walk::new(&self.cells.grid, &segment) {
            if cell.enter > limit {
                break;
            }
            count.cells(1);
            for id in self.cells.ids(self.cells.grid.index(cell.slice)) {
                let id = id.widen();
                count.candidates(1);
                if self.mailbox && tested.contains_or_insert(id) {
                    continue;
                }
                count.tests(1);
                // The objects know the order of hits that are reported at the same t.
                let before = best.object;
                self.objects.closest(id, ray, &mut best);
                if best.object != before {
                    if ANY {
                        return best;
                    }
                    limit = segment.limit(best.t);
                }
            }
        }
        best
    }
}

/// The objects that a ray has met lately.
struct Mailbox([u32; 16]);

impl Default for Mailbox {
    fn default() -> Self {
        Self([Nearest::NONE; 16])
    }
}

impl Mailbox {
    #[inline(always)]
    fn contains_or_insert(&mut self, id: u32) -> bool {
        let place = &mut self.0[id as usize % 16];
        std::mem::replace(place, id) == id
    }
}

/// A ray traced with the chosen instruction set.
struct Trace<'a, O, I, const ANY: bool>(&'a Built<O, I>, &'a Ray);

impl<O: Objects, I: Id, const ANY: bool> Task for Trace<'_, O, I, ANY> {
    type Out = Nearest;
    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Nearest {
        self.0.nearest::<NoCount, ANY>(self.1, &mut NoCount)
    }
}

impl<O: Objects, I: Id> Accel for Built<O, I> {
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.settings.simd.run(Trace::<_, _, false>(self, ray)).hit()
    }

    fn occluded(&self, ray: &Ray) -> bool {
        self.settings.simd.run(Trace::<_, _, true>(self, ray)).hit().is_some()
    }

    fn trace(&self, rays: &RaySet, hits: &mut [Option<Hit>]) {
        for_each_ray(rays, hits, |ray| self.closest(ray));
    }

    fn candidates(&self, ray: &Ray, found: &mut Vec<u32>) -> bool {
        let first = found.len();
        if let Some(segment) = self.cells.grid.clip(ray) {
            for cell in Walk::new(&self.cells.grid, &segment) {
                found.extend(self.cells.ids(self.cells.grid.index(cell.slice)).iter().map(|id| id.widen()));
            }
        }
        crate::once::keep_once(found, first);
        true
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        accel::all_hits::of(self, &self.objects, ray)
    }

    fn footprint(&self) -> Footprint {
        Footprint::default()
            .structure("counters", size_of_val(&*self.cells.counters))
            .structure("pointers", size_of_val(&*self.cells.pointers))
            .structure("ids", size_of_val(&*self.cells.ids))
    }

    fn plan(&self) -> String {
        let [x, y, z] = self.cells.grid.resolution();
        format!("{x}x{y}x{z} cells by {}, ids of {} bytes", self.settings.resolution, size_of::<I>())
    }

    fn count(&self, rays: &RaySet, occlusion: bool) -> Option<Counters> {
        let mut counters = Counters::default();
        for i in 0..rays.len() {
            if occlusion {
                self.nearest::<_, true>(&rays.ray(i), &mut counters);
            } else {
                self.nearest::<_, false>(&rays.ray(i), &mut counters);
            }
        }
        Some(counters)
    }
}

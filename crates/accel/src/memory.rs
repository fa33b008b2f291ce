//! How much memory a structure may take, and taking it.

use crate::BuildError;
use crate::parallel::prelude::*;
use crate::parallel::{extend, repeat_n};
use bytemuck::Zeroable;
use bytemuck::allocation::try_zeroed_vec;
use std::path::{Path, PathBuf};

/// A vector of equal values, written by all threads of the current pool: its memory is new to the process as a rule, and the
/// system clears each page when it is first written to.
///
/// # Errors
/// Those of [`reserved`].
pub fn filled<T: Clone + Send>(structure: &str, value: T, len: usize) -> Result<Vec<T>, BuildError> {
    const TASK: usize = 1 << 12;
    let mut all = reserved(structure, len)?;
    extend(&mut all, repeat_n(value, len).with_min_len(TASK));
    Ok(all)
}

/// A vector of zeros, which the system gives as they are: no page is touched before it is used.
///
/// # Errors
/// Those of [`reserved`].
pub fn zeroed<T: Zeroable>(structure: &str, len: usize) -> Result<Vec<T>, BuildError> {
    try_zeroed_vec(len).map_err(|()| too_large::<T>(structure, len))
}

/// Appends to a vector that may have no room left.
///
/// # Errors
/// Those of [`reserved`].
#[inline]
pub fn append<T>(structure: &str, all: &mut Vec<T>, item: T) -> Result<(), BuildError> {
    if all.len() == all.capacity() {
        make_room(structure, all, 1)?;
    }
    all.push(item);
    Ok(())
}

/// Room for so many more, and for as many again where a vector grows.
///
/// # Errors
/// Those of [`reserved`].
pub fn make_room<T>(structure: &str, all: &mut Vec<T>, more: usize) -> Result<(), BuildError> {
    let len = all.len() + more;
    all.try_reserve(more).map_err(|_| too_large::<T>(structure, len))
}

/// An empty vector with room for so many, for a structure that is being built: what grows with a scene is asked for and not taken
/// for granted.
///
/// # Errors
/// [`BuildError::TooLarge`] if the system doesn't give it.
pub fn reserved<T>(structure: &str, len: usize) -> Result<Vec<T>, BuildError> {
    let mut room = Vec::new();
    if room.try_reserve_exact(len).is_ok() {
        return Ok(room);
    }
    Err(too_large::<T>(structure, len))
}

/// So many elements, which the system did not give.
#[cold]
fn too_large<T>(structure: &str, len: usize) -> BuildError {
    let bytes = len as u128 * size_of::<T>() as u128;
    // There is less, whatever is said.
    let limit = available_memory().min(bytes.saturating_sub(1));
    BuildError::TooLarge { structure: structure.into(), bytes, limit }
}

/// The elements of all vectors in order, moved by all threads of the current pool.
///
/// # Errors
/// Those of [`reserved`].
pub fn concatenated<T: Copy + Send + Sync>(structure: &str, parts: &[Vec<T>]) -> Result<Vec<T>, BuildError> {
    let Some(first) = parts.iter().find_map(|part| part.first()) else { return Ok(Vec::new()) };
    let len = parts.iter().map(Vec::len).sum();
    if crate::parallel::threads() == 1 || size_of::<T>() * len < WORTH_SHARING {
        let mut all = reserved(structure, len)?;
        parts.iter().for_each(|part| all.extend_from_slice(part));
        return Ok(all);
    }
    let mut all = filled(structure, *first, len)?;
    let mut rest = &mut all[..];
    let rooms: Vec<_> =
        parts.iter().map(|part| (part, rest.split_off_mut(..part.len()).expect("room for all"))).collect();
    rooms.into_par_iter().for_each(|(part, room)| room.copy_from_slice(part));
    Ok(all)
}

/// Bytes from which on threads are asked to help moving them.
const WORTH_SHARING: usize = 1 << 20;

/// Taken where the system does not tell: 16 GiB.
const UNKNOWN: u128 = 16 << 30;

/// Bytes that can be allocated now without swapping: the default limit that builders hold
/// their needs against before they allocate (see [`crate::BuildError::TooLarge`]).
///
/// The least of what the system has (`/proc/meminfo`), what the process's control groups still allow (a container's
/// limit, of versions 1 and 2), and what is left of its address space (`ulimit -v`); 16 GiB where nothing tells.
pub fn available_memory() -> u128 {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let system = read("/proc/meminfo").and_then(|text| available(&text));
    let limits = read("/proc/self/limits").zip(read("/proc/self/status"));
    let address_space = limits.and_then(|(limits, status)| address_space(&limits, &status));
    let groups = read("/proc/self/cgroup").and_then(|groups| of_groups(&groups, Path::new("/sys/fs/cgroup")));
    [system, address_space, groups].into_iter().flatten().min().unwrap_or(UNKNOWN)
}

fn available(meminfo: &str) -> Option<u128> {
    field(meminfo, "MemAvailable:")
}

/// A line `name 12 kB` in bytes.
fn field(text: &str, name: &str) -> Option<u128> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u128 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

fn address_space(limits: &str, status: &str) -> Option<u128> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u128 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(field(status, "VmSize:")?))
}

/// What the groups named in `/proc/self/cgroup` and all above them still allow; `root` is where they are mounted.
fn of_groups(groups: &str, root: &Path) -> Option<u128> {
    let left = groups.lines().filter_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?.trim_start_matches('/'));
        match controllers {
            "" => above(root, path, "memory.max", "memory.current"),
            _ if controllers.split(',').any(|name| name == "memory") => {
                above(&root.join("memory"), path, "memory.limit_in_bytes", "memory.usage_in_bytes")
            }
            _ => None,
        }
    });
    left.min()
}

/// The least that a group and those above it allow. In a container the path may be that of the host, and the group is
/// mounted as the root.
fn above(root: &Path, path: &str, limit: &str, used: &str) -> Option<u128> {
    let number = |file: PathBuf| std::fs::read_to_string(file).ok()?.trim().parse::<u128>().ok();
    let inside = root.join(path);
    let groups = inside.ancestors().take_while(|group| group.starts_with(root));
    let left = |group: &Path| Some(number(group.join(limit))?.saturating_sub(number(group.join(used))?));
    groups.filter_map(left).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_joined_in_order_whatever_the_number_of_threads() {
        for (part, parts) in [(0, 3), (5, 4), (70_000, 7)] {
            let parts: Vec<Vec<u32>> = (0..parts).map(|i| (i * part..(i + 1) * part).collect()).collect();
            let expected: Result<Vec<u32>, BuildError> = Ok(parts.iter().flatten().copied().collect());
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert_eq!(pool.install(|| concatenated("x", &parts)), expected);
            }
        }
    }

    #[test]
    fn what_no_system_has_is_an_error() {
        assert!(reserved::<u64>("x", 1000).unwrap().capacity() >= 1000);
        for len in [1 << 60, usize::MAX] {
            let error = reserved::<u64>("x", len).unwrap_err();
            assert!(matches!(error, BuildError::TooLarge { bytes, limit, .. } if bytes > limit), "{error}");
        }
    }

    #[test]
    fn the_line_is_read_in_bytes() {
        let text = "MemTotal:       16316412 kB\nMemAvailable:    1024 kB\n";
        assert_eq!(available(text), Some(1 << 20));
        assert_eq!(available("MemTotal: 1 kB\n"), None);
        assert!(available_memory() > 0);
    }

    #[test]
    fn the_limits_of_groups_are_found_up_to_the_root() {
        let root = std::env::temp_dir().join(format!("rayscale-groups-{}", std::process::id()));
        let inner = root.join("pod").join("box");
        std::fs::create_dir_all(&inner).unwrap();
        let write = |folder: &Path, max: &str, used: &str| {
            std::fs::write(folder.join("memory.max"), max).unwrap();
            std::fs::write(folder.join("memory.current"), used).unwrap();
        };
        write(&inner, "max\n", "5\n");
        write(&root.join("pod"), "3000\n", "1000\n");
        assert_eq!(of_groups("0::/pod/box\n", &root), Some(2000));
        write(&inner, "700\n", "900\n");
        assert_eq!(of_groups("0::/pod/box\n", &root), Some(0), "more is used than there may be");
        write(&root, "50\n", "8\n");
        assert_eq!(
            of_groups("0::/of/the/host\n", &root),
            Some(42),
            "a container sees its own group as the root"
        );
        assert_eq!(of_groups("4:cpu:/pod\n", &root), None);
        std::fs::remove_dir_all(&root).unwrap();
    }

    #[test]
    fn the_address_space_that_is_left_is_a_limit() {
        let limits = "Max address space         4000000000           unlimited            bytes     \n";
        assert_eq!(address_space(limits, "VmSize:\t 1000000 kB\n"), Some(4_000_000_000 - 1_024_000_000));
        assert_eq!(address_space("Max address space   unlimited  unlimited bytes\n", "VmSize: 1 kB\n"), None);
    }
}

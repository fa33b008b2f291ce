//! Structures with any settings.

use crate::Numbers;
use lanes::Level;
use primitives::KernelId;

/// A structure with settings and this kernel, as the command line takes them; grids are of no more than `finest` slices an axis,
/// or 40.
pub fn structure(numbers: &mut impl Numbers, kernel: KernelId, finest: u32) -> String {
    let resolution = match numbers.below(4) {
        0 => String::new(),
        1 => format!(",resolution={}", 1 + numbers.below(20).min(finest - 1)),
        2 => {
            format!(",resolution={}x{}x{}", 1 + numbers.below(9), 1 + numbers.below(9), 1 + numbers.below(40))
        }
        _ => format!(",resolution={}", numbers.one_of(&[1, 2, finest])),
    };
    let levels: Vec<Level> = Level::ALL.into_iter().filter(|level| level.available()).collect();
    let level = numbers.one_of(&levels).id();
    let simd = if numbers.below(2) == 0 { format!(",simd={level}") } else { String::new() };
    match numbers.below(40) {
        0 => format!("minmax:kernel={kernel}"),
        1 => format!("sphere:kernel={kernel}"),
        2..6 => {
            let walk = numbers.one_of(&["", ",loop=appendix", ",loop=words"]);
            let mailbox = numbers.one_of(&["", ",mailbox=on", ",mailbox=off"]);
            format!("bmssm-dense:kernel={kernel}{simd}{resolution}{walk}{mailbox}")
        }
        6..8 => format!("ssm-list:kernel={kernel}{simd}{resolution}"),
        8..22 => {
            let divide = numbers.one_of(&["", ",divide=off", ",divide=0.5", ",divide=3"]);
            let density = numbers.one_of(&["", ",density=0.1", ",density=4"]);
            let cells = if resolution.is_empty() { density } else { &resolution };
            format!("ssm:kernel={kernel}{simd}{cells}{divide}")
        }
        _ => {
            let exact_split = numbers.one_of(&["", ",exact_split=64", ",exact_split=256"]);
            let geometry = numbers.one_of(&["", ",geometry=scene", ",geometry=rows", ",geometry=boxes"]);
            let tile = numbers.one_of(&["", ",tile=1", ",tile=16"]);
            let depth = numbers.one_of(&["", ",depth_bits=0", ",depth_bits=8"]);
            let large = numbers.one_of(&["", ",large=1", ",large=65536"]);
            format!("bmssm:kernel={kernel}{simd}{exact_split}{geometry}{tile}{depth}{large}")
        }
    }
}

//! Haines' Standard Procedural Databases (E. Haines 1987, "A Proposal for Standard Graphics
//! Environments", IEEE CG&A 7(11); definitions at
//! <https://github.com/erich666/StandardProceduralDatabases>), and the teapot.
//!
//! Each function returns the scene's primitives in the published number; tessellation comes
//! after. The names of the parameters are those of the databases: a size factor `sf`.

mod balls;
mod gears;
mod jacks;
mod lattice;
mod mount;
mod rings;
mod shells;
mod sombrero;
mod teapot;
mod tetra;
mod tree;

pub use balls::balls;
pub use gears::gears;
pub use jacks::jacks;
pub use lattice::lattice;
pub use mount::mount;
pub use rings::rings;
pub use shells::shells;
pub use sombrero::sombrero;
pub use teapot::{checkerboard, teapot, teapot_patches};
pub use tetra::tetra;
pub use tree::tree;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn databases_have_the_published_numbers_of_primitives() {
        assert_eq!(balls(4).len(), 7382);
        assert_eq!(balls(5).len(), 66_431);
        assert_eq!(jacks(1).len(), 9);
        assert_eq!(jacks(4).len(), 9 * (4096 - 1) / 7);
        assert_eq!(lattice(12).len(), 8281);
        assert_eq!(rings(7).len(), 8401);
        assert_eq!(rings(1).len(), 61);
        assert_eq!(shells(5).len(), 5760);
        assert_eq!(tetra(6).len(), 4096);
        assert_eq!(tetra(1).len(), 4);
        assert_eq!(tree(11).len(), 8191);
    }
}

//! Solids as scene definitions say them: a `[[solid]]` table each, with its kind and its fields.

mod fields;
mod kinds;

use accel::Solid;
use fields::Table;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use toml::{Spanned, Value};

/// The text of the `[[solid]]` tables of a definition, read but not understood.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(transparent)]
pub struct Tables(Vec<BTreeMap<String, Spanned<Value>>>);

impl Tables {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The solids that they say. `text` is what they were read from, `folder` where
    /// files are that they name.
    ///
    /// # Errors
    /// In words, with the line, the object's number from 1, the field and the reason.
    pub fn solids(&self, text: &str, folder: Option<&Path>) -> Result<Vec<Solid>, String> {
        let solid = |(number, table): (usize, &BTreeMap<String, Spanned<Value>>)| {
            let mut table = Table::new(number + 1, table, text, folder);
            let solid = kinds::read(&mut table)?;
            table.finish(&solid)?;
            Ok(solid)
        };
        self.0.iter().enumerate().map(solid).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::definition::Definition;

    const HEAD: &str = "id = 'a'\ndescription = 'b'\ncharacter = 'c'\n";

    #[test]
    fn each_kind_is_read() {
        let text = "
            solid = [
                { kind = 'triangle', corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] },
                { kind = 'box', min = [0, 0, 0], max = [1, 2, 3] },
                { kind = 'sphere', center = [0, 0.5, 0], radius = 2 },
                { kind = 'cone', base = [0, 0, 0], base_radius = 1.5, top = [0, 0, 2] },
                { kind = 'cylinder', base = [0, 0, 0], top = [0, 0, 2], radius = 0.5 },
                { kind = 'disc', center = [0, 0, 0], normal = [0, 1, 0], radius = 1 },
                { kind = 'quadric', coefficients = [1, 1, -1, 0, 0, 0, 0, 0, 0, -1], min = [-2, -2, -2], max = [2, 2, 2] },
                { kind = 'torus', center = [0, 0, 0], axis = [0, 0, 1], major = 2, minor = 0.5 },
            ]
        ";
        let definition = Definition::parse(&format!("{HEAD}{text}")).unwrap();
        let kinds: Vec<_> = definition.solids.iter().map(accel::Solid::kind).collect();
        assert_eq!(kinds, ["triangle", "box", "sphere", "cone", "cone", "disc", "quadric", "torus"]);
    }

    #[test]
    fn functions_patches_sets_and_groups_are_read() {
        let net: String = (0..16).map(|i| format!("[{}, {}, 0], ", i % 4, i / 4)).collect();
        let text = format!(
            "
            [[solid]]
            kind = 'implicit'
            function = 'x^2 + y^2 + z^2 - 1'
            min = [-1, -1, -1]
            max = [1, 1, 1]
            [[solid]]
            kind = 'patch'
            points = [{net}]
            [[solid]]
            kind = 'csg'
            combination = 'difference'
            parts = [
                {{ kind = 'box', min = [0, 0, 0], max = [1, 1, 1] }},
                {{ kind = 'csg', combination = 'union', parts = [
                    {{ kind = 'sphere', center = [0, 0, 0], radius = 0.5 }},
                    {{ kind = 'sphere', center = [1, 1, 1], radius = 0.5 }},
                ] }},
            ]
            [[solid]]
            kind = 'group'
            parts = [
                {{ kind = 'disc', center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }},
                {{ kind = 'group', parts = [
                    {{ kind = 'sphere', center = [0, 0, 3], radius = 0.5 }},
                    {{ kind = 'box', min = [0, 0, 1], max = [1, 1, 2] }},
                ] }},
            ]
        "
        );
        let definition = Definition::parse(&format!("{HEAD}{text}")).unwrap();
        let kinds: Vec<_> = definition.solids.iter().map(accel::Solid::kind).collect();
        assert_eq!(kinds, ["implicit", "patch", "csg", "group"]);
    }

    #[test]
    fn open_meshes_in_sets_are_refused_by_file_and_reason() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("open.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let text = "[[solid]]\nkind = 'csg'\ncombination = 'union'\nparts = [\n{ kind = 'sphere', center = [0, 0, 0], radius = 1 },\n{ kind = 'facets', file = 'open.obj' }]";
        let error = Definition::parse_in(&format!("{HEAD}{text}"), Some(folder.path())).unwrap_err();
        assert!(error.starts_with("line 7, solid 1 (csg), part 2 (facets): `file` is not closed"), "{error}");
        let error =
            Definition::parse(&format!("{HEAD}{}", text.replace("open.obj", "none.obj"))).unwrap_err();
        assert!(error.contains("part 2 (facets): `file` can't be had"), "{error}");
    }

    #[test]
    fn slips_are_told_with_line_number_field_and_reason() {
        let ball = "[[solid]]\nkind = 'sphere'\ncenter = [0, 0, 0]\n";
        for (text, says) in [
            (
                "[[solid]]\nkind = 'spher'",
                "line 5, solid 1: `kind`: there is no kind `spher`; did you mean `sphere`?",
            ),
            ("[[solid]]\nradius = 1", "line 5, solid 1: `kind` is missing"),
            (
                &format!("{ball}radius = nan"),
                "line 7, solid 1 (sphere): `radius` is NaN, which is not finite",
            ),
            (&format!("{ball}radius = -2.0"), "line 7, solid 1 (sphere): `radius` must be above 0, not -2"),
            (
                &format!("{ball}radius = 'x'"),
                "line 7, solid 1 (sphere): `radius` must be a number, not \"x\"",
            ),
            (
                &format!("{ball}radius = 1e300"),
                "line 7, solid 1 (sphere): `radius` is inf, which is not finite",
            ),
            (&format!("{ball}radius = 1\nsize = 2"), "line 8, solid 1 (sphere): there is no field `size`"),
            (ball, "solid 1 (sphere): `radius` is missing"),
            (
                &format!("{ball}radius = 1\n\n[[solid]]\nkind = 'disc'\ncenter = [0, 0]"),
                "line 11, solid 2 (disc): `center` must be three numbers",
            ),
            (
                "[[solid]]\nkind = 'torus'\ncenter = [0,0,0]\naxis = [0,0,0]\nmajor = 1\nminor = 2",
                "line 7, solid 1 (torus): `axis` must not be zero",
            ),
            (
                "[[solid]]\nkind = 'implicit'\nfunction = 'x +'\nmin = [0,0,0]\nmax = [1,1,1]",
                "line 6, solid 1 (implicit): `function` column 4: ends where a value is expected",
            ),
            ("[[solid]]\nkind = 'implicit'\nfunction = 'x'", "solid 1 (implicit): `min` is missing"),
            (
                "[[solid]]\nkind = 'patch'\npoints = [[0,0,0]]",
                "line 6, solid 1 (patch): `points` must be 16 points of three numbers each; 1 are there",
            ),
            (
                "[[solid]]\nkind = 'csg'\ncombination = 'union'\nparts = [{ kind = 'disc', center = [0,0,0], normal = [0,0,1], radius = 1 }, { kind = 'box', min = [0,0,0], max = [1,1,1] }]",
                "line 7, solid 1 (csg): `parts` hold a disc, which is no closed object",
            ),
            (
                "[[solid]]\nkind = 'csg'\ncombination = 'without'\nparts = []",
                "`combination` must be union, intersection or difference, not `without`",
            ),
            (
                "[[solid]]\nkind = 'csg'\ncombination = 'union'\nparts = [{ kind = 'group', parts = [{ kind = 'box', min = [0,0,0], max = [1,1,1] }, { kind = 'sphere', center = [0,0,0], radius = 1 }] }, { kind = 'box', min = [0,0,0], max = [1,1,1] }]",
                "line 7, solid 1 (csg): `parts` hold a group, which may be open",
            ),
            (
                "[[solid]]\nkind = 'group'\nparts = [{ kind = 'box', min = [0,0,0], max = [1,1,1] }, { kind = 'sphere', center = [0,0,0], radius = -1 }]",
                "line 6, solid 1 (group), part 2 (sphere): `radius` must be above 0",
            ),
            ("[[solid]]\nkind = 'quadric'\ncoefficients = [1, 2]", "`coefficients` must be 10 numbers"),
        ] {
            let error = Definition::parse(&format!("{HEAD}{text}")).unwrap_err();
            assert!(error.contains(says), "{text:?} gave {error}");
        }
    }
}

//! Values of libraries by the names that options give them.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use harness::grouped::Measure;
use report::picture::Shading;

/// A name, what it means, and what is said of it.
type Named<T> = (&'static str, T, &'static str);

const MEASURES: [Named<Measure>; 4] = [
    ("trace", Measure::Trace, "Time per ray"),
    ("build", Measure::Build, "Time to build"),
    ("structure", Measure::Structure, "Bytes that the method adds"),
    ("bytes", Measure::Bytes, "Bytes in all, copied geometry included"),
];

const SHADINGS: [Named<Shading>; 4] = [
    ("light", Shading::Light, "Matt surfaces under a lamp beside the eye"),
    ("normal", Shading::Normal, "The surface normal: red, green and blue for x, y and z"),
    ("depth", Shading::Depth, "The distance: near is bright"),
    ("object", Shading::Object, "Which object: one colour each"),
];

/// What rankings and tables compare.
pub fn measures() -> impl TypedValueParser<Value = Measure> {
    named(&MEASURES)
}

/// What the colours of a picture say.
pub fn shadings() -> impl TypedValueParser<Value = Shading> {
    named(&SHADINGS)
}

fn named<T: Copy + Send + Sync + 'static>(all: &'static [Named<T>]) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|(name, _, help)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(names)
        .map(|name| all.iter().find(|(known, ..)| *known == name).expect("clap takes no other name").1)
}

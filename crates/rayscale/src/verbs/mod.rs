//! The verbs, one file each. A verb is a `clap::Args` struct that is a [`Verb`], and a line of `verbs!` below.

pub mod check;
pub mod cmp;
pub mod compare;
pub mod completions;
pub mod diff;
mod hits;
mod judged;
pub mod measure;
pub mod model;
pub mod paper;
mod pictures;
pub mod rank;
pub mod recommend;
pub mod render;
pub mod report;
pub mod scenes;
pub mod structures;
pub mod trace;
pub mod trade;
pub mod welcome;

use crate::verb::Verb;
use clap::Subcommand;

macro_rules! verbs {
    ($($name:ident: $verb:ty,)*) => {
        /// What is to be done.
        #[derive(Debug, Subcommand)]
        pub enum Command {
            $($name($verb),)*
        }

        impl Command {
            /// The verb with its options.
            pub fn verb(&self) -> &dyn Verb {
                match self {
                    $(Self::$name(verb) => verb,)*
                }
            }
        }
    };
}

// In the order of help texts.
verbs! {
    Compare: compare::Compare,
    Check: check::Check,
    Measure: measure::Measure,
    Report: report::Report,
    Cmp: cmp::Cmp,
    Rank: rank::Rank,
    Recommend: recommend::Recommend,
    Diff: diff::Diff,
    Render: render::Render,
    Trace: trace::Trace,
    Scenes: scenes::Scenes,
    Structures: structures::Structures,
    Paper: paper::PaperVerb,
    Trade: trade::Trade,
    Model: model::ModelVerb,
    Completions: completions::Completions,
}

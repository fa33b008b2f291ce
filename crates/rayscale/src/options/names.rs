//! Names that shells complete and that verbs look up themselves, so that slips get the suite's own suggestions.

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::error::Error;
use clap::{Arg, Command};
use harness::registry::{self, AUTO};
use primitives::KernelId;
use scenes::rays::RaysId;
use std::ffi::OsStr;

/// Takes any text and lists the names there are.
#[derive(Clone)]
pub struct Names(Vec<PossibleValue>);

impl Names {
    fn new(names: impl IntoIterator<Item = PossibleValue>) -> Self {
        Self(names.into_iter().collect())
    }
}

impl TypedValueParser for Names {
    type Value = String;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<String, Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.0.iter().cloned()))
    }
}

/// Structures.
pub fn structures() -> Names {
    let value = |entry: &registry::Entry| PossibleValue::new(entry.id).help(entry.description);
    Names::new(registry::entries().iter().map(value))
}

/// Ray sets.
pub fn ray_sets() -> Names {
    Names::new(RaysId::ALL.map(|id| PossibleValue::new(id.name())))
}

/// Kernels, and the choice of one.
pub fn kernels() -> Names {
    let kernel = |kernel: KernelId| {
        let value = PossibleValue::new(kernel.id());
        if kernel.is_lossy() { value.help("lossy: it takes the scene for another one") } else { value }
    };
    let auto =
        PossibleValue::new(AUTO).help("for each scene the cheapest that keeps --max-error on its rays");
    Names::new(KernelId::ALL.map(kernel).into_iter().chain([auto]))
}

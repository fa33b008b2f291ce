//! The options that choose a ray-triangle test.

use super::limits::LimitOptions;
use super::names::kernels;
use crate::error::Error;
use clap::Args;
use harness::registry::{self, AUTO, Choice, ChosenKernel, StructureSpec};
use primitives::KernelId;

/// Which ray-triangle test, and how wrong it may be.
#[derive(Clone, Debug, Default, Args)]
pub struct KernelOptions {
    /// The ray-triangle intersector of the suite's own structures
    #[arg(long, value_name = "ID", value_parser = kernels())]
    pub kernel: Option<String>,
    /// For the kernel auto, which keeps to one error in a million otherwise
    #[command(flatten)]
    pub limits: LimitOptions,
}

impl KernelOptions {
    /// `--kernel` if given.
    ///
    /// # Errors
    /// A kernel that is not known.
    fn name(&self) -> Result<Option<&str>, Error> {
        let Some(name) = self.kernel.as_deref() else { return Ok(None) };
        if name == AUTO || KernelId::from_id(name).is_some() {
            return Ok(Some(name));
        }
        let known = KernelId::ALL.map(KernelId::id).into_iter().chain([AUTO]);
        Err(Error::unknown("kernel", name, known))
    }

    /// The structures with the kernel of `--kernel`, where they have none of their own and name none.
    ///
    /// # Errors
    /// Structures, settings or kernels that are not known; limits where no kernel is to be chosen.
    pub fn choose_all(&self, specs: &[StructureSpec]) -> Result<Vec<Choice>, Error> {
        let kernel = self.name()?;
        let choose = |spec: &StructureSpec| -> Result<Choice, Error> {
            let own = registry::find(&spec.id)?.traits.built_in;
            let spec = match kernel {
                Some(kernel) if own => spec.clone().with_default("kernel", kernel),
                _ => spec.clone(),
            };
            Ok(registry::choose(&spec)?)
        };
        let choices: Result<Vec<Choice>, Error> = specs.iter().map(choose).collect();
        self.limit(choices?)
    }

    /// The structure of that name and settings with the kernel of `--kernel`.
    ///
    /// # Errors
    /// As [`KernelOptions::choose_all`]; a kernel for a structure that brings its own, or two.
    pub fn choose_one(&self, text: &str) -> Result<Choice, Error> {
        let mut spec: StructureSpec = text.parse()?;
        if let Some(kernel) = self.name()? {
            let entry = registry::find(&spec.id)?;
            if !entry.traits.built_in {
                return Err(Error::usage(
                    format!(
                        "structure `{}` brings its own ray-triangle test; it takes no --kernel",
                        entry.id
                    ),
                    "leave --kernel out",
                ));
            }
            if spec.get("kernel").is_some_and(|given| given != kernel) {
                return Err(Error::usage(
                    format!("`{text}` and --kernel {kernel} name two kernels"),
                    "name one of them",
                ));
            }
            spec = spec.with_default("kernel", kernel);
        }
        let mut choices = self.limit(vec![registry::choose(&spec)?])?;
        Ok(choices.remove(0))
    }

    /// Tells the choices that are left to the suite how many errors there may be.
    fn limit(&self, mut choices: Vec<Choice>) -> Result<Vec<Choice>, Error> {
        let mut any = false;
        for choice in &mut choices {
            if let ChosenKernel::Auto { limits } = &mut choice.kernel {
                *limits = self.limits.limits_or_default();
                any = true;
            }
        }
        if let (Some(option), false) = (self.limits.given(), any) {
            return Err(Error::usage(
                format!("{option} is for a kernel that is to be chosen, and none is"),
                format!("add --kernel auto, or leave {option} out"),
            ));
        }
        Ok(choices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::judge::Limits;

    fn options(kernel: Option<&str>, max_error: Option<f64>) -> KernelOptions {
        let limits = LimitOptions { max_error, ..LimitOptions::default() };
        KernelOptions { kernel: kernel.map(str::to_owned), limits }
    }

    #[test]
    fn auto_has_a_limit_and_only_auto_has() {
        let specs = ["ssm", "minmax:kernel=exact", "obvhs-bvh2"].map(|id| id.parse().unwrap());
        let choices = options(Some("auto"), Some(2.5)).choose_all(&specs).unwrap();
        assert_eq!(
            choices[0].kernel,
            ChosenKernel::Auto { limits: Limits { errors: Some(2.5), ..Limits::NONE } }
        );
        assert_eq!([0, 1, 2].map(|i| choices[i].kernel()), ["auto", "exact", "own"]);
        let alone = options(None, None).choose_one("ssm:kernel=auto").unwrap();
        assert_eq!(alone.kernel, ChosenKernel::Auto { limits: Limits::default() });
        assert!(options(Some("exact"), Some(1.0)).choose_all(&specs).is_err());
        assert!(options(Some("automatic"), None).choose_all(&specs).is_err());
        assert!(options(Some("auto"), None).choose_one("obvhs-bvh2").is_err());
    }
}

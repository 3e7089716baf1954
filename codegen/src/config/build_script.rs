//! Inside a build script: what cargo is told, and which modules stand afterwards.

use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use super::Config;
use super::made::Made;
use super::modules::Modules;
use crate::cache::Cache;
use crate::check::is_module_name;
use crate::error::Error;
use crate::load::Loaded;
use crate::text::escaped;

/// An unoptimised generator that takes longer is reported.
const LONG: Duration = Duration::from_secs(5);
/// How the generator is compiled.
const OPT_LEVEL: &str = env!("GRAMFORGE_OPT_LEVEL");

/// Generates the modules of `config` and writes directives for cargo to `out`; whether everything went well.
pub(super) fn run(config: &Config, out: &mut impl Write) -> bool {
    let start = Instant::now();
    let loaded = config.load();
    // Print this first, so that cargo knows the files even if the work fails or is interrupted.
    let told = watch(config, &loaded, out);
    let names: Vec<String> = loaded.iter().filter_map(module_name).collect();
    let result = config.folder().and_then(|folder| {
        let modules = Modules::in_folder(&folder);
        let cache = modules.kept().filter(|_| !config.uncached).and_then(Cache::below);
        let made = config.make(loaded, cache.as_ref());
        // Of a specification that is broken for a while the entries stay.
        if let (Some(cache), Ok(_)) = (&cache, &made) {
            cache.sweep();
        }
        let written = made.and_then(|made| modules.publish(&made).map(|()| made));
        written.inspect_err(|error| modules.spoil(&names, &error.to_string()))
    });
    let done = result.is_ok();
    let told = told.and_then(|()| slow(start.elapsed(), OPT_LEVEL, out));
    told.and_then(|()| conclude(result, out)).is_ok() && done
}

/// Warns if the generator was compiled without optimisation (`level` is "0"), as cargo compiles build scripts, and took
/// long.
fn slow(taken: Duration, level: &str, out: &mut impl Write) -> io::Result<()> {
    if taken <= LONG || level != "0" {
        return Ok(());
    }
    let seconds = taken.as_secs();
    let advice = format!(
        "Gramforge took {seconds} s, compiled with opt-level {level}; write `opt-level = 3` in `[profile.dev.package.gramforge]` and \
         `[profile.release.package.gramforge]` of Cargo.toml, and it takes less than a tenth"
    );
    directive(out, "cargo:warning=", &advice)
}

/// Tells cargo which files to watch.
fn watch(config: &Config, loaded: &[Result<Loaded, Error>], out: &mut impl Write) -> io::Result<()> {
    let mut watched = |path: &Path| directive(out, "cargo:rerun-if-changed=", &path.to_string_lossy());
    for (spec, loaded) in config.specs.iter().zip(loaded) {
        watched(spec)?;
        // A faulty specification still names files that must rerun the script once they are corrected.
        for named in loaded.iter().flat_map(|loaded| &loaded.named) {
            watched(&named.path)?;
        }
    }
    Ok(())
}

/// Tells cargo warnings or faults.
fn conclude(result: Result<Vec<Made>, Error>, out: &mut impl Write) -> io::Result<()> {
    match result {
        Ok(all) => {
            for warning in all.iter().flat_map(|made| &made.text.warnings) {
                directive(out, "cargo:warning=", warning)?;
            }
        }
        // With one colon cargo takes `error` for a word of somebody else's, and the build goes on.
        Err(error) => {
            for line in error.to_string().lines() {
                directive(out, "cargo::error=", line)?;
            }
        }
    }
    out.flush()
}

/// One directive on one line, whatever `value` holds.
fn directive(out: &mut impl Write, key: &str, value: &str) -> io::Result<()> {
    writeln!(out, "{key}{}", escaped(value))
}

/// The module's name where the specification can be read and it is one.
fn module_name(loaded: &Result<Loaded, Error>) -> Option<String> {
    let name = &loaded.as_ref().ok()?.spec.name;
    is_module_name(name).then(|| name.clone())
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{directive, slow};

    #[test]
    fn a_directive_never_becomes_two() {
        let mut out = Vec::new();
        directive(&mut out, "cargo:warning=", "a\ncargo:rustc-link-arg=x\r\u{2028}\u{202e}").unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text, "cargo:warning=a\\ncargo:rustc-link-arg=x\\r\\u{2028}\\u{202e}\n");
    }

    #[test]
    fn a_slow_generator_without_optimisation_is_reported() {
        let told = |taken: f64, level: &str| {
            let mut out = Vec::new();
            slow(Duration::from_secs_f64(taken), level, &mut out).unwrap();
            String::from_utf8(out).unwrap()
        };
        let warning = told(54.2, "0");
        assert!(
            warning.starts_with("cargo:warning=Gramforge took 54 s, compiled with opt-level 0; "),
            "{warning}"
        );
        assert!(warning.contains("`[profile.dev.package.gramforge]`") && warning.contains("`opt-level = 3`"));
        assert_eq!(warning.lines().count(), 1);
        assert!(!told(5.001, "0").is_empty());
        for (taken, level) in [(5.0, "0"), (0.0, "0"), (54.2, "1"), (54.2, "3"), (54.2, "s")] {
            assert_eq!(told(taken, level), "", "{taken} s at opt-level {level}");
        }
    }
}

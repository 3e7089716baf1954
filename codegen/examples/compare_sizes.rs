//! The same arm with more and more functions: what each model costs, and what its verdict is.

use std::path::Path;

use gramforge::load::load;
use gramforge::spec::ModelSpec;
use gramforge::{Error, Generation};

fn main() -> Result<(), Error> {
    let loaded = load(Path::new("generated/specs/arm3_xi2.json"))?;
    for functions in 1..=4 {
        let mut changed = loaded.clone();
        changed.spec.model = ModelSpec::Shared { functions };
        let generation = Generation::new(changed)?;
        println!(
            "{functions} functions, module of {} bytes: {}",
            generation.module()?.len(),
            generation.verdict()
        );
    }
    Ok(())
}

use std::path::Path;

use super::{Changes, Group, ModuleText};
use crate::load::parse;
use crate::progress::Silent;
use crate::sizes::{Size, run};
use crate::spec::ModelSpec;

fn module(functions: usize) -> ModuleText {
    let path = Path::new("arm3.json");
    let loaded = parse(include_str!("../../specs/arm3.json"), path).unwrap();
    let size = Size::of(ModelSpec::Shared { functions });
    let (_, generation) = run(&loaded, &size, false, &Silent).unwrap();
    ModuleText::new(size.label(), generation.module().unwrap(), path).unwrap()
}

#[test]
fn a_module_does_not_differ_from_itself() {
    let changes = Changes::new(&module(1), &module(1));
    assert!(!changes.differ && changes.numbers.is_empty() && changes.source.is_empty());
    assert!(changes.psi_added.is_empty() && changes.psi_removed.is_empty());
}

#[test]
fn one_function_more_is_added_and_moves_numbers() {
    let (one, two) = (module(1), module(2));
    let changes = Changes::new(&one, &two);
    assert_eq!((changes.psi_added.len(), changes.psi_removed.len()), (1, 0));
    assert_eq!(changes.psi_added[0], two.facts.psi[1]);
    let sum: f64 = two.facts.psi.iter().map(|(_, share)| share).sum();
    assert!((sum - 1.0).abs() < 1e-12 && two.facts.psi.iter().all(|(_, share)| *share > 0.0));
    let groups: Vec<Group> = changes.numbers.iter().map(|part| part.group).collect();
    assert!(groups.contains(&Group::Parameters) && groups.contains(&Group::Bounds), "{groups:?}");
    for part in &changes.numbers {
        assert!(part.moved.windows(2).all(|pair| pair[0].distance() >= pair[1].distance()), "{part:?}");
    }
    assert!(changes.source.starts_with("--- xi 1\n+++ xi 2\n@@"), "{}", changes.source);
    let back = Changes::new(&two, &one);
    assert_eq!((back.psi_removed, back.psi_added), (changes.psi_added, changes.psi_removed));
}

#[test]
fn another_text_is_no_module() {
    let path = Path::new("arm.rs");
    assert!(ModuleText::new("arm".to_string(), "fn main() {}".to_string(), path).is_err());
    let broken = module(1).text + "}";
    assert!(ModuleText::new("arm".to_string(), broken, path).is_err());
}

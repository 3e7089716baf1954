//! First specifications are complete, are read back, and stay inside the limits.

use std::path::{Path, PathBuf};

use super::{Example, Request, TRIALS, example, first, relative};
use crate::check::{Extent, checked};
use crate::error::Error;
use crate::load::parse;
use crate::spec::LawSpec;

/// A file of the package.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn request(law: Option<LawSpec>) -> Request {
    Request { urdf: file("specs/panda.urdf"), out: file("specs/first.jsonc"), name: None, tip: None, law }
}

#[test]
fn a_first_specification_passes_every_check_with_any_law() {
    let laws = [LawSpec::Exact, LawSpec::Report, LawSpec::Tight, LawSpec::Adaptive].map(Some);
    for law in laws.into_iter().chain([None]) {
        let first = first(&request(law), TRIALS[0]).expect("a specification");
        assert_eq!(first.loaded.spec.control.is_some(), law.is_some());
        checked(first.loaded, Extent::Whole).expect("no fault: the motion keeps the limits too");
    }
}

#[test]
fn a_tip_that_is_not_there_is_refused_with_those_that_are() {
    let asked = Request { tip: Some("tool9".into()), ..request(None) };
    let Err(Error::Input(faults)) = first(&asked, TRIALS[0]) else { panic!("a link that is not there") };
    assert!(faults[0].problem.contains("tool9") && faults[0].help.contains("--tip"), "{}", faults[0]);
}

#[test]
fn the_robot_file_is_named_from_the_folder_of_the_specification() {
    let urdf = file("specs/panda.urdf");
    assert_eq!(relative(&urdf, &file("specs/a.jsonc")), "panda.urdf");
    assert_eq!(relative(&urdf, &file("src/a.jsonc")), "../specs/panda.urdf");
    assert_eq!(relative(&urdf, &file("specs/not/there/a.jsonc")), "../../panda.urdf");
}

#[test]
fn every_example_is_a_specification() {
    for known in [Example::Arm3, Example::Puma560, Example::Panda] {
        let (name, text) = example(known)[0];
        let loaded = parse(text, &file("specs").join(name)).expect("a specification");
        checked(loaded, Extent::Whole).expect("no fault");
    }
}

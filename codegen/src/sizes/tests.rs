use std::path::Path;

use super::{Row, Size, default_sizes, run};
use crate::load::{Loaded, parse};
use crate::pipeline::Generation;
use crate::progress::Silent;
use crate::spec::{DictionarySpec, ModelSpec, RobustGainSpec, ScalarSpec};

fn arm3() -> Loaded {
    parse(include_str!("../../specs/arm3.json"), Path::new("arm3.json")).unwrap()
}

fn xi(functions: usize) -> Size {
    Size::of(ModelSpec::Shared { functions })
}

#[test]
fn a_size_is_named_by_what_it_changes() {
    let all = Size {
        model: Some(ModelSpec::Tolerance { torque: 0.025 }),
        dictionary: Some(DictionarySpec::Union),
        robust_gain: Some(RobustGainSpec::Constant),
        scalar: Some(ScalarSpec::F32),
    };
    let names = [Size::default(), Size::of(ModelSpec::Exact), xi(6), all].map(|size| size.label());
    assert_eq!(names, ["as specified", "exact", "xi 6", "2.5 %, union, constant gain, f32"]);
}

#[test]
fn the_figures_are_those_of_the_same_specification() {
    let loaded = arm3();
    let (row, _) = run(&loaded, &xi(2), true, &Silent).unwrap();
    let mut same = loaded.clone();
    same.spec.model = ModelSpec::Shared { functions: 2 };
    let generation = Generation::new(same).unwrap();
    let text = generation.module().unwrap();
    assert_eq!((row.bytes, row.lines, row.functions), (text.len(), text.lines().count(), 2));
    assert_eq!(row.operations.total, generation.step().unwrap().operations().cost());
    assert_eq!(row.torque_error.as_deref(), generation.torque().map(|torque| &torque.error[..]));
    let statement = generation.statement().unwrap();
    assert_eq!(row.guarantee.as_ref().unwrap().kind, statement.kind.name());
    assert!(row.verdict.contains(&row.operations.total.to_string()), "{}", row.verdict);
}

#[test]
fn more_functions_leave_less_out() {
    let loaded = arm3();
    let rows: Vec<Row> = (1..=3).map(|k| run(&loaded, &xi(k), false, &Silent).unwrap().0).collect();
    let worst = |row: &Row| row.worst_fraction().unwrap();
    assert!(rows.windows(2).all(|pair| worst(&pair[1]) < worst(&pair[0])), "{rows:#?}");
    assert!(rows.iter().all(|row| row.guarantee.is_none()));
}

#[test]
fn a_size_is_read_as_it_is_named() {
    let read = |text: &str| text.parse::<Size>().map(|size| size.label());
    for (text, name) in [
        ("exact", "exact"),
        ("xi6", "xi 6"),
        ("xi 6 each", "xi 6 each"),
        ("0.5%", "0.5 %"),
        ("2.5 % + union+constant + f32", "2.5 %, union, constant gain, f32"),
    ] {
        assert_eq!(read(text).as_deref(), Ok(name), "{text}");
    }
    for text in ["", "xi", "xi-1", "%", "exact+xi2", "f16", "1%+1%"] {
        assert!(read(text).is_err(), "{text}");
    }
}

#[test]
fn rows_survive_a_file() {
    let (row, _) = run(&arm3(), &xi(1), true, &Silent).unwrap();
    let text = serde_json::to_string(&row).unwrap();
    assert_eq!(serde_json::from_str::<Row>(&text).unwrap(), row);
}

#[test]
fn the_sizes_tried_begin_with_the_exact_model_and_end_with_all_functions() {
    let sizes = default_sizes(&arm3()).unwrap();
    let names: Vec<String> = sizes.iter().map(Size::label).collect();
    assert_eq!(names[..5], ["exact", "0.5 %", "1 %", "2 %", "5 %"]);
    let counts: Vec<&str> = names[5..].iter().map(String::as_str).collect();
    // The specification's own number is among them, and none stands there twice.
    assert_eq!(counts, ["xi 1", "xi 2", "xi 3", "xi 5", "xi 7", "xi 11"]);
}

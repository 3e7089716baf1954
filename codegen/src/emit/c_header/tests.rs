//! The texts of a C interface.

use super::*;

#[test]
fn the_header_has_the_numbers_of_the_module() {
    let double = interface(Some(0.1), 0);
    let single = Interface { scalar: Scalar::of(ScalarSpec::F32), period: 0.1, ..double };
    assert!(header::text(&double).contains("#define A_1_PERIOD 1e-7\n"));
    let header = header::text(&single);
    assert!(header.contains("#define A_1_PERIOD 0.1f\n") && header.contains("float torque[3];"));
    assert!(header.contains("uint32_t opaque[8];") && !header.contains("double"));
    assert!(shim::text(&single).contains("mark: u32,") && !shim::text(&single).contains("f64"));
}

fn interface(duration: Option<f64>, parameters: usize) -> Interface<'static> {
    let scalar = Scalar::of(ScalarSpec::F64);
    Interface {
        name: "a_1",
        hash: "0a1f",
        scalar,
        joints: 3,
        parameters,
        period: 1e-7,
        duration,
        checked: false,
    }
}

fn texts(interface: &Interface) -> [String; 3] {
    [header::text(interface), interface.fill(MANIFEST), shim::text(interface)]
}

#[test]
fn every_word_is_filled_in() {
    let checked = Interface { checked: true, ..interface(None, 0) };
    for interface in [interface(None, 0), interface(Some(2.5), 4), checked] {
        for text in texts(&interface) {
            assert!(!text.contains("{{") && !text.contains("}}"), "{text}");
            assert!(text.ends_with('\n') && text.is_ascii(), "{text}");
        }
    }
}

#[test]
fn what_there_is_not_has_no_function() {
    let names = ["a_1_reference", "a_1_learnt", "a_1_restore", "A_1_DURATION", "A_1_PARAMETERS"];
    let [header, _, shim] = texts(&interface(None, 0));
    assert!(names.iter().all(|name| !header.contains(name) && !shim.contains(name)));
    let [header, _, shim] = texts(&interface(Some(2.5), 4));
    assert!(names.iter().all(|name| header.contains(name)));
    assert!(names[..3].iter().all(|name| shim.contains(name)));
    assert!(header.contains("#define A_1_PERIOD 1e-7\n") && header.contains("#define A_1_DURATION 2.5\n"));
}

#[test]
fn a_step_that_looks_at_the_desired_motion_has_faults_for_it() {
    let faults = ["POSITION_LIMIT = 9", "VELOCITY_LIMIT = 10", "ACCELERATION_LIMIT = 11"];
    let [plain, _, shim] = texts(&interface(None, 0));
    assert!(faults.iter().all(|fault| !plain.contains(fault)) && !shim.contains("Limit"));
    let [header, _, shim] = texts(&Interface { checked: true, ..interface(None, 0) });
    assert!(faults.iter().all(|fault| header.contains(&format!("A_1_FAULT_{fault},"))), "{header}");
    assert!(
        ["PositionLimit = 9,", "VelocityLimit = 10,", "AccelerationLimit = 11,"]
            .iter()
            .all(|x| shim.contains(x))
    );
}

#[test]
fn every_function_of_the_header_is_prefixed_and_in_the_library() {
    let [header, _, shim] = texts(&interface(Some(2.5), 4));
    let declared =
        |line: &&str| line.contains('(') && (line.starts_with("enum") || line.starts_with("const char"));
    let mut count = 0;
    for line in header.lines().filter(declared) {
        let name =
            line.split('(').next().and_then(|start| start.rsplit([' ', '*']).next()).unwrap_or_default();
        assert!(name.starts_with("a_1_") && shim.contains(&format!("extern \"C\" fn {name}(")), "{line}");
        count += 1;
    }
    assert_eq!(count, 8);
    assert_eq!(shim.matches("extern \"C\" fn ").count(), count);
}

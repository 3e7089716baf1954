//! The texts of a C interface.

use super::*;

fn interface(duration: Option<f64>, parameters: usize, std: bool) -> Interface<'static> {
    let scalar = Scalar::of(ScalarSpec::F64);
    Interface { name: "a_1", hash: "0a1f", scalar, joints: 3, parameters, period: 1e-7, duration, std }
}

fn texts(interface: &Interface) -> [String; 3] {
    [header::text(interface), manifest::text(interface), shim::text(interface)]
}

#[test]
fn every_word_is_filled_in() {
    for interface in [interface(None, 0, false), interface(Some(2.5), 4, true)] {
        for text in texts(&interface) {
            assert!(!text.contains("{{") && !text.contains("}}"), "{text}");
            assert!(text.ends_with('\n') && text.is_ascii(), "{text}");
        }
    }
}

#[test]
fn what_there_is_not_has_no_function() {
    let names = ["a_1_reference", "a_1_learnt", "a_1_restore", "A_1_DURATION", "A_1_PARAMETERS"];
    let [header, manifest, shim] = texts(&interface(None, 0, false));
    assert!(names.iter().all(|name| !header.contains(name) && !shim.contains(name)));
    assert!(manifest.contains("panic_handler = []"));
    let [header, manifest, shim] = texts(&interface(Some(2.5), 4, true));
    assert!(names.iter().all(|name| header.contains(name)) && !shim.contains("#[panic_handler]"));
    assert!(!manifest.contains("panic_handler"));
    assert!(header.contains("#define A_1_PERIOD 1e-7\n") && header.contains("#define A_1_DURATION 2.5\n"));
}

#[test]
fn every_function_of_the_header_is_prefixed_and_in_the_library() {
    let [header, _, shim] = texts(&interface(Some(2.5), 4, false));
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

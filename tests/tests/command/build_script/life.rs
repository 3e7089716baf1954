//! A package through its life: valid, broken, repaired, renamed, deleted, of two specifications, with files that change.

use std::fs;

use super::package::{Package, spec, urdf};

/// Line and column of the first `value` in `text`, as messages name them.
fn place(text: &str, value: &str) -> String {
    let at = text.find(value).expect("a value");
    let (line, column) =
        (text[..at].matches('\n').count(), text[..at].rsplit('\n').next().map_or(0, str::len));
    format!("{}:{}", line + 1, column + 1)
}

/// A package of one specification `specs/arm.json`, run once.
fn arm(name: &str) -> Package {
    let package = Package::new(name);
    package.write("specs/arm.json", &spec("arm", "arm.urdf", 0.001));
    package.write("specs/arm.urdf", &urdf("joint1", "link1", 1.0));
    package.specs(&["specs/arm.json"]);
    package.modules(&["arm"]);
    let before = package.listing();
    assert_eq!(package.run().good(), "0.001\n");
    assert_eq!(package.listing(), before, "nothing is written outside OUT_DIR");
    package
}

#[test]
fn a_broken_specification_breaks_the_build_until_it_is_repaired() {
    let package = arm("gramforge-scratch-broken");
    let module = package.out_dir().join("arm.rs");
    let good = fs::read_to_string(&module).expect("a module");
    let before = package.listing();
    let broken = spec("arm", "arm.urdf", -1.0);
    let period = format!("specs/arm.json:{}: control.period: is -1", place(&broken, "-1"));
    for (text, words) in [
        (broken.as_str(), period.as_str()),
        ("{", "specs/arm.json:1:1: is not JSON that can be read "),
        ("{\"name\": 3}", "specs/arm.json:1:10: name: is 3"),
    ] {
        package.write("specs/arm.json", text);
        // Twice: a failure must not be taken for done the second time.
        for _ in 0..2 {
            package.run().bad(&[words]);
            let stale = fs::read_to_string(&module).expect("a module");
            let told = stale.contains("::core::compile_error!(") && stale.contains(words);
            assert!(told && stale.lines().count() == 2, "{stale}");
        }
    }
    package.write("specs/arm.json", &spec("arm", "arm.urdf", 0.001));
    assert_eq!(package.run().good(), "0.001\n");
    assert_eq!(fs::read_to_string(&module).expect("a module"), good);
    assert_eq!(package.listing(), before);
}

#[test]
fn no_module_outlives_its_specification() {
    let package = arm("gramforge-scratch-renamed");
    let out_dir = package.out_dir();
    package.write("specs/arm.json", &spec("other", "arm.urdf", 0.002));
    package.run().bad(&["arm.rs"]);
    assert!(!out_dir.join("arm.rs").exists() && out_dir.join("other.rs").exists());
    package.modules(&["other"]);
    assert_eq!(package.run().good(), "0.002\n");

    fs::remove_file(package.path("specs/arm.json")).expect("removed");
    package.run().bad(&["specs/arm.json: cannot be read"]);
    let stale = fs::read_to_string(out_dir.join("other.rs")).expect("a module");
    assert!(stale.contains("::core::compile_error!("), "{stale}");

    // No specification at all.
    package.specs(&[]);
    package.run().bad(&["other.rs"]);
    assert!(!out_dir.join("other.rs").exists());
}

/// The entries of the cache whose names begin with `kind`.
fn kept(package: &Package, kind: &str) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(package.out_dir().join("gramforge-cache")).expect("a cache");
    let own = |path: &std::path::PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind))
    };
    entries.map(|entry| entry.expect("an entry").path()).filter(own).collect()
}

#[test]
fn what_is_kept_is_what_would_be_made() {
    let package = arm("gramforge-scratch-kept");
    let module = package.out_dir().join("arm.rs");
    let again = |period: f64| {
        package.write("specs/arm.json", &spec("arm", "arm.urdf", period));
        assert_eq!(package.run().good(), format!("{period}\n"));
        fs::read_to_string(&module).expect("a module")
    };
    let first = again(0.001);
    let (models, modules) = (kept(&package, "model-"), kept(&package, "module-"));
    assert_eq!((models.len(), modules.len()), (1, 1), "{models:?} {modules:?}");

    // Another period changes the module, and nothing that the model follows from.
    let second = again(0.002);
    assert_ne!(first, second);
    assert_eq!(kept(&package, "model-"), models);
    assert_ne!(kept(&package, "module-"), modules);
    assert_eq!(again(0.001), first);

    // An entry is read: with a right hash it is believed, with a wrong one it is made anew.
    let entry = &kept(&package, "module-")[0];
    let text = fs::read_to_string(entry).expect("an entry");
    let body = text.split_once('\n').expect("a hash").1;
    fs::write(entry, format!("{}\n{}", "0".repeat(64), body.replace("0.001", "0.003"))).expect("written");
    assert_eq!(again(0.001), first);
    fs::write(&models[0], "").expect("written");
    assert_eq!(again(0.002), second);
    let entry = &kept(&package, "module-")[0];
    let body = "{\"module\":\"compile_error!(\\\"kept\\\");\",\"warnings\":[]}";
    // SHA-256 of `body`.
    let hash = "6c73b8ed8c41889faf84069ca6f85300a57c2b5cb91fc963dab5a01597250a36";
    fs::write(entry, format!("{hash}\n{body}")).expect("written");
    package.write("specs/arm.json", &spec("arm", "arm.urdf", 0.002));
    package.run().bad(&["kept"]);

    // Without the cache, and with a robot file that has changed, all is made anew.
    package.build_script(
        "gramforge::Config::new().spec(\"specs/arm.json\").cache(false).run_in_build_script();",
    );
    assert_eq!(again(0.002), second);
    package.specs(&["specs/arm.json"]);
    package.write("specs/arm.urdf", &urdf("joint1", "link1", 2.0));
    assert_ne!(again(0.002), second);
}

#[test]
fn two_specifications_stand_and_fall_together() {
    let package = arm("gramforge-scratch-two");
    package.write("specs/second.json", &spec("second", "arm.urdf", 0.002));
    package.specs(&["specs/arm.json", "specs/second.json"]);
    package.modules(&["arm", "second"]);
    assert_eq!(package.run().good(), "0.001\n0.002\n");

    let (first, second) = (spec("arm", "arm.urdf", -1.0), spec("second", "arm.urdf", -2.0));
    package.write("specs/arm.json", &first);
    package.write("specs/second.json", &second);
    package.run().bad(&[
        &format!("specs/arm.json:{}: control.period: is -1", place(&first, "-1")),
        &format!("specs/second.json:{}: control.period: is -2", place(&second, "-2")),
    ]);
    for module in ["arm.rs", "second.rs"] {
        let stale = fs::read_to_string(package.out_dir().join(module)).expect("a module");
        assert!(stale.contains("is -1") && stale.contains("is -2"), "{stale}");
    }

    // Two configurations one after the other know of each other.
    package.write("specs/arm.json", &spec("arm", "arm.urdf", 0.003));
    package.write("specs/second.json", &spec("second", "arm.urdf", 0.004));
    let one = |spec| format!("    gramforge::Config::new().spec({spec:?}).run_in_build_script();\n");
    let script = format!("fn main() {{\n{}{}}}\n", one("specs/arm.json"), one("specs/second.json"));
    package.write("build.rs", &script);
    assert_eq!(package.run().good(), "0.003\n0.004\n");

    package.specs(&["specs/second.json"]);
    package.modules(&["second"]);
    assert_eq!(package.run().good(), "0.004\n");
    assert!(!package.out_dir().join("arm.rs").exists());
}

#[test]
fn a_named_file_is_watched() {
    let package = arm("gramforge-scratch-watched");
    let module = package.out_dir().join("arm.rs");
    let light = fs::read_to_string(&module).expect("a module");
    package.write("specs/arm.urdf", &urdf("joint1", "link1", 2.0));
    assert_eq!(package.run().good(), "0.001\n");
    let heavy = fs::read_to_string(&module).expect("a module");
    let header = |text: &str| text.lines().nth(1).map(str::to_string);
    assert!(heavy != light && header(&heavy) != header(&light), "the URDF's bytes count in module and hash");

    fs::remove_file(package.path("specs/arm.urdf")).expect("removed");
    let named = place(&spec("arm", "arm.urdf", 0.001), "\"arm.urdf\"");
    package
        .run()
        .bad(&[&format!("specs/arm.json:{named}: arm.urdf: names specs/arm.urdf, which cannot be read")]);
    assert!(fs::read_to_string(&module).expect("a module").contains("::core::compile_error!("));

    package.write("specs/arm.urdf", &urdf("joint1", "link1", 1.0));
    assert_eq!(package.run().good(), "0.001\n");
    assert_eq!(fs::read_to_string(&module).expect("a module"), light);
}

#[test]
fn a_joint_cannot_give_directives() {
    let package = arm("gramforge-scratch-directive");
    for (joint, kind) in
        [("j&#10;cargo:rustc-env=INJECTED=1", "\\n"), ("j&#13;cargo::rustc-env=INJECTED=1", "\\r")]
    {
        package.write("specs/arm.urdf", &urdf(joint, "link1", 1.0));
        let told = package.run().bad(&[&format!("joint[j{kind}cargo:"), "with the hidden character U+00"]);
        let raw = |line: &str| line.trim_start().starts_with("cargo:rustc-env") || line.contains('\r');
        assert!(!told.lines().any(raw), "{told}");
    }
}

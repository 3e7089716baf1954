//! Tells the library how it is optimised: a build script runs it, and may have to warn.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let level = std::env::var("OPT_LEVEL").unwrap_or_default();
    println!("cargo:rustc-env=GRAMFORGE_OPT_LEVEL={level}");
}

//! Packages made for a test: generated modules compiled as a user's crate would compile them.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A generated module: its name, its number of joints, its text.
pub type Module = (String, usize, String);

/// A program of compiled modules that answers torques.
#[derive(Debug)]
pub struct Program(PathBuf);

/// One call of a module's passivity torque: q, q̇, v_r and a_r, one after the other.
pub type Call = (usize, Vec<f64>);

/// Makes a program `scratch` of `main` in `folder`, about the runtime with these features, with the lock file of the workspace.
pub fn package(folder: &Path, features: &[&str], main: &str) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = folder.join("src");
    std::fs::create_dir_all(&source).expect("a folder");
    let runtime = here.join("../runtime").canonicalize().expect("the runtime");
    let manifest = format!(
        "[package]\nname = \"scratch\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\n\
         gramforge-runtime = {{ path = {runtime:?}, features = {features:?} }}\n\n[profile.dev]\nopt-level = 0\ndebug = false\n\n[workspace]\n"
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
    std::fs::copy(here.join("../Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
    std::fs::write(source.join("main.rs"), main).expect("a program");
}

/// Compiles `modules` in `folder`, with the lock file and without a network.
pub fn compile(folder: &Path, modules: &[Module]) -> Program {
    let source = folder.join("src");
    let mut main = String::from(MAIN);
    let mut arms = String::new();
    for (index, (name, joints, _)) in modules.iter().enumerate() {
        writeln!(main, "#[allow(dead_code)] mod {name} {{ include!(\"{name}.rs\"); }}").expect("text");
        let model = gramforge::internals::emit::type_name(name);
        writeln!(arms, "        {index} => torque::<{joints}>(&{name}::{model}, &x),").expect("text");
    }
    write!(main, "fn called(index: usize, x: Vec<f64>) -> Vec<f64> {{\n    match index {{\n{arms}        _ => Vec::new(),\n    }}\n}}\n")
        .expect("text");
    package(folder, &[], &main);
    for (name, _, text) in modules {
        std::fs::write(source.join(format!("{name}.rs")), text).expect("a module");
    }
    let built = cargo(folder, &["build", "--offline", "--quiet"]).output().expect("cargo starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    Program(folder.join("target/debug/scratch"))
}

/// Cargo in `folder`, as a user calls it: nothing of the running build reaches it.
pub fn cargo(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(folder).args(arguments).env("CARGO_TARGET_DIR", folder.join("target"));
    let own = |name: &str| {
        name.starts_with("CARGO_")
            || matches!(name, "RUSTFLAGS" | "RUSTC_WRAPPER" | "RUSTC_WORKSPACE_WRAPPER")
    };
    for (name, _) in std::env::vars().filter(|(name, _)| own(name)) {
        if name != "CARGO_TARGET_DIR" && name != "CARGO_HOME" {
            command.env_remove(name);
        }
    }
    command
}

impl Program {
    /// The torques of all calls, N·m or N.
    pub fn torques(&self, calls: &[Call]) -> Vec<Vec<f64>> {
        called(&self.0, calls.iter().map(|(index, x)| (index.to_string(), x.as_slice())))
    }
}

/// What `program` answers to `calls`: a line for each, its words and then its numbers by their bits.
pub fn called<'a>(program: &Path, calls: impl Iterator<Item = (String, &'a [f64])>) -> Vec<Vec<f64>> {
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut input = String::new();
    for (words, x) in calls {
        input.push_str(&words);
        x.iter().for_each(|x| write!(input, " {:x}", x.to_bits()).expect("text"));
        input.push('\n');
    }
    let mut pipe = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || pipe.write_all(input.as_bytes()));
    let output = child.wait_with_output().expect("the program ends");
    writer.join().expect("a thread").expect("all calls are read");
    let number = |word: &str| f64::from_bits(u64::from_str_radix(word, 16).expect("bits"));
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines().map(|line| line.split_whitespace().map(number).collect()).collect()
}

const MAIN: &str = r#"use gramforge_runtime::Model;

fn torque<const N: usize>(model: &impl Model<N, Scalar = f64>, x: &[f64]) -> Vec<f64> {
    let part = |k: usize| -> [f64; N] { core::array::from_fn(|i| x[k * N + i]) };
    model.passivity_torque(&part(0), &part(1), &part(2), &part(3)).to_vec()
}

fn main() {
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut words = line.split_whitespace();
        let index = words.next().unwrap().parse().unwrap();
        let x = words.map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap())).collect();
        let bits: Vec<String> = called(index, x).iter().map(|t| format!("{:x}", t.to_bits())).collect();
        println!("{}", bits.join(" "));
    }
}
"#;

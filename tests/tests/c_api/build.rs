//! Modules with a C interface, their libraries, and programs that use these.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use gramforge::{Config, Output};
use gramforge_tests::{scratch, spec};
use serde_json::{Value, json};

/// A folder with the files of some modules and their libraries.
pub struct Library {
    folder: PathBuf,
    archives: Vec<PathBuf>,
}

/// A compiler and the language that it takes a program for.
#[derive(Clone, Copy, Debug)]
pub enum Language {
    C99,
    Cpp17,
}

/// A program.
pub struct Program(PathBuf);

/// `here` as in the workspace's tests folder.
fn ours(here: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(here).canonicalize().expect("a file of the workspace")
}

/// Whether `tool` can be started.
pub fn installed(tool: &str) -> bool {
    let there = Command::new(tool).arg("--version").output().is_ok_and(|output| output.status.success());
    if !there {
        eprintln!("{tool} is not installed: what needs it is not tested");
    }
    there
}

/// The specification `name`, with a C interface.
pub fn with_c_api(name: &str) -> Value {
    let text = fs::read_to_string(spec(name)).expect("a specification");
    let mut value: Value = serde_json::from_str(&text).expect("JSON");
    value["emit"]["c_api"] = json!(true);
    value
}

/// Writes the specifications into the folder `specs` and what they give into `out`.
pub fn generate(values: &[Value], specs: &Path, out: &Path) -> Vec<Output> {
    fs::create_dir_all(specs).expect("a folder");
    let mut config = Config::new().out_dir(out);
    for value in values {
        let path = specs.join(format!("{}.json", value["name"].as_str().expect("a name")));
        fs::write(&path, value.to_string()).expect("written");
        config = config.spec(path);
    }
    config.generate().unwrap_or_else(|error| panic!("{error}"))
}

/// Tells the cargo that runs below `folder` where the runtime is, as a user does who has no package registry.
pub fn patch(folder: &Path) {
    let runtime = ours("../runtime");
    let text =
        format!("[patch.crates-io]\ngramforge-runtime = {{ path = {runtime:?} }}\n[net]\noffline = true\n");
    fs::create_dir_all(folder.join(".cargo")).expect("a folder");
    fs::write(folder.join(".cargo/config.toml"), text).expect("written");
}

/// The workspace's lock file, for the crate in `shim`.
pub fn lock(shim: &Path) {
    fs::copy(ours("../Cargo.lock"), shim.join("Cargo.lock")).expect("the lock file");
}

impl Library {
    /// Generates and builds the modules of these specifications.
    pub fn new(specs: &[Value]) -> Self {
        // The same place every time: what cargo has built of the crates behind them is not built again.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_api");
        let _ = fs::remove_dir_all(folder.join("out"));
        patch(&folder);
        generate(specs, &folder.join("specs"), &folder.join("out"));
        let mut library = Self { folder, archives: Vec::new() };
        for spec in specs {
            let name = spec["name"].as_str().expect("a name");
            let shim = library.file(&format!("{name}_c"));
            lock(&shim);
            let target = library.folder.join("target");
            let mut cargo = scratch::cargo(&shim, &["build", "--quiet"]);
            let output = cargo.env("CARGO_TARGET_DIR", &target).env("RUSTFLAGS", "-D warnings").output();
            let output = output.expect("cargo starts");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            library.archives.push(target.join(format!("debug/lib{name}_c.a")));
        }
        library
    }

    /// A file that was generated.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join("out").join(name)
    }

    /// The program of `source`, a file of the folder `c`, with all libraries. A warning is an error.
    pub fn compile(&self, source: &str, language: Language) -> Program {
        let program = self.folder.join(format!("{source}.{language:?}"));
        let mut command = Command::new(language.compiler());
        command.args(language.arguments()).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]);
        command.arg(self.folder.join("out")).arg(ours("c").join(source));
        // The libraries are no source.
        command.args(["-x", "none"]).args(&self.archives).arg("-o").arg(&program);
        let output = command.output().expect("the compiler starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Program(program)
    }
}

impl Language {
    /// Those whose compilers are there.
    pub fn installed() -> Vec<Self> {
        [Self::C99, Self::Cpp17].into_iter().filter(|language| installed(language.compiler())).collect()
    }

    fn compiler(self) -> &'static str {
        match self {
            Self::C99 => "gcc",
            Self::Cpp17 => "g++",
        }
    }

    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::C99 => &["-std=c99", "-x", "c"],
            Self::Cpp17 => &["-std=c++17", "-x", "c++"],
        }
    }
}

impl Program {
    /// What it prints, by lines, when it reads `input`.
    pub fn answers(&self, input: &str) -> Vec<String> {
        let mut child = Command::new(&self.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut pipe = child.stdin.take().expect("a pipe");
        let input = input.to_string();
        let writer = std::thread::spawn(move || pipe.write_all(input.as_bytes()));
        let output = child.wait_with_output().expect("the program ends");
        let text = String::from_utf8(output.stdout).expect("text");
        assert!(output.status.success(), "{} {text}", output.status);
        writer.join().expect("a thread").expect("all is read");
        text.lines().map(str::to_string).collect()
    }
}

//! A user's package in a folder of its own, built by the real cargo.
//!
//! All packages build into the workspace's target folder, with its lock file and its profiles: of the crates behind the
//! generator none is built anew. The generator is built once for all of them, in the way that takes least time.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use gramforge_tests::scratch;
use serde_json::{Value, json};

/// A package that depends on the generator as a user's does.
pub struct Package {
    folder: PathBuf,
    name: String,
}

/// What cargo made of it.
#[derive(Debug)]
pub struct Built {
    /// Whether cargo ended with exit code 0.
    pub good: bool,
    /// Standard output: that of the program where it was run.
    pub stdout: String,
    /// What cargo says.
    pub stderr: String,
}

impl Built {
    /// Asserts that all went well; standard output.
    pub fn good(self) -> String {
        assert!(self.good, "{self:#?}");
        self.stdout
    }

    /// Asserts that cargo failed and showed `words` as errors; what it said.
    pub fn bad(self, words: &[&str]) -> String {
        assert!(!self.good, "{self:#?}");
        for word in words {
            let told = self.stderr.lines().any(|line| line.starts_with("error") && line.contains(word));
            assert!(told, "no error {word:?} in {}", self.stderr);
        }
        self.stderr
    }
}

/// The workspace's target folder.
fn target() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder")
}

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.canonicalize().expect("the workspace")
}

impl Package {
    /// An empty package called `name`, which no other test may use.
    pub fn new(name: &str) -> Self {
        // The same place every time: cargo would keep what it built of every other one.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        let package = Self { folder, name: name.to_string() };
        let root = root();
        let workspace = fs::read_to_string(root.join("Cargo.toml")).expect("the workspace's manifest");
        let profiles = workspace.find("[profile").map_or("", |at| &workspace[at..]);
        let own = "[profile.dev.package.gramforge]\n";
        let profiles = profiles.replace(&format!("{own}opt-level = 3\n"), "");
        let crates = root.display();
        package.write(
            "Cargo.toml",
            &format!(
                "[package]\nname = {name:?}\nedition = \"2024\"\n\n[workspace]\n\n\
                 [dependencies]\ngramforge-runtime = {{ path = \"{crates}/runtime\", features = [\"std\"] }}\n\n\
                 [build-dependencies]\ngramforge = {{ path = \"{crates}/codegen\" }}\n\n\
                 [lints.rust]\nwarnings = \"deny\"\n\n{profiles}\n{own}opt-level = 1\ndebug = false\n"
            ),
        );
        let lock = fs::read_to_string(root.join("Cargo.lock")).expect("the workspace's lock file");
        package.write("Cargo.lock", &lock);
        package
    }

    /// The path of `file`.
    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// Writes `file`, with folders on the way.
    pub fn write(&self, file: &str, text: &str) {
        let path = self.path(file);
        fs::create_dir_all(path.parent().expect("a folder")).expect("folders");
        fs::write(&path, text).expect("written");
    }

    /// Writes the build script of these specifications.
    pub fn specs(&self, specs: &[&str]) {
        let calls: String = specs.iter().map(|spec| format!(".spec({spec:?})")).collect();
        self.build_script(&format!("gramforge::Config::new(){calls}.run_in_build_script();"));
    }

    /// Writes a build script that runs `statement`.
    pub fn build_script(&self, statement: &str) {
        self.write("build.rs", &format!("fn main() {{\n    {statement}\n}}\n"));
    }

    /// Writes a program that includes these modules and prints the control period of each.
    pub fn modules(&self, modules: &[&str]) {
        let mut text = String::new();
        for module in modules {
            text += &format!(
                "mod {module} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{module}.rs\"));\n}}\n"
            );
        }
        let prints: String =
            modules.iter().map(|m| format!("    println!(\"{{}}\", {m}::SETTINGS.period);\n")).collect();
        self.write("src/main.rs", &format!("{text}fn main() {{\n{prints}}}\n"));
    }

    /// `cargo ARGUMENTS` in the package.
    pub fn cargo(&self, arguments: &[&str]) -> Built {
        let mut command = scratch::cargo(&self.folder, arguments);
        command
            .env("CARGO_TARGET_DIR", target())
            .env("CARGO_NET_OFFLINE", "true")
            .env("CARGO_TERM_COLOR", "never");
        let output = command.output().expect("cargo starts");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Built { good: output.status.success(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// Builds and runs it.
    pub fn run(&self) -> Built {
        self.cargo(&["run"])
    }

    /// The folder that its build script writes to, of which there is one.
    pub fn out_dir(&self) -> PathBuf {
        let build =
            Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder").join("debug/build");
        let list = |folder: &Path| -> Vec<PathBuf> {
            let entries = fs::read_dir(folder).expect("a folder");
            entries.map(|entry| entry.expect("an entry").path()).collect()
        };
        let own = |path: &PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            // Another compiler may have left another one.
            name.rsplit_once('-').is_some_and(|(package, _)| package == self.name)
        };
        let outs: Vec<PathBuf> = list(&build)
            .into_iter()
            .filter(own)
            .map(|path| path.join("out"))
            .filter(|out| out.exists())
            .collect();
        let time =
            |path: &PathBuf| fs::metadata(path.with_file_name("output")).and_then(|m| m.modified()).ok();
        outs.into_iter().max_by_key(time).expect("a build script has run")
    }

    /// Every file and folder of the package.
    pub fn listing(&self) -> BTreeSet<PathBuf> {
        let mut found = BTreeSet::new();
        let mut folders = vec![self.folder.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path.clone());
                }
                found.insert(path);
            }
        }
        found
    }
}

/// The text of a specification called `name` of a robot of one joint from `urdf`, controlled every `period` seconds.
pub fn spec(name: &str, urdf: &str, period: f64) -> String {
    value(name, urdf, period).to_string()
}

/// The same as JSON.
pub fn value(name: &str, urdf: &str, period: f64) -> Value {
    json!({
        "name": name,
        "arm": { "urdf": urdf },
        "motion": { "quintic": { "from": [0.1], "to": [0.6], "duration": 2.0 } },
        "model": "exact",
        "control": { "law": "exact", "period": period, "W": 10.0, "Pqq": 4.0, "Omega": 16.0 }
    })
}

/// A robot of one joint with these names, whose link has this mass.
pub fn urdf(joint: &str, link: &str, mass: f64) -> String {
    format!(
        "<robot name=\"r\"><link name=\"base\"/><link name=\"{link}\"><inertial><origin xyz=\"0.1 0.02 0.03\"/>\
         <mass value=\"{mass}\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>\
         </link><joint name=\"{joint}\" type=\"revolute\"><parent link=\"base\"/><child link=\"{link}\"/>\
         <axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2\" effort=\"3.14\" velocity=\"2\"/></joint></robot>"
    )
}

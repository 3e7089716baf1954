//! `gramforge init`: a first specification.

mod trial;

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::show_warnings;
use crate::error::{Diagnostics, Error};
use crate::init::{Example, First, Request, TRIALS, example, first};
use crate::load::{SCHEMA, module_name};
use crate::output::{Wanted, write_all};
use crate::spec::LawSpec;
use trial::{Tried, tried};

/// Writes a first specification for a robot: complete, with comments, and tried out.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  gramforge init ur5.urdf
  gramforge init panda.urdf --tip panda_hand --out specs/panda.jsonc
  gramforge init --example puma560")]
pub(super) struct Init {
    /// The URDF file of the robot.
    #[arg(required_unless_present = "example")]
    urdf: Option<PathBuf>,
    /// Take an arm that comes with the program instead.
    #[arg(long, value_enum, conflicts_with = "urdf")]
    example: Option<Example>,
    /// The specification file to write. Default: NAME.jsonc in the working directory. The schema is written next to it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Name of the generated module. Default: that of the specification file, which is the robot's where --out is not given.
    #[arg(long, conflicts_with = "example")]
    name: Option<String>,
    /// The link at which the arm ends. Default: the likeliest; all are listed.
    #[arg(long, conflicts_with = "example", value_name = "LINK")]
    tip: Option<String>,
    /// The tracking law, or `none` for a model alone.
    #[arg(long, value_enum, default_value_t = Control::Tight, conflicts_with = "example", value_name = "LAW")]
    control: Control,
    /// Write the specification without trying it out.
    #[arg(long)]
    untried: bool,
    /// Replace files that are there.
    #[arg(long)]
    force: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Control {
    None,
    Exact,
    Report,
    Tight,
    Adaptive,
}

const SCHEMA_NAME: &str = "gramforge.schema.json";

impl Init {
    pub(super) fn run(&self) -> Result<String, Error> {
        match (&self.example, &self.urdf) {
            (Some(known), _) => self.example(*known),
            (None, Some(urdf)) => self.robot(urdf),
            (None, None) => Err(Error::Internal("neither a robot nor an example was named".into())),
        }
    }

    fn example(&self, known: Example) -> Result<String, Error> {
        let files = example(known);
        let name = files.first().map_or("", |(name, _)| *name);
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from(name));
        let beside = |name: &str| out.with_file_name(name);
        let mut wanted: Vec<(PathBuf, &str)> =
            vec![(out.clone(), files.first().map_or("", |(_, text)| text))];
        wanted.extend(files.iter().skip(1).map(|(name, text)| (beside(name), *text)));
        wanted.push((beside(SCHEMA_NAME), SCHEMA));
        let written = self.write(&wanted)?;
        Ok(format!("{written}\n{}", next(&out, true)))
    }

    fn robot(&self, urdf: &Path) -> Result<String, Error> {
        let law = match self.control {
            Control::None => None,
            Control::Exact => Some(LawSpec::Exact),
            Control::Report => Some(LawSpec::Report),
            Control::Tight => Some(LawSpec::Tight),
            Control::Adaptive => Some(LawSpec::Adaptive),
        };
        let mut request = Request {
            urdf: urdf.to_path_buf(),
            out: self.out.clone().unwrap_or_else(|| PathBuf::from("arm.jsonc")),
            name: self.name.clone().or(self.out.as_deref().map(named_after)),
            tip: self.tip.clone(),
            law,
        };
        let begun = first(&request, TRIALS[0])?;
        if self.out.is_none() {
            request.out = PathBuf::from(format!("{}.jsonc", begun.loaded.spec.name));
        }
        self.refuse_standing(&[request.out.clone(), request.out.with_file_name(SCHEMA_NAME)])?;
        show_warnings(&begun.warnings);
        let Tried { first, said, good } = match self.untried {
            true => Tried { first: first(&request, TRIALS[0])?, said: String::new(), good: true },
            false => tried(&request)?,
        };
        let wanted =
            [(request.out.clone(), first.text.as_str()), (request.out.with_file_name(SCHEMA_NAME), SCHEMA)];
        let written = self.write(&wanted)?;
        let module = &first.loaded.spec.name;
        let named = format!("Module: {module}, in {module}.rs\n");
        Ok(format!("{written}{named}{}{said}\n{}", about(&first), next(&request.out, good)))
    }

    /// Writes the files and says so.
    fn write(&self, files: &[(PathBuf, &str)]) -> Result<String, Error> {
        self.refuse_standing(&files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>())?;
        let wanted: Vec<Wanted> = files.iter().map(|(path, text)| (path.as_path(), *text)).collect();
        write_all(&wanted)?;
        Ok(files.iter().map(|(path, _)| format!("{}: written\n", path.display())).collect())
    }

    /// A fault for each file that is there and may not be replaced. A schema that is there is the same or an older one.
    fn refuse_standing(&self, paths: &[PathBuf]) -> Result<(), Error> {
        let mut faults = Diagnostics::of(Path::new(""));
        let standing = |path: &&PathBuf| match fs::symlink_metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => false,
            _ => path.file_name().is_none_or(|name| name != SCHEMA_NAME),
        };
        for path in paths.iter().filter(standing).filter(|_| !self.force) {
            faults.push_in(
                path,
                "",
                "is there already",
                "write --force to replace it, or --out with another path",
            );
        }
        faults.finish(())
    }
}

/// The name of a module after its specification file.
fn named_after(out: &Path) -> String {
    module_name(&out.file_stem().unwrap_or_default().to_string_lossy())
}

/// What was chosen, and what else there is.
fn about(first: &First) -> String {
    let mut out = String::new();
    let joints = first.arm.dof();
    let tip = first.tips.first().map_or("", |tip| tip.link.as_str());
    out += &format!("Arm: {joints} joints to the link {tip}");
    let others: Vec<&str> = first.tips.iter().skip(1).map(|tip| tip.link.as_str()).collect();
    if !others.is_empty() {
        out += &format!(" (others, for --tip: {})", crate::text::listed(&others));
    }
    out.push('\n');
    for (name, at) in &first.locked {
        out += &format!("Held: {name} at {at:?}: it moves a branch off the way to the tip\n");
    }
    let bare: Vec<&str> = first
        .arm
        .joints
        .iter()
        .filter(|joint| joint.armature == 0.0)
        .map(|joint| joint.name.as_str())
        .collect();
    if !bare.is_empty() {
        out += &format!(
            "Armature: zero for {}.\n  Write it under `arm.joints`: the inertia of the rotor times the square of the gear ratio,\n  mostly 0.05 \
             to 1 kg m^2. Without it wrists look too light, gains and guarantee are those of\n  another arm, and often there is no \
             guarantee.\n",
            crate::text::listed(&bare)
        );
    }
    out += &format!(
        "Motion: {:?} s, half a radian or less by joint, at rest at both ends\n",
        first.motion.duration
    );
    out
}

/// What to run next; `good` where the specification can be used as it is.
fn next(out: &Path, good: bool) -> String {
    let path = out.display();
    let stem = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let commands = [
        (format!("gramforge inspect {path}"), "what it amounts to"),
        (format!("gramforge sweep {path}"), "which model size pays"),
        (format!("gramforge simulate {path} --runs 100"), "how it tracks"),
        (format!("gramforge report {path} --out {stem}.html"), "all of it, with pictures"),
        (format!("gramforge generate {path} --out src"), "the module"),
    ];
    let width = commands.iter().map(|(command, _)| command.chars().count()).max().unwrap_or_default();
    let line = |(command, what): &(String, &str)| format!("  {command:width$}  {what}\n");
    let when = if good { "Next" } else { "Once it is changed" };
    format!("{when}:\n{}", commands.iter().map(line).collect::<String>())
}

//! A first specification for a robot file: complete, with comments, and inside the arm's limits.

mod examples;
mod motion;
mod text;

use std::path::{Path, PathBuf};

use crate::arm::{Arm, Tip, survey};
use crate::error::{Diagnostics, Error};
use crate::load::{Loaded, Named, module_name, parse};
use crate::spec::LawSpec;

pub use examples::{Example, example};
pub use motion::{FirstMotion, first_motion};

/// What a first specification is made of.
#[derive(Clone, Debug)]
pub struct Request {
    /// The URDF file.
    pub urdf: PathBuf,
    /// Where the specification will be; the path of the URDF file in it starts there.
    pub out: PathBuf,
    /// Name of the module; `None` for one from the name of the robot.
    pub name: Option<String>,
    /// The link at which the arm ends; `None` for the likeliest.
    pub tip: Option<String>,
    /// The tracking law; `None` for a model alone.
    pub law: Option<LawSpec>,
}

/// A first specification.
#[derive(Clone, Debug)]
pub struct First {
    /// Its text: JSON with comments.
    pub text: String,
    /// The same, read; its files are those of the request.
    pub loaded: Loaded,
    /// The arm.
    pub arm: Arm,
    /// All links at which the arm may end, the chosen one first.
    pub tips: Vec<Tip>,
    /// The joints that are held, with their positions, rad or m.
    pub locked: Vec<(String, f64)>,
    /// The motion.
    pub motion: FirstMotion,
    /// What is odd about the robot file.
    pub warnings: Vec<String>,
}

/// What is asked of the controller.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Time in which errors are to fall to 1/20, s.
    pub convergence_time: f64,
    /// Largest position error by joint for which the model is bounded, rad or m.
    pub tube: f64,
}

/// What is tried, one after the other: the first with which a promise can be kept is taken. The narrow tube comes first: over it the
/// inertia of a light wrist can be bounded, and most errors stay inside.
pub const TRIALS: [Trial; 3] = [
    Trial { convergence_time: 1.0, tube: 0.02 },
    Trial { convergence_time: 2.0, tube: 0.02 },
    Trial { convergence_time: 4.0, tube: 0.05 },
];

/// The first specification for `request` that asks for `trial`.
///
/// # Errors
/// [`Error::Input`] with every fault of the robot file and of the request.
pub fn first(request: &Request, trial: Trial) -> Result<First, Error> {
    let named = Named::alone("arm.urdf", &request.urdf);
    let surveyed = survey(&named)?;
    let mut tips = surveyed.tips;
    let tip = chosen(request, &mut tips)?;
    let name = request.name.clone().unwrap_or_else(|| {
        let stem = request.urdf.file_stem().unwrap_or_default().to_string_lossy();
        module_name(if surveyed.name.is_empty() { &stem } else { &surveyed.name })
    });
    let mut page = text::Page {
        name,
        urdf: relative(&request.urdf, &request.out),
        tip: tip.link.clone(),
        locked: tip.branches.iter().map(|joint| (joint.clone(), 0.0)).collect(),
        armatures: Vec::new(),
        motion: None,
        law: request.law,
        trial,
    };
    let (arm, warnings) = alone(&page, request)?;
    page.armatures = arm.joints.iter().map(|joint| (joint.name.clone(), joint.armature)).collect();
    let motion = first_motion(&arm);
    page.motion = Some(motion.clone());
    let text = page.text();
    let loaded = read(&page, request)?;
    let locked = page.locked;
    Ok(First { text, loaded, arm, tips, locked, motion, warnings })
}

/// The tip that is asked for, or the likeliest; it becomes the first of `tips`.
fn chosen(request: &Request, tips: &mut Vec<Tip>) -> Result<Tip, Error> {
    let refused = |problem: String, help: String| Err(Error::input(&request.urdf, "", problem, help));
    let names = || tips.iter().map(|tip| tip.link.as_str()).collect::<Vec<_>>();
    let Some(asked) = &request.tip else {
        return match tips.first() {
            Some(tip) => Ok(tip.clone()),
            None => refused("has no joint that moves".into(), "give the URDF file of an arm".into()),
        };
    };
    let Some(at) = tips.iter().position(|tip| tip.link == *asked) else {
        let help = format!("write --tip with one of {}", crate::text::listed(&names()));
        return refused(format!("has no link {asked:?} at which an arm may end"), help);
    };
    let tip = tips.remove(at);
    tips.insert(0, tip.clone());
    Ok(tip)
}

/// The arm of `page` without a controller, and what is odd about it.
fn alone(page: &text::Page, request: &Request) -> Result<(Arm, Vec<String>), Error> {
    let loaded = read(page, request)?;
    let mut faults = Diagnostics::of(&request.out);
    match Arm::from_spec(&loaded, &mut faults) {
        Some(built) => faults.finish((built.arm, built.warnings)),
        None => Err(faults.into_error().pointing_into_files(&loaded)),
    }
}

/// The text of `page`, read. The folder of the specification need not be there yet, so the robot file is read by the path of
/// the request.
fn read(page: &text::Page, request: &Request) -> Result<Loaded, Error> {
    let here = std::path::absolute(&request.urdf).unwrap_or_else(|_| request.urdf.clone());
    let probe = text::Page { urdf: here.display().to_string(), ..page.clone() };
    let mut loaded = parse(&probe.text(), &request.out)?;
    loaded.spec.arm.urdf = Some(page.urdf.clone());
    loaded.text = page.text().into();
    for named in &mut loaded.named {
        named.name.clone_from(&page.urdf);
    }
    Ok(loaded)
}

/// `file` as seen from the folder of `from`; as it is where either cannot be found.
fn relative(file: &Path, from: &Path) -> String {
    let folder = from.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Ok(file_path), Some(folder)) = (file.canonicalize(), real(folder)) else {
        return file.display().to_string();
    };
    let (mut to, mut base) = (file_path.components().peekable(), folder.components().peekable());
    while to.peek().is_some() && to.peek() == base.peek() {
        to.next();
        base.next();
    }
    let up = base.map(|_| "..".to_string());
    let down = to.map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// `folder` without links and steps back; it need not be there yet.
fn real(folder: &Path) -> Option<PathBuf> {
    match folder.canonicalize() {
        Ok(found) => Some(found),
        Err(_) => {
            let parent = folder.parent()?;
            let parent = if parent.as_os_str().is_empty() { Path::new(".") } else { parent };
            Some(real(parent)?.join(folder.file_name()?))
        }
    }
}

#[cfg(test)]
mod tests;

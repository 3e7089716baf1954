//! The text of a first specification: JSON with comments that say what each field is for.

use std::fmt::Write as _;

use serde_json::json;

use super::{FirstMotion, Trial};
use crate::spec::LawSpec;

/// What stands on the page.
#[derive(Clone, Debug)]
pub(super) struct Page {
    pub name: String,
    pub urdf: String,
    pub tip: String,
    /// Joints that are held, with their positions, rad or m.
    pub locked: Vec<(String, f64)>,
    /// Rotor inertia by joint, kg·m² or kg; empty while the joints are not known.
    pub armatures: Vec<(String, f64)>,
    /// `None` for the arm alone.
    pub motion: Option<FirstMotion>,
    pub law: Option<LawSpec>,
    pub trial: Trial,
}

impl Page {
    pub(super) fn text(&self) -> String {
        let mut out = String::from("{\n");
        out += "  // The schema next to this file lets an editor complete and check what you write.\n";
        out += "  \"$schema\": \"./gramforge.schema.json\",\n";
        let _ = writeln!(out, "  // The module is NAME.rs: lower-case letters, digits, underscores.");
        let _ = writeln!(out, "  \"name\": {},\n", json!(self.name));
        out += &self.arm();
        if let Some(motion) = &self.motion {
            out += &self.rest(motion);
        }
        out.push_str("}\n");
        out
    }

    fn arm(&self) -> String {
        let mut out = String::from("  \"arm\": {\n");
        let _ = writeln!(out, "    \"urdf\": {},", json!(self.urdf));
        out += "    // The link at which the arm ends. What it carries counts as one body with it.\n";
        let _ = write!(out, "    \"tip\": {}", json!(self.tip));
        if !self.locked.is_empty() {
            out += ",\n    // Joints off the way to the tip, held at these positions (rad or m): a gripper counts as mass.\n";
            let held: Vec<String> =
                self.locked.iter().map(|(name, at)| format!("{}: {at:?}", json!(name))).collect();
            let _ = write!(out, "    \"lock\": {{ {} }}", held.join(", "));
        }
        if !self.armatures.is_empty() {
            out += ARMATURE;
            let joints: Vec<String> = self
                .armatures
                .iter()
                .map(|(name, armature)| format!("      {}: {{ \"armature\": {armature:?} }}", json!(name)))
                .collect();
            let _ = write!(out, "{}\n    }}", joints.join(",\n"));
        }
        out += "\n    // \"payload\": { \"mass\": 2.0, \"com\": [0, 0, 0.05] }  may stand here: a body at the tip.\n  }";
        out
    }

    fn rest(&self, motion: &FirstMotion) -> String {
        let mut out = String::from(",\n\n");
        out += "  // The desired motion, at rest at both ends: rad or m, s. Others: waypoints, sinusoids, csv.\n";
        let _ = writeln!(
            out,
            "  \"motion\": {{ \"quintic\": {{\n    \"from\": {:?},\n    \"to\": {:?},\n    \"duration\": {:?}\n  }} }},\n",
            motion.from, motion.to, motion.duration
        );
        out += "  // Where the model must be good: position errors around the motion, rad or m. Or \"workspace\".\n";
        let _ = writeln!(
            out,
            "  \"measure\": {{ \"tube\": {{ \"position_error\": {:?} }} }},\n",
            self.trial.tube
        );
        if self.law == Some(LawSpec::Adaptive) {
            out += "  // The adaptive law learns with the exact model. Or { \"shared\": { \"functions\": N } }.\n";
            out += "  \"model\": \"exact\"";
        } else {
            out += "  // The cheapest model whose proved torque error is below 1 % of each joint's peak torque. Or \"exact\".\n";
            out += "  \"model\": \"auto\"";
        }
        out += ",\n\n  // \"f32\" for a processor without double precision; \"polynomial\" sines cost half of libm's.\n";
        out += "  \"emit\": { \"scalar\": \"f64\" }";
        if let Some(law) = self.law {
            out += &self.control(law);
        }
        out.push('\n');
        out
    }

    fn control(&self, law: LawSpec) -> String {
        let name = match law {
            LawSpec::Exact => "exact",
            LawSpec::Report => "report",
            LawSpec::Tight => "tight",
            LawSpec::Adaptive => "adaptive",
        };
        let mut out = String::from(",\n\n  \"control\": {\n");
        out += "    // \"exact\": no robust term; \"report\" and \"tight\": outweigh what the model leaves out; \"adaptive\": learns.\n";
        let _ = writeln!(out, "    \"law\": \"{name}\",");
        out += "    // The gains are found: position errors fall to 1/20 in this time, s, sampled at this period, s.\n";
        out += "    // To give them yourself write \"period\", \"W\", \"Pqq\" and \"Omega\" in place of \"design\".\n";
        let _ = writeln!(
            out,
            "    \"design\": {{ \"convergence_time\": {:?}, \"period\": 0.001 }},",
            self.trial.convergence_time
        );
        out += "    // How far from the motion the arm may be when it starts, rad or m.\n";
        out += "    \"initial_error\": { \"position\": 0.01 }\n";
        if law == LawSpec::Adaptive {
            out.truncate(out.trim_end().len());
            out +=
                ",\n    // What the law learns, by intervals: here the mass of a payload at the tip, kg.\n";
            out += "    \"uncertainty\": { \"payload\": { \"mass\": [0.0, 1.0] } }\n  }";
            return out;
        }
        out += "    // \"uncertainty\": { \"payload\": { \"mass\": [0, 2] } }  may stand here: what is known to intervals only.\n  }";
        out
    }
}

const ARMATURE: &str = ",
    // Armature: rotor inertia times the square of the gear ratio, kg·m² at the joint (kg where it slides). URDF has no field
    // for it, and it often outweighs the links. Without it light wrists look lighter than they are: gains come out
    // wrong, and little can be proved of short periods. Take it from the drive's data sheet and write it here.
    \"joints\": {
";

//! A good arm of two joints, changed step by step, and what becomes of it.

use gramforge::Generation;
use gramforge::internals::dynamics;
use gramforge_tests::chain::{Chain, Link};
use gramforge_tests::random::Random;
use gramforge_tests::{difference, largest};
use serde_json::{Value, json};

/// The file of [`chain`], with room for more.
pub const URDF: &str = r#"<?xml version="1.0"?>
<robot name="two">
  <link name="base"/>
  <link name="l1">
    <inertial>
      <origin xyz="0.1 0.02 0.03" rpy="0 0 0"/>
      <mass value="1.3"/>
      <inertia ixx="0.1" iyy="0.12" izz="0.11" ixy="0.002" ixz="0" iyz="0.001"/>
    </inertial>
  </link>
  <link name="l2">
    <inertial>
      <origin xyz="0.15 -0.02 0.01"/>
      <mass value="0.7"/>
      <inertia ixx="0.05" iyy="0.06" izz="0.04" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <joint name="j1" type="revolute">
    <parent link="base"/>
    <child link="l1"/>
    <origin xyz="0.3 0 0.1" rpy="0.3 0 0"/>
    <axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="100" velocity="2"/>
  </joint>
  <joint name="j2" type="revolute">
    <parent link="l1"/>
    <child link="l2"/>
    <origin xyz="0.3 0 0" rpy="0.2 0 0.1"/>
    <axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="100" velocity="2"/>
  </joint>
</robot>
"#;

/// The arm of [`URDF`] by its numbers.
pub fn chain() -> Chain {
    let first = Link {
        prismatic: false,
        xyz: [0.3, 0.0, 0.1],
        rpy: [0.3, 0.0, 0.0],
        axis: [0.0, 1.0, 0.0],
        mass: 1.3,
        com: [0.1, 0.02, 0.03],
        com_rpy: [0.0; 3],
        inertia: [0.1, 0.12, 0.11, 0.002, 0.0, 0.001],
        armature: 0.0,
        follows: (0, 1.0, 0.0),
    };
    let second = Link {
        xyz: [0.3, 0.0, 0.0],
        rpy: [0.2, 0.0, 0.1],
        mass: 0.7,
        com: [0.15, -0.02, 0.01],
        inertia: [0.05, 0.06, 0.04, 0.0, 0.0, 0.0],
        follows: (1, 1.0, 0.0),
        ..first.clone()
    };
    Chain { links: vec![first, second], gravity: [0.0, 0.0, -9.81] }
}

/// One change of the file and of what the specification says of it.
pub struct Case {
    pub name: &'static str,
    /// What is replaced by what in the file's text, once each.
    pub edits: Vec<(&'static str, String)>,
    /// The specification's `arm`, without the file.
    pub arm: Value,
    /// Other members of the specification.
    pub more: Value,
}

/// The text at which more elements may stand.
pub const END: &str = "</robot>";

impl Case {
    pub fn new(name: &'static str) -> Self {
        Self { name, edits: Vec::new(), arm: json!({ "tip": "l2" }), more: json!({}) }
    }

    #[must_use]
    pub fn edit(mut self, from: &'static str, to: impl Into<String>) -> Self {
        self.edits.push((from, to.into()));
        self
    }

    /// Adds elements to the robot.
    #[must_use]
    pub fn with(self, elements: &str) -> Self {
        self.edit(END, format!("  {elements}\n{END}"))
    }

    #[must_use]
    pub fn arm(mut self, key: &str, value: Value) -> Self {
        self.arm[key] = value;
        self
    }

    #[must_use]
    pub fn more(mut self, key: &str, value: Value) -> Self {
        self.more[key] = value;
        self
    }

    pub fn text(&self) -> String {
        self.edits.iter().fold(URDF.to_string(), |text, (from, to)| {
            assert!(text.contains(from), "{}: no {from}", self.name);
            text.replacen(from, to, 1)
        })
    }

    /// The line of the file in which `part` begins.
    pub fn line(&self, part: &str) -> usize {
        let text = self.text();
        let before = text.split(part).next().filter(|before| before.len() < text.len());
        1 + before.unwrap_or_else(|| panic!("{}: no {part}", self.name)).matches('\n').count()
    }

    /// The generation from the file as `bytes`, or the message of why there is none.
    pub fn run(&self, bytes: &[u8]) -> Result<Generation, String> {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("arm.urdf"), bytes).expect("a file");
        let n = self.more.get("dof").and_then(Value::as_u64).unwrap_or(2) as usize;
        let mut spec = json!({ "name": "robot", "arm": self.arm, "model": "exact",
            "motion": { "quintic": { "from": vec![0.1; n], "to": vec![0.4; n], "duration": 3.0 } } });
        spec["arm"]["urdf"] = json!("arm.urdf");
        for (key, value) in self.more.as_object().expect("an object").iter().filter(|(key, _)| *key != "dof")
        {
            spec[key] = value.clone();
        }
        let path = folder.path().join("arm.json");
        let loaded = gramforge::load::parse(&spec.to_string(), &path).map_err(|error| error.to_string())?;
        let shown = folder.path().display().to_string() + "/";
        Generation::new(loaded).map_err(|error| error.to_string().replace(&shown, ""))
    }

    /// Accepted, with the dynamics of `chain`; gives the generation for more looks.
    pub fn accepted(&self, chain: &Chain) -> Generation {
        self.accepted_as(self.text().as_bytes(), chain)
    }

    /// The same from other bytes.
    pub fn accepted_as(&self, bytes: &[u8], chain: &Chain) -> Generation {
        let made = self.run(bytes).unwrap_or_else(|message| panic!("{}: {message}", self.name));
        assert_eq!(made.arm().dof(), chain.dof(), "{}", self.name);
        let mut random = Random::new(9);
        for _ in 0..10 {
            let n = chain.dof();
            let (q, qd, qdd) = (random.vector(n, 1.5), random.vector(n, 2.0), random.vector(n, 5.0));
            let pairs = [
                (dynamics::mass_matrix(made.arm(), &q).concat(), chain.mass_matrix(&q).concat()),
                (dynamics::coriolis(made.arm(), &q, &qd).concat(), chain.coriolis(&q, &qd).concat()),
                (made.code().interpret(&q, &qd, &vec![0.0; n], &vec![0.0; n]), chain.gravity_torque(&q)),
                (made.code().interpret(&q, &qd, &qd, &qdd), chain.torque(&q, &qd, &qdd)),
            ];
            for (ours, theirs) in pairs {
                let error = difference(&ours, &theirs);
                assert!(error <= 1e-12 * largest(&theirs).max(1.0), "{}: {ours:?} for {theirs:?}", self.name);
            }
        }
        made
    }

    /// Refused in one line that begins with the file, the line of `at` (none: the whole file) and `field`, and holds
    /// `words` in order.
    pub fn refused(&self, at: Option<&str>, field: &str, words: &[&str]) {
        let message = self.run(self.text().as_bytes()).map(|_| ()).expect_err(self.name);
        let start = match (at, field) {
            (Some(_), "") => "arm.urdf: ".to_string(),
            (Some(_), field) => format!("arm.urdf: {field}: "),
            (None, field) => format!("{field}: "),
        };
        assert_eq!(message.lines().count(), 1, "{}: {message}", self.name);
        let line = at.map(|part| self.line(part).to_string());
        let told = gramforge_tests::unplaced(&message);
        let place = message.strip_prefix("arm.urdf:").and_then(|rest| rest.split([':', ' ']).next());
        assert!(line.is_none() || place == line.as_deref(), "{}: {message:?} for line {line:?}", self.name);
        let rest =
            told.strip_prefix(&start).unwrap_or_else(|| panic!("{}: {message:?} for {start:?}", self.name));
        let mut left = rest;
        for word in words {
            let (_, behind) =
                left.split_once(word).unwrap_or_else(|| panic!("{}: {rest:?} lacks {word:?}", self.name));
            left = behind;
        }
    }
}

//! What the program prints: one `MODULE KEY VALUE` a line.

use std::collections::BTreeMap;

/// Values by module and key.
#[derive(Debug)]
pub struct Results(pub BTreeMap<(String, String), u64>);

impl Results {
    /// Reads the lines; the output must hold nothing else.
    pub fn parse(output: &str) -> Self {
        let line = |line: &str| {
            let [module, key, value] = line.split(' ').collect::<Vec<_>>()[..] else {
                panic!("not a line of results: {line:?}")
            };
            let value = u64::from_str_radix(value, 16).expect("a number in hexadecimal");
            ((module.to_string(), key.to_string()), value)
        };
        Self(output.lines().map(line).collect())
    }

    /// One value.
    pub fn value(&self, module: &str, key: &str) -> u64 {
        let key = (module.to_string(), key.to_string());
        *self.0.get(&key).unwrap_or_else(|| panic!("the program has not printed {key:?}"))
    }

    /// The value of every module that has this key.
    pub fn values(&self, key: &str) -> BTreeMap<&str, u64> {
        self.0
            .iter()
            .filter(|((_, own), _)| own == key)
            .map(|((module, _), &value)| (&module[..], value))
            .collect()
    }
}

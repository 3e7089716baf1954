//! Makes modules into `OUT_DIR` the way a user's build script does; `tests/emitted/generated_code.rs` includes them.

fn main() {
    let specs = [
        "arm",
        "ur5",
        "stanford",
        "arm3_sinusoids",
        "arm3_waypoints",
        "arm3_csv",
        "arm3_polynomial",
        "arm3_table",
        "puma3_separate",
        "puma3_union",
        "puma3_tolerance",
        "stanford_tolerance",
        "follower",
        "panda",
        "step_tight",
        "step_switching",
        "step_constant",
        "step_exact",
        "workspace_checked",
        "single_sign",
        "single_adaptive",
        "single_puma",
        "single_panda",
        "single_ur5",
        "single_stanford",
        "single_tight",
        "single_csv",
        "single_guaranteed",
        "single_sinusoids",
    ];
    let config =
        specs.iter().fold(gramforge::Config::new(), |config, name| config.spec(format!("data/{name}.json")));
    config.run_in_build_script();
}

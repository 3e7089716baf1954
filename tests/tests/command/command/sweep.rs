//! `gramforge sweep`: shards that merge into the bytes of one run, interruptions that keep what is done, and refusals.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::{Outcome, committed, finish, gramforge, root, text, value};

const SIZES: &str = "exact,xi1,xi2,xi3+constant,1%,xi2+f32";

fn sweep(arguments: &[&str]) -> Outcome {
    finish(gramforge().arg("sweep").args(arguments))
}

#[test]
fn merged_shards_are_the_bytes_of_one_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| text(&folder.path().join(name));
    let specs = ["arm3_xi1", "arm3_exact"].map(|name| text(&committed(name)));
    let base = [&specs[0], &specs[1], "--sizes", SIZES];
    let with = |more: &[&str]| sweep(&[&base[..], more].concat());
    let whole = with(&["--out", &file("whole"), "--jobs", "1"]).expect(0);
    let parts: Vec<String> = (1..=3).map(|i| file(&format!("part{i}"))).collect();
    for (i, part) in (1..).zip(&parts) {
        with(&["--shard", &format!("{i}/3"), "--out", part, "--jobs", "2"]).expect(0);
    }
    // In any order.
    let merged =
        sweep(&["--merge", &parts[2], &parts[0], &parts[1], "--out", &file("merged"), "--csv", &file("csv")])
            .expect(0);
    assert!(fs::read(file("merged")).expect("merged") == fs::read(file("whole")).expect("whole"));
    assert_eq!(merged.stdout, whole.stdout);
    assert!(whole.stdout.lines().all(|line| line.chars().count() <= 80), "{}", whole.stdout);
    let csv = fs::read_to_string(file("csv")).expect("CSV");
    assert_eq!(csv.lines().count(), 1 + 2 * 6);

    let missing = sweep(&["--merge", &parts[0], &parts[2], "--out", &file("partial")]).expect(2);
    assert!(missing.stderr.contains("lacks 4 of 12 rows, the first is row 1"), "{missing:#?}");
    assert!(!Path::new(&file("partial")).exists());
    sweep(&["--merge", &parts[0], &parts[2], "--partial", "--out", &file("partial")]).expect(0);

    let other = sweep(&[&specs[0], "--sizes", "exact", "--out", &file("other")]).expect(0);
    assert_eq!(other.stderr, "");
    let mixed = sweep(&["--merge", &parts[0], &file("other")]).expect(2);
    assert!(mixed.stderr.contains("is of another sweep"), "{mixed:#?}");
}

#[test]
fn rows_agree_with_inspect() {
    let spec = text(&committed("arm3_xi2"));
    let swept = sweep(&[&spec, "--functions", "2", "--guarantee", "--json"]).json();
    let row = &swept[0]["row"];
    let view = finish(gramforge().args(["inspect", &spec, "--json"])).json();
    assert_eq!(row["size"], "xi 2");
    assert_eq!(row["torque_error"], view["torque_error"]);
    assert_eq!(row["period_max"], view["continuous"]["period_max"]);
    assert_eq!(row["guarantee"]["kind"], view["guarantee"]["kind"]);
    assert_eq!(row["verdict"], view["verdict"]);
    assert_eq!(row["bytes"], view["size"]);
    for count in ["mul", "add"] {
        assert_eq!(row["operations"][count], view["step_operations"]["reduced"][count]);
    }
}

#[test]
fn a_size_that_cannot_be_is_a_row_with_its_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let plot = folder.path().join("sizes.svg");
    let spec = text(&committed("arm3_xi2"));
    let done = sweep(&[&spec, "--sizes", "xi2,xi12", "--plot", &text(&plot)]).expect(0);
    assert!(
        done.stdout.contains("xi 12: refused: ") && done.stdout.contains("has 11 functions"),
        "{done:#?}"
    );
    let picture = fs::read_to_string(plot).expect("a plot");
    assert!(picture.starts_with("<svg") && picture.contains("xi 2") && !picture.contains("NaN"));
}

#[test]
fn bad_input_touches_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(&folder.path().join("rows"));
    let spec = text(&committed("arm3_xi2"));
    let mut broken = value("arm3_xi2");
    broken["measure"]["tube"]["position_error"] = Value::from(-1.0);
    let bad = folder.path().join("bad.json");
    fs::write(&bad, broken.to_string()).expect("written");
    let cases: [(&[&str], &str); 7] = [
        (&[&spec, "--sizes", "xi0.5"], "no part of a size"),
        (&[&spec, "--sizes", "exact+xi2"], "comes after another part of its kind"),
        (&[&spec, "--shard", "4/3"], "write i/n"),
        (&[&spec, "nowhere.json"], "cannot be read"),
        (&[&text(&bad), "nowhere.json"], "position_error"),
        (&["--merge", &spec], "is not the first line of a sweep"),
        (&[&spec, "--jobs", "0"], "--jobs"),
    ];
    for (arguments, words) in cases {
        let refused = sweep(&[arguments, &["--out", &out]].concat()).expect(2);
        assert!(refused.stderr.contains(words), "{words}: {refused:#?}");
        assert!(!Path::new(&out).exists(), "{words}");
    }
}

#[test]
fn an_interruption_keeps_what_is_done_and_the_same_command_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let [whole, part] = ["whole", "part"].map(|name| text(&folder.path().join(name)));
    let spec = text(&committed("arm3_xi2"));
    let counts = (0..8).map(|_| "1,2,3,4,5").collect::<Vec<_>>().join(",");
    let base = [&spec, "--functions", &counts, "--jobs", "1"];
    let with = |out: &str| sweep(&[&base[..], &["--out", out]].concat());
    with(&whole).expect(0);

    let mut command = gramforge();
    command.arg("sweep").args(base).args(["--out", &part]).stdout(Stdio::null());
    let mut child = command.spawn().expect("the command starts");
    let lines = |file: &str| fs::read_to_string(file).unwrap_or_default().lines().count();
    let patience = Instant::now();
    while lines(&part) < 5 {
        assert!(patience.elapsed() < Duration::from_secs(120), "no rows appear");
        sleep(Duration::from_millis(2));
    }
    // Control-C, and where whoever started the test has it ignored, the next stronger signal.
    for signal in ["-INT", "-TERM"] {
        // The first one may be enough.
        let _ = Command::new("kill").args([signal, &child.id().to_string()]).output().expect("kill");
    }
    assert!(!child.wait().expect("it ends").success());

    let (kept, all) = (fs::read_to_string(&part).expect("rows"), fs::read_to_string(&whole).expect("rows"));
    let (rows, total) = (kept.lines().count(), all.lines().count());
    assert!((5..total).contains(&rows), "{rows} of {total}");
    assert!(all.starts_with(&kept), "what is kept is the beginning of the whole");
    let shown = sweep(&["--merge", "--partial", &part, "--json"]).json();
    assert_eq!(shown.as_array().map(Vec::len), Some(rows - 1));
    with(&part).expect(0);
    assert!(fs::read_to_string(&part).expect("rows") == all, "the rest is added");
}

#[test]
fn gnu_parallel_runs_the_shards() {
    if Command::new("parallel").arg("--version").output().is_err() {
        println!("skipped: GNU parallel is not installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, whole) = (text(&committed("arm3_xi2")), text(&folder.path().join("whole")));
    sweep(&[&spec, "--functions", "1,2,3,4", "--out", &whole]).expect(0);
    let program = text(Path::new(gramforge().get_program()));
    let line = format!("{program} sweep {spec} --functions 1,2,3,4 --shard {{}}/3 --out part{{}}");
    let mut command = Command::new("parallel");
    command.current_dir(&folder).env("HOME", folder.path()).args(["--halt", "now,fail=1", &line, ":::"]);
    finish(command.args(["1", "2", "3"])).expect(0);
    let parts = ["part1", "part2", "part3"].map(|part| text(&folder.path().join(part)));
    let merged = text(&folder.path().join("merged"));
    sweep(&["--merge", &parts[0], &parts[1], &parts[2], "--out", &merged]).expect(0);
    assert!(fs::read(merged).expect("merged") == fs::read(whole).expect("whole"));
}

#[test]
fn the_guide_and_the_slurm_script_show_commands_that_work() {
    let guide = fs::read_to_string(root().join("docs/guides/sizes.md")).expect("the guide");
    let script = fs::read_to_string(root().join("docs/guides/sweep.sbatch")).expect("the script");
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(committed("arm3_xi2"), folder.path().join("arm.json")).expect("copied");
    let shown = guide.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let commands: Vec<&str> = shown.flat_map(str::lines).filter(|l| l.starts_with("gramforge ")).collect();
    assert!(commands.len() >= 6, "{commands:?}");
    for line in commands {
        let words: Vec<&str> = line.split_whitespace().skip(1).collect();
        let done = finish(gramforge().current_dir(&folder).args(&words));
        assert!(matches!(done.code, Some(0 | 1)) && !done.stdout.is_empty(), "{line}: {done:#?}");
    }
    // The script as Slurm starts it, once for each part.
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).expect("a folder");
    fs::copy(gramforge().get_program(), bin.join("gramforge")).expect("copied");
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
    fs::write(folder.path().join("sweep.sbatch"), script).expect("written");
    for task in ["1", "2"] {
        let mut command = Command::new("bash");
        command.current_dir(&folder).args(["sweep.sbatch", "arm.json"]).env("PATH", &path);
        command.env("SLURM_ARRAY_TASK_ID", task).env("SLURM_ARRAY_TASK_COUNT", "2");
        finish(command.env("SLURM_CPUS_PER_TASK", "1")).expect(0);
    }
    let parts = ["rows-1", "rows-2"].map(|part| text(&folder.path().join(part)));
    sweep(&["--merge", &parts[0], &parts[1]]).expect(0);
}

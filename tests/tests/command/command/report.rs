//! `gramforge report`: one page, the same bytes, and the numbers of `inspect`.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::{committed, finish, gramforge, root, run, text, value};

/// A short motion, so that the loop is soon followed.
fn short(folder: &Path) -> (String, Value) {
    let mut spec = value("arm3_robust");
    spec["motion"]["quintic"]["duration"] = json!(0.5);
    spec["control"]["settle"] = json!(0.4);
    let path = folder.join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    (text(&path), spec)
}

/// The page of `spec`.
fn page(spec: &str, out: &Path, threads: &str, more: &[&str]) -> String {
    let mut command = gramforge();
    command.env("RAYON_NUM_THREADS", threads).args(["report", spec, "--out"]).arg(out).args(more);
    finish(&mut command).expect(0);
    fs::read_to_string(out).expect("a page")
}

/// What the script of a page reads.
fn data(page: &str) -> Value {
    let json = page.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next());
    serde_json::from_str(json.expect("data")).expect("JSON")
}

/// A figure of the size that is shown first.
fn figure<'a>(data: &'a Value, id: &str) -> &'a Value {
    let own = data["own"].as_u64().expect("a number") as usize;
    let number = data["sizes"][own]["figures"][id].as_u64().expect("a figure") as usize;
    &data["figures"][number]
}

#[test]
fn the_same_bytes_on_any_number_of_threads_and_nothing_from_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, _) = short(folder.path());
    let made = |name: &str, threads: &str| page(&spec, &folder.path().join(name), threads, &["--runs", "3"]);
    let first = made("a.html", "1");
    assert!(first == made("b.html", "3"), "other bytes with more threads");
    assert!(first == made("a.html", "2"), "other bytes");
    let again = run(["report", &spec, "--out", &text(&folder.path().join("a.html")), "--runs", "3"]);
    assert!(again.expect(0).stdout.contains("a.html: unchanged"));
    assert!(first.len() < 3_000_000, "{}", first.len());
    for word in ["http://", "https://", "//cdn", " src=", "@import", "url(", "fetch(", "XMLHttpRequest"] {
        assert!(!first.contains(word), "{word}");
    }
    let links: Vec<&str> =
        first.split(" href=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(links.iter().all(|link| link.starts_with('#') || link.starts_with("data:")), "{links:?}");
    assert!(!first.contains(&text(folder.path())), "a path");
    let data = data(&first);
    let labels: Vec<&str> =
        data["sizes"].as_array().expect("sizes").iter().filter_map(|size| size["label"].as_str()).collect();
    assert!(
        labels.len() >= 5 && labels.iter().filter(|label| label.ends_with("(specified)")).count() == 1,
        "{labels:?}"
    );
}

#[test]
fn the_numbers_are_those_of_inspect() {
    let folder = tempfile::tempdir().expect("a folder");
    for spec in [short(folder.path()).0, text(&committed("arm3_xi2"))] {
        let shown = data(&page(&spec, &folder.path().join("arm.html"), "2", &["--one-size", "--runs", "2"]));
        let told = run(["inspect", &spec, "--json"]).json();
        let list = |value: &Value| -> Vec<f64> {
            value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
        };
        let (error, peak) = (list(&told["torque_error"]), list(&told["peak_torque"]));
        let bars = figure(&shown, "bounds")["panels"][0]["rows"].as_array().expect("bars");
        assert_eq!(bars.len(), error.len());
        for (i, bar) in bars.iter().enumerate() {
            let values = list(&bar["values"]);
            let certified = 100.0 * error[i] / peak[i];
            assert!((values[0] / certified - 1.0).abs() < 1e-4, "{values:?} {certified}");
            assert!(values[1] <= values[0], "found above certified: {values:?}");
        }
        let table = figure(&shown, "operations")["panels"][1]["rows"].as_array().expect("rows");
        for (name, key) in
            [("multiplications", "mul"), ("additions", "add"), ("sine-cosine pairs", "trig_pairs")]
        {
            let row = table.iter().find(|row| row[0] == name).expect(name);
            assert_eq!(row[2], told["step_operations"]["reduced"][key].to_string(), "{name}");
            assert_eq!(row[3], told["step_operations"]["exact"][key].to_string(), "{name}");
        }
        assert_eq!(figure(&shown, "operations")["caption"], told["verdict"]);
        let tiles = figure(&shown, "summary")["panels"][0]["tiles"].as_array().expect("tiles").clone();
        let tile = |name: &str| -> String {
            let tile = tiles.iter().find(|tile| tile["name"] == name).expect(name);
            tile["value"].as_str().expect("words").to_string()
        };
        let kind = told["guarantee"]["kind"].as_str().expect("a kind");
        assert!(tile("Guarantee").starts_with(kind), "{} {kind}", tile("Guarantee"));
        let size = told["size"].as_f64().expect("bytes") / 1e3;
        let kilobytes: f64 = tile("Module").trim_end_matches(" kB").parse().expect("a number");
        assert!((kilobytes / size - 1.0).abs() < 5e-3, "{kilobytes} {size}");
        let level = &figure(&shown, "lyapunov")["panels"][0]["series"][0];
        if told["continuous"]["holds"] == true {
            let told = told["control"]["level"].as_f64().expect("a level");
            assert!((level["y"][0].as_f64().expect("a level") / told - 1.0).abs() < 1e-4);
        }
        // The funnel is the guarantee's: its largest value is the reach.
        if kind == "sampled" {
            for (panel, reach) in figure(&shown, "funnel")["panels"]
                .as_array()
                .expect("panels")
                .iter()
                .zip(list(&told["guarantee"]["reach"]))
            {
                let series = panel["series"].as_array().expect("curves");
                let certified = series.iter().find(|one| one["role"] == "certified").expect("a bound");
                let most = list(&certified["y"]).into_iter().fold(0.0, f64::max);
                assert!((most / reach - 1.0).abs() < 1e-4, "{most} {reach}");
            }
        }
    }
}

#[test]
fn an_arm_alone_has_a_page_as_well() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut spec = value("puma560_one_percent");
    let object = spec.as_object_mut().expect("an object");
    object.remove("control");
    object.remove("motion");
    object.insert("model".to_string(), json!("exact"));
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    let shown = data(&page(&text(&path), &folder.path().join("arm.html"), "2", &["--one-size"]));
    let figures: Vec<&String> = shown["sizes"][0]["figures"].as_object().expect("figures").keys().collect();
    assert_eq!(figures, ["arm", "bounds", "domain", "functions", "operations", "summary"]);
}

#[test]
fn what_cannot_be_read_or_written_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("arm.html");
    run(["report", &text(&folder.path().join("nowhere.json")), "--out", &text(&out)]).expect(2);
    let mut spec = value("arm3_xi2");
    spec["control"]["period"] = json!(-1.0);
    let path = folder.path().join("arm.json");
    fs::write(&path, spec.to_string()).expect("written");
    let refused = run(["report", &text(&path), "--out", &text(&out)]).expect(2);
    assert!(refused.stderr.contains("control.period"), "{refused:?}");
    assert!(!out.exists());
    let (spec, _) = short(folder.path());
    let refused =
        run(["report", &spec, "--one-size", "--runs", "1", "--out", &text(folder.path())]).expect(2);
    assert!(refused.stderr.contains("is a folder"), "{refused:?}");
}

#[test]
fn the_command_of_the_guide_works() {
    let guide = fs::read_to_string(root().join("docs/guides/report.md")).expect("the guide");
    let command = guide.split("```sh\n").nth(1).and_then(|rest| rest.lines().next()).expect("a command");
    let folder = tempfile::tempdir().expect("a folder");
    let out = text(&folder.path().join("arm3.html"));
    let arguments = command.strip_prefix("gramforge ").expect("the command").replace("arm3.html", &out);
    let told =
        finish(gramforge().current_dir(root()).args(arguments.split(' ')).args(["--runs", "1"])).expect(0);
    assert!(told.stdout.contains("arm3.html: written") && told.stdout.contains("model sizes"), "{told:?}");
    // Every figure is explained.
    let page = fs::read_to_string(&out).expect("a page");
    let titles = page.split("<h2 id=\"").skip(1).filter_map(|rest| rest.split("</h2>").next());
    let headings: Vec<&str> =
        titles.filter_map(|title| title.split_once("\">")).map(|title| title.1).collect();
    assert!(headings.len() > 10, "{headings:?}");
    for heading in headings.into_iter().filter(|heading| *heading != "Code") {
        assert!(guide.contains(&format!("| {heading} |")), "{heading}");
    }
}

//! Generates a module from a program of your own: `cargo run --example generate -- SPEC.json FOLDER`.

use std::process::ExitCode;

use gramforge::Config;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let spec = arguments.next().unwrap_or("generated/specs/arm3_xi2.json".to_string());
    let folder = arguments.next().unwrap_or("target/example".to_string());
    match Config::new().spec(spec).out_dir(folder).generate() {
        Ok(outputs) => {
            for output in outputs {
                println!("{}: {} bytes", output.path.display(), output.text.len());
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

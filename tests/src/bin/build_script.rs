//! A build script whose specifications are its arguments: what it tells cargo can be read without cargo.

fn main() {
    let specs = std::env::args_os().skip(1);
    specs.fold(gramforge::Config::new(), |config, spec| config.spec(spec)).run_in_build_script();
}

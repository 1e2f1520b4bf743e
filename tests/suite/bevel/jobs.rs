//! Bevel scenes made ready.

use gearcut::process::bevel::BevelJob;
use std::path::Path;

/// A shipped scene made ready, with `--set` arguments.
pub fn job(scene: &str, settings: &[&str]) -> gearcut::Result<BevelJob> {
    job_of(Path::new(&format!("scenes/bevel/{scene}.toml")), settings)
}

/// Any scene made ready.
pub fn job_of(path: &Path, settings: &[&str]) -> gearcut::Result<BevelJob> {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let loaded = gearcut::process::load(path, &settings).unwrap_or_else(|e| panic!("{e}"));
    BevelJob::new(&loaded.scene)
}

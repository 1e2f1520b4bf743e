//! Shipped bevel scenes made ready.

use gearcut::process::bevel::BevelJob;

/// A shipped scene made ready, with `--set` arguments.
pub fn job(scene: &str, settings: &[&str]) -> gearcut::Result<BevelJob> {
    let settings: Vec<String> = settings.iter().map(|&s| s.to_owned()).collect();
    let path = format!("scenes/bevel/{scene}.toml");
    let loaded = gearcut::process::load(std::path::Path::new(&path), &settings).unwrap_or_else(|e| panic!("{e}"));
    BevelJob::new(&loaded.scene)
}

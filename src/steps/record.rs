//! The run record: what is needed to repeat a run and to trust its files.

use super::{Tools, Work};
use crate::output::folder::CHECKSUMS;
use gearcut_core::error::{Error, Result};
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::Path;

/// SHA-256 of every file of the folder.
///
/// # Errors
/// Files that cannot be read back.
pub fn checksums(tools: &Tools) -> Result<Map<String, Value>> {
    let step = tools.progress.step("checksums", 1, "folder");
    let mut checksums = Map::new();
    collect_checksums(&tools.folder.path("")?, "", &mut checksums)?;
    step.advance(1);
    step.finish();
    Ok(checksums)
}

/// What is needed to repeat the run and to trust its files; the wall time is that from the first step to now, when
/// nothing but this record is missing.
pub fn run_record(tools: &Tools, work: &Work, complete: bool, checksums: &Map<String, Value>) -> Map<String, Value> {
    let Tools { resolved, backend, backend_why, parts, progress, .. } = *tools;
    let stages = progress.stages();
    let record = json!({
        "program": "gearcut",
        "program_version": env!("CARGO_PKG_VERSION"),
        "command": "cut",
        "scene": resolved,
        "scene_sha256": sha256_hex(resolved.as_bytes()),
        "written": parts.names(),
        "backend": backend.name(),
        "backend_why": backend_why,
        "backend_incidents": backend.incidents(),
        "stage_times": backend
            .stage_times()
            .iter()
            .map(|t| json!({"stage": t.stage, "batches": t.batches, "device_s": t.device_s}))
            .collect::<Vec<_>>(),
        "stages": stages.iter().map(|(name, wall_s)| json!({"stage": name, "wall_s": wall_s})).collect::<Vec<_>>(),
        "complete": complete,
        "dexels": work.dexels,
        "dexel_passes": work.stats.dexel_passes,
        "dexels_cut": work.stats.dexels,
        "dexel_passes_per_dexel_cut": work.passes_per_dexel(),
        "wall_time_s": progress.elapsed().as_secs_f64(),
        "threads": rayon::current_num_threads(),
        CHECKSUMS: checksums,
    });
    let Value::Object(record) = record else { unreachable!("an object was written") };
    record
}

/// SHA-256 in hexadecimal digits.
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn collect_checksums(folder: &Path, prefix: &str, into: &mut Map<String, Value>) -> Result<()> {
    let mut entries: Vec<_> = std::fs::read_dir(folder)
        .and_then(Iterator::collect::<std::io::Result<Vec<_>>>)
        .map_err(Error::reading(folder))?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if path.is_dir() {
            collect_checksums(&path, &format!("{name}/"), into)?;
        } else {
            let bytes = std::fs::read(&path).map_err(Error::reading(&path))?;
            into.insert(name, Value::String(sha256_hex(&bytes)));
        }
    }
    Ok(())
}

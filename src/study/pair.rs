//! Pairs as cases: keys of the mate begin with `mate.`, options of `gearcut pair` with `pair.`, all others are the
//! scene's.
//!
//! In: both scenes and a case's settings. Out: the findings of `gearcut pair`. An option is called as its argument is:
//! `pair.center_distance_error_um` is `--center-distance-error-um`.

use crate::findings::Findings;
use crate::interrupt::Interrupt;
use crate::pair_job;
use crate::pair_job::options::PairOptions;
use crate::pair_job::watch::Watch;
use crate::process;
use crate::progress::{Progress, ProgressMode};
use crate::scene::LoadedScene;
use gearcut_core::cut::Backend;
use gearcut_core::error::{Refusal, Result};

/// What the keys of the mate begin with, and the options.
const PREFIXES: [&str; 2] = ["mate.", "pair."];

/// What the cases of pairs have beside the scene.
#[derive(Debug)]
pub struct PairBase {
    /// The other gear.
    pub mate: LoadedScene,
    /// How both are mounted.
    pub options: PairOptions,
}

/// Settings of the scene, of the mate, and options, without what they begin with.
pub fn parted(settings: &[String]) -> [Vec<String>; 3] {
    let mut parts = [Vec::new(), Vec::new(), Vec::new()];
    for setting in settings {
        let [mate, pair] = PREFIXES.map(|prefix| setting.strip_prefix(prefix));
        let (part, words) = match (mate, pair) {
            (Some(rest), _) => (1, rest),
            (None, Some(rest)) => (2, rest),
            (None, None) => (0, setting.as_str()),
        };
        parts[part].push(words.to_owned());
    }
    parts
}

/// The key of a scene without what a mate's begins with.
pub fn key_of_scene(key: &str) -> &str {
    key.strip_prefix(PREFIXES[0]).unwrap_or(key)
}

/// Options from settings.
///
/// # Errors
/// An option that there is not; a value that it cannot have.
pub fn options(settings: &[String]) -> Result<PairOptions, Refusal> {
    with_options(PairOptions::default(), settings)
}

fn with_options(mut options: PairOptions, settings: &[String]) -> Result<PairOptions, Refusal> {
    for setting in settings {
        let (name, value) = setting.split_once('=').unwrap_or((setting, ""));
        let way_out = "the options of a pair are the arguments of gearcut pair, with _ for -";
        let refuse = |why: &str| Refusal::new("pair", format!("`pair.{setting}`: {why}"), way_out);
        if !options.set(name.trim(), value.trim().trim_matches('"')).map_err(|why| refuse(&why))? {
            return Err(refuse("there is no such option"));
        }
    }
    Ok(options)
}

/// What a case finds.
///
/// # Errors
/// Scenes that do not load, or do not run together; the backend's; Ctrl-C.
pub fn found(
    base: (&LoadedScene, &PairBase),
    settings: &[String],
    backend: &dyn Backend,
    interrupt: &Interrupt,
) -> Result<Findings> {
    let (scene, PairBase { mate, options }) = base;
    let [own, of_mate, of_pair] = parted(settings);
    let table = process::table();
    let (a, b) = (scene.with_settings(&own, table)?, mate.with_settings(&of_mate, table)?);
    let options = with_options(options.clone(), &of_pair)?;
    let quiet = Progress::new(ProgressMode::Quiet);
    pair_job::found([&a.scene, &b.scene], &options, backend, &Watch::new(&quiet, interrupt))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair_job::flanks::FlankSource;

    #[test]
    fn settings_know_their_scene() {
        let settings = ["gear.teeth=20", "mate.gear.teeth=30", "pair.flanks=\"nominal\""].map(str::to_owned);
        let [own, mate, pair] = parted(&settings);
        assert_eq!((own, mate), (vec!["gear.teeth=20".to_owned()], vec!["gear.teeth=30".to_owned()]));
        assert_eq!(options(&pair).expect("options").source, FlankSource::Nominal);
        for wrong in ["flanks=cutt", "marking_um=0", "positions=-3", "center_distanc_mm=3", "center_distance_mm=nan"] {
            assert!(options(&[wrong.to_owned()]).is_err(), "{wrong}");
        }
        assert_eq!(key_of_scene("mate.gear.teeth"), "gear.teeth");
    }
}

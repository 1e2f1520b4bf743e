//! Values compared with each other: contradictions that no single key shows, and sizes that no memory holds.
//!
//! Here for the keys that all processes share; each process checks its own. What needs the pitch curve itself
//! (curvature, undercut, closing) is refused later, where the curve is known.

use std::collections::BTreeMap;

use super::keys::join;
use super::problems::Found;

/// Most dexels on one flank: 100 million take 1.5 GB through all operations, a hundred times a usual flank.
const MOST_DEXELS: f64 = 1e8;

/// Adds a problem for every contradiction between shared keys.
pub(super) fn cross_check(found: &mut Found<'_, '_, '_>) {
    // A missing value ends only the check that asks for it.
    let _: [Option<()>; 5] = [gear_bore(found), sinusoidal(found), fourier(found), profile(found), dexels(found)];
    names(found);
    for index in 0..found.values.count("picture") {
        let _: Option<()> = picture_tooth(found, &format!("picture.{index}"));
    }
}

fn gear_bore(found: &mut Found) -> Option<()> {
    let gear = found.view("gear");
    let (module_mm, teeth) = (gear.number("module_mm")?, f64::from(gear.whole("teeth")?));
    let bore_mm = gear.number("bore_diameter_mm")?;
    let root_mm = module_mm * (teeth - 2.5);
    let message = || {
        format!("`gear.bore_diameter_mm`: {bore_mm} leaves no ring under the teeth: mean root diameter {root_mm:.3} mm")
    };
    found.blame(bore_mm >= root_mm, "gear.bore_diameter_mm", message, "make the bore smaller, or leave it out");
    Some(())
}

fn sinusoidal(found: &mut Found) -> Option<()> {
    let path = "gear.pitch_curve.sinusoidal_ratio";
    let curve = found.view(path);
    let (mean, amplitude) = (curve.number("mean_ratio")?, curve.number("ratio_amplitude")?);
    let message = || {
        format!(
            "`{path}.ratio_amplitude`: {amplitude} is not smaller than mean_ratio = {mean}: the ratio would pass zero"
        )
    };
    let key = join(path, "ratio_amplitude");
    found.blame(amplitude >= mean, &key, message, "make ratio_amplitude smaller than mean_ratio");
    Some(())
}

fn profile(found: &mut Found) -> Option<()> {
    let measure = found.view("measure");
    let (start_mm, end_mm) = (measure.number("profile_start_height_mm")?, measure.number("profile_end_height_mm")?);
    let message = || format!("the evaluated profile ends at {end_mm} mm, not above its start at {start_mm} mm");
    let way_out = "make profile_end_height_mm larger than profile_start_height_mm";
    found.blame(start_mm >= end_mm, "measure.profile_end_height_mm", message, way_out);
    Some(())
}

fn fourier(found: &mut Found) -> Option<()> {
    let path = "gear.pitch_curve.fourier";
    let curve = found.view(path);
    let empty = curve.numbers("cosine")?.is_empty() && curve.numbers("sine")?.is_empty();
    let message = || "the Fourier curve has no harmonics: neither `cosine` nor `sine` has an entry".to_owned();
    found.blame(empty, path, message, "write cosine = [0.0, 0.08], for example, or [gear.pitch_curve.circle]");
    Some(())
}

fn dexels(found: &mut Found) -> Option<()> {
    let (gear, flank) = (found.view("gear"), found.view("fields.flank"));
    let (module_mm, face_width_mm) = (gear.number("module_mm")?, gear.number("face_width_mm")?);
    let along_profile = 2250.0 * module_mm / flank.number("profile_spacing_um")?;
    let along_lead = 1000.0 * face_width_mm / flank.number("lead_spacing_um")?;
    let dexels = along_profile * along_lead;
    let message = || format!("about {dexels:.1e} dexels on one flank; at most {MOST_DEXELS:.0e} are taken");
    let way_out = "make profile_spacing_um or lead_spacing_um larger";
    found.blame(dexels > MOST_DEXELS, "fields.flank.profile_spacing_um", message, way_out);
    Some(())
}

/// Names of operations are unique, also where folders do not tell capitals from small letters.
fn names(found: &mut Found) {
    for (list, what, written) in [("operation", "operations", "folders are"), ("picture", "pictures", "files are")] {
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for index in 0..found.values.count(list) {
            let path = format!("{list}.{index}");
            let Some(name) = found.view(&path).text("name") else { continue };
            let (name, first) = (name.to_owned(), *seen.entry(name.to_lowercase()).or_insert(index));
            let message = || format!("{what} {} and {} are both named \"{name}\"", first + 1, index + 1);
            let way_out =
                format!("give each {list} its own name; capitals do not count, because {written} named after them");
            found.blame(first != index, &join(&path, "name"), message, &way_out);
        }
    }
}

fn picture_tooth(found: &mut Found, path: &str) -> Option<()> {
    let (tooth, teeth) = (found.view(path).whole("tooth")?, found.view("gear").whole("teeth")?);
    let message = || format!("`picture.tooth`: there is no tooth {tooth} on a gear of {teeth}");
    found.blame(tooth > teeth, &join(path, "tooth"), message, "teeth are counted from 1, the first at phi > 0");
    Some(())
}

//! Values compared with each other: contradictions that no single key shows, and sizes that no memory holds.
//!
//! Here for the keys that all processes share; each process checks its own. What needs the pitch curve itself
//! (curvature, undercut, closing) is refused later, where the curve is known.

use std::collections::BTreeMap;

use super::build::sector_deg;
use super::keys::join;
use super::problems::Found;

/// Most dexels on one flank: 100 million take 1.5 GB through all operations, a hundred times a usual flank.
const MOST_DEXELS: f64 = 1e8;

/// Adds a problem for every contradiction between shared keys.
pub(super) fn cross_check(found: &mut Found<'_, '_, '_>) {
    // A missing value ends only the check that asks for it.
    let _: [Option<()>; 5] =
        [gear_kind(found), mate_teeth(found), profile(found), of_round_gears(found), dexels(found)];
    for curve in ["gear.pitch_curve", "gear.pitch_curve.mate.driver"] {
        let _: [Option<()>; 2] = [sinusoidal(found, curve), fourier(found, curve)];
    }
    names(found);
    for index in 0..found.values.count("picture") {
        let _: Option<()> = picture_tooth(found, &format!("picture.{index}"));
    }
}

/// A ring has no bore, and only a ring has a rim.
fn gear_kind(found: &mut Found) -> Option<()> {
    let gear = found.view("gear");
    let internal = gear.text("kind")? == "internal";
    let bore_mm = gear.number("bore_diameter_mm")?;
    let message =
        || format!("`gear.bore_diameter_mm`: {bore_mm} on an internal gear, whose teeth are where a bore would be");
    let way_out = "leave the bore out; rim_mm says how much material lies outside the pitch curve";
    found.blame(internal && bore_mm > 0.0, "gear.bore_diameter_mm", message, way_out);
    let written = found.values.is_written("gear", "rim_mm");
    let message = || "`gear.rim_mm`: an external gear has no rim; it is the ring of an internal one".to_owned();
    found.blame(!internal && written, "gear.rim_mm", message, "leave rim_mm out, or write kind = \"internal\"");
    Some(())
}

/// A driver runs inside an internal gear, which has more teeth.
fn mate_teeth(found: &mut Found) -> Option<()> {
    let gear = found.view("gear");
    let driver = found.view("gear.pitch_curve.mate").whole("driver_teeth")?;
    let teeth = gear.whole("teeth")?;
    let message = || {
        format!("`gear.pitch_curve.mate.driver_teeth`: a driver of {driver} teeth does not fit into a ring of {teeth}")
    };
    let full = gear.text("kind")? == "internal" && driver >= teeth;
    let way_out = "give the driver fewer teeth than gear.teeth";
    found.blame(full, "gear.pitch_curve.mate.driver_teeth", message, way_out);
    Some(())
}

fn sinusoidal(found: &mut Found, curve: &str) -> Option<()> {
    let path = &join(curve, "sinusoidal_ratio");
    let curve = found.view(path);
    let (mean, amplitude) = (curve.number("mean_ratio")?, curve.number("ratio_amplitude")?);
    let message = || {
        format!(
            "`{path}.ratio_amplitude`: {amplitude} is not smaller than mean_ratio = {mean}: the ratio would pass zero"
        )
    };
    let key = join(path, "ratio_amplitude");
    found.blame(amplitude.abs() >= mean, &key, message, "make ratio_amplitude smaller than mean_ratio");
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

/// What only a round gear has.
fn of_round_gears(found: &mut Found) -> Option<()> {
    let curve = found.view("gear").variant("pitch_curve")?;
    // The mate of a circle is one.
    let driver = found.view("gear.pitch_curve.mate").variant("driver").filter(|_| curve == "mate");
    let is_sector = sector_deg(found.values).is_some();
    let is_round = driver.unwrap_or(curve) == "circle" && !is_sector;
    for (key, what, way_out) in [
        (
            "iso_1328_class",
            "the classes of ISO 1328-1",
            "write what the drawing allows in [measure.limits]; without this key gearcut check prints those of the \
             round gear of the same mean diameter",
        ),
        ("ball_diameter_mm", "dimensions over balls", "remove it; results.json has the thickness of every tooth"),
    ] {
        let curve = if is_sector { "a sector" } else { curve };
        let message = || format!("`measure.{key}`: {what} are for round gears, and the pitch curve is {curve}");
        let wrong = !is_round && found.values.is_written("measure", key);
        found.blame(wrong, &join("measure", key), message, way_out);
    }
    Some(())
}

fn fourier(found: &mut Found, curve: &str) -> Option<()> {
    let path = &join(curve, "fourier");
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

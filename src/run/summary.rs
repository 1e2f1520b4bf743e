//! What is printed when a run is done: what a gear engineer asks first, stock before all.

use super::CutGear;
use crate::job::Job;
use crate::output::quantity::Quantity;
use crate::output::results::{BlankResults, ChipPeak, OperationResults, Results, TextureResults};
use crate::output::text::{Sheet, significant};
use std::path::Path;

/// Cuts below the target deeper than this are worth a warning: far above the resolution, below every tolerance on a gear drawing.
const GOUGE_MM: f64 = 1e-4;

/// The summary of a run.
pub fn summary(job: &Job, cut: &CutGear, results: &Results, out: &Path, backend: &str) -> String {
    let mut sheet = Sheet::default();
    let gear = &job.scene.gear;
    let state = if cut.interrupted { ", stopped before all flanks were done" } else { "" };
    sheet.heading(&format!(
        "{}: {} teeth, module {} mm, {} of {} flanks cut{state}",
        results.scene,
        gear.teeth,
        gear.module_mm,
        cut.report.flanks.len(),
        2 * gear.teeth,
    ));
    let headline = &results.headline;
    sheet.line("smallest normal stock", shown(&headline.smallest_normal_stock));
    sheet.line("largest normal stock", shown(&headline.largest_normal_stock));
    sheet.line("highest start of involute", shown(&headline.start_of_involute));
    sheet.line("undercut flanks", shown(&headline.undercut_flanks));
    sheet.line("narrowest tip land", shown(&headline.tip_land));
    sheet.line("pointed teeth", shown(&headline.pointed_teeth));
    sheet.line("highest scallop", shown(&headline.scallop_height));
    sheet.line("witness mark", shown(&headline.witness_mark));
    sheet.line(
        "tooth thickness (arc)",
        format!("{} to {}", shown(&headline.smallest_tooth_thickness), shown(&headline.largest_tooth_thickness)),
    );
    sheet.line("relief on the return stroke", share(&headline.relief_ratio, "of a circular gear's"));
    sheet.line("tightest axis limit", share(&headline.axis_margin, "of it left"));
    sheet.line("largest chip section", at_stroke(&headline.largest_chip_section));
    sheet.line("largest cutting force", at_stroke(&headline.largest_cutting_force));
    if headline.entry_cutting_force.value().is_some() {
        let force = shown(&headline.entry_cutting_force);
        sheet.line("first stroke at full depth", format!("{force} (no machine cuts so: give the operation an infeed)"));
    }
    sheet.line("removal rate", format!("{}, {} idle", shown(&headline.removal_rate), shown(&headline.idle_strokes)));
    sheet.line("time of all strokes", minutes(&headline.cycle_time));
    if let Some(blank) = &results.blank {
        print_blank(&mut sheet, blank);
    }
    for operation in results.operations.iter().filter(|o| !o.teeth.is_empty()) {
        print_unevenness(&mut sheet, operation, results.period_teeth);
    }
    print_texture(&mut sheet, &results.texture);
    for warning in warnings(cut) {
        sheet.heading(&format!("warning: {warning}"));
    }
    sheet.heading("Run");
    sheet.line("backend", backend);
    let per_dexel = cut.stats.dexel_passes as f64 / cut.stats.dexels.max(1) as f64;
    let alike = if cut.stats.dexels < cut.dexels { "; rows are alike, so one was cut for all" } else { "" };
    let millions = cut.dexels as f64 / 1e6;
    sheet.line("dexels", format!("{millions:.1} million, {} passes each{alike}", significant(per_dexel, 3)));
    sheet.line("cut, measured and mapped in", format!("{} s", significant(cut.elapsed.as_secs_f64(), 3)));
    sheet.line("written to", out.display().to_string());
    sheet.into_text()
}

/// Height and core parameters of every window.
fn print_texture(sheet: &mut Sheet, textures: &[TextureResults]) {
    if textures.is_empty() {
        return;
    }
    sheet.heading("Surface texture (ISO 25178-2; chains and all parameters in results.json)");
    let symbols = ["Sa", "Sq", "Sz", "Sk", "Spk", "Svk"];
    let mut rows = vec![vec!["window".to_owned()]];
    rows[0].extend(symbols.map(|symbol| format!("{symbol} um")));
    for texture in textures {
        let mut row = vec![format!("{}: tooth {} {}", texture.operation, texture.tooth, texture.flank)];
        row.extend(symbols.map(|symbol| {
            let value = texture.parameters.get(symbol).and_then(Quantity::value);
            value.map_or_else(|| "-".to_owned(), |value| significant(value, 4))
        }));
        rows.push(row);
    }
    sheet.table(&rows);
    for texture in textures {
        for warning in &texture.warnings {
            let window = format!("{}, tooth {} {}", texture.operation, texture.tooth, texture.flank);
            sheet.heading(&format!("warning: {window}: {warning}"));
        }
    }
}

/// The whole blank in a few lines.
fn print_blank(sheet: &mut Sheet, blank: &BlankResults) {
    let cm3 = |q: &Quantity| q.value().map_or_else(|| "-".to_owned(), |v| format!("{:.3} cm3", 1e-3 * v));
    let removed: Vec<String> =
        blank.operations.iter().map(|o| format!("{} {}", cm3(&o.removed_volume), o.name)).collect();
    sheet.line("material removed", format!("{} of {}", removed.join(", "), cm3(&blank.blank_volume)));
    let kinds = [
        ("gouges", &blank.gouges),
        ("interference", &blank.interference),
        ("return stroke on the gear", &blank.rubbing_on_gear),
        ("return stroke on stock", &blank.rubbing_on_stock),
    ];
    for (name, damage) in kinds {
        let deepest = damage.deepest.value().map(|mm| format!(", up to {} mm deep", significant(mm, 3)));
        let Some(places) = damage.places.value() else {
            sheet.line(name, "not judged: the target's outline is not known in closed form");
            continue;
        };
        sheet.line(name, deepest.map_or_else(|| "none".to_owned(), |deep| format!("{places} sides of teeth{deep}")));
    }
}

fn print_unevenness(sheet: &mut Sheet, operation: &OperationResults, period_teeth: u32) {
    sheet.heading(&format!("Allowance after {} ({})", operation.name, operation.linkage));
    // Below a billionth of a percent stands rounding, not unevenness.
    let percent =
        |q: &Quantity| q.value().map_or_else(|| "-".to_owned(), |v| significant(if v < 1e-9 { 0.0 } else { v }, 4));
    let u = &operation.unevenness;
    let row = |name: &str, spread: &crate::output::results::Spread| {
        vec![name.to_owned(), percent(&spread.max), percent(&spread.mean)]
    };
    sheet.table(&[
        vec!["unevenness".to_owned(), "max %".to_owned(), "mean %".to_owned()],
        row("|AB-CD| / mean of AB and CD, as cut", &u.mean_denominator),
        row("  in the limit of many strokes", &u.envelope_mean_denominator),
        row("|AB-CD| / (delta_d tan alpha), as cut", &u.rack_denominator),
    ]);
    let mm = |q: &Quantity| q.value().map_or_else(|| "-".to_owned(), |v| format!("{v:.4}"));
    let mut rows = vec![["tooth", "AB mm", "CD mm", "unevenness %"].map(str::to_owned).to_vec()];
    for tooth in operation.teeth.iter().take(period_teeth.max(1) as usize) {
        rows.push(vec![
            tooth.index.to_string(),
            mm(&tooth.ab),
            mm(&tooth.cd),
            percent(&tooth.unevenness_mean_denominator),
        ]);
    }
    sheet.table(&rows);
}

/// What a user must know before trusting the numbers.
pub fn warnings(cut: &CutGear) -> Vec<String> {
    let mut warnings = Vec::new();
    let below: u64 = cut.report.flanks.iter().map(|f| f.below_range).sum();
    if below > 0 {
        warnings.push(format!("{below} dexels were cut deeper than their rays record: heights there are upper bounds"));
    }
    let untouched: u64 = cut.report.flanks.iter().map(|f| f.untouched).sum();
    if untouched > 0 {
        warnings.push(format!("{untouched} dexels were touched by no pass: part of the flanks is still the blank"));
    }
    let deepest = cut
        .report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.undercut?)))
        .min_by(|a, b| a.1.value_mm.total_cmp(&b.1.value_mm))
        .filter(|(_, deepest)| deepest.value_mm < -GOUGE_MM);
    if let Some((flank, deepest)) = deepest {
        let count = cut.report.flanks.iter().filter(|f| f.undercut.is_some_and(|u| u.value_mm < -GOUGE_MM)).count();
        warnings.push(format!(
            "{count} flanks are cut below the target, tooth {} {} by {} um, {:.2} mm above the start of the involute",
            flank.tooth,
            flank.side.name(),
            significant(-deepest.value_mm * 1e3, 3),
            deepest.arc_mm
        ));
    }
    if cut.stats.unconverged > 0 {
        let count = cut.stats.unconverged;
        warnings
            .push(format!("{count} rays did not converge: their heights may be too large; please report the scene"));
    }
    if cut.interrupted {
        warnings.push("stopped by Ctrl-C: figures cover the finished flanks only".to_owned());
    }
    warnings
}

fn shown(quantity: &Quantity) -> String {
    let Some(value) = quantity.value() else {
        return format!("none ({})", quantity.why().unwrap_or("not defined"));
    };
    let unit = quantity.unit().unwrap_or("");
    match quantity.place() {
        Some(place) => format!(
            "{} {unit} (tooth {} {}, {:.2} mm along the profile, {:+.1} mm along the tooth)",
            significant(value, 4),
            place.tooth,
            place.flank,
            place.u_mm,
            place.v_mm
        ),
        None => format!("{} {unit}", significant(value, 4)),
    }
}

fn at_stroke(peak: &ChipPeak) -> String {
    match (peak.stroke.value(), peak.space.value()) {
        (Some(stroke), Some(space)) => format!("{} (stroke {stroke}, tooth space {space})", shown(&peak.value)),
        _ => shown(&peak.value),
    }
}

fn share(quantity: &Quantity, of: &str) -> String {
    quantity.value().map_or_else(|| shown(quantity), |value| format!("{:.1} % {of}", 100.0 * value))
}

fn minutes(quantity: &Quantity) -> String {
    quantity.value().map_or_else(|| shown(quantity), crate::output::progress::duration_text)
}

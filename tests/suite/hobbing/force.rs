//! Cutting forces of hob teeth: section of the chip and engaged length of edge, counted by points that know no rays.
//!
//! The material of one tooth space is a cloud of points on a square grid. A pass takes those inside its section away:
//! their number is the section of its chip. The places of the section's border that stand in the blank and in no
//! section before are the edge in engagement.

use super::section_polygon::{Polygon, STEP_MM, sections_near};
use gearcut::cut::cpu::Cpu;
use gearcut::process::hobbing::measure::hob_force::OperationForce;
use gearcut::process::hobbing::run::{force, load as hob_load};
use gearcut::process::hobbing::{HobCutter, HobbedBlank, HobbingJob};
use gearcut::process::load;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// The shipped spur gear, 6 mm wide with a slice at either face, its material's forces as given.
fn spur(settings: &[&str]) -> HobbingJob {
    let mut all = vec!["gear.face_width_mm=6".to_owned(), "fields.blank.slice_spacing_mm=6".to_owned()];
    all.extend(settings.iter().map(|&setting| setting.to_owned()));
    let scene = load(Path::new("scenes/hobbing/circular_spur.toml"), &all).unwrap_or_else(|e| panic!("{e}")).scene;
    HobbingJob::new(&scene).expect("a scene that cuts")
}

fn cut(cutter: &HobCutter) -> HobbedBlank {
    let field = cutter.job.blank_field().expect("fits");
    cutter.cut_blank(&Cpu::default(), field, &|| true).expect("cuts").expect("not stopped")
}

/// Section and engaged edge of one pass in one slice, over the tip's travel through it.
#[derive(Debug, Clone, Copy, Default)]
struct Counted {
    section_mm2: f64,
    edge_mm: f64,
}

/// Passes through a space in the slice `z_mm`: those whose tip stands less than half a pitch beside its middle on the
/// pitch curve, where alone they take material.
fn by_points(cutter: &HobCutter, space: i64, z_mm: f64) -> BTreeMap<u32, Counted> {
    let job = cutter.job;
    let middle = job.curve.frame(job.curve.phi_at_arc(job.target.space_arc_mm(space, z_mm))).point_mm;
    let reach_mm = 0.5 * std::f64::consts::PI * job.scene.gear.module_mm;
    let in_blank = |p: DVec2| job.blank.height(p, p.to_angle()).0 < job.blank.addendum_mm;
    let count = (2.0 * reach_mm / STEP_MM) as i32;
    let along = middle.normalize();
    let mut material: Vec<DVec2> = (-count..=count)
        .flat_map(|i| (-count..=count).map(move |j| DVec2::new(f64::from(i), f64::from(j)) * STEP_MM))
        .map(|p| middle + p.x * along + p.y * along.perp())
        .filter(|&p| in_blank(p))
        .collect();
    let (mut before, mut found): (Vec<Polygon>, _) = (Vec::new(), BTreeMap::new());
    sections_near(cutter, z_mm, middle, reach_mm, |section, polygon| {
        let standing = material.len();
        material.retain(|&p| !polygon.holds(p));
        let taken_mm2 = (standing - material.len()) as f64 * STEP_MM * STEP_MM;
        let mut swept_mm = 0.0;
        for point in &polygon.of_edge {
            // A little inside the tool: not on a border that both sections share.
            let inside = point.place + 1e-4 * point.inward;
            if in_blank(inside) && !before.iter().rev().any(|polygon| polygon.holds(inside)) {
                swept_mm += point.length_mm / section.heading.upright(-point.inward);
            }
        }
        let tip = polygon.of_edge[polygon.of_edge.len() / 2].place;
        if taken_mm2 > 0.0 && along.perp_dot(tip - middle).abs() < reach_mm {
            let per_travel = section.heading.travel_per_mm.recip();
            let counted = Counted { section_mm2: taken_mm2 * per_travel, edge_mm: swept_mm * per_travel };
            found.insert(section.pass, counted);
        }
        before.push(polygon);
    });
    found
}

/// Largest over both slices, pass by pass, of two spaces.
fn of_two_spaces(cutter: &HobCutter, slices_z_mm: &[f64]) -> BTreeMap<u32, Counted> {
    let places: Vec<(f64, i64)> = slices_z_mm.iter().flat_map(|&z_mm| [0, 13].map(|space| (z_mm, space))).collect();
    let found: Vec<_> = places.par_iter().map(|&(z_mm, space)| by_points(cutter, space, z_mm)).collect();
    let mut largest: BTreeMap<u32, Counted> = BTreeMap::new();
    for (pass, counted) in found.into_iter().flatten() {
        let of_pass = largest.entry(pass).or_default();
        of_pass.section_mm2 = of_pass.section_mm2.max(counted.section_mm2);
        of_pass.edge_mm = of_pass.edge_mm.max(counted.edge_mm);
    }
    largest
}

/// Work of all teeth, N mm, and their volume, mm3.
fn work_and_volume(settings: &[&str]) -> [f64; 2] {
    let job = spur(settings);
    let cutter = HobCutter::new(&job).expect("passes");
    let blank = cut(&cutter);
    let forces = force::measure(&cutter, &blank);
    let loads = hob_load::measure(&cutter, &blank);
    [forces[0].work_nmm(), loads[0].volume_mm3()]
}

#[test]
fn without_a_material_no_force_is_computed() {
    let job = spur(&["fields.blank.spacing_mm=1.5"]);
    let cutter = HobCutter::new(&job).expect("passes");
    let blank = cut(&cutter);
    assert!(blank.in_slices.is_empty() && force::measure(&cutter, &blank).is_empty());
    assert!(force::findings(&job, &[]).is_none());
}

/// Work is K_c times the volume where the edge costs nothing: the closed form of the law.
#[test]
fn work_is_the_specific_force_times_the_volume() {
    let [work_nmm, volume_mm3] = work_and_volume(&[
        "fields.blank.spacing_mm=1",
        "material.cutting_force_n_per_mm2=1234",
        "material.cutting_edge_force_n_per_mm=0",
    ]);
    assert!(volume_mm3 > 100.0 && (work_nmm / (1234.0 * volume_mm3) - 1.0).abs() < 1e-9, "{work_nmm}, {volume_mm3}");
}

#[test]
fn findings_say_force_power_and_place() {
    let job = spur(&["fields.blank.spacing_mm=1", "material.name=\"42CrMo4\""]);
    let cutter = HobCutter::new(&job).expect("passes");
    let forces = force::measure(&cutter, &cut(&cutter));
    let found = force::findings(&job, &forces).expect("a material");
    let number = |key: &str| found.number(&format!("operations.finish.{key}")).expect("a number");
    let [force_n, power_w] = ["largest_cutting_force", "largest_power"].map(number);
    // 200 turns a minute of a tip at 40 + 1.25 x 3 mm.
    let speed_m_per_s = std::f64::consts::TAU * 200.0 / 60.0 * 43.75e-3;
    assert!((power_w / (force_n * speed_m_per_s) - 1.0).abs() < 1e-3, "{force_n} N, {power_w} W");
    assert!(number("mean_force") < force_n && number("mean_power") > 0.0);
    let place = found.quantity("operations.finish.largest_cutting_force").and_then(|q| q.place()).expect("a place");
    assert!(place.get("hob_tooth").is_some() && place.get("time_s").is_some());
    let table = found.table_at("over_time").expect("a table");
    assert_eq!(table.len(), forces[0].passes.len());
    assert_eq!(force::bars(&job, &forces).len() + force::over_time(&job, &forces).len(), 2);
}

mod slow {
    use super::*;

    /// Ratios of rays to points, sorted.
    fn ratios(pairs: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
        let mut ratios: Vec<f64> = pairs.map(|[rays, points]| rays / points).collect();
        ratios.sort_by(f64::total_cmp);
        ratios
    }

    #[test]
    fn section_and_engaged_edge_are_those_of_points() {
        let mut wanted: Option<BTreeMap<u32, Counted>> = None;
        let mut spreads = Vec::new();
        for spacing in ["0.3", "0.15"] {
            let job =
                spur(&[&format!("fields.blank.spacing_mm={spacing}"), "gear.teeth=20", "material.name=\"16MnCr5\""]);
            let cutter = HobCutter::new(&job).expect("passes");
            let blank = cut(&cutter);
            let wanted = wanted.get_or_insert_with(|| of_two_spaces(&cutter, &blank.cut.field.grid.slices_z_mm));
            let forces: Vec<OperationForce> = force::measure(&cutter, &blank);
            let by_pass: BTreeMap<u32, Counted> = blank.in_slices[0].iter().fold(BTreeMap::new(), |mut all, chip| {
                let of_pass: &mut Counted = all.entry(chip.pass).or_default();
                let volume_mm3 = 0.5 * (chip.removed_mm3[0] + chip.removed_mm3[1]);
                of_pass.section_mm2 = of_pass.section_mm2.max(volume_mm3 / chip.travel_mm);
                of_pass.edge_mm = of_pass.edge_mm.max(chip.swept_mm2 / chip.travel_mm);
                all
            });
            assert_eq!(by_pass.len(), forces[0].passes.len());
            // Chips that points tell well: at least a hundred of them.
            let pairs = |pick: fn(&Counted) -> f64| {
                let well = wanted.iter().filter(|(_, counted)| counted.section_mm2 > 0.16);
                ratios(
                    well.filter_map(|(pass, points)| Some([pick(by_pass.get(pass)?), pick(points)]))
                        .collect::<Vec<_>>()
                        .into_iter(),
                )
            };
            let (sections, edges) = (pairs(|c| c.section_mm2), pairs(|c| c.edge_mm));
            for (name, ratios) in [("section", &sections), ("engaged edge", &edges)] {
                let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share).round() as usize];
                let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
                let square = ratios.iter().map(|r| (r - 1.0).powi(2)).sum::<f64>() / ratios.len() as f64;
                println!(
                    "rays {spacing} mm apart, {name}: {} chips, ratio {:.3} {:.3} {:.3} {:.3} {:.3}, \
                     mean {mean:.4}, rms {:.4}",
                    ratios.len(),
                    at(0.0),
                    at(0.05),
                    at(0.5),
                    at(0.95),
                    at(1.0),
                    square.sqrt()
                );
                spreads.push(square.sqrt());
            }
            let largest = |pick: fn(&Counted) -> f64| {
                [by_pass.values().map(pick).fold(0.0, f64::max), wanted.values().map(pick).fold(0.0, f64::max)]
            };
            println!(
                "largest section {:.4?} mm2, largest edge {:.3?} mm (rays, points)",
                largest(|c| c.section_mm2),
                largest(|c| c.edge_mm)
            );
        }
        assert!(spreads[2] < spreads[0] && spreads[3] < spreads[1], "{spreads:?}");
    }
}

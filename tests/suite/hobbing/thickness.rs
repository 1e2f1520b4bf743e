//! Uncut chip thickness of hob teeth against a front of points: sections of all passes through one tooth space as fine
//! polygons, no rays, no normals.
//!
//! The surface of the material is a cloud of points. A pass takes those inside its section away: they are the old
//! surface of its chip. Points of the section's border that stand in material join the cloud: the new one. The chip's
//! thickness is the largest distance of a new point from the nearest old one.

use super::section_polygon::{EdgePoint, Polygon, STEP_MM, sections_near};
use gearcut::cut::cpu::Cpu;
use gearcut::process::hobbing::{HobCutter, HobbingJob};
use gearcut::process::load;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// Thickness of the chips of all passes in the slice `z_mm` within `reach_mm` of a space's middle on the pitch curve.
fn by_points(cutter: &HobCutter, space: i64, z_mm: f64, reach_mm: f64) -> BTreeMap<u32, f64> {
    let job = cutter.job;
    let middle_arc_mm = job.target.space_arc_mm(space, z_mm);
    let middle = job.curve.frame(job.curve.phi_at_arc(middle_arc_mm)).point_mm;
    let outline = |i: i32| {
        let phi = middle.to_angle() + f64::from(i) * STEP_MM / middle.length();
        job.blank.outline_mm(phi)
    };
    let half = (2.0 * reach_mm / STEP_MM) as i32;
    let mut front: Vec<DVec2> = (-half..=half).map(outline).collect();
    let (mut before, mut found): (Vec<Polygon>, _) = (Vec::new(), BTreeMap::new());
    sections_near(cutter, z_mm, middle, reach_mm, |section, polygon| {
        let (old, kept): (Vec<DVec2>, Vec<DVec2>) =
            std::mem::take(&mut front).into_iter().partition(|&p| polygon.holds(p));
        front = kept;
        let mut thickest_mm = 0.0_f64;
        for &EdgePoint { place, inward, .. } in &polygon.of_edge {
            // A little inside the tool: not on a border that both sections share.
            let inside = place + 1e-5 * inward;
            let stands = place.distance(middle) < 1.5 * reach_mm
                && job.blank.height(inside, inside.to_angle()).0 < job.blank.addendum_mm
                && !before.iter().rev().any(|polygon| polygon.holds(inside));
            if !stands {
                continue;
            }
            front.push(place);
            let nearest = old.iter().map(|old| old.distance_squared(place)).fold(f64::INFINITY, f64::min).sqrt();
            if nearest.is_finite() && place.distance(middle) < reach_mm {
                thickest_mm = thickest_mm.max(nearest * section.heading.upright(-inward));
            }
        }
        if thickest_mm > 0.0 {
            found.insert(section.pass, thickest_mm);
        }
        before.push(polygon);
    });
    found
}

mod slow {
    use super::*;

    #[test]
    fn thickness_is_that_of_points() {
        let (mut wanted, mut close): (Option<BTreeMap<u32, f64>>, _) = (None, Vec::new());
        // At 0.6 mm, as long as the thickest chips, rays miss so much of them that values are up to a half too large.
        for (spacing, within) in [("0.3", 0.1), ("0.15", 0.05)] {
            let settings = [
                format!("fields.blank.spacing_mm={spacing}"),
                "gear.face_width_mm=6".to_owned(),
                "fields.blank.slice_spacing_mm=6".to_owned(),
            ];
            let scene =
                load(Path::new("scenes/hobbing/circular_spur.toml"), &settings).unwrap_or_else(|e| panic!("{e}")).scene;
            let job = HobbingJob::new(&scene).expect("a scene that cuts");
            let cutter = HobCutter::new(&job).expect("passes");
            let field = job.blank_field().expect("fits");
            let slices = field.grid.slices_z_mm.clone();
            let blank = cutter.cut_blank(&Cpu::default(), field, &|| true).expect("cuts").expect("not stopped");
            let wanted = wanted.get_or_insert_with(|| {
                let places: Vec<(f64, i64)> =
                    slices.iter().flat_map(|&z_mm| [0, 13].map(|space| (z_mm, space))).collect();
                let found: Vec<_> =
                    places.par_iter().map(|&(z_mm, space)| by_points(&cutter, space, z_mm, 4.5)).collect();
                let mut largest = BTreeMap::new();
                for (pass, mm) in found.into_iter().flatten() {
                    let of_pass = largest.entry(pass).or_insert(0.0_f64);
                    *of_pass = of_pass.max(mm);
                }
                largest
            });
            // Two slices of all 40 spaces by rays, of two spaces by points: the thickest chip of all.
            let by_rays = blank.chips[0].iter().map(|chip| chip.thickness_mm).fold(0.0, f64::max);
            let by_points = wanted.values().copied().fold(0.0, f64::max);
            // Chip by chip, those that points tell well: rays may miss a short thick place, but find none that is not
            // there.
            let mut ratios: Vec<f64> = blank.chips[0]
                .iter()
                .filter_map(|chip| Some(chip.thickness_mm / wanted.get(&chip.pass).filter(|&&mm| mm > 0.07)?))
                .collect();
            ratios.sort_by(f64::total_cmp);
            let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share).round() as usize];
            let near = ratios.iter().filter(|&&ratio| (ratio - 1.0).abs() < 0.1).count() as f64 / ratios.len() as f64;
            println!(
                "rays {spacing} mm apart: thickest {by_rays:.4} mm, {by_points:.4} by points; {} chips, ratio {:.3} \
                {:.3} {:.3} {:.3}, {near:.3} within a tenth",
                ratios.len(),
                at(0.0),
                at(0.5),
                at(0.95),
                at(1.0)
            );
            assert!((by_rays / by_points - 1.0).abs() < within);
            assert!(ratios.len() > 50 && at(0.5) > 0.9 && at(0.5) < 1.02 && at(0.95) < 1.05 && at(1.0) < 1.0 + within);
            close.push(near);
        }
        assert!(close[0] < close[1] && close[1] > 0.75, "{close:?}");
    }
}

//! What the blank field says about any gear: volumes counted twice, and damage to the target.
//!
//! In: the cut blank, the target's section in a slice. Out: [`Damage`] by tooth, side and zone, deepest place and
//! volume.
//!
//! Material of the target that is not there was taken by the pass that left the surface beside the gap. Whatever lies
//! less than [`LEAST_DEPTH_MM`] under the target is left out: rays and outline are no better than that.

use super::gear_place::{GearPlace, Zone};
use super::target_outline::TargetOutline;
use crate::scene::model::Gear;
use gearcut_core::cut::CutBlank;
use gearcut_core::dexel::{BlankField, NO_PASS, intervals};
use gearcut_core::math::planar_rays::FAMILIES;
use gearcut_core::terms::Side;
use glam::DVec2;
use std::collections::BTreeMap;
use std::f64::consts::SQRT_2;

/// Damage and rubbing less deep than this are not reported: above the errors of the outline (chords of the target, 0.1
/// um in a fillet), below what any machine holds.
pub const LEAST_DEPTH_MM: f64 = 1e-3;

/// Depth from which on a cut below the target is a gouge, mm: what ISO 1328-1:2013 allows a profile of this module as
/// form deviation in class 8, f_f_alpha = (0.55 m + 5) um times sqrt(2)^(8 - 5). Shallower cuts are deviations.
pub fn gouge_mm(module_mm: f64) -> f64 {
    1e-3 * (0.55 * module_mm + 5.0) * SQRT_2.powi(3)
}

/// Damage or rubbing on one side of a tooth by one operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damage {
    /// Index of the operation.
    pub operation: usize,
    /// Where it is deepest.
    pub place: GearPlace,
    /// That place in the gear frame, mm.
    pub point_mm: DVec2,
    /// And along the tooth from the middle of the face, mm.
    pub z_mm: f64,
    /// Largest depth, mm: along the normal of a flank; in the transverse section, where that is no shorter, of roots,
    /// fillets and tips.
    pub depth_mm: f64,
    /// Volume, mm3: mean of both families. For rubbing the sum over strokes.
    pub volume_mm3: f64,
    /// Stroke that made the deepest place.
    pub stroke: usize,
    /// Cutter tooth that made it.
    pub blade: u32,
}

/// Volume that an operation removed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperationVolume {
    /// Pass by pass, mm3, by both families.
    pub by_passes_mm3: [f64; 2],
    /// As missing from the rays, mm3, by both families.
    pub by_rays_mm3: [f64; 2],
}

impl OperationVolume {
    /// Largest difference of the two counts, relative to the volume.
    pub fn imbalance(&self) -> f64 {
        let off = |f: usize| {
            let scale = self.by_rays_mm3[f].abs().max(f64::MIN_POSITIVE);
            (self.by_passes_mm3[f] - self.by_rays_mm3[f]).abs() / scale
        };
        off(0).max(off(1))
    }
}

/// Section that is left against the target's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndFace {
    /// Mean section by rays of both families, mm2.
    pub cut_mm2: [f64; 2],
    /// Area of the target's section, mm2.
    pub target_mm2: f64,
    /// How far rays at this spacing may be off, mm2, by both families.
    pub bound_mm2: [f64; 2],
}

/// Volume of every operation, by its passes and by the rays.
pub fn volumes(cut: &CutBlank) -> Vec<OperationVolume> {
    let before = std::iter::once(&cut.blank_mm3).chain(&cut.left_mm3);
    let pairs = before.zip(&cut.left_mm3).zip(&cut.cuts);
    pairs
        .map(|((before, after), done)| OperationVolume {
            by_passes_mm3: [0, 1].map(|f| done.removed_mm3.iter().map(|pass| pass[f]).sum()),
            by_rays_mm3: [0, 1].map(|f| before[f] - after[f]),
        })
        .collect()
}

/// Damage of one side of a tooth: what [`collect`] sorts by.
type Where = (usize, u32, Side, Zone, bool);

/// One ray's share of some damage.
pub struct Finding {
    /// Index of the operation.
    pub operation: usize,
    /// On a surface that stays; otherwise on stock that is still to be removed.
    pub stays: bool,
    /// Deepest place on the ray, gear frame, mm.
    pub point_mm: DVec2,
    /// Its place along the tooth from the middle of the face, mm.
    pub z_mm: f64,
    /// Depth along the normal in the transverse section, mm.
    pub depth_mm: f64,
    /// The ray's share of the volume, half of it for each family, mm3.
    pub volume_mm3: f64,
    /// Pass that did it.
    pub pass: u32,
}

/// Findings side by side of the teeth, deepest place and volume each; only those at least [`LEAST_DEPTH_MM`] deep.
///
/// Depths of a helical gear's flanks become those along their spatial normals, which lean by the base helix angle.
/// `place` names places, `maker` gives stroke and blade behind a pass of an operation.
pub fn collect(
    gear: &Gear,
    findings: impl Iterator<Item = Finding>,
    place: impl Fn(&Finding) -> GearPlace,
    maker: impl Fn(usize, u32) -> (usize, u32),
) -> Vec<(Damage, bool)> {
    let mut sides: BTreeMap<Where, Damage> = BTreeMap::new();
    for finding in findings {
        let place = place(&finding);
        let leaning = if place.zone == Zone::Flank { gear.base_helix_cosine() } else { 1.0 };
        let depth_mm = finding.depth_mm * leaning;
        let (stroke, blade) = maker(finding.operation, finding.pass);
        let key = (finding.operation, place.tooth, place.side, place.zone, finding.stays);
        let damage = sides.entry(key).or_insert(Damage {
            operation: finding.operation,
            place,
            point_mm: finding.point_mm,
            z_mm: finding.z_mm,
            depth_mm,
            volume_mm3: 0.0,
            stroke,
            blade,
        });
        let volume_mm3 = damage.volume_mm3 + finding.volume_mm3;
        if depth_mm > damage.depth_mm {
            let (point_mm, z_mm) = (finding.point_mm, finding.z_mm);
            *damage = Damage { place, point_mm, z_mm, depth_mm, stroke, blade, ..*damage };
        }
        damage.volume_mm3 = volume_mm3;
    }
    let deep = sides.into_iter().filter(|(_, damage)| damage.depth_mm >= LEAST_DEPTH_MM);
    deep.map(|((.., stays), damage)| (damage, stays)).collect()
}

/// Material of the target that one slice of a field lacks, ray by ray; `operation_of` knows whose pass it was.
pub fn missing_in_slice(
    field: &BlankField,
    slice: usize,
    target: &TargetOutline,
    gear: &Gear,
    operation_of: impl Fn(u32) -> Option<usize>,
) -> Vec<Finding> {
    let grid = &field.grid;
    let step_mm = 0.5 * gear.module_mm;
    let (width_mm, z_mm) = (grid.slice_widths_mm()[slice], grid.slices_z_mm[slice]);
    let mut findings = Vec::new();
    for (f, family) in FAMILIES.into_iter().enumerate() {
        let row = &grid.rows[f];
        let wanted = target.spans(family, row);
        for (ray, spans) in field.slices[slice].rays[f].iter().enumerate() {
            let gaps = intervals::missing(&wanted[ray], spans);
            for [low, high] in gaps.into_iter().filter(|[low, high]| high - low > LEAST_DEPTH_MM) {
                let deepest = deepest_of(target, step_mm, [low, high].map(|along| family.point(along, row.at_mm(ray))));
                let Some(pass) = pass_beside(spans, low, high) else { continue };
                let Some(operation) = operation_of(pass) else { continue };
                findings.push(Finding {
                    operation,
                    stays: true,
                    point_mm: deepest.1,
                    z_mm,
                    depth_mm: deepest.0,
                    volume_mm3: 0.5 * (high - low) * row.spacing_mm * width_mm,
                    pass,
                });
            }
        }
    }
    findings
}

/// Deepest of the places along a gap, its ends and middle among them and no further apart than `step_mm`: depth under
/// the outline and place. Depths of neighbours differ by no more than their distance, so what lies between two of them
/// is at most a quarter of a module deeper.
fn deepest_of(target: &TargetOutline, step_mm: f64, [low_mm, high_mm]: [DVec2; 2]) -> (f64, DVec2) {
    let steps = 2 * (0.5 * low_mm.distance(high_mm) / step_mm).ceil().max(1.0) as u32;
    let places = (0..=steps).map(|step| low_mm.lerp(high_mm, f64::from(step) / f64::from(steps)));
    let depths = places.filter_map(|place| Some((-target.distance_mm(place, f64::INFINITY)?, place)));
    depths.reduce(|best, next| if next.0 > best.0 { next } else { best }).unwrap_or((0.0, low_mm))
}

/// Pass that left the surface at an end of a gap. Where the target is gone from end to end the ray knows no pass; the
/// rays across it, which end in what is left, do.
fn pass_beside(spans: &[intervals::Span], low_mm: f64, high_mm: f64) -> Option<u32> {
    let above = spans.iter().find(|s| s.low.at_mm == high_mm).map(|s| s.low.pass);
    let below = spans.iter().find(|s| s.high.at_mm == low_mm).map(|s| s.high.pass);
    above.into_iter().chain(below).find(|&pass| pass != NO_PASS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;
    use gearcut_core::dexel::blank_field::Slice;
    use gearcut_core::dexel::{BlankGrid, intervals::Span};
    use gearcut_core::gear::Back;
    use gearcut_core::math::planar_rays::RayRow;
    use std::path::Path;

    /// A square of 20 mm through whose middle a pass has cut a slot of 16 mm, nowhere less than 2 mm from the outline:
    /// several modules deep, and told as deep as it is.
    #[test]
    fn a_cut_through_the_body_is_as_deep_as_it_lies_under_the_target() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping/circular_m3_z24.toml");
        let gear = process::load(&path, &[]).expect("a shipped scene").scene.gear;
        let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(|(x, y)| DVec2::new(x, y));
        let target = TargetOutline::new(corners.to_vec(), Back::bore(0.0));
        let row = |count| RayRow { first_mm: 10.0, spacing_mm: 1.0, count };
        let grid = BlankGrid { rows: [row(1), row(0)], slices_z_mm: vec![0.0], face_width_mm: 1.0 };
        let normal = [0.0; 2];
        let end = |at_mm, pass| intervals::End { at_mm, pass, normal };
        let spans = vec![
            Span { low: end(0.0, NO_PASS), high: end(2.0, 7) },
            Span { low: end(18.0, 7), high: end(20.0, NO_PASS) },
        ];
        let field = BlankField { grid, slices: vec![Slice { rays: [vec![spans], Vec::new()] }] };
        let found = missing_in_slice(&field, 0, &target, &gear, |_| Some(0));
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].depth_mm, found[0].point_mm), (10.0, DVec2::new(10.0, 10.0)));
        let place = |_: &Finding| GearPlace { tooth: 1, side: Side::Left, zone: Zone::Root, height_mm: 0.0 };
        assert_eq!(collect(&gear, found.into_iter(), place, |_, _| (0, 0)).len(), 1, "and is not passed over");
    }
}

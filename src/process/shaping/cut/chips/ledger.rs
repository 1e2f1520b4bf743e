//! The ledger of a whole job: spaces in parallel, strokes in order of time within each of them.

use super::oblique::ElementForce;
use super::space::{LEAST_AREA_MM2, Space, contours, middle_pose};
use super::stroke::{PlaceContact, StrokeChips, StrokePose, ToothChip};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::scene::model::Infeed;
use crate::process::shaping::tool::edge_polygon::{EdgePolygon, Station};
use gearcut_core::cut::LEAST_CHIP_MM;
use gearcut_core::passes::sections::swept_sections::EDGE_PLACES;
use glam::DVec2;
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Most rows of a map over strokes: more cannot be told apart in a picture, and files stay small.
const MOST_ROWS: usize = 2000;

/// Largest uncut chip thickness over rows (strokes or spaces) and stations of the edge.
#[derive(Debug, Clone, PartialEq)]
pub struct ThicknessMap {
    /// Rows.
    pub rows: usize,
    /// Strokes (or spaces) that a row stands for.
    pub per_row: f64,
    /// Thickness, mm, row by row; 0 where nothing is cut.
    pub thickness_mm: Vec<f32>,
}

/// Chips of one operation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationChips {
    /// The first stroke comes at full depth, without an infeed: it takes a plug of whole tooth spaces at once, as no
    /// machine would, and is left out where strokes are compared.
    pub enters_at_depth: bool,
    /// One entry per stroke.
    pub strokes: Vec<StrokeChips>,
    /// Largest thickness over strokes and edge, over all cutter teeth.
    pub by_stroke: ThicknessMap,
    /// Largest thickness over tooth spaces ([`ShapingJob::spaces`]) and edge.
    pub by_space: ThicknessMap,
}

/// Chips of a whole job.
#[derive(Debug, Clone, PartialEq)]
pub struct ChipLedger {
    /// Operations in order.
    pub operations: Vec<OperationChips>,
    /// Places along the edge.
    pub stations: Vec<Station>,
    /// Spacing of rays and stations, mm.
    pub spacing_mm: f64,
    /// Every tooth's chip, in order of time, where the scene says how the cutter wears; none otherwise.
    pub worn_by: Vec<ToothChip>,
}

/// What one space gives to the ledger.
pub(super) struct SpaceChips {
    /// Of its own teeth, in order of time.
    pub(super) chips: Vec<ToothChip>,
    /// Per operation, (row of the map over strokes, thickness at the stations).
    rows: Vec<Vec<(usize, Vec<f32>)>>,
}

impl ChipLedger {
    /// Follows all strokes of a job; `advance` is called after every space and says whether to go on. `None`: stopped.
    pub fn new(job: &ShapingJob, advance: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        Self::of_spaces(job, job.spaces(), advance)
    }

    /// The same with the chips of these spaces alone.
    pub fn of_spaces(
        job: &ShapingJob,
        spaces: RangeInclusive<u32>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        let spacing_mm = job.chip_spacing_mm;
        let polygon = EdgePolygon::new(job.cutter.edge(), spacing_mm);
        let forces = ElementForce::along_edge(&job.material, job.cutter_spec.rake_angle_rad, &polygon.stations);
        let contours_mm = contours(job);
        let spaces: Vec<Option<SpaceChips>> = spaces
            .into_par_iter()
            .map(|space| advance().then(|| chips_of(&Space::new(job, &polygon, &contours_mm, space, 0.0), &forces)))
            .collect();
        let stations = polygon.stations.len();
        let map = |rows: usize, per_row| ThicknessMap { rows, per_row, thickness_mm: vec![0.0; rows * stations] };
        let mut operations: Vec<OperationChips> = job
            .operations
            .iter()
            .map(|operation| {
                let count = operation.count();
                OperationChips {
                    enters_at_depth: operation.spec.infeed == Infeed::None,
                    strokes: vec![StrokeChips::default(); count],
                    by_stroke: map(count.min(MOST_ROWS), count.max(1) as f64 / count.clamp(1, MOST_ROWS) as f64),
                    by_space: map(job.spaces().count(), 1.0),
                }
            })
            .collect();
        let mut chips = Vec::new();
        for (index, space) in spaces.into_iter().enumerate() {
            let space = space?;
            chips.extend(space.chips);
            for (operation, rows) in operations.iter_mut().zip(space.rows) {
                for (row, thickness_mm) in rows {
                    raise(&mut operation.by_stroke.thickness_mm[row * stations..][..stations], &thickness_mm);
                    raise(&mut operation.by_space.thickness_mm[index * stations..][..stations], &thickness_mm);
                }
            }
        }
        chips.sort_unstable_by_key(|c| (c.operation, c.stroke, c.blade));
        let eccentricity_mm = job.eccentricity_mm();
        let module_mm = job.scene.gear.module_mm;
        for chip in &chips {
            let pose = middle_pose(job, chip.operation, chip.stroke as usize);
            let stroke = &mut operations[chip.operation].strokes[chip.stroke as usize];
            stroke.add(chip, module_mm, pose.translation_mm + eccentricity_mm);
        }
        let worn_by = if job.wear.is_some() { chips } else { Vec::new() };
        Some(Self { operations, stations: polygon.stations, spacing_mm, worn_by })
    }

    /// Area that an operation takes from the transverse section, mm^2.
    pub fn area_mm2(&self, operation: usize) -> f64 {
        self.operations[operation].strokes.iter().map(|stroke| stroke.area_mm2).sum()
    }
}

impl OperationChips {
    /// The stroke with the largest value, an entry at depth left out; `None` if all others are idle.
    pub fn largest(&self, value: impl Fn(&StrokeChips) -> f64) -> Option<(usize, &StrokeChips)> {
        let compared = self.strokes.iter().enumerate().skip(usize::from(self.enters_at_depth));
        let busy = compared.filter(|(_, stroke)| !stroke.is_idle());
        busy.reduce(|best, next| if value(next.1) > value(best.1) { next } else { best })
    }

    /// The first stroke, where it enters at depth and cuts.
    pub fn entry(&self) -> Option<&StrokeChips> {
        self.strokes.first().filter(|stroke| self.enters_at_depth && !stroke.is_idle())
    }

    /// Strokes that cut nothing.
    pub fn idle(&self) -> usize {
        self.strokes.iter().filter(|stroke| stroke.is_idle()).count()
    }
}

fn raise(map: &mut [f32], values: &[f32]) {
    for (cell, &value) in map.iter_mut().zip(values) {
        *cell = cell.max(value);
    }
}

/// All chips of a space, stroke by stroke.
pub(super) fn chips_of(space: &Space, forces: &[ElementForce]) -> SpaceChips {
    let (job, operations) = (space.job, &space.job.operations);
    let mut chips = Vec::new();
    let mut rows: Vec<Vec<(usize, Vec<f32>)>> = vec![Vec::new(); operations.len()];
    if space.passes.is_empty() {
        return SpaceChips { chips, rows };
    }
    let mut section = space.section();
    let mut thickness_mm = Vec::new();
    for pass in &space.passes {
        let area_mm2 = section.cut(&pass.section_from_blade);
        if !pass.own || area_mm2 < LEAST_AREA_MM2 {
            continue;
        }
        section.thickness_mm(&pass.section_from_blade, &mut thickness_mm);
        let operation = pass.operation as usize;
        let mut chip = ToothChip {
            operation,
            stroke: pass.stroke,
            blade: pass.blade,
            space: space.number,
            area_mm2,
            contact_mm: [0.0; 3],
            edge: [PlaceContact::default(); EDGE_PLACES],
            thickest_mm: [0.0; 3],
            cutting_n: 0.0,
            side_force_n: DVec2::ZERO,
            work_torque_nmm: 0.0,
            cutter_torque_nmm: 0.0,
        };
        let stand = StrokePose {
            work_from_blade: space.work_from_section.after(&pass.section_from_blade),
            cutter_axis_mm: middle_pose(job, operation, pass.stroke as usize).translation_mm,
            work_axis_mm: -job.eccentricity_mm(),
        };
        chip.measure(&space.polygon.stations, forces, &thickness_mm, &stand);
        chips.push(chip);
        let row = pass.stroke as usize * operations[operation].count().min(MOST_ROWS) / operations[operation].count();
        let shown = thickness_mm.iter().map(|&h| if h < LEAST_CHIP_MM { 0.0 } else { h as f32 });
        match rows[operation].last_mut() {
            Some((last, values)) if *last == row => raise(values, &shown.collect::<Vec<_>>()),
            _ => rows[operation].push((row, shown.collect())),
        }
    }
    SpaceChips { chips, rows }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use std::path::Path;

    /// Chips of some spaces of a shipped scene: with the passes that they depend on, with all passes, and with those of
    /// their own teeth alone; with the number of passes of each.
    fn chips(scene: &str, settings: &[&str], spaces: [u32; 3]) -> [(Vec<ToothChip>, usize); 3] {
        let settings: Vec<String> = settings.iter().map(|&key| key.to_owned()).collect();
        let scene = load(Path::new(scene), &settings).expect("a shipped scene");
        let job = ShapingJob::new(scene.scene).expect("a shipped gear");
        let polygon = EdgePolygon::new(job.cutter.edge(), job.chip_spacing_mm);
        let forces = ElementForce::along_edge(&job.material, job.cutter_spec.rake_angle_rad, &polygon.stations);
        let contours_mm = contours(&job);
        let mut found = [(); 3].map(|()| (Vec::new(), 0));
        for number in spaces {
            let all = || Space::with_all_passes(&job, &polygon, &contours_mm, number, 0.0).0;
            let mut own = all();
            own.passes.retain(|pass| pass.own);
            let kept = Space::new(&job, &polygon, &contours_mm, number, 0.0);
            for ((chips, passes), space) in found.iter_mut().zip([kept, all(), own]) {
                chips.extend(chips_of(&space, &forces).chips);
                *passes += space.passes.len();
            }
        }
        found
    }

    /// Gears of all kinds, pitch curves that bend inwards, a cutter of few teeth whose tips meet pointed teeth.
    const GEARS: [(&str, &[&str]); 6] = [
        ("scenes/shaping/elliptical_normal.toml", &[]),
        ("scenes/shaping/elliptical_traditional.toml", &[]),
        ("scenes/shaping/fourier_concave.toml", &[]),
        ("scenes/shaping/internal_ellipse.toml", &[]),
        ("scenes/shaping/circular_m3_z24.toml", &["gear.addendum_coefficient=1.3"]),
        ("scenes/shaping/machine_errors.toml", &[]),
    ];

    #[test]
    fn passes_that_are_left_out_change_no_chip() {
        for (scene, settings) in GEARS {
            let [(kept, some), (all, every), _] = chips(scene, settings, [1, 4, 9]);
            println!("{scene}: {some} of {every} passes, {} chips", kept.len());
            assert!(kept.len() > 100, "{scene}: {} chips", kept.len());
            assert!(kept == all, "{scene}");
            assert!(some < every, "{scene}: {some} of {every} passes");
        }
    }

    /// Planted: a space whose own teeth alone cut has other chips where those of the next spaces have come before.
    #[test]
    fn passes_of_other_teeth_are_missed() {
        let other = GEARS.iter().filter(|(scene, settings)| {
            let [_, (all, _), (own, _)] = chips(scene, settings, [1, 4, 9]);
            own != all
        });
        assert!(other.count() > 0, "passes of other teeth never matter on these gears");
    }
}

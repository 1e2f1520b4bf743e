//! Deflections by another road: the material as polygons instead of rays, distances by looking at every side, small
//! steps towards C Q instead of Newton's, each stroke after the deflected ones before it.

use super::deflection::{ROUND, SOFT, found, with};
use super::machine_errors::job;
use gearcut::frame::Rigid2;
use gearcut::machine_errors::Deflection;
use gearcut::process::shaping::ShapingJob;
use gearcut::tool::{CuttingTool, PlanarTool};
use glam::{DVec2, DVec4};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use std::f64::consts::TAU;

/// The material as polygons, and what is left of it stroke by stroke.
struct Polygons {
    left: Vec<Vec<[f64; 2]>>,
    tooth: Vec<DVec2>,
    /// Places in the middle of short pieces of the edge: point, normal out of the tool, length.
    edge: Vec<(DVec2, DVec2, f64)>,
}

impl Polygons {
    fn new(job: &ShapingJob) -> Self {
        let blank = (0..8000).map(|i| {
            let frame = job.curve.frame(TAU * f64::from(i) / 8000.0);
            (frame.point_mm + job.blank.addendum_mm * frame.normal).to_array()
        });
        let (mut tooth, mut edge) = (Vec::new(), Vec::new());
        for segment in &job.cutter.edge().segments {
            let [from, to] = segment.y_range_mm;
            let at = |share: f64| {
                let y = from + (to - from) * share;
                segment.blade_from_segment.point(DVec2::new(segment.x_and_slope(y)[0], y))
            };
            tooth.extend((0..=240).map(|i| at(f64::from(i) / 240.0)));
            let pieces = ((at(1.0) - at(0.0)).length() / 0.025).ceil();
            edge.extend((0..pieces as u32).map(|i| {
                let [a, b] = [0.0, 1.0].map(|end| at((f64::from(i) + end) / pieces));
                // The edge runs from the right to the left flank, the tool on its left hand.
                (at((f64::from(i) + 0.5) / pieces), -(b - a).normalize().perp(), (b - a).length())
            }));
        }
        tooth.push(DVec2::ZERO);
        Self { left: vec![blank.collect()], tooth, edge }
    }

    /// Inside of the material: how far a point is from its border.
    fn depth_mm(near: &[[DVec2; 2]], all: &[Vec<[f64; 2]>], point: DVec2) -> f64 {
        let crossings = all.iter().flat_map(|contour| contour.iter().zip(contour.iter().cycle().skip(1)));
        let inside = crossings
            .filter(|(a, b)| (a[1] > point.y) != (b[1] > point.y))
            .filter(|(a, b)| point.x < a[0] + (point.y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            .count();
        if inside % 2 == 0 {
            return 0.0;
        }
        let to = |[a, b]: &[DVec2; 2]| {
            let share = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-30)).clamp(0.0, 1.0);
            point.distance(a + share * (b - a))
        };
        near.iter().map(to).fold(f64::INFINITY, f64::min)
    }

    /// C Q of a cutter at a pose, for a force K_n h along the normal alone.
    fn pushed(&self, job: &ShapingJob, pose: &Rigid2) -> DVec4 {
        let k = job.material.normal_n_per_mm2;
        let axis = pose.translation_mm;
        let near: Vec<[DVec2; 2]> = self
            .left
            .iter()
            .flat_map(|contour| contour.iter().zip(contour.iter().cycle().skip(1)))
            .map(|(a, b)| [DVec2::from_array(*a), DVec2::from_array(*b)])
            .filter(|[a, _]| a.distance(axis) < job.cutter.tip_radius_mm + 1.0)
            .collect();
        let mut load = DVec4::ZERO;
        for blade in 0..job.cutter.blade_count() {
            let place = pose.after(&job.cutter.tool_from_blade(blade));
            if place.point(job.cutter.edge().center_mm).length() > 45.0 {
                continue;
            }
            for (point, normal, length_mm) in &self.edge {
                let (point, normal) = (place.point(*point), place.direction(*normal));
                if point.length() > 39.0 {
                    continue;
                }
                let force = -k * length_mm * Self::depth_mm(&near, &self.left, point) * normal;
                let out = axis.normalize();
                load += DVec4::new(
                    force.dot(out),
                    force.dot(out.perp()),
                    (point - axis).perp_dot(force),
                    -point.perp_dot(force),
                );
            }
        }
        job.machine.compliance.diagonal() * load
    }

    fn cut(&mut self, job: &ShapingJob, pose: &Rigid2) {
        let teeth: Vec<Vec<[f64; 2]>> = (0..job.cutter.blade_count())
            .map(|blade| pose.after(&job.cutter.tool_from_blade(blade)))
            .filter(|place| place.point(job.cutter.edge().center_mm).length() < 45.0)
            .map(|place| self.tooth.iter().map(|&p| place.point(p).to_array()).collect())
            .collect();
        let left = self.left.overlay(&teeth, OverlayRule::Difference, FillRule::NonZero);
        self.left = left.into_iter().flatten().collect();
    }
}

#[test]
fn polygons_and_small_steps_find_the_same_deflections() {
    let settings = [
        "material.normal_edge_force_n_per_mm=0",
        "operation.finish.strokes_per_revolution=720",
        "operation.finish.infeed.spiral.angle_deg=45",
        "fields.chips.spacing_mm=0.025",
    ];
    let rigid = job(ROUND, &with(&SOFT, &settings));
    let ours = &found(&rigid)[0];
    let mut polygons = Polygons::new(&rigid);
    let (mut largest_um, mut off_um) = (0.0_f64, Vec::new());
    let lengths = DVec4::new(1.0, 1.0, 30.0, 66.0);
    let mut q = DVec4::ZERO;
    for (stroke, ours) in ours.iter().enumerate().take(75) {
        let commanded = rigid.operations[0].strokes.poses(stroke)[0];
        let mut pose = commanded;
        for _ in 0..60 {
            pose = Deflection::of_coordinates(q).displaced(&commanded, DVec2::ZERO);
            let step = 0.5 * (polygons.pushed(&rigid, &pose) - q);
            q += step;
            if (lengths * step).abs().max_element() < 2e-5 {
                break;
            }
        }
        polygons.cut(&rigid, &pose);
        largest_um = largest_um.max(1e3 * (lengths * q).abs().max_element());
        off_um.push(1e3 * (lengths * (q - ours.coordinates())).abs().max_element());
    }
    off_um.sort_by(f64::total_cmp);
    let (median_um, worst_um) = (off_um[off_um.len() / 2], off_um[off_um.len() - 1]);
    println!("up to {largest_um:.2} um; {median_um:.3} um off (median), {worst_um:.3} um (worst)");
    // Where a tooth enters, its chips are a quarter of a millimetre thick; the ledger joins ends of rays across such a
    // chip and has it thinner here and there.
    assert!(largest_um > 15.0 && median_um < 0.01 * largest_um && worst_um < 0.03 * largest_um);
}

//! Return strokes on a round gear against what their geometry says.

use crate::fixtures::paper::*;
use gearcut::cut::Rub;
use gearcut::cut::cpu::Cpu;
use gearcut::gear::PitchCurveShape;
use gearcut::measure::damage::LEAST_DEPTH_MM;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::Shaping;
use gearcut::process::shaping::tool::edge_polygon::{EdgePolygon, Station};
use gearcut::steps::planar::blank_report;
use gearcut::tool::PlanarTool;
use std::collections::BTreeMap;

fn round_job(back_off_mm: f64) -> ShapingJob {
    let mut scene = paper_scene(vec![operation("finish", NORMAL, 0.0, 480)]);
    (scene.gear.pitch_curve, scene.gear.teeth) = (PitchCurveShape::Circle, 24);
    Shaping::of_mut(&mut scene).expect("shaping").machine.back_off_mm = back_off_mm;
    ShapingJob::new(scene).expect("a round gear")
}

fn rubs(job: &ShapingJob) -> Vec<Rub> {
    let cut = job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits"), &|| true).expect("native");
    cut.expect("not stopped").cuts.remove(0).rubs
}

/// A return stroke of one cutter tooth, deepest place.
struct Deepest {
    rub: Rub,
    /// Back-off times the share of the edge's normal along it, at the place of the edge that rubs; and the largest of
    /// these on this tooth inside the blank.
    own_mm: f64,
    most_mm: f64,
    /// The straight, radial base of the cutter tooth: back-off times the sine of its angle from the line of centres.
    base_mm: Option<f64>,
}

fn deepest(job: &ShapingJob) -> Vec<Deepest> {
    let back_off_mm = job.machine.back_off_mm;
    let polygon = EdgePolygon::new(job.cutter.edge(), 0.02);
    let set = &job.operations[0].strokes;
    let mut by_pass: BTreeMap<u32, Rub> = BTreeMap::new();
    for rub in rubs(job) {
        let worst = by_pass.entry(rub.pass).or_insert(rub);
        if rub.depth_mm > worst.depth_mm {
            *worst = rub;
        }
    }
    let of_pass = |rub: Rub| {
        let (stroke, blade) = set.stroke_and_blade(rub.pass);
        let pose = set.poses(stroke)[0];
        let away = pose.translation_mm.normalize();
        let work_from_blade = pose.after(&job.cutter.tool_from_blade(blade));
        let lifted = |station: &Station| back_off_mm * work_from_blade.direction(station.normal).dot(away);
        let place = work_from_blade.inverse().point(rub.place_mm - back_off_mm * away);
        let nearest = |a: &&Station, b: &&Station| {
            a.point_mm.distance_squared(place).total_cmp(&b.point_mm.distance_squared(place))
        };
        let station = polygon.stations.iter().min_by(nearest).expect("an edge");
        let inside = |station: &&Station| work_from_blade.point(station.point_mm).length() < 39.0;
        let radial = work_from_blade.direction(station.point_mm.normalize());
        Deepest {
            rub,
            own_mm: lifted(station),
            most_mm: polygon.stations.iter().filter(inside).map(lifted).fold(f64::NEG_INFINITY, f64::max),
            base_mm: (station.point_mm.length()
                < job.cutter.involute().expect("involute flanks").base_radius_mm - 0.02)
                .then(|| back_off_mm * radial.perp_dot(away).abs()),
        }
    };
    by_pass.into_values().filter(|rub| rub.depth_mm > LEAST_DEPTH_MM).map(of_pass).collect()
}

#[test]
fn return_strokes_enter_the_stock_as_deep_as_the_back_off_presses_the_edge_into_it() {
    // Drawn back by b along the line of centres u, an edge that has just cut moves by b (u . n) along its normal n, out
    // of the tool. In contact with a flank that is -b sin(20 deg): clear. On a cutter tooth that stands beside the line
    // of centres the side that looks away from it is pressed into what the stroke has left; on the radial base of the
    // tooth by b times the sine of its angle.
    for back_off_mm in [0.1, 0.5] {
        let found = deepest(&round_job(back_off_mm));
        let (mut on_base, mut exact) = (0, 0);
        for Deepest { rub, own_mm, most_mm, base_mm } in &found {
            // A ray's length times the cosine is the depth between parallel surfaces; involutes bend a little.
            assert!(rub.depth_mm < 1.02 * most_mm + 1e-6, "{rub:?}: {own_mm} of {most_mm}");
            if let Some(base_mm) = base_mm {
                on_base += 1;
                // The base goes on along the tangent of the involute's first places, 0.0018 rad off the radius.
                assert!((own_mm - base_mm).abs() < 0.0019 * back_off_mm, "{rub:?}: {own_mm} {base_mm}");
                exact += usize::from((rub.depth_mm - own_mm).abs() < 1e-6);
            }
        }
        println!(
            "back-off {back_off_mm}: {} passes rub, {on_base} with their base, {exact} of these to a nanometre",
            found.len()
        );
        assert!(on_base > 50 && 10 * exact > 9 * on_base);
    }
}

#[test]
fn no_edge_enters_deeper_than_it_has_moved_along_its_normal() {
    // On the elliptical gear cutter teeth enter at all angles, and rays run along slivers: length alone would say a
    // millimetre at half a millimetre of back-off.
    let job = ShapingJob::new(paper_scene(vec![operation("finish", NORMAL, 0.0, 1440)])).expect("the paper's gear");
    let found = deepest(&job);
    let exact = found.iter().filter(|d| (d.rub.depth_mm - d.own_mm).abs() < 1e-6).count();
    let largest = found.iter().map(|d| d.rub.depth_mm).fold(0.0, f64::max);
    println!(
        "{} passes rub, {exact} as deep as their edge has moved to a nanometre, at most {largest:.3} mm",
        found.len()
    );
    // The nearest place of the sampled edge stands up to 0.01 mm beside the ray's: its normal is off by as much as the
    // edge bends there.
    assert!(found.len() > 1000 && 4 * exact > found.len() && largest < 0.25);
}

#[test]
fn what_rubs_on_a_round_gear_is_stock() {
    let job = round_job(0.5);
    let cut = job.cut_blank(&Cpu::default(), job.planar().blank_field().expect("fits"), &|| true).expect("native");
    let report = blank_report::measure(&job.planar(), &cut.expect("not stopped"), &[]);
    assert!(report.rubbing.len() > 10 && report.rubbing.iter().all(|rubbing| !rubbing.stays), "{:?}", report.rubbing);
}

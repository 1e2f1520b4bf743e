//! Hobbing against an independent implementation: pitch curves, five and six axes, edge points in the work, marks,
//! target points, engagement.
//!
//! tests/data/hobbing/p*.json hold numbers of a program in another language with solvers of its own; the tolerances
//! stand in the files. S4 is the ellipse of Liu et al. 2013, S2 the third-order gear of Liu et al. 2015. The data stand
//! in the papers' work frame (x_c, y_c, z_c), which is the gear frame turned over: x_c = y, y_c = x, z_c = -z.

use crate::fixtures::expected::{close, number};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::fixtures::oracle_cases::{
    SCHEMES, cycle_speed, data, law, numbers, papers_ellipse, papers_hob, papers_rack,
};
use gearcut::gear::PitchCurve;
use gearcut::gear::PitchCurveShape;
use gearcut::gear::blank::Blank;
use gearcut::process::hobbing::linkage::marks::Marks;
use gearcut::process::hobbing::linkage::{FeedPath, HobbingAxes, HobbingGeometry, HobbingLinkage};
use gearcut::process::hobbing::measure::engagement::Engagement;
use gearcut::process::hobbing::rack_generation::{ProfilePart, RackGeneration};
use gearcut::process::hobbing::scene::model::{EvenMotion, ExtraRotation, LinkageForm};
use gearcut::terms::Side;
use gearcut::tool::SpatialTool;
use glam::{DVec2, DVec3};
use serde_json::Value;

/// Largest value less smallest.
fn range(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
}

/// Axes where the pitch point has the polar angle `theta`.
fn at_polar(linkage: &HobbingLinkage, theta: f64) -> (f64, HobbingAxes<3>) {
    let mut t = linkage.cycle_s() * theta / TAU;
    for _ in 0..60 {
        let polar = linkage.axes::<2>(t).polar_rad;
        t += (theta - polar.value()) / polar.derivative(1);
    }
    (t, linkage.axes(t))
}

#[test]
fn pitch_curves_and_rolling() {
    let file = data("p01_pitch");
    let rel = number(&file["tol_rel"]);
    for case in file["cases"].as_array().unwrap() {
        let order = number(&case["n"]) as u32;
        let a = number(&case["A"]);
        let (e, perimeter) = (number(&case["e"]), number(&case["perimeter"]));
        let shape = PitchCurveShape::Ellipse { order, eccentricity: e, semi_major_axis_mm: Some(a) };
        let curve = PitchCurve::with_accuracy(&shape, perimeter / (35.0 * PI), 35, 1e-12).unwrap();
        close("perimeter", curve.perimeter_mm(), perimeter, rel * perimeter);
        for (i, theta) in numbers(&case["theta"]).into_iter().enumerate() {
            let radius = curve.radius(theta);
            let expect = |name: &str, found: f64| {
                let value = numbers(&case[name])[i];
                close(&format!("{name} at {theta}"), found, value, rel * value.abs().max(1.0));
            };
            expect("r", radius.value());
            expect("dr", radius.derivative(1));
            expect("d2r", radius.derivative(2));
            expect("d3r", radius.derivative(3));
            let frame = curve.frame(theta);
            expect("rho", 1.0 / frame.curvature_per_mm);
            expect("mu", frame.mu_rad);
            expect("phi", theta + frame.mu_rad - 0.5 * PI);
            expect("arc", curve.arc_mm(theta));
        }
        // Spur, hob turning evenly: the axes over the arc.
        let geometry = HobbingGeometry::new(&papers_hob(132.0), 0.0, 1.0);
        let even = law(EvenMotion::ArcLength, ExtraRotation::Work, LinkageForm::Exact);
        let linkage =
            HobbingLinkage::new(Arc::new(curve), geometry, even, 1.0, &FeedPath::steady(1.0, 0.0, 0.0)).unwrap();
        for (i, s) in numbers(&case["roll"]["s"]).into_iter().enumerate() {
            let axes = linkage.axes::<1>(s / geometry.arc_per_hob_rad_mm());
            for (name, found) in [
                ("theta", axes.polar_rad.value()),
                ("phi", axes.work_rad.value()),
                ("X", axes.x_mm.value()),
                ("Y", axes.y_mm.value()),
            ] {
                let value = numbers(&case["roll"][name])[i];
                close(&format!("{name} at arc {s}"), found, value, rel * value.abs().max(1.0));
            }
        }
    }
}

#[test]
fn five_axes_of_the_six_schemes() {
    let file = data("p02_linkage5_s4");
    let (rel, rel_range) = (number(&file["tol_rel"]), number(&file["tol_range_rel"]));
    let beta = number(&file["beta"]);
    let curve = papers_ellipse(1, 0.6, Some(150.0), beta, 33);
    // sigma = +1 is a gear of the hob's hand.
    let geometry = HobbingGeometry::new(&papers_hob(132.0), beta, -1.0);
    let hob_speed = cycle_speed(&curve, &geometry, number(&file["T"]));
    let thetas = numbers(&file["theta"]);
    let steady = |slide: f64| FeedPath::steady(1.5, slide, 0.0);
    for (model, even, extra) in SCHEMES {
        let expected = &file["models"][model];
        let make = |form, slide| {
            HobbingLinkage::new(curve.clone(), geometry, law(even, extra, form), hob_speed, &steady(slide)).unwrap()
        };
        for (variant, form) in [("paper", LinkageForm::AsPrinted), ("exact", LinkageForm::Exact)] {
            let Some(columns) = expected.get(variant) else { continue };
            let linkage = make(form, number(&file["vz"]));
            for (i, &theta) in thetas.iter().enumerate() {
                let axes = at_polar(&linkage, theta).1;
                for (name, found) in [
                    ("w", axes.polar_rad.derivative(1)),
                    ("wc_s", axes.work_rad.derivative(1)),
                    ("wb_s", axes.hob_rad.derivative(1)),
                    ("vx", axes.x_mm.derivative(1)),
                    ("vy", axes.y_mm.derivative(1)),
                ] {
                    let value = numbers(&columns[name])[i];
                    close(&format!("{model} {variant} {name} at {theta}"), found, value, rel * value.abs().max(1.0));
                }
            }
        }
        let still = make(LinkageForm::Exact, 0.0);
        for (i, &theta) in thetas.iter().enumerate() {
            let (t, axes) = at_polar(&still, theta);
            close(&format!("{model} t"), t, numbers(&expected["t_basic"])[i], rel);
            for (name, found) in [
                ("ac", axes.work_rad.derivative(2)),
                ("ab", axes.hob_rad.derivative(2)),
                ("ax", axes.x_mm.derivative(2)),
                ("ay", axes.y_mm.derivative(2)),
            ] {
                let value = numbers(&expected["acc_vz0"][name])[i];
                close(&format!("{model} {name} at {theta}"), found, value, rel * value.abs().max(1.0));
            }
        }
        // Ranges over a cycle on an even grid of time: the peaks are flat, the last digits would not move.
        let samples: Vec<HobbingAxes<3>> =
            (0..60_000).map(|i| still.axes(still.cycle_s() * f64::from(i) / 60_000.0)).collect();
        for (name, order, axis) in RANGES {
            let found = range(samples.iter().map(|a| axis(a, order)));
            let value = number(&expected["ranges_vz0"][name]["range"]);
            close(&format!("{model} range of {name}"), found, value, rel_range * value.abs().max(1.0));
        }
    }
}

/// Column of the data, order of the derivative, axis.
type AxisColumn = (&'static str, usize, fn(&HobbingAxes<3>, usize) -> f64);
const RANGES: [AxisColumn; 8] = [
    ("wb", 1, |a, k| a.hob_rad.derivative(k)),
    ("vx", 1, |a, k| a.x_mm.derivative(k)),
    ("vy", 1, |a, k| a.y_mm.derivative(k)),
    ("wc", 1, |a, k| a.work_rad.derivative(k)),
    ("ac", 2, |a, k| a.work_rad.derivative(k)),
    ("ab", 2, |a, k| a.hob_rad.derivative(k)),
    ("ax", 2, |a, k| a.x_mm.derivative(k)),
    ("ay", 2, |a, k| a.y_mm.derivative(k)),
];

#[test]
fn six_axes_of_the_four_conditions() {
    let file = data("p03_linkage6_s2");
    let rel = number(&file["tol_rel"]);
    for block in ["vd_half", "vd_five"] {
        let block = &file[block];
        let beta = number(&block["beta"]);
        let curve = papers_ellipse(3, 0.1, Some(140.0), beta, 35);
        for (condition, expected) in block["conditions"].as_object().unwrap() {
            let geometry = HobbingGeometry::new(&papers_hob(132.0), beta, number(&expected["gear_hand"]));
            close("gamma", geometry.head_angle_rad, number(&expected["gamma"]), rel);
            let kappa_vd = number(&expected["kappa"]) * number(&block["vd"]);
            let slide = number(&block["vz_resultant"]) + kappa_vd * geometry.head_angle_rad.sin();
            close(&format!("{condition} v_z"), slide, number(&expected["vz"]), rel);
            for (variant, form) in [("paper", LinkageForm::AsPrinted), ("exact", LinkageForm::Exact)] {
                let law = law(EvenMotion::ArcLength, ExtraRotation::Work, form);
                let path = FeedPath::steady(300.0, slide, -kappa_vd);
                let linkage = HobbingLinkage::new(curve.clone(), geometry, law, number(&block["wb"]), &path).unwrap();
                if form == LinkageForm::Exact {
                    let rate = linkage.axes::<2>(7.0).arc_mm.derivative(1);
                    close("arc rate", rate, number(&expected["arc_rate_exact"]), rel * rate);
                }
                for (i, theta) in numbers(&block["theta"]).into_iter().enumerate() {
                    let axes = at_polar(&linkage, theta).1;
                    for (name, found) in [
                        ("w", axes.polar_rad.derivative(1)),
                        ("wc_s", axes.work_rad.derivative(1)),
                        ("vx", axes.x_mm.derivative(1)),
                        ("vy", axes.y_mm.derivative(1)),
                    ] {
                        let value = numbers(&expected[variant][name])[i];
                        let what = format!("{condition} {variant} {name} at {theta}");
                        close(&what, found, value, rel * value.abs().max(1.0));
                    }
                }
            }
        }
    }
}

#[test]
fn edges_stand_in_the_work_where_they_should() {
    let file = data("p08_events_s2");
    let tolerance = number(&file["tol_mm"]);
    let hob = papers_hob(132.0);
    for case in ["axial", "diagonal_VL"] {
        let case = &file[case];
        let setup = &case["setup"];
        let curve = papers_ellipse(3, 0.1, None, number(&setup["beta"]), 35);
        close("A", curve.size_mm(), number(&setup["A_scaled"]), 1e-9);
        close("R_p", hob.pitch_radius_mm, number(&setup["Rp"]), 1e-12);
        close("R_a", hob.tip_radius_mm, number(&setup["Ra"]), 1e-12);
        close("lead", hob.lead_mm, number(&setup["lead"]), 1e-12);
        let geometry = HobbingGeometry::new(&hob, number(&setup["beta"]), number(&setup["h"]));
        let path = FeedPath::steady(1.0, number(&setup["vz"]), number(&setup["udot"]));
        let exact = law(EvenMotion::ArcLength, ExtraRotation::Work, LinkageForm::Exact);
        let linkage = HobbingLinkage::new(curve, geometry, exact, number(&setup["wb"]), &path).unwrap();
        let target = RackGeneration { curve: linkage.curve().clone(), rack: papers_rack(number(&setup["beta"]), -1.0) };
        let side = if number(&case["flank"]) > 0.0 { Side::Left } else { Side::Right };
        let marks = Marks { linkage: &linkage, target: &target, hob: &hob, side };
        for event in case["events"].as_array().unwrap() {
            let gash = number(&event["g"]);
            let mark = marks.mark(gash as i64, number(&case["space"]) as i64);
            close("sigma of the mark", mark.roll_mm, number(&event["mark"]["sigma"]), tolerance);
            close("z of the mark", -mark.z_mm, number(&event["mark"]["z"]), tolerance);
            close("time of the mark", mark.time_s, number(&event["mark"]["t"]), tolerance);
            let t = linkage.time_at_hob_angle(TAU * gash / f64::from(hob.gashes));
            close("t", t, number(&event["t"]), 1e-13);
            let axes = linkage.axes::<1>(t);
            for (name, found) in [
                ("s", axes.arc_mm),
                ("phi", axes.work_rad),
                ("X", axes.x_mm),
                ("Y", axes.y_mm),
                ("shift", axes.shift_mm),
                ("slide_z", axes.slide_mm),
            ] {
                close(name, found.value(), number(&event[name]), tolerance);
            }
            let axial = number(&event["thread_axial"]);
            let index = hob.teeth.iter().position(|tooth| (tooth.axial_mm - axial).abs() < 1e-9).expect("on the hob");
            let turns = (hob.teeth[index].passage as f64 - gash) / f64::from(hob.gashes);
            close("whole turns", turns, turns.round(), 1e-12);
            let work_from_blade = linkage.work_from_tool(t).after(&hob.tool_from_blade(index as u32));
            for (side, sign) in [("left", 1.0), ("right", -1.0)] {
                let expected = event["edge_points_workpiece"][side].as_array().unwrap();
                for (&radius, expected) in numbers(&event["edge_radii"]).iter().zip(expected) {
                    let found = work_from_blade.point(DVec3::new(radius, sign * hob.half_thickness_mm(radius), 0.0));
                    let expected = numbers(expected);
                    let expected = DVec3::new(expected[1], expected[0], -expected[2]);
                    assert!(found.distance(expected) < tolerance, "{side} {radius}: {found} not {expected}");
                }
            }
        }
    }
}

#[test]
fn as_printed_parts_work_and_carriage() {
    let file = data("p05_literal_error");
    let rel = number(&file["tol_rel"]);
    for case in file["cases"].as_array().unwrap() {
        let (curve, beta) = if case["case"] == "S2" {
            let beta = (10.0 + 34.0 / 60.0_f64).to_radians();
            (papers_ellipse(3, 0.1, Some(140.0), beta, 35), beta)
        } else {
            let beta = 12.899_f64.to_radians();
            (papers_ellipse(1, 0.6, Some(150.0), beta, 33), beta)
        };
        let geometry = HobbingGeometry::new(&papers_hob(132.0), beta, -1.0);
        let (model, even, extra) = SCHEMES.into_iter().find(|s| s.0 == case["model"]).unwrap();
        let (cycle_s, cycles) = (1.5, number(&case["cycles"]));
        let path = FeedPath::steady(cycle_s * cycles, -number(&case["feed"]) / cycle_s, 0.0);
        let printed = law(even, extra, LinkageForm::AsPrinted);
        let hob_speed = cycle_speed(&curve, &geometry, cycle_s);
        let linkage = HobbingLinkage::new(curve.clone(), geometry, printed, hob_speed, &path).unwrap();
        // What the work has turned beyond the rolling, and how far P then lies from where the exact rolling has it, in
        // the directions of the machine.
        let error = |t: f64| {
            let axes = linkage.axes::<1>(t);
            let theta = axes.polar_rad.value();
            let here = curve.frame(theta);
            let turned = axes.work_rad.value() - (theta + here.mu_rad - 0.5 * PI);
            let turn = DVec2::from_angle(turned);
            let arc = curve.arc_mm(theta) + geometry.arc_per_slide() * axes.slide_mm.value();
            let off = turn.rotate(here.point_mm) - curve.frame(curve.phi_at_arc(arc)).point_mm;
            [off.dot(turn.rotate(here.tangent)).abs(), off.dot(turn.rotate(here.normal)).abs(), turned]
        };
        // The file's maxima stand on a grid of 720 steps over the last cycle.
        let grid: Vec<[f64; 3]> = (0..=720).map(|i| error(cycle_s * (cycles - 1.0 + f64::from(i) / 720.0))).collect();
        for (column, name) in [(0, "max_tangential"), (1, "max_radial")] {
            let (found, expected) = (grid.iter().map(|e| e[column]).fold(0.0, f64::max), number(&case[name]));
            close(&format!("{model} {name}"), found, expected, rel * expected);
        }
        close(&format!("{model} turned"), grid[720][2], number(&case["eps_end"]), rel);
    }
}

#[test]
fn target_profiles_at_350_points() {
    let file = data("p07_points350_s2");
    let tolerance = number(&file["tol_mm"]);
    let beta = (10.0 + 34.0 / 60.0_f64).to_radians();
    let curve = papers_ellipse(3, 0.1, None, beta, 35);
    close("A", curve.size_mm(), number(&file["A_scaled"]), 1e-9);
    let blank = Blank::new(curve.clone(), 8.0).unwrap();
    let target = RackGeneration { curve, rack: papers_rack(beta, -1.0) };
    let (mut worst, mut fillets) = (0.0_f64, 0);
    for row in file["rows"].as_array().unwrap() {
        let [space, flank, height, foot, x_c, y_c, kind] = numbers(row)[..] else { panic!("seven columns") };
        let side = if flank > 0.0 { Side::Left } else { Side::Right };
        let found = target.crossing(&blank, space as i64, side, height, 0.0).expect("a crossing");
        assert_eq!(found.part == ProfilePart::Fillet, kind == 1.0, "space {space} {side:?} at {height}");
        worst = worst.max(found.point_mm.distance(DVec2::new(y_c, x_c))).max((found.foot_arc_mm - foot).abs());
        fillets += usize::from(kind == 1.0);
    }
    println!("350 points: worst {:.2e} um, {fillets} on fillets", 1e3 * worst);
    assert!(worst < tolerance, "{worst:e} mm");
    assert_eq!(fillets, 20);
}

#[test]
fn nominal_points_of_the_patches() {
    let beta = (10.0 + 34.0 / 60.0_f64).to_radians();
    let target = RackGeneration { curve: papers_ellipse(3, 0.1, None, beta, 35), rack: papers_rack(beta, -1.0) };
    // The first corner and the middle of the flank of space 3 that both patches of S2 stand on; z_c = -z.
    for (roll, z_c, point, normal) in [
        (
            -10.0,
            -3.0,
            [63.77717736546778, 130.46685569922124],
            [0.9363918619989371, -0.3057384220460156, -0.17232033561647897],
        ),
        (
            0.05025125628140614,
            0.015075376884421843,
            [62.84580450156031, 126.4578963327214],
            [0.9077586712659427, -0.38246554965710866, -0.17232033561647897],
        ),
    ] {
        let contact = target.flank_contact(3, Side::Left, roll, -z_c);
        let expected = DVec3::new(point[1], point[0], -z_c);
        assert!(contact.point_mm.distance(expected) < 1e-9, "{} not {expected}", contact.point_mm);
        let expected = DVec3::new(normal[1], normal[0], -normal[2]);
        assert!(contact.normal.distance(expected) < 1e-12, "{} not {expected}", contact.normal);
    }
}

#[test]
fn lattices_of_marks() {
    let file = data("p06_marks_s2");
    let rel = number(&file["tol_rel"]);
    let beta = (10.0 + 34.0 / 60.0_f64).to_radians();
    let hob = papers_hob(132.0);
    for case in file["cases"].as_array().unwrap() {
        let condition = case["condition"].as_str().unwrap();
        let hand = if condition.ends_with('R') { 1.0 } else { -1.0 };
        let kappa = if condition.starts_with('U') { 1.0 } else { -1.0 };
        let geometry = HobbingGeometry::new(&hob, beta, hand);
        let shift = -kappa * number(&case["vd"]);
        let slide = -50.0 / 300.0 - shift * geometry.head_angle_rad.sin();
        let exact = law(EvenMotion::ArcLength, ExtraRotation::Work, LinkageForm::Exact);
        let curve = papers_ellipse(3, 0.1, None, beta, 35);
        let linkage =
            HobbingLinkage::new(curve.clone(), geometry, exact, 14.661, &FeedPath::steady(60.0, slide, shift)).unwrap();
        let target = RackGeneration { curve, rack: papers_rack(beta, hand) };
        let marks = Marks { linkage: &linkage, target: &target, hob: &hob, side: Side::Left };
        let (gash, space, mark) = marks.nearest(0, 35, 0.0);
        assert_eq!(space, 0);
        // Without shift two gashes are equally near the pitch line, and the file takes either.
        let v1_file = number(&case["v1"][0]);
        let off = |gash: &i64| (marks.to_next_gash(*gash, 0).x - v1_file).abs();
        let tied = |gash: &i64| (marks.mark(*gash, 0).roll_mm.abs() - mark.roll_mm.abs()).abs() < 0.01;
        let near = (gash - 1..=gash + 1).filter(tied);
        let gash = near.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        // The data count z the other way: steps and angles change the sign of z with it.
        let theirs = |step: DVec2| DVec2::new(step.x, -step.y);
        let expect = |name: &str, found: DVec2, expected: &Value| {
            let expected = numbers(expected);
            let scale = found.length();
            close(&format!("{condition} {name} roll"), found.x, expected[0], rel * scale);
            close(&format!("{condition} {name} z"), found.y, expected[1], rel * scale);
        };
        let (v1, v2) = (marks.to_next_gash(gash, 0), marks.to_same_tooth(gash, 0, 35));
        assert!(mark.roll_mm.abs() < 0.6 * v1.x);
        expect("v1", theirs(v1), &case["v1"]);
        expect("v2", theirs(v2), &case["v2"]);
        // On the pitch line a roll takes sin(alpha_t) of its length along the profile.
        let length_per_roll = target.rack.pressure_angle_rad.sin();
        let same_tooth = -marks.on_flank(v2, length_per_roll).to_trace_rad().to_degrees();
        close("same tooth", same_tooth, number(&case["same_tooth_inclination_deg"]), 1e-5);
        let reduced = marks.reduced([v1, v2], length_per_roll);
        for (step, expected) in reduced.into_iter().zip(case["reduced"].as_array().unwrap()) {
            close("length", step.length_mm(), number(&expected["length"]), rel * step.length_mm());
            close("angle", -step.to_trace_rad(), number(&expected["angle"]), 1e-6);
        }
    }
}

#[test]
fn generating_marks_are_spaced_alike_by_every_law() {
    let file = data("p04_spacing");
    let rel = number(&file["tol_rel"]);
    let s4 = &file["s4"];
    let beta = number(&s4["beta"]);
    let curve = papers_ellipse(1, 0.6, Some(150.0), beta, 33);
    let geometry = HobbingGeometry::new(&papers_hob(132.0), beta, -1.0);
    let per_gash = TAU / number(&s4["Zb"]);
    close("arc per gash", geometry.arc_per_hob_rad_mm() * per_gash, number(&s4["gash_arc"]), rel);
    let target = RackGeneration { curve: curve.clone(), rack: papers_rack(beta, -1.0) };
    for (i, theta) in numbers(&s4["theta"]).into_iter().enumerate() {
        let rho = 1.0 / curve.frame(theta).curvature_per_mm;
        close("rho", rho, numbers(&s4["rho"])[i], rel * rho);
        // Profile length per gash: at the pitch point, and 5 mm above it on the line of action.
        let spacing =
            |c: f64| (target.rack.pressure_angle_rad.sin() + c / rho) * geometry.arc_per_hob_rad_mm() * per_gash;
        close("spacing", spacing(0.0), numbers(&s4["profile_spacing_at_pitch"])[i], rel);
        close("spacing", spacing(5.0), numbers(&s4["profile_spacing_c_plus5"])[i], rel);
        // What differs between the laws is the arc per time: marks of a constant period, such as a servo's, not those
        // of gashes.
        for model in ["I", "III", "V"] {
            let (_, even, extra) = SCHEMES.into_iter().find(|s| s.0 == model).unwrap();
            let law = law(even, extra, LinkageForm::Exact);
            let hob_speed = cycle_speed(&curve, &geometry, number(&s4["T"]));
            let path = FeedPath::steady(1.5, 0.0, 0.0);
            let linkage = HobbingLinkage::new(curve.clone(), geometry, law, hob_speed, &path).unwrap();
            let axes = at_polar(&linkage, theta).1;
            let expected = numbers(&s4["arc_rate"][model])[i];
            close(model, axes.arc_mm.derivative(1), expected, rel * expected);
            // Between two gashes the arc is the same wherever and however it is rolled.
            let gash = (axes.hob_rad.value() / per_gash).round();
            let arc = |g: f64| linkage.axes::<1>(linkage.time_at_hob_angle(g * per_gash)).arc_mm.value();
            close("arc between gashes", arc(gash + 1.0) - arc(gash), number(&s4["gash_arc"]), 1e-9);
        }
    }
}

mod slow {
    use super::*;

    #[test]
    fn teeth_share_the_work() {
        let file = data("p14_engagement");
        let beta = (10.0 + 34.0 / 60.0_f64).to_radians();
        // The file's grid for one space; coarser for all 35 of the third-order gear.
        for (name, order, eccentricity, spaces, spacing) in
            [("circle_r142", 1, 0.0, vec![0], 0.2), ("s2_three_lobe", 3, 0.1, (0..35).collect(), 1.0)]
        {
            let expected = &file[name];
            let curve = papers_ellipse(order, eccentricity, None, beta, 35);
            let long_hob = papers_hob(240.0);
            let geometry = HobbingGeometry::new(&long_hob, beta, -1.0);
            let exact = law(EvenMotion::ArcLength, ExtraRotation::Work, LinkageForm::Exact);
            let feed = FeedPath { start_slide_mm: 75.0, ..FeedPath::steady(900.0, -2.5 / 15.0, 0.0) };
            let linkage = HobbingLinkage::new(curve.clone(), geometry, exact, 14.661, &feed).unwrap();
            let target = RackGeneration { curve, rack: papers_rack(beta, -1.0) };
            let mut all = Engagement::default();
            for space in &spaces {
                let grid = [10.0, 8.0, spacing];
                all.add(&Engagement::of_space(&linkage, &target, &long_hob, *space, 0.0, grid).expect("moments"));
            }
            let area = all.total_mm2() / spaces.len() as f64;
            let wanted = number(&expected["area_per_space"]);
            let mut worst = 0.0_f64;
            for (j, share) in numbers(&expected["j"]).into_iter().zip(numbers(&expected["share"])) {
                worst = worst.max((all.share(j as i64) - share).abs());
            }
            println!("{name}: area {area:.2} for {wanted:.2} mm2, shares within {worst:.4}, peak {:?}", all.peak());
            assert!((area / wanted - 1.0).abs() < number(&file["tol_area_rel"]), "{name}: {area} mm2");
            assert!(worst < number(&file["tol_share_abs"]), "{name}: {worst}");
        }
    }
}

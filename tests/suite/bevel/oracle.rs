//! Bevel gears against an independent implementation: matrices, the paper's tables, the blank, points of the flank.

use super::cases::*;
use gearcut::bevel::blank::{MatingCones, pitch_angle_rad};
use gearcut::bevel::cradle::{CradleSettings, Roll, Tilt};
use gearcut::bevel::envelope::{Envelope, OnFlank};
use gearcut::bevel::face_mill::{BladeKind, CuttingSurface};
use gearcut::bevel::five_axis::{FiveAxisMachine, SixAxes};
use gearcut::bevel::flank::BevelFlank;
use gearcut::bevel::inferred::InferredCutter;
use gearcut::frame::Rigid3;
use gearcut::math::least_squares::WindowFit;
use glam::{DMat3, DVec3};

/// Largest entry of the difference of two poses.
fn apart(a: &Rigid3, b: &Rigid3) -> f64 {
    let turn = (a.rotation - b.rotation).to_cols_array();
    let shift = (a.translation_mm - b.translation_mm).to_array();
    turn.into_iter().chain(shift).map(f64::abs).fold(0.0, f64::max)
}

#[test]
fn matrices_and_axes() {
    let file = data("b01_matrices");
    let (matrix, axes_mm) = (number(&file["tol"], "matrix"), number(&file["tol"], "axes_mm"));
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 12);
    for case in cases {
        let of = |key: &str| number(&case["input"], key);
        let settings = CradleSettings {
            radial_setting_mm: of("Sr"),
            cradle_angle_rad: 0.0,
            blank_offset_mm: of("E_m"),
            cross_shift_mm: of("X_B"),
            sliding_base_mm: 0.0,
            center_to_back_mm: of("X_p"),
            root_angle_rad: of("gamma_m"),
            tilt: Tilt::default(),
            roll: Roll { ratio: 1.0, ..Roll::default() },
        };
        let pose = settings.work_from_tool_at(of("q"), of("phi_G"));
        for row in 0..3 {
            let wanted = numbers(&case["M_pt"][row]);
            for (found, wanted) in pose.rotation.row(row).to_array().into_iter().zip(&wanted) {
                close("L_pt", found, *wanted, matrix);
            }
            close("a_i4", pose.translation_mm[row], wanted[3], axes_mm);
            close("O_t O_p", -pose.translation_mm[row], numbers(&case["OtOp_p"])[row], axes_mm);
        }
        // The axes of the pose, and the paper's closed form of them.
        let machine = FiveAxisMachine { mounting_mm: of("x_e") };
        let axes = machine.axes_of(&pose).expect("axes");
        let wanted = |key: &str| number(&case["axes"], key);
        let found =
            [axes.slides_mm.x, axes.slides_mm.y, axes.slides_mm.z, axes.work_rad, axes.swing_rad, axes.head_rad];
        for (axis, (key, found)) in ["X", "Y", "Z", "A", "B", "C"].into_iter().zip(found).enumerate() {
            close(key, found, wanted(key), if axis < 3 { axes_mm } else { matrix });
        }
        // Table 2's machine turns the work by R_a q; here the angle is given.
        let closed = SixAxes { work_rad: of("phi_G"), ..machine.axes_of_cradle(&settings, of("q")) };
        assert!(closed.slides_mm.distance(axes.slides_mm) < axes_mm);
        assert!(apart(&machine.work_from_tool(&closed), &pose) < axes_mm);
        // Alive: an axis that is off by a nanometre or a nanoradian is seen.
        for wrong in [
            SixAxes { slides_mm: axes.slides_mm + 1e-6 * DVec3::Z, ..axes },
            SixAxes { swing_rad: axes.swing_rad + 1e-9, ..axes },
        ] {
            assert!(apart(&machine.work_from_tool(&wrong), &pose) > 2.0 * matrix);
        }
    }
}

/// All rows of Table 3; the file has the fifth row's Y without its stray digit, and the work's angles that follow from
/// the other columns.
#[test]
fn positions_of_table_3() {
    let file = data("b02_table3");
    let settings = settings(&file);
    let machine = FiveAxisMachine { mounting_mm: number(&file["settings"], "xe") };
    let (axes_mm, table_mm) = (number(&file["tol"], "axes_mm"), number(&file["tol"], "table_mm"));
    let rows = file["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let axes = machine.axes_of_cradle(&settings, number(row, "q_deg").to_radians());
        let printed = numbers(&row["printed"]);
        for (place, key) in ["X", "Y", "Z"].into_iter().enumerate() {
            close(key, axes.slides_mm[place], number(row, key), axes_mm);
            close(key, axes.slides_mm[place], printed[place], table_mm);
        }
        close("A", axes.work_rad.to_degrees(), number(row, "A_deg"), 1e-10);
        close("B", axes.swing_rad.to_degrees(), printed[4], 1e-10);
        // The printed work angles do not belong to the other columns.
        let off_deg = (printed[3] - axes.work_rad.to_degrees()).abs();
        close("error of A", off_deg, number(row, "A_printed_error").abs(), 1e-9);
        assert!(off_deg > 0.05);
    }
}

#[test]
fn polynomials_of_table_4_and_their_errors() {
    let file = data("b03_table4");
    let settings = settings(&data("b02_table3"));
    let machine = FiveAxisMachine { mounting_mm: number(&data("b02_table3")["settings"], "xe") };
    let (start, rate) = (file["A"][0].as_f64().unwrap(), file["A"][1].as_f64().unwrap());
    let slides = |time_s: f64| {
        let cradle_rad = (start + rate * time_s).to_radians() / settings.roll.ratio;
        machine.axes_of_cradle(&settings, cradle_rad).slides_mm
    };
    let relative = number(&file["tol"], "poly_rel");
    for (place, key) in ["X", "Y", "Z"].into_iter().enumerate() {
        let fit = WindowFit::new(|time_s| slides(time_s)[place], [0.0, 30.0], 4, 361).expect("a fit");
        for (found, wanted) in fit.in_place().into_iter().zip(numbers(&file["coeffs"][key])) {
            close(key, found, wanted, relative * wanted.abs() + 1e-12);
        }
        for (found, printed) in fit.in_place().into_iter().zip(numbers(&file["printed"][key])) {
            close("as printed", found, printed, 6e-5);
        }
        if place == 2 {
            continue;
        }
        // What the printed polynomial is off by where the table's rows stand.
        let off = (0..=866).map(|i| 6.0 + 0.01 * f64::from(i)).map(|t| (fit.at(t) - slides(t)[place]).abs());
        let worst_mm = off.fold(0.0, f64::max);
        close("error", worst_mm, number(&file["max_error_of_this_polynomial_in_6_14p67_s"], key), 0.01);
        for (order, wanted) in file["window_fits"].as_object().unwrap() {
            let window = [6.0, 14.0 + 2.0 / 3.0];
            let fit = WindowFit::new(|t| slides(t)[place], window, order.parse().unwrap(), 2001).expect("a fit");
            close(order, fit.largest_error, number(&wanted[key], "max_err"), 1e-11);
            for (found, wanted) in fit.in_tau.iter().zip(numbers(&wanted[key]["coeffs_in_tau"])) {
                // Rounding of 100 mm, 1.4e-14, is made larger by the fit of order 8, a few hundred times.
                close(key, *found, wanted, relative * wanted.abs() + 1e-11);
            }
        }
    }
}

#[test]
fn the_blank_and_what_the_settings_say_of_the_cutter() {
    let file = data("b04_blank");
    let (blank, settings) = (blank(&file), settings(&file));
    let mm = number(&file["tol"], "mm");
    close("mean cone distance", blank.mean_cone_distance_mm(), number(&file, "mean_cone_distance"), mm);
    close("module", blank.outer_module_mm(), number(&file, "outer_module_gear"), mm);
    // How far the line of the roots passes the pitch apex, towards the back.
    let (sin, cos) = blank.dedendum_angle_rad().sin_cos();
    let root_line_mm = blank.outer_dedendum_mm * cos - blank.outer_cone_distance_mm * sin;
    close("root line", root_line_mm, number(&file, "root_plane_offset_from_apex"), mm);
    let inferred = InferredCutter::new(&settings, &blank);
    close("radius", inferred.radius_mm, number(&file, "rc_inferred"), mm);
    close("spiral angle", inferred.spiral_angle_rad.to_degrees(), number(&file, "spiral_inferred_deg"), mm);
    close("ratio of roll", inferred.roll_ratio, number(&file, "Ra_predicted"), mm);
    // Angles of the table are rounded to 1/60 deg, and so fit 19 to 62 teeth at 95 deg.
    let mate = MatingCones { teeth: 19, shaft_angle_rad: 95_f64.to_radians() };
    assert!(blank.contradictions(Some(mate)).is_empty());
    let pinion_deg = pitch_angle_rad(19, 62, mate.shaft_angle_rad).to_degrees();
    close("pinion", pinion_deg, number(&file["settings"], "gamma1"), 0.003);
}

/// With an offset, radius and spiral angle are those of the head's circle through the mean point, and with the ratio of
/// roll the tool moves along the tooth there; of both hands.
#[test]
fn the_ratio_of_roll_lets_the_mean_point_slide_along_the_tooth() {
    let file = data("b04_blank");
    let blank = blank(&file);
    let (spiral_rad, cutter_mm) = (35_f64.to_radians(), 95.25);
    let [distance_mm, below_rad] = [blank.mean_cone_distance_mm(), blank.dedendum_angle_rad()];
    for (hand, offset_mm) in [(1.0, 0.0), (1.0, 5.0), (1.0, -8.0), (-1.0, 5.0)] {
        // In axes of the machine about the work's apex: the mean point on the pitch cone, the head in the plane of the
        // tips.
        let mean_mm = distance_mm * DVec3::new(below_rad.cos(), 0.0, -below_rad.sin());
        let head_mm = mean_mm.with_z(0.0) + cutter_mm * DVec3::new(-spiral_rad.sin(), hand * spiral_rad.cos(), 0.0);
        let from_cradle_mm = head_mm - offset_mm * DVec3::Y;
        let mut settings = CradleSettings {
            radial_setting_mm: from_cradle_mm.length(),
            cradle_angle_rad: from_cradle_mm.y.atan2(from_cradle_mm.x),
            blank_offset_mm: offset_mm,
            cross_shift_mm: 0.0,
            ..settings(&file)
        };
        let inferred = InferredCutter::new(&settings, &blank);
        close("radius", inferred.radius_mm, cutter_mm, 1e-12);
        close("spiral angle", inferred.spiral_angle_rad, spiral_rad, 1e-12);
        settings.roll.ratio = inferred.roll_ratio;
        let q = settings.cradle_angle_rad;
        let motion = settings.motion(q);
        let in_tool =
            DMat3::from_rotation_z(-q) * (mean_mm - offset_mm * DVec3::Y) - settings.radial_setting_mm * DVec3::X;
        let velocity = DMat3::from_rotation_z(q)
            * motion.pose.rotation.transpose()
            * motion.velocity_at(motion.pose.point(in_tool));
        let tooth = DVec3::new(spiral_rad.cos(), hand * spiral_rad.sin(), 0.0);
        let across = velocity - velocity.dot(tooth) * tooth;
        assert!(across.length() < 1e-9, "hand {hand}, offset {offset_mm} mm: {across} mm/rad");
        let slides = velocity.dot(tooth).abs();
        close("sliding", slides, offset_mm.abs() / spiral_rad.cos(), 1e-9);
    }
}

#[test]
fn points_and_normals_of_the_flank() {
    let file = data("b05_flank");
    let flank_mm = number(&file["tol"], "flank_mm");
    let blank = blank(&file);
    let machine = FiveAxisMachine { mounting_mm: number(&file["settings"], "xe") };
    for case in ["as_printed", "depth_corrected"] {
        let settings = CradleSettings { sliding_base_mm: number(&file[case], "XBz"), ..settings(&file) };
        for kind in BladeKind::BOTH {
            let side = &file[case]["sides"][format!("{}_blade", kind.name())];
            let envelope = Envelope { settings, surface: surface(kind) };
            let mut worst_mm = 0.0_f64;
            let points: Vec<_> =
                side["points"].as_array().unwrap().iter().flat_map(|r| r.as_array().unwrap()).collect();
            assert_eq!(points.len(), 45);
            for point in points {
                let distance_mm = number(point, "cone_distance");
                let found = envelope
                    .find(&blank, distance_mm, OnFlank::Height(number(point, "height")), envelope.guess(distance_mm))
                    .expect("a point of the flank");
                let wanted = DVec3::from_slice(&numbers(&point["P"]));
                worst_mm = worst_mm.max(found.point_mm.distance(wanted));
                let normal = DVec3::from_slice(&numbers(&point["n"]));
                // The file's normals point into the material.
                assert!((found.normal + normal).length() < 1e-9, "{} not {normal}", -found.normal);
                close("theta", found.head_rad, number(point, "theta"), 1e-9);
                close("A", settings.work_angle(found.cradle_rad)[0], number(point, "A"), 1e-9);
                close("u", found.edge_mm, number(point, "u"), flank_mm);
                // The six axes put the same point of the cutter there.
                let axes = machine.axes_of_cradle(&settings, found.cradle_rad);
                let in_tool = envelope.surface.point_mm(found.head_rad, found.edge_mm);
                assert!(machine.work_from_tool(&axes).point(in_tool).distance(wanted) < flank_mm);
                // A neighbour of the moment generates another point.
                let beside = envelope.at(found.head_rad, found.cradle_rad + 1e-6).point_mm;
                assert!(beside.distance(wanted) > 10.0 * flank_mm);
            }
            println!("{case}, {}: {worst_mm:e} mm", kind.name());
            assert!(worst_mm < flank_mm, "{case}: {worst_mm:e} mm");
            let flank = BevelFlank::new(envelope, blank).expect("a flank");
            let row = flank.row(0.0).expect("a row");
            let spiral_deg = row.spiral_angle_rad().expect("a point").to_degrees();
            close("spiral angle", spiral_deg, number(side, "spiral_angle_mean_deg"), 1e-4);
        }
    }
}

/// The way back from positions of the six axes to the settings that they stand for.
#[test]
fn settings_come_back_from_axes() {
    let settings = CradleSettings {
        blank_offset_mm: 8.0,
        sliding_base_mm: 0.7,
        center_to_back_mm: -1.2,
        roll: Roll { ratio: 1.0232, second_order_per_rad: 0.012, third_order_per_rad2: -0.04, ..Roll::default() },
        ..settings(&data("b04_blank"))
    };
    let machine = FiveAxisMachine { mounting_mm: 37.05 };
    let roll: Vec<SixAxes> = (0..40).map(|i| machine.axes_of_cradle(&settings, 0.7 + 0.01 * f64::from(i))).collect();
    let (found, off_mm) = machine.cradle_of(&roll, settings.cradle_angle_rad, 0.7, settings.tilt).expect("settings");
    assert!(off_mm < 1e-11, "{off_mm:e} mm");
    for (found, wanted) in [
        (found.radial_setting_mm, settings.radial_setting_mm),
        (found.blank_offset_mm, settings.blank_offset_mm),
        (found.cross_shift_mm, settings.cross_shift_mm),
        (found.center_to_back_mm, settings.center_to_back_mm),
        (found.root_angle_rad, settings.root_angle_rad),
        (found.roll.ratio, settings.roll.ratio),
        (found.roll.second_order_per_rad, settings.roll.second_order_per_rad),
        (found.roll.third_order_per_rad2, settings.roll.third_order_per_rad2),
    ] {
        close("setting", found, wanted, 1e-9);
    }
    // A path that no cradle machine makes is told by its distance.
    let bent = roll
        .iter()
        .enumerate()
        .map(|(i, axes)| SixAxes { slides_mm: axes.slides_mm + 1e-3 * (0.3 * i as f64).sin() * DVec3::Y, ..*axes });
    let (_, off_mm) =
        machine.cradle_of(&bent.collect::<Vec<_>>(), settings.cradle_angle_rad, 0.7, settings.tilt).expect("settings");
    assert!(off_mm > 1e-4, "{off_mm:e} mm");
    assert!(machine.cradle_of(&roll[..1], 0.9, 0.7, settings.tilt).is_err());
}

/// Point of the fillet that belongs to angles about the head's axis and of the cradle, work frame, and its lean: the
/// blade angle where it joins the flank, a right angle where it joins the bottom. All normals
/// of the round go through its middle c, so that its velocity alone counts: the lean follows from n . (v + w x c) = 0.
fn fillet_at(envelope: &Envelope, head_rad: f64, cradle_rad: f64) -> (DVec3, f64) {
    let motion = envelope.settings.motion(cradle_rad);
    let center_mm = envelope.surface.corner_center_mm(head_rad);
    let velocity = motion.pose.rotation.transpose() * motion.velocity_at(motion.pose.point(center_mm));
    let away = velocity.dot(DVec3::new(head_rad.cos(), head_rad.sin(), 0.0));
    // -s cos(lean) away - sin(lean) v_z = 0.
    let mut lean_rad = (-envelope.surface.kind.sign() * away).atan2(velocity.z);
    if lean_rad < 0.0 {
        lean_rad += std::f64::consts::PI;
    }
    let normal = envelope.surface.normal_of_corner(head_rad, lean_rad);
    (motion.pose.point(center_mm - envelope.surface.corner_radius_mm * normal), lean_rad)
}

/// Points of the fillet are the torus's at their moment, and moments beside it leave them in the material that stays:
/// the torus touches its envelope from inside.
#[test]
fn the_fillet_is_touched_by_the_round() {
    let file = data("b05_flank");
    let settings = settings(&file);
    for kind in BladeKind::BOTH {
        let surface = CuttingSurface { corner_radius_mm: 0.5, ..surface(kind) };
        let envelope = Envelope { settings, surface };
        let [head_rad, cradle_rad] = envelope.guess(blank(&file).mean_cone_distance_mm());
        // Distance of the point from the torus at another moment, less the radius of its round.
        let beyond_mm = |point_mm: DVec3, cradle_rad: f64| {
            let in_tool = settings.work_from_tool(cradle_rad).inverse().point(point_mm);
            let center_mm = surface.corner_center_mm(in_tool.y.atan2(in_tool.x));
            in_tool.distance(center_mm) - surface.corner_radius_mm
        };
        let mut leans = 0;
        for i in 0..200 {
            let cradle_rad = cradle_rad + 0.002 * f64::from(i - 100);
            let (point_mm, lean_rad) = fillet_at(&envelope, head_rad, cradle_rad);
            if lean_rad < surface.blade_angle_rad || lean_rad > std::f64::consts::FRAC_PI_2 {
                continue;
            }
            leans += 1;
            assert!(beyond_mm(point_mm, cradle_rad).abs() < 1e-12);
            for step in [-3e-3, -1e-3, 1e-3, 3e-3] {
                let beside_mm = beyond_mm(point_mm, cradle_rad + step);
                assert!(beside_mm > 1e-7, "{}: {beside_mm:e} mm at {step}", kind.name());
            }
        }
        assert!(leans > 3, "{}: {leans}", kind.name());
    }
}

//! Texture of what was cut: cusps against brute-force envelopes, and the fingerprint of surfaces that were cut here.

use crate::fixtures::paper::{NORMAL, TRADITIONAL, operation, paper_scene};
use gearcut::cut::cpu::Cpu;
use gearcut::gear::{PitchCurveShape, TableScaling};
use gearcut::interrupt::Interrupt;
use gearcut::measure::scallop::{cusps, facets};
use gearcut::measure::topography::Form;
use gearcut::process::shaping::ShapingJob;
use gearcut::process::shaping::scene::model::{Feed, Shaping, StrokeSpacing};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::scene::model::{Scene, TextureFilters, TextureWindow, WindowSides};
use gearcut::terms::Side;
use gearcut::texture::{Direction, WindowTexture, cut_window, measure, roughness, sampled, warnings, windows};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/topography").join(name)
}

/// One finishing cut with a circular feed, mm per stroke, at equal arcs.
fn finishing_scene(module_mm: f64, teeth: u32, cutter_teeth: u32, shape: PitchCurveShape, feed_mm: f64) -> Scene {
    let mut finish = operation("finish", NORMAL, 0.0, 100);
    finish.feed = Feed::CircularMmPerStroke(feed_mm);
    finish.spacing = StrokeSpacing::Arc;
    let mut scene = paper_scene(vec![finish]);
    scene.gear.module_mm = module_mm;
    scene.gear.teeth = teeth;
    scene.gear.pitch_curve = shape;
    scene.gear.face_width_mm = 10.0;
    Shaping::of_mut(&mut scene).expect("shaping").tool.teeth = cutter_teeth;
    scene.fields.profile_spacing_mm = 0.002;
    scene.fields.lead_spacing_mm = 10.0;
    scene
}

/// Cusps of a flank: rolling distance from the pitch point along the pitch line (positive towards the root) and height,
/// mm; and the feed in force.
fn flank_cusps(job: &ShapingJob, tooth: u32, side: Side, crossing_arc_mm: f64) -> (Vec<[f64; 2]>, f64) {
    let flank = job.target_flank(tooth, side);
    let cut = job.cut(&Cpu::default(), job.flank_field(flank)).expect("cut");
    let rolled = |arc_mm: f64| job.curve.arc_mm(flank.at_arc(arc_mm).phi_rad) - crossing_arc_mm;
    let towards_root = (rolled(0.0) - rolled(flank.length_mm())).signum();
    let found = cusps(&facets(&cut.field, &cut.layers[0], 0));
    let list = found.iter().map(|cusp| [towards_root * rolled(cusp.arc_mm), cusp.height_mm]).collect();
    (list, job.curve.perimeter_mm() / job.operations[0].schedule.count() as f64)
}

/// Value at `x` of the parabola through the three table points nearest to it.
fn interpolated(table: &[[f64; 2]], x: f64) -> f64 {
    let nearest = (0..table.len()).min_by(|&a, &b| (table[a][0] - x).abs().total_cmp(&(table[b][0] - x).abs()));
    let first = nearest.expect("a table").saturating_sub(1).min(table.len() - 3);
    let p = &table[first..first + 3];
    (0..3)
        .map(|i| {
            let others = (0..3).filter(|&j| j != i);
            others.fold(p[i][1], |product, j| product * (x - p[j][0]) / (p[i][0] - p[j][0]))
        })
        .sum()
}

/// Compares all cusps inside the table's range with its brute-force heights, in units of the feed's square.
fn check_cusps(case: &str, job: &ShapingJob, tooth: u32, side: Side, crossing_arc_mm: f64) {
    let text = std::fs::read_to_string(data("kinematics.json")).expect("a copy");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    let cases = json["cases"].as_array().expect("cases");
    let expected = cases.iter().find(|c| c["name"] == case).expect("the case");
    let number = |value: &Value| value.as_f64().expect("a number");
    let table: Vec<[f64; 2]> = expected["cusps"]
        .as_array()
        .expect("cusps")
        .iter()
        .map(|c| [number(&c["a_mm"]), number(&c["h_brute_um"]) * 1e-3])
        .collect();
    let given_mm = number(&expected["roll_step_mm"]);
    let (found, feed_mm) = flank_cusps(job, tooth, side, crossing_arc_mm);
    let inside: Vec<_> = found.iter().filter(|c| c[0] > table[0][0] && c[0] < table[table.len() - 1][0]).collect();
    assert!(inside.len() >= 8, "{case}: {} cusps", inside.len());
    for &&[a_mm, height_mm] in &inside {
        let height = height_mm / feed_mm.powi(2) * given_mm.powi(2);
        let law = interpolated(&table, a_mm);
        assert!((height / law - 1.0).abs() < 5e-3, "{case}: at {a_mm} mm the cusp is {height} mm, not {law} mm high");
    }
}

#[test]
fn cusps_on_a_round_gear_are_as_high_as_brute_force_says() {
    let job = ShapingJob::new(finishing_scene(2.0, 30, 25, PitchCurveShape::Circle, 0.35)).expect("a job");
    let pitch_mm = std::f64::consts::PI * 2.0;
    check_cusps("shape_ext_m2_z30_zc25", &job, 4, Side::Left, 3.75 * pitch_mm);
    check_cusps("shape_ext_m2_z30_zc25", &job, 4, Side::Right, 3.25 * pitch_mm);
}

/// The reference flanks cross the pitch curve at the ends of the axes: the ellipse is turned until they do. Its
/// circumference takes 38 teeth, and 27 cutter teeth have a pitch radius of 24.995 mm, where the reference has 25.
#[test]
fn cusps_on_an_ellipse_are_as_high_as_brute_force_says() {
    let (a, b, teeth) = (40.0_f64, 30.0_f64, 38_u32);
    let radius = |angle: f64| a * b / (b * angle.cos()).hypot(a * angle.sin());
    let arc = |from: f64, to: f64| -> f64 {
        let (steps, step) = (20_000, (to - from) / 20_000.0);
        (0..steps)
            .map(|i| {
                let t = from + (f64::from(i) + 0.5) * step;
                // Eccentric angle: the ellipse's own parameter.
                (a * t.sin()).hypot(b * t.cos()) * step
            })
            .sum()
    };
    let perimeter_mm = arc(0.0, std::f64::consts::TAU);
    let pitch_mm = perimeter_mm / f64::from(teeth);
    // Eccentric angle a quarter pitch from the end of the major axis, and the polar angle there.
    let mut t = 0.25 * pitch_mm / b;
    for _ in 0..20 {
        t -= (arc(0.0, t) - 0.25 * pitch_mm) / (a * t.sin()).hypot(b * t.cos());
    }
    let turn = (b * t.sin()).atan2(a * t.cos());
    let points_rad_mm =
        (0..2880).map(|i| std::f64::consts::TAU * f64::from(i) / 2880.0).map(|phi| [phi, radius(phi - turn)]).collect();
    let shape = PitchCurveShape::Table { points_rad_mm, scaling: TableScaling::Any };
    let scene = finishing_scene(pitch_mm / std::f64::consts::PI, teeth, 27, shape, 0.35);
    let job = ShapingJob::new(scene).expect("a job");
    assert!((job.curve.perimeter_mm() - perimeter_mm).abs() < 1e-4, "{}", job.curve.perimeter_mm());
    check_cusps("shape_ellipse_sharp", &job, 1, Side::Right, 0.25 * pitch_mm);
    check_cusps("shape_ellipse_flat", &job, 10, Side::Left, 9.75 * pitch_mm);
}

#[test]
fn cusps_grow_with_the_square_of_the_feed() {
    let height_at_pitch_point = |feed_mm: f64| {
        let job = ShapingJob::new(finishing_scene(2.0, 30, 25, PitchCurveShape::Circle, feed_mm)).expect("a job");
        let (mut found, feed_mm) = flank_cusps(&job, 2, Side::Left, 1.75 * std::f64::consts::PI * 2.0);
        found.sort_by(|p, q| p[0].total_cmp(&q[0]));
        interpolated(&found, 0.0) / feed_mm.powi(2)
    };
    let reference = height_at_pitch_point(0.1);
    for feed_mm in [0.2, 0.4, 0.8] {
        let ratio = height_at_pitch_point(feed_mm) / reference;
        assert!((ratio - 1.0).abs() < 5e-3, "{feed_mm} mm: {ratio}");
    }
}

fn window(
    tooth: u32,
    sides: WindowSides,
    middle_mm: Option<f64>,
    length_mm: Option<f64>,
    spacing_mm: f64,
    form: Form,
) -> TextureWindow {
    TextureWindow {
        tooth,
        sides,
        operation: None,
        center_profile_mm: middle_mm,
        center_lead_mm: 0.0,
        length_profile_mm: length_mm,
        length_lead_mm: Some(1.0),
        profile_spacing_mm: Some(spacing_mm),
        lead_spacing_mm: Some(0.1),
        form,
        filters: TextureFilters::default(),
        measured: None,
    }
}

fn textures(job: &ShapingJob) -> Vec<WindowTexture> {
    let windows = windows(job).expect("windows");
    windows.iter().map(|window| cut_window(job, &Cpu::default(), window).expect("cut")).collect()
}

#[test]
fn without_windows_the_extreme_teeth_and_tooth_3_are_taken_whole() {
    let job = ShapingJob::new(paper_scene(vec![operation("finish", NORMAL, 0.0, 360)])).expect("a job");
    let windows = windows(&job).expect("windows");
    // r is largest at 0 and smallest at 60 deg, a sixth of 42 pitches: beside tooth 1 and beside tooth 7.
    let flanks: Vec<_> = windows.iter().map(|w| (w.tooth, w.side)).collect();
    assert_eq!(flanks, [1, 3, 7].map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)]).concat());
    for window in &windows {
        assert_eq!(window.chain.form, Form::Poly2);
        let [along_tooth, along_profile] = window.length_mm();
        assert!((along_tooth - 30.0).abs() < 0.61 && (4.0..7.0).contains(&along_profile), "{window:?}");
        // Equal steps of arc, not of roll angle.
        let arcs: Vec<f64> = window.arcs_mm().collect();
        assert!(arcs.windows(2).all(|pair| (pair[1] - pair[0] - 0.005).abs() < 1e-12), "{window:?}");
    }
}

/// Marks are a tenth of a millimetre apart on the profile, and lean by one of them over the face where the feed goes on
/// during the stroke.
#[test]
fn a_window_with_too_few_marks_says_so() {
    for (during_stroke, length_mm, directions) in [
        (false, 0.05, &["along the profile"][..]),
        (false, 2.0, &[]),
        (true, 0.05, &["along the tooth", "along the profile"]),
        (true, 2.0, &["along the tooth"]),
    ] {
        let mut scene = finishing_scene(2.0, 30, 25, PitchCurveShape::Circle, 0.3);
        Shaping::of_mut(&mut scene).expect("shaping").operations[0].feed_during_stroke = during_stroke;
        scene.textures = vec![window(3, WindowSides::Left, None, Some(length_mm), 1e-3, Form::Plane)];
        let textures = textures(&ShapingJob::new(scene).expect("a job"));
        let warnings = textures[0].warnings();
        assert_eq!(warnings.len(), directions.len(), "{during_stroke}, {length_mm} mm: {warnings:?}");
        for (warning, direction) in warnings.iter().zip(directions) {
            assert!(warning.contains("the window holds only") && warning.contains(direction), "{warning}");
        }
    }
}

/// Marks a tenth of a millimetre apart: five points each are too few for slopes, a hundred are enough.
#[test]
fn a_window_too_coarse_for_its_marks_says_so() {
    for (spacing_mm, warned) in [(0.02, true), (1e-3, false)] {
        let mut scene = finishing_scene(2.0, 30, 25, PitchCurveShape::Circle, 0.3);
        scene.textures = vec![window(3, WindowSides::Left, None, Some(2.0), spacing_mm, Form::Plane)];
        let textures = textures(&ShapingJob::new(scene).expect("a job"));
        let warnings = textures[0].warnings();
        assert_eq!(!warnings.is_empty(), warned, "{spacing_mm} mm: {warnings:?}");
        for warning in warnings {
            assert!(
                warning.contains("a mark along the profile has only") && warning.contains("profile_spacing_um"),
                "{warning}"
            );
        }
    }
}

/// A gear and a cutter so large that a few marks are all alike: the fingerprint of parabolic scallops, cut and not
/// painted.
#[test]
fn a_cut_scallop_surface_has_the_fingerprint_of_its_shape() {
    let mut scene = finishing_scene(2.0, 1000, 300, PitchCurveShape::Circle, 0.3);
    let probe = ShapingJob::new(scene.clone()).expect("a job");
    let flank = probe.target_flank(7, Side::Left);
    let cut = probe.cut(&Cpu::default(), probe.flank_field(flank)).expect("cut");
    let all = cusps(&facets(&cut.field, &cut.layers[0], 0));
    let first = all.len() / 2 - 5;
    let marks = &all[first..=first + 10];
    let mean_um = 1e3 * marks.iter().map(|c| c.height_mm).sum::<f64>() / marks.len() as f64;
    let highest_um = marks.iter().map(|c| 1e3 * c.height_mm).fold(0.0, f64::max);
    // Whole marks, from cusp to cusp.
    let (from, to) = (marks[0].arc_mm, marks[10].arc_mm);
    scene.textures = vec![window(7, WindowSides::Left, Some(0.5 * (from + to)), Some(to - from), 2e-4, Form::None)];
    let job = ShapingJob::new(scene).expect("a job");
    let textures = textures(&job);
    assert_eq!(textures[0].marks[1], 10, "ten marks along the profile");
    assert_eq!(textures[0].marks[0], 0, "none along the tooth");
    assert!(textures[0].warnings().is_empty(), "{:?}", textures[0].warnings());
    let evaluation = &textures[0].evaluated.as_ref().expect("evaluated").evaluation;
    let h = mean_um;
    for (symbol, closed, of) in [
        ("Sa", 0.25660 * h, h),
        ("Sq", 0.29814 * h, h),
        ("Sk", 0.4 * h, h),
        ("Spk", 0.5762 * h, h),
        ("Svk", 0.0, h),
        ("Ssk", 0.6389, 1.0),
        ("Sku", 2.1429, 1.0),
        ("Sz", highest_um, h),
        ("Smrk1", 38.90, 100.0),
        ("Smrk2", 100.0, 100.0),
        ("Sal", 0.20537 * (to - from) * 100.0, 100.0),
    ] {
        let value = evaluation.value(symbol).expect("defined");
        let allowed = if closed == 0.0 { 0.01 * of } else { 0.01 * closed };
        assert!((value - closed).abs() <= allowed, "{symbol} is {value}, not {closed} (h = {h} um)");
    }
    assert_eq!(evaluation.value("Str"), None, "marks without end have no longest decay");
}

/// Lines across ten parabolic marks of 0.1 mm, with a cut-off that leaves 1 - 2^-6.25 of their first wave: Ra 0.2566 h
/// and Rz h. Along the tooth, where the axes rest, nothing. Both limits of the drawing are judged by the largest line.
#[test]
fn lines_across_a_cut_surface_have_the_roughness_of_its_marks() {
    let mut scene = finishing_scene(2.0, 1000, 300, PitchCurveShape::Circle, 0.3);
    let probe = ShapingJob::new(scene.clone()).expect("a job");
    let flank = probe.target_flank(7, Side::Left);
    let cut = probe.cut(&Cpu::default(), probe.flank_field(flank)).expect("cut");
    let all = cusps(&facets(&cut.field, &cut.layers[0], 0));
    let marks = &all[all.len() / 2 - 8..=all.len() / 2 + 8];
    let (from, to) = (marks[0].arc_mm, marks[16].arc_mm);
    let middle = 1e3 * marks[4..=12].iter().map(|c| c.height_mm).sum::<f64>() / 9.0;
    let mut wanted = window(7, WindowSides::Left, Some(0.5 * (from + to)), Some(to - from), 1e-3, Form::None);
    wanted.filters.cutoff_um = Some(250.0);
    scene.textures = vec![wanted];
    scene.measure.limits.ra_um = Some(0.3 * middle);
    scene.measure.limits.rz_um = Some(0.5 * middle);
    let job = ShapingJob::new(scene).expect("a job");
    let windows = sampled(&job, &windows(&job).expect("windows")).expect("sampled");
    let quiet = Progress::new(ProgressMode::Quiet);
    let textures = measure(&job, &windows, &Cpu::default(), &quiet, &Interrupt::default()).expect("cut");
    let [profile, tooth] = textures[0].traces.as_slice() else { panic!("both directions") };
    assert_eq!((profile.direction, tooth.direction), (Direction::Profile, Direction::Tooth));
    let of = |symbol| profile.of(symbol).unwrap_or_else(|| panic!("{symbol}: {:?}", profile.profiles)).mean_um;
    assert!((of("Ra") / (0.256_60 * middle) - 1.0).abs() < 0.03, "{} of {middle}", of("Ra"));
    assert!((of("Rz") / middle - 1.0).abs() < 0.05, "{} of {middle}", of("Rz"));
    assert!(tooth.of("Ra").is_none_or(|ra| ra.largest_um < 1e-3 * middle), "{:?}", tooth.of("Ra"));
    let section = roughness(&job, &textures);
    let lines = section.at_path("finish.tooth_07_left_along_profile").expect("a section of its own");
    assert_eq!(lines.number("cutoff"), Some(0.25));
    assert_eq!((lines.words("Ra_limit"), lines.words("Rz_limit")), ("kept", "exceeded"));
    let told: Vec<String> = warnings(&job, &textures).into_iter().map(|warning| warning.text).collect();
    assert!(told.iter().any(|text| text.starts_with("Rz of tooth 7 left along the profile is up to")), "{told:?}");
    assert!(!told.iter().any(|text| text.starts_with("Ra of tooth 7 left along the profile")), "{told:?}");
}

/// With no offset both linkages move the cutter alike: what they leave is the same surface, and its roughness has the
/// ratio 1.
#[test]
fn both_linkages_finish_to_the_same_roughness() {
    let measured = |linkage| {
        let mut scene =
            paper_scene(vec![operation("rough", linkage, 2.0, 4200), operation("finish", linkage, 0.0, 360)]);
        scene.textures = vec![window(3, WindowSides::Both, None, Some(5.0), 5e-3, Form::Poly2)];
        let textures = textures(&ShapingJob::new(scene).expect("a job"));
        assert!(textures.len() == 2 && textures.iter().all(|t| t.window.operation == 1), "two finished flanks");
        textures
            .iter()
            .map(|t| {
                let evaluation = &t.evaluated.as_ref().expect("evaluated").evaluation;
                ["Sa", "Sk", "Spk"].map(|symbol| evaluation.value(symbol).expect("defined"))
            })
            .collect::<Vec<_>>()
    };
    let (normal, traditional) = (measured(NORMAL), measured(TRADITIONAL));
    for (n, t) in normal.iter().flatten().zip(traditional.iter().flatten()) {
        assert!((n / t - 1.0).abs() < 1e-3, "{n} against {t} um: the ratio is not 1.00");
    }
}

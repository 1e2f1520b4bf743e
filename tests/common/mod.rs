//! Scenes of the papers, built without a file.
#![allow(dead_code, reason = "each test binary uses its own part")]

use gearcut::job::Job;
use gearcut::scene::model::*;
use glam::DVec2;

/// The paper's gear and cutter with given operations.
pub fn paper_scene(operations: Vec<Operation>) -> Scene {
    Scene {
        name: "paper".into(),
        gear: Gear {
            module_mm: 3.0,
            teeth: 42,
            pressure_angle_rad: 20_f64.to_radians(),
            helix_angle_rad: 0.0,
            hand: Hand::Right,
            face_width_mm: 30.0,
            addendum_coefficient: 1.0,
            bore_diameter_mm: 20.0,
            tooth_thickness_allowance_mm: 0.0,
            pitch_curve: PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) },
        },
        material: gearcut::material::MATERIALS[0].edge_force(),
        process: Process::Shaping(Shaping {
            tool: ShaperCutter {
                teeth: 20,
                addendum_coefficient: 1.25,
                dedendum_coefficient: 1.25,
                profile_shift_coefficient: 0.0,
                thinning_mm: 0.0,
                tip: Tip::Sharp,
                rake_angle_rad: 0.0,
                runout_mm: 0.0,
                runout_angle_rad: 0.0,
                pitch_errors_mm: Vec::new(),
            },
            machine: Machine {
                double_strokes_per_minute: 300.0,
                approach_mm: 5.0,
                overrun_mm: 2.0,
                back_off_mm: 0.5,
                work_eccentricity_mm: 0.0,
                work_eccentricity_angle_rad: 0.0,
                limits: AxisLimits::default(),
            },
            operations,
        }),
        textures: Vec::new(),
        fields: Fields {
            profile_spacing_mm: 0.005,
            lead_spacing_mm: 0.05,
            blank_spacing_mm: 0.1,
            blank_slice_spacing_mm: 2.5,
            chip_spacing_mm: 0.05,
        },
        measure: Measure { profile_start_height_mm: None, profile_end_height_mm: None },
        output: Output {
            map_spacing_mm: 0.1,
            mesh_spacing_mm: 0.1,
            folder: None,
            gcode: GcodeDialect::Linear,
            gcode_contour_error_mm: 0.001,
        },
        pictures: Vec::new(),
    }
}

/// An operation with frozen strokes.
pub fn operation(name: &str, linkage: Linkage, offset_mm: f64, strokes: u32) -> Operation {
    Operation {
        name: name.into(),
        offset_mm,
        linkage,
        feed: Feed::StrokesPerRevolution(strokes),
        spacing: StrokeSpacing::WorkAngle,
        window_rad: None,
        revolutions: 1,
        overlap_rad: 0.0,
        infeed: Infeed::None,
        feed_during_stroke: false,
        program: None,
    }
}

/// The corrected normal linkage.
pub const NORMAL: Linkage = Linkage::ShapingNormal { reading: NormalReading::Corrected };
/// The traditional linkage.
pub const TRADITIONAL: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };

/// Height at which a ray meets one pass of an involute flank, and the cosine between ray and flank normal there, written from the closed form alone: the signed distance of a point to the flank,
/// `r_b (sigma theta + u - atan u - psi_b)`, has the flank's normal as its gradient.
pub fn involute_height_mm(job: &Job, stroke: usize, blade: u32, side: f64, o: DVec2, n: DVec2) -> Option<[f64; 2]> {
    let state = job.finishing().schedule.state(stroke as f64);
    let r_b = 30.0 * 20_f64.to_radians().cos();
    let alpha = 20_f64.to_radians();
    let psi_b = std::f64::consts::PI / 40.0 + alpha.tan() - alpha;
    let turn = -(state.pose.angle_rad + std::f64::consts::TAU * f64::from(blade) / 20.0);
    let local = |p: DVec2| DVec2::from_angle(turn).rotate(p - state.pose.center_mm);
    let (o, n) = (local(o), DVec2::from_angle(turn).rotate(n));
    // From outside the tooth, so that the iteration does not fall below the base circle on its way.
    let mut h = -0.05;
    for _ in 0..60 {
        let p = o + h * n;
        if p.x <= 0.0 {
            return None;
        }
        let u = ((p.length() / r_b).powi(2) - 1.0).max(0.0).sqrt();
        let distance = r_b * (side * p.to_angle() + u - u.atan() - psi_b);
        let lean = DVec2::from_angle(p.to_angle() + side * (std::f64::consts::FRAC_PI_2 - u.atan()));
        let rate = lean.dot(n);
        if rate > -0.05 {
            return None;
        }
        let step = distance / rate;
        h -= step;
        if step.abs() < 1e-14 {
            let p = o + h * n;
            let tip = 30.0 + 1.25 * 3.0;
            return (p.length() <= tip && p.length() > r_b + 1e-4).then_some([h, -rate]);
        }
    }
    None
}

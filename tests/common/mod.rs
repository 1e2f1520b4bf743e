//! Scenes of the papers, built without a file.
#![allow(dead_code, reason = "each test binary uses its own part")]

use gearcut::scene::model::*;

/// The paper's gear and cutter with given operations.
pub fn paper_scene(operations: Vec<Operation>) -> Scene {
    Scene {
        name: "paper".into(),
        gear: Gear {
            module_mm: 3.0,
            teeth: 42,
            pressure_angle_rad: 20_f64.to_radians(),
            face_width_mm: 30.0,
            addendum_coefficient: 1.0,
            bore_diameter_mm: 20.0,
            tooth_thickness_allowance_mm: 0.0,
            pitch_curve: PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: Some(61.11) },
        },
        tool: ShaperCutter {
            teeth: 20,
            addendum_coefficient: 1.25,
            dedendum_coefficient: 1.25,
            profile_shift_coefficient: 0.0,
            thinning_mm: 0.0,
            tip: Tip::Sharp,
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
        textures: Vec::new(),
        fields: Fields {
            profile_spacing_mm: 0.005,
            lead_spacing_mm: 0.05,
            blank_spacing_mm: 0.1,
            blank_slice_spacing_mm: 2.5,
        },
        measure: Measure { profile_start_height_mm: None, profile_end_height_mm: None },
        output: Output { map_spacing_mm: 0.1, mesh_spacing_mm: 0.1, folder: None },
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
    }
}

/// The corrected normal linkage.
pub const NORMAL: Linkage = Linkage::ShapingNormal { reading: NormalReading::Corrected };
/// The traditional linkage.
pub const TRADITIONAL: Linkage = Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine };

//! Checked values to the model, with units turned into those used inside: mm, rad, s.
//!
//! Every value is there once the scene is without problems; a missing one ends the building, and a test over all
//! variants keeps the table of keys and this file together.

pub(super) mod hobbing;

use std::path::{Path, PathBuf};

use super::model::{
    AxisLimits, Feed, Fields, GcodeDialect, Gear, Infeed, Linkage, Machine, Measure, NormalReading, Operation, Output,
    Picture, PictureColour, PictureView, Process, Scene, ShaperCutter, Shaping, StrokeSpacing, TextureWindow, Tip,
    TraditionalDirection, WindowSides,
};
use super::process::SceneProcess;
use super::values::{Values, View};
use crate::gear::PitchCurveShape;
use crate::material::EdgeForce;
use crate::terms::Side;
use crate::units::UM_PER_MM;
use gearcut_texture::Form;

/// The scene called `name`; `base_dir` holds the files it refers to.
pub(super) fn build(name: &str, base_dir: &Path, values: &Values) -> Option<Scene> {
    let pictures: Option<Vec<Picture>> = (0..values.count("picture"))
        .map(|index| picture(values.view(&format!("picture.{index}")), values.count("operation")))
        .collect();
    let flank = values.view("fields.flank");
    let blank = values.view("fields.blank");
    let output = values.view("output");
    Some(Scene {
        name: name.to_owned(),
        gear: gear(values)?,
        process: (SceneProcess::of(values)?.build)(values, base_dir)?,
        textures: (0..values.count("texture"))
            .map(|index| texture(values.view(&format!("texture.{index}"))))
            .collect::<Option<_>>()?,
        fields: Fields {
            profile_spacing_mm: mm_from_um(flank, "profile_spacing_um")?,
            lead_spacing_mm: mm_from_um(flank, "lead_spacing_um")?,
            blank_spacing_mm: blank.number("spacing_mm")?,
            blank_slice_spacing_mm: blank.number("slice_spacing_mm")?,
        },
        output: Output {
            map_spacing_mm: output.number("map_spacing_mm")?,
            mesh_spacing_mm: output.number("mesh_spacing_mm")?,
            folder: output.text("folder").map(PathBuf::from),
            gcode: match output.text("gcode")? {
                "linear" => GcodeDialect::Linear,
                "paper_g84" => GcodeDialect::PaperG84,
                "none" => GcodeDialect::None,
                _ => return None,
            },
            gcode_contour_error_mm: mm_from_um(output, "gcode_contour_error_um")?,
        },
        pictures: pictures?,
    })
}

fn rad(view: View<'_>, name: &str) -> Option<f64> {
    view.number(name).map(f64::to_radians)
}

fn mm_from_um(view: View<'_>, name: &str) -> Option<f64> {
    view.number(name).map(|um| um / UM_PER_MM)
}

/// Shaping: cutter, machine and operations.
pub(super) fn shaping(values: &Values, base_dir: &Path) -> Option<Process> {
    let pressure_angle_rad = rad(values.view("gear"), "pressure_angle_deg")?;
    let operations: Option<Vec<Operation>> = (0..values.count("operation"))
        .map(|index| operation(values, &format!("operation.{index}"), base_dir, pressure_angle_rad))
        .collect();
    let measure = values.view("measure");
    Some(Process::Shaping(Shaping {
        tool: shaper_cutter(values)?,
        machine: machine(values)?,
        operations: operations?,
        material: material(values)?,
        chip_spacing_mm: values.view("fields.chips").number("spacing_mm")?,
        measure: Measure {
            profile_start_height_mm: measure.number("profile_start_height_mm"),
            profile_end_height_mm: measure.number("profile_end_height_mm"),
        },
    }))
}

/// How far the tool stays back: given, or from the stock on each flank.
fn stock_or_offset(operation: View<'_>, pressure_angle_rad: f64) -> Option<f64> {
    match operation.number("stock_per_flank_mm") {
        Some(stock_mm) => Some(stock_mm / pressure_angle_rad.sin()),
        None => operation.number("offset_mm"),
    }
}

fn gear(values: &Values) -> Option<Gear> {
    let gear = values.view("gear");
    Some(Gear {
        module_mm: gear.number("module_mm")?,
        teeth: gear.whole("teeth")?,
        pressure_angle_rad: rad(gear, "pressure_angle_deg")?,
        helix_angle_rad: rad(gear, "helix_angle_deg")?,
        hand: hobbing::hand(gear.text("hand")?)?,
        face_width_mm: gear.number("face_width_mm")?,
        addendum_coefficient: gear.number("addendum_coefficient")?,
        bore_diameter_mm: gear.number("bore_diameter_mm")?,
        tooth_thickness_allowance_mm: gear.number("tooth_thickness_allowance_mm")?,
        pitch_curve: pitch_curve(values, gear.variant("pitch_curve")?)?,
    })
}

fn material(values: &Values) -> Option<EdgeForce> {
    let material = values.view("material");
    Some(EdgeForce {
        cutting_n_per_mm2: material.number("cutting_force_n_per_mm2")?,
        cutting_edge_n_per_mm: material.number("cutting_edge_force_n_per_mm")?,
        normal_n_per_mm2: material.number("normal_force_n_per_mm2")?,
        normal_edge_n_per_mm: material.number("normal_edge_force_n_per_mm")?,
    })
}

fn pitch_curve(values: &Values, shape: &str) -> Option<PitchCurveShape> {
    let path = format!("gear.pitch_curve.{shape}");
    let curve = values.view(&path);
    Some(match shape {
        "circle" => PitchCurveShape::Circle,
        "ellipse" => PitchCurveShape::Ellipse {
            order: curve.whole("order")?,
            eccentricity: curve.number("eccentricity")?,
            semi_major_axis_mm: curve.number("semi_major_axis_mm"),
        },
        "sinusoidal_ratio" => PitchCurveShape::SinusoidalRatio {
            order: curve.whole("order")?,
            mean_ratio: curve.number("mean_ratio")?,
            ratio_amplitude: curve.number("ratio_amplitude")?,
            center_distance_mm: curve.number("center_distance_mm"),
        },
        "pascal" => PitchCurveShape::Pascal {
            order: curve.whole("order")?,
            eccentricity: curve.number("eccentricity")?,
            mean_radius_mm: curve.number("mean_radius_mm"),
        },
        "fourier" => PitchCurveShape::Fourier {
            cosine: curve.numbers("cosine")?.to_vec(),
            sine: curve.numbers("sine")?.to_vec(),
            mean_radius_mm: curve.number("mean_radius_mm"),
        },
        "table" => PitchCurveShape::Table {
            points_rad_mm: curve.points("points_deg_mm")?.iter().map(|&[deg, mm]| [deg.to_radians(), mm]).collect(),
            scale_to_close: curve.boolean("scale_to_close")?,
        },
        _ => return None,
    })
}

fn shaper_cutter(values: &Values) -> Option<ShaperCutter> {
    let cutter = values.view("tool.shaper_cutter");
    let round = values.view("tool.shaper_cutter.tip.round");
    let chamfer = values.view("tool.shaper_cutter.tip.chamfer");
    Some(ShaperCutter {
        teeth: cutter.whole("teeth")?,
        addendum_coefficient: cutter.number("addendum_coefficient")?,
        dedendum_coefficient: cutter.number("dedendum_coefficient")?,
        profile_shift_coefficient: cutter.number("profile_shift_coefficient")?,
        thinning_mm: cutter.number("thinning_mm")?,
        tip: match cutter.variant("tip")? {
            "sharp" => Tip::Sharp,
            "round" => Tip::Round { radius_mm: round.number("radius_mm")? },
            "chamfer" => {
                Tip::Chamfer { height_mm: chamfer.number("height_mm")?, angle_rad: rad(chamfer, "angle_deg")? }
            }
            _ => return None,
        },
        rake_angle_rad: rad(cutter, "rake_angle_deg")?,
        runout_mm: mm_from_um(cutter, "runout_um")?,
        runout_angle_rad: rad(cutter, "runout_angle_deg")?,
        pitch_errors_mm: cutter.numbers("pitch_errors_um")?.iter().map(|um| um / UM_PER_MM).collect(),
    })
}

fn machine(values: &Values) -> Option<Machine> {
    let machine = values.view("machine");
    let limits = values.view("machine.limits");
    Some(Machine {
        double_strokes_per_minute: machine.number("double_strokes_per_minute")?,
        approach_mm: machine.number("approach_mm")?,
        overrun_mm: machine.number("overrun_mm")?,
        back_off_mm: machine.number("back_off_mm")?,
        work_eccentricity_mm: mm_from_um(machine, "work_eccentricity_um")?,
        work_eccentricity_angle_rad: rad(machine, "work_eccentricity_angle_deg")?,
        limits: AxisLimits {
            work_speed_rad_per_s: rad(limits, "work_speed_deg_per_s"),
            cutter_speed_rad_per_s: rad(limits, "cutter_speed_deg_per_s"),
            center_distance_speed_mm_per_s: limits.number("center_distance_speed_mm_per_s"),
            work_acceleration_rad_per_s2: rad(limits, "work_acceleration_deg_per_s2"),
            cutter_acceleration_rad_per_s2: rad(limits, "cutter_acceleration_deg_per_s2"),
            center_distance_acceleration_mm_per_s2: limits.number("center_distance_acceleration_mm_per_s2"),
        },
    })
}

fn operation(values: &Values, path: &str, base_dir: &Path, pressure_angle_rad: f64) -> Option<Operation> {
    let operation = values.view(path);
    let feed = match operation.number("circular_feed_mm_per_stroke") {
        Some(feed_mm) => Feed::CircularMmPerStroke(feed_mm),
        None => Feed::StrokesPerRevolution(operation.whole("strokes_per_revolution")?),
    };
    let window_rad = match operation.numbers("window_deg") {
        Some([start, end]) => Some([start.to_radians(), end.to_radians()]),
        _ => None,
    };
    Some(Operation {
        name: operation.text("name")?.to_owned(),
        offset_mm: stock_or_offset(operation, pressure_angle_rad)?,
        linkage: linkage(values, path, operation.variant("linkage")?)?,
        feed,
        spacing: match operation.text("stroke_spacing")? {
            "work_angle" => StrokeSpacing::WorkAngle,
            "arc" => StrokeSpacing::Arc,
            "time" => StrokeSpacing::Time,
            _ => return None,
        },
        window_rad,
        revolutions: operation.whole("revolutions")?,
        overlap_rad: rad(operation, "overlap_deg")?,
        infeed: infeed(values, path, operation.variant("infeed")?)?,
        feed_during_stroke: operation.boolean("feed_during_stroke")?,
        program: operation.text("program").map(|name| base_dir.join(name)),
    })
}

fn texture(window: View<'_>) -> Option<TextureWindow> {
    Some(TextureWindow {
        tooth: window.whole("tooth")?,
        sides: match window.text("side")? {
            "left" => WindowSides::Left,
            "right" => WindowSides::Right,
            "both" => WindowSides::Both,
            _ => return None,
        },
        center_profile_mm: window.number("center_profile_mm"),
        center_lead_mm: window.number("center_lead_mm")?,
        length_profile_mm: window.number("length_profile_mm"),
        length_lead_mm: window.number("length_lead_mm"),
        profile_spacing_mm: mm_from_um(window, "profile_spacing_um"),
        lead_spacing_mm: mm_from_um(window, "lead_spacing_um"),
        form: match window.text("form")? {
            "none" => Form::None,
            "plane" => Form::Plane,
            "poly2" => Form::Poly2,
            "poly2-plus-cylinder" => Form::Poly2PlusCylinder,
            _ => return None,
        },
    })
}

fn linkage(values: &Values, path: &str, law: &str) -> Option<Linkage> {
    let path = format!("{path}.linkage.{law}");
    let linkage = values.view(&path);
    Some(match law {
        "shaping_traditional" => Linkage::ShapingTraditional {
            direction: match linkage.text("direction")? {
                "center_line" => TraditionalDirection::CenterLine,
                "polar_radius" => TraditionalDirection::PolarRadius,
                _ => return None,
            },
        },
        "shaping_normal" => Linkage::ShapingNormal {
            reading: match linkage.text("reading")? {
                "corrected" => NormalReading::Corrected,
                "as_printed" => NormalReading::AsPrinted,
                _ => return None,
            },
        },
        _ => return None,
    })
}

fn infeed(values: &Values, path: &str, way: &str) -> Option<Infeed> {
    let path = format!("{path}.infeed.{way}");
    let infeed = values.view(&path);
    Some(match way {
        "none" => Infeed::None,
        "plunge" => Infeed::Plunge { depth_mm: infeed.number("depth_mm")?, strokes: infeed.whole("strokes")? },
        "spiral" => Infeed::Spiral { depth_mm: infeed.number("depth_mm")?, angle_rad: rad(infeed, "angle_deg")? },
        "plunge_and_roll" => Infeed::PlungeAndRoll {
            plunge_depth_mm: infeed.number("plunge_depth_mm")?,
            strokes: infeed.whole("strokes")?,
            roll_depth_mm: infeed.number("roll_depth_mm")?,
            angle_rad: rad(infeed, "angle_deg")?,
        },
        _ => return None,
    })
}

fn picture(picture: View<'_>, operations: usize) -> Option<Picture> {
    let view = match picture.text("view")? {
        "gear" => PictureView::Gear,
        "tooth" => PictureView::Tooth,
        "flank" => PictureView::Flank,
        _ => return None,
    };
    let [azimuth_deg, elevation_deg] = match view {
        PictureView::Gear => [-60.0, 40.0],
        PictureView::Tooth => [-25.0, 35.0],
        PictureView::Flank => [0.0, 60.0],
    };
    Some(Picture {
        name: picture.text("name")?.to_owned(),
        view,
        tooth: picture.whole("tooth")?,
        side: match picture.text("side")? {
            "left" => Side::Left,
            "right" => Side::Right,
            _ => return None,
        },
        colour: match picture.text("colour") {
            Some("stock") => PictureColour::Stock,
            Some("height") => PictureColour::Height,
            Some("pass") => PictureColour::Pass,
            Some("clay") => PictureColour::Clay,
            Some(_) => return None,
            None if operations > 1 && view != PictureView::Flank => PictureColour::Stock,
            None => PictureColour::Clay,
        },
        azimuth_rad: picture.number("azimuth_deg").unwrap_or(azimuth_deg).to_radians(),
        elevation_rad: picture.number("elevation_deg").unwrap_or(elevation_deg).to_radians(),
        extent_mm: picture.number("extent_mm"),
        exaggeration: picture.number("exaggeration"),
        size_px: (picture.whole("width_px")?, picture.whole("height_px")?),
        exr: picture.boolean("exr")?,
    })
}

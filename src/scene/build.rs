//! Checked values to the model, with units turned into those used inside: mm, rad, s; the process builds its own part.
//!
//! Every value is there once the scene is without problems; a missing one ends the building, and a test over all
//! variants keeps the table of keys and this file together.

use std::path::{Path, PathBuf};

use super::model::{
    DrawnLimits, Fields, Gear, Measure, Output, Picture, PictureColour, PictureView, Post, ReportHead, Scene,
    TextureFilters, TextureWindow, WindowSides,
};
use super::process::SceneProcess;
use super::values::{Values, View};
use crate::material::CuttingForce;
use gearcut_core::gear::{Driver, FormulaMeaning, GearKind, PitchCurveShape, TableScaling};
use gearcut_core::math::formula::Formula;
use gearcut_core::terms::{Hand, Side};
use gearcut_texture::Form;

/// Polar angles between which a gear has teeth, where that is a part of the turn alone; processes that cut such gears
/// know the key.
pub(crate) fn sector_deg(values: &Values) -> Option<[f64; 2]> {
    values.view("gear").numbers("sector_deg")?.try_into().ok()
}

/// The scene called `name`; `base_dir` holds the files it refers to.
pub(super) fn build(name: &str, process: &SceneProcess, base_dir: &Path, values: &Values) -> Option<Scene> {
    let pictures: Option<Vec<Picture>> = (0..values.count("picture"))
        .map(|index| picture(values.view(&format!("picture.{index}")), values.count("operation")))
        .collect();
    let flank = values.view("fields.flank");
    let blank = values.view("fields.blank");
    let output = values.view("output");
    let measure = values.view("measure");
    Some(Scene {
        name: name.to_owned(),
        gear: gear(values)?,
        process: (process.build)(values, base_dir)?,
        measure: Measure {
            profile_start_height_mm: measure.number("profile_start_height_mm"),
            profile_end_height_mm: measure.number("profile_end_height_mm"),
            iso_1328_class: measure.whole("iso_1328_class"),
            ball_diameter_mm: measure.number("ball_diameter_mm"),
            limits: drawn_limits(values.view("measure.limits")),
        },
        textures: (0..values.count("texture"))
            .map(|index| texture(values.view(&format!("texture.{index}")), base_dir))
            .collect::<Option<_>>()?,
        fields: Fields {
            profile_spacing_mm: flank.mm_from_um("profile_spacing_um")?,
            lead_spacing_mm: flank.mm_from_um("lead_spacing_um")?,
            blank_spacing_mm: blank.number("spacing_mm")?,
            blank_slice_spacing_mm: blank.number("slice_spacing_mm")?,
        },
        output: Output {
            map_spacing_mm: output.number("map_spacing_mm")?,
            mesh_spacing_mm: output.number("mesh_spacing_mm")?,
            draws_all_flanks: output.text("flank_pictures")? == "all",
            folder: output.text("folder").map(PathBuf::from),
            gcode_contour_error_mm: output.mm_from_um("gcode_contour_error_um")?,
            post: match output.text("post")? {
                "plain" => Post::Plain,
                "linuxcnc" => Post::LinuxCnc,
                "siemens" => Post::Siemens,
                "fanuc" => Post::Fanuc,
                _ => return None,
            },
        },
        report: report_head(values.view("report")),
        pictures: pictures?,
        is_draft: false,
    })
}

fn report_head(report: View<'_>) -> ReportHead {
    let field = |name: &str| report.text(name).map(str::to_owned);
    ReportHead {
        part: field("part"),
        drawing: field("drawing"),
        customer: field("customer"),
        date: field("date"),
        us_letter: report.text("paper") == Some("letter"),
    }
}

fn drawn_limits(limits: View<'_>) -> DrawnLimits {
    DrawnLimits {
        profile_total_um: limits.number("profile_total_um"),
        profile_form_um: limits.number("profile_form_um"),
        profile_slope_um: limits.number("profile_slope_um"),
        helix_total_um: limits.number("helix_total_um"),
        helix_form_um: limits.number("helix_form_um"),
        helix_slope_um: limits.number("helix_slope_um"),
        single_pitch_um: limits.number("single_pitch_um"),
        total_pitch_um: limits.number("total_pitch_um"),
        runout_um: limits.number("runout_um"),
        ra_um: limits.number("ra_um"),
        rz_um: limits.number("rz_um"),
    }
}

/// How far the tool stays back in an operation, mm: given, or from the stock on each flank.
pub(crate) fn stock_or_offset_mm(operation: View<'_>, pressure_angle_rad: f64) -> Option<f64> {
    match operation.number("stock_per_flank_mm") {
        Some(stock_mm) => Some(stock_mm / pressure_angle_rad.sin()),
        None => operation.number("offset_mm"),
    }
}

/// Cutting force of the material that a scene names.
pub(crate) fn cutting_force(material: View<'_>) -> Option<CuttingForce> {
    Some(CuttingForce {
        per_area_n_per_mm2: material.number("cutting_force_n_per_mm2")?,
        per_length_n_per_mm: material.number("cutting_edge_force_n_per_mm")?,
    })
}

/// Whether straight-line programs are written, of a process that has no others.
pub(crate) fn linear_programs(values: &Values) -> Option<bool> {
    match values.view("output").text("gcode")? {
        "linear" => Some(true),
        "none" => Some(false),
        _ => None,
    }
}

fn gear(values: &Values) -> Option<Gear> {
    let gear = values.view("gear");
    let kind = match gear.text("kind")? {
        "external" => GearKind::External,
        "internal" => GearKind::Internal,
        _ => return None,
    };
    Some(Gear {
        kind,
        module_mm: gear.number("module_mm")?,
        teeth: gear.whole("teeth")?,
        pressure_angle_rad: gear.rad("pressure_angle_deg")?,
        // Only processes that cut helical gears know these two.
        helix_angle_rad: gear.rad("helix_angle_deg").unwrap_or(0.0),
        hand: gear.hand("hand").unwrap_or(Hand::Right),
        face_width_mm: gear.number("face_width_mm")?,
        addendum_coefficient: gear.number("addendum_coefficient")?,
        profile_shift_coefficient: gear.number("profile_shift_coefficient")?,
        bore_diameter_mm: gear.number("bore_diameter_mm")?,
        rim_mm: gear.number("rim_mm").unwrap_or(0.0),
        tooth_thickness_allowance_mm: gear.number("tooth_thickness_allowance_mm")?,
        center_distance_mm: gear.number("center_distance_mm"),
        dwell_radius_mm: gear.number("dwell_radius_mm"),
        pitch_curve: over_sector(values, pitch_curve(values, "gear.pitch_curve", kind)?),
    })
}

/// The curve over the sector that a scene has teeth on, if it has not all round.
fn over_sector(values: &Values, law: PitchCurveShape) -> PitchCurveShape {
    match sector_deg(values) {
        Some(range_deg) => PitchCurveShape::Sector { law: Box::new(law), range_rad: range_deg.map(f64::to_radians) },
        None => law,
    }
}

/// The curve that a table chooses: `[gear.pitch_curve]`, or that of a mate's driver.
fn pitch_curve(values: &Values, choice: &str, kind: GearKind) -> Option<PitchCurveShape> {
    let (holder, name) = choice.rsplit_once('.')?;
    // Gears that roll on cones have no choice of curves: a circle stands for theirs.
    let Some(shape) = values.view(holder).variant(name) else { return Some(PitchCurveShape::Circle) };
    let path = format!("{choice}.{shape}");
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
        "radius_formula" => PitchCurveShape::Formula {
            formula: Formula::parse(curve.text("radius")?).ok()?,
            meaning: FormulaMeaning::Radius,
            size_mm: curve.number("scale_mm"),
        },
        "ratio_formula" => PitchCurveShape::Formula {
            formula: Formula::parse(curve.text("ratio")?).ok()?,
            // A driver is an external gear, whatever its mate.
            meaning: FormulaMeaning::Ratio(if holder == "gear" { kind } else { GearKind::External }),
            size_mm: curve.number("center_distance_mm"),
        },
        "table" => PitchCurveShape::Table {
            points_rad_mm: curve.points("points_deg_mm")?.iter().map(|&[deg, mm]| [deg.to_radians(), mm]).collect(),
            scaling: match curve.boolean("scale_to_close") {
                None => TableScaling::Small,
                Some(true) => TableScaling::Any,
                Some(false) => TableScaling::AsGiven,
            },
        },
        "mate" => {
            let driver = Driver {
                curve: pitch_curve(values, &format!("{path}.driver"), kind)?,
                teeth: curve.whole("driver_teeth")?,
                start_rad: curve.rad("start_deg"),
            };
            PitchCurveShape::Mate { driver: Box::new(driver), kind }
        }
        _ => return None,
    })
}

fn texture(window: View<'_>, base_dir: &Path) -> Option<TextureWindow> {
    Some(TextureWindow {
        tooth: window.whole("tooth")?,
        sides: match window.text("side")? {
            "left" => WindowSides::Left,
            "right" => WindowSides::Right,
            "both" => WindowSides::Both,
            _ => return None,
        },
        operation: window.text("operation").map(str::to_owned),
        center_profile_mm: window.number("center_profile_mm"),
        center_lead_mm: window.number("center_lead_mm")?,
        length_profile_mm: window.number("length_profile_mm"),
        length_lead_mm: window.number("length_lead_mm"),
        profile_spacing_mm: window.mm_from_um("profile_spacing_um"),
        lead_spacing_mm: window.mm_from_um("lead_spacing_um"),
        form: match window.text("form")? {
            "none" => Form::None,
            "plane" => Form::Plane,
            "poly2" => Form::Poly2,
            "poly2-plus-cylinder" => Form::Poly2PlusCylinder,
            _ => return None,
        },
        filters: TextureFilters {
            s_filter_um: window.number("s_filter_um"),
            l_filter_um: window.number("l_filter_um"),
            robust: window.boolean("robust")?,
            cutoff_um: window.number("cutoff_um"),
        },
        measured: window.text("measured").map(|name| base_dir.join(name)),
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

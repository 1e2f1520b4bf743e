//! Checked values of a shaping scene to the model.

use super::keys::{
    AXES, BUILT_UP_EDGE, CMM, EDGE_ROUGHNESS, EDGE_ROUNDING, GRINDING, PROFILE, VIBRATION_KEYS, VIBRATION_PATH, WEAR,
};
use super::model::{
    AxisLimits, BuiltUpEdge, CmmSpec, CutterSpec, EdgeRoughness, EdgeRounding, Feed, GcodeDialect, Grinding, Infeed,
    Linkage, Machine, MachineVibration, NormalReading, Operation, Retraction, Shaping, StockScatter, StrokeSpacing,
    Tip, TraditionalDirection,
};
use super::stock;
use crate::machine_errors::{Compliance, SideCompliance};
use crate::material::EdgeForce;
use crate::random::Draws;
use crate::scene::ScenePart;
use crate::scene::drawn_profile::ToolProfile;
use crate::scene::machine_errors::machine_errors;
use crate::scene::tool_wear;
use crate::scene::values::{Values, View};
use gearcut_core::units::UM_PER_MM;
use std::path::Path;

/// Number of the first operation's source of random numbers: axes have those from 0 on.
const STOCK_SOURCE: u32 = 100;
/// mm/N for 1 um/kN.
const MM_PER_N_IN_UM_PER_KN: f64 = 1e-6;
/// mm/s for 1 m/min.
const MM_PER_S_IN_M_PER_MIN: f64 = 1000.0 / 60.0;
/// rad/(N mm) for 1 urad/(N m).
const RAD_PER_NMM_IN_URAD_PER_NM: f64 = 1e-9;

/// Shaping: cutter, machine and operations.
pub(super) fn build(values: &Values, base_dir: &Path) -> Option<ScenePart> {
    let pressure_angle_rad = values.view("gear").rad("pressure_angle_deg")?;
    let operations: Option<Vec<Operation>> =
        (0..values.count("operation")).map(|index| operation(values, index, base_dir, pressure_angle_rad)).collect();
    Some(ScenePart::new(Shaping {
        tool: shaper_cutter(values, base_dir)?,
        machine: machine(values)?,
        operations: operations?,
        material: material(values)?,
        chip_spacing_mm: values.view("fields.chips").number("spacing_mm")?,
        gcode: match values.view("output").text("gcode")? {
            "linear" => GcodeDialect::Linear,
            "paper_g84" => GcodeDialect::PaperG84,
            "none" => GcodeDialect::None,
            _ => return None,
        },
        wear: tool_wear::spec(values, WEAR),
        cmm: if values.has_section(CMM) { Some(cmm(values)?) } else { None },
    }))
}

fn cmm(values: &Values) -> Option<CmmSpec> {
    let cmm = values.view(CMM);
    Some(CmmSpec {
        points: cmm.whole("points")?,
        probe_diameter_mm: cmm.number("probe_diameter_mm")?,
        point_deviation_mm: cmm.mm_from_um("point_deviation_um")?,
        clamping_offset_mm: cmm.mm_from_um("clamping_offset_um")?,
        clamping_turn_rad: cmm.rad("clamping_turn_deg")?,
        draws: cmm.whole("draws")?,
        seed: cmm.whole("seed")?,
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

fn shaper_cutter(values: &Values, base_dir: &Path) -> Option<CutterSpec> {
    let cutter = values.view("tool.shaper_cutter");
    let round = values.view("tool.shaper_cutter.tip.round");
    let chamfer = values.view("tool.shaper_cutter.tip.chamfer");
    Some(CutterSpec {
        teeth: cutter.whole("teeth")?,
        addendum_coefficient: cutter.number("addendum_coefficient")?,
        dedendum_coefficient: cutter.number("dedendum_coefficient")?,
        profile_shift_coefficient: cutter.number("profile_shift_coefficient")?,
        thinning_mm: cutter.number("thinning_mm")?,
        tip: match cutter.variant("tip")? {
            "sharp" => Tip::Sharp,
            "round" => Tip::Round { radius_mm: round.number("radius_mm")? },
            "chamfer" => Tip::Chamfer { height_mm: chamfer.number("height_mm")?, angle_rad: chamfer.rad("angle_deg")? },
            _ => return None,
        },
        rake_angle_rad: cutter.rad("rake_angle_deg")?,
        runout_mm: cutter.mm_from_um("runout_um")?,
        runout_angle_rad: cutter.rad("runout_angle_deg")?,
        pitch_errors_mm: cutter.numbers("pitch_errors_um")?.iter().map(|um| um / UM_PER_MM).collect(),
        grinding: grinding(values),
        edge_roughness: edge_roughness(values, base_dir),
        edge_rounding: edge_rounding(values),
        built_up_edge: built_up_edge(values),
        profile: ToolProfile::of(values, PROFILE, base_dir),
    })
}

fn grinding(values: &Values) -> Option<Grinding> {
    let grinding = values.view(GRINDING);
    let (relief_rad, pressure_angle_rad) = (grinding.rad("tip_relief_angle_deg"), grinding.rad("pressure_angle_deg"));
    let is_known = relief_rad.is_some_and(|rad| rad > 0.0) || pressure_angle_rad.is_some();
    is_known.then(|| Grinding { tip_relief_rad: relief_rad.unwrap_or_default(), pressure_angle_rad })
}

fn edge_roughness(values: &Values, base_dir: &Path) -> Option<EdgeRoughness> {
    let roughness = values.view(EDGE_ROUGHNESS);
    if let Some(name) = roughness.text("profile") {
        return Some(EdgeRoughness::Profile(base_dir.join(name)));
    }
    let rq_mm = roughness.mm_from_um("rq_um").filter(|&rq_mm| rq_mm > 0.0)?;
    let correlation_mm = roughness.mm_from_um("correlation_length_um")?;
    Some(EdgeRoughness::Spectrum { rq_mm, correlation_mm, seed: roughness.whole("seed")? })
}

fn edge_rounding(values: &Values) -> Option<EdgeRounding> {
    let rounding = values.view(EDGE_ROUNDING);
    Some(EdgeRounding {
        radius_mm: rounding.mm_from_um("radius_um")?,
        minimum_chip_share: rounding.number("minimum_chip_share")?,
        recovery_share: rounding.number("recovery_share")?,
    })
}

fn built_up_edge(values: &Values) -> Option<BuiltUpEdge> {
    let edge = values.view(BUILT_UP_EDGE);
    let (&[from, to], &[full_from, full_to]) =
        (edge.numbers("speeds_m_per_min")?, edge.numbers("full_speeds_m_per_min")?)
    else {
        return None;
    };
    Some(BuiltUpEdge {
        density_per_mm2: edge.number("density_per_mm2")?,
        speeds_mm_per_s: [from, full_from, full_to, to].map(|m_per_min| m_per_min * MM_PER_S_IN_M_PER_MIN),
        chip_mm: edge.mm_from_um("chip_um")?,
        chip_exponent: edge.number("chip_exponent")?,
        depth_mm: edge.mm_from_um("depth_um")?,
        width_mm: edge.mm_from_um("width_um")?,
        scratch_share: edge.number("scratch_share")?,
        scratch_length_mm: edge.mm_from_um("scratch_length_um")?,
        seed: values.view("machine.errors").whole("seed")?,
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
        retraction: match machine.text("retraction")? {
            "center_line" => Retraction::CenterLine,
            "normal" => Retraction::Normal,
            "turned" => Retraction::Turned,
            "tilted" => Retraction::Tilted,
            "auto" => Retraction::Auto,
            _ => return None,
        },
        guide_lead_mm: machine.number("guide_lead_mm"),
        guide_hand: machine.hand("guide_hand"),
        errors: machine_errors(values, &AXES)?,
        compliance: compliance(values),
        vibration: vibration(values),
        limits: AxisLimits {
            work_speed_rad_per_s: limits.rad("work_speed_deg_per_s"),
            cutter_speed_rad_per_s: limits.rad("cutter_speed_deg_per_s"),
            center_distance_speed_mm_per_s: limits.number("center_distance_speed_mm_per_s"),
            work_acceleration_rad_per_s2: limits.rad("work_acceleration_deg_per_s2"),
            cutter_acceleration_rad_per_s2: limits.rad("cutter_acceleration_deg_per_s2"),
            center_distance_acceleration_mm_per_s2: limits.number("center_distance_acceleration_mm_per_s2"),
            cutting_force_n: limits.number("cutting_force_n"),
        },
    })
}

fn compliance(values: &Values) -> Compliance {
    let view = values.view("machine.compliance");
    let side = |side: &str| {
        let of = |name: &str| view.number(&format!("{side}_{name}")).unwrap_or(0.0);
        SideCompliance {
            radial_mm_per_n: of("radial_um_per_kn") * MM_PER_N_IN_UM_PER_KN,
            tangential_mm_per_n: of("tangential_um_per_kn") * MM_PER_N_IN_UM_PER_KN,
            torsional_rad_per_nmm: of("torsional_urad_per_nm") * RAD_PER_NMM_IN_URAD_PER_NM,
        }
    };
    Compliance { tool: side("tool"), work: side("work") }
}

fn vibration(values: &Values) -> Option<MachineVibration> {
    let view = values.view(VIBRATION_PATH);
    let word = view.text(VIBRATION_KEYS[0])?;
    Some(MachineVibration {
        axis: MachineVibration::AXES.iter().position(|&axis| axis == word)?,
        natural_frequency_hz: view.number(VIBRATION_KEYS[1])?,
        damping_ratio: view.number(VIBRATION_KEYS[2])?,
    })
}

fn operation(values: &Values, index: usize, base_dir: &Path, pressure_angle_rad: f64) -> Option<Operation> {
    let path = &format!("operation.{index}");
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
        offset_mm: stock::offset_mm(values, index)?,
        stock_scatter: stock_scatter(values, operation, index, pressure_angle_rad),
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
        overlap_rad: operation.rad("overlap_deg")?,
        infeed: infeed(values, path, operation.variant("infeed")?)?,
        feed_during_stroke: operation.boolean("feed_during_stroke")?,
        program: operation.text("program").map(|name| base_dir.join(name)),
    })
}

fn stock_scatter(values: &Values, operation: View<'_>, index: usize, pressure_angle_rad: f64) -> Option<StockScatter> {
    let stock_mm = operation.mm_from_um("stock_scatter_um").filter(|&stock_mm| stock_mm > 0.0)?;
    Some(StockScatter {
        deviation_mm: stock_mm / pressure_angle_rad.sin(),
        length_mm: operation.number("stock_scatter_length_mm"),
        draws: Draws::new(values.view("machine.errors").whole("seed")?, STOCK_SOURCE + index as u32),
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

fn infeed(values: &Values, path: &str, law: &str) -> Option<Infeed> {
    let path = format!("{path}.infeed.{law}");
    let infeed = values.view(&path);
    Some(match law {
        "none" => Infeed::None,
        "plunge" => Infeed::Plunge { depth_mm: infeed.number("depth_mm")?, strokes: infeed.whole("strokes")? },
        "spiral" => Infeed::Spiral { depth_mm: infeed.number("depth_mm")?, angle_rad: infeed.rad("angle_deg")? },
        "plunge_and_roll" => Infeed::PlungeAndRoll {
            plunge_depth_mm: infeed.number("plunge_depth_mm")?,
            strokes: infeed.whole("strokes")?,
            roll_depth_mm: infeed.number("roll_depth_mm")?,
            angle_rad: infeed.rad("angle_deg")?,
        },
        _ => return None,
    })
}

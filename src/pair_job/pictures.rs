//! Pictures of a pair: contact patterns on all flanks of both gears, and the gears rolling.
//!
//! In: a rolled pair. Out: a sheet of maps for each gear (u along the profile from the form point upward, v along the
//! tooth), and an animated PNG of the sections in the middle of the face.
//!
//! A pattern shows the smallest gap that a place has had to the mate while its side drove; places that stayed farther
//! away than the marking compound is thick are grey: nothing is rubbed off there.

use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::TAU;

use super::fit::SIDES;
use super::flanks::SectionOfGear;
use super::rolled::RolledPair;
use super::teeth::gap_um;
use super::watch::{PICTURES, Watch};
use crate::colormap::ColourScale;
use crate::output::apng::write_apng;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::rolling_picture::RollingPicture;
use crate::pair::flank_chain::{FlankChain, GearFlanks};
use crate::pair::pitch_pair::Member;
use crate::scene::Scene;
use gearcut_core::error::Result;
use gearcut_core::gear::GearKind;
use gearcut_core::terms::Side;

/// Rows of a map along the profile, mm apart.
const MAP_STEP_MM: f64 = 0.05;
/// Pitches that the animation rolls over, and its frames in each.
const FRAME_PITCHES: usize = 8;
const FRAMES_PER_PITCH: usize = 6;
const FRAME_MS: u16 = 80;
const FRAME_WIDTH_PX: u32 = 640;
/// What the animation shows beside the pitch points, modules: along the line of centres and across it.
const WINDOW_MODULES: [f64; 2] = [2.6, 8.0];
/// Points of chains closer than this are one in the animation, mm: a fifth of a pixel.
const DRAWN_MM: f64 = 0.02;
const COLOUR_A: [u8; 3] = [120, 160, 200];
const COLOUR_B: [u8; 3] = [225, 180, 120];
const CONTACT_COLOUR: [u8; 3] = [190, 20, 20];

/// Writes the sheet of contact patterns of a gear under `pictures/`; none of nominal flanks, which have no form points.
/// Returns the name of the file.
///
/// # Errors
/// Files that cannot be written.
pub fn write_pattern(
    rolled: &RolledPair,
    member: Member,
    scene: &Scene,
    marking_um: f64,
    folder: &OutputFolder,
) -> Result<Option<String>> {
    let gear = usize::from(member == Member::Driven);
    if rolled.flanks.sections[0][gear].u_mm.right[0].is_empty() {
        return Ok(None);
    }
    let maps: Vec<(String, MapGrid, Vec<f32>)> = (1..=i64::from(scene.gear.teeth))
        .flat_map(|tooth| [(tooth, Side::Left), (tooth, Side::Right)])
        .map(|(tooth, side)| {
            let (grid, values) = pattern(rolled, member, side, tooth, marking_um);
            let letter = if side == Side::Left { "L" } else { "R" };
            (format!("{tooth} {letter}"), grid, values)
        })
        .collect();
    let thumbnails: Vec<Thumbnail> =
        maps.iter().map(|(label, grid, values)| Thumbnail { label, grid, values }).collect();
    let letter = ["A", "B"][gear];
    let name = format!("pictures/contact_pattern_{letter}.png");
    let sheet = ContactSheet {
        title: &format!("{}: contact pattern of gear {letter}, marking {marking_um} µm", scene.name),
        quantity: "smallest gap to the mate",
        unit: "µm",
        scale: ColourScale::Sequential { low: 0.0, high: marking_um as f32 },
        missing: "nothing rubbed off",
        maps: &thumbnails,
    };
    write_contact_sheet(&folder.path(&name)?, &sheet)?;
    Ok(Some(name))
}

/// Smallest gaps on a flank, um, by places along the profile and sections; NaN where nothing is rubbed off.
pub fn pattern(rolled: &RolledPair, member: Member, side: Side, tooth: i64, marking_um: f64) -> (MapGrid, Vec<f32>) {
    let gear = usize::from(member == Member::Driven);
    // The label under which the pair knows the flank.
    let (side, label) = match member {
        Member::Driver => (side, tooth),
        Member::Driven => rolled.fit.label_of(side, tooth),
    };
    let u_of = |section: &[SectionOfGear; 2]| section[gear].u_mm.get(side, label).clone();
    let arcs: Vec<Vec<f64>> = rolled.flanks.sections.iter().map(u_of).collect();
    let length_mm = arcs.iter().filter_map(|u_mm| u_mm.last()).fold(0.0_f64, |most, u| most.max(*u));
    let rows = (length_mm / MAP_STEP_MM).ceil().max(1.0) as usize;
    let sections = arcs.len();
    let places = &rolled.flanks.rows_mm;
    let step_mm = if sections > 1 { places[1] - places[0] } else { rolled.face_mm };
    let axis = |name: &str, meaning: &str, start_mm, step_mm, count| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm,
        step_mm,
        count,
    };
    let u_step_mm = length_mm / rows as f64;
    let grid = MapGrid {
        u: axis("u", "along the profile", 0.5 * u_step_mm, u_step_mm, rows),
        v: axis("v", "along the tooth", places[0], step_mm, sections),
    };
    let mut values = vec![f32::NAN; rows * sections];
    for (section, u_mm) in arcs.iter().enumerate() {
        let gaps = &rolled.gaps[section];
        let gaps_um = match member {
            Member::Driver => gaps.driver_um.get(side, label),
            Member::Driven => gaps.driven_um.get(side, label),
        };
        for row in 0..rows {
            let gap_um = gap_at(u_mm, gaps_um, grid.u.place_mm(row));
            if f64::from(gap_um) <= marking_um {
                values[row * sections + section] = gap_um;
            }
        }
    }
    (grid, values)
}

/// Gap at an arc between the points of a chain, which are some hundredths of a millimetre apart.
fn gap_at(u_mm: &[f64], gaps_um: &[f32], at_mm: f64) -> f32 {
    let next = u_mm.partition_point(|u| *u <= at_mm).clamp(1, u_mm.len() - 1);
    let share = ((at_mm - u_mm[next - 1]) / (u_mm[next] - u_mm[next - 1])).clamp(0.0, 1.0) as f32;
    gaps_um[next - 1] + share * (gaps_um[next] - gaps_um[next - 1])
}

/// Writes an animation of the first pitches, `pictures/rolling.apng`, and returns its name.
///
/// # Errors
/// Files that cannot be written; Ctrl-C.
pub fn write_animation(rolled: &RolledPair, marking_um: f64, folder: &OutputFolder, watch: &Watch) -> Result<String> {
    let pitches = (rolled.period.turns * rolled.period.teeth) as usize;
    let per_frame = (rolled.period.moments.len() / pitches / FRAMES_PER_PITCH).max(1);
    let count = (FRAME_PITCHES * FRAMES_PER_PITCH).min(rolled.period.moments.len() / per_frame);
    let middle = rolled.flanks.sections.len() / 2;
    let [a, b] = &rolled.flanks.sections[middle];
    let ring = rolled.fit.pitch.teeth().driven == GearKind::Internal;
    let outlines = [body(&a.chains, false), body(&b.chains, ring)];
    let facts = rolled.fit.pitch.curve().facts();
    let module_mm = rolled.fit.pitch.teeth().module_mm;
    let beside = WINDOW_MODULES.map(|modules| modules * module_mm);
    let low = DVec2::new(facts.smallest_radius_mm - beside[0], -0.5 * beside[1]);
    let high = DVec2::new(facts.largest_radius_mm + beside[0], 0.5 * beside[1]);
    let stage = watch.stage(PICTURES, count, "frames")?;
    let frames = (0..count).into_par_iter().map(|k| {
        stage.count()?;
        let moment = &rolled.period.moments[k * per_frame];
        let section = &rolled.meshing.sections[middle];
        let stand = rolled.meshing.stand(&moment.pitch, section, 0.0);
        let angle_2 = stand.sign * (stand.phi_2_rad + moment.right.error_rad);
        let [off_1, off_2] = rolled.meshing.eccentricity_mm;
        let placed = |polygons: &[Vec<DVec2>], off: DVec2, angle: f64, axis: DVec2| {
            let turn = DVec2::from_angle(angle);
            let place = |p: &DVec2| turn.rotate(*p + off) + axis;
            polygons.iter().map(|polygon| polygon.iter().map(place).collect()).collect::<Vec<Vec<DVec2>>>()
        };
        let near = |pair: &&crate::pair::assembly::ToothTouch| {
            gap_um(&rolled.meshing, moment, Side::Right, pair) <= marking_um && pair.section == middle
        };
        let ratio = moment.pitch.radius_mm[1] / moment.pitch.radius_mm[0];
        RollingPicture {
            areas: vec![
                (COLOUR_B, placed(&outlines[1], off_2, angle_2, stand.axis_2_mm)),
                (COLOUR_A, placed(&outlines[0], off_1, -stand.phi_1_rad, DVec2::ZERO)),
            ],
            marks_mm: moment.right.pairs.iter().filter(near).map(|pair| pair.touch.point_mm).collect(),
            mark_colour: CONTACT_COLOUR,
            window_mm: [low, high],
            width_px: FRAME_WIDTH_PX,
            words: format!("A (left) at {:.1}°, ratio {ratio:.3}", moment.pitch.phi_1_rad.to_degrees()),
        }
        .frame()
    });
    let frames = frames.collect::<Result<Vec<_>>>()?;
    stage.finish();
    let name = "pictures/rolling.apng".to_owned();
    write_apng(&folder.path(&name)?, &frames, FRAME_MS, FRAME_MS)?;
    Ok(name)
}

/// The section of a gear: flanks joined over tips and roots; a ring with a circle round it.
fn body(chains: &GearFlanks<FlankChain>, ring: bool) -> Vec<Vec<DVec2>> {
    let mut flanks: Vec<(f64, Vec<DVec2>)> = Vec::new();
    for side in SIDES {
        for label in 0..chains.right.len() as i64 {
            let chain = chains.get(side, label);
            let angle = chain.at(0.5 * chain.last()).to_angle();
            flanks.push((angle, thinned(&chain.points_mm)));
        }
    }
    // Round the gear flanks stand with the tip first and the root first by turns.
    flanks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends = |i: usize| (flanks[i].1[0], flanks[i].1[flanks[i].1.len() - 1]);
    let tips_meet = ends(0).1.distance(ends(1).1) < ends(0).0.distance(ends(1).0);
    let outline = flanks.iter().enumerate().flat_map(|(i, (_, points))| {
        let upward = (i % 2 == 0) == tips_meet;
        let mut points = points.clone();
        if !upward {
            points.reverse();
        }
        points
    });
    let mut polygons = vec![outline.collect::<Vec<DVec2>>()];
    if ring {
        let reach_mm = polygons[0].iter().map(|p| p.length()).fold(0.0, f64::max);
        polygons.push((0..360).map(|i| 1.2 * reach_mm * DVec2::from_angle(TAU * f64::from(i) / 360.0)).collect());
    }
    polygons
}

/// Points far enough apart to be told from each other.
fn thinned(points_mm: &[DVec2]) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::new();
    for (i, point) in points_mm.iter().enumerate() {
        if i + 1 == points_mm.len() || kept.last().is_none_or(|last| last.distance(*point) > DRAWN_MM) {
            kept.push(*point);
        }
    }
    kept
}

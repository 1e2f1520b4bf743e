//! A hobbing program ready for a control: what the operator must know, then the lines.

use super::program::{Gearbox, digits};
use crate::findings::Notice;
use crate::gcode::{AxisColumn, Script, StraightLine};
use crate::machine::Axis;
use crate::number_text::{plain, significant};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::commanded::{HobbingKnot, HobbingProgram};
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::AXES;
use crate::process::hobbing::scene::model::HobbingKind;
use gearcut_core::units::UM_PER_MM;

/// Room between hob and blank before and after a program, mm.
const CLEAR_MM: f64 = 2.0;

/// A program, with everything in its head that the operator must know.
pub fn script(
    job: &HobbingJob,
    operation: &PreparedHobbing,
    program: &HobbingProgram,
    gearbox: Option<&Gearbox>,
    (reached_mm, time_s): (f64, f64),
    warnings: &[Notice],
) -> Script {
    let (output, linkage, spec) = (&job.scene.output, &operation.linkage, &job.scene.gear);
    let g = linkage.geometry();
    let diagonal = matches!(operation.spec.kind, HobbingKind::Diagonal { .. });
    let hand = |sign: f64| if sign > 0.0 { "right" } else { "left" };
    let mut head = vec![
        format!("gearcut {}: operation {} of {}", env!("CARGO_PKG_VERSION"), operation.spec.name, job.scene.name),
        "UNITS mm and deg; G90 absolute; G93 inverse time, F = 1 / minutes of the block".to_owned(),
        "AXES X tangential, Y radial, Z slide along the work, B hob spindle, C work spindle".to_owned(),
        "SIGNS Z along the rotation vector of the work; Y out of the work towards the hob; X completes them to a \
        right-hand frame; C counter-clockwise seen against Z; B in the cutting direction".to_owned(),
        "ZERO X0 Y0: the pitch point of the hob on the axis of the work; Z0: the axis of the hob crosses the middle of \
        the face; C0: polar angle 0 of the gear points along +Y; B0: a gash looks at the work".to_owned(),
        format!(
            "SET UP hob {} start, {}-hand, module {} mm, {} gashes, lead angle {:.6} deg, pitch radius {:.6} mm: \
            the axis of the hob stands at Y + pitch radius",
            g.starts,
            hand(g.hob_hand),
            plain(g.module_mm),
            job.hob.gashes,
            g.lead_angle_rad.to_degrees(),
            g.pitch_radius_mm
        ),
        format!("SET UP head swivelled so that the axis of the hob stands at {:.6} deg against X, positive from +X \
            towards +Z", g.head_angle_rad.to_degrees()),
        format!(
            "GEAR z {} normal module {} mm, helix {:.6} deg {}-hand, face {} mm",
            spec.teeth,
            plain(spec.module_mm),
            spec.helix_angle_rad.to_degrees(),
            hand(g.gear_hand),
            plain(spec.face_width_mm)
        ),
        format!(
            "CONTOUR at most {} um at the hob in the work asked, {} um reached at {time_s:.3} s",
            plain(output.gcode_contour_error_mm * UM_PER_MM),
            significant(reached_mm * UM_PER_MM, 6)
        ),
    ];
    if diagonal {
        head.push(
            "AXES W shift along the axis of the hob, positive along its projection on +X; W0: its middle at the \
            pitch point"
                .to_owned(),
        );
    } else {
        head.push(format!(
            "SET UP shift at {:.6} mm, the middle of the hob against the pitch point",
            program.knots[0].axes[5]
        ));
    }
    head.push(match gearbox {
        None => "FORM every axis interpolated; no gearbox may be active".to_owned(),
        Some(_) => "FORM electronic gearbox: the control couples C to B, Z and W; the word C is what is added to the \
            coupling: the variation of a gear that is not round"
            .to_owned(),
    });
    if let Some(gearbox) = gearbox {
        head.push(format!(
            "SET UP gearbox C = {:.15} B {:+.15} Z {:+.15} W, deg per deg and deg per mm; switch it on before the \
            first block, at the positions of the first block",
            gearbox.per_hob,
            gearbox.per_slide.to_degrees(),
            gearbox.per_shift.to_degrees()
        ));
        if !diagonal {
            head.push(format!(
                "SET UP W in the gearbox is the shift above, {:.6} mm, and stays",
                program.knots[0].axes[5]
            ));
        }
    }
    head.push(
        "The first position is clear of the work; clamping, coolant and the way there are the operator's".to_owned(),
    );
    let digits = digits(job, output.gcode_contour_error_mm);
    // What is left when the gearbox's share is taken off is no round number: digits enough for all three words
    // together.
    let work_digits = if gearbox.is_some() { digits.angle + 2 } else { digits.angle };
    let order: Vec<usize> = [2, 3, 4].into_iter().chain(diagonal.then_some(5)).chain([0, 1]).collect();
    let column = |&axis: &usize| {
        let Axis { letter, kind, .. } = AXES[axis];
        AxisColumn { letter, kind, digits: if axis == 1 { work_digits } else { digits.of(kind) } }
    };
    let position =
        |knot: &HobbingKnot| order.iter().map(|&axis| AXES[axis].kind.shown(knot.axes[axis])).collect::<Vec<_>>();
    let line = |pair: &[HobbingKnot]| StraightLine {
        to: position(&pair[1]),
        per_minute: 60.0 / (pair[1].time_s - pair[0].time_s),
    };
    head.extend(warnings.iter().map(Notice::line));
    let before = job.operations.iter().take_while(|before| before.spec.name != operation.spec.name).count();
    let [full, geared] = program_numbers(before);
    let gearbox_words = if gearbox.is_some() { " gearbox" } else { "" };
    Script {
        name: format!("{}{gearbox_words}", operation.spec.name),
        number: if gearbox.is_some() { geared } else { full },
        head,
        columns: order.iter().map(column).collect(),
        // The radial axis.
        clear: (1, clear_mm(job)),
        ram: None,
        start: position(&program.knots[0]),
        lines: program.knots.windows(2).map(line).collect(),
        contour_error_mm: output.gcode_contour_error_mm,
    }
}

/// Numbers of both programs of an operation among those of its scene: fully interpolated, and with a gearbox.
pub fn program_numbers(operation: usize) -> [u32; 2] {
    let first = 2 * operation as u32 + 1;
    [first, first + 1]
}

/// Place of the hob's pitch plane at which it is clear of the blank, however that is turned.
fn clear_mm(job: &HobbingJob) -> f64 {
    let tip_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
    (job.curve.facts().largest_radius_mm + job.stock.addendum_mm + tip_mm + CLEAR_MM).ceil()
}

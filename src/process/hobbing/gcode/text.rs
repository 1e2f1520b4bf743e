//! A hobbing program as text: what the operator must know, then the blocks.

use super::program::{Gearbox, HobbingKnot, HobbingProgram, digits};
use crate::findings::Warning;
use crate::gcode::{ProgramText, axis_word};
use crate::output::text::{plain, significant};
use crate::process::hobbing::HobbingJob;
use crate::process::hobbing::job::PreparedHobbing;
use crate::process::hobbing::linkage::dynamics::AXES;
use crate::process::hobbing::scene::model::HobbingKind;
use gearcut_core::units::UM_PER_MM;

/// The text of a program, with everything in its head that the operator must know.
pub fn text(
    job: &HobbingJob,
    operation: &PreparedHobbing,
    program: &HobbingProgram,
    gearbox: Option<&Gearbox>,
    (reached_mm, time_s): (f64, f64),
    warnings: &[Warning],
) -> String {
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
    let position = |knot: &HobbingKnot| {
        let word = |axis: usize| axis_word(&AXES[axis], knot.axes[axis], digits.of(AXES[axis].kind));
        let mut words: Vec<String> = [2, 3, 4].map(word).into();
        words.extend(diagonal.then(|| word(5)));
        words.extend([word(0), axis_word(&AXES[1], knot.axes[1], work_digits)]);
        words.join(" ")
    };
    let mut text = ProgramText::new(&head, warnings.iter().map(Warning::line));
    text.block("G21 G90 G94");
    text.block(&format!("G0 {}", position(&program.knots[0])));
    for pair in program.knots.windows(2) {
        let per_minute = 60.0 / (pair[1].time_s - pair[0].time_s);
        text.block(&format!("G93 G1 {} F{per_minute:.9}", position(&pair[1])));
    }
    text.block("M30");
    text.finish()
}

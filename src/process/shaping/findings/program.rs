//! A program under test: how far it lies off the scene's own strokes, and which strokes it leaves out.
//!
//! In: what [`crate::process::shaping::motion::gcode::judge`] found. Out: a section of the operation, the sentences of
//! the list of warnings, and whether numbers that are known of the scene's own strokes hold for the gear that is cut.

use crate::findings::notices::ProgramOff;
use crate::findings::quantities::program::{LARGEST_DISTANCE, PROGRAM};
use crate::findings::{Notice, Place, QuantityRow, Section};
use crate::measure::damage::gouge_mm;
use crate::number_text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::gear::measure::GearReport;
use crate::process::shaping::motion::gcode::Judgement;
use crate::process::shaping::notices::{
    ProgramBack, ProgramBetween, ProgramForeign, ProgramMissing, ProgramSpeed, ProgramTwice,
};
use crate::process::shaping::quantities::{
    DISTANCE_BETWEEN, DOUBLED_STROKES, MISSING_STROKES, SCENE_STROKES_PER_MINUTE, SHORT_OF_DRAWN_BACK, STROKES_OFF,
    STROKES_PER_MINUTE,
};
use crate::steps::axes::AxesOfOperation as _;
use gearcut_core::units::UM_PER_MM;

/// Why what is known of whole flanks alone is not known of a tooth.
pub const NOT_WHOLE: &str = "a flank of the tooth is cut away";

/// The section; none where the operation is cut by the scene's own strokes.
pub fn section(motion: &OperationAxes) -> Option<Section> {
    let judgement = motion.program()?;
    let Judgement { distance_mm, distance_at, between_mm, between_at, missing, doubled, off, .. } = judgement;
    let at = |stroke: f64| Place::default().and("stroke", stroke);
    let count = |row: &QuantityRow, of: &[usize]| {
        row.of(of.len()).at(of.first().map(|&first| Place::default().and("stroke", first as u64)))
    };
    let [program, scene] = judgement.strokes_per_minute;
    let back = judgement.back.map(|back| SHORT_OF_DRAWN_BACK.of(UM_PER_MM * back.short_mm).at(at(back.at)));
    let section = PROGRAM.section(back).entries([
        LARGEST_DISTANCE.of(UM_PER_MM * distance_mm).at(at(*distance_at)),
        DISTANCE_BETWEEN.of(UM_PER_MM * between_mm).at(at(*between_at)),
        count(&MISSING_STROKES, missing),
        count(&DOUBLED_STROKES, doubled),
        count(&STROKES_OFF, off),
        STROKES_PER_MINUTE.of(program),
        SCENE_STROKES_PER_MINUTE.of(scene),
    ]);
    Some(section)
}

/// Whether what is known of the scene's own strokes holds for the gear that is cut: a reason where it does not.
pub fn not_of_the_gear(job: &ShapingJob, motion: &[OperationAxes]) -> Option<String> {
    let distance_mm = |operation: &OperationAxes| operation.program().map_or(0.0, |program| program.distance_mm);
    let others = motion.iter().filter_map(|of| Some((distance_mm(of), not_of_the_operation(job, of)?)));
    others.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, why)| why)
}

/// The same of the gear after the run: flanks that are cut away have neither the ends nor the tips of the scene's own.
pub fn not_of_the_cut_gear(job: &ShapingJob, motion: &[OperationAxes], report: &GearReport) -> Option<String> {
    let lost = report.lost();
    not_of_the_gear(job, motion).or_else(|| {
        (lost > 0)
            .then(|| format!("known of whole flanks alone; {lost} of {} flanks are cut away", report.flanks.len()))
    })
}

/// The same of one operation, whatever the others do: a program that lies off its strokes, leaves some of them out or
/// makes others.
pub fn not_of_the_operation(job: &ShapingJob, motion: &OperationAxes) -> Option<String> {
    let judgement = motion.program()?;
    let lies_off = judgement.is_off(job.scene.output.gcode_contour_error_mm);
    let (missing, off) = (judgement.missing.len(), judgement.off.len());
    let told = [
        (lies_off, format!("lies up to {} mm off them", significant(judgement.distance_mm, 3))),
        (missing > 0, format!("leaves out {missing} of them")),
        (off > 0, format!("makes {off} that {} none of them", if off == 1 { "is" } else { "are" })),
    ];
    let told: Vec<String> = told.into_iter().filter_map(|(is_so, words)| is_so.then_some(words)).collect();
    (!told.is_empty()).then(|| {
        let name = motion.name();
        let told = told.join(" and ");
        format!("known of the scene's own strokes alone; the program of {name} that cuts this gear {told}")
    })
}

/// What a reader must know of the programs under test.
pub fn warnings(job: &ShapingJob, motion: &[OperationAxes]) -> Vec<Notice> {
    let of = |operation: &OperationAxes| operation.program().map(|program| told(job, operation, program));
    motion.iter().filter_map(of).flatten().collect()
}

fn told(job: &ShapingJob, motion: &OperationAxes, judgement: &Judgement) -> Vec<Notice> {
    let (name, mut warnings) = (motion.name(), Vec::new());
    let gouges = |mm: f64| mm > gouge_mm(job.scene.gear.module_mm);
    let asked_mm = job.scene.output.gcode_contour_error_mm;
    let distance_mm = judgement.distance_mm;
    if judgement.is_off(asked_mm) {
        let off = ProgramOff {
            operation: name,
            distance_um: significant(UM_PER_MM * distance_mm, 4),
            of: "strokes",
            place: format!("stroke {}", significant(judgement.distance_at, 6)),
            asked_um: significant(UM_PER_MM * asked_mm, 3),
        };
        warnings.push(off.notice().fault_where(gouges(distance_mm)));
    }
    // Between strokes the cutter is drawn back: the nearest flank is this far away.
    let clearance_mm = motion.relief().clearance_mm(job.machine.back_off_mm).max(0.0);
    let scraping_mm = judgement.between_mm - clearance_mm;
    if scraping_mm > asked_mm {
        let between = ProgramBetween {
            operation: name,
            distance_um: significant(UM_PER_MM * judgement.between_mm, 4),
            stroke: significant(judgement.between_at, 6),
            clearance_um: significant(UM_PER_MM * clearance_mm, 3),
        };
        warnings.push(between.notice().fault_where(gouges(scraping_mm)));
    }
    if let Some(back) = judgement.falls_short(asked_mm) {
        let back_off = ProgramBack {
            operation: name,
            short_um: significant(UM_PER_MM * back.short_mm, 4),
            asked_um: significant(UM_PER_MM * back.asked_mm, 4),
            stroke: significant(back.at, 6),
            so: if back.drags() {
                "it drags over the flanks: draw back before the return stroke enters the face, and come in after it \
                 has left it"
            } else {
                "it clears the flanks by less than the scene says"
            },
        };
        warnings.push(back_off.notice().fault_where(back.drags()));
    }
    // How many, with the verb, and which is the first.
    let counted = |strokes: &[usize], one: &str, several: &str| {
        let count = strokes.len();
        let first = strokes.first()?;
        Some(if count == 1 {
            (format!("1 {one}"), format!("stroke {first}"))
        } else {
            (format!("{count} {several}"), format!("the first is stroke {first}"))
        })
    };
    let operation = name;
    if let Some((strokes, first)) =
        counted(&judgement.missing, "of the scene's strokes is", "of the scene's strokes are")
    {
        warnings.push(ProgramMissing { operation, strokes, first }.notice());
    }
    let of_program = |strokes: &[usize]| counted(strokes, "stroke of the program is", "strokes of the program are");
    if let Some((strokes, first)) = of_program(&judgement.doubled) {
        warnings.push(ProgramTwice { operation, strokes, first }.notice());
    }
    if let Some((strokes, first)) = of_program(&judgement.off) {
        warnings.push(ProgramForeign { operation, strokes, first }.notice());
    }
    if judgement.is_at_another_speed() {
        let [program_per_minute, scene_per_minute] = judgement.strokes_per_minute.map(|rate| significant(rate, 6));
        warnings.push(ProgramSpeed { operation, program_per_minute, scene_per_minute }.notice());
    }
    warnings
}

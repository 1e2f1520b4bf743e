//! G-code for a five- or six-axis CNC hobbing machine: written from a linkage, and read back into axis positions.
//!
//! In: a prepared operation and the **contour error**, the largest displacement of the hob in the work that straight lines may cause where both meet. Out: two texts, and from any such text the axes at every
//! moment ([`read`]).
//!
//! | word | axis | unit |
//! | --- | --- | --- |
//! | X | tangential: pitch point against the work's axis, along the rack | mm |
//! | Y | radial: pitch plane of the hob against the work's axis, infeed included | mm |
//! | Z | slide along the work's axis, 0 in the middle of the face | mm |
//! | W | shift along the hob's axis, 0 with its middle at the pitch point; diagonal hobbing only | mm |
//! | B | hob spindle in the cutting direction | deg |
//! | C | work spindle, counter-clockwise seen against Z | deg |
//!
//! **Fully interpolated**: every block is a straight line in all axes, in inverse time (`G93`). **With an electronic gearbox**: the control itself couples the work to hob, slide and shift as it does for a round gear,
//! `C = k_B B + k_Z Z + k_W W`, the rolling of a circle as long as the pitch curve; the word C then commands what is added to it, the variation of a gear that is not round. Its digits stay few and the
//! synchronism of hob and work no longer hangs on the interpolation.
//!
//! Road not taken: cycles of single controls. Their names and parameters differ from maker to maker; the coupling's three numbers stand in the head of the program instead.

use crate::gcode::program::{Digits, longest_lines};
use crate::gcode::read::{Word, blocks};
use crate::gcode::write::ProgramText;
use crate::job::HobbingJob;
use crate::job::hobbing::PreparedHobbing;
use crate::linkage::HobbingLinkage;
use crate::linkage::hobbing::{HobbingGeometry, work_from_machine_at};
use crate::output::atomic::write_bytes_atomically;
use crate::output::folder::OutputFolder;
use crate::output::text::{plain, significant};
use crate::scene::model::{GcodeDialect, HobbingAxisLimits, HobbingKind};
use crate::units::{TURN_RAD, UM_PER_MM};
use glam::DVec3;
use rayon::prelude::*;
use std::fmt::Write as _;

/// Shortest block, s: what block buffers of older controls keep up with.
const SHORTEST_S: f64 = 1e-3;
/// Blocks in a cycle along the pitch curve are no shorter than this share of it.
const SHARE_OF_CYCLE: f64 = 1.0 / 1440.0;
/// Places within the shortest block at which a program is held against its linkage.
const SAMPLES: usize = 2;
/// Share of the contour error that the samples may show, so that what lies between them stays below all of it.
const SAMPLED_SHARE: f64 = 0.95;
/// Axis letters in the order hob, work, tangential, radial, slide, shift.
const LETTERS: [char; 6] = ['B', 'C', 'X', 'Y', 'Z', 'W'];
/// Names of the axes in that order.
const NAMES: [&str; 6] = ["hob spindle", "work spindle", "tangential axis", "radial axis", "slide", "shift"];

/// Positions of hob (rad), work (rad), tangential, radial with infeed, slide and shift (mm).
pub type Positions = [f64; 6];

/// Axes at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HobbingKnot {
    /// Time from the first knot, s.
    pub time_s: f64,
    /// Where the axes stand.
    pub axes: Positions,
}

/// A program: straight lines between knots in order of time, the first at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbingProgram {
    /// At least one.
    pub knots: Vec<HobbingKnot>,
}

/// What an electronic gearbox adds to the work's angle, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gearbox {
    /// Work per hob angle: starts over teeth.
    pub per_hob: f64,
    /// Work per slide, rad/mm: the helix.
    pub per_slide: f64,
    /// Work per shift, rad/mm.
    pub per_shift: f64,
}

impl Gearbox {
    /// Of a linkage: a circle as long as its pitch curve rolls on the hob's rack.
    pub fn new(linkage: &HobbingLinkage) -> Self {
        let (g, per_arc) = (linkage.geometry(), TURN_RAD / linkage.curve().perimeter_mm());
        Self {
            per_hob: per_arc * g.arc_per_hob_rad_mm(),
            per_slide: per_arc * g.arc_per_slide(),
            per_shift: per_arc * g.arc_per_shift(),
        }
    }

    /// Angle of the work that the gearbox gives, rad.
    pub fn work_rad(&self, axes: &Positions) -> f64 {
        self.per_hob * axes[0] + self.per_slide * axes[4] + self.per_shift * axes[5]
    }
}

/// Points of the hob that can be in the work, machine frame at the pitch point, mm.
struct ContactZone {
    geometry: HobbingGeometry,
    points_mm: Vec<DVec3>,
}

impl ContactZone {
    fn new(job: &HobbingJob, operation: &PreparedHobbing) -> Self {
        let geometry = *operation.linkage.geometry();
        let along_mm = operation.plan.contact_half_length_mm;
        let tip_mm = job.hob.tip_radius_mm - job.hob.pitch_radius_mm;
        let points_mm = [-along_mm, 0.0, along_mm]
            .into_iter()
            .flat_map(|along| [-tip_mm, job.blank.addendum_mm].map(|y| along * geometry.hob_axis() + y * DVec3::Y))
            .collect();
        Self { geometry, points_mm }
    }

    /// Largest displacement of these points of the hob in the work between two positions, mm.
    fn displacement_mm(&self, exact: &Positions, other: &Positions) -> f64 {
        let [a, b] = [exact, other].map(|&[hob, work, x, y, slide, shift]| {
            // Infeed counts in Y: the pitch plane stands where the program says.
            let machine_from_tool = self.geometry.machine_from_tool(hob, 0.0, slide, shift);
            (work_from_machine_at(work, x, y).after(&machine_from_tool), machine_from_tool)
        });
        let tool_from_machine = a.1.inverse();
        let stand_mm = DVec3::new(0.0, 0.0, exact[4]);
        self.points_mm
            .iter()
            .map(|&point| tool_from_machine.point(point + stand_mm))
            .map(|point| a.0.point(point).distance(b.0.point(point)))
            .fold(0.0, f64::max)
    }

    /// Distance from the axes of rotation that matters to their digits, mm.
    fn reach_mm(job: &HobbingJob) -> f64 {
        (job.curve.facts().largest_radius_mm + job.blank.addendum_mm).max(job.hob.tip_radius_mm)
    }
}

fn exact(linkage: &HobbingLinkage, time_s: f64) -> Positions {
    let axes = linkage.axes::<1>(time_s);
    [
        axes.hob_rad.value(),
        axes.work_rad.value(),
        axes.x_mm.value(),
        axes.y_mm.value() + axes.radial_mm.value(),
        axes.slide_mm.value(),
        axes.shift_mm.value(),
    ]
}

fn between(a: &HobbingKnot, b: &HobbingKnot, time_s: f64) -> Positions {
    let share = if b.time_s > a.time_s { (time_s - a.time_s) / (b.time_s - a.time_s) } else { 0.0 };
    std::array::from_fn(|i| a.axes[i] + share * (b.axes[i] - a.axes[i]))
}

/// Positions as they will be written.
fn rounded(axes: &Positions, digits: Digits) -> Positions {
    std::array::from_fn(|i| {
        if i < 2 {
            Digits::round(axes[i].to_degrees(), digits.angle).to_radians()
        } else {
            Digits::round(axes[i], digits.length)
        }
    })
}

impl HobbingProgram {
    /// Longest straight lines, one after the other, that keep the hob within `contour_error_mm` of the operation's linkage, as far as the shortest blocks can. Feeds begin and end at knots.
    pub fn fit(job: &HobbingJob, operation: &PreparedHobbing, contour_error_mm: f64) -> Self {
        let linkage = &operation.linkage;
        let zone = ContactZone::new(job, operation);
        let digits = Digits::new(contour_error_mm, ContactZone::reach_mm(job));
        let shortest_s = SHORTEST_S.max(SHARE_OF_CYCLE * linkage.cycle_s());
        let sampled_mm = SAMPLED_SHARE * contour_error_mm;
        let mut knots: Vec<HobbingKnot> = Vec::new();
        for corner in linkage.corners_s().windows(2) {
            let [from_s, to_s] = [corner[0], corner[1]];
            let blocks = ((to_s - from_s) / shortest_s).floor().max(1.0) as usize;
            let time = |sample: usize| from_s + (to_s - from_s) * sample as f64 / (blocks * SAMPLES) as f64;
            let samples: Vec<HobbingKnot> = (0..=blocks * SAMPLES)
                .into_par_iter()
                .map(|sample| HobbingKnot { time_s: time(sample), axes: exact(linkage, time(sample)) })
                .collect();
            let written = |block: usize| {
                let knot = samples[block * SAMPLES];
                HobbingKnot { axes: rounded(&knot.axes, digits), ..knot }
            };
            let fits = |from: usize, to: usize| {
                let (a, b) = (written(from), written(to));
                samples[from * SAMPLES..=to * SAMPLES]
                    .iter()
                    .all(|knot| zone.displacement_mm(&knot.axes, &between(&a, &b, knot.time_s)) <= sampled_mm)
            };
            if knots.is_empty() {
                knots.push(written(0));
            }
            knots.extend(longest_lines(blocks, fits).into_iter().map(written));
        }
        Self { knots }
    }

    /// Where the axes stand at a time; before the first and after the last knot the motion is continued.
    pub fn at(&self, time_s: f64) -> Positions {
        let after = self.knots.partition_point(|k| k.time_s <= time_s).clamp(1, self.knots.len().max(2) - 1);
        self.knots.get(after).map_or(self.knots[0].axes, |b| between(&self.knots[after - 1], b, time_s))
    }

    /// Largest displacement of the hob from an operation's linkage, mm, and when, s.
    pub fn contour_error_mm(&self, job: &HobbingJob, operation: &PreparedHobbing) -> (f64, f64) {
        let (linkage, zone) = (&operation.linkage, ContactZone::new(job, operation));
        let shortest_s = SHORTEST_S.max(SHARE_OF_CYCLE * linkage.cycle_s());
        let count = (linkage.end_s() / shortest_s * SAMPLES as f64).ceil() as u32;
        (0..=count)
            .into_par_iter()
            .map(|i| {
                let time_s = linkage.end_s() * f64::from(i) / f64::from(count);
                (zone.displacement_mm(&exact(linkage, time_s), &self.at(time_s)), time_s)
            })
            .reduce(|| (0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }

    /// What the program asks beyond the machine's limits: speeds within blocks, and steps of speed between blocks over the mean of their times. Where feeds begin, change and end, at `corners_s`, the control's own
    /// ramps hold.
    pub fn exceeded(&self, limits: &HobbingAxisLimits, corners_s: &[f64]) -> Vec<String> {
        let mut exceeded = Vec::new();
        for (axis, name) in NAMES.iter().enumerate() {
            let speeds: Vec<(f64, f64, f64)> = self
                .knots
                .windows(2)
                .map(|pair| (pair[0].time_s, pair[1].time_s, pair))
                .map(|(from, to, pair)| (from, to, (pair[1].axes[axis] - pair[0].axes[axis]) / (to - from)))
                .collect();
            let largest = speeds.iter().fold(0.0_f64, |most, (.., speed)| most.max(speed.abs()));
            let ramp = |time: f64| corners_s.iter().any(|corner| (corner - time).abs() < 1e-9);
            let step = speeds
                .windows(2)
                .filter(|pair| !ramp(pair[1].0))
                .map(|pair| 2.0 * (pair[1].2 - pair[0].2).abs() / (pair[1].1 - pair[0].0))
                .fold(0.0, f64::max);
            let (unit, shown): (&str, fn(f64) -> f64) = if axis < 2 { ("deg", f64::to_degrees) } else { ("mm", |v| v) };
            for (value, limit, per) in
                [(largest, limits.speeds[axis], "/s"), (step, limits.accelerations[axis], "/s^2")]
            {
                if let Some(limit) = limit.filter(|&limit| value > limit) {
                    exceeded.push(format!(
                        "the {name} needs {:.4} {unit}{per}, the machine allows {:.4}",
                        shown(value),
                        shown(limit)
                    ));
                }
            }
        }
        exceeded
    }

    /// The same program with the gearbox's share taken off the work's angle, or with `sign` = 1 put back on.
    fn geared(&self, gearbox: &Gearbox, sign: f64) -> Self {
        let mut program = self.clone();
        for knot in &mut program.knots {
            knot.axes[1] += sign * gearbox.work_rad(&knot.axes);
        }
        program
    }

    /// Axes of a program that commands only what is added to the gearbox.
    #[must_use]
    pub fn with_gearbox(&self, gearbox: &Gearbox) -> Self {
        self.geared(gearbox, 1.0)
    }
}

/// Writes both programs of all operations as `axes/<operation>.ngc` and `axes/<operation>_gearbox.ngc`; gives a sentence for each operation that has none.
///
/// # Errors
/// Files that cannot be written.
pub fn write_all(job: &HobbingJob, folder: &OutputFolder) -> crate::Result<Vec<String>> {
    let mut left_out = Vec::new();
    for operation in &job.operations {
        let name = &operation.spec.name;
        match texts(job, operation) {
            Some(Ok([full, geared])) => {
                write_bytes_atomically(&folder.path(format!("axes/{name}.ngc"))?, full.as_bytes())?;
                write_bytes_atomically(&folder.path(format!("axes/{name}_gearbox.ngc"))?, geared.as_bytes())?;
            }
            Some(Err(why)) => left_out.push(format!("operation {name}: no G-code written: {why}")),
            None => {}
        }
    }
    Ok(left_out)
}

/// Both programs of an operation, fully interpolated and with a gearbox; an error is the reason why there are none, `None`: none are wanted.
pub fn texts(job: &HobbingJob, operation: &PreparedHobbing) -> Option<Result<[String; 2], String>> {
    match job.scene.output.gcode {
        GcodeDialect::None => None,
        GcodeDialect::PaperG84 => {
            Some(Err("the one-block form of the literature is for shaping; use gcode = \"linear\"".to_owned()))
        }
        GcodeDialect::Linear => Some(linear(job, operation)),
    }
}

fn linear(job: &HobbingJob, operation: &PreparedHobbing) -> Result<[String; 2], String> {
    let linkage = &operation.linkage;
    if linkage.law().is_as_printed() {
        return Err(
            "the linkage as printed parts work and carriage on a curve that is no circle; it is for comparison only"
                .to_owned(),
        );
    }
    let asked_mm = job.scene.output.gcode_contour_error_mm;
    let program = HobbingProgram::fit(job, operation, asked_mm);
    let (reached_mm, time_s) = program.contour_error_mm(job, operation);
    if reached_mm > asked_mm {
        return Err(format!(
            "blocks of {} ms leave a contour error of {} um at {time_s:.3} s, {} um are asked; ask for no less, or lower hob_speed_per_minute",
            significant(1e3 * SHORTEST_S.max(SHARE_OF_CYCLE * linkage.cycle_s()), 3),
            significant(reached_mm * UM_PER_MM, 3),
            plain(asked_mm * UM_PER_MM),
        ));
    }
    if let Some(first) = program.exceeded(&job.limits, &linkage.corners_s()).first() {
        return Err(format!("{first}; lower hob_speed_per_minute, or take another even_motion"));
    }
    let gearbox = Gearbox::new(linkage);
    let geared = program.geared(&gearbox, -1.0);
    Ok([(&program, None), (&geared, Some(&gearbox))]
        .map(|(program, gearbox)| text(job, operation, program, gearbox, (reached_mm, time_s))))
}

/// The text of a program, with everything in its head that the man at the machine must know.
fn text(
    job: &HobbingJob,
    operation: &PreparedHobbing,
    program: &HobbingProgram,
    gearbox: Option<&Gearbox>,
    (reached_mm, time_s): (f64, f64),
) -> String {
    let (output, linkage, spec) = (&job.scene.output, &operation.linkage, &job.scene.gear);
    let g = linkage.geometry();
    let diagonal = matches!(operation.spec.kind, HobbingKind::Diagonal { .. });
    let hand = |sign: f64| if sign > 0.0 { "right" } else { "left" };
    let mut head = vec![
        format!("gearcut {}: operation {} of {}", env!("CARGO_PKG_VERSION"), operation.spec.name, job.scene.name),
        "UNITS mm and deg; G90 absolute; G93 inverse time, F = 1 / minutes of the block".to_owned(),
        "AXES X tangential, Y radial, Z slide along the work, B hob spindle, C work spindle".to_owned(),
        "SIGNS Z along the rotation vector of the work; Y out of the work towards the hob; X completes them to a right-hand frame; C counter-clockwise seen against Z; B in the cutting direction".to_owned(),
        "ZERO X0 Y0: the pitch point of the hob on the axis of the work; Z0: the axis of the hob crosses the middle of the face; C0: polar angle 0 of the gear points along +Y; B0: a gash looks at the work".to_owned(),
        format!("SET UP hob {} start, {}-hand, module {} mm, {} gashes, lead angle {:.6} deg, pitch radius {:.6} mm: the axis of the hob stands at Y + pitch radius", g.starts, hand(g.hob_hand), plain(g.module_mm), job.hob.gashes, g.lead_angle_rad.to_degrees(), g.pitch_radius_mm),
        format!("SET UP head swivelled so that the axis of the hob stands at {:.6} deg against X, positive from +X towards +Z", g.head_angle_rad.to_degrees()),
        format!("GEAR z {} normal module {} mm, helix {:.6} deg {}-hand, face {} mm", spec.teeth, plain(spec.module_mm), spec.helix_angle_rad.to_degrees(), hand(g.gear_hand), plain(spec.face_width_mm)),
        format!("CONTOUR at most {} um at the hob in the work asked, {} um reached at {time_s:.3} s", plain(output.gcode_contour_error_mm * UM_PER_MM), significant(reached_mm * UM_PER_MM, 6)),
    ];
    if diagonal {
        head.push("AXES W shift along the axis of the hob, positive along its projection on +X; W0: its middle at the pitch point".to_owned());
    } else {
        head.push(format!(
            "SET UP shift at {:.6} mm, the middle of the hob against the pitch point",
            program.knots[0].axes[5]
        ));
    }
    head.push(match gearbox {
        None => "FORM every axis interpolated; no gearbox may be active".to_owned(),
        Some(_) => "FORM electronic gearbox: the control couples C to B, Z and W; the word C is what is added to the coupling: the variation of a gear that is not round".to_owned(),
    });
    if let Some(gearbox) = gearbox {
        head.push(format!(
            "SET UP gearbox C = {:.15} B {:+.15} Z {:+.15} W, deg per deg and deg per mm; switch it on before the first block, at the positions of the first block",
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
    let digits = Digits::new(output.gcode_contour_error_mm, ContactZone::reach_mm(job));
    // What is left when the gearbox's share is taken off is no round number: digits enough for all three words together.
    let work_digits = if gearbox.is_some() { digits.angle + 2 } else { digits.angle };
    let position = |knot: &HobbingKnot| {
        // Negated zeros read as nonsense.
        let clean = |value: f64| if value == 0.0 { 0.0 } else { value };
        let mut words = format!(
            "X{:.*} Y{:.*} Z{:.*}",
            digits.length,
            clean(knot.axes[2]),
            digits.length,
            clean(knot.axes[3]),
            digits.length,
            clean(knot.axes[4])
        );
        if diagonal {
            let _ = write!(words, " W{:.*}", digits.length, clean(knot.axes[5]));
        }
        let [hob, work] = [knot.axes[0], knot.axes[1]].map(|rad| clean(rad.to_degrees()));
        let _ = write!(words, " B{hob:.*} C{work:.*}", digits.angle, work_digits);
        words
    };
    let mut text = ProgramText::new(&head);
    text.block("G21 G90 G94");
    text.block(&format!("G0 {}", position(&program.knots[0])));
    for pair in program.knots.windows(2) {
        let per_minute = 60.0 / (pair[1].time_s - pair[0].time_s);
        text.block(&format!("G93 G1 {} F{per_minute:.9}", position(&pair[1])));
    }
    text.block("M30");
    text.finish()
}

/// Axis positions of a program in this dialect: `G0` to the start, `G1` in `G93` with `F` in every block, `G21`, `G90`, `G94`, `M30`, words `N X Y Z W B C`, comments. Without W the shift is `shift_mm`.
///
/// # Errors
/// Line and word of what is malformed, unknown or missing.
pub fn read(text: &str, shift_mm: f64) -> Result<HobbingProgram, String> {
    let mut state = Reader { position: [None; 6], motion: None, inverse_time: false, knots: Vec::new(), ended: false };
    state.position[5] = Some(shift_mm);
    let (lines, ended) = blocks(text, |words| {
        state.block(words)?;
        Ok(state.ended)
    })?;
    ended?;
    if state.knots.is_empty() {
        return Err(format!("line {lines}: no axis has moved"));
    }
    Ok(HobbingProgram { knots: state.knots })
}

/// What the blocks so far have said.
struct Reader {
    /// In mm and deg.
    position: [Option<f64>; 6],
    motion: Option<u32>,
    inverse_time: bool,
    knots: Vec<HobbingKnot>,
    ended: bool,
}

impl Reader {
    fn block(&mut self, words: &[Word]) -> Result<(), String> {
        let (mut moves, mut per_minute) = (false, None);
        let mut seen = Vec::new();
        for word in words {
            let refuse = |why: &str| Err(format!("word `{}`: {why}", word.text));
            if !matches!(word.letter, 'G' | 'M') && seen.contains(&word.letter) {
                return refuse("this letter stands twice in the block");
            }
            seen.push(word.letter);
            match (word.letter, (word.number * 10.0).round() as i64) {
                ('N', _) | ('G', 210 | 900) => {}
                ('G', 0) => self.motion = Some(0),
                ('G', 10) => self.motion = Some(1),
                ('G', 930) => self.inverse_time = true,
                ('G', 940) => self.inverse_time = false,
                ('G', 200) => return refuse("inches are not read; write the program in mm (G21)"),
                ('G', 910) => return refuse("relative positions are not read; write absolute ones (G90)"),
                ('G', _) => return refuse("this G is not read; known are G0, G1, G21, G90, G93, G94"),
                ('M', 20 | 300) => self.ended = true,
                ('M', _) => return refuse("this M is not read; known are M2, M30"),
                ('F', _) if word.number > 0.0 => per_minute = Some(word.number),
                ('F', _) => return refuse("a feed must be above zero"),
                (letter, _) => match LETTERS.iter().position(|&axis| axis == letter) {
                    Some(axis) => {
                        self.position[axis] = Some(word.number);
                        moves = true;
                    }
                    None => return refuse("this letter is not read; axes are X, Y, Z, W, B and C"),
                },
            }
        }
        if moves { self.travel(per_minute) } else { Ok(()) }
    }

    fn travel(&mut self, per_minute: Option<f64>) -> Result<(), String> {
        if let Some(axis) = self.position.iter().position(Option::is_none) {
            return Err(format!("axes move before axis {} has a position", LETTERS[axis]));
        }
        let axes = std::array::from_fn(|i| {
            let value = self.position[i].unwrap_or_default();
            if i < 2 { value.to_radians() } else { value }
        });
        match (self.motion, self.knots.last()) {
            (None, _) => Err("axes move, but neither G0 nor G1 has been given".to_owned()),
            (Some(0), None) => {
                self.knots.push(HobbingKnot { time_s: 0.0, axes });
                Ok(())
            }
            (Some(0), Some(_)) => Err("word `G0`: rapid travel after the start; use G1 with G93".to_owned()),
            (Some(_), None) => Err("the program does not begin with G0 to its first position".to_owned()),
            (Some(_), Some(last)) => {
                if !self.inverse_time {
                    return Err("axes move without G93: the time of the block is not known".to_owned());
                }
                let Some(per_minute) = per_minute else {
                    return Err("word `F` is missing: in G93 every block needs its own".to_owned());
                };
                self.knots.push(HobbingKnot { time_s: last.time_s + 60.0 / per_minute, axes });
                Ok(())
            }
        }
    }
}

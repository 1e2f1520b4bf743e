//! gearcut as a library: a scene, a job, its flanks, its findings.
//!
//! In: a [`LoadedScene`]. Out: a [`Job`], which cuts single flanks for programs that look at surfaces, and whole gears
//! with all files for programs that replace the command line. A job owns what it needs: it goes to other threads, is
//! shared between them, and lives as long as it is needed. What a run needs beyond that (the backend, progress, a flag
//! that ends it, the parts that are written) has defaults and is named when it differs: [`Run`].
//!
//! Heights are normal deviations: from the target flank along its outward normal, positive where material is left.
//! Arrays over a flank have the shape `[columns, rows]`, rows fastest: a column is a place along the profile, a row a
//! place along the tooth.
//!
//! Road not taken: a job that borrows its scene. A binding to another language, a server and a study keep jobs longer
//! than the function that made them.

use crate::backend::{self, BackendWish, Choice, OnFailure};
use crate::findings::Notice;
use crate::interrupt::Interrupt;
use crate::job::{GearJob, rows_z_mm};
use crate::output::folder::OutputFolder;
use crate::output::text::Sheet;
use crate::process::{self, ProcessJob};
use crate::run::Run;
use crate::scene::LoadedScene;
use gearcut_core::dexel::{Layer, NO_PASS, Ray};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::frame::Rigid2;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::Arc;

/// A scene made ready to cut, with what cuts it. Clones share all of it.
#[derive(Clone)]
pub struct Job {
    scene: Arc<LoadedScene>,
    prepared: Arc<dyn ProcessJob>,
    choice: Arc<Choice>,
}

impl Job {
    /// Makes a scene ready; the processor cuts it.
    ///
    /// # Errors
    /// Geometry that cannot be cut; [`LoadedScene::explain`] finds the key that says so.
    pub fn new(scene: impl Into<Arc<LoadedScene>>) -> Result<Self> {
        let scene = scene.into();
        let prepared = process::prepare(&scene.scene)?.into();
        Ok(Self { scene, prepared, choice: backend::choose(BackendWish::Cpu, OnFailure::default())?.into() })
    }

    /// The same on another backend: [`backend::choose`].
    #[must_use]
    pub fn on(self, choice: impl Into<Arc<Choice>>) -> Self {
        Self { choice: choice.into(), ..self }
    }

    /// The scene.
    pub fn scene(&self) -> &LoadedScene {
        &self.scene
    }

    /// Cuts one flank with the scene's spacing through all operations.
    ///
    /// `tooth` counts from 1, counter-clockwise. Nothing is written.
    ///
    /// # Errors
    /// A tooth that the gear does not have, a flank that the tool does not generate, the backend's.
    pub fn cut_flank(&self, tooth: u32, side: Side) -> Result<Flank> {
        self.with_gear(|gear| Flank::spaced(gear, &self.choice, tooth, side))
    }

    /// Cuts one flank at places of the caller's own: arcs along the profile from the form point, and distances along
    /// the tooth from the middle of the face, mm, both increasing.
    ///
    /// # Errors
    /// Those of [`Self::cut_flank`]; places that do not increase, or beside the flank.
    pub fn cut_flank_at(&self, tooth: u32, side: Side, arcs_mm: &[f64], face_mm: &[f64]) -> Result<Flank> {
        self.with_gear(|gear| {
            refuse_tooth(gear, tooth)?;
            let half_face_mm = 0.5 * gear.scene().gear.face_width_mm;
            refuse_places("arcs", arcs_mm, [0.0, gear.profile_length_mm(tooth, side)?])?;
            refuse_places("places along the tooth", face_mm, [-half_face_mm, half_face_mm])?;
            Flank::cut(gear, &self.choice, (tooth, side), arcs_mm.to_vec(), face_mm.to_vec())
        })
    }

    /// Places of a flank at the scene's spacing, as [`Self::cut_flank_at`] takes them: arcs and places along the tooth,
    /// mm. Whoever cuts a flank piece by piece takes some of the arcs at a time, and has the same heights within
    /// 0.1 nm.
    ///
    /// # Errors
    /// Those of [`Self::cut_flank`].
    pub fn flank_places_mm(&self, tooth: u32, side: Side) -> Result<[Vec<f64>; 2]> {
        self.with_gear(|gear| Flank::places_mm(gear, tooth, side))
    }

    /// Cuts all flanks with the scene's spacing, on all cores, and hands over each as it is finished, in no fixed
    /// order. Memory holds as many flanks as there are cores.
    ///
    /// # Errors
    /// Those of [`Self::cut_flank`] and of `each`; [`gearcut_core::Error::Interrupted`] once the flag is raised.
    pub fn cut_flanks(&self, interrupt: &Interrupt, each: impl Fn(Flank) -> Result<()> + Sync) -> Result<()> {
        self.with_gear(|gear| {
            let flanks =
                (1..=gear.scene().gear.teeth).flat_map(|tooth| [Side::Left, Side::Right].map(|side| (tooth, side)));
            flanks.collect::<Vec<_>>().into_par_iter().try_for_each(|(tooth, side)| {
                interrupt.check()?;
                each(Flank::spaced(gear, &self.choice, tooth, side)?)
            })
        })
    }

    /// Says on a sheet what the scene means before anything is cut; gives what must be known before cutting.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn check(&self, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        self.prepared.check(sheet)
    }

    /// What must be known before cutting: the notices of [`Self::check`] without its sheet, and without the cuts by
    /// which it forecasts the cost.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn foreseen(&self) -> Result<Vec<Notice>> {
        self.prepared.foreseen()
    }

    /// Those notices of [`Self::foreseen`] that follow from the shapes of gear and tool alone: undercut, pointed teeth,
    /// interference in rings. Of shaped gears they come within milliseconds.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn foreseen_of_shapes(&self) -> Result<Vec<Notice>> {
        self.prepared.foreseen_of_shapes()
    }

    /// Charts of the axes as SVG, each with its name, such as `finish_velocities`.
    ///
    /// # Errors
    /// A chart that cannot be drawn.
    pub fn axis_charts(&self) -> Result<Vec<(String, String)>> {
        self.prepared.axis_charts()
    }

    /// Outlines of gear and tool in the middle of the face, and where the tool stands at every stroke: what a drawing
    /// of the cut needs. Chords lie within `chord_mm` of the tool's edge, points of the gear so far apart that the
    /// same holds of its fillets.
    ///
    /// # Errors
    /// A gear without transverse sections; flanks whose target is not known in closed form.
    pub fn planar_view(&self, chord_mm: f64) -> Result<PlanarView> {
        self.with_gear(|gear| PlanarView::of(gear, chord_mm))
    }

    /// Writes axis tables, charts and programs into `axes/` of a folder, and says on a sheet what the axes do; gives
    /// what must be known before they are used.
    ///
    /// # Errors
    /// Files that cannot be written; [`gearcut_core::Error::Interrupted`] once the flag is raised.
    pub fn axes(&self, folder: &OutputFolder, interrupt: &Interrupt, sheet: &mut Sheet) -> Result<Vec<Notice>> {
        self.prepared.axes(folder, interrupt, sheet)
    }

    /// A run of the whole job: all flanks, the blank, and every file that `gearcut cut` writes.
    pub fn run(&self) -> Run<'_> {
        Run::new(&self.scene, self.prepared.as_ref(), &self.choice)
    }

    fn with_gear<T>(&self, answer: impl Fn(&dyn GearJob) -> Result<T>) -> Result<T> {
        let mut answered = None;
        self.prepared.with_gear(&mut |gear| {
            answered = Some(answer(gear)?);
            Ok(())
        })?;
        Ok(answered.expect("a job shows its gear"))
    }
}

/// A gear and its tool in a transverse section, gear frame, mm; all outlines are closed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarView {
    /// The target, tooth after tooth counter-clockwise.
    pub gear_mm: Vec<DVec2>,
    /// The pitch curve.
    pub pitch_mm: Vec<DVec2>,
    /// The stock before the first stroke: where the tips come to lie.
    pub stock_mm: Vec<DVec2>,
    /// Radius of the bore, or of a ring's rim, mm.
    pub back_radius_mm: f64,
    /// The tool in its own frame.
    pub tool_mm: Vec<DVec2>,
    /// Turn of the tool against its own frame, rad, and its axis at every stroke through all operations; none where
    /// the tool does not move in transverse sections.
    pub strokes: Vec<(f64, DVec2)>,
}

impl PlanarView {
    fn of(gear: &dyn GearJob, chord_mm: f64) -> Result<Self> {
        let Some(of) = gear.cylindrical() else {
            let why = "a gear without transverse sections has no such drawing";
            return Err(Refusal::new("tool", why, "draw gears of shaping or hobbing").into());
        };
        let teeth = gear.scene().gear.teeth;
        let spacing_mm = (chord_mm * gear.scene().gear.module_mm).sqrt();
        let mut gear_mm = Vec::new();
        for tooth in 1..=teeth {
            gear_mm.extend(of.target_section(tooth, 0.0, spacing_mm)?.outline_mm());
        }
        let blank = of.blank();
        let places = 24 * blank.curve().pitches();
        let [from, to] = blank.curve().toothed_rad();
        let at = |i: u32| blank.at_height_mm(from + (to - from) * f64::from(i) / f64::from(places), 0.0);
        let place = |place: Rigid2| (place.rotation.to_angle(), place.translation_mm);
        Ok(Self {
            gear_mm,
            pitch_mm: (0..places).map(at).collect(),
            stock_mm: blank.polygon_mm(places as usize),
            back_radius_mm: blank.back.radius_mm,
            tool_mm: of.tool_section(chord_mm).points_mm,
            strokes: of.tool_places().into_iter().map(place).collect(),
        })
    }
}

fn refuse_tooth(gear: &dyn GearJob, tooth: u32) -> Result<()> {
    let teeth = gear.scene().gear.teeth;
    if (1..=teeth).contains(&tooth) {
        return Ok(());
    }
    let problem = format!("tooth {tooth} does not exist, the gear has {teeth}");
    Err(Refusal::new("gear.teeth", problem, "take a tooth from 1 to the number of teeth").into())
}

fn refuse_places(what: &str, places_mm: &[f64], [first_mm, last_mm]: [f64; 2]) -> Result<()> {
    let increase = places_mm.windows(2).all(|pair| pair[0] < pair[1]);
    let inside = places_mm.iter().all(|mm| (first_mm..=last_mm).contains(mm));
    if increase && inside && !places_mm.is_empty() {
        return Ok(());
    }
    let problem = if inside { "do not increase".to_owned() } else { "lie beside the flank".to_owned() };
    let way_out = format!("give places that increase, from {first_mm:.6} to {last_mm:.6} mm");
    Err(Refusal::new("fields.flank", format!("the {what} {problem}"), way_out).into())
}

/// One flank after all operations: dexels at places along the profile (columns) and along the tooth (rows).
#[derive(Debug, Clone)]
pub struct Flank {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Which of its flanks.
    pub side: Side,
    /// Arcs of the target profile from the form point to the tip, mm, increasing: the columns.
    pub arcs_mm: Vec<f64>,
    /// Places along the tooth from the middle of the face, mm, increasing: the rows.
    pub face_mm: Vec<f64>,
    /// Names of the operations in their order.
    pub operations: Vec<String>,
    layers: Vec<Layer>,
    /// Target points and unit normals, gear frame, mm, in the order of the layers.
    points_mm: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl Flank {
    fn spaced(gear: &dyn GearJob, choice: &Choice, tooth: u32, side: Side) -> Result<Self> {
        let [arcs_mm, face_mm] = Self::places_mm(gear, tooth, side)?;
        Self::cut(gear, choice, (tooth, side), arcs_mm, face_mm)
    }

    fn places_mm(gear: &dyn GearJob, tooth: u32, side: Side) -> Result<[Vec<f64>; 2]> {
        refuse_tooth(gear, tooth)?;
        let scene = gear.scene();
        let face_mm = rows_z_mm(scene.gear.face_width_mm, scene.fields.lead_spacing_mm);
        Ok([gear.even_arcs_mm(tooth, side, scene.fields.profile_spacing_mm)?, face_mm])
    }

    fn cut(
        gear: &dyn GearJob,
        choice: &Choice,
        (tooth, side): (u32, Side),
        arcs_mm: Vec<f64>,
        face_mm: Vec<f64>,
    ) -> Result<Self> {
        let target = gear.target_points(tooth, side, &arcs_mm, &face_mm)?;
        let layers = gear.cut_flank(choice.backend.as_ref(), tooth, side, &arcs_mm, &face_mm)?;
        let operations = gear.operations().into_iter().map(|(name, _)| name.to_owned()).collect();
        let column_by_column = (0..arcs_mm.len()).flat_map(|column| target.iter().map(move |row| row[column]));
        let (points_mm, normals) = column_by_column.map(|Ray { origin_mm, normal }| (origin_mm, normal)).unzip();
        Ok(Self { tooth, side, arcs_mm, face_mm, operations, layers, points_mm, normals })
    }

    /// The arrays alone, for programs that keep them without a copy: target points, normals, and a layer for each
    /// operation.
    pub fn into_arrays(self) -> (Vec<DVec3>, Vec<DVec3>, Vec<Layer>) {
        (self.points_mm, self.normals, self.layers)
    }

    /// Index of an operation in [`Flank::operations`].
    pub fn operation(&self, name: &str) -> Option<usize> {
        self.operations.iter().position(|operation| operation == name)
    }

    /// Columns and rows: the shape of all arrays, rows fastest.
    pub fn shape(&self) -> [usize; 2] {
        [self.arcs_mm.len(), self.face_mm.len()]
    }

    /// Target points, gear frame, mm: `[columns, rows]`, rows fastest.
    pub fn points_mm(&self) -> &[DVec3] {
        &self.points_mm
    }

    /// Outward unit normals of the target, gear frame: `[columns, rows]`, rows fastest.
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Normal deviations from the target after an operation, mm: `[columns, rows]`, rows fastest. Where no pass came
    /// ([`Self::passes`]) it is the blank's own surface, or the end of the ray.
    ///
    /// # Panics
    /// An index beyond [`Flank::operations`].
    pub fn deviations_mm(&self, operation: usize) -> &[f32] {
        &self.layers[operation].heights_mm
    }

    /// Ids of the passes that left the surface after an operation: `[columns, rows]`, rows fastest; [`NO_PASS`] where
    /// no pass came.
    ///
    /// # Panics
    /// An index beyond [`Flank::operations`].
    pub fn passes(&self, operation: usize) -> &[u32] {
        &self.layers[operation].passes
    }

    /// Stock that an operation left for those after it, along the target's normal, mm: `[columns, rows]`, rows fastest;
    /// NaN where a pass of this operation or of the last one is missing.
    ///
    /// # Panics
    /// An index beyond [`Flank::operations`].
    pub fn stock_mm(&self, operation: usize) -> Vec<f32> {
        let (layer, last) = (&self.layers[operation], &self.layers[self.layers.len() - 1]);
        let stock = |dexel: usize| {
            let cut = layer.passes[dexel] != NO_PASS && last.passes[dexel] != NO_PASS;
            if cut { layer.heights_mm[dexel] - last.heights_mm[dexel] } else { f32::NAN }
        };
        (0..layer.heights_mm.len()).map(stock).collect()
    }

    /// Index of a dexel in the arrays.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn dexel(&self, column: usize, row: usize) -> usize {
        assert!(column < self.arcs_mm.len() && row < self.face_mm.len(), "dexel ({column}, {row}) is off the flank");
        column * self.face_mm.len() + row
    }

    /// Pass that left the surface after an operation; `None` where no pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn pass(&self, operation: usize, column: usize, row: usize) -> Option<u32> {
        Some(self.passes(operation)[self.dexel(column, row)]).filter(|&pass| pass != NO_PASS)
    }

    /// Normal deviation after an operation, um; `None` where no pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn deviation_um(&self, operation: usize, column: usize, row: usize) -> Option<f64> {
        self.pass(operation, column, row)?;
        Some(f64::from(self.deviations_mm(operation)[self.dexel(column, row)]) * UM_PER_MM)
    }

    /// Place of the surface after an operation, gear frame, mm: the target's point and the deviation along its normal;
    /// `None` where no pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn point_mm(&self, operation: usize, column: usize, row: usize) -> Option<DVec3> {
        let height_mm = self.deviation_um(operation, column, row)? / UM_PER_MM;
        let dexel = self.dexel(column, row);
        Some(Ray { origin_mm: self.points_mm[dexel], normal: self.normals[dexel] }.at(height_mm))
    }

    /// Profile in one row after an operation: arc from the form point, mm, and normal deviation, um, where a pass came.
    ///
    /// # Panics
    /// Indices beyond the flank's.
    pub fn profile(&self, operation: usize, row: usize) -> Vec<(f64, f64)> {
        let at = |column: usize| Some((self.arcs_mm[column], self.deviation_um(operation, column, row)?));
        (0..self.arcs_mm.len()).filter_map(at).collect()
    }
}

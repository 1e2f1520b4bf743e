//! A gear without pitch curve and transverse sections through the steps that all processes share: the two sides of
//! slots that a face-mill head leaves at rest, cones whose axis leans in the gear.

use crate::fixtures::face_mill::*;
use crate::fixtures::paper::paper_scene;
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{FreeRays, Layer, Ray, RayGrid, SpatialField};
use gearcut::error::Result;
use gearcut::findings::Findings;
use gearcut::frame::Rigid3;
use gearcut::interrupt::Interrupt;
use gearcut::job::{CylindricalGear, GearJob, ToothFrame};
use gearcut::output::folder::OutputFolder;
use gearcut::passes::{SweepPlan, TurningPasses};
use gearcut::progress::{Progress, ProgressMode};
use gearcut::scene::Scene;
use gearcut::scene::model::{Picture, PictureColour, PictureView};
use gearcut::steps::attempts::Attempts;
use gearcut::steps::cut_flanks::{CutFlank, CutFlanks, FlankQueue, cut_flanks, dexels_of};
use gearcut::steps::parts::{Parts, Stages};
use gearcut::steps::report::PageGear;
use gearcut::steps::view_mesh::{ViewFlank, ViewMesh};
use gearcut::steps::{Tools, pictures, report, sheets};
use gearcut::surface::triangles::Triangles;
use gearcut::terms::Side;
use gearcut::texture;
use glam::{DMat3, DVec3};

/// Where flanks begin over the tips' plane, and how long their profiles are, mm.
const FOOT_MM: f64 = 0.5;
const PROFILE_MM: f64 = 4.0;
/// Length of the teeth, mm.
const FACE_MM: f64 = 20.0;
/// How far the farthest outside and inside blade stand out, mm.
const RUNOUT_MM: [f64; 2] = [0.01, -0.02];

/// Two teeth, whose left flanks are the outer sides of slots and whose right ones are the inner sides.
struct ConicalJob {
    scene: Scene,
    passes: TurningPasses,
    gear_from_head: Rigid3,
}

impl ConicalJob {
    fn new() -> Self {
        let mut scene = paper_scene(Vec::new());
        scene.name = "cones".into();
        scene.gear.teeth = 2;
        scene.gear.face_width_mm = FACE_MM;
        scene.fields.profile_spacing_mm = 0.1;
        scene.fields.lead_spacing_mm = 0.2;
        scene.output.map_spacing_mm = 0.2;
        scene.output.mesh_spacing_mm = 0.2;
        let picture = |name: &str, view| Picture {
            name: name.into(),
            view,
            tooth: 1,
            side: Side::Left,
            colour: PictureColour::Height,
            azimuth_rad: 0.3,
            elevation_rad: 0.5,
            extent_mm: None,
            exaggeration: None,
            size_px: (160, 120),
            exr: false,
        };
        scene.pictures = vec![picture("tooth", PictureView::Tooth), picture("flank", PictureView::Flank)];
        let runout_mm = [0.0, 0.0, RUNOUT_MM[0], RUNOUT_MM[1], 0.0, 0.0, 0.0, 0.0];
        let head = FaceMill { runout_mm, ..FaceMill::default() };
        let rotation = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_y(1.1);
        let gear_from_head = Rigid3 { rotation, translation_mm: DVec3::new(-30.0, 12.0, 40.0) };
        let passes = head.passes_over([-1.0, 8.0], |_| gear_from_head.inverse());
        Self { scene, passes, gear_from_head }
    }

    fn rays(&self, side: Side, arcs_mm: Vec<f64>, rows_mm: Vec<f64>) -> FreeRays {
        let heights_mm: Vec<f64> = arcs_mm.iter().map(|arc_mm| FOOT_MM + arc_mm * BLADE_ANGLE_RAD.cos()).collect();
        let angles_rad: Vec<f64> = rows_mm.iter().map(|row_mm| row_mm / RADIUS_MM).collect();
        let in_head = cone(side.sign(), &heights_mm, &angles_rad);
        let field = SpatialField::new(arcs_mm.len(), rows_mm.len(), in_head.low_mm, |column, row| {
            let Ray { origin_mm, normal } = in_head.ray(column, row);
            let placed =
                Ray { origin_mm: self.gear_from_head.point(origin_mm), normal: self.gear_from_head.direction(normal) };
            (placed, 1.5)
        });
        FreeRays { field, arcs_mm, rows_mm }
    }

    fn all_rays(&self, side: Side) -> FreeRays {
        self.rays(side, even(0.0, PROFILE_MM, 41), even(-0.5 * FACE_MM, 0.5 * FACE_MM, 101))
    }

    fn cut(&self, rays: &FreeRays) -> Layer {
        let mut layer = rays.field.blank_layer();
        Cpu::default()
            .cut_spatial(&rays.field, &SweepPlan::new(&rays.field, &self.passes), &mut layer)
            .expect("native");
        layer
    }

    /// Height of a point over the cone of a side, along its normal, mm.
    fn height_mm(&self, side: Side, point_mm: DVec3) -> f64 {
        let at = self.gear_from_head.inverse().point(point_mm);
        let cone_mm = radius_at_mm(side.sign(), at.z);
        side.sign() * (cone_mm - at.truncate().length()) * BLADE_ANGLE_RAD.cos()
    }
}

/// What the blade that stands out most leaves of a side.
fn left_mm(side: Side) -> f64 {
    let blade = usize::from(side == Side::Right);
    -side.sign() * RUNOUT_MM[blade] * BLADE_ANGLE_RAD.cos()
}

impl GearJob for ConicalJob {
    fn cylindrical(&self) -> Option<&dyn CylindricalGear> {
        None
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn operations(&self) -> Vec<(&str, f64)> {
        vec![("mill", 0.0)]
    }

    fn passes(&self) -> u32 {
        self.passes.end_pass()
    }

    fn pass_time_s(&self, pass: u32) -> f64 {
        self.passes.pass(pass).tool_angle_rad
    }

    fn marks_follow(&self, _operation: usize) -> [bool; 2] {
        [false, true]
    }

    fn profile_length_mm(&self, _tooth: u32, _side: Side) -> Result<f64> {
        Ok(PROFILE_MM)
    }

    fn evaluated_profile_mm(&self, _tooth: u32, _side: Side) -> Result<[f64; 2]> {
        Ok([0.0, PROFILE_MM])
    }

    fn teeth_that_differ_most(&self) -> Vec<u32> {
        vec![1]
    }

    fn tooth_frame(&self, _tooth: u32) -> ToothFrame {
        let [front, left, along] = [DVec3::Z, DVec3::X, DVec3::Y].map(|axis| self.gear_from_head.direction(axis));
        ToothFrame { place_mm: self.gear_from_head.point(RADIUS_MM * DVec3::X), front, left, along }
    }

    fn target_points(&self, _tooth: u32, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<Vec<Ray>>> {
        let rays = self.rays(side, arcs_mm.to_vec(), rows_mm.to_vec());
        let row = |row| (0..arcs_mm.len()).map(|column| rays.field.ray(column, row)).collect();
        Ok((0..rows_mm.len()).map(row).collect())
    }

    fn cut_flank(
        &self,
        _backend: &dyn Backend,
        _tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_mm: &[f64],
    ) -> Result<Vec<Layer>> {
        Ok(vec![self.cut(&self.rays(side, arcs_mm.to_vec(), rows_mm.to_vec()))])
    }
}

fn cut(job: &ConicalJob, tools: Option<&Tools>) -> CutFlanks<()> {
    let (progress, interrupt) = (Progress::new(ProgressMode::Quiet), Interrupt::default());
    let cut_one = |_, side| -> Result<CutFlank<_, ()>> {
        let rays = job.all_rays(side);
        let layers = vec![job.cut(&rays)];
        let evaluated_mm = vec![[0.0, f64::INFINITY]];
        Ok(CutFlank {
            dexels: dexels_of(&layers),
            rays,
            layers,
            stats: gearcut::cut::CutStats::default(),
            evaluated_mm,
            report: (),
        })
    };
    let folder = tools.map(|tools| (tools.folder, tools.notes, tools.parts));
    let cut_all = |flanks: &FlankQueue<_, _>| {
        flanks.list.iter().enumerate().try_for_each(|(at, &(tooth, side))| flanks.take(at, cut_one(tooth, side)?))
    };
    cut_flanks(job, &progress, &interrupt, folder, cut_all, |_, _, _| Vec::new()).expect("cuts")
}

#[test]
fn surfaces_are_points_and_normals_in_space() {
    let job = ConicalJob::new();
    let done = cut(&job, None);
    assert_eq!((done.surfaces.len(), done.maps.flanks.len()), (4, 4));
    for (index, grid) in done.surfaces.iter().enumerate() {
        let side = [Side::Left, Side::Right][index % 2];
        for &point_mm in &grid.points_mm {
            let off_mm = job.height_mm(side, point_mm) - left_mm(side);
            assert!(off_mm.abs() < 1e-7, "{side:?}: {off_mm:e} mm off the cone");
        }
        // No row stands in a transverse section, nor in any plane of the gear's axes.
        for axis in 0..3 {
            let row = (0..grid.columns()).map(|column| grid.position_mm(column, 0)[axis]);
            let [low, high] = row.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            assert!(high - low > 0.3, "axis {axis}: {} mm", high - low);
        }
        let mesh = grid.mesh("cone");
        let rays = job.all_rays(side);
        let normal = RayGrid::normal(&rays, 20, 50);
        let middle = (0..mesh.triangles.len()).min_by(|&a, &b| {
            let distance = |t: usize| mesh.corners_mm(t)[0].distance(rays.point_mm(20, 50, 0.0));
            distance(a).total_cmp(&distance(b))
        });
        let own = mesh.scaled_normal(middle.expect("triangles")).normalize();
        assert!(own.dot(normal) > 0.999, "{side:?}: triangles face {own}, the target {normal}");
        // A cone's area: the angle, times the slant length, times the mean radius; offset by what is left.
        let middle_mm = radius_at_mm(side.sign(), FOOT_MM + 0.5 * PROFILE_MM * BLADE_ANGLE_RAD.cos());
        let radius_mm = middle_mm - side.sign() * left_mm(side) * BLADE_ANGLE_RAD.cos();
        let area_mm2 = FACE_MM / RADIUS_MM * PROFILE_MM * radius_mm;
        // Chords of 0.2 mm on a radius of 95 mm are shorter than their arcs by 2e-7.
        assert!((mesh.area_mm2() / area_mm2 - 1.0).abs() < 1e-6, "{} of {area_mm2} mm2", mesh.area_mm2());
        // Alive: a cone of another angle or a slot elsewhere is seen.
        assert!(grid.points_mm.iter().all(|&p| (job.height_mm(side, p + 1e-5 * normal) - left_mm(side)).abs() > 5e-6));
    }
    let deviations = done.maps.flanks[0].deviation_mm();
    assert!(deviations.iter().all(|&d| (f64::from(d) - left_mm(Side::Left)).abs() < 1e-7));
}

#[test]
fn files_pictures_page_and_texture_ask_for_no_pitch_curve() {
    let job = ConicalJob::new();
    let place = tempfile::tempdir().expect("a folder for the test");
    let folder = OutputFolder::create(&place.path().join("cones")).expect("free");
    let (progress, interrupt, cpu) = (Progress::new(ProgressMode::Quiet), Interrupt::default(), Cpu::default());
    let notes = [("scene".to_owned(), "cones".to_owned())];
    let tools = Tools {
        resolved: "",
        backend: &cpu,
        backend_why: "",
        progress: &progress,
        interrupt: &interrupt,
        folder: &folder,
        parts: Parts::all(),
        stages: Stages::ALL,
        notes: &notes,
    };
    let done = cut(&job, Some(&tools));
    let windows = texture::windows(&job).expect("windows on the cones");
    let windows = texture::sampled(&job, &windows).expect("marks on the cones");
    sheets::write_sheets_and_flanks(&job, &done.maps, &windows, &tools).expect("sheets");
    // What stands for the gear's body: here the flank alone.
    let body = done.surfaces[0].mesh("tooth_01_left");
    let mut attempts = Attempts::new(&progress);
    let drawn = pictures::draw(&job, Some(&body), (&done.pictured, None), &tools, &mut attempts).expect("pictures");
    assert_eq!(drawn, 2);

    let rows_mm = even(-0.5 * FACE_MM, 0.5 * FACE_MM, 11);
    let flank = |tooth, side| ViewFlank::of_target(&job, tooth, side, rows_mm.clone()).expect("a target");
    let flanks: Vec<ViewFlank> = (1..=2).flat_map(|t| [flank(t, Side::Left), flank(t, Side::Right)]).collect();
    for flank in &flanks {
        let at = |corner: u32| DVec3::from(flank.triangles.positions_mm[corner as usize].map(f64::from));
        for triangle in flank.triangles.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| at(triangle[k]));
            let normal = DVec3::from(flank.triangles.normals[triangle[0] as usize].map(f64::from));
            assert!((b - a).cross(c - a).normalize().dot(normal) > 0.99, "a triangle faces inwards");
        }
    }
    let gear = PageGear { words: "Slots on cones".into(), mesh: ViewMesh { flanks, body: Triangles::default() } };
    let found = Findings {
        program_version: "0".into(),
        process: "milling".into(),
        scene: "cones".into(),
        complete: true,
        headline: Vec::new(),
        warnings: Vec::new(),
        sections: Vec::new(),
    };
    let page = report::page(&job, gear, &found, &done.maps, |_| String::new(), Vec::new());
    assert_eq!(page.subtitle, "Slots on cones");
    page.write(&folder.path("report.html").expect("a place")).expect("written");
    assert_eq!(windows.len(), 4, "both flanks of the tooth that differs most and of the papers' tooth");
    let textures = texture::measure(&job, &windows, &cpu, &progress, &interrupt).expect("texture");
    for texture in &textures {
        let heights = texture.heights.as_ref().expect("cut everywhere");
        let wanted_um = 1e3 * left_mm(texture.window.side);
        assert!(heights.heights_um().iter().all(|&h| (h - wanted_um).abs() < 1e-4));
    }
    assert_eq!(texture::findings(&job, &textures).sections[0].sections.len(), textures.len());

    folder.write_json("run.json", &serde_json::json!({"program": "gearcut"})).expect("the record");
    let written = folder.finish().expect("finished");
    for file in [
        "maps/mill/tooth_01_left.png",
        "maps/mill/tooth_02_right.exr",
        "deviation/tooth_02_left.exr",
        "mesh/flanks/tooth_01_right.ply",
        "pictures/tooth.png",
        "pictures/flank.png",
        "report.html",
    ] {
        assert!(written.join(file).is_file(), "{file} is missing");
    }
}

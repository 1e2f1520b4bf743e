//! The target gear as a closed, coarse mesh to look at: flanks apart from the rest, so that maps can be laid on them.
//!
//! In: the job. Out: [`ViewMesh`] in the work frame. Flanks, roots and tip lands are sampled every half millimetre
//! along the profile, and along the tooth in as many sections as the shape asks for: straight teeth are ruled along z
//! and need two. What an operation leaves differs from the target by far less than a pixel; it is shown by colours, not
//! by the shape.
//!
//! End faces need no general triangulation: every tooth is a ladder from its right to its left flank, and the ring
//! below the teeth a strip from root to bore or rim. All parts meet in the same points, so the mesh is closed (a test
//! counts its edges).

use crate::job::{CylindricalGear, GearJob};
use crate::surface::triangles::{SectionProfile, Triangles};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use glam::{DVec2, DVec3};

/// Distance between points along profiles and roots, mm.
const SPACING_MM: f64 = 0.5;
/// Intervals across a tip land: its outline is nearly straight.
const TIP_INTERVALS: usize = 4;

/// One flank: points at arcs times sections, the sections of an arc following each other.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewFlank {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank.
    pub side: Side,
    /// Arcs from the form point, mm.
    pub arcs_mm: Vec<f64>,
    /// Places along the tooth, mm.
    pub rows_mm: Vec<f64>,
    /// Its triangles; corner i n + k belongs to arc i and section k of n.
    pub triangles: Triangles,
}

/// The gear.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewMesh {
    /// Flanks in order of teeth, left before right.
    pub flanks: Vec<ViewFlank>,
    /// Roots, tip lands, end faces, bore or rim.
    pub body: Triangles,
}

impl ViewFlank {
    /// Samples the target flank of any gear, in rows at places along the tooth.
    ///
    /// # Errors
    /// The tool generates no flank there.
    pub fn of_target(job: &dyn GearJob, tooth: u32, side: Side, rows_mm: Vec<f64>) -> Result<Self> {
        let arcs_mm = job.even_arcs_mm(tooth, side, SPACING_MM)?;
        let rows = job.target_points(tooth, side, &arcs_mm, &rows_mm)?;
        let (first, [along_profile, along_tooth]) =
            (rows[0][0], [rows[0][arcs_mm.len() - 1], rows[rows.len() - 1][0]].map(|corner| corner.origin_mm));
        let across = (along_profile - first.origin_mm).cross(along_tooth - first.origin_mm);
        let mut triangles = Triangles::default();
        triangles.surface(&rows, across.dot(first.normal) > 0.0);
        Ok(Self { tooth, side, arcs_mm, rows_mm, triangles })
    }
}

impl ViewMesh {
    /// Samples the target of a cylindrical gear.
    ///
    /// # Errors
    /// No flank is generated on some tooth.
    pub fn new(job: &dyn CylindricalGear) -> Result<Self> {
        let rows_z_mm = job.view_rows_z_mm();
        let [bottom, top] = [0, rows_z_mm.len() - 1];
        let mut flanks = Vec::new();
        let gear = job.blank().kind();
        let mut body = Triangles::of(gear);
        let mut rims = Vec::new();
        for tooth in 1..=job.scene().gear.teeth {
            let profiles = |side: Side| -> Result<_> {
                let arcs_mm = job.even_arcs_mm(tooth, side, SPACING_MM)?;
                let profiles = job.target_profiles(tooth, side, &arcs_mm, &rows_z_mm)?;
                Ok((arcs_mm, profiles))
            };
            let ((left_arcs, left), (right_arcs, right)) = (profiles(Side::Left)?, profiles(Side::Right)?);
            let tip: Vec<SectionProfile> =
                right.iter().zip(&left).map(|(right, left)| tip_land(job, right, left)).collect();
            for (side, arcs_mm, profiles) in [(Side::Left, left_arcs, &left), (Side::Right, right_arcs, &right)] {
                let mut triangles = Triangles::of(gear);
                triangles.wall(profiles, &rows_z_mm, side == Side::Right);
                flanks.push(ViewFlank { tooth, side, arcs_mm, rows_mm: rows_z_mm.clone(), triangles });
            }
            body.wall(&tip, &rows_z_mm, true);
            for k in [bottom, top] {
                body.tooth_end([&right[k], &left[k], &tip[k]], rows_z_mm[k], k == top);
            }
            let ends =
                |profiles: &[SectionProfile]| -> SectionProfile { profiles.iter().map(|profile| profile[0]).collect() };
            rims.push((ends(&right), ends(&left)));
        }
        let mut rim: [Vec<DVec2>; 2] = Default::default();
        for (space, (index, (right, left))) in (1..).zip(rims.iter().enumerate()) {
            let next = &rims[(index + 1) % rims.len()].0;
            let roots = roots(job, space, &rows_z_mm, left, next)?;
            body.wall(&roots, &rows_z_mm, true);
            for (rim, k) in rim.iter_mut().zip([bottom, top]) {
                rim.push(right[k].0);
                rim.extend(roots[k][..roots[k].len() - 1].iter().map(|(point, _)| *point));
            }
        }
        body.rings(&rim, job.blank().back.radius_mm, [rows_z_mm[bottom], rows_z_mm[top]]);
        Ok(Self { flanks, body })
    }
}

/// Tip land from the right flank's tip to the left one's, as high over the pitch curve as they are.
fn tip_land(job: &dyn CylindricalGear, right: &SectionProfile, left: &SectionProfile) -> SectionProfile {
    let ends = [right[right.len() - 1].0, left[left.len() - 1].0];
    let foot = |point: DVec2| job.blank().height(point, point.to_angle());
    let heights = ends.map(|end| foot(end).0);
    (0..=TIP_INTERVALS)
        .map(|i| {
            let share = i as f64 / TIP_INTERVALS as f64;
            let foot_rad = foot(ends[0].lerp(ends[1], share)).1;
            let height_mm = heights[0] + share * (heights[1] - heights[0]);
            // The ends are the flanks' own points, to the last digit.
            let point = match i {
                0 => ends[0],
                TIP_INTERVALS => ends[1],
                _ => job.blank().at_height_mm(foot_rad, height_mm),
            };
            (point, job.blank().towards_tip(&job.curve().frame(foot_rad)).extend(0.0))
        })
        .collect()
}

/// Root of a space from the form points of the left flank before it to those of the right flank after it, in all
/// sections.
fn roots(
    job: &dyn CylindricalGear,
    space: u32,
    rows_z_mm: &[f64],
    left: &SectionProfile,
    right: &SectionProfile,
) -> Result<Vec<SectionProfile>> {
    let roots = job.target_roots(space, SPACING_MM, rows_z_mm)?;
    // Points nearly on the flanks' ends would make needles of triangles; what is left out in one section is left out in
    // all.
    let apart = |i: usize| {
        let from_ends = |k: usize, point: DVec2| point.distance(left[k].0).min(point.distance(right[k].0));
        roots.iter().enumerate().all(|(k, root)| from_ends(k, root[i].0) > 0.05 * SPACING_MM)
    };
    let kept: Vec<usize> = (0..roots[0].len()).filter(|&i| apart(i)).collect();
    let whole = |k: usize| {
        let root = &roots[k];
        let normal_at = |end: Option<&(DVec2, DVec3)>, other: DVec3| end.map_or(other, |(_, normal)| *normal);
        let mut profile = vec![(left[k].0, normal_at(root.first(), left[k].1))];
        profile.extend(kept.iter().map(|&i| root[i]));
        profile.push((right[k].0, normal_at(root.last(), right[k].1)));
        profile
    };
    Ok((0..rows_z_mm.len()).map(whole).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process;
    use crate::process::hobbing::{HobCutter, HobbingJob};
    use crate::process::shaping::ShapingJob;
    use std::collections::HashMap;
    use std::path::Path;

    fn mesh(scene: &str) -> (ShapingJob, ViewMesh) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping").join(scene);
        let job = ShapingJob::new(process::load(&path, &[]).expect("a shipped scene").scene).expect("a gear");
        let mesh = ViewMesh::new(&job).expect("a mesh");
        (job, mesh)
    }

    fn hobbed_mesh(name: &str) -> ViewMesh {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hobbing").join(name).with_extension("toml");
        let job = HobbingJob::new(&process::load(&path, &[]).expect("a shipped scene").scene).expect("a gear");
        ViewMesh::new(&HobCutter::new(&job).expect("passes")).expect("a mesh")
    }

    fn triangles(mesh: &ViewMesh) -> Vec<[[f64; 3]; 3]> {
        mesh.flanks
            .iter()
            .map(|flank| &flank.triangles)
            .chain([&mesh.body])
            .flat_map(|part| {
                part.indices
                    .chunks(3)
                    .map(|corners| [0, 1, 2].map(|k| part.positions_mm[corners[k] as usize].map(f64::from)))
            })
            .collect()
    }

    /// Every edge belongs to two triangles that pass it in opposite directions: closed, and all faces look outwards.
    #[test]
    fn the_gear_is_closed_and_looks_outwards() {
        let shaped =
            ["elliptical_normal.toml", "circular_m3_z24.toml", "order_2.toml"].map(|name| (name, mesh(name).1));
        let hobbed = ["circular_helical", "third_order_plain"].map(|name| (name, hobbed_mesh(name)));
        for (scene, mesh) in shaped.into_iter().chain(hobbed) {
            let mut edges: HashMap<[[i64; 3]; 2], i32> = HashMap::new();
            for triangle in triangles(&mesh) {
                let corners = triangle.map(|corner| corner.map(|value| (value * 1e4).round() as i64));
                for k in 0..3 {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
                }
            }
            let open = edges.values().filter(|&&count| count != 0).count();
            assert_eq!(open, 0, "{scene}: {open} of {} edges", edges.len());
        }
    }

    /// Volume by the divergence theorem against the area inside the tooth outline known from elsewhere: blank less
    /// spaces, from the pitch circle's symmetry.
    #[test]
    fn the_round_gear_has_the_volume_of_its_outline() {
        let (job, mesh) = mesh("circular_m3_z24.toml");
        let volume: f64 = triangles(&mesh)
            .iter()
            .map(|[a, b, c]| {
                (a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]))
                    / 6.0
            })
            .sum();
        // A round gear with m 3, z 24: its teeth and spaces are equally wide on the pitch circle (d = 72 mm), the tooth
        // is 3 mm high above and 3.75 mm deep below it; the area inside lies between those of the root and tip circles,
        // near that of the pitch circle.
        let disc = |radius: f64| std::f64::consts::PI * (radius * radius - 100.0) * job.scene.gear.face_width_mm;
        assert!(volume > disc(36.0 - 1.5) && volume < disc(36.0 + 0.5), "{volume} against {}", disc(36.0));
    }

    #[test]
    fn flank_corners_lie_on_the_target() {
        let (job, mesh) = mesh("elliptical_normal.toml");
        let flank = &mesh.flanks[7];
        assert_eq!((flank.tooth, flank.side), (4, Side::Right));
        let target = job.target_flank(4, Side::Right);
        for (i, &arc) in flank.arcs_mm.iter().enumerate() {
            let corner = flank.triangles.positions_mm[2 * i + 1];
            let point = target.at_arc(arc).point_mm;
            assert!((f64::from(corner[0]) - point.x).hypot(f64::from(corner[1]) - point.y) < 1e-5);
            assert_eq!(corner[2], 15.0);
        }
    }
}

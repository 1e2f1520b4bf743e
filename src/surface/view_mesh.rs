//! The target gear as a closed, coarse mesh to look at: flanks apart from the rest, so that maps can be laid on them.
//!
//! In: the job. Out: [`ViewMesh`] in the work frame. Flanks, roots and tip lands are sampled every half millimetre along the profile, and along the tooth in as many sections as the shape asks for:
//! straight teeth are ruled along z and need two. What an operation leaves differs from the target by far less than a pixel; it is shown by colours, not by the shape.
//!
//! End faces need no general triangulation: every tooth is a ladder from its right to its left flank, and the ring below the teeth a strip from root to bore. All parts meet in the same
//! points, so the mesh is closed (a test counts its edges).

use crate::error::Result;
use crate::gear::generation::Side;
use crate::job::GearJob;
use crate::job::gear_job::Profile;
use crate::units::TURN_RAD;
use glam::{DVec2, DVec3};

/// Distance between points along profiles and roots, mm.
const SPACING_MM: f64 = 0.5;
/// Intervals across a tip land: its outline is nearly straight.
const TIP_INTERVALS: usize = 4;

/// Triangles with a normal at every corner; counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangles {
    /// Corners, mm.
    pub positions_mm: Vec<[f32; 3]>,
    /// Unit normals at the corners.
    pub normals: Vec<[f32; 3]>,
    /// Three corners per triangle.
    pub indices: Vec<u32>,
}

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
    pub leads_mm: Vec<f64>,
    /// Its triangles; corner i n + k belongs to arc i and section k of n.
    pub triangles: Triangles,
}

/// The gear.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewMesh {
    /// Flanks in order of teeth, left before right.
    pub flanks: Vec<ViewFlank>,
    /// Roots, tip lands, end faces and bore.
    pub body: Triangles,
}

impl ViewMesh {
    /// Samples the target gear of a job.
    ///
    /// # Errors
    /// No flank is generated on some tooth.
    pub fn new(job: &dyn GearJob) -> Result<Self> {
        let leads_mm = job.view_leads_mm();
        let [bottom, top] = [0, leads_mm.len() - 1];
        let mut flanks = Vec::new();
        let mut body = Triangles::default();
        let mut rims = Vec::new();
        for tooth in 1..=job.scene().gear.teeth {
            let [left, right] =
                [Side::Left, Side::Right].map(|side| job.target_profiles(tooth, side, SPACING_MM, &leads_mm));
            let ((left_arcs, left), (right_arcs, right)) = (left?, right?);
            let tip: Vec<Profile> = right.iter().zip(&left).map(|(right, left)| tip_land(job, right, left)).collect();
            for (side, arcs_mm, profiles) in [(Side::Left, left_arcs, &left), (Side::Right, right_arcs, &right)] {
                let mut triangles = Triangles::default();
                triangles.wall(profiles, &leads_mm, side == Side::Right);
                flanks.push(ViewFlank { tooth, side, arcs_mm, leads_mm: leads_mm.clone(), triangles });
            }
            body.wall(&tip, &leads_mm, true);
            for k in [bottom, top] {
                body.tooth_end([&right[k], &left[k], &tip[k]], leads_mm[k], k == top);
            }
            let ends = |profiles: &[Profile]| -> Profile { profiles.iter().map(|profile| profile[0]).collect() };
            rims.push((ends(&right), ends(&left)));
        }
        let mut rim: [Vec<DVec2>; 2] = Default::default();
        for (space, (index, (right, left))) in (1..).zip(rims.iter().enumerate()) {
            let next = &rims[(index + 1) % rims.len()].0;
            let roots = roots(job, space, &leads_mm, left, next)?;
            body.wall(&roots, &leads_mm, true);
            for (rim, k) in rim.iter_mut().zip([bottom, top]) {
                rim.push(right[k].0);
                rim.extend(roots[k][..roots[k].len() - 1].iter().map(|(point, _)| *point));
            }
        }
        body.rings(&rim, 0.5 * job.scene().gear.bore_diameter_mm, [leads_mm[bottom], leads_mm[top]]);
        Ok(Self { flanks, body })
    }
}

/// Tip land from the right flank's tip to the left one's, as high over the pitch curve as they are.
fn tip_land(job: &dyn GearJob, right: &Profile, left: &Profile) -> Profile {
    let ends = [right[right.len() - 1].0, left[left.len() - 1].0];
    let foot = |point: DVec2| job.blank().height(point, point.to_angle());
    let heights = ends.map(|end| foot(end).0);
    (0..=TIP_INTERVALS)
        .map(|i| {
            let share = i as f64 / TIP_INTERVALS as f64;
            let frame = job.curve().frame(foot(ends[0].lerp(ends[1], share)).1);
            let height_mm = heights[0] + share * (heights[1] - heights[0]);
            // The ends are the flanks' own points, to the last digit.
            let point = match i {
                0 => ends[0],
                TIP_INTERVALS => ends[1],
                _ => frame.point_mm + height_mm * frame.normal,
            };
            (point, frame.normal.extend(0.0))
        })
        .collect()
}

/// Root of a space from the form points of the left flank before it to those of the right flank after it, in all sections.
fn roots(job: &dyn GearJob, space: u32, leads_mm: &[f64], left: &Profile, right: &Profile) -> Result<Vec<Profile>> {
    let roots = job.target_roots(space, SPACING_MM, leads_mm)?;
    // Points nearly on the flanks' ends would make needles of triangles; what is left out in one section is left out in all.
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
    Ok((0..leads_mm.len()).map(whole).collect())
}

impl Triangles {
    fn corner(&mut self, point: DVec2, z_mm: f64, normal: DVec3) -> u32 {
        self.positions_mm.push(point.extend(z_mm).as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.positions_mm.len() as u32 - 1
    }

    /// Profiles of all sections joined along the tooth; `forward`: they run counter-clockwise round the gear.
    fn wall(&mut self, profiles: &[Profile], leads_mm: &[f64], forward: bool) {
        let (first, sections) = (self.positions_mm.len() as u32, leads_mm.len() as u32);
        for i in 0..profiles[0].len() {
            for (profile, &lead) in profiles.iter().zip(leads_mm) {
                let (point, normal) = profile[i];
                self.corner(point, lead, normal);
            }
        }
        for i in 0..profiles[0].len() as u32 - 1 {
            for k in 0..sections - 1 {
                let [a, b] = [k, k + 1].map(|k| first + sections * i + k);
                let [c, d] = [a, b].map(|corner| corner + sections);
                let quad = if forward { [a, c, d, a, d, b] } else { [a, d, c, a, b, d] };
                self.indices.extend(quad);
            }
        }
    }

    /// Flat polygons at one end of the face from triangles that are counter-clockwise seen from +z.
    fn end(&mut self, points: &[DVec2], triangles: &[[usize; 3]], z_mm: f64, top: bool) {
        let first = self.positions_mm.len() as u32;
        for &point in points {
            self.corner(point, z_mm, if top { DVec3::Z } else { DVec3::NEG_Z });
        }
        for [a, b, c] in triangles.iter().map(|triangle| triangle.map(|corner| first + corner as u32)) {
            self.indices.extend(if top { [a, b, c] } else { [a, c, b] });
        }
    }

    /// One end of one tooth: a ladder between its right and its left flank, a fan under its tip land.
    fn tooth_end(&mut self, [right, left, tip]: [&Profile; 3], z_mm: f64, top: bool) {
        let points: Vec<DVec2> =
            right.iter().chain(left).chain(&tip[1..tip.len() - 1]).map(|&(point, _)| point).collect();
        let (r_last, l_first) = (right.len() - 1, right.len());
        let l_last = l_first + left.len() - 1;
        let mut triangles = Vec::new();
        // The flanks may have different numbers of points: the one that lags behind takes the next step.
        let (mut r, mut l) = (0, l_first);
        while r < r_last || l < l_last {
            let behind = (r as f64 / r_last as f64) <= ((l - l_first) as f64 / (left.len() - 1) as f64);
            if r < r_last && (behind || l == l_last) {
                triangles.push([r, r + 1, l]);
                r += 1;
            } else {
                triangles.push([r, l + 1, l]);
                l += 1;
            }
        }
        let rim: Vec<usize> = std::iter::once(r_last).chain(l_last + 1..points.len()).chain([l_last]).collect();
        triangles.extend(rim[1..].windows(2).map(|pair| [rim[0], pair[0], pair[1]]));
        self.end(&points, &triangles, z_mm, top);
    }

    /// Both end faces (bottom, top) from their closed rims (counter-clockwise) to the bore, and the bore; without a bore to the axis.
    fn rings(&mut self, rims: &[Vec<DVec2>; 2], bore_radius_mm: f64, leads_mm: [f64; 2]) {
        let bores = [0, 1].map(|k| {
            if bore_radius_mm <= 0.0 {
                self.fan(&rims[k], leads_mm[k], k == 1);
                return Profile::new();
            }
            self.ring(&rims[k], bore_radius_mm, leads_mm[k], k == 1)
        });
        if bore_radius_mm > 0.0 {
            self.wall(&bores, &leads_mm, false);
        }
    }

    /// An end face without a bore.
    fn fan(&mut self, rim: &[DVec2], z_mm: f64, top: bool) {
        let count = rim.len();
        let points: Vec<DVec2> = rim.iter().copied().chain([DVec2::ZERO]).collect();
        let fan: Vec<[usize; 3]> = (0..count).map(|i| [i, (i + 1) % count, count]).collect();
        self.end(&points, &fan, z_mm, top);
    }

    /// An end face round a bore; gives the bore's closed outline with its normals.
    fn ring(&mut self, rim: &[DVec2], bore_radius_mm: f64, z_mm: f64, top: bool) -> Profile {
        let count = rim.len();
        let bore: Vec<DVec2> = (0..count)
            .map(|i| bore_radius_mm * DVec2::from_angle(rim[0].to_angle() + TURN_RAD * i as f64 / count as f64))
            .collect();
        // Rim and bore have equally many points; each rim point looks for the bore point in its own direction.
        let points: Vec<DVec2> = rim.iter().copied().chain(bore.iter().copied()).collect();
        let turns = |point: DVec2| (point.to_angle() - rim[0].to_angle()).rem_euclid(TURN_RAD) / TURN_RAD;
        let (mut outer, mut inner) = (0, 0);
        let mut triangles = Vec::new();
        while outer < count || inner < count {
            let place = |i: usize| if i >= count { 1.0 } else { turns(rim[i]) };
            let ahead = |i: usize| i as f64 / count as f64;
            let (o, i) = (outer % count, count + inner % count);
            if outer < count && (inner == count || place(outer + 1) <= ahead(inner + 1)) {
                triangles.push([o, (outer + 1) % count, i]);
                outer += 1;
            } else {
                triangles.push([o, count + (inner + 1) % count, i]);
                inner += 1;
            }
        }
        self.end(&points, &triangles, z_mm, top);
        bore.iter().chain([&bore[0]]).map(|&point| (point, (-point.normalize_or_zero()).extend(0.0))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{HobCutter, HobbingJob, Job};
    use crate::scene;
    use std::collections::HashMap;
    use std::path::Path;

    fn mesh(scene: &str) -> (Job, ViewMesh) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shaping").join(scene);
        let job = Job::new(scene::load(&path, &[]).expect("a shipped scene").scene).expect("a gear");
        let mesh = ViewMesh::new(&job).expect("a mesh");
        (job, mesh)
    }

    fn hobbed_mesh(name: &str) -> ViewMesh {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hobbing").join(name).with_extension("toml");
        let job = HobbingJob::new(&scene::load(&path, &[]).expect("a shipped scene").scene).expect("a gear");
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

    /// Volume by the divergence theorem against the area inside the tooth outline known from elsewhere: blank less spaces, from the pitch circle's symmetry.
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
        // A round gear with m 3, z 24: its teeth and spaces are equally wide on the pitch circle (d = 72 mm), the tooth is 3 mm high above
        // and 3.75 mm deep below it; the area inside lies between those of the root and tip circles, near that of the pitch circle.
        let disc = |radius: f64| std::f64::consts::PI * (radius * radius - 100.0) * job.scene.gear.face_width_mm;
        assert!(volume > disc(36.0 - 1.5) && volume < disc(36.0 + 0.5), "{volume} against {}", disc(36.0));
    }

    #[test]
    fn flank_corners_lie_on_the_target() {
        let (job, mesh) = mesh("elliptical_normal.toml");
        let generation = job.target_generation();
        let flank = &mesh.flanks[7];
        assert_eq!((flank.tooth, flank.side), (4, Side::Right));
        let target = job.target_flank(&generation, 4, Side::Right).expect("a flank");
        for (i, &arc) in flank.arcs_mm.iter().enumerate() {
            let corner = flank.triangles.positions_mm[2 * i + 1];
            let point = target.at_arc(arc).point_mm;
            assert!((f64::from(corner[0]) - point.x).hypot(f64::from(corner[1]) - point.y) < 1e-5);
            assert_eq!(corner[2], 15.0);
        }
    }
}

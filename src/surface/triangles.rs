//! Triangles with normals for a viewer: walls between sections, end faces, bores and rims.
//!
//! Profiles run counter-clockwise round the gear axis. The material of an external gear lies on their left, that of a
//! ring on their right, where all triangles turn over.

use super::mesh::Mesh;
use gearcut_core::dexel::Ray;
use gearcut_core::gear::GearKind;
use gearcut_core::units::TURN_RAD;
use glam::{DVec2, DVec3};

/// Points of the target in one transverse section, gear frame, mm, each with the target's unit normal out of the gear.
pub type SectionProfile = Vec<(DVec2, DVec3)>;

/// Profiles of transverse sections as points and normals in space.
pub fn in_space(profiles: &[SectionProfile], rows_z_mm: &[f64]) -> Vec<Vec<Ray>> {
    let row = |(profile, &z_mm): (&SectionProfile, &f64)| {
        profile.iter().map(|&(point, normal)| Ray { origin_mm: point.extend(z_mm), normal }).collect()
    };
    profiles.iter().zip(rows_z_mm).map(row).collect()
}

/// Triangles with a normal at every corner; counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangles {
    /// Of an external gear or of a ring.
    pub gear: GearKind,
    /// Corners, mm.
    pub positions_mm: Vec<[f32; 3]>,
    /// Unit normals at the corners.
    pub normals: Vec<[f32; 3]>,
    /// Three corners per triangle.
    pub indices: Vec<u32>,
}

impl Triangles {
    /// None yet, of an external gear or of a ring.
    pub fn of(gear: GearKind) -> Self {
        Self { gear, ..Self::default() }
    }

    /// One more corner; its index.
    pub fn corner(&mut self, point_mm: DVec3, normal: DVec3) -> u32 {
        self.positions_mm.push(point_mm.as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.positions_mm.len() as u32 - 1
    }

    /// A mesh as it is, for a viewer that finds its normals.
    pub fn add_mesh(&mut self, mesh: &Mesh) {
        let first = self.positions_mm.len() as u32;
        for &at_mm in &mesh.positions_mm {
            self.corner(at_mm, DVec3::Z);
        }
        self.indices.extend(mesh.triangles.as_flattened().iter().map(|corner| first + corner));
    }

    /// Profiles of all sections joined along the tooth; `forward`: they run counter-clockwise round the gear axis with
    /// the teeth, clockwise with its back.
    pub fn wall(&mut self, profiles: &[SectionProfile], rows_z_mm: &[f64], forward: bool) {
        self.surface(&in_space(profiles, rows_z_mm), forward == (self.gear == GearKind::External));
    }

    /// A surface of points and normals in space, row after row along the tooth, each along the profile; `forward`: the
    /// direction along the profile and the one along the tooth have the outside to their left, as x and y have z.
    pub fn surface(&mut self, rows: &[Vec<Ray>], forward: bool) {
        let (first, count) = (self.positions_mm.len() as u32, rows.len() as u32);
        for i in 0..rows[0].len() {
            for row in rows {
                self.corner(row[i].origin_mm, row[i].normal);
            }
        }
        for i in 0..rows[0].len() as u32 - 1 {
            for k in 0..count - 1 {
                let [a, b] = [k, k + 1].map(|k| first + count * i + k);
                let [c, d] = [a, b].map(|corner| corner + count);
                let quad = if forward { [a, c, d, a, d, b] } else { [a, d, c, a, b, d] };
                self.indices.extend(quad);
            }
        }
    }

    /// Flat polygons at one end of the face from triangles that, on an external gear, are counter-clockwise seen from
    /// +z.
    pub fn end(&mut self, points: &[DVec2], triangles: &[[usize; 3]], z_mm: f64, top: bool) {
        let first = self.positions_mm.len() as u32;
        for &point in points {
            self.corner(point.extend(z_mm), if top { DVec3::Z } else { DVec3::NEG_Z });
        }
        for [a, b, c] in triangles.iter().map(|triangle| triangle.map(|corner| first + corner as u32)) {
            let as_given = top == (self.gear == GearKind::External);
            self.indices.extend(if as_given { [a, b, c] } else { [a, c, b] });
        }
    }

    /// One end of one tooth: a ladder between its right and its left flank, a fan under its tip land.
    pub fn tooth_end(&mut self, [right, left, tip]: [&SectionProfile; 3], z_mm: f64, top: bool) {
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

    /// Both end faces (bottom, top) from their closed root lines (counter-clockwise) to the back, and the back; without
    /// a bore to the axis.
    pub fn rings(&mut self, roots: &[Vec<DVec2>; 2], back_radius_mm: f64, rows_z_mm: [f64; 2]) {
        let backs = [0, 1].map(|k| {
            if back_radius_mm <= 0.0 {
                self.fan(&roots[k], rows_z_mm[k], k == 1);
                return SectionProfile::new();
            }
            self.ring(&roots[k], back_radius_mm, rows_z_mm[k], k == 1)
        });
        if back_radius_mm > 0.0 {
            self.wall(&backs, &rows_z_mm, false);
        }
    }

    /// An end face without a bore.
    pub fn fan(&mut self, rim: &[DVec2], z_mm: f64, top: bool) {
        let count = rim.len();
        let points: Vec<DVec2> = rim.iter().copied().chain([DVec2::ZERO]).collect();
        let fan: Vec<[usize; 3]> = (0..count).map(|i| [i, (i + 1) % count, count]).collect();
        self.end(&points, &fan, z_mm, top);
    }

    /// An end face between the root line and the back; gives the back's closed outline with its normals.
    pub fn ring(&mut self, roots: &[DVec2], back_radius_mm: f64, z_mm: f64, top: bool) -> SectionProfile {
        let count = roots.len();
        let back: Vec<DVec2> = (0..count)
            .map(|i| back_radius_mm * DVec2::from_angle(roots[0].to_angle() + TURN_RAD * i as f64 / count as f64))
            .collect();
        // Both have equally many points; each root point looks for the back's point in its own direction.
        let points: Vec<DVec2> = roots.iter().copied().chain(back.iter().copied()).collect();
        let turns = |point: DVec2| (point.to_angle() - roots[0].to_angle()).rem_euclid(TURN_RAD) / TURN_RAD;
        let (mut at_roots, mut at_back) = (0, 0);
        let mut triangles = Vec::new();
        while at_roots < count || at_back < count {
            let place = |i: usize| if i >= count { 1.0 } else { turns(roots[i]) };
            let ahead = |i: usize| i as f64 / count as f64;
            let (o, i) = (at_roots % count, count + at_back % count);
            if at_roots < count && (at_back == count || place(at_roots + 1) <= ahead(at_back + 1)) {
                triangles.push([o, (at_roots + 1) % count, i]);
                at_roots += 1;
            } else {
                triangles.push([o, count + (at_back + 1) % count, i]);
                at_back += 1;
            }
        }
        self.end(&points, &triangles, z_mm, top);
        let normal = |point: DVec2| (-self.gear.tip_sign() * point.normalize_or_zero()).extend(0.0);
        back.iter().chain([&back[0]]).map(|&point| (point, normal(point))).collect()
    }
}

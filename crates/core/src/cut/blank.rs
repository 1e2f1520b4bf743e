//! What goes into a cut of the blank field, and what comes out of it, whatever the backend.

use crate::dexel::BlankField;
use crate::dexel::intervals::End;
use crate::math::planar_rays::Family;
use crate::passes::StrokeSet;
use crate::tool::PlanarTool;
use crate::tool::closed_tooth::ClosedTooth;
use glam::DVec2;

/// Is shown what passes take on the native backend, as they take it: slice, family, ray, both ends of the cut. On one
/// ray cuts come in order of time; rays of several tiles come at once.
pub type WatchCuts<'a> = dyn Fn(usize, Family, usize, [End; 2]) + Sync + 'a;

/// One operation over the blank field.
pub struct BlankOperation<'a> {
    /// Strokes.
    pub strokes: &'a StrokeSet,
    /// Poses of the return strokes, if they are to be checked.
    pub returns: Option<&'a StrokeSet>,
    /// The cutter.
    pub tool: &'a dyn PlanarTool,
    /// Its teeth as closed regions, one for each of its edges.
    pub teeth: &'a [ClosedTooth],
    /// Largest distance of the blank from the gear axis, mm.
    pub blank_reach_mm: f64,
    /// Whether candidates are chosen; otherwise every pass visits every ray: what candidates are compared with.
    pub cull: bool,
}

/// Work done, ray by ray and pass by pass.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BlankStats {
    /// (Ray, pass) pairs in which the ray crosses the tooth.
    pub visited: u64,
    /// Pairs that bounds could not tell clear of material, so that the crossings were solved.
    pub solved: u64,
    /// Pairs that removed material.
    pub removing: u64,
}

impl std::ops::AddAssign for BlankStats {
    fn add_assign(&mut self, other: Self) {
        self.visited += other.visited;
        self.solved += other.solved;
        self.removing += other.removing;
    }
}

/// A place where a return stroke enters material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rub {
    /// Pass after whose stroke it happens, by id: stroke and cutter tooth.
    pub pass: u32,
    /// Slice of the field.
    pub slice: u32,
    /// Middle of the entered material, gear frame.
    pub place_mm: DVec2,
    /// How deep the edge goes in, along its normal, mm: at most as far as it has moved along it since its stroke; 0 on
    /// rays that graze it, whose place the other family's rays know.
    pub depth_mm: f64,
    /// Volume of the ray's share, mm3, for one family of rays.
    pub volume_mm3: f64,
    /// Family of the ray.
    pub family: Family,
}

/// What an operation did to the blank field.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BlankCut {
    /// Volume that each pass removed by family X and Y, mm3, from the operation's first pass on.
    pub removed_mm3: Vec<[f64; 2]>,
    /// Where return strokes rub, in order of slice, family, ray and time.
    pub rubs: Vec<Rub>,
    /// Work done.
    pub stats: BlankStats,
}

/// The whole gear after all operations, and what each of them did.
#[derive(Debug, Clone, PartialEq)]
pub struct CutBlank {
    /// What is left.
    pub field: BlankField,
    /// Volume of the uncut blank by both families, mm3.
    pub blank_mm3: [f64; 2],
    /// Volume after each operation by both families, mm3.
    pub left_mm3: Vec<[f64; 2]>,
    /// What each operation did.
    pub cuts: Vec<BlankCut>,
}

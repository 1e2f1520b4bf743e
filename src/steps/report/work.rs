//! The work stroke by stroke on the page, for every process that has strokes there.
//!
//! In: the blank, and what the native kernels say of every cut ([`RemovalWatch`]). Out: slabs of the gear with the
//! place of the slider from which each node of their sections is gone. Where all sections are alike a single slab, the
//! section in the middle of the face, is the whole face; otherwise several share it, sections of both end faces among
//! them.
//!
//! The grid is as fine as the [`Slabs`] allow: the page grows by some 100 kB for any gear. What is measured comes
//! from the fields of the job; nothing is read off this one.

use crate::output::report::viewer::work::{OUTSIDE, STAYS, ViewerSlab, ViewerWork};
use crate::scene::Scene;
use gearcut_core::dexel::removal::{Removal, RemovalWatch};
use gearcut_core::dexel::{BlankField, BlankGrid, NO_PASS};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::blank::Blank;
use gearcut_core::gear::blank_outline::BlankOutline;

/// How many slabs a gear has, and nodes in the spaces of all of them.
struct Slabs {
    count: u32,
    nodes: f64,
}

/// Where sections are alike, and where they differ: these cost more bytes a node, and more time.
const ALIKE: Slabs = Slabs { count: 1, nodes: 26_000.0 };
const DIFFERENT: Slabs = Slabs { count: 5, nodes: 18_000.0 };
/// Area of the spaces in modules times the pitch curve's length: half of a depth of 2.25 modules.
const SPACES_MODULES: f64 = 1.125;

/// The uncut blank for the page; all sections `alike` or not.
///
/// # Errors
/// A field that does not fit in memory.
pub fn field(scene: &Scene, blank: &Blank, alike: bool) -> Result<BlankField, Refusal> {
    let outline = BlankOutline::new(blank);
    let face_mm = scene.gear.face_width_mm;
    let slabs = if alike { ALIKE } else { DIFFERENT };
    let count = f64::from(slabs.count);
    let spaces_mm2 = SPACES_MODULES * scene.gear.module_mm * blank.curve().perimeter_mm();
    let spacing_mm = (spaces_mm2 * count / slabs.nodes).sqrt();
    let slice_spacing_mm = (!alike).then(|| face_mm / (count - 1.0));
    Ok(BlankField::new(BlankGrid::new(blank, &outline, face_mm, spacing_mm, slice_spacing_mm)?, &outline))
}

/// The work for the page: `cut` takes all operations from the field, natively, and shows every cut to the watch; ids of
/// the last passes before the places of the slider, in order.
///
/// # Errors
/// Those of `cut`.
pub fn watched(
    field: BlankField,
    last_passes: &[u32],
    cut: impl FnOnce(BlankField, &RemovalWatch) -> Result<()>,
) -> Result<ViewerWork> {
    let grid = field.grid.clone();
    let watch = RemovalWatch::new(&field);
    cut(field, &watch)?;
    let [y, x] = grid.rows;
    // A pass is gone from the first place that comes after it; passes after the last one that is shown with that.
    let most = last_passes.len().min(usize::from(STAYS) - 1);
    let place = |node: Option<u32>| match node {
        None => OUTSIDE,
        Some(NO_PASS) => STAYS,
        Some(pass) => (last_passes.partition_point(|&last| last < pass) + 1).min(most) as u16,
    };
    let half_mm = 0.5 * grid.face_width_mm;
    let z_mm = &grid.slices_z_mm;
    let slab = |(index, removal): (usize, Removal)| {
        let between = |one: usize| z_mm.get(one + 1).map(|next| 0.5 * (z_mm[one] + next));
        let low_mm = index.checked_sub(1).and_then(between).unwrap_or(-half_mm);
        ViewerSlab {
            z_mm: [low_mm, between(index).unwrap_or(half_mm)],
            gone_from: removal.nodes.into_iter().map(place).collect(),
            edges: removal.edges,
        }
    };
    Ok(ViewerWork {
        corner_mm: [x.first_mm, y.first_mm],
        spacing_mm: grid.spacing_mm(),
        counts: [x.count, y.count],
        slabs: watch.finish().into_iter().enumerate().map(slab).collect(),
    })
}

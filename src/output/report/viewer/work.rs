//! The work while it is cut, for the page's 3D view: slabs of the gear along its axis, each with the place of the
//! slider from which every node of its section is gone.
//!
//! In: slabs with nodes on one square grid. Out: bytes and their description; `assets/report/work.js` draws from them
//! the section after any stroke, as the walls and caps between nodes that are material and nodes that are not.
//!
//! Road not taken: cutting in the page, by the program itself as a wasm module. It would show the same places, add
//! some 4 MB to every report and a build for browsers to every build of the program, and need WebGPU in the reader's
//! browser. Places of nodes are some 100 kB, and any browser that draws the gear draws them.

use super::Arrays;
use gearcut_core::dexel::removal::EDGE_STEPS;
use serde_json::{Value, json};

/// Place of a node that stays.
pub const STAYS: u16 = u16::MAX;
/// Place of a node outside of the blank; strokes begin at 1.
pub const OUTSIDE: u16 = 0;

/// The work as slabs.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerWork {
    /// First node in x and y, mm.
    pub corner_mm: [f64; 2],
    /// Distance of nodes, mm.
    pub spacing_mm: f64,
    /// Nodes along x and y.
    pub counts: [usize; 2],
    /// Slabs from the lowest to the highest.
    pub slabs: Vec<ViewerSlab>,
}

/// A part of the face that is drawn by one section.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewerSlab {
    /// Where it begins and ends along the gear's axis, mm.
    pub z_mm: [f64; 2],
    /// Place of the slider from which a node is gone, row by row along x.
    pub gone_from: Vec<u16>,
    /// Where the surface lies on the edges from each node along x and along y, in steps of [`EDGE_STEPS`].
    pub edges: [Vec<u8>; 2],
}

impl ViewerWork {
    /// Adds its bytes to the page's and says where they are: for every slab the high bytes of the nodes' places, the
    /// low ones, edges along x, edges along y.
    pub(super) fn packed(&self, block: &mut Arrays) -> Value {
        let slabs = self.slabs.iter().map(|slab| {
            let places = &slab.gone_from;
            let halves = [0, 1].map(|half: usize| places.iter().map(move |place| place.to_be_bytes()[half]));
            let edges = slab.edges.iter().flatten().copied();
            json!({"z": slab.z_mm, "at": block.add(halves.into_iter().flatten().chain(edges))})
        });
        let slabs: Vec<Value> = slabs.collect();
        json!({
            "corner": self.corner_mm,
            "step": self.spacing_mm,
            "counts": self.counts,
            "edge_steps": EDGE_STEPS,
            "slabs": slabs,
        })
    }
}

//! Closed meshes of small fields whose inside nodes are given.

use super::BlankMesh;
use gearcut_core::dexel::BlankGrid;
use gearcut_core::dexel::blank_field::Slice;
use gearcut_core::dexel::blank_field::{BlankField, RayMaterial};
use gearcut_core::dexel::intervals::{End, Span};
use gearcut_core::math::planar_rays::RayRow;
use proptest::prelude::*;

/// Both families of a field whose inside nodes are given; surfaces a third of a cell beside the nodes.
fn field(size: usize, slices: usize, inside: impl Fn(usize, usize, usize) -> bool) -> BlankField {
    let row = RayRow { first_mm: 0.0, spacing_mm: 1.0, count: size + 2 };
    let node = |s: usize, i: usize, j: usize| (1..=size).contains(&i) && (1..=size).contains(&j) && inside(s, i, j);
    let end = |at_mm: f64, normal: [f32; 2]| End { at_mm, pass: at_mm as u32, normal };
    let ray = |along_x: bool, s: usize, r: usize| -> RayMaterial {
        let here = |k: usize| if along_x { node(s, k, r) } else { node(s, r, k) };
        let out = |sign: f32| if along_x { [sign, 0.0] } else { [0.0, sign] };
        let mut spans = Vec::new();
        let mut from = None;
        for k in 1..size + 2 {
            match (here(k - 1), here(k)) {
                (false, true) => from = Some(k as f64 - 1.0 / 3.0),
                (true, false) => spans.push(Span {
                    low: end(from.expect("begun"), out(-1.0)),
                    high: end(k as f64 - 2.0 / 3.0, out(1.0)),
                }),
                _ => {}
            }
        }
        spans
    };
    let slice = |s: usize| Slice { rays: [true, false].map(|x| (0..size + 2).map(|r| ray(x, s, r)).collect()) };
    let slices_z_mm = (0..slices).map(|s| s as f64 - 0.5 * (slices as f64 - 1.0)).collect();
    let face_width_mm = (slices as f64 - 1.0).max(1.0);
    let grid = BlankGrid { rows: [row; 2], slices_z_mm, face_width_mm };
    BlankField { grid, slices: (0..slices).map(slice).collect() }
}

#[test]
fn a_square_bar_keeps_its_edges_and_volume() {
    for slices in [1, 4] {
        let field = field(6, slices, |_, i, j| (2..=4).contains(&i) && (3..=5).contains(&j));
        let BlankMesh { mesh, guessed } = BlankMesh::new(&field, None);
        assert!(mesh.is_closed() && guessed == 0, "{:?}", mesh.edge_faults());
        let side = 2.0 + 2.0 / 3.0;
        assert!((mesh.volume_mm3() - side * side * field.grid.face_width_mm).abs() < 1e-9);
    }
}

proptest! {
    /// Whatever the nodes: checkerboards, islands and holes through all slices.
    #[test]
    fn random_nodes_give_closed_meshes(
        nodes in proptest::collection::vec(any::<bool>(), 192),
        slices in 1_usize..4,
    ) {
        let field = field(8, slices, |s, i, j| nodes[64 * s + 8 * (i - 1) + j - 1]);
        let mesh = BlankMesh::new(&field, None).mesh;
        prop_assume!(!mesh.triangles.is_empty());
        prop_assert!(mesh.is_closed(), "{:?}", mesh.edge_faults());
        prop_assert!(mesh.volume_mm3() > 0.0);
    }
}

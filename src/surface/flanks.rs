//! A flank or root as a grid of surface points, thinned out to the spacing of meshes.
//!
//! In: a field and what the operations left on it. Out: [`SurfaceGrid`]: points on the finished surface with their
//! outward normals, the normal deviation, the stock of the operation before the last one and the pass that left
//! the point; and the same as a [`Mesh`].
//!
//! Columns are the dexels nearest to places `spacing_mm` apart, the first and the last one always among them: every
//! vertex lies on the cut surface, nothing is averaged. Rows come from the same spacing, but where the surface runs
//! straight along the tooth to [`STRAIGHT_MM`] the rows between are left out: strokes whose axes rest leave two rows
//! per flank, whatever its width. Helical flanks keep all rows: they wind about the axis.

use super::mesh::{Mesh, MeshPart, Scalar, ScalarValues};
use gearcut_core::dexel::{Layer, NO_PASS, RayGrid};
use gearcut_core::units::UM_PER_MM;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Rows are left out where straight lines between the others miss no height by more than this, mm: a tenth of a
/// micrometre, below any machine's accuracy.
pub const STRAIGHT_MM: f64 = 1e-4;

/// Points of the finished surface over one flank or root, column by column (rows contiguous).
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceGrid {
    /// Arc length of each column along the target profile, mm.
    pub arcs_mm: Vec<f64>,
    /// Place of each row along the tooth, mm, increasing.
    pub rows_mm: Vec<f64>,
    /// Unit normal of the target out of the gear, of each column in the first row.
    pub normals: Vec<DVec3>,
    /// Whether all sections have one target profile, so that straight heights are straight lines.
    pub is_straight: bool,
    /// Points on the surface, gear frame, mm.
    pub points_mm: Vec<DVec3>,
    /// Normal deviation, µm.
    pub height_um: Vec<f32>,
    /// Normal stock that the last operation found: the surface before it less the surface after it, mm; NaN where one
    /// of them is the blank's own, `None` if there was one operation only.
    pub stock_mm: Option<Vec<f32>>,
    /// Pass that left the point; [`NO_PASS`] on the blank's own surface.
    pub passes: Vec<u32>,
}

impl SurfaceGrid {
    /// Grid with columns and rows about `spacing_mm` apart (never closer than the dexels); `layers` as the operations
    /// left them, in order.
    ///
    /// # Panics
    /// No layer or no dexel.
    pub fn new(field: &impl RayGrid, layers: &[Layer], spacing_mm: f64) -> Self {
        Self::of_rows(field, layers, 0..field.rows_mm().len(), spacing_mm)
    }

    /// [`SurfaceGrid::new`] of some of the rows.
    ///
    /// # Panics
    /// No layer or no dexel.
    pub fn of_rows(field: &impl RayGrid, layers: &[Layer], among: Range<usize>, spacing_mm: f64) -> Self {
        let last = layers.last().expect("a job has at least one operation");
        let before = layers.len().checked_sub(2).map(|i| &layers[i]);
        let (arcs_mm, rows_mm) = (field.arcs_mm(), field.rows_mm());
        let columns = spaced(&arcs_mm, spacing_mm);
        let first = among.start;
        let mut rows: Vec<usize> = spaced(&rows_mm[among], spacing_mm).into_iter().map(|row| first + row).collect();
        let all = rows_mm.len();
        if field.is_straight() {
            rows = straight_rows(rows_mm, &rows, STRAIGHT_MM, |from, to, visit| {
                for &column in &columns {
                    for layer in [Some(last), before].into_iter().flatten() {
                        let heights_mm = layer.column(column, all);
                        if !visit(f64::from(heights_mm[to]) - f64::from(heights_mm[from])) {
                            return;
                        }
                    }
                }
            });
        }
        let places = || columns.iter().flat_map(|&column| rows.iter().map(move |&row| (column, row)));
        let dexels = || places().map(|(column, row)| column * all + row);
        let stock_mm = before.map(|before| {
            // Where no pass came, the blank stands: what the last operation found there ends with the ray, not with a
            // surface.
            let cut = |i: usize| before.passes[i] != NO_PASS && last.passes[i] != NO_PASS;
            let stock = |i: usize| if cut(i) { before.heights_mm[i] - last.heights_mm[i] } else { f32::NAN };
            dexels().map(stock).collect::<Vec<f32>>()
        });
        Self {
            arcs_mm: columns.iter().map(|&c| arcs_mm[c]).collect(),
            rows_mm: rows.iter().map(|&r| rows_mm[r]).collect(),
            normals: columns.iter().map(|&c| field.normal(c, rows[0])).collect(),
            is_straight: field.is_straight(),
            points_mm: places().map(|(c, r)| field.point_mm(c, r, f64::from(last.heights_mm[c * all + r]))).collect(),
            height_um: dexels().map(|i| last.heights_mm[i] * UM_PER_MM as f32).collect(),
            stock_mm,
            passes: dexels().map(|i| last.passes[i]).collect(),
        }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.arcs_mm.len()
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows_mm.len()
    }

    /// Point of a column and row in space, mm.
    pub fn position_mm(&self, column: usize, row: usize) -> DVec3 {
        self.points_mm[column * self.rows() + row]
    }

    /// Whether no pass came to a point, so that it lies on the blank's own surface or nowhere.
    pub fn is_uncut(&self, column: usize, row: usize) -> bool {
        self.passes[column * self.rows() + row] == NO_PASS
    }

    /// The grid as triangles, one part of this name, with `height_um`, `stock_mm` (if there is) and `pass_id`.
    pub fn mesh(&self, name: &str) -> Mesh {
        let (columns, rows) = (self.columns(), self.rows());
        // Which way round is outside depends on the directions of columns and rows.
        let first = self.points_mm[0];
        let [profile, tooth] = [(columns - 1) * rows, rows - 1].map(|corner| self.points_mm[corner] - first);
        let outward = profile.cross(tooth).dot(self.normals[columns / 2]) > 0.0;
        let at = |c: usize, r: usize| (c * rows + r) as u32;
        let triangles: Vec<[u32; 3]> = (1..columns)
            .flat_map(|c| (1..rows).map(move |r| (c, r)))
            .flat_map(|(c, r)| {
                let [a, b, d, e] = [at(c - 1, r - 1), at(c, r - 1), at(c, r), at(c - 1, r)];
                if outward { [[a, b, d], [a, d, e]] } else { [[a, d, b], [a, e, d]] }
            })
            .collect();
        let parts = vec![MeshPart { name: name.to_owned(), triangles: 0..triangles.len(), measured: true }];
        Mesh { positions_mm: self.points_mm.clone(), triangles, scalars: self.scalars(), parts }
    }

    /// The values as quantities of a mesh whose vertices are these points, in order.
    pub fn scalars(&self) -> Vec<Scalar> {
        let height = Some(height_scalar(self.height_um.clone()));
        let stock = self.stock_mm.clone().map(stock_scalar);
        [height, stock, Some(pass_scalar(self.passes.clone()))].into_iter().flatten().collect()
    }
}

/// Points on the surface after the last operation, section by section, of rays that stay in their sections.
///
/// # Panics
/// No layer.
pub fn points_of_sections(field: &impl RayGrid, layers: &[Layer]) -> Vec<Vec<DVec2>> {
    let last = layers.last().expect("a job has at least one operation");
    let rows = field.rows_mm().len();
    let point = |c: usize, r: usize| field.point_mm(c, r, f64::from(last.heights_mm[c * rows + r])).truncate();
    (0..rows).map(|r| (0..field.arcs_mm().len()).map(|c| point(c, r)).collect()).collect()
}

/// Normal deviation as a quantity.
pub fn height_scalar(values: Vec<f32>) -> Scalar {
    Scalar {
        name: "height_um",
        unit: "um",
        definition: "normal deviation from the target after the last operation".to_owned(),
        values: ScalarValues::F32(values),
    }
}

/// Stock as a quantity.
pub fn stock_scalar(values: Vec<f32>) -> Scalar {
    Scalar {
        name: "stock_mm",
        unit: "mm",
        definition: "normal stock that the last operation found".to_owned(),
        values: ScalarValues::F32(values),
    }
}

/// Pass ids as a quantity.
pub fn pass_scalar(values: Vec<u32>) -> Scalar {
    Scalar {
        name: "pass_id",
        unit: "1",
        definition: format!("pass that left the point, counted in time; {NO_PASS} where none came"),
        values: ScalarValues::U32(values),
    }
}

/// Indices of the places nearest to multiples of `spacing_mm` from the first one; first and last always among them.
fn spaced(places_mm: &[f64], spacing_mm: f64) -> Vec<usize> {
    let (first, last) = (places_mm[0], places_mm[places_mm.len() - 1]);
    let intervals = ((last - first) / spacing_mm).round().max(1.0) as usize;
    let mut indices: Vec<usize> = (0..=intervals)
        .map(|i| {
            let place_mm = first + (last - first) * i as f64 / intervals as f64;
            let after = places_mm.partition_point(|&p| p < place_mm).min(places_mm.len() - 1);
            let before = after.saturating_sub(1);
            if places_mm[after] - place_mm < place_mm - places_mm[before] { after } else { before }
        })
        .collect();
    indices[intervals] = places_mm.len() - 1;
    indices.dedup();
    indices
}

/// Those of the `candidates` between which everything runs straight to `within_mm`.
///
/// `differences(from, to, visit)` visits the differences of all heights between two rows, in the same order at every
/// call, until `visit` returns false. Each height keeps the window of slopes that its rows so far allow (the cone
/// method of Williams, 1978): one look at every dexel.
pub(super) fn straight_rows(
    rows_z_mm: &[f64],
    candidates: &[usize],
    within_mm: f64,
    differences: impl Fn(usize, usize, &mut dyn FnMut(f64) -> bool),
) -> Vec<usize> {
    let mut kept = vec![candidates[0]];
    let mut windows: Vec<[f64; 2]> = Vec::new();
    let mut next = 1;
    while next < candidates.len() {
        let (from, to) = (kept[kept.len() - 1], candidates[next]);
        let length_mm = rows_z_mm[to] - rows_z_mm[from];
        let mut straight = true;
        let mut index = 0;
        let tolerance = within_mm / length_mm;
        differences(from, to, &mut |difference_mm| {
            let slope = difference_mm / length_mm;
            if index == windows.len() {
                windows.push([f64::NEG_INFINITY, f64::INFINITY]);
            }
            let [low, high] = &mut windows[index];
            straight = slope >= *low && slope <= *high;
            *low = low.max(slope - tolerance);
            *high = high.min(slope + tolerance);
            index += 1;
            straight
        });
        if straight {
            next += 1;
        } else {
            kept.push(candidates[next - 1]);
            windows.clear();
        }
    }
    kept.push(candidates[candidates.len() - 1]);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::dexel::{Column, Field};

    /// Part of a cylinder of radius 50 mm on the left of a tooth: `columns` dexels 5 µm apart, rows 50 µm apart over 10
    /// mm.
    fn field(columns: usize) -> Field {
        let columns = (0..columns)
            .map(|i| {
                let arc_mm = 0.005 * i as f64;
                let normal = DVec2::from_angle(1.5 - arc_mm / 50.0);
                Column { arc_mm, origin_mm: 50.0 * normal, normal, low_mm: -1.0, blank_mm: 3.0 }
            })
            .collect();
        Field { columns, rows_z_mm: (0..=200).map(|i| 0.05 * f64::from(i) - 5.0).collect() }
    }

    fn layer(field: &Field, height_mm: impl Fn(f64, f64) -> f64) -> Layer {
        let heights_mm = field
            .columns
            .iter()
            .flat_map(|c| field.rows_z_mm.iter().map(|&v| height_mm(c.arc_mm, v) as f32).collect::<Vec<_>>())
            .collect();
        Layer { heights_mm, passes: vec![7; field.len()] }
    }

    #[test]
    fn straight_flanks_need_two_rows_and_keep_their_ends() {
        let field = field(1003);
        let layers = [layer(&field, |_, _| 0.7), layer(&field, |u, v| 0.01 * u.sin() + 0.002 * v)];
        let grid = SurfaceGrid::new(&field, &layers, 0.1);
        assert_eq!((grid.rows(), grid.columns()), (2, 51));
        assert_eq!([grid.rows_mm[0], grid.rows_mm[1]], [-5.0, 5.0]);
        assert_eq!(grid.arcs_mm[50], 0.005 * 1002.0);
        for c in 0..51 {
            let (u, z) = (grid.arcs_mm[c], grid.position_mm(c, 1));
            let height = 0.01 * u.sin() + 0.01;
            assert!((z.truncate().length() - 50.0 - height).abs() < 1e-8);
            assert!(
                (f64::from(grid.stock_mm.as_ref().expect("two operations")[2 * c + 1]) - 0.7 + height).abs() < 1e-6
            );
        }
    }

    #[test]
    fn what_is_left_out_is_straight_to_the_tolerance() {
        let field = field(40);
        let height = |u: f64, v: f64| 0.002 * (2.0 * v + u).sin() + if v > 2.0 { 0.003 } else { 0.0 };
        let layers = [layer(&field, height)];
        let grid = SurfaceGrid::new(&field, &layers, 0.005);
        assert!(grid.rows() > 20 && grid.rows() < 100, "{} rows", grid.rows());
        let mut worst = 0.0_f64;
        for (c, &u) in grid.arcs_mm.iter().enumerate() {
            for &v in &field.rows_z_mm {
                let r = grid.rows_mm.partition_point(|&l| l <= v).clamp(1, grid.rows() - 1);
                let (a, b) = (grid.rows_mm[r - 1], grid.rows_mm[r]);
                let h = |r: usize| f64::from(grid.height_um[c * grid.rows() + r]) * 1e-3;
                let between = h(r - 1) + (h(r) - h(r - 1)) * (v - a) / (b - a);
                worst = worst.max((between - height(u, v)).abs());
            }
        }
        assert!(worst <= STRAIGHT_MM * 1.001, "{worst}");
        assert!(worst > 0.2 * STRAIGHT_MM, "the tolerance is made use of: {worst}");
    }

    #[test]
    fn triangles_face_outwards_on_both_sides_of_a_tooth() {
        let left = field(300);
        let mut right = left.clone();
        right.columns.reverse();
        for (column, i) in right.columns.iter_mut().zip(0..) {
            column.arc_mm = 0.005 * f64::from(i);
        }
        for field in [left, right] {
            let grid = SurfaceGrid::new(&field, &[layer(&field, |_, v| 0.001 * v * v)], 0.1);
            let mesh = grid.mesh("tooth_01_left");
            assert_eq!(mesh.triangles.len(), 2 * (grid.rows() - 1) * (grid.columns() - 1));
            for t in 0..mesh.triangles.len() {
                let outward = mesh.corners_mm(t)[0].truncate().normalize();
                assert!(mesh.scaled_normal(t).truncate().dot(outward) > 0.0);
            }
            let names: Vec<&str> = mesh.scalars.iter().map(|s| s.name).collect();
            assert_eq!(names, ["height_um", "pass_id"]);
            // A strip of a cylinder, bulged by 0.001 v^2: mean of 1 + h / 50 and of the slope's square over v.
            let bulged = 1.0 + 0.001 * 25.0 / 3.0 / 50.0 + 0.5 * 0.002_f64.powi(2) * 25.0 / 3.0;
            assert!((mesh.area_mm2() - 10.0 * 0.005 * 299.0 * bulged).abs() < 1e-4);
        }
    }
}

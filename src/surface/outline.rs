//! The transverse outline of the cut gear, row by row: flanks, roots and tips in one closed chain of columns.
//!
//! In: the grids of all flanks, roots and tips. Out: [`Outline`]: columns in the order of growing polar angle, each
//! with one point per row, so that neighbouring rows can be lofted. Rows are left out where straight lines between the
//! others miss no height of any grid by more than is asked for ([`BODY_MM`] for files), that is no dexel by a tenth of
//! a micrometre more ([`STRAIGHT_MM`](super::flanks::STRAIGHT_MM)).
//!
//! The order follows from the gear alone: right flank of a tooth from form point to tip, its tip land, its left flank
//! down again, the root of the space behind it, and so on. What no pass reached (tip lands, teeth outside a window) is
//! the blank's own outline. Roots end where flanks begin, undercut or not: nothing lies behind, and no crossing is
//! sought.

use super::flanks::{SurfaceGrid, straight_rows};
use gearcut_core::dexel::NO_PASS;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;
use std::f64::consts::TAU;

/// Columns nearer than this to the one before are left out, mm: written files are f32, whose ulp reaches 0.03 µm on the
/// largest gears.
const NEAREST_MM: f64 = 1e-4;
/// Rows of a written body are left out within this, mm: rays at the tip of one tooth end on the blank here and in the
/// cut there, each at another place, and a tenth of it would keep nearly every row for their sake.
pub const BODY_MM: f64 = 1e-3;
/// A miss of the stock counts as so much of one of the surface: it is shown as a colour between zero and some tenths of
/// a millimetre.
pub const STOCK_SHARE: f64 = 0.1;
/// Points of the blank's own outline stand this far apart along it, mm per mm of its radius: a chord error of 0.3 µm at
/// 60 mm.
const OUTLINE_STEP: f64 = 1.0 / 300.0;

/// All surfaces of a cut gear.
#[derive(Debug, Clone, PartialEq)]
pub struct GearSurfaces {
    /// Teeth in order, from tooth 1.
    pub teeth: Vec<ToothSurfaces>,
}

/// Surfaces of one tooth and of the space behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothSurfaces {
    /// Right flank (smaller arc), from the form point.
    pub right: SurfaceGrid,
    /// Tip land from the right flank to the left one; `None` where there is hardly any.
    pub tip: Option<SurfaceGrid>,
    /// Left flank (larger arc), from the form point.
    pub left: SurfaceGrid,
    /// Root of the space after the tooth, from its left flank on.
    pub root: SurfaceGrid,
}

/// One column of the outline.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlineColumn {
    /// Point of every row, gear frame, mm.
    pub points_mm: Vec<DVec2>,
    /// Normal deviation, µm; NaN on the blank's own outline.
    pub height_um: Vec<f32>,
    /// Stock that the last operation found, mm; NaN where there is none.
    pub stock_mm: Vec<f32>,
    /// Pass that left the point.
    pub passes: Vec<u32>,
    /// Index of its part in [`Outline::parts`].
    pub part: usize,
}

/// The outline of all rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Place of each row along the tooth, mm, increasing.
    pub rows_z_mm: Vec<f64>,
    /// Columns counter-clockwise; the last one is followed by the first.
    pub columns: Vec<OutlineColumn>,
    /// Names of the parts, in the order of the columns: `tooth_07_right`, `tip_07`, `tooth_07_left`, `root_07`.
    pub parts: Vec<String>,
    /// Whether the values have a stock.
    pub has_stock: bool,
}

/// `tooth_07_left`: the name of a flank in files.
pub fn flank_name(tooth: u32, side: Side) -> String {
    format!("tooth_{tooth:02}_{}", side.name())
}

/// Columns that no pass reached, on their way to become the blank's own outline.
#[derive(Debug, Default)]
struct UncutColumns {
    /// Part that the outline's points will belong to.
    part: Option<usize>,
}

impl Outline {
    /// Outline of a gear; rows are left out within `within_mm`.
    pub fn new(surfaces: &GearSurfaces, blank: &Blank, within_mm: f64) -> Self {
        let rows_z_mm = common_rows(surfaces, within_mm);
        let has_stock = surfaces.teeth.iter().all(|t| t.right.stock_mm.is_some());
        let mut outline = Self { rows_z_mm, columns: Vec::new(), parts: Vec::new(), has_stock };
        let mut gap = UncutColumns::default();
        for (number, tooth) in (1..).zip(&surfaces.teeth) {
            let all = |grid: &SurfaceGrid| (0..grid.columns()).collect::<Vec<_>>();
            outline.begin(flank_name(number, Side::Right));
            outline.append(&tooth.right, &all(&tooth.right), blank, &mut gap);
            outline.begin(format!("tip_{number:02}"));
            if let Some(tip) = &tooth.tip {
                outline.append(tip, &tip_columns(tooth, tip, blank), blank, &mut gap);
            }
            outline.begin(flank_name(number, Side::Left));
            let down: Vec<usize> = (0..tooth.left.columns()).rev().collect();
            outline.append(&tooth.left, &down, blank, &mut gap);
            outline.begin(format!("root_{number:02}"));
            let root = all(&tooth.root);
            match blank.dwell() {
                Some(dwell) if number as usize == surfaces.teeth.len() => {
                    let (last, first) = root.split_at(behind_widest_step(&tooth.root));
                    outline.append(&tooth.root, last, blank, &mut gap);
                    let end_mm = |column: usize| tooth.root.points_mm[column * tooth.root.rows()].truncate();
                    let ends_mm = [last[last.len() - 1], first[0]].map(end_mm);
                    for [point_mm, _] in dwell.path_mm(ends_mm, OUTLINE_STEP * dwell.radius_mm) {
                        let column = outline.bare(point_mm);
                        outline.push(column);
                    }
                    outline.append(&tooth.root, first, blank, &mut gap);
                }
                _ => outline.append(&tooth.root, &root, blank, &mut gap),
            }
        }
        outline.close(blank, &gap);
        outline
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows_z_mm.len()
    }

    /// Points of one row, counter-clockwise.
    pub fn row_mm(&self, row: usize) -> Vec<DVec2> {
        self.columns.iter().map(|column| column.points_mm[row]).collect()
    }

    fn begin(&mut self, part: String) {
        self.parts.push(part);
    }

    /// A column on which nothing was measured.
    fn bare(&self, point_mm: DVec2) -> OutlineColumn {
        let rows = self.rows();
        OutlineColumn {
            points_mm: vec![point_mm; rows],
            height_um: vec![f32::NAN; rows],
            stock_mm: vec![f32::NAN; rows],
            passes: vec![NO_PASS; rows],
            part: self.parts.len() - 1,
        }
    }

    fn push(&mut self, column: OutlineColumn) {
        let near =
            |a: &OutlineColumn| a.points_mm.iter().zip(&column.points_mm).any(|(a, b)| a.distance(*b) < NEAREST_MM);
        if !self.columns.last().is_some_and(near) {
            self.columns.push(column);
        }
    }

    /// Appends columns of a grid in the given order. Those that no pass reached become the blank's outline.
    fn append(&mut self, grid: &SurfaceGrid, order: &[usize], blank: &Blank, gap: &mut UncutColumns) {
        let part = self.parts.len() - 1;
        let uncut = |column: usize| (0..grid.rows()).all(|row| grid.is_uncut(column, row));
        for (i, &column) in order.iter().enumerate() {
            let neighbours = [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(|k| order.get(k));
            // The last uncut column before a cut one is the corner between the blank's surface and the cut.
            if uncut(column) && neighbours.copied().all(uncut) {
                if gap.part.is_none() || self.parts[part].starts_with("tip") {
                    gap.part = Some(part);
                }
                continue;
            }
            let column = self.sample(grid, column, blank);
            if let Some(part) = gap.part.take()
                && let Some(last) = self.columns.last()
            {
                let from_mm = last.points_mm.clone();
                self.fill([&from_mm, &column.points_mm], part, blank);
            }
            self.push(column);
        }
    }

    /// One column of a grid at all rows of the outline.
    fn sample(&self, grid: &SurfaceGrid, column: usize, blank: &Blank) -> OutlineColumn {
        let mut sampled = self.bare(DVec2::ZERO);
        let rows = grid.rows();
        for (row, &z_mm) in self.rows_z_mm.iter().enumerate() {
            let place = RowPlace::of(&grid.rows_mm, z_mm);
            let a = column * rows + place.before;
            let nearest = if place.share < 0.5 { a } else { a + 1 };
            sampled.passes[row] = grid.passes[nearest];
            let [from, to] = [a, a + 1].map(|at| grid.points_mm[at].truncate());
            let between = |values: &[f32]| place.between(column * rows, values);
            sampled.points_mm[row] = from + place.share * (to - from);
            if grid.passes[nearest] == NO_PASS {
                sampled.points_mm[row] = blank.outline_mm(outline_angle(blank, sampled.points_mm[row]));
                continue;
            }
            sampled.height_um[row] = between(&grid.height_um);
            if let Some(stock_mm) = &grid.stock_mm {
                sampled.stock_mm[row] = between(stock_mm);
            }
        }
        sampled
    }

    /// The blank's outline between two points of every row, ends left out.
    fn fill(&mut self, ends_mm: [&[DVec2]; 2], part: usize, blank: &Blank) {
        // Angle at which each row begins, and how far it goes: nearly the same in all rows, each turned by its own
        // helix angle.
        let whole = self.columns.is_empty();
        let rows: Vec<[f64; 2]> = ends_mm[0]
            .iter()
            .zip(ends_mm[1])
            .map(|(&from_mm, &to_mm)| {
                let from = outline_angle(blank, from_mm);
                [from, if whole { TAU } else { (outline_angle(blank, to_mm) - from).rem_euclid(TAU) }]
            })
            .collect();
        let angle = rows[0][1];
        if !whole && angle > 0.999 * TAU {
            return; // the two ends have met
        }
        let count = (angle / OUTLINE_STEP).ceil() as u32;
        for i in u32::from(!whole)..count {
            let share = f64::from(i) / f64::from(count);
            let mut column = self.bare(DVec2::ZERO);
            column.points_mm = rows.iter().map(|[from, angle]| blank.outline_mm(from + share * angle)).collect();
            column.part = part;
            self.push(column);
        }
    }

    /// From the last column back to the first one.
    fn close(&mut self, blank: &Blank, gap: &UncutColumns) {
        let near = |a: &OutlineColumn, b: &OutlineColumn| {
            a.points_mm.iter().zip(&b.points_mm).any(|(a, b)| a.distance(*b) < NEAREST_MM)
        };
        if let Some(part) = gap.part {
            let rows = self.rows();
            let at = |column: Option<&OutlineColumn>| column.map_or(vec![DVec2::X; rows], |c| c.points_mm.clone());
            let [from_mm, to_mm] = [at(self.columns.last()), at(self.columns.first())];
            self.fill([&from_mm, &to_mm], part, blank);
        }
        while self.columns.len() > 3 && near(&self.columns[self.columns.len() - 1], &self.columns[0]) {
            self.columns.pop();
        }
    }
}

/// Columns of a tip land without those that end on a flank below its own end: on a tooth that is displaced along the
/// curve they find the flank again, and the outline would fold.
fn tip_columns(tooth: &ToothSurfaces, tip: &SurfaceGrid, blank: &Blank) -> Vec<usize> {
    let height_mm = |grid: &SurfaceGrid, column: usize| {
        let points_mm = &grid.points_mm[column * grid.rows()..][..grid.rows()];
        let heights_mm = points_mm.iter().map(|point| blank.height(point.truncate(), point.truncate().to_angle()).0);
        heights_mm.fold(f64::INFINITY, f64::min)
    };
    let end_mm = |flank: &SurfaceGrid| height_mm(flank, flank.columns() - 1) - NEAREST_MM;
    let [right_mm, left_mm] = [&tooth.right, &tooth.left].map(end_mm);
    let columns = 0..tip.columns();
    let first = columns.clone().take_while(|&column| height_mm(tip, column) < right_mm).count();
    let last = columns.clone().rev().take_while(|&column| height_mm(tip, column) < left_mm).count();
    columns.take(tip.columns() - last).skip(first).collect()
}

/// The column behind the widest step of a root: behind the last tooth of a sector, where the dwell is left out. Both
/// halves have columns.
fn behind_widest_step(root: &SurfaceGrid) -> usize {
    let at_mm = |column: usize| root.points_mm[column * root.rows()];
    let steps = (1..root.columns()).max_by(|&a, &b| {
        let step_mm = |column: usize| at_mm(column).distance(at_mm(column - 1));
        step_mm(a).total_cmp(&step_mm(b))
    });
    steps.unwrap_or(0)
}

/// Polar angle of the foot of a point on the blank's outline, rad.
fn outline_angle(blank: &Blank, point_mm: DVec2) -> f64 {
    blank.height(point_mm, point_mm.to_angle()).1
}

/// Rows of all grids; where sections are alike, those between which every column of every grid runs straight. A grid
/// keeps the rows that it needs itself, but those of many grids together, each at other places, would be all there
/// are.
fn common_rows(surfaces: &GearSurfaces, within_mm: f64) -> Vec<f64> {
    let grids = surfaces.teeth.iter().flat_map(|t| [Some(&t.right), t.tip.as_ref(), Some(&t.left), Some(&t.root)]);
    let grids: Vec<&SurfaceGrid> = grids.flatten().collect();
    let mut rows_z_mm: Vec<f64> = grids.iter().flat_map(|grid| grid.rows_mm.iter().copied()).collect();
    rows_z_mm.sort_unstable_by(f64::total_cmp);
    rows_z_mm.dedup_by(|later, kept| *later - *kept < NEAREST_MM);
    if grids.iter().any(|grid| !grid.is_straight) {
        return rows_z_mm;
    }
    let all: Vec<usize> = (0..rows_z_mm.len()).collect();
    let rows = straight_rows(&rows_z_mm, &all, within_mm, |from, to, visit| {
        for grid in &grids {
            let [from, to] = [from, to].map(|row| RowPlace::of(&grid.rows_mm, rows_z_mm[row]));
            for column in 0..grid.columns() {
                let first = column * grid.rows();
                let between = |values: &[f32]| [&from, &to].map(|place| place.between(first, values));
                let [a, b] = between(&grid.height_um).map(|um| f64::from(um) / UM_PER_MM);
                if !visit(b - a) {
                    return;
                }
                let Some(stock_mm) = &grid.stock_mm else { continue };
                let stock_mm = between(stock_mm).map(f64::from);
                let [a, b] = stock_mm.map(|mm| if mm.is_nan() { 0.0 } else { mm });
                // Where stock begins or ends, a row stands on either side.
                let [known_a, known_b] = stock_mm.map(|mm| f64::from(u8::from(!mm.is_nan())));
                if !visit(STOCK_SHARE * (b - a)) || !visit(known_b - known_a) {
                    return;
                }
            }
        }
    });
    rows.into_iter().map(|row| rows_z_mm[row]).collect()
}

/// Where a place along the tooth lies among the rows of a grid.
struct RowPlace {
    /// The row before it.
    before: usize,
    /// How far it lies from there towards the next one, 0 to 1.
    share: f64,
}

impl RowPlace {
    fn of(rows_mm: &[f64], z_mm: f64) -> Self {
        let after = rows_mm.partition_point(|&row_mm| row_mm < z_mm).clamp(1, rows_mm.len() - 1);
        let (from, to) = (rows_mm[after - 1], rows_mm[after]);
        Self { before: after - 1, share: ((z_mm - from) / (to - from)).clamp(0.0, 1.0) }
    }

    /// A value of the column whose values begin at `first`: exactly the one value where both are equal, and on a row
    /// that of the row, though its neighbour has none.
    fn between(&self, first: usize, values: &[f32]) -> f32 {
        let [from, to] = [0, 1].map(|after| values[first + self.before + after]);
        if self.share >= 1.0 { to } else { from + self.share as f32 * (to - from) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Three columns; heights and stock in mm by place along the tooth.
    fn grid(rows_mm: &[f64], height_mm: impl Fn(f64) -> f64, stock_mm: impl Fn(f64) -> f64) -> SurfaceGrid {
        let of_all = |value: &dyn Fn(f64) -> f64| -> Vec<f32> {
            (0..3).flat_map(|_| rows_mm.iter().map(|&z| value(z) as f32)).collect()
        };
        SurfaceGrid {
            arcs_mm: vec![0.0, 1.0, 2.0],
            rows_mm: rows_mm.to_vec(),
            normals: vec![DVec3::X; 3],
            is_straight: true,
            points_mm: vec![DVec3::ZERO; 3 * rows_mm.len()],
            height_um: of_all(&|z| UM_PER_MM * height_mm(z)),
            stock_mm: Some(of_all(&stock_mm)),
            passes: vec![1; 3 * rows_mm.len()],
        }
    }

    fn straight(rows_mm: &[f64]) -> SurfaceGrid {
        grid(rows_mm, |z| 1e-3 * z, |_| 0.5)
    }

    fn gear(root: &SurfaceGrid) -> GearSurfaces {
        // Every flank is bent by half of what shows, each at another place.
        let flank = |k: f64| grid(&[-5.0, k, 5.0], |z| if z == k { 0.5 * BODY_MM } else { 0.0 }, |z| 0.01 * z);
        let tooth = |k: i32| ToothSurfaces {
            right: flank(0.31 * f64::from(k)),
            tip: None,
            left: flank(0.17 - 0.29 * f64::from(k)),
            root: if k == 7 { root.clone() } else { straight(&[-5.0, 5.0]) },
        };
        GearSurfaces { teeth: (0..12).map(tooth).collect() }
    }

    #[test]
    fn rows_that_no_grid_needs_are_left_out() {
        assert_eq!(common_rows(&gear(&straight(&[-5.0, 1.0, 5.0])), BODY_MM), [-5.0, 5.0]);
        let bent = grid(&[-5.0, 1.0, 5.0], |z| if z == 1.0 { 3.0 * BODY_MM } else { 0.0 }, |_| 0.5);
        let rows_mm = common_rows(&gear(&bent), BODY_MM);
        let bend_mm = |z: f64| 3.0 * BODY_MM * ((z + 5.0) / 6.0).min((5.0 - z) / 4.0);
        let lines = rows_mm.windows(2).find(|rows| rows[1] >= 1.0).expect("rows to the end of the face");
        let share = (1.0 - lines[0]) / (lines[1] - lines[0]);
        let missed_mm = bend_mm(1.0) - bend_mm(lines[0]) - share * (bend_mm(lines[1]) - bend_mm(lines[0]));
        assert!(missed_mm <= BODY_MM && rows_mm.len() <= 5, "{missed_mm} mm, {rows_mm:?}");
        // Helical sections wind about the axis: straight heights are no straight lines there.
        let mut helical = gear(&straight(&[-5.0, 5.0]));
        helical.teeth[0].right.is_straight = false;
        assert_eq!(common_rows(&helical, BODY_MM).len(), 2 + 24);
    }

    #[test]
    fn stock_ends_between_two_rows_of_its_own() {
        let from = |edge: f64| move |z: f64| if z > edge { 0.5 } else { f64::NAN };
        for rows_mm in [[-5.0, 2.0, 2.05, 5.0], [-5.0, -2.05, -2.0, 5.0]] {
            let half = grid(&rows_mm, |_| 0.0, from(rows_mm[1]));
            let common = common_rows(&gear(&half), BODY_MM);
            assert!(common.contains(&rows_mm[1]) && common.contains(&rows_mm[2]), "{common:?}");
        }
    }
}

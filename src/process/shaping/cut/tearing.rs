//! Pits and scratches on cut flanks: which marks of a built-up edge are there, and the surface with them.
//!
//! In: a job, a flank and what operations leave on a field of its rays. Out: the same lower where marks lie. The marks
//! of an operation are those of [`crate::process::shaping::tool::built_up_edge`]; each asks at its middle which pass
//! cut there last, how thick the chip was ([`super::chips::last_chips_at`]) and how fast the ram ran; it is there if
//! its lot is below the product of both shares. A pass of a later operation takes it away. Whatever shows flanks cuts
//! them here, so that maps, windows and meshes see the same marks; roots and tips have none.
//!
//! Law of the ram as for strokes ([`gearcut_core::passes::planar::strokes`]): z = z_m + (L / 2) cos(theta), so that
//! v = v_max sqrt(1 - (2 (z - z_m) / L)^2).
//!
//! Road not taken: marks that strokes before the last one left, and that are too deep to be cut away. The density is
//! that of marks that are found on a surface, which is what can be counted.

use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::last_chips_at;
use crate::process::shaping::scene::model::BuiltUpEdge;
use crate::process::shaping::tool::built_up_edge::{Place, TornMark};
use crate::random::Draws;
use crate::steps::planar::CutField;
use gearcut_core::dexel::{Field, Layer, NO_PASS};
use gearcut_core::terms::Side;

/// Chips are looked up at places of the profile so far apart, mm: a choice, a twentieth of a usual facet. Places do not
/// hang on the field, and marks that share one ask once.
pub(in crate::process::shaping) const LOOKUP_MM: f64 = 0.005;

/// Number of the first operation's source of random numbers; others have those from 0, 100 and 1000 on.
const SOURCE: u32 = 2000;

/// Places of a field's columns and rows on a flank, in any order.
struct SeenPlaces {
    arcs_mm: Vec<f64>,
    rows_z_mm: Vec<f64>,
}

impl SeenPlaces {
    /// The least and the greatest of both.
    fn ends_mm(&self) -> [Place; 2] {
        let end = |of: fn(f64, f64) -> f64| {
            [&self.arcs_mm, &self.rows_z_mm].map(|places| places.iter().copied().reduce(of).unwrap_or(0.0))
        };
        [end(f64::min), end(f64::max)]
    }

    /// Columns and rows that a mark may reach.
    fn reached_by(&self, mark: &TornMark) -> [Vec<usize>; 2] {
        let places = [&self.arcs_mm, &self.rows_z_mm];
        [0, 1].map(|axis| {
            let reached = |&index: &usize| (places[axis][index] - mark.place_mm[axis]).abs() < mark.half_mm[axis];
            (0..places[axis].len()).filter(reached).collect()
        })
    }

    /// Lowers a surface where marks lie.
    fn lower<'a>(&self, field: &Field, marks: impl Iterator<Item = &'a TornMark>, layer: &mut Layer) {
        let rows = self.rows_z_mm.len();
        // Sums in the order of the marks, so that a place has the same one on every grid.
        let mut depths_mm = vec![0.0; layer.heights_mm.len()];
        for mark in marks {
            let [columns, of_column] = self.reached_by(mark);
            for &column in &columns {
                for &row in &of_column {
                    let place_mm = [self.arcs_mm[column], self.rows_z_mm[row]];
                    depths_mm[column * rows + row] += mark.depth_at_mm(place_mm);
                }
            }
        }
        for (dexel, (height_mm, depth_mm)) in layer.heights_mm.iter_mut().zip(depths_mm).enumerate() {
            if depth_mm > 0.0 && layer.passes[dexel] != NO_PASS {
                let low_mm = field.columns[dexel / rows].low_mm;
                *height_mm = (f64::from(*height_mm) - depth_mm).max(low_mm) as f32;
            }
        }
    }
}

impl ShapingJob {
    /// Speed of the ram at a height over the middle of the face in an operation, mm/s; 0 beyond its stroke.
    fn cutting_speed_mm_per_s(&self, operation: usize, z_mm: f64) -> f64 {
        self.ram_speed_mm_per_s(operation) * self.machine.speed_share(self.scene.gear.face_width_mm, z_mm)
    }

    /// Marks of all operations that the rays of a field can see, where the cutting speed allows them, in order of their
    /// arcs; with their operations.
    fn possible_marks(
        &self,
        edge: &BuiltUpEdge,
        (tooth, side): (u32, Side),
        grid: &SeenPlaces,
    ) -> Vec<(usize, TornMark)> {
        let reach_mm = edge.reach_mm();
        let half_face_mm = 0.5 * self.scene.gear.face_width_mm;
        let ends_mm = [[0.0, self.target_flank(tooth, side).length_mm()], [-half_face_mm, half_face_mm]];
        let [first, last] = grid.ends_mm();
        let corner = |seen: Place, towards: f64| -> Place {
            [0, 1].map(|axis| (seen[axis] + towards * reach_mm[axis]).clamp(ends_mm[axis][0], ends_mm[axis][1]))
        };
        let corners = [corner(first, -1.0), corner(last, 1.0)];
        let on_flank =
            |mark: &TornMark| (0..2).all(|axis| (ends_mm[axis][0]..=ends_mm[axis][1]).contains(&mark.place_mm[axis]));
        let flank = 2 * i64::from(tooth) + i64::from(side == Side::Left);
        let mut marks: Vec<(usize, TornMark)> = (0..self.operations.len())
            .flat_map(|operation| {
                let draws = Draws::new(edge.seed, SOURCE + operation as u32);
                edge.marks(draws, flank, corners).into_iter().map(move |mark| (operation, mark))
            })
            .filter(|(_, mark)| on_flank(mark) && grid.reached_by(mark).iter().all(|places| !places.is_empty()))
            .filter(|(operation, mark)| {
                mark.lot < edge.speed_share(self.cutting_speed_mm_per_s(*operation, mark.place_mm[1]))
            })
            .collect();
        marks.sort_by(|(_, a), (_, b)| a.place_mm[0].total_cmp(&b.place_mm[0]));
        marks
    }

    /// Puts the marks of a built-up edge on a cut flank.
    pub(in crate::process::shaping) fn tear(&self, edge: &BuiltUpEdge, (tooth, side): (u32, Side), cut: &mut CutField) {
        let grid = SeenPlaces { arcs_mm: cut.field.arcs_mm(), rows_z_mm: cut.field.rows_z_mm.clone() };
        let marks = self.possible_marks(edge, (tooth, side), &grid);
        if marks.is_empty() {
            return;
        }
        // Where the axes rest during strokes all heights are alike.
        let rows_are_alike = self.planar().rows_are_alike();
        let (mut places, mut place_of_mark): (Vec<Place>, Vec<usize>) = (Vec::new(), Vec::new());
        for (_, mark) in &marks {
            let arc_mm = (mark.place_mm[0] / LOOKUP_MM).round() * LOOKUP_MM;
            if !rows_are_alike || places.last().is_none_or(|last| last[0] < arc_mm) {
                places.push([arc_mm, mark.place_mm[1]]);
            }
            place_of_mark.push(places.len() - 1);
        }
        let along = |axis: usize| places.iter().map(move |place| place[axis]);
        let probes = self.field_over(self.target_flank(tooth, side), along(0), along(1).collect());
        let chips = last_chips_at(self, &probes);
        for (chips, layer) in chips.iter().zip(&mut cut.layers) {
            let is_there = |&(index, (operation, mark)): &(usize, &(usize, TornMark))| {
                let index = place_of_mark[index];
                let strokes = &self.operations[*operation].strokes;
                let speed_mm_per_s = self.cutting_speed_mm_per_s(*operation, mark.place_mm[1]);
                (strokes.first_pass..strokes.end_pass()).contains(&chips.passes[index])
                    && mark.lot
                        < edge.speed_share(speed_mm_per_s) * edge.chip_share(f64::from(chips.thickness_mm[index]))
            };
            let there = marks.iter().enumerate().filter(is_there).map(|(_, (_, mark))| mark);
            grid.lower(&cut.field, there, layer);
        }
    }
}

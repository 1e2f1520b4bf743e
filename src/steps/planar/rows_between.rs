//! Rows of a field whose heights follow from those of a few others.
//!
//! In: a field and the operations over it. Out: its layers, of which some rows are cut, spread over the face
//! ([`Nodes`]), and all rows of those columns alone whose other rows these do not tell.
//!
//! **The law.** While the axes rest, a guide, a wobble or noise of a bandwidth moves the cutter by micrometres along
//! the face, on a cubic in the place along the tooth. The height h_p(z) at which a pass p leaves a ray is as smooth:
//! the edge itself bends by picometres over what the cutter moves from node to node, so that h_p leaves its chord from
//! one node to the next by as much as the cutter's path does. Nodes stand so close that this is [`BEND_MM`] at most.
//! The surface is the lowest of all h_p, and what the nodes do not show is small or seen:
//!
//! - A pass that lies higher than another at two neighbouring nodes dips under it between these by twice that bend.
//! - Where the mark of one pass ends and that of the next begins the surface bends. Every node is told from its
//!   neighbours by the cubic through four of them; where that misses by more than [`NODE_MM`], or a ray was cut at some
//!   of the nodes only, the column is cut row by row.
//!
//! Rows that are told lie within 2 nm of those that are cut, on flanks, roots and tips; a comparison with all rows says
//! so for all of it (tests below), no proof. Their pass is one that leaves them as low.
//!
//! Kernels take sixteen rows of a column at a time, so that as many nodes cost as much as a single row.
//!
//! Road not taken: sixteen nodes whatever the path. Under a bow of 8 um another pass dipped by 10 nm between the two
//! nodes beside the turning point, and every node was on its cubic.

use super::{CutField, PlanarGear, PlanarOperation};
use gearcut_core::cut::{Backend, PlannedField};
use gearcut_core::dexel::{Field, Layer, NO_PASS};
use gearcut_core::error::Result;
use gearcut_core::passes::CutPlan;
use std::iter::repeat_n;

/// The native kernel takes so many rows at a time.
const ROWS_AT_ONCE: usize = 16;
/// The cutter's path leaves its chord between two nodes by this at most, mm.
const BEND_MM: f64 = 5e-7;
/// A node lies this near to the cubic through its neighbours, mm, or its column is cut row by row. A bend between two
/// nodes shows at those beside it with almost half of what it leaves in its middle.
const NODE_MM: f64 = 5e-7;

/// The cubic through four nodes in Newton's form, as far as it follows from their places along the tooth.
#[derive(Debug, Clone)]
struct Cubic {
    /// The nodes; the one from which rows are counted comes first, so that it keeps its height to the last bit.
    nodes: [usize; 4],
    places_mm: [f64; 4],
    /// 1 / (z_j - z_i), i < j, 1/mm: 01, 12, 23; 02, 13; 03.
    inverse: [f64; 6],
}

impl Cubic {
    fn through(nodes: [usize; 4], all_places_mm: &[f64]) -> Self {
        let places_mm = nodes.map(|node| all_places_mm[node]);
        let pairs = [[0, 1], [1, 2], [2, 3], [0, 2], [1, 3], [0, 3]];
        Self { nodes, places_mm, inverse: pairs.map(|[i, j]| (places_mm[j] - places_mm[i]).recip()) }
    }

    /// Its divided differences over heights of all nodes.
    fn differences(&self, heights_mm: &[f32]) -> [f64; 4] {
        let [h0, h1, h2, h3] = self.nodes.map(|node| f64::from(heights_mm[node]));
        let [i01, i12, i23, i02, i13, i03] = self.inverse;
        let [d01, d12, d23] = [(h1 - h0) * i01, (h2 - h1) * i12, (h3 - h2) * i23];
        let [d012, d123] = [(d12 - d01) * i02, (d23 - d12) * i13];
        [h0, d01, d012, (d123 - d012) * i03]
    }

    /// Its height at a place, mm.
    fn at(&self, [h0, d01, d012, d0123]: [f64; 4], place_mm: f64) -> f64 {
        let [z0, z1, z2, _] = self.places_mm;
        h0 + (place_mm - z0) * (d01 + (place_mm - z1) * (d012 + (place_mm - z2) * d0123))
    }
}

/// Rows of a field that are cut for all of it, both ends among them.
struct Nodes {
    /// Their numbers in the field.
    rows: Vec<usize>,
    /// Their places along the tooth, mm.
    places_mm: Vec<f64>,
    /// For every node but the last the cubic of the rows from there to the next one.
    between: Vec<Cubic>,
    /// For every node the cubic through its neighbours.
    beside: Vec<Cubic>,
}

impl Nodes {
    /// How many rows of so many are nodes where the cutter's path bends by `bend_mm` ([`StrokeSet::bend_mm`]): all of
    /// them where they stand no closer than nodes must.
    ///
    /// [`StrokeSet::bend_mm`]: gearcut_core::passes::StrokeSet::bend_mm
    fn count(rows: usize, bend_mm: f64) -> usize {
        // Phases run from -1 to 1, and the path leaves a chord of h by h^2 / 8 of its second derivative.
        let intervals = (0.5 * bend_mm / BEND_MM).sqrt().ceil() as usize;
        rows.min((intervals + 1).next_multiple_of(ROWS_AT_ONCE))
    }

    /// Those of a field; nothing where they are all its rows.
    fn of(field: &Field, bend_mm: f64) -> Option<Self> {
        let (all, count) = (field.rows(), Self::count(field.rows(), bend_mm));
        if count == all {
            return None;
        }
        let row = |node: usize| (node * (all - 1) + (count - 1) / 2) / (count - 1);
        let rows: Vec<usize> = (0..count).map(row).collect();
        let places_mm: Vec<f64> = rows.iter().map(|&row| field.rows_z_mm[row]).collect();
        let between = (0..count - 1).map(|node| {
            let first = node.saturating_sub(1).min(count - 4);
            let mut nodes: [usize; 4] = std::array::from_fn(|k| first + k);
            nodes.swap(0, node - first);
            Cubic::through(nodes, &places_mm)
        });
        let beside = (0..count).map(|node| {
            let first = node.saturating_sub(2).min(count - 5);
            Cubic::through(std::array::from_fn(|k| first + k + usize::from(first + k >= node)), &places_mm)
        });
        let (between, beside) = (between.collect(), beside.collect());
        Some(Self { rows, places_mm, between, beside })
    }

    /// Whether the nodes of a column tell of the rows between them.
    fn tell(&self, layer: &Layer, column: usize) -> bool {
        let count = self.rows.len();
        let (heights_mm, passes) = (layer.column(column, count), &layer.passes[column * count..][..count]);
        let uncut = passes.iter().filter(|&&pass| pass == NO_PASS).count();
        let is_told = |(node, cubic): (usize, &Cubic)| {
            let told_mm = cubic.at(cubic.differences(heights_mm), self.places_mm[node]);
            (told_mm - f64::from(heights_mm[node])).abs() <= NODE_MM
        };
        uncut == count || uncut == 0 && self.beside.iter().enumerate().all(is_told)
    }

    /// The layer of all rows of a field.
    fn filled(&self, at_nodes: &Layer, field: &Field) -> Layer {
        let count = self.rows.len();
        let mut heights_mm = Vec::with_capacity(field.len());
        let mut passes = Vec::with_capacity(field.len());
        for column in 0..field.columns.len() {
            let at_nodes_mm = at_nodes.column(column, count);
            let passes_at_nodes = &at_nodes.passes[column * count..][..count];
            for (node, (rows, cubic)) in self.rows.windows(2).zip(&self.between).enumerate() {
                let differences = cubic.differences(at_nodes_mm);
                let places_mm = &field.rows_z_mm[rows[0]..rows[1]];
                heights_mm.extend(places_mm.iter().map(|&place_mm| cubic.at(differences, place_mm) as f32));
                let own = self.rows_of_own_pass(node, at_nodes_mm, passes_at_nodes, places_mm.len());
                passes.extend(repeat_n(passes_at_nodes[node], own));
                passes.extend(repeat_n(passes_at_nodes[node + 1], places_mm.len() - own));
            }
            heights_mm.push(at_nodes_mm[count - 1]);
            passes.push(passes_at_nodes[count - 1]);
        }
        Layer { heights_mm, passes }
    }

    /// How many of so many rows from a node on its own pass leaves, and not that of the next one: up to where the lines
    /// meet on which both leave their nodes, as far as these are known.
    fn rows_of_own_pass(&self, node: usize, heights_mm: &[f32], passes: &[u32], rows: usize) -> usize {
        let [own, next] = [node, node + 1].map(|node| passes[node]);
        if own == next {
            return rows;
        }
        let slope =
            |a: usize, b: usize| f64::from(heights_mm[b] - heights_mm[a]) / (self.places_mm[b] - self.places_mm[a]);
        let before = node.checked_sub(1).filter(|&before| passes[before] == own);
        let after = Some(node + 2).filter(|&after| passes.get(after) == Some(&next));
        let share = before.zip(after).map_or(0.5, |(before, after)| {
            let (own_slope, next_slope) = (slope(before, node), slope(node + 1, after));
            (next_slope - slope(node, node + 1)) / (next_slope - own_slope)
        });
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        ((share * rows as f64).ceil() as usize).max(1)
    }
}

impl PlanarGear<'_> {
    /// How far the tool's path bends along a stroke at most, of all operations ([`StrokeSet::bend_mm`]).
    ///
    /// [`StrokeSet::bend_mm`]: gearcut_core::passes::StrokeSet::bend_mm
    fn bend_mm(&self) -> f64 {
        self.operations.iter().map(|operation| operation.strokes.bend_mm()).fold(0.0, f64::max)
    }

    /// Cuts a field while the axes rest: its nodes, every row of the columns that these do not tell of, and what lies
    /// between.
    ///
    /// # Errors
    /// The backend's.
    pub(super) fn cut_resting(&self, backend: &dyn Backend, field: Field) -> Result<CutField> {
        self.cut_told(backend, field, Nodes::tell)
    }

    fn cut_told(
        &self,
        backend: &dyn Backend,
        field: Field,
        tell: impl Fn(&Nodes, &Layer, usize) -> bool,
    ) -> Result<CutField> {
        let Some(nodes) = Nodes::of(&field, self.bend_mm()) else {
            return self.cut_rows(backend, &field);
        };
        let columns: Vec<usize> = (0..field.columns.len()).collect();
        let cut = |field: Field, plans: Vec<CutPlan>| {
            self.prepare_planned(backend, PlannedField { field, plans, lines: None })?.cut(backend)
        };
        let at_nodes = field.at([&columns, &nodes.rows]);
        let plans = self.plans(&at_nodes);
        let CutField { layers: at_nodes, mut stats, .. } = cut(at_nodes, plans.clone())?;
        let is_told = |column: &usize| at_nodes.iter().all(|layer| tell(&nodes, layer, *column));
        let untold: Vec<usize> = columns.into_iter().filter(|column| !is_told(column)).collect();
        let mut layers: Vec<Layer> = at_nodes.iter().map(|layer| nodes.filled(layer, &field)).collect();
        if !untold.is_empty() {
            let rows = field.rows();
            let all_rows: Vec<usize> = (0..rows).collect();
            let over_all_rows = |(plan, operation): (&CutPlan, &PlanarOperation)| {
                let phases = field.rows_z_mm.iter().map(|&z_mm| operation.strokes.law.tau(z_mm));
                plan.of_columns(&untold, phases.collect())
            };
            let plans: Vec<CutPlan> = plans.iter().zip(&self.operations).map(over_all_rows).collect();
            let CutField { layers: row_by_row, stats: more, .. } = cut(field.at([&untold, &all_rows]), plans)?;
            stats += more;
            let of = |column: usize| column * rows..(column + 1) * rows;
            for (layer, cut) in layers.iter_mut().zip(&row_by_row) {
                for (from, &to) in untold.iter().enumerate() {
                    layer.heights_mm[of(to)].copy_from_slice(&cut.heights_mm[of(from)]);
                    layer.passes[of(to)].copy_from_slice(&cut.passes[of(from)]);
                }
            }
        }
        Ok(CutField { field, layers, figures: None, stats })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::load;
    use crate::process::shaping::ShapingJob;
    use gearcut_core::cut::cpu::Cpu;
    use gearcut_core::terms::Side;
    use std::path::Path;

    /// How far rows that are told may be off, mm.
    const TOLD_MM: f64 = 2e-6;

    /// Gears whose axes rest while guide, clamping or noise move their sections.
    const SCENES: [(&str, &[&str]); 6] = [
        ("machine_errors", &["fields.flank.lead_spacing_um=100"]),
        ("machine_errors", &["operation.finish.strokes_per_revolution=400", "fields.flank.lead_spacing_um=200"]),
        ("elliptical_normal", &["machine.errors.guide.tangential_um_per_100mm=25", "mounting.wobble_um_per_100mm=10"]),
        ("elliptical_traditional", &["machine.errors.guide.radial_bow_um=8"]),
        (
            "internal_ellipse",
            &[
                "operation.rough.feed_during_stroke=false",
                "operation.finish.feed_during_stroke=false",
                "machine.errors.guide.radial_um_per_100mm=60",
                "fields.flank.lead_spacing_um=100",
            ],
        ),
        ("noise", &["fields.flank.lead_spacing_um=100"]),
    ];

    fn job(scene: &str, settings: &[&str]) -> ShapingJob {
        let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
        let loaded = load(Path::new(&format!("scenes/shaping/{scene}.toml")), &settings).expect("the shipped scene");
        ShapingJob::new(loaded.scene).expect("the shipped gear")
    }

    /// Fields of a gear: two flanks in every fourth column, a root.
    fn fields(job: &ShapingJob) -> Vec<Field> {
        let some = |field: Field, step: usize| {
            let columns: Vec<usize> = (0..field.columns.len()).step_by(step).collect();
            let rows: Vec<usize> = (0..field.rows()).collect();
            field.at([&columns, &rows])
        };
        let flank = |(tooth, side)| some(job.flank_field(job.target_flank(tooth, side)), 4);
        [(3, Side::Left), (8, Side::Right)].into_iter().map(flank).chain([some(job.root_field(5), 20)]).collect()
    }

    /// Largest miss of what is told on a field, mm, and the share of its dexels whose pass is another one.
    fn missed(job: &ShapingJob, field: &Field, tell: impl Fn(&Nodes, &Layer, usize) -> bool) -> [f64; 2] {
        let (gear, backend) = (job.planar(), Cpu::default());
        let told = gear.cut_told(&backend, field.clone(), tell).expect("cut");
        let all = gear.cut_rows(&backend, field).expect("cut").layers;
        let mut missed = [0.0_f64; 2];
        for (told, all) in told.layers.iter().zip(&all) {
            let off_mm = told.heights_mm.iter().zip(&all.heights_mm).map(|(&a, &b)| f64::from(a - b).abs());
            let others = told.passes.iter().zip(&all.passes).filter(|(a, b)| a != b).count();
            missed = [off_mm.fold(missed[0], f64::max), missed[1].max(others as f64 / field.len() as f64)];
        }
        missed
    }

    #[test]
    fn rows_between_are_those_that_are_cut() {
        for (scene, settings) in SCENES {
            let job = job(scene, settings);
            assert!(job.planar().rests() && !job.planar().rows_are_alike(), "{scene}");
            for field in fields(&job) {
                let [off_mm, others] = missed(&job, &field, Nodes::tell);
                let rows = field.rows();
                let nodes = Nodes::count(rows, job.planar().bend_mm());
                println!(
                    "{scene} {nodes} of {rows} rows: {:.3} nm, other passes {:.4} %",
                    off_mm * 1e6,
                    others * 100.0
                );
                assert!(off_mm <= TOLD_MM, "{scene}: {off_mm} mm");
                assert!(others <= 0.01, "{scene}: {others}");
            }
        }
    }

    /// Planted: columns whose nodes do not tell of their rows are filled all the same.
    #[test]
    fn nodes_that_are_believed_whatever_they_say_miss_heights() {
        let missed_mm = |(scene, settings): (&str, &[&str])| {
            let job = job(scene, settings);
            fields(&job).iter().map(|field| missed(&job, field, |_, _, _| true)[0]).fold(0.0, f64::max)
        };
        let worst = SCENES.into_iter().map(missed_mm).fold(0.0, f64::max);
        assert!(worst > 5.0 * TOLD_MM, "{worst} mm");
    }
}

//! The chip with which every place of a flank got its surface.
//!
//! In: the job and a field of rays on a flank (few of them: those of a map). Out, after each operation: uncut chip
//! thickness, the part of the cutter's edge that took it, and the pass.
//!
//! **Definition.** Every pass that touches a ray is taken in strict order of time, over all operations so far. A pass
//! that lies lower than all before it lowers the surface; the material between is solid, for no earlier pass has
//! reached it. Its length along the ray times the cosine between ray and edge normal is the thickness across the chip:
//! where the edge runs parallel to the surface that it finds, as it does within milliradians from stroke to stroke, the
//! distance between them. The last pass that lowers the surface leaves it. Where it is the first pass of all, the chip
//! reaches to the blank's surface or to the end of the ray, half a pitch out.
//!
//! The candidates that suffice for heights do not do here: the pass before the last one may lie above it on a whole
//! tile, and be culled. So passes are chosen column by column (`deciding`). Heights are f64 throughout: on
//! finished flanks the edge goes through the contact, chips are thinner than a micrometre, and the ledger's sections,
//! good to a tenth of a micrometre, would not see them. Away from the contact by t strokes, passes stand c t^2 over the
//! target (c is four times the height of a scallop, t at most a half on the surface that is left), so thickness runs
//! from 0 at one end of a facet through c in its middle to 2 c at the other.

use super::along_rows;
use super::column_group::ColumnGroup;
use super::deciding::{ColumnPasses, deciding};
use super::ploughing;
use super::rays::{Chosen, FieldPasses, Pairing, RaySurface};
use super::segments::Reaching;
use crate::measure::LastChips;
use crate::measure::chip_places::ChipPlaces;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::tool::edge_polygon::EdgeSide;
use gearcut_core::dexel::field::{Column, Field};

/// Rows from which on the courses of passes along the face cost less than looks at each row.
const ENOUGH_ROWS: usize = 10;

/// Part of the edge as maps have it: 0 for none.
pub fn side_code(side: Option<EdgeSide>) -> u8 {
    side.map_or(0, |side| side as u8 + 1)
}

/// Chips that left the surface after each operation, in their order.
#[cfg(feature = "testing")]
pub fn last_chips(job: &ShapingJob, field: &Field) -> Vec<LastChips> {
    last_chips_on_rays(job, field, Pairing::All, |_, _| true)
}

/// The same at single places: of each column the ray in the row of the same number.
pub fn last_chips_at(job: &ShapingJob, field: &Field) -> Vec<LastChips> {
    last_chips_on_rays(job, field, Pairing::Diagonal, |_, _| true)
}

/// The same at the places of a map, as if no pass had come to those that are not asked for.
pub fn last_chips_on_map(job: &ShapingJob, field: &Field, places: &ChipPlaces) -> Vec<LastChips> {
    // Columns of which nothing is asked for are left out.
    let followed: Vec<usize> = (0..places.columns.len()).filter(|&column| places.wants_any(column)).collect();
    let columns: Vec<usize> = followed.iter().map(|&column| places.columns[column]).collect();
    let field = field.at([&columns, &places.rows]);
    let wants = |operation: usize, [column, row]: [usize; 2]| places.wants(operation, [followed[column], row]);
    let chips = last_chips_on_rays(job, &field, Pairing::All, wants);
    let rows = places.rows.len();
    let on_all_columns = |(operation, chips): (usize, LastChips)| {
        let mut all = LastChips::none(places.columns.len() * rows);
        for (index, &column) in followed.iter().enumerate() {
            for row in (0..rows).filter(|&row| wants(operation, [index, row])) {
                let (from, to) = (index * rows + row, column * rows + row);
                all.thickness_mm[to] = chips.thickness_mm[from];
                all.sides[to] = chips.sides[from];
                all.passes[to] = chips.passes[from];
            }
        }
        all
    };
    chips.into_iter().enumerate().map(on_all_columns).collect()
}

/// Chips on those rays that `wants` says after which operation, by their columns and rows; the others are uncut, or
/// cut where edges plough.
fn last_chips_on_rays(
    job: &ShapingJob,
    field: &Field,
    pairing: Pairing,
    wants: impl Fn(usize, [usize; 2]) -> bool,
) -> Vec<LastChips> {
    match &job.cutter_spec.edge_rounding {
        None => {
            let passes = FieldPasses::of_smooth_edges(job, field, pairing);
            last_chips_of(&passes, field, deciding, in_rows, wants)
        }
        Some(rounding) => {
            let ploughed = ploughing::surfaces(job, field, pairing, rounding);
            ploughed.after.iter().map(|surfaces| last_chips_on(surfaces, ploughed.copies)).collect()
        }
    }
}

/// The same of those passes that `choose` takes of a column's, up to one of them, followed in rows by `follow`.
pub(super) fn last_chips_of(
    passes: &FieldPasses,
    field: &Field,
    choose: impl Fn(&mut ColumnPasses, usize) -> Vec<Reaching>,
    follow: impl Fn(&FieldPasses, &[Chosen], &Column, &[usize]) -> Vec<RaySurface>,
    wants: impl Fn(usize, [usize; 2]) -> bool,
) -> Vec<LastChips> {
    let mut after: Vec<Vec<RaySurface>> = vec![Vec::new(); passes.operations()];
    let mut before = None;
    for (first, columns) in ColumnGroup::groups(&field.columns) {
        let mut group = passes.group(columns, before.take());
        for (index, ray) in (first..).zip(columns) {
            let mut column = passes.over(&mut group, ray);
            for (operation, after) in after.iter_mut().enumerate() {
                let rows = passes.rows(index);
                if !rows.clone().any(|row| wants(operation, [index, row])) {
                    after.extend(rows.map(|_| RaySurface::uncut(ray)));
                    continue;
                }
                let chosen = passes.chosen(choose(&mut column, passes.of_operation(operation).end));
                let wanted: Vec<usize> = rows.clone().filter(|&row| wants(operation, [index, row])).collect();
                let mut surfaces = vec![RaySurface::uncut(ray); rows.len()];
                for (&row, cut) in wanted.iter().zip(follow(passes, &chosen, ray, &wanted)) {
                    surfaces[row - rows.start] = cut;
                }
                after.extend(surfaces);
            }
        }
        before = Some(group);
    }
    after.into_iter().map(|surfaces| last_chips_on(&surfaces, passes.copies)).collect()
}

/// What some passes leave on a ray in some rows.
pub(super) fn in_rows(passes: &FieldPasses, chosen: &[Chosen], ray: &Column, rows: &[usize]) -> Vec<RaySurface> {
    if rows.len() < ENOUGH_ROWS || !passes.rest(chosen) {
        return in_every_row(passes, chosen, ray, rows);
    }
    let mut likely = chosen.len() / 2;
    let told = along_rows::surfaces(passes, chosen, ray, rows).into_iter().zip(rows);
    told.map(|(told, &row)| told.unwrap_or_else(|| last_cut(passes, chosen, row, ray, &mut likely))).collect()
}

/// The same by a look in each of them.
pub(super) fn in_every_row(passes: &FieldPasses, chosen: &[Chosen], ray: &Column, rows: &[usize]) -> Vec<RaySurface> {
    let mut likely = chosen.len() / 2;
    rows.iter().map(|&row| last_cut(passes, chosen, row, ray, &mut likely)).collect()
}

/// What some passes leave on a ray in a row: the first of those that come lowest, and before it the surface of those
/// before it. Asked first is `likely`, the one of the row before, so that a look at the edge tells of most others that
/// they stay above; the last one found takes its place.
fn last_cut(passes: &FieldPasses, chosen: &[Chosen], row: usize, ray: &Column, likely: &mut usize) -> RaySurface {
    let enters = |index: usize, surface_mm: f64| {
        let entry = passes.entry(&chosen[index], row, ray, surface_mm)?;
        Some((index, entry.height_mm.max(ray.low_mm), entry))
    };
    let uncut = RaySurface::uncut(ray);
    let asked_first = chosen.get(*likely).and_then(|_| enters(*likely, uncut.height_mm));
    let lowest = (0..chosen.len()).fold(asked_first, |lowest, index| {
        let Some((by, lowest_mm, _)) = lowest else { return enters(index, uncut.height_mm) };
        // Of those that come equally low the first one cut.
        let surface_mm = if index < by { lowest_mm.next_up() } else { lowest_mm };
        enters(index, surface_mm).filter(|&(_, height_mm, _)| height_mm < surface_mm).or(lowest)
    });
    let Some((last, height_mm, entry)) = lowest.filter(|&(_, height_mm, _)| height_mm < uncut.height_mm) else {
        return uncut;
    };
    *likely = last;
    let before_mm = (0..last).rev().fold(uncut.height_mm, |before_mm, index| {
        enters(index, before_mm).map_or(before_mm, |(_, height_mm, _)| height_mm.min(before_mm))
    });
    let thickness_mm = (before_mm - height_mm) * entry.cosine;
    RaySurface { height_mm, thickness_mm, side: Some(entry.side), pass: chosen[last].id }
}

/// What the surfaces of a section say, repeated on as many rows.
fn last_chips_on(surfaces: &[RaySurface], copies: usize) -> LastChips {
    let all = || surfaces.iter().flat_map(|surface| std::iter::repeat_n(surface, copies));
    LastChips {
        thickness_mm: all().map(|s| s.thickness_mm as f32).collect(),
        sides: all().map(|s| side_code(s.side)).collect(),
        passes: all().map(|s| s.pass).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::flank_maps::FlankMaps;
    use crate::process::load;
    use crate::process::shaping::scene::model::Shaping;
    use crate::process::shaping::sections::GearPart;
    use gearcut_core::cut::cpu::Cpu;
    use gearcut_core::terms::Side;
    use std::path::Path;

    /// Bits of what is known of some rays.
    fn bits(chips: &LastChips, rays: impl Iterator<Item = usize>) -> Vec<(u32, u32)> {
        rays.map(|ray| (chips.thickness_mm[ray].to_bits(), chips.passes[ray])).collect()
    }

    #[test]
    fn single_places_have_the_chips_of_their_columns_and_rows() {
        let feed = ["operation.rough.feed_during_stroke=true", "operation.finish.feed_during_stroke=true"];
        let rounding =
            ["radius_um=5", "minimum_chip_share=0.2"].map(|key| format!("tool.shaper_cutter.edge_rounding.{key}"));
        for (settings, rounded) in [(&feed[..0], false), (&feed[..], false), (&feed[..], true)] {
            let rounding = rounding.iter().filter(|_| rounded).cloned();
            let settings: Vec<String> = settings.iter().map(|&key| key.to_owned()).chain(rounding).collect();
            let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &settings).expect("the shipped scene");
            let job = ShapingJob::new(scene.scene).expect("the shipped gear");
            let field = job.flank_field(job.target_flank(4, Side::Left));
            let columns: Vec<usize> = (0..7).map(|i| 100 * i + 90).collect();
            let rows: Vec<usize> = (0..7).map(|i| 99 - 13 * i).collect();
            let field = field.at([&columns, &rows]);
            let (all, single) = (last_chips(&job, &field), last_chips_at(&job, &field));
            for (all, single) in all.iter().zip(&single) {
                assert_eq!(bits(all, (0..7).map(|i| 8 * i)), bits(single, 0..7));
                assert_eq!(single.passes.len(), 7);
            }
            assert_eq!(bits(&all[1], 0..7).iter().all(|ray| *ray == bits(&all[1], 0..1)[0]), settings.is_empty());
        }
    }

    /// A map's chips are those of its places; and of a cell they are nearly the thickest of all that might be followed.
    #[test]
    fn a_map_follows_the_thickest_chip_of_its_cells() {
        let feed = ["operation.rough.feed_during_stroke=true", "operation.finish.feed_during_stroke=true"];
        for settings in [&[][..], &feed] {
            let settings: Vec<String> = settings.iter().map(|&key: &&str| key.to_owned()).collect();
            let scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &settings).expect("the shipped scene");
            let job = ShapingJob::new(scene.scene).expect("the shipped gear");
            let field = job.flank_field(job.target_flank(4, Side::Left));
            let cut = job.cut_on(&Cpu::default(), GearPart::Flank(4, Side::Left), field).expect("cuts");
            let field = cut.field;
            let arcs_mm: Vec<f64> = field.columns.iter().map(|column| column.arc_mm).collect();
            let spacing_mm = job.scene.output.map_spacing_mm;
            let maps = FlankMaps::sample(4, Side::Left, [&arcs_mm, &field.rows_z_mm], &cut.layers, spacing_mm);
            let places = maps.chip_places(&cut.layers, field.rows());
            let all = last_chips(&job, &field.at([&places.columns, &places.rows]));
            let [mut one, mut four] = [maps.clone(), maps];
            one.take_chips(&last_chips_on_map(&job, &field, &places));
            four.take_chips(&all);
            for ((one, four), least) in one.chips.iter().zip(&four.chips).zip([0.7, 0.9]) {
                let cells = one.thickness_mm.iter().zip(&four.thickness_mm).filter(|(_, four)| !four.is_nan());
                let shares: Vec<f64> = cells.map(|(&one, &four)| f64::from(one / four)).collect();
                let same = shares.iter().filter(|&&share| share == 1.0).count();
                let mean = shares.iter().sum::<f64>() / shares.len() as f64;
                println!("{settings:?}: {same} of {} cells, mean share {mean:.3}", shares.len());
                let [least, same] = [least, same as f64 / shares.len() as f64];
                assert!(same > least && mean > 0.5 * (1.0 + least), "{same} of the cells, {mean}");
            }
        }
    }

    #[test]
    fn the_passes_that_decide_leave_the_chips_of_all() {
        let mut scene = load(Path::new("scenes/shaping/elliptical_normal.toml"), &[]).expect("the shipped scene").scene;
        for operation in &mut Shaping::of_mut(&mut scene).expect("shaping").operations {
            operation.feed_during_stroke = true;
        }
        let job = ShapingJob::new(scene).expect("the shipped gear");
        let (mut all, mut kept) = (0, 0);
        for (tooth, side) in [(1, Side::Left), (8, Side::Right)] {
            let field = job.flank_field(job.target_flank(tooth, side));
            let columns: Vec<usize> = (0..field.columns.len()).step_by(31).collect();
            let field = field.at([&columns, &[0, 100, 300, 500, 600]]);
            let chosen = last_chips(&job, &field);
            let passes = FieldPasses::of_smooth_edges(&job, &field, Pairing::All);
            let of_all = last_chips_of(&passes, &field, |column, end| column.all(0..end), in_rows, |_, _| true);
            for (chosen, of_all) in chosen.iter().zip(&of_all) {
                let bits = |chips: &LastChips| chips.thickness_mm.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
                assert_eq!((&chosen.passes, bits(chosen)), (&of_all.passes, bits(of_all)));
            }
            let counted = std::cell::Cell::new([0, 0]);
            last_chips_of(
                &passes,
                &field,
                |column, so_far| {
                    let deciding = deciding(column, so_far);
                    let [a, k] = counted.get();
                    counted.set([a + column.all(0..so_far).len(), k + deciding.len()]);
                    deciding
                },
                in_rows,
                |_, _| true,
            );
            let [a, k] = counted.get();
            (all, kept) = (all + a, kept + k);
        }
        println!("{kept} of {all} passes decide");
        assert!(20 * kept < all, "{kept} of {all}");
    }
}

//! Heights of a flank after all operations, for files that other programs measure by.
//!
//! In: a flank, arcs from its form point times places along the tooth. Out: heights over the target, mm, arc by arc. A
//! place that no stroke reaches has none, and is refused: what stays there is the stock's edge.

use crate::job::GearJob;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::{Error, Refusal, Result};
use gearcut_core::terms::Side;

/// The heights. Where the stock ends within `edge_mm` of the target, as it does on a face cone, it is as good as cut.
///
/// # Errors
/// The tool generates no flank there; a place that no stroke reaches; the backend's.
pub fn cut_heights_mm(
    gear: &dyn GearJob,
    backend: &dyn Backend,
    (tooth, side): (u32, Side),
    [arcs_mm, rows_mm]: [&[f64]; 2],
    edge_mm: Option<f64>,
) -> Result<Vec<f64>> {
    let layers = gear.cut_flank(backend, tooth, side, arcs_mm, rows_mm)?;
    let layer = layers.into_iter().last().ok_or(Error::Interrupted)?;
    let height_mm = |(place, (&height_mm, &pass)): (usize, (&f32, &u32))| {
        let height_mm = f64::from(height_mm);
        if pass != NO_PASS || edge_mm.is_some_and(|edge_mm| height_mm <= edge_mm) {
            return Ok(height_mm);
        }
        let problem = format!(
            "no stroke reaches the {} flank of tooth {tooth} {:.3} mm from the form point, {:.3} mm from the middle of \
             the face",
            side.name(),
            arcs_mm[place / rows_mm.len()],
            rows_mm[place % rows_mm.len()]
        );
        Err(Refusal::new("operation", problem, "leave --as-cut out, or name teeth that are cut with --teeth").into())
    };
    layer.heights_mm.iter().zip(&layer.passes).enumerate().map(height_mm).collect()
}

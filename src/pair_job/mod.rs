//! `gearcut pair`: two gears of scenes or results rolled on each other, and what is written about it.
//!
//! In: two scenes, errors of mounting. Out: findings, tables, charts, contact patterns, an animation and a page. The
//! mechanics are those of `crate::pair`.
//!
//! | module | what |
//! | --- | --- |
//! | [`member`] | a gear as it is named: a scene, a folder of results, the mate of the other |
//! | [`fit`] | whether two gears belong together, and which of their teeth meet |
//! | [`working`] | round gears at any distance of their axes |
//! | [`outline`] | flanks and roots as cut, in transverse sections |
//! | [`flanks`] | the flanks of both gears as they are rolled |
//! | [`generated`] | how far the flanks that the tools generate reach |
//! | [`options`] | what a pair is rolled with: positions, sections, errors of mounting |
//! | [`watch`] | progress and Ctrl-C |
//! | [`rolled`] | everything that is found out about the pair |
//! | [`teeth`] | contact tooth by tooth, edges and fillets that carry |
//! | [`corners`] | tip corners in the mate's material |
//! | [`double_flank`] | the centre distance without play, against the mate and against masters |
//! | [`spline`] | a splined shaft in its hub, which do not roll |
//! | [`findings`] | the tree of findings |
//! | [`charts`], [`pictures`], [`view`], [`page`] | what is drawn |
//! | [`mod@write`] | the files |
//!
//! A pair is two scenes and options of a command, not a scene of its own: each gear stays one file that `cut`, `check`
//! and `mate` read as well, and what is tried again and again with the same gears is how they are mounted.

pub mod charts;
pub mod corners;
pub mod double_flank;
pub mod findings;
pub mod fit;
pub mod flanks;
pub mod generated;
pub mod member;
pub(crate) mod notices;
pub mod options;
pub mod outline;
pub mod page;
pub mod pictures;
pub mod quantities;
pub mod rolled;
pub mod spline;
pub mod teeth;
#[cfg(test)]
mod tests;
pub mod view;
pub mod watch;
pub mod working;
pub mod write;

use crate::findings::Findings;
use crate::scene::Scene;
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;

/// Rolls two gears on each other, or puts a shaft into its hub, and writes nothing.
///
/// # Errors
/// Gears that do not belong together; geometry, the backend; Ctrl-C.
pub fn found(
    scenes: [&Scene; 2],
    options: &options::PairOptions,
    backend: &dyn Backend,
    watch: &watch::Watch,
) -> Result<Findings> {
    let name = format!("{}_with_{}", scenes[0].name, scenes[1].name);
    if spline::is_spline(scenes) {
        let fit = spline::fit(scenes, options, backend, watch)?;
        return Ok(spline::report::findings(&name, scenes, &fit));
    }
    let rolled = rolled::roll_pair(scenes, options, backend, watch)?;
    Ok(findings::findings(&name, scenes, options, &rolled))
}

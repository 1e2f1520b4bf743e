//! Quantities of flanks: normal deviations with their figures of ISO 1328-1, stock, where the flank begins and ends.
//!
//! Two measures are kept apart everywhere. A **normal deviation** is measured from the target, the envelope of the last
//! operation. A **stock** is the material of an operation over the finished surface. Both run along the target's
//! normal, positive where material is.

use crate::findings::rows;

/// Source of the figures of flanks and teeth.
pub const ISO_1328: &str = "ISO 1328-1:2013";
/// No figure of a trace.
pub const NO_TRACE: &str = "a dexel of the evaluated trace was reached by no pass";
/// No figure of a trace on a coarse grid.
pub const FEW_DEXELS: &str = "fewer than three dexels lie on the evaluated trace: make fields.flank.profile_spacing_um \
     (profiles) or fields.flank.lead_spacing_um (helices) smaller";
/// Why a trace has no figure.
const TRACE: &[&str] = &[NO_TRACE, FEW_DEXELS, BELOW_RANGE, NOT_CUT];
/// No height of the evaluated part.
pub const UNREACHED: &str = "a dexel of every evaluated part was reached by no pass";
/// No lowest height.
pub const BELOW_RANGE: &str = "the flank is cut deeper than its rays record, half a module under the target";
/// A flank that a stopped run did not come to.
pub const NOT_CUT: &str = "the run was stopped before this flank was cut";
/// No stock.
pub const NO_STOCK: &str = "no flank has a stock: they were not cut or reached, or are cut away";
/// No stock of a flank.
pub const NO_STOCK_HERE: &str = "the flank was not cut or not reached, or is cut away";
/// No earlier operation.
pub const SINGLE: &str = "the scene has one operation; stock is the material of an earlier one";

rows! {
    /// Deviations and stock of flanks.
    FLANKS: "flanks", "Flanks", "headline (the worst of all flanks); teeth.<tooth>.<flank>; columns of teeth.flanks";

    SMALLEST_STOCK: "smallest_stock", "mm",
        "smallest stock that the operation before the last has on the active flanks; negative where it cut too deep"
        => titled("smallest normal stock"), or(&[SINGLE, NO_STOCK]);
    LARGEST_STOCK: "largest_stock", "mm", "largest stock that the operation before the last has on the active flanks"
        => titled("largest normal stock"), or(&[SINGLE, NO_STOCK]);
    HIGHEST_DEVIATION: "highest_deviation", "um",
        "largest normal deviation of the finished surface on the evaluated part, marks of the tool included"
        => or(&[UNREACHED, BELOW_RANGE, NOT_CUT]);
    DEEPEST_CUT: "deepest_cut", "um",
        "depth of the deepest place of the finished surface on the evaluated part, below the target positive"
        => or(&[UNREACHED, BELOW_RANGE]);
    F_ALPHA: "F_alpha", "um",
        "total profile deviation: range of the normal deviations along the evaluated profile, middle of the face"
        => titled("profile deviation F_alpha"), symbol("F_α"), source(ISO_1328), or(TRACE);
    F_H_ALPHA: "f_H_alpha", "um",
        "profile slope deviation: rise of the profile's mean line over the roll of the evaluated profile, positive \
        towards the tip; bevel gears: over its arc"
        => titled("profile slope f_H_alpha"), symbol("f_Hα"), source(ISO_1328), or(TRACE);
    F_F_ALPHA: "f_f_alpha", "um", "profile form deviation: range of the normal deviations about the profile's mean line"
        => titled("profile form f_f_alpha"), symbol("f_fα"), source(ISO_1328), or(TRACE);
    F_BETA: "F_beta", "um",
        "total helix deviation: range of the normal deviations along the tooth, at the pitch curve or in the middle of \
         the profile"
        => titled("helix deviation F_beta"), symbol("F_β"), source(ISO_1328), or(TRACE);
    F_H_BETA: "f_H_beta", "um", "helix slope deviation: rise of the helix's mean line over the evaluated face"
        => titled("helix slope f_H_beta"), symbol("f_Hβ"), source(ISO_1328), or(TRACE);
    F_F_BETA: "f_f_beta", "um", "helix form deviation: range of the normal deviations about the helix's mean line"
        => titled("helix form f_f_beta"), symbol("f_fβ"), source(ISO_1328), or(TRACE);
    LOWEST_DEVIATION: "lowest_deviation", "um",
        "smallest normal deviation of the finished surface on the evaluated part"
        => or(&[UNREACHED, BELOW_RANGE, NOT_CUT]);
    MEAN_DEVIATION: "mean_deviation", "um", "mean normal deviation of the finished surface on the evaluated part"
        => or(&[UNREACHED]);
    SQ: "Sq", "um", "root mean square of the normal deviations of the evaluated part about their mean"
        => symbol("Sq"), source("ISO 25178-2"), or(&[UNREACHED]);
    EVALUATED_FROM: "evaluated_from", "mm", "arc from the start of the profile at which its evaluated part begins"
        => or(&[NOT_CUT, BELOW_RANGE]);
    EVALUATED_TO: "evaluated_to", "mm", "arc from the start of the profile at which its evaluated part ends"
        => or(&[NOT_CUT, BELOW_RANGE]);
    PROFILE_LENGTH: "profile_length", "mm", "length of the profile from its start to the tip, middle of the face"
        => or(&[NOT_CUT, BELOW_RANGE]);
    START_OF_FLANK: "start_of_flank", "mm",
        "height over the pitch curve at which the generated flank (an involute: its start of involute) begins: the \
         highest of its sections, in the headline of all flanks"
        => titled("highest start of flank"), or(&[NOT_CUT, BELOW_RANGE]);
    UNDERCUT_FLANKS: "undercut_flanks", "flanks",
        "flanks that the tool's tip undercuts: it takes part of what was generated away";
    UNTOUCHED_DEXELS: "untouched_dexels", "dexels", "dexels of flanks that no pass touched";
}

rows! {
    /// Stock of an operation: of all flanks, of a flank, of roots.
    STOCK: "stock", "Stock",
        "operations.<operation>.flank_stock, .fillet_stock, .root_stock and .teeth.<tooth>.<flank>; columns of \
         teeth.flanks, their keys after the name of the operation";

    STOCK_SMALLEST: "smallest_stock", "mm",
        "smallest stock along the target's normal on what the section names; negative where the operation cut below \
         the target and finishing takes nothing"
        => or(&[NO_STOCK_HERE, LAST, NO_FLANK_REACHED]);
    STOCK_LARGEST: "largest_stock", "mm", "largest stock along the target's normal on what the section names"
        => or(&[NO_STOCK_HERE, LAST, NO_FLANK_REACHED]);
    STOCK_MEAN: "mean_stock", "mm", "mean stock on what the section names, over the dexels that the operation reached"
        => or(&[NO_STOCK_HERE, LAST, NO_FLANK_REACHED]);
}

/// The last operation has no stock over itself.
pub const LAST: &str = "the last operation has no stock over itself";
/// No flank of an operation was reached.
pub const NO_FLANK_REACHED: &str = "no flank was reached";

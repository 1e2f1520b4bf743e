//! Notices of pairs of cylindrical gears.

use crate::findings::notice::notices;

notices! {
    /// Edges carry what flanks should: they wear, and the pair is loud.
    EdgeContact: Warning "pair.edge_contact", "pair.md", (flanks, percent, lift),
        "{flanks} flanks: at {percent} % of the positions a tip corner or a fillet carries{lift}";
        "Give the tips relief or the fillets more room, or correct the mounting."
    /// The gears lose each other's flanks between two teeth: the ratio jumps with every tooth.
    ContactRatio: Warning "pair.contact_ratio", "pair.md", (flanks, ratio),
        "{flanks} flanks: the contact ratio falls to {ratio}, below 1: a pair of flanks parts before the next one \
         meets";
        "Move the axes nearer to each other, or give the teeth a larger addendum or more of them."
    /// The pair cannot be assembled, or runs under load from both flanks.
    Jams: Warning or Fault where "more is missing than feed marks are high, 10 um" "pair.jams", "pair.md",
        (missing_um, by),
        "the pair jams: {missing_um} um of backlash are missing; "
        + "make the teeth thinner ({by}), or move the axes"
    /// The pair cannot turn through this position.
    Interference: Fault "pair.interference", "pair.md", (other, depth_um, place, own, angle_deg),
        "a tip of gear {other} is {depth_um} um deep in a {place} of gear {own} at the ratio of the pitch curves, at \
         {angle_deg} deg of gear A";
        "Use a lower addendum, more clearance, or a cutter that cuts deeper fillets."
    /// The gears do not roll at the ratio of gear A's curve.
    Misfit: Warning "pair.misfit", "pair.md", (misfit_um),
        "gear B's pitch curve is up to {misfit_um} um away from that of gear A's mate";
        "Let gearcut mate write the scene of gear B."
    /// The parts cannot be put together.
    NoClearance: Fault "pair.no_clearance", "pair.md", (missing_um, place),
        "the shaft does not go into the hub: {missing_um} um of clearance are missing along the pitch circle{place}; "
        + "thin the teeth of one part with gear.tooth_thickness_allowance_mm"
}

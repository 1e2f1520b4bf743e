//! Notices of pairs of cylindrical gears.

use crate::findings::notice::notices;

notices! {
    /// The pair cannot be assembled, or runs under load from both flanks.
    Jams: Warning "pair.jams", "pair.md", (missing_um, by),
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

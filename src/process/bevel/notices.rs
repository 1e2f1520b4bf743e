//! Notices of bevel gears and their pairs.

use crate::findings::notice::notices;

notices! {
    /// Pitch cones of both members do not roll on each other.
    PitchAngle: Warning "blank.pitch_angle", "bevel.md", (own_deg, teeth, mate_teeth, shaft_deg, right_deg),
        "the pitch angle is {own_deg} deg; {teeth} and {mate_teeth} teeth at a shaft angle of {shaft_deg} deg roll on \
         cones of {right_deg} deg";
        "Correct the pitch angle, the teeth or the shaft angle."
    /// Teeth break at a thin toe.
    WideFace: Warning "blank.wide_face", "bevel.md", (percent),
        "the face takes {percent} % of the outer cone distance; more than a third makes the toe weak";
        "Use a narrower face."
    /// The depth changes along the tooth other than the blank's.
    RootAngle: Warning "bevel.root_angle", "bevel.md", (off_deg),
        "the machine's root angle is {off_deg} deg off the blank's: slots are not parallel to the root cone";
        "Give the machine the root angle of the blank."
    /// Teeth have too little or too much clearance, and another thickness.
    Depth: Warning "bevel.depth", "bevel.md", (short_mm, way, add_mm),
        "slots come out {short_mm} mm {way} at the middle of the face: "
        + "add {add_mm} mm to machine.cradle.sliding_base_mm"
    /// Pressure angles of both sides come out wrong.
    ExchangedBlades: Warning "bevel.blades_exchanged", "bevel.md",
        (concave_deg, convex_deg, inside_deg, outside_deg, other_concave_deg, other_convex_deg, wanted_deg),
        "inside and outside blades look exchanged: concave flanks come out with a pressure angle of {concave_deg} deg, \
         convex ones with {convex_deg} deg; with outside blades of {inside_deg} deg and inside blades of {outside_deg} \
         deg it would be {other_concave_deg} and {other_convex_deg} deg, near gear.pressure_angle_deg = {wanted_deg}";
        "Exchange the blade angles."
    /// Part of the flanks is no envelope, but what the head left.
    ShortRoll: Warning "bevel.short_roll", "bevel.md", (operation, from_deg, to_deg, low_deg, high_deg),
        "operation {operation}: the cradle rolls from {from_deg} to {to_deg} deg, the flanks need {low_deg} to \
         {high_deg} deg: they are not generated as a whole";
        "Roll over the whole range that the flanks need."
    /// A machine that goes to the first position at rapid breaks head and blank.
    StartsInBlank: Warning "bevel.starts_in_blank", "bevel.md", (operation, deep_mm, way_out),
        "operation {operation}: where the roll begins the head is in the blank and would have to be withdrawn by \
         {deep_mm} mm to be clear of it; no feed to depth is part of the motion: programs go there as they go from \
         slot to slot, and thickest chips leave out those of the first revolution: {way_out}";
        "Begin the roll earlier, or cut the slots before."
    /// The machine cannot reach these positions.
    Travel: Warning "axis.travel", "bevel.md", (operation, axis, low, high, unit, from, to),
        "operation {operation}: {axis} goes from {low} to {high} {unit}, the machine from {from} to {to} {unit}: "
        + "check the settings, machine.five_axis.mounting_distance_mm and machine.bevel_limits"
    /// The gear is damaged: the head cuts teeth beside its slot.
    NextTooth: Fault "bevel.next_tooth", "bevel.md", (depth_mm, side, along_mm),
        "the head hits the next tooth: while one slot is cut, its blades go {depth_mm} mm into the {side} flank \
         beyond, {along_mm} mm from the middle of the face along the tooth; "
        + "roll less far, or use a smaller point width or a larger cutter"
    /// Undercut weakens the root and shortens the active flank.
    Undercut: Warning "flank.undercut", "bevel.md", (depth_mm, side, arc_mm, along_mm, end),
        "undercut: blades of the same slot go {depth_mm} mm below the {side} flank, {arc_mm} mm from its form point \
         and {along_mm} mm from the middle of the face towards the {end}; "
        + "use a smaller dedendum, larger blade angles or more teeth"
    /// Edges carry what flanks should: they wear, and the pair is loud.
    EdgeContact: Warning "pair.edge_contact", "bevel.md", (flanks, percent),
        "{flanks} flanks: over {percent} % of a pitch the contact is at an edge of the gear's or the pinion's flank";
        "Give the flanks more ease-off, or correct the mounting."
}

//! Notices that processes share: axes, programs, the cut, flanks, texture, limits of the drawing.

use super::notice::notices;

notices! {
    /// The machine cannot make this motion: its control slows down or stops, and another gear comes out.
    AxisLimit: Warning or Fault where "a program under test makes it" "axis.limit", "gcode.md",
        (operation, peak, reached, allowed, unit, way_out),
        "operation {operation}: the {peak} reaches {reached} {unit}, the machine allows {allowed} {unit}: {way_out}";
        "Make the motion slower or smoother as the notice says, or state the machine's true limits."

    /// Without a program the machine cannot be run from this scene.
    NoProgram: Warning "program.none", "gcode.md", (operation, why),
        "operation {operation}: no G-code written: {why}"; "Remove the reason that the notice names."
    /// The program makes another gear than the scene.
    ProgramOff: Warning or Fault where "the distance is deeper than a gouge" "program.off", "gcode.md",
        (operation, distance_um, of, place, asked_um),
        "operation {operation}: the program lies up to {distance_um} um off the scene's own {of}, at {place}; \
         {asked_um} um are asked (output.gcode_contour_error_um)";
        "Correct the program, or allow a larger output.gcode_contour_error_um."
    /// Where motion is missing, material is left; where there is more, something else may be cut.
    ProgramShare: Fault "program.share", "gcode.md", (operation, verb, percent),
        "operation {operation}: the program {verb} {percent} %";
        "Let the program make the scene's motion, all of it and no more."
    /// Forces, errors that depend on speed and times follow the program and no longer the scene.
    ProgramTime: Fault "program.time", "gcode.md", (operation, program_s, scene_s),
        "operation {operation}: the program takes {program_s} s for what the scene does in {scene_s} s: speeds, drifts \
         and lags are those of the program";
        "Give the program the scene's feeds, or the scene those of the program."
    /// The machine cannot follow the program.
    ProgramLimit: Fault "program.limit", "gcode.md", (operation, exceeded),
        "operation {operation}: {exceeded}, under the program"; "Lower the feeds of the program there."

    /// Heights of these rays may lie above the surface that was cut.
    Unconverged: Warning "cut.unconverged", "dexels.md", (rays),
        "{rays} rays did not converge: their heights may be too large; "
        + "please report the scene"
    /// Extremes and means over the gear lack the other flanks.
    Stopped: Warning "cut.stopped", "howto.md", (),
        "stopped by Ctrl-C: figures cover the finished flanks only"; "Let the run end, or cut with --draft."
    /// Numbers are those of a coarse cut.
    Draft: Note "cut.draft", "howto.md", (also),
        "a draft: dexels 8, rays and cells of maps 4 times as far apart; deviations, chips and texture are rough{also}";
        "Cut without --draft for numbers that count."
    /// Part of the flanks is still the blank, and no number covers it.
    Untouched: Warning "flank.uncut", "hobbing.md", (dexels, why),
        "{dexels} dexels were reached by no pass: {why}"; "Let the tool travel or roll further."
    /// Deviations of these flanks are evaluated over another part of the profile than the drawing says.
    Unreached: Note "measure.unreached", "results.md", (flanks),
        "{flanks} flanks do not reach an end of [measure]: there 5 % of the profile are left out instead";
        "Name ends that all flanks reach."
    /// A file or a chapter of this run is missing.
    PartFailed: Fault "cut.part_failed", "howto.md", (part, why),
        "{part}: {why}; everything else is there"; "Remove the reason that the notice names and run again."
    /// Meshes for other programs and pictures show no closed gear.
    NoBody: Warning "cut.no_body", "pictures.md", (left_out, why),
        "{left_out}; mesh/blank.ply shows the gear: {why}";
        "Correct what keeps the flanks from meeting, such as a tooth that is cut away."

    /// The teeth do not divide the turn evenly: the error lies on one pitch.
    CurveClosure: Warning "curve.closure", "shaping.md", (error_um, word, teeth),
        "the pitch curve is {error_um} um {word} for {teeth} teeth: the last tooth pays for it; "
        + "leave the size out and it is solved"
    /// The gear has another size than the points say.
    CurveScaled: Warning "curve.scaled", "shaping.md", (factor, teeth),
        "radii of the points are multiplied by {factor} to close on {teeth} teeth: "
        + "correct them, or write scale_to_close = true"

    /// The gear is damaged: material of its finished flanks is gone.
    Gouge: Fault "flank.gouge", "blank.md", (sides, by, place, depth_um, on_flanks, gouge_um),
        "{sides} cut below the target: {by} gouged {place} by {depth_um} um{on_flanks}; a gouge is deeper than \
         {gouge_um} um";
        "Leave more stock to the operations before finishing, or change the motion of the stroke that the notice names."
    /// Deviations of this size spend the tolerance of the drawing.
    BelowTarget: Warning "flank.below_target", "blank.md", (sides, by, place, depth_um, on_flanks, gouge_um),
        "{sides} cut below the target, by {depth_um} um at most ({by}, {place}){on_flanks}: deviations, no gouges, \
         which are deeper than {gouge_um} um";
        "Nothing, where the drawing allows it; else as for flank.gouge."
    /// Damage to the gear would not be seen.
    NoTarget: Note "blank.no_target", "blank.md", (why),
        "cuts below the target are not looked for: {why}"; "Give the gear the tool's own tips, whose outline is known."

    /// The gear may be refused at inspection.
    BeyondLimit: Warning "measure.limit", "results.md", (figure, symbol, place, value_um, limit_um, source),
        "{figure} {symbol}{place}: {value_um} um, beyond the limit of {limit_um} um ({source})";
        "Find the cause among the errors of machine and tool (gearcut budget), or allow more in [measure.limits]."
    /// The drawing's class is not verified.
    NotJudged: Warning "measure.not_judged", "results.md", (class, why),
        "class {class} is not judged: {why}; "
        + "write [measure.limits]"

    /// Parameters are those of the points that are left.
    Holes: Note "texture.holes", "texture.md", (of, holes),
        "{of}{holes} points of the window are holes: no pass reached them, or they are cut deeper than their rays \
         record";
        "Move the window to where the flank is cut."
    /// There are no numbers of this window.
    NotEvaluated: Note "texture.not_evaluated", "texture.md", (of, why),
        "{of}the window could not be evaluated: {why}"; "Change the window or its filters as the reason says."
    /// The numbers are rounding.
    NoMarks: Note "texture.no_marks", "texture.md", (of),
        "{of}this flank has no marks of the tool's motion: its numbers are those of rounding";
        "Remove the window, or give the machine the errors whose traces it is to show."
    /// Numbers of few marks depend on where the window begins.
    FewMarks: Note "texture.few_marks", "texture.md", (of, marks, direction, enough),
        "{of}the window holds only {marks} {direction}; {enough} at least make its numbers representative";
        "Make the window longer in that direction."
    /// Slopes and developed area come out too small.
    FewPoints: Warning "texture.few_points", "texture.md", (of, direction, points, enough, key),
        "{of}a mark {direction} has only {points} points; with less than {enough} slopes are averaged over cusps, and \
         Sdq and Sdr come out low: "
        + "make {key} smaller"
    /// The flank may be refused for its roughness.
    RoughnessLimit: Warning "texture.limit", "texture.md", (symbol, place, found_um, limit_um),
        "{symbol} of {place} is up to {found_um} um, above the drawing's limit of {limit_um} um";
        "Take more strokes or a lower feed."
    /// The drawing's limit of roughness is not verified.
    RoughnessNotJudged: Warning "texture.not_judged", "texture.md", (symbol, place, why),
        "{symbol} of {place} is not judged: {why}"; "Make the window longer, or give another cut-off."
    /// Surfaces of different places have no difference.
    PoorCorrelation: Warning "texture.correlation", "texture.md", (of, correlation),
        "{of}a correlation of {correlation} is poor: are these surfaces of one place?";
        "Compare surfaces of one place."
    /// Differences of a replica are those of heights with the wrong sign.
    InvertedHeights: Warning "texture.inverted", "texture.md", (of, correlation),
        "{of}with its heights inverted the second correlates with {correlation}: is one of them a replica? "
        + "`gearcut texture FILE --invert --save ...` turns it back"
    /// There is no comparison with what was measured.
    NotLaidOver: Fault "texture.not_laid_over", "texture.md", (of, why),
        "{of}it cannot be laid over what was cut: {why}"; "Measure the window's place, as large as the window."
}

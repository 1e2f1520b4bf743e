//! Quantities of the motion: how far a program under test is off the scene's own, and the errors of the machine.

use crate::findings::rows;

rows! {
    /// A program under test.
    PROGRAM: "program", "Program under test", "operations.<operation>.program";

    LARGEST_DISTANCE: "largest_distance", "um",
        "largest displacement of the tool in the work from the scene's own motion"
        => titled("off the scene's motion"), shown();
    MISSING_SHARE: "missing_share", "%", "share of the scene's motion that the program does not make"
        => titled("missing"), shown();
    SHARE_BEYOND: "share_beyond", "%", "motion beyond the ends of the scene's, as a share of it";
    PROGRAM_TIME: "time", "s", "time of the program for the motion that both make";
    SCENE_TIME: "scene_time", "s", "time of the scene for the motion that both make";
}

rows! {
    /// Errors of the machine, layer by layer.
    MACHINE_ERRORS: "machine_errors", "Errors of the machine", "machine_errors, of each layer under its name";

    LAYER: "layer", "", "errors of a layer that is on";
}

rows! {
    /// A turn that no gear shows.
    TURN: "turn", "Turn of the whole gear, taken off", "machine_errors.turn";

    TURN_ANGLE: "angle", "deg",
        "turn of the finished gear against its tool by drives that lag, the cycle of the gearbox and play; a gear has \
         no datum of angle, and the zero of the work spindle makes up for it";
    TURN_ON_FLANKS: "on_flanks", "um",
        "what that turn would move left flanks by along their normals, and right flanks the other way";
}

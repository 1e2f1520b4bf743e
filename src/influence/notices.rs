//! Notices of budgets, and of errors that are fitted to measured gears.

use crate::findings::notice::notices;

notices! {
    /// Its influence is not known, and it may be the cause.
    StepRefused: Note "error.step_refused", "budget.md", (parameter, why),
        "{parameter} was left out, its step is refused: {why}"; "Move the scene's value away from the end of its range."
    /// A larger error does not do so many times as much.
    NotLinear: Note "budget.not_linear", "budget.md", (parameters),
        "half the step or the other direction does not do in proportion: {parameters}. Their influences hold for the \
         step alone";
        "Shift these errors by what is expected of the machine, and cut."
    /// A parameter that was not reached may matter most.
    BudgetStopped: Warning "cut.stopped", "budget.md", (),
        "stopped by Ctrl-C: only finished parameters are ranked"; "Let the run end, or name fewer --parameters."

    /// One more error, or one more round, may explain the deviations better.
    DiagnosisStopped: Warning "cut.stopped", "budget.md", (errors, rounds),
        "stopped by Ctrl-C: {errors} errors were tried and {rounds} rounds of the fit done; another error or another \
         round may explain these deviations better";
        "Let the run end, or name fewer --parameters."
    /// Something happened to this tooth or flank that no error of the machine does.
    StandsOut: Warning "fit.stands_out", "budget.md", (what),
        "{what}; errors are fitted beside that";
        "Look at that place of the gear: a chip that was clamped, a nick, dirt on the probe."
    /// Sizes and intervals are not those of the best fit.
    DiagnosisUnsettled: Warning "fit.unsettled", "budget.md", (),
        "the fit has not settled: gears that are cut with the named sizes lead to others; intervals do not hold";
        "Name fewer --parameters, or check units and signs of what was measured."
    /// Something else is wrong with the gear than the scene can name.
    DiagnosisUnexplained: Warning "fit.unexplained", "budget.md", (left_um),
        "unexplained: {left_um} um are left beyond the noise of values and axes; no error that the scene can name \
         makes them, and what is named has no intervals: it may take the place of something else";
        "Check --noise-um, the noise of the axes in the scene (noise_arcsec, noise_um, noise_bandwidth_hz), and the \
         tool and blank that it names."
    /// Mending the named one may mend nothing.
    SameAs: Warning "fit.not_told_apart", "budget.md", (source, others),
        "{source} acts on these deviations like {others}: each would explain them as well";
        "Measure more teeth, both sides and helices, or look at the machine."
    /// Their size is not known one by one.
    NoOwnSize: Note "fit.no_own_size", "budget.md", (source),
        "parts of {source} are combinations of other named errors at these places and have no size of their own";
        "Measure more places."
    /// These errors may be there all the same.
    Hidden: Note "fit.hidden", "budget.md", (sources),
        "noise hides a natural step of these at the measured places, beside a turn of the gear: {sources}";
        "Measure with less noise, or more places."
    /// An error of the other sign is at work, or another one.
    Unsayable: Note "fit.unsayable", "budget.md", (sources),
        "these would explain something by a size that the scene has no word for, such as a play below 0, and are not \
         named: {sources}";
        "Check signs and sides of what was measured."

    /// Another round may change the sizes.
    CalibrationStopped: Warning "cut.stopped", "budget.md", (),
        "stopped by Ctrl-C: fitted by the rounds that were done; intervals are of the last one"; "Let the run end."
    /// The measured values want a machine that the scene cannot describe.
    AtEnd: Warning "fit.at_end_of_range", "budget.md", (parameter, shift, unit),
        "{parameter} is at the end of its range, {shift} {unit} beyond the scene: the measured values lie beyond, \
         and no interval of any parameter holds; are they in the units that their columns name?";
        "Check the units, or fit another error."
    /// Any size of it would fit as well.
    Unidentified: Warning "fit.unidentified", "budget.md", (parameter),
        "{parameter} cannot be identified: the measured values do not change with it about the size that the scene \
         has, or no more than with the others together";
        "Measure what it changes, or fit fewer errors. Largest values, such as F_r, have a kink at 0: \
         begin there with a little of the error (--set)."
    /// The sizes are not those of the best fit.
    CalibrationBeyond: Warning "fit.unsettled", "budget.md", (),
        "the fit has not settled: the measured values draw it beyond the ranges of keys, or to gears that cannot be \
         cut; are they in the units that their columns name?";
        "Check the units, or fit fewer errors."
    /// The sizes are not those of the best fit.
    CalibrationUnsettled: Warning "fit.unsettled", "budget.md", (),
        "the fit has not settled: its numbers are no least squares"; "Fit fewer errors, or start nearer to the machine."
    /// Something else is wrong with the gear than the fitted errors.
    CalibrationUnexplained: Warning "fit.unexplained", "budget.md", (of_1000),
        "unexplained: uncertainties alone leave residuals as large in {of_1000} of 1000 cases; something else is wrong";
        "Fit other errors as well, and check the stated uncertainties."
    /// Agreement is then no evidence.
    NoFreedom: Note "fit.no_freedom", "budget.md", (),
        "as many numbers are fitted as measured: that they agree says nothing about the model";
        "Measure more, or fit fewer errors."
    /// Numbers of one surface repeat each other.
    OneSurface: Warning "fit.one_surface", "budget.md", (symbols, surface, factor),
        "{symbols} of {surface} come from one surface, and are fitted as if each had been measured on a surface of its \
         own: intervals of what they say may be too narrow, by a factor of up to {factor}";
        "Name fewer --surface-numbers."
    /// Numbers of surfaces depend on the size of what is evaluated.
    OtherSize: Note "fit.other_size", "budget.md", (path, size, window),
        "{path} is {size} large, its window {window} along tooth and profile: numbers of surfaces depend on that";
        "Give the scene's window the size of the measured surface."
    /// Short waves count in one surface and not in the other.
    OtherSpacing: Note "fit.other_spacing", "budget.md", (path, apart, window),
        "points of {path} are {apart} apart, those of its window {window} or closer along tooth and profile: short \
         waves and noise count in one and not in the other unless both have the same s_filter_um";
        "Give both the same s_filter_um."
}

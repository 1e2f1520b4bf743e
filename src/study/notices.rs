//! Notices of studies.

use crate::findings::notice::notices;

notices! {
    /// Some cases have no row of numbers.
    CasesFailed: Warning "study.failed", "studies.md", (failed, cases, count, first, reason),
        "{failed} of {cases} cases could not be made; {count} of them, case {first} first, because: {reason}";
        "Change the scene or the ranges of the parameters; the column error of rows.csv has all reasons."
    /// What is said of a quantity is said of the other cases.
    ValuesMissing: Warning "study.missing", "studies.md", (cases, quantities),
        "{cases} cases have no value of kept quantities, and are not in what is said of these: {quantities}";
        "tables/missing.csv has the reasons; a draft is too coarse for marks of the tool."
    /// Words have no neighbours.
    ManyWords: Note "study.no_parts", "studies.md", (keys),
        "no effect is stated of parameters with more than 32 words, or with too few cases: {keys}";
        "Take fewer values, numbers, or more samples."
}

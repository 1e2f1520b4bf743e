//! Keys of where flanks are measured.

use super::{Key, KeySection, Range, Role};

/// `[measure]`.
pub(super) static SECTIONS: &[KeySection] = &[KeySection {
    path: "measure",
    role: Role::Plain,
    keys: &[
        Key::optional(
            "profile_start_height_mm",
            "mm",
            Range::closed(-100.0, 100.0),
            "from the form point, 5 % left out",
            "-2.0",
            "Lower end of the evaluated profile, as height over the pitch curve along its normal.",
        ),
        Key::optional(
            "profile_end_height_mm",
            "mm",
            Range::closed(-100.0, 100.0),
            "to the tip, 5 % left out",
            "2.5",
            "Upper end of the evaluated profile, as height over the pitch curve along its normal.",
        ),
    ],
    groups: &[],
    teach: "Where profiles are evaluated.",
}];

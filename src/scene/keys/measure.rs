//! Keys of where flanks are measured, and of the limits that they must keep.

use super::{Default, Key, KeySection, Kind, Range, Role};

impl Key {
    /// What a drawing allows a figure of inspection.
    const fn drawn_limit(name: &'static str, teach: &'static str) -> Self {
        Self::optional(name, "um", Range::above(0.0, 10_000.0), "that of the class, if there is one", "12.0", teach)
    }
}

/// `[measure]` and `[measure.limits]`.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new(
        "measure",
        Role::Plain,
        &[
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
            Key {
                name: "iso_1328_class",
                kind: Kind::Whole { min: 1, max: 11 },
                unit: "",
                default: Default::LeftOut("no class"),
                example: "6",
                teach: "Flank tolerance class of ISO 1328-1:2013 that a round gear must keep.",
            },
            Key::optional(
                "ball_diameter_mm",
                "mm",
                Range::above(0.0, 500.0),
                "1.728 x module, 1.44 x module in a ring",
                "5.25",
                "Diameter D_M of the balls or pins over which a round gear is measured.",
            ),
        ],
        "Where profiles are evaluated, and the limits that the gear must keep.",
    ),
    KeySection::new(
        "measure.limits",
        Role::Plain,
        &[
            Key::drawn_limit("profile_total_um", "Largest total profile deviation F_alpha."),
            Key::drawn_limit("profile_form_um", "Largest profile form deviation f_f_alpha."),
            Key::drawn_limit("profile_slope_um", "Largest profile slope deviation f_H_alpha, either sign."),
            Key::drawn_limit("helix_total_um", "Largest total helix (lead) deviation F_beta."),
            Key::drawn_limit("helix_form_um", "Largest helix form deviation f_f_beta."),
            Key::drawn_limit("helix_slope_um", "Largest helix slope deviation f_H_beta, either sign."),
            Key::drawn_limit("single_pitch_um", "Largest single pitch deviation f_p, either sign."),
            Key::drawn_limit("total_pitch_um", "Largest total pitch deviation F_p."),
            Key::drawn_limit("runout_um", "Largest runout F_r."),
            Key::optional(
                "ra_um",
                "um",
                Range::above(0.0, 100.0),
                "not judged",
                "0.8",
                "Largest Ra of lines along profile and tooth on texture windows; gives their cut-off (ISO 21920-3).",
            ),
            Key::optional(
                "rz_um",
                "um",
                Range::above(0.0, 1000.0),
                "not judged",
                "4.0",
                "Largest Rz of the same lines; gives the cut-off where Ra has no limit.",
            ),
        ],
        "Limits of the drawing. On a round gear they go before those of the class; other gears have no class, \
            and only these limits.",
    ),
];

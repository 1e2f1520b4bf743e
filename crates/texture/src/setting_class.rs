//! Setting classes of ISO 21920-3:2021: which cut-off and which S-filter belong to which roughness.
//!
//! | class | Ra, um, up to | Rz, um, up to | cut-off and section, mm | evaluation length, mm | S-filter, um |
//! | --- | --- | --- | --- | --- | --- |
//! | Sc1 | 0.02 | 0.16 | 0.08 | 0.4 | 2.5 |
//! | Sc2 | 0.1 | 0.8 | 0.25 | 1.25 | 2.5 |
//! | Sc3 | 2 | 16 | 0.8 | 4 | 2.5 |
//! | Sc4 | 10 | 80 | 2.5 | 12.5 | 8 |
//! | Sc5 | beyond | beyond | 8 | 40 | 25 |
//!
//! Limits, cut-offs and lengths were held against a published summary of the standard. The S-filters are from memory:
//! no readable source was found for that column.
//!
//! The standard takes the class from the upper limit on the drawing. Without one it is taken from an estimate of Ra
//! ([`crate::profile_chain`] says of which).

/// A class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SettingClass {
    /// Its name.
    pub name: &'static str,
    /// Largest Ra, um.
    pub ra_um: f64,
    /// Largest Rz, um.
    pub rz_um: f64,
    /// Nesting index of the profile L-filter (cut-off), which is also the section's length, um.
    pub cutoff_um: f64,
    /// Nesting index of the profile S-filter, um.
    pub s_filter_um: f64,
}

const fn class(name: &'static str, ra_um: f64, rz_um: f64, cutoff_um: f64, s_filter_um: f64) -> SettingClass {
    SettingClass { name, ra_um, rz_um, cutoff_um, s_filter_um }
}

/// All of them, the finest first.
pub const CLASSES: [SettingClass; 5] = [
    class("Sc1", 0.02, 0.16, 80.0, 2.5),
    class("Sc2", 0.1, 0.8, 250.0, 2.5),
    class("Sc3", 2.0, 16.0, 800.0, 2.5),
    class("Sc4", 10.0, 80.0, 2500.0, 8.0),
    class("Sc5", f64::INFINITY, f64::INFINITY, 8000.0, 25.0),
];

impl SettingClass {
    /// Index of the class of a roughness Ra, um.
    pub fn of_ra(ra_um: f64) -> usize {
        CLASSES.iter().position(|class| ra_um <= class.ra_um).unwrap_or(CLASSES.len() - 1)
    }

    /// Index of the class of a roughness Rz, um.
    pub fn of_rz(rz_um: f64) -> usize {
        CLASSES.iter().position(|class| rz_um <= class.rz_um).unwrap_or(CLASSES.len() - 1)
    }

    /// The S-filter that belongs to a cut-off, um: that of the first class whose cut-off is as long.
    pub fn s_filter_um(cutoff_um: f64) -> f64 {
        CLASSES.iter().find(|class| cutoff_um <= class.cutoff_um).unwrap_or(&CLASSES[4]).s_filter_um
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_belong_to_the_finer_class() {
        let cutoffs =
            [0.02, 0.021, 0.1, 0.8, 2.0, 2.1, 10.0, 50.0].map(|ra| CLASSES[SettingClass::of_ra(ra)].cutoff_um);
        assert_eq!(cutoffs, [80.0, 250.0, 250.0, 800.0, 800.0, 2500.0, 2500.0, 8000.0]);
        assert_eq!(CLASSES[SettingClass::of_rz(4.0)].name, "Sc3");
        assert_eq!([100.0, 800.0, 2500.0, 9000.0].map(SettingClass::s_filter_um), [2.5, 2.5, 8.0, 25.0]);
    }
}

//! Names of the parameters that refusals of this crate blame. A program that reads parameters from files puts its own
//! names in their place.

/// Before the name of a parameter of a mate's driver.
pub const OF_DRIVER: &str = "driver's ";

macro_rules! parameters {
    ($($name:ident = $words:literal),* $(,)?) => {
        $(
            #[doc = concat!("The ", $words, ".")]
            pub const $name: &str = $words;
        )*

        /// All of them.
        pub const ALL: &[&str] = &[$($name),*];
    };
}

parameters! {
    MODULE = "module",
    ADDENDUM = "addendum",
    FACE_WIDTH = "face width",
    CIRCLE = "circle",
    ELLIPSE = "ellipse",
    ELLIPSE_ORDER = "order of the ellipse",
    ELLIPSE_ECCENTRICITY = "eccentricity of the ellipse",
    ELLIPSE_SIZE = "semi-major axis of the ellipse",
    SINUSOIDAL_RATIO = "sinusoidal ratio",
    SINUSOIDAL_ORDER = "order of the sinusoidal ratio",
    SINUSOIDAL_AMPLITUDE = "amplitude of the sinusoidal ratio",
    SINUSOIDAL_SIZE = "centre distance of the sinusoidal ratio",
    PASCAL = "curve of Pascal",
    PASCAL_ORDER = "order of the curve of Pascal",
    PASCAL_ECCENTRICITY = "eccentricity of the curve of Pascal",
    PASCAL_SIZE = "mean radius of the curve of Pascal",
    FOURIER = "Fourier series",
    FOURIER_SIZE = "mean radius of the Fourier series",
    RADIUS_FORMULA = "radius formula",
    RADIUS_FORMULA_SIZE = "scale of the radius formula",
    RATIO_FORMULA = "ratio formula",
    RATIO_FORMULA_SIZE = "centre distance of the ratio formula",
    TABLE = "table of points",
    TABLE_POINTS = "points of the table",
    TABLE_SCALING = "scaling of the table",
    MATE = "mate",
    MATE_DRIVER = "mate's driver",
    MATE_DRIVER_TEETH = "teeth of the mate's driver",
    SECTOR = "sector",
    DWELL_RADIUS = "radius of the dwell arc",
    PITCH_ANGLE = "pitch angle",
    ROOT_ANGLE = "root angle",
    FACE_ANGLE = "face angle",
    BLADES = "blades",
    TIP_WIDTH = "tip width of the blades",
    CORNER_RADIUS = "corner radius of the blades",
    CRADLE = "settings of the cradle",
    BLANK_OFFSET = "blank offset",
    SLIDING_BASE = "sliding base",
    MACHINE_ROOT_ANGLE = "root angle of the machine",
    RAY_SPACING = "spacing of the blank's rays",
}

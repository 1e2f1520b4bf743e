//! Spiral bevel and hypoid gears cut with a face-mill head: blank, head, machines, and the flank that they generate.
//!
//! In: cone data, settings of a machine, the head. Out: poses of the tool over the roll ([`cradle`], [`five_axis`]),
//! blades for the passes ([`face_mill`]), and the flank in the limit of many blades ([`envelope`], [`flank`]).
//!
//! **Frames**, after Chen, Yan, Ming and Xie (2008), Figs. 2 and 3; all are right-handed, lengths in mm:
//!
//! - machine frame m: origin in the machine centre, z along the cradle's axis from the cutter to the work, x in the
//!   plane of cradle axis and work axis, away from the apex along the generatrix of the root cone that the head
//!   touches;
//! - tool frame t: origin in the middle of the plane of the blades' tips, z along the head's axis to the work. It turns
//!   with the cradle: t is m turned about z by the cradle angle q and moved by the radial setting S_r;
//! - work frame p (the paper's S_p): x along the work's axis from the apex towards the back, turning with the work.
//!   With root angle gamma_m and work angle A a point is p = R_x(-A) (R_y(gamma_m) (m + (X_B, E_m, X_D)) - (X_p, 0,
//!   0)).
//!
//! Angles of roll count as the paper counts them: the work turns by A about -x while the cradle turns by q about z.
//!
//! The law of generation: the cutting surface is a surface of revolution about the head's axis, and a point of it is on
//! the gear's flank in the moment when its normal is square to its velocity in the work, n . v = 0.

pub mod blank;
pub mod clearance;
pub mod contact;
pub mod cradle;
pub mod ease_off;
pub mod envelope;
pub mod face_mill;
pub mod five_axis;
pub mod flank;
pub mod inferred;

//! Two gears that roll on each other without load: when their flanks touch, how evenly they turn, how much play they
//! have.
//!
//! In: pitch curves and flanks of both gears, nominal or cut. Out: rotations of the driven gear at which flanks touch,
//! and what follows from them. Everything lives in transverse planes: one of a spur pair, several of a helical one or
//! of one whose axes are out of parallel.
//!
//! | module | what |
//! | --- | --- |
//! | [`pitch_pair`] | the pitch curves: closing centre distance, ratio law, path of contact |
//! | [`flank_chain`] | flanks as chains of points, by tooth and side |
//! | [`contact`] | where a flank of the driver touches one of the driven gear |
//! | [`assembly`] | the gears in the machine, with errors of mounting |
//! | [`rolling`] | a whole period: transmission error and its harmonics |
//! | [`backlash`] | the play between both flanks, in four measures |
//! | [`contact_ratio`] | path of contact between the tips, contact ratio of a moment and of a tooth |
//! | [`double_flank`] | the centre distance without play: against the mate and against a master |
//! | [`flank_limits`] | how far generated flanks reach along the line of action |
//! | [`penetration`] | how deep tip corners stand in the mate's material |
//! | [`pattern`] | how near the mate comes to every point of a flank |
//!
//! Words: the driver (gear 1) turns clockwise as phi_1 grows and pushes with its **right** flanks; its left flanks are
//! the back flanks. The **transmission error** is the rotation of the driven gear less the one that the pitch curves
//! ask for.

pub mod assembly;
pub mod backlash;
pub mod contact;
pub mod contact_ratio;
pub mod double_flank;
pub mod flank_chain;
pub mod flank_limits;
pub mod pattern;
pub mod penetration;
pub mod pitch_pair;
pub mod rolling;
#[cfg(test)]
mod tests;

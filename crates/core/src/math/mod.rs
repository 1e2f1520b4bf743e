//! Mathematics that knows no gears: Taylor series, formulas, roots and extrema (see [`convergence`]), integrals,
//! splines, rays against closed curves.

pub mod column_basis;
pub mod convergence;
pub mod extremum;
pub mod formula;
pub mod jet;
pub mod least_squares;
pub mod newton;
pub mod periodic_integral;
pub mod periodic_spline;
pub mod planar_rays;
pub mod ray_reach;
pub mod roots;

pub use jet::Jet;

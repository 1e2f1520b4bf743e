//! Hobbing: linkages, flanks, blanks, tools, deviations and programs.

mod blank;
mod body;
mod corners;
mod deviations;
pub(crate) mod drawn_teeth;
mod evaluated;
mod feed_marks;
mod force;
mod foreseen_chips;
mod gcode;
mod hollow;
mod kept;
mod machine_errors;
mod metrology;
mod oracle;
mod page;
mod papers;
mod program_under_test;
mod round_gear;
mod section_polygon;
mod spatial;
mod spline;
mod surface;
mod thickness;
mod tip_relief;
mod tools;
mod wear;

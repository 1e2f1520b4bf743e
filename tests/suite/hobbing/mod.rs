//! Hobbing: linkages, flanks, blanks, tools, deviations and programs.

mod blank;
mod body;
mod corners;
mod deviations;
mod gcode;
mod hollow;
mod metrology;
mod oracle;
mod papers;
mod spatial;
mod surface;
mod thickness;
mod tools;

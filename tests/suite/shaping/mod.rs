//! Shaping: linkages, flanks, blanks, chips and programs.

mod active_flank;
mod answers;
mod below_zero;
mod blank_field;
mod chips;
mod deflection;
mod deflection_polygons;
mod edge_roughness;
mod flank_chips;
mod flank_heights;
mod gcode;
mod gcode_kinematics;
mod injected_errors;
mod internal_oracle;
mod internal_refusals;
mod internal_ring;
mod linkage_envelope;
mod linkage_oracle;
mod machine_errors;
mod noise;
mod oracle;
mod paper_figures;
mod planted;
mod retraction;
mod round_gear;
mod rubbing;

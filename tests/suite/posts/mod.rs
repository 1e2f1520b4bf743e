//! Programs for LinuxCNC, SINUMERIK and FANUC, read by readers that know nothing of the writer: each was written from
//! the control's manual and refuses what the control would refuse or take for something else. What they read must move
//! the axes as the linkage does, from a clear position to a clear position.

mod controls;
mod fanuc;
mod linuxcnc;
mod paths;
mod siemens;

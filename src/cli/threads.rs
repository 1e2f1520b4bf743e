//! The threads that share the work.

use super::failure::Failure;
use rayon::ThreadPoolBuilder;

/// Starts them, one for each core or as many as `RAYON_NUM_THREADS` says, before anything is begun: where the first
/// loop started them itself, a system without room for them would end the program in a panic.
///
/// # Errors
/// The system starts no more threads.
pub fn start() -> Result<(), Failure> {
    ThreadPoolBuilder::new().build_global().map_err(|reason| {
        Failure::of_system(&format!(
            "the system does not start the threads that share the work: {reason}\n  way out: RAYON_NUM_THREADS=1 \
             gearcut ... takes one; `ulimit -u`, and of a container its limit of processes, say how many there may be"
        ))
    })
}

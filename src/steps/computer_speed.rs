//! How fast this machine computes, against the one on which the rates of estimates were measured.
//!
//! In: pieces of the work that is to be estimated, each with the seconds that the rates say. Out: the factor between
//! the processor time that they took and those seconds. Processor time, not wall time: other programs that run at the
//! same time change the one only.
//!
//! Road not taken: a benchmark of its own. It would say nothing of the mix of planning and cutting that this scene asks
//! for.

use std::ops::AddAssign;
use std::time::Duration;

/// Processor time for pieces of work, s: enough for a factor, and nobody waits for it.
const BUDGET_S: f64 = 0.15;

/// So much work is taken to have lasted as long as the rates say. Pieces of coarse fields are over at once, and what a
/// plan costs whatever its size would be taken for a slow machine.
const ASSUMED_S: f64 = 0.05;

/// Pieces of work that were timed.
#[derive(Debug, Clone, Copy, Default)]
pub struct ComputerSpeed {
    expected_s: f64,
    taken_s: f64,
}

impl ComputerSpeed {
    /// Does a piece and times it; `expected_s` says of what it gave how long it takes by the rates.
    pub fn piece<T>(&mut self, work: impl FnOnce() -> T, expected_s: impl FnOnce(&T) -> f64) -> T {
        let before = processor_time();
        let done = work();
        self.taken_s += processor_time().saturating_sub(before).as_secs_f64();
        self.expected_s += expected_s(&done);
        done
    }

    /// Whether there is time for more pieces.
    pub fn wants_more(&self) -> bool {
        self.taken_s < BUDGET_S
    }

    /// Processor time that the pieces took, s.
    pub fn taken_s(&self) -> f64 {
        self.taken_s
    }

    /// Seconds on this machine for a second by the rates; nearly 1 where little was timed.
    pub fn factor(&self) -> f64 {
        (self.taken_s + ASSUMED_S) / (self.expected_s + ASSUMED_S)
    }
}

/// Pieces that several threads timed count together.
impl AddAssign for ComputerSpeed {
    fn add_assign(&mut self, other: Self) {
        self.expected_s += other.expected_s;
        self.taken_s += other.taken_s;
    }
}

/// Processor time of this command so far, all threads, s: what it did before an estimate a cut does as well.
pub fn so_far_s() -> f64 {
    processor_time_of_command().as_secs_f64()
}

/// Processor time of this thread.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    // Neither is negative.
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Processor time of all threads.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn processor_time_of_command() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// The same without a clock for it.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn processor_time_of_command() -> Duration {
    processor_time()
}

/// Where the system has no such clock, wall time stands in for it.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn processor_time() -> Duration {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What one thread takes is among what the command has taken.
    #[test]
    fn the_command_takes_what_its_threads_take() {
        let before_s = so_far_s();
        let mut speed = ComputerSpeed::default();
        let spin = |rounds: u64| (0..rounds).fold(1.0_f64, |x, i| (x + i as f64).sqrt());
        let x = speed.piece(|| spin(3_000_000), |_| 1e-3);
        let after_s = so_far_s();
        assert!(x > 0.0 && after_s - before_s >= 0.99 * speed.taken_s(), "{before_s} {after_s} {}", speed.taken_s());
    }

    #[test]
    fn the_factor_is_time_taken_over_time_expected() {
        let mut speed = ComputerSpeed::default();
        assert!(speed.wants_more() && speed.factor() == 1.0);
        let spin = |rounds: u64| (0..rounds).fold(1.0_f64, |x, i| (x + i as f64).sqrt());
        let x = speed.piece(|| spin(3_000_000), |_| 1e-3);
        let once = speed;
        speed.piece(|| spin(3_000_000), |_| 1e-3);
        assert!(x > 0.0 && once.taken_s > 0.0 && speed.taken_s > once.taken_s);
        let wanted = (once.taken_s + ASSUMED_S) / (1e-3 + ASSUMED_S);
        assert!((once.factor() - wanted).abs() < 1e-9);
        let mut both = once;
        both += once;
        assert_eq!([both.expected_s, both.taken_s], [2.0 * once.expected_s, 2.0 * once.taken_s]);
        let slow = ComputerSpeed { expected_s: 1.0, taken_s: 2.0 };
        assert!((slow.factor() - 2.0).abs() < 0.06, "{}", slow.factor());
        // A thread that sleeps takes no processor time.
        let mut idle = ComputerSpeed::default();
        idle.piece(|| std::thread::sleep(Duration::from_millis(60)), |()| 0.06);
        assert!(cfg!(windows) || idle.factor() < 0.5, "{}", idle.factor());
    }
}

//! The one place where this crate waits for what a device answers. In a browser nobody may: there everything that
//! comes later is awaited.

use std::future::Future;

/// Waits.
pub fn wait<T>(answer: impl Future<Output = T>) -> T {
    pollster::block_on(answer)
}

//! What a callback brings, as a future.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

/// Something that comes once; clones wait for the same.
pub struct Arrival<T>(Arc<Mutex<(Option<T>, Option<Waker>)>>);

impl<T> Arrival<T> {
    /// It is here.
    pub fn with(self, arrived: T) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.0 = Some(arrived);
        if let Some(waiting) = state.1.take() {
            waiting.wake();
        }
    }
}

impl<T> Default for Arrival<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Clone for Arrival<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> Future for Arrival<T> {
    type Output = T;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<T> {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match state.0.take() {
            Some(arrived) => Poll::Ready(arrived),
            None => {
                state.1 = Some(context.waker().clone());
                Poll::Pending
            }
        }
    }
}

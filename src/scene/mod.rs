//! Scene text to checked values.
pub mod model;
pub use model::Scene;

/// All problems found in one scene.
#[derive(Debug, thiserror::Error)]
#[error("placeholder")]
pub struct SceneErrors;

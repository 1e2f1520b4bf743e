//! Scenes: read, refused, overridden.

mod broken;
mod hostile;
mod keys;
mod load;
mod mate;
mod settings;

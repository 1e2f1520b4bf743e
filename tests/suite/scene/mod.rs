//! Scenes: read, refused, overridden.

mod broken;
mod core_words;
mod hostile;
mod keys;
mod load;
mod mate;
mod settings;

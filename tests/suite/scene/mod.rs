//! Scenes: read, refused, overridden.

mod broken;
mod core_words;
mod drawn_curve;
mod hostile;
mod keys;
mod load;
mod mate;
mod motion_table;
mod settings;

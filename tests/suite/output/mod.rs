//! Files, pictures and folders as other programs see them.

mod charts;
mod exr;
mod folder;
mod maps;
mod meshes;
mod progress;
mod work;

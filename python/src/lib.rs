//! gearcut for Python: what the package `gearcut` cannot do in Python itself.
//!
//! In: scenes as text or path, arrays, callables that watch. Out: arrays of numpy that own what Rust has allocated, and
//! findings as the text of `results.json`, whose numbers read back to the last bit. The package's Python files make
//! classes of them (`python/gearcut`); nobody else uses this module.
//!
//! The rule: work runs on a thread of its own without the lock of the interpreter, while the calling thread listens for
//! Ctrl-C ([`waiting`]). Nothing of gearcut is done twice here: every number is the library's.
//!
//! Road not taken: classes of Rust for findings, tables and notices. Python reads them from one text, the same one
//! that lies in output folders, so that results of yesterday and of another machine are the same objects.

mod failure;
mod flank;
mod job;
mod pair;
mod scene;
mod study;
mod texture;
mod waiting;

use pyo3::prelude::*;

/// The module `gearcut._native`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("NO_PASS", gearcut_core::dexel::NO_PASS)?;
    module.add_class::<scene::NativeScene>()?;
    module.add_class::<job::NativeJob>()?;
    module.add_function(wrap_pyfunction!(pair::pair, module)?)?;
    module.add_function(wrap_pyfunction!(study::study, module)?)?;
    module.add_function(wrap_pyfunction!(texture::texture, module)?)?;
    module.add_function(wrap_pyfunction!(texture::texture_of_file, module)?)?;
    Ok(())
}

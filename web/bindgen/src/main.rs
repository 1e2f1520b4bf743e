//! Writes the JavaScript that calls a wasm library, and the library without what only this step reads.
//!
//! In: the library as the compiler left it, and a folder. Out: `gearcut.js` and `gearcut_bg.wasm` in the folder, as a
//! module of JavaScript that a page or a worker imports.
//!
//! Road not taken: installing `wasm-bindgen-cli`. It takes two minutes to build, with a client for the web in it, and
//! its version has to be kept equal by hand.

use std::env::args_os;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [library, folder] = args_os().skip(1).collect::<Vec<_>>().try_into().map_err(|_| "give LIBRARY.wasm FOLDER")?;
    let mut bindgen = Bindgen::new();
    bindgen.input_path(library).out_name("gearcut").web(true)?.typescript(false).remove_name_section(true);
    Ok(bindgen.generate(folder)?)
}

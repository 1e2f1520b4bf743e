//! Reads a measured surface, takes off its form and its waviness, and prints its parameters.
//!
//! `cargo run -p gearcut-texture --example read_x3p -- FILE.x3p [L_FILTER_UM]`; without a file the one of the tests is
//! taken.

use gearcut_texture::files::read_surface;
use gearcut_texture::{Arguments, Chain, Evaluation, Form};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let sample = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/written_elsewhere/x3pio.x3p"));
    let path = arguments.next().map_or_else(sample, PathBuf::from);
    let l_filter_um = arguments.next().map(|text| text.parse()).transpose()?;

    let file = read_surface(&path, None)?;
    let chain = Chain { l_filter_um, ..Chain::of_form(Form::Plane) };
    let (surface, steps) = chain.apply(&file.surface)?;
    let [x_mm, y_mm] = surface.size_mm();
    println!("{}: {} x {} points, {x_mm} x {y_mm} mm", path.display(), surface.nx(), surface.ny());
    for step in steps {
        println!("{step}");
    }
    for parameter in Evaluation::of(&surface, &Arguments::default()).parameters {
        match parameter.value {
            Ok(value) => println!("{:10} {value:12.6} {}", parameter.symbol, parameter.unit),
            Err(why) => println!("{:10} none: {why}", parameter.symbol),
        }
    }
    Ok(())
}

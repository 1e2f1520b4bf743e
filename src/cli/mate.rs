//! `gearcut mate`: the scene of the gear that runs with a scene's gear, and what `gearcut check` warns about in it.

use std::path::Path;

use crate::output::text::Sheet;
use crate::process;
use crate::scene::Mate;
use gearcut_core::gear::GearKind;

use super::args::MateArguments;
use super::failure::Failure;
use super::new::write_new;
use super::print;

/// Runs the command.
pub fn run(arguments: &MateArguments) -> Result<(), Failure> {
    let loaded = process::load(&arguments.scene.scene, &arguments.scene.settings)?;
    let kind = if arguments.internal { GearKind::Internal } else { GearKind::External };
    let wanted = Mate { teeth: arguments.teeth, kind };
    // What goes to the terminal is meant for the current folder.
    let folder = arguments.out.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    // The refusal blames keys of the mate's scene, which does not exist yet: it is no place in the driver's file.
    let mate = print::waiting("mate", "scene", || loaded.mate(wanted, folder)).map_err(|refusal| {
        let words = if arguments.internal { "internal" } else { "external" };
        Failure::without_place(&format!("no {words} mate with {} teeth", wanted.teeth), &refusal)
    })?;
    let Some(path) = &arguments.out else { return Ok(print::to_stdout(&mate.text)?) };
    write_new(path, &mate.text)?;
    let shown = path.display();
    let note = format!("`gearcut check {shown}` says what it means; `gearcut pair` rolls both, once they are cut\n");
    print::sheet(&format!("wrote {shown}: distance of the axes {:.6} mm\n{note}", mate.center_distance_mm))?;
    // Tip, tool and operations are the driver's: on the mate's curve they may not do.
    let written = process::load(path, &[])?;
    let checked = print::waiting("check", "mate", || {
        process::prepare(&written.scene).and_then(|job| job.check(&mut Sheet::brief()))
    });
    print::warnings(&checked.map_err(|error| Failure::of_scene(&written, error))?);
    Ok(())
}

//! `gearcut study` and `gearcut sweep`: many scenes that differ in a few keys, one row of quantities each.

use super::args::{CasesArguments, StudyArguments, SweepArguments};
use super::failure::Failure;
use super::folder::listening;
use super::{backend, print};
use crate::findings::table::table_file;
use crate::interrupt::Interrupt;
use crate::study::StudyPlan;
use crate::study::engine::ROWS;
use crate::study::file::{StudyFile, folder_of, read};

/// Runs `study`.
pub fn study(arguments: &StudyArguments) -> Result<(), Failure> {
    let file = read(&arguments.study, arguments.cases.most_cases)?;
    let stem = arguments.study.file_stem().and_then(|stem| stem.to_str()).unwrap_or("study");
    run(file, stem, &arguments.cases)
}

/// Runs `sweep`.
pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let listed = arguments.grid.iter().map(|of| of.0.clone());
    let parameters = listed.chain(arguments.range.iter().map(|of| of.0.clone())).collect();
    let sampling = (arguments.samples, arguments.design.design(), arguments.seed);
    let file = StudyFile {
        scene: arguments.scene.scene.clone(),
        command: arguments.command.command(),
        mate: arguments.mate.clone(),
        draft: arguments.draft,
        settings: arguments.scene.settings.clone(),
        keep: arguments.keep.clone(),
        maps: Vec::new(),
        plan: StudyPlan::new(parameters, sampling, arguments.cases.most_cases)?,
    };
    let stem = arguments.scene.scene.file_stem().and_then(|stem| stem.to_str()).unwrap_or("scene");
    run(file, stem, &arguments.cases)
}

fn run(file: StudyFile, stem: &str, arguments: &CasesArguments) -> Result<(), Failure> {
    let base = file.base()?;
    let shard = arguments.shard;
    let out = arguments.out.clone().unwrap_or_else(|| folder_of(&format!("{stem}_study"), shard));
    let interrupt = Interrupt::listen().map_err(listening(&out))?;
    let (choice, progress) = backend::of_few_places(&arguments.compute, false, &base.scene.scene)?;
    let done = file.study(&base, shard, &choice).run(&out, (&progress, &interrupt))?;
    if done.rows < done.cases {
        return Err(Failure::to_go_on(&out, [done.rows, done.cases], "cases"));
    }
    let rows = done.path.join(table_file(ROWS));
    let failed = if done.failed == 0 { String::new() } else { format!(", {} of them failed", done.failed) };
    print::sheet(&format!("{} cases{failed}; their rows are in {}\n", done.cases, rows.display()))?;
    if !done.notices.is_empty() {
        print::warnings(&done.notices);
    }
    Ok(())
}

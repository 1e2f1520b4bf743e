//! `gearcut devices`: what can compute here, what `--backend auto` would take, and how fast each is.

use crate::backend;
use crate::backend::bench_machines;
use crate::bench::{KERNELS, KernelRate, kernel_rates};
use crate::number_text::significant;
use crate::output::text::Sheet;
use crate::progress::{Progress, ProgressMode};

use super::args::DevicesArguments;
use super::failure::Failure;
use super::{drivers, print};

/// Runs the command.
pub fn run(arguments: &DevicesArguments) -> Result<(), Failure> {
    drivers::without_window_system();
    let devices = backend::devices();
    if !arguments.bench {
        return Ok(print::sheet(&format!("{devices}\n"))?);
    }
    let machines = bench_machines();
    let progress = Progress::new(ProgressMode::choose(false, false));
    let step = progress.step("kernels", (machines.len() * KERNELS) as u64, "rates");
    let mut rates: Vec<[KernelRate; KERNELS]> = Vec::new();
    let mut heads = vec!["million in a second".to_owned()];
    for (name, machine) in &machines {
        rates.push(kernel_rates(machine.as_ref(), &|| step.advance(1))?);
        heads.push(name.clone());
    }
    step.finish();
    let row = |kernel: usize| -> Vec<String> {
        let KernelRate { kernel: cuts, unit, .. } = rates[0][kernel];
        let values = rates.iter().map(|of| significant(1e-6 * of[kernel].per_second, 3));
        std::iter::once(format!("{cuts}, {unit}")).chain(values).collect()
    };
    let mut sheet = Sheet::default();
    sheet.table(&std::iter::once(heads).chain((0..KERNELS).map(row)).collect::<Vec<_>>());
    Ok(print::sheet(&format!("{devices}\n\n{}\n", sheet.into_text()))?)
}

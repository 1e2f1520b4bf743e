//! A diagnosis as findings, and for the terminal.

use super::{Diagnosis, ErrorModel, FittedSize, NamedSource};
use crate::findings::{Datum, Entry, Findings, Quantity, Section, Table, TableColumn, Warning};
use crate::influence::measured::MeasuredPoint;
use crate::output::summary;
use crate::output::text::{Sheet, significant};
use crate::scene::Scene;

/// What stands behind every fitted number.
const FITTED: &str = "fitted";

/// The tree.
pub fn findings(
    scene: &Scene,
    model: &ErrorModel,
    points: &[MeasuredPoint],
    noise_um: f64,
    found: &Diagnosis,
) -> Findings {
    let percent = |share: Option<f64>| share.map(|share| 100.0 * share);
    let headline = vec![
        Entry::headline(
            "sources",
            "sources named",
            Quantity::count(found.named.len() as u64, "sources", "fitted: errors that explain more than noise would"),
        ),
        Entry::headline(
            "explained",
            "explained",
            Quantity::number_or(
                percent(found.explained),
                "%",
                "fitted: share of the squared deviations, beside those of the scene and a turn, that the named sources \
                 take away",
                "nothing deviates",
            ),
        ),
        Entry::headline(
            "residual",
            "left over",
            Quantity::number(found.residual_um, "um", "fitted: root mean square of the residuals"),
        ),
        Entry::headline(
            "unexplained",
            "unexplained",
            Quantity::number(
                found.unexplained_um,
                "um",
                "fitted: root mean square of what is left beyond the stated noise; 0 where noise makes as much in more \
                 than 1 of 1000 gears",
            ),
        ),
    ];
    let turn = |of: fn(FittedSize) -> f64, what| {
        Quantity::number_or(found.turn_arcsec.map(of), "arcsec", what, "no measured place shows a turn")
    };
    let section = Section::new("diagnosis", "Diagnosis")
        .with("points", Quantity::count(points.len() as u64, "places", "measured places"))
        .with("noise", Quantity::number(noise_um, "um", "stated standard deviation of every measured value"))
        .with("turn", {
            let what = "fitted: how far the gear stood turned on the measuring machine, counter-clockwise";
            turn(|turn| turn.size, what)
        })
        .with("turn_low", turn(|turn| turn.interval[0], "fitted: lower end of its 95 % interval"))
        .with("turn_high", turn(|turn| turn.interval[1], "fitted: upper end of its 95 % interval"))
        .with("freedom", Quantity::count(found.freedom as u64, "1", "measured values less fitted numbers"))
        .with("chance", {
            let what = "chance that noise alone leaves as much: chi-square of the residuals over the stated noise";
            Quantity::number(found.chance, "1", what)
        })
        .with("rounds", {
            let what = "fitted: how often the gear was cut with the sizes found so far, until they moved no more";
            Quantity::count(found.rounds as u64, "1", what)
        })
        .with("bent", {
            let what = "measured places that the first fit went without, where the heights bend by more than the noise \
                        within a natural step of an error; all others have them";
            Quantity::count(found.bent as u64, "places", what)
        })
        .table(sources(model, found))
        .table(residuals(points, model, found));
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: scene.process_name().to_owned(),
        scene: scene.name.clone(),
        complete: model.complete,
        headline,
        warnings: warnings(model, found),
        sections: vec![section],
    }
}

fn title(model: &ErrorModel, source: usize) -> String {
    model.sources[source].title()
}

fn warnings(model: &ErrorModel, found: &Diagnosis) -> Vec<Warning> {
    let names = |sources: &[usize]| sources.iter().map(|&source| title(model, source)).collect::<Vec<_>>().join("; ");
    let mut warnings = Vec::new();
    if !model.complete {
        warnings.push(Warning::warn(format!(
            "stopped by Ctrl-C: {} errors were tried and {} rounds of the fit done; another error or another round may \
             explain these deviations better",
            model.sources.len(),
            found.rounds
        )));
    } else if !found.settled {
        warnings.push(Warning::warn(
            "the fit has not settled: gears that are cut with the named sizes lead to others; intervals do not hold",
        ));
    }
    if found.unexplained_um > 0.0 {
        warnings.push(Warning::warn(format!(
            "unexplained: {} um are left beyond the stated noise; no error that the scene can name makes them",
            significant(found.unexplained_um, 3)
        )));
    }
    for named in &found.named {
        if !named.same_as.is_empty() {
            warnings.push(Warning::warn(format!(
                "{} cannot be told apart from: {}. Each would explain these deviations as well",
                title(model, named.source),
                names(&named.same_as)
            )));
        }
        if named.fitted.contains(&None) {
            warnings.push(Warning::note(format!(
                "parts of {} are combinations of other named errors at these places and have no size of their own",
                title(model, named.source)
            )));
        }
    }
    if !found.hidden.is_empty() {
        warnings.push(Warning::note(format!(
            "noise hides a natural step of these at the measured places, beside a turn of the gear: {}",
            names(&found.hidden)
        )));
    }
    if !found.unsayable.is_empty() {
        warnings.push(Warning::note(format!(
            "these would explain something by a size that the scene has no word for, such as a play below 0, and are \
             not named: {}",
            names(&found.unsayable)
        )));
    }
    for (parameter, why) in &model.refused {
        warnings.push(Warning::note(format!("{} was left out, its step is refused: {why}", parameter.id)));
    }
    warnings
}

/// A row for each fitted parameter.
fn sources(model: &ErrorModel, found: &Diagnosis) -> Table {
    let low = "lower end of its 95 % interval, over all sets of sources that explain the deviations about as well";
    let alone = "half the width of the 95 % interval if exactly the named sources are there";
    let sure = "weight of the sets of sources with this one, of all that explain the deviations about as well";
    let columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("error", "what it is"),
        TableColumn::words("kind", "fitted: a number that was chosen so that it explains the measured values"),
        TableColumn::by_row("size", "size, beyond that of the scene").or("other errors say all of it"),
        TableColumn::by_row("low", low).or("other errors say all of it"),
        TableColumn::by_row("high", "upper end of that interval").or("other errors say all of it"),
        TableColumn::by_row("half_if_right", alone).or("other errors say all of it"),
        TableColumn::words("unit", "unit of sizes and intervals"),
        TableColumn::new("sure", "%", sure),
        TableColumn::new("alone", "%", "share of the squared deviations that no other named source explains"),
        TableColumn::words("same_as", "sources that would explain as much in its place"),
    ];
    let mut rows = Vec::new();
    for named in &found.named {
        let source = &model.sources[named.source];
        for (parameter, fitted) in source.parameters.iter().zip(&named.fitted) {
            let same: Vec<&str> = named.same_as.iter().map(|&other| model.sources[other].key.as_str()).collect();
            rows.push(vec![
                parameter.id.as_str().into(),
                parameter.title.as_str().into(),
                FITTED.into(),
                Datum::from(fitted.map(|fitted| fitted.size)),
                Datum::from(fitted.map(|fitted| fitted.interval[0])),
                Datum::from(fitted.map(|fitted| fitted.interval[1])),
                Datum::from(fitted.map(|fitted| fitted.half_if_right)),
                parameter.unit.into(),
                (100.0 * named.weight).into(),
                (100.0 * named.alone).into(),
                same.join(" ").as_str().into(),
            ]);
        }
    }
    Table::new("sources", "Errors that explain the measured flanks", columns).with_rows(rows).in_file("sources")
}

/// A row for each measured place.
fn residuals(points: &[MeasuredPoint], model: &ErrorModel, found: &Diagnosis) -> Table {
    let columns = vec![
        TableColumn::new("tooth", "1", "tooth, from 1"),
        TableColumn::words("flank", "left or right"),
        TableColumn::new("u", "mm", "arc along the profile from the form point"),
        TableColumn::new("v", "mm", "place along the tooth from the middle of the face"),
        TableColumn::new("measured", "um", "measured normal deviation"),
        TableColumn::new("predicted", "um", "predicted: that of the scene's own gear"),
        TableColumn::new("residual", "um", "fitted: measured less that of the gear with the fitted errors, turned"),
    ];
    let rows = points.iter().zip(&model.before_um).zip(&found.residuals_um).map(|((point, before), residual)| {
        vec![
            point.tooth.into(),
            point.side.name().into(),
            point.u_mm.into(),
            point.v_mm.into(),
            point.deviation_um.into(),
            (*before).into(),
            (*residual).into(),
        ]
    });
    Table::new("residuals", "What is left over", columns).with_rows(rows).rows_in_file("residuals")
}

/// Size and interval in words.
pub(super) fn sized(fitted: Option<FittedSize>, unit: &str) -> String {
    let words = |FittedSize { size, interval: [low, high], .. }| format!("{size:.2} ({low:.2} to {high:.2}) {unit}");
    fitted.map_or_else(|| "no size of its own".to_owned(), words)
}

/// For the terminal: what is named, and the headline.
pub fn sheet(model: &ErrorModel, found: &Diagnosis, tree: &Findings, sheet: &mut Sheet) {
    for entry in &tree.headline {
        summary::line(sheet, &entry.title, &summary::shown(&entry.quantity));
    }
    if found.named.is_empty() {
        return;
    }
    sheet.heading("Fitted, with 95 % intervals");
    let rows = |named: &NamedSource| {
        let source = &model.sources[named.source];
        let cells = |(parameter, fitted): (&crate::scene::error_parameters::ErrorParameter, &Option<FittedSize>)| {
            let apart = if named.same_as.is_empty() { String::new() } else { "not told apart".to_owned() };
            vec![parameter.title.clone(), sized(*fitted, parameter.unit), apart]
        };
        source.parameters.iter().zip(&named.fitted).map(cells).collect::<Vec<_>>()
    };
    sheet.table(&found.named.iter().flat_map(rows).collect::<Vec<_>>());
}

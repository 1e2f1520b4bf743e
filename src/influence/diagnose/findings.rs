//! A diagnosis as findings, and for the terminal.

use super::{Diagnosis, ErrorModel, FittedSize, NamedSource, StandingShape};
use crate::findings::{Datum, Entry, Findings, Notice, Quantity, Section, Table, TableColumn};
use crate::influence::measured::MeasuredPoint;
use crate::influence::notices::{
    DiagnosisStopped, DiagnosisUnexplained, DiagnosisUnsettled, Hidden, NoOwnSize, SameAs, StandsOut, StepRefused,
    Unsayable,
};
use crate::output::summary;
use crate::output::text::{Sheet, significant};
use crate::scene::Scene;

/// What stands behind every fitted number.
const FITTED: &str = "fitted";
/// Why there is no interval.
const NO_INTERVAL: &str = "no interval holds while deviations are left that neither noise nor an error explains";
/// Why a parameter has no size.
const NO_SIZE: &str = "other errors say all of it";
/// Why a parameter has no interval.
const NO_SIZE_OR_INTERVAL: &str = "other errors say all of it, or no interval holds: deviations are left that neither \
                                   noise nor an error explains";

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
    let turn_end = |of: fn(FittedSize) -> f64, what| {
        if found.intervals_hold() { turn(of, what) } else { Quantity::number_or(None, "arcsec", what, NO_INTERVAL) }
    };
    let section = Section::new("diagnosis", "Diagnosis")
        .with("points", Quantity::count(points.len() as u64, "places", "measured places"))
        .with("noise", Quantity::number(noise_um, "um", "stated standard deviation of every measured value"))
        .with("turn", {
            let what = "fitted: how far the gear stood turned on the measuring machine, counter-clockwise";
            turn(|turn| turn.size, what)
        })
        .with("turn_low", turn_end(|turn| turn.interval[0], "fitted: lower end of its 95 % interval"))
        .with("turn_high", turn_end(|turn| turn.interval[1], "fitted: upper end of its 95 % interval"))
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
    let section = if model.standing_out.is_empty() { section } else { section.table(standing_out(model, found)) };
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

fn warnings(model: &ErrorModel, found: &Diagnosis) -> Vec<Notice> {
    let names = |sources: &[usize]| sources.iter().map(|&source| title(model, source)).collect::<Vec<_>>().join("; ");
    let outstanding = found.standing_words(model).into_iter();
    let mut warnings: Vec<Notice> = outstanding.map(|what| StandsOut { what }.notice()).collect();
    if !model.complete {
        warnings.push(DiagnosisStopped { errors: model.sources.len(), rounds: found.rounds }.notice());
    } else if !found.settled {
        warnings.push(DiagnosisUnsettled {}.notice());
    }
    if found.unexplained_um > 0.0 {
        warnings.push(DiagnosisUnexplained { left_um: significant(found.unexplained_um, 3) }.notice());
    }
    for named in &found.named {
        let source = title(model, named.source);
        if !named.same_as.is_empty() {
            warnings.push(SameAs { source: &source, others: names(&named.same_as) }.notice());
        }
        if named.fitted.contains(&None) {
            warnings.push(NoOwnSize { source }.notice());
        }
    }
    if !found.hidden.is_empty() {
        warnings.push(Hidden { sources: names(&found.hidden) }.notice());
    }
    if !found.unsayable.is_empty() {
        warnings.push(Unsayable { sources: names(&found.unsayable) }.notice());
    }
    let refused = model.refused.iter().map(|(parameter, why)| StepRefused { parameter: &parameter.id, why }.notice());
    warnings.extend(refused);
    warnings
}

/// A row for each thing that stands out.
fn standing_out(model: &ErrorModel, found: &Diagnosis) -> Table {
    let columns = vec![
        TableColumn::words("shape", "what stands out: a tooth, bent profiles, a step along the face"),
        TableColumn::words("kind", "fitted: beside the errors of the machine"),
        TableColumn::new("left", "um", "its size on left flanks: normal deviation, crown or rise").or(NO_SIZE),
        TableColumn::new("right", "um", "its size on right flanks").or(NO_SIZE),
    ];
    let rows = found
        .standing_out(model)
        .map(|(shape, um)| vec![shape.title().as_str().into(), FITTED.into(), Datum::from(um[0]), Datum::from(um[1])]);
    Table::new("standing_out", "What stands out of the gear", columns).with_rows(rows).in_file("standing_out")
}

impl Diagnosis {
    /// Whether intervals hold: nothing but noise is left.
    pub fn intervals_hold(&self) -> bool {
        self.unexplained_um == 0.0
    }

    /// What stands out, with its sizes on left and right flanks, um.
    fn standing_out<'a>(
        &'a self,
        model: &'a ErrorModel,
    ) -> impl Iterator<Item = (StandingShape, [Option<f64>; 2])> + 'a {
        let sizes = self.standing_out_um.chunks_exact(2);
        let um = |sizes: &[Option<FittedSize>]| [0, 1].map(|i| sizes[i].map(|fitted| fitted.size));
        model.standing_out.iter().zip(sizes).map(move |(of, sizes)| (of.shape, um(sizes)))
    }

    /// What stands out in sentences; single teeth in one of them.
    fn standing_words(&self, model: &ErrorModel) -> Vec<String> {
        let larger = |um: [Option<f64>; 2]| {
            um.into_iter().flatten().fold(0.0, |most: f64, um| if um.abs() > most.abs() { um } else { most })
        };
        let on_sides = |um: [Option<f64>; 2]| {
            let side = |um: Option<f64>, name| um.map(|um| format!("{um:.1} um on {name} flanks"));
            [side(um[0], "left"), side(um[1], "right")].into_iter().flatten().collect::<Vec<_>>().join(", ")
        };
        let (mut teeth, mut others) = (Vec::new(), Vec::new());
        for (shape, um) in self.standing_out(model) {
            match shape {
                StandingShape::Tooth(tooth) => teeth.push((tooth, larger(um).abs())),
                StandingShape::Profile(_) => {
                    let bent = if larger(um) < 0.0 { "hollow" } else { "crowned" };
                    others.push(format!("{}: {}", shape.title().replace("bent", bent), on_sides(um)));
                }
                StandingShape::Step(..) => others.push(format!("{}: {}", shape.title(), on_sides(um))),
            }
        }
        let single = match &teeth[..] {
            [] => None,
            [(tooth, um)] => Some(format!("tooth {tooth} stands out by {um:.1} um")),
            _ => {
                let list = |words: Vec<String>| match words.split_last() {
                    Some((last, others)) => format!("{} and {last}", others.join(", ")),
                    None => String::new(),
                };
                let names = list(teeth.iter().map(|(tooth, _)| tooth.to_string()).collect());
                let sizes = list(teeth.iter().map(|(_, um)| format!("{um:.1}")).collect());
                Some(format!("teeth {names} stand out by {sizes} um"))
            }
        };
        single.into_iter().chain(others).collect()
    }
}

/// A row for each fitted parameter.
fn sources(model: &ErrorModel, found: &Diagnosis) -> Table {
    let low = "lower end of its 95 % interval, over all sets of sources that explain the deviations about as well";
    let holds = found.intervals_hold();
    let alone = "half the width of the 95 % interval if exactly the named sources are there";
    let sure = "weight of the sets of sources with this one, of all that explain the deviations about as well";
    let columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("error", "what it is"),
        TableColumn::words("kind", "fitted: a number that was chosen so that it explains the measured values"),
        TableColumn::by_row("size", "size, beyond that of the scene").or(NO_SIZE),
        TableColumn::by_row("low", low).or(NO_SIZE_OR_INTERVAL),
        TableColumn::by_row("high", "upper end of that interval").or(NO_SIZE_OR_INTERVAL),
        TableColumn::by_row("half_if_right", alone).or(NO_SIZE_OR_INTERVAL),
        TableColumn::words("unit", "unit of sizes and intervals"),
        TableColumn::new("sure", "%", sure).or(NO_INTERVAL),
        TableColumn::new("alone", "%", "share of the squared deviations that no other named source explains"),
        TableColumn::words("same_as", "sources that would explain as much in its place"),
    ];
    let mut rows = Vec::new();
    for named in &found.named {
        let source = &model.sources[named.source];
        for (parameter, fitted) in source.parameters.iter().zip(&named.fitted) {
            let with_interval = fitted.filter(|_| holds);
            let same: Vec<&str> = named.same_as.iter().map(|&other| model.sources[other].key.as_str()).collect();
            rows.push(vec![
                parameter.id.as_str().into(),
                parameter.title.as_str().into(),
                FITTED.into(),
                Datum::from(fitted.map(|fitted| fitted.size)),
                Datum::from(with_interval.map(|fitted| fitted.interval[0])),
                Datum::from(with_interval.map(|fitted| fitted.interval[1])),
                Datum::from(with_interval.map(|fitted| fitted.half_if_right)),
                parameter.unit.into(),
                Datum::from(holds.then_some(100.0 * named.weight)),
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

/// Size in words, with its interval where that holds.
pub(super) fn sized(found: &Diagnosis, fitted: Option<FittedSize>, unit: &str) -> String {
    let words = |FittedSize { size, interval: [low, high], .. }| {
        if found.intervals_hold() {
            format!("{size:.2} ({low:.2} to {high:.2}) {unit}")
        } else {
            format!("{size:.2} {unit}, no interval holds")
        }
    };
    fitted.map_or_else(|| "no size of its own".to_owned(), words)
}

/// For the terminal: what stands out, the headline, and what is named.
pub fn sheet(model: &ErrorModel, found: &Diagnosis, tree: &Findings, sheet: &mut Sheet) {
    for what in found.standing_words(model) {
        sheet.words(&StandsOut { what }.notice().text);
    }
    for entry in &tree.headline {
        summary::line(sheet, &entry.title, &summary::shown(&entry.quantity));
    }
    if found.named.is_empty() {
        return;
    }
    sheet.heading(if found.intervals_hold() { "Fitted, with 95 % intervals" } else { "Fitted, deviations are left" });
    let rows = |named: &NamedSource| {
        let source = &model.sources[named.source];
        let cells = |(parameter, fitted): (&crate::scene::error_parameters::ErrorParameter, &Option<FittedSize>)| {
            let apart = if named.same_as.is_empty() { String::new() } else { "not told apart".to_owned() };
            vec![parameter.title.clone(), sized(found, *fitted, parameter.unit), apart]
        };
        source.parameters.iter().zip(&named.fitted).map(cells).collect::<Vec<_>>()
    };
    sheet.table(&found.named.iter().flat_map(rows).collect::<Vec<_>>());
}

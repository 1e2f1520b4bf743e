//! A diagnosis as findings, and for the terminal.

use super::{Diagnosis, ErrorModel, FittedSize, NamedSource, Noise, StandingShape};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Findings, Notice, QuantityRow, Table};
use crate::influence::measured::MeasuredPoint;
use crate::influence::notices::{
    DiagnosisStopped, DiagnosisUnexplained, DiagnosisUnsettled, Hidden, NoOwnSize, SameAs, StandsOut, StepRefused,
    Unsayable,
};
use crate::influence::quantities::budget::{U, V};
use crate::influence::quantities::diagnosis::{
    ALONE, AXES_NOISE, BENT, CHANCE, DIAGNOSIS, EXPLAINED, FREEDOM, HALF_IF_RIGHT, HIGH, KIND_OF_SHAPE, LEFT, LOW,
    MEASURED, NAMED, NO_INTERVAL, NO_TURN, NOISE, NOTHING_DEVIATES, OF_SCENE, ON_LEFT, ON_RIGHT, POINTS, RESIDUAL,
    RESIDUALS, ROUNDS, SAME_AS, SHAPE, SIZE, SOURCES, STANDING_OUT, SURE, TURN, TURN_HIGH, TURN_LOW, UNEXPLAINED,
};
use crate::influence::quantities::{ERROR, KIND, PARAMETER, UNIT};
use crate::number_text::{significant, to_width};
use crate::output::summary;
use crate::output::text::Sheet;
use crate::scene::Scene;

/// From this weight on a source is named without a word of doubt.
const WITHOUT_DOUBT: f64 = 0.95;
/// What every fitted number is.
const FITTED: &str = "fitted";

/// The tree.
pub fn findings(
    scene: &Scene,
    model: &ErrorModel,
    points: &[MeasuredPoint],
    noise: &Noise,
    found: &Diagnosis,
) -> Findings {
    let headline = [
        NAMED.of(found.named.len()),
        EXPLAINED.of_or(found.explained.map(|share| 100.0 * share), NOTHING_DEVIATES),
        RESIDUAL.of(found.residual_um),
        UNEXPLAINED.of(found.unexplained_um),
    ];
    let turn = |row: &QuantityRow, of: fn(FittedSize) -> f64| row.of_or(found.turn_arcsec.map(of), NO_TURN);
    let turn_end = |row: &QuantityRow, of: fn(FittedSize) -> f64| {
        if found.intervals_hold() { turn(row, of) } else { row.none(NO_INTERVAL) }
    };
    let section = DIAGNOSIS
        .section([
            POINTS.of(points.len()),
            NOISE.of(noise.value_um),
            AXES_NOISE.of(noise.axes_um()),
            turn(&TURN, |turn| turn.size),
            turn_end(&TURN_LOW, |turn| turn.interval[0]),
            turn_end(&TURN_HIGH, |turn| turn.interval[1]),
            FREEDOM.of(found.freedom),
            CHANCE.of(found.chance),
            ROUNDS.of(found.rounds),
            BENT.of(found.bent),
        ])
        .table(sources(model, found))
        .table(residuals(points, model, found));
    let section = if model.standing_out.is_empty() { section } else { section.table(standing_out(model, found)) };
    Findings::new(scene.process_name(), &scene.name, model.complete, headline, warnings(model, found), vec![section])
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
    STANDING_OUT
        .table(found.standing_out(model))
        .column(&SHAPE, |(shape, _)| shape.title())
        .column(&KIND_OF_SHAPE, |_| FITTED)
        .column(&ON_LEFT, |(_, um)| um[0])
        .column(&ON_RIGHT, |(_, um)| um[1])
        .in_file("standing_out")
}

impl Diagnosis {
    /// Whether intervals hold: nothing but noise is left, and the fit has settled.
    pub fn intervals_hold(&self) -> bool {
        self.unexplained_um == 0.0 && self.settled
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
    let holds = found.intervals_hold();
    let rows = found.named.iter().flat_map(|named| {
        let parameters = model.sources[named.source].parameters.iter();
        parameters.zip(&named.fitted).map(move |(parameter, fitted)| (named, parameter, *fitted))
    });
    let of_interval = |fitted: &Option<FittedSize>, of: fn(FittedSize) -> f64| fitted.filter(|_| holds).map(of);
    let same_as = |named: &NamedSource| {
        let keys: Vec<&str> = named.same_as.iter().map(|&other| model.sources[other].key.as_str()).collect();
        keys.join(" ")
    };
    SOURCES
        .table(rows)
        .column(&PARAMETER, |(_, parameter, _)| parameter.id.as_str())
        .column(&ERROR, |(_, parameter, _)| parameter.title.as_str())
        .column(&KIND, |_| FITTED)
        .column(&SIZE, |(.., fitted)| fitted.map(|fitted| fitted.size))
        .column(&LOW, |(.., fitted)| of_interval(fitted, |of| of.interval[0]))
        .column(&HIGH, |(.., fitted)| of_interval(fitted, |of| of.interval[1]))
        .column(&HALF_IF_RIGHT, |(.., fitted)| of_interval(fitted, |of| of.half_if_right))
        .column(&UNIT, |(_, parameter, _)| parameter.unit)
        .column(&SURE, |(named, ..)| holds.then_some(100.0 * named.weight))
        .column(&ALONE, |(named, ..)| 100.0 * named.alone)
        .column(&SAME_AS, |(named, ..)| same_as(named))
        .in_file("sources")
}

/// A row for each measured place.
fn residuals(points: &[MeasuredPoint], model: &ErrorModel, found: &Diagnosis) -> Table {
    RESIDUALS
        .table(points.iter().zip(&model.before_um).zip(&found.residuals_um))
        .column(&TOOTH, |((point, _), _)| point.tooth)
        .column(&FLANK, |((point, _), _)| point.side.name())
        .column(&U, |((point, _), _)| point.u_mm)
        .column(&V, |((point, _), _)| point.v_mm)
        .column(&MEASURED, |((point, _), _)| point.deviation_um)
        .column(&OF_SCENE, |((_, before), _)| **before)
        .column(&LEFT, |(_, residual)| **residual)
        .rows_in_file("residuals")
}

/// Size in words, with its interval where that holds.
pub(super) fn sized(found: &Diagnosis, fitted: Option<FittedSize>, unit: &str) -> String {
    let words = |FittedSize { size, interval: [low, high], half_if_right }| {
        if found.intervals_hold() {
            let [size, low, high] = [size, low, high].map(|value| to_width(value, high - low));
            format!("{size} ({low} to {high}) {unit}")
        } else {
            format!("{} {unit}, no interval holds", to_width(size, 2.0 * half_if_right))
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
    sheet.heading(if found.intervals_hold() { "Fitted, with 95 % intervals" } else { "Fitted, no interval holds" });
    let rows = |named: &NamedSource| {
        let source = &model.sources[named.source];
        let cells = |(parameter, fitted): (&crate::scene::error_parameters::ErrorParameter, &Option<FittedSize>)| {
            let doubt = found.intervals_hold() && named.weight < WITHOUT_DOUBT;
            let sure = doubt.then(|| format!("{:.0} % sure", 100.0 * named.weight));
            let another = (!named.same_as.is_empty()).then(|| "or another".to_owned());
            let words = [sure, another].into_iter().flatten().collect::<Vec<_>>().join(", ");
            vec![parameter.title.clone(), sized(found, *fitted, parameter.unit), words]
        };
        source.parameters.iter().zip(&named.fitted).map(cells).collect::<Vec<_>>()
    };
    sheet.table(&found.named.iter().flat_map(rows).collect::<Vec<_>>());
}

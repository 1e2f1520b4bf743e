//! QIF: points of flanks as features and, of a cut gear, as results, in one document of QIF 3.0 (ISO 23952:2020).
//!
//! In: [`FlankPoints`]. Out: the text of a `QIFDocument`. A flank is a point-defined surface, all of one definition:
//!
//! - Its nominal has the points that define it and refers to a set of nominal points with their normals, which point
//!   out of the material.
//! - Its item has its name; tooth and flank are attributes of both.
//! - As cut, its measurement refers to a set of measured points with the same normals, the deviations along them and
//!   the ids of the nominal points they belong to. The results say that a simulation gave them; they are not judged.
//!
//! The document's own id is a UUID of version 8 (RFC 9562) from the SHA-256 of its text: the same scene gives the same
//! bytes.
//!
//! Roads not taken: a point feature with a point profile for each place, and a surface profile for each flank. Both
//! characteristics must have a tolerance, and a scene has none for the normal deviation of single points.

use super::points::{FlankPoints, direction, shown};
use super::step::frame_words;
use super::unit::FileUnit;
use crate::job::GearJob;
use gearcut_core::error::Refusal;
use maud::{Markup, html};
use sha2::{Digest, Sha256};

/// Namespace and version of the schema.
const SCHEMA: [&str; 2] = ["http://qifstandards.org/xsd/qif3", "3.0.0"];
/// Points that a document may have: as cut, a hundred megabytes.
const MOST_POINTS: usize = 250_000;
/// Id of the gear's frame.
const FRAME: usize = 1;
/// Id of the definition of all flanks.
const DEFINITION: usize = 2;
/// Id of the results.
const RESULTS: usize = 3;

/// Points that a document of a reasonable size has no room for.
///
/// # Errors
/// There are more than [`MOST_POINTS`].
pub fn refuse_many(points: usize) -> Result<(), Refusal> {
    if points <= MOST_POINTS {
        return Ok(());
    }
    let problem = format!("{points} points are more than the {MOST_POINTS} that a QIF document has room for");
    Err(Refusal::new("--qif", problem, "take fewer with --teeth or --grid, or write a table with --points"))
}

/// The document; `grid` is places along the profile and along the tooth.
pub fn qif(gear: &dyn GearJob, flanks: &[FlankPoints], grid: [usize; 2], unit: FileUnit) -> String {
    let numbered = FlankIds::of(flanks);
    let is_cut = flanks.iter().any(|flank| flank.heights_mm.is_some());
    let body = html! {
        (header(gear, is_cut)) "\n"
        (units(unit)) "\n"
        (frame()) "\n"
        (features(&numbered, grid, unit)) "\n"
        @if is_cut { (results(&numbered, unit)) "\n" }
    }
    .into_string();
    let id_max = numbered.last().map_or(RESULTS, |(ids, _)| ids.next() - 1);
    let [namespace, version] = SCHEMA;
    let id = document_id(&body);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <QIFDocument xmlns=\"{namespace}\" versionQIF=\"{version}\" idMax=\"{id_max}\">\n\
         <QPId>{id}</QPId>\n{body}</QIFDocument>\n"
    )
}

/// Ids of a flank: five of its own, one of each measuring point, one of each defining point.
#[derive(Clone, Copy)]
struct FlankIds {
    first: usize,
    places: usize,
}

impl FlankIds {
    fn of(flanks: &[FlankPoints]) -> Vec<(Self, &FlankPoints)> {
        let mut first = RESULTS + 1;
        let ids = |flank: &FlankPoints| {
            let ids = Self { first, places: flank.target.len() };
            first = ids.next();
            ids
        };
        flanks.iter().map(ids).zip(flanks).collect()
    }

    fn nominal(self) -> usize {
        self.first
    }

    fn item(self) -> usize {
        self.first + 1
    }

    fn nominal_points(self) -> usize {
        self.first + 2
    }

    fn measurement(self) -> usize {
        self.first + 3
    }

    fn measured_points(self) -> usize {
        self.first + 4
    }

    fn measuring_point(self, place: usize) -> usize {
        self.first + 5 + place
    }

    fn defining_point(self, place: usize) -> usize {
        self.measuring_point(self.places + place)
    }

    /// The first id of the next flank.
    fn next(self) -> usize {
        self.measuring_point(2 * self.places)
    }
}

fn header(gear: &dyn GearJob, is_cut: bool) -> Markup {
    let name = &gear.scene().name;
    let (what, scope) = if is_cut {
        ("flanks of a simulated cut against their targets", "Results")
    } else {
        ("targets of flanks", "Features")
    };
    html! {
        Header {
            Application { Name { "gearcut " (env!("CARGO_PKG_VERSION")) } }
            Description { (name) ": " (what) "; " (frame_words(gear)) }
            Scope { (scope) }
        }
    }
}

fn units(unit: FileUnit) -> Markup {
    let metres = match unit {
        FileUnit::Millimetre => "0.001",
        FileUnit::Inch => "0.0254",
    };
    html! {
        FileUnits {
            PrimaryUnits {
                AngularUnit { SIUnitName { "radian" } UnitName { "radian" } }
                LinearUnit {
                    SIUnitName { "meter" }
                    UnitName { (unit.word()) }
                    UnitConversion { Factor { (metres) } }
                }
            }
        }
    }
}

fn frame() -> Markup {
    html! {
        CoordinateSystems {
            CoordinateSystemDefinitions n="1" { CoordinateSystem id=(FRAME) { Name { "gear" } } }
            CommonCoordinateSystemId { (FRAME) }
        }
    }
}

fn features(numbered: &[(FlankIds, &FlankPoints)], grid: [usize; 2], unit: FileUnit) -> Markup {
    html! {
        Features {
            "\n" FeatureDefinitions n="1" { PointDefinedSurfaceFeatureDefinition id=(DEFINITION) {} }
            "\n" FeatureNominals n=(numbered.len()) {
                @for (ids, flank) in numbered { "\n" (nominal(*ids, flank, grid, unit)) }
            }
            "\n" FeatureItems n=(numbered.len()) {
                @for (ids, flank) in numbered { "\n" (item(*ids, flank)) }
            }
            "\n" NominalPointSets n=(numbered.len()) {
                @for (ids, flank) in numbered { "\n" (nominal_points(*ids, flank, unit)) }
            }
        }
    }
}

fn nominal(ids: FlankIds, flank: &FlankPoints, [profile, lead]: [usize; 2], unit: FileUnit) -> Markup {
    html! {
        PointDefinedSurfaceFeatureNominal id=(ids.nominal()) {
            Attributes n="3" {
                (tooth_and_side(flank))
                AttributeI2 name="places along profile and tooth" value={ (profile) " " (lead) } {}
            }
            Name { (name(flank)) }
            FeatureDefinitionId { (DEFINITION) }
            PointList n="1" { WholePointSetId { (ids.nominal_points()) } }
            DefiningPoints n=(ids.places) {
                @for (place, ray) in flank.target.iter().enumerate() {
                    "\n" DefiningPoint id=(ids.defining_point(place)) {
                        Point { (shown(ray.origin_mm, unit).join(" ")) }
                        SequenceNumber { (place + 1) }
                    }
                }
            }
        }
    }
}

fn item(ids: FlankIds, flank: &FlankPoints) -> Markup {
    html! {
        PointDefinedSurfaceFeatureItem id=(ids.item()) {
            Attributes n="2" { (tooth_and_side(flank)) }
            FeatureNominalId { (ids.nominal()) }
            FeatureName { (name(flank)) }
            DeterminationMode { Checked {} }
        }
    }
}

fn nominal_points(ids: FlankIds, flank: &FlankPoints, unit: FileUnit) -> Markup {
    html! {
        NominalPointSet n=(ids.places) id=(ids.nominal_points()) {
            @for (place, ray) in flank.target.iter().enumerate() {
                "\n" MeasurePoint id=(ids.measuring_point(place)) {
                    Point { (shown(ray.origin_mm, unit).join(" ")) }
                    Normal { (direction(ray.normal).join(" ")) }
                }
            }
        }
    }
}

fn results(numbered: &[(FlankIds, &FlankPoints)], unit: FileUnit) -> Markup {
    html! {
        Results {
            MeasurementResultsSet n="1" {
                MeasurementResults id=(RESULTS) {
                    Attributes n="1" { AttributeStr name="source" value="simulation" {} }
                    "\n" MeasuredFeatures n=(numbered.len()) {
                        @for (ids, _) in numbered { "\n" (measurement(*ids)) }
                    }
                    "\n" MeasuredPointSets n=(numbered.len()) {
                        @for (ids, flank) in numbered { "\n" (measured_points(*ids, flank, unit)) }
                    }
                    "\n" InspectionStatus { InspectionStatusEnum { "NOT_CALCULATED" } }
                }
            }
        }
    }
}

fn measurement(ids: FlankIds) -> Markup {
    html! {
        PointDefinedSurfaceFeatureMeasurement id=(ids.measurement()) {
            FeatureItemId { (ids.item()) }
            PointList n="1" { WholePointSetId { (ids.measured_points()) } }
        }
    }
}

fn measured_points(ids: FlankIds, flank: &FlankPoints, unit: FileUnit) -> Markup {
    html! {
        MeasuredPointSet count=(ids.places) id=(ids.measured_points()) {
            "\n" Points { @for point_mm in flank.points_mm() { (shown(point_mm, unit).join(" ")) "\n" } }
            "\n" Normals { @for ray in &flank.target { (direction(ray.normal).join(" ")) "\n" } }
            "\n" Compensated { "true" }
            "\n" MeasurePointNominalIds n=(ids.places) {
                Ids { @for place in 0..ids.places { (ids.measuring_point(place)) " " } }
            }
            "\n" Deviations { @for height_mm in flank.heights_mm.iter().flatten() { (unit.shown(*height_mm)) " " } }
        }
    }
}

fn tooth_and_side(flank: &FlankPoints) -> Markup {
    html! {
        AttributeI1 name="tooth" value=(flank.tooth) {}
        AttributeStr name="flank" value=(flank.side.name()) {}
    }
}

fn name(flank: &FlankPoints) -> String {
    format!("tooth {} {}", flank.tooth, flank.side.name())
}

/// A UUID of version 8 and variant 10 whose other bits are the first of the text's SHA-256.
fn document_id(text: &str) -> String {
    let hash = Sha256::digest(text);
    let bits = hash.iter().take(16).fold(0, |bits: u128, &byte| bits << 8 | u128::from(byte));
    let bits = bits & !(0xf << 76 | 0b11 << 62) | 8 << 76 | 0b10 << 62;
    let hex = format!("{bits:032x}");
    [0..8, 8..12, 12..16, 16..20, 20..32].map(|part| &hex[part]).join("-")
}

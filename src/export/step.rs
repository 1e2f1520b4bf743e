//! STEP: a solid or surfaces as a file of ISO 10303-21 after AP214 (`AUTOMOTIVE_DESIGN`), in mm.
//!
//! In: a [`GearSolid`], or [`FlankFaces`] of a gear that has none. Out: the text of the file: one `MANIFOLD_SOLID_BREP`
//! whose shell is closed ([`solid`]), or one `SHELL_BASED_SURFACE_MODEL` with a shell for each flank ([`flanks`]).
//!
//! The accuracy in the head is what readers join edges by: the tolerance, and at most [`LARGEST_ACCURACY_MM`], so that
//! no tip land of a coarse file is taken for a point.
//!
//! Road not taken: the crate `truck-stepio` (0.3.0). It writes the topology of its own modelling kernel, five crates
//! more, and puts the time into each file: the same scene would no longer give the same bytes.

use super::b_spline::{CubicKnots, DEGREE};
use super::drawing::zero_words;
use super::section::{ProfileSource, SectionWish};
use super::unit::fixed;
use crate::job::GearJob;
use crate::number_text::plain;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use std::fmt::Write as _;

pub mod flanks;
pub mod solid;

#[cfg(doc)]
use super::{flank_faces::FlankFaces, solid::GearSolid};

/// Digits of lengths in mm and of knots.
const DIGITS: [usize; 2] = [9, 12];
/// Accuracy that the head says at most, mm.
const LARGEST_ACCURACY_MM: f64 = 1e-3;

/// What is said of the solid.
#[derive(Debug, Clone, PartialEq)]
pub struct StepWords {
    /// Name of the product.
    pub name: String,
    /// Lines of the description in the head.
    pub notes: Vec<String>,
    /// The tolerance of the faces, mm.
    pub tolerance_mm: f64,
}

impl StepWords {
    /// What is said of a gear: as a solid if it is cylindrical, else of its flanks.
    pub fn new(gear: &dyn GearJob, wish: &SectionWish) -> Self {
        let name = gear.scene().name.clone();
        let is_solid = gear.cylindrical().is_some();
        let what = match wish.source {
            ProfileSource::Target => "target: the envelope of the finishing operation".to_owned(),
            ProfileSource::Cut if is_solid && gear.scene().gear.helix_angle_rad == 0.0 => {
                format!("as cut {} mm from the middle of the face, swept straight", plain(wish.z_mm))
            }
            ProfileSource::Cut => "as cut".to_owned(),
        };
        let of = if is_solid { "profile" } else { "flanks" };
        let within = format!("faces are within {} um of the {of}", plain(wish.tolerance_mm * UM_PER_MM));
        let notes = vec![format!("{name}: {what}"), within, frame_words(gear)];
        Self { name, notes, tolerance_mm: wish.tolerance_mm }
    }
}

/// The frame of exported points and faces.
pub fn frame_words(gear: &dyn GearJob) -> String {
    match gear.cylindrical() {
        Some(gear) => format!("gear frame: axis along z, z = 0 in the middle of the face, {}", zero_words(gear)),
        None => "gear frame: axis along z, the apex of the pitch cone at the origin, the back below it, a tooth space \
                 on the x axis"
            .to_owned(),
    }
}

/// A file and how many faces its solid has.
#[derive(Debug, Clone, PartialEq)]
pub struct StepFile {
    /// Its text.
    pub text: String,
    /// Faces.
    pub faces: usize,
}

/// Number of an instance.
type InstanceId = usize;

/// Edges in the order of a loop, each with whether it is run through from its start.
type EdgeLoop = Vec<(InstanceId, bool)>;

/// Instances of the data section.
#[derive(Default)]
struct InstanceWriter {
    text: String,
    count: usize,
    faces: Vec<InstanceId>,
}

/// A loop, or the same backwards.
fn oriented(mut edges: EdgeLoop, is_forward: bool) -> EdgeLoop {
    if !is_forward {
        edges.reverse();
        for (_, sense) in &mut edges {
            *sense = !*sense;
        }
    }
    edges
}

impl InstanceWriter {
    /// One more instance.
    fn add(&mut self, body: &str) -> InstanceId {
        self.count += 1;
        let _ = writeln!(self.text, "#{}={body};", self.count);
        self.count
    }

    fn point(&mut self, place_mm: DVec3) -> InstanceId {
        let numbers = place_mm.to_array().map(|mm| real(mm, DIGITS[0])).join(",");
        self.add(&format!("CARTESIAN_POINT('',({numbers}))"))
    }

    fn direction(&mut self, direction: DVec3) -> InstanceId {
        let numbers = direction.to_array().map(|part| real(part, DIGITS[0])).join(",");
        self.add(&format!("DIRECTION('',({numbers}))"))
    }

    /// Axes with their origin at a place, z along `up`, x as in the gear.
    fn placement(&mut self, place_mm: DVec3, up: DVec3) -> InstanceId {
        let (place, up, x) = (self.point(place_mm), self.direction(up), self.direction(DVec3::X));
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{place},#{up},#{x})"))
    }

    fn vertex(&mut self, point: InstanceId) -> InstanceId {
        self.add(&format!("VERTEX_POINT('',#{point})"))
    }

    fn edge(&mut self, [from, to]: [InstanceId; 2], curve: InstanceId) -> InstanceId {
        self.add(&format!("EDGE_CURVE('',#{from},#{to},#{curve},.T.)"))
    }

    fn curve(&mut self, knots: &CubicKnots, controls: &[InstanceId]) -> InstanceId {
        let [times, places] = multiplicities(knots);
        let controls = references(controls);
        self.add(&format!(
            "B_SPLINE_CURVE_WITH_KNOTS('',{DEGREE},{controls},.UNSPECIFIED.,.F.,.F.,{times},{places},.UNSPECIFIED.)"
        ))
    }

    fn face(&mut self, surface: InstanceId, is_forward: bool, loops: Vec<EdgeLoop>) {
        let mut bounds = Vec::new();
        for (i, edges) in loops.into_iter().enumerate() {
            let mut uses = Vec::new();
            for (edge, is_forward) in edges {
                uses.push(self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{})", logical(is_forward))));
            }
            let edges = self.add(&format!("EDGE_LOOP('',{})", references(&uses)));
            let kind = if i == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            bounds.push(self.add(&format!("{kind}('',#{edges},.T.)")));
        }
        let bounds = references(&bounds);
        let face = self.add(&format!("ADVANCED_FACE('',{bounds},#{surface},{})", logical(is_forward)));
        self.faces.push(face);
    }

    /// A surface through rows of control points, each along the profile.
    fn surface(&mut self, knots: [&CubicKnots; 2], rows: &[Vec<InstanceId>]) -> InstanceId {
        let column = |i: usize| references(&rows.iter().map(|row| row[i]).collect::<Vec<_>>());
        let columns = (0..rows[0].len()).map(column).collect::<Vec<_>>().join(",");
        let [[times_u, places_u], [times_v, places_v]] = knots.map(multiplicities);
        self.add(&format!(
            "B_SPLINE_SURFACE_WITH_KNOTS('',{DEGREE},{DEGREE},({columns}),.UNSPECIFIED.,.F.,.F.,.F.,\
             {times_u},{times_v},{places_u},{places_v},.UNSPECIFIED.)"
        ))
    }

    /// The representation of a shape in mm, and the product that has it.
    fn product(&mut self, words: &StepWords, kind: &str, shape: InstanceId) {
        let name = text(&words.name);
        let axes = self.placement(DVec3::ZERO, DVec3::Z);
        let mm = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let rad = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let sr = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let accuracy = real(words.tolerance_mm.min(LARGEST_ACCURACY_MM), DIGITS[0]);
        let accuracy = self.add(&format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({accuracy}),#{mm},'distance_accuracy_value','')"
        ));
        let context = self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{accuracy}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{mm},#{rad},#{sr}))REPRESENTATION_CONTEXT('',''))"
        ));
        let shape = self.add(&format!("{kind}({name},(#{axes},#{shape}),#{context})"));
        let application = self.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
        self.add(&format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{application})"
        ));
        let of = self.add(&format!("PRODUCT_CONTEXT('',#{application},'mechanical')"));
        let product = self.add(&format!("PRODUCT({name},{name},'',(#{of}))"));
        self.add(&format!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let of = self.add(&format!("PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"));
        let definition = self.add(&format!("PRODUCT_DEFINITION('design','',#{formation},#{of})"));
        let of = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{of},#{shape})"));
    }
}

/// Head, data, end.
fn whole(data: &str, words: &StepWords) -> String {
    let notes = words.notes.iter().map(|note| text(note)).collect::<Vec<_>>().join(",");
    let program = text(&format!("gearcut {}", env!("CARGO_PKG_VERSION")));
    let name = text(&words.name);
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(({notes}),'2;1');\n\
         FILE_NAME({name},'',(''),(''),{program},{program},'');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\nENDSEC;\nDATA;\n{data}ENDSEC;\n\
         END-ISO-10303-21;\n"
    )
}

/// How often each knot counts, and the knots.
fn multiplicities(knots: &CubicKnots) -> [String; 2] {
    let places = knots.places();
    let times = |i: usize| if i == 0 || i == places.len() - 1 { DEGREE + 1 } else { 1 };
    let list = |items: Vec<String>| format!("({})", items.join(","));
    [
        list((0..places.len()).map(|i| times(i).to_string()).collect()),
        list(places.iter().map(|&place| real(place, DIGITS[1])).collect()),
    ]
}

fn references(of: &[InstanceId]) -> String {
    format!("({})", of.iter().map(|id| format!("#{id}")).collect::<Vec<_>>().join(","))
}

fn logical(is_true: bool) -> &'static str {
    if is_true { ".T." } else { ".F." }
}

/// A number with a point, without zeros behind it.
fn real(value: f64, digits: usize) -> String {
    fixed(value, digits).trim_end_matches('0').to_owned()
}

/// A string: quotes and backslashes doubled, other characters than those of ASCII by their number.
fn text(of: &str) -> String {
    let one = |c: char| match c {
        '\'' | '\\' => format!("{c}{c}"),
        ' '..='~' => c.to_string(),
        c if c.is_control() => " ".to_owned(),
        c if u32::from(c) <= 0xFFFF => format!("\\X2\\{:04X}\\X0\\", u32::from(c)),
        c => format!("\\X4\\{:08X}\\X0\\", u32::from(c)),
    };
    format!("'{}'", of.chars().map(one).collect::<String>())
}

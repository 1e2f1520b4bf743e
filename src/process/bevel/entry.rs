//! The head where the first roll begins: in the blank, or clear of it.
//!
//! In: a job. Out: a notice where the head is in the blank, how far it would have to be withdrawn along the
//! cradle's axis, and a cradle angle at which the roll would begin clear. Places of the blank are tried, from root to
//! tip over the whole face and round the gear, against the ring in which all blades stay ([`HeadInSlot`]). Operations
//! after the first one find slots; a head that plunges begins clear by its course.

use super::job::BevelJob;
use super::notices::StartsInBlank;
use crate::findings::Notice;
use crate::number_text::significant;
use gearcut_core::bevel::clearance::HeadInSlot;
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::units::TURN_RAD;
use glam::DVec3;

/// Places from toe to heel and from root to tip.
const LAYERS: u32 = 9;
/// Places round the gear: closer together than a slot is wide.
const ROUND: u32 = 900;
/// Halvings of the way out.
const HALVINGS: u32 = 12;
/// Cradle angles that are tried before the beginning, in whole degrees.
const MOST_DEG: u32 = 60;

/// The head in the blank before the first feed.
pub(super) fn warning(job: &BevelJob) -> Option<Notice> {
    let first = job.operations.first()?;
    let settings = first.as_set;
    if settings.plunges() {
        return None;
    }
    let places_mm = places_mm(job);
    let is_clear = |settings: &CradleSettings, cradle_rad: f64| {
        let head = HeadInSlot::new(settings, [cradle_rad; 2], &job.head);
        places_mm.iter().all(|&place_mm| head.clears([place_mm; 2]))
    };
    let [from, to] = first.course.range;
    if is_clear(&settings, from) {
        return None;
    }
    let withdrawn = |by_mm: f64| CradleSettings { sliding_base_mm: settings.sliding_base_mm - by_mm, ..settings };
    let mut ends_mm = [0.0, job.head.blade_height_mm];
    for _ in 0..HALVINGS {
        let middle_mm = 0.5 * (ends_mm[0] + ends_mm[1]);
        ends_mm[usize::from(is_clear(&withdrawn(middle_mm), from))] = middle_mm;
    }
    let back = (from - to).signum();
    let earlier = (1..=MOST_DEG).map(|deg| from + back * f64::from(deg).to_radians());
    let way_out = match earlier.into_iter().find(|&cradle_rad| is_clear(&settings, cradle_rad)) {
        Some(clear_rad) => {
            let whole_deg = if back < 0.0 { clear_rad.to_degrees().floor() } else { clear_rad.to_degrees().ceil() };
            format!("begin clear of it, with operation.roll_from_deg = {whole_deg}")
        }
        None => "rough the slots before, or feed the head in".to_owned(),
    };
    let (operation, deep_mm) = (&first.spec.name, significant(ends_mm[1], 3));
    Some(StartsInBlank { operation, deep_mm, way_out }.notice())
}

/// Places of the blank, work frame.
fn places_mm(job: &BevelJob) -> Vec<DVec3> {
    let blank = &job.blank;
    let share = |index: u32| f64::from(index) / f64::from(LAYERS - 1);
    let layers = (0..LAYERS).flat_map(|row| (0..LAYERS).map(move |layer| (share(row), share(layer))));
    let outlines = layers.map(|(along, up)| {
        let distance_mm = blank.outer_cone_distance_mm - blank.face_width_mm * (1.0 - along);
        let [root_mm, tip_mm] = [-blank.dedendum_mm(distance_mm), blank.addendum_mm(distance_mm)];
        blank.axial_mm([distance_mm, root_mm + up * (tip_mm - root_mm)])
    });
    let round = |axial_mm: glam::DVec2| {
        (0..ROUND).map(move |index| {
            let (sin, cos) = (TURN_RAD * f64::from(index) / f64::from(ROUND)).sin_cos();
            DVec3::new(axial_mm.x, axial_mm.y * cos, axial_mm.y * sin)
        })
    };
    outlines.flat_map(round).collect()
}

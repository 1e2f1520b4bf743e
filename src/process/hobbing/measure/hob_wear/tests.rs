use super::*;

/// A hob with one thread.
fn thread(teeth: usize) -> [Range<usize>; 1] {
    let all = 0..teeth;
    [all]
}

fn at_tip(shares: &[f64]) -> OfPlaces {
    let of = |&share: &f64| {
        let mut places = [0.0; EDGE_PLACES];
        places[EDGE_PLACES / 2] = share;
        places
    };
    shares.iter().map(of).collect()
}

/// Ten teeth, the fifth of which takes a tenth of its life per gear and its neighbours half of that. Without shift ten
/// gears. By a tooth to the entering end there are five places: a tooth in the middle takes 0.05 + 0.1 + 0.05 of its
/// life in five gears, so five turns use it up. By two teeth there are three, and teeth take 0.1, or 0.05 + 0.05, in
/// three gears: ten turns.
#[test]
fn gears_with_a_shift_are_those_counted_by_hand() {
    let load = at_tip(&[0.0, 0.0, 0.0, 0.05, 0.1, 0.05, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(gears(&[&load]), 10);
    let found = shifts(&thread(10), &load, [9, 9]).expect("room at both ends");
    let of = |teeth: f64, then: ShiftReturn| found.iter().find(|s| s.teeth == teeth && s.then == then).copied();
    let one = of(1.0, ShiftReturn::Repeating).expect("one tooth");
    assert_eq!((one.places, one.gears), (5, 25));
    let two = of(2.0, ShiftReturn::Repeating).expect("two teeth");
    assert_eq!((two.places, two.gears), (3, 30));
    // There and back: the place in the middle comes twice in four gears. Five turns use it up; one gear more goes to
    // the first place.
    let back = of(2.0, ShiftReturn::Reciprocating).expect("two teeth");
    assert_eq!((back.places, back.gears), (3, 21));
    // To the leaving end there is room for three teeth.
    assert_eq!(of(-3.0, ShiftReturn::Repeating).map(|s| (s.places, s.gears)), Some((2, 20)));
    assert!(of(-4.0, ShiftReturn::Repeating).is_none());
    // Contact may leave less: two teeth to the entering end, none to the other.
    let least = shifts(&thread(10), &load, [2, 0]).expect("room at both ends");
    let farthest = least.iter().map(|shift| shift.teeth).fold(0.0, f64::max);
    assert!(farthest == 2.0 && least.iter().all(|shift| shift.teeth > 0.0));
}

/// The two threads of a hob do not lend each other teeth.
#[test]
fn threads_keep_to_themselves() {
    let load = at_tip(&[0.0, 0.1, 0.0, 0.0, 0.1, 0.0]);
    let moved = moved(&[0..3, 3..6], &load, 1.0);
    assert_eq!(moved, at_tip(&[0.0, 0.0, 0.1, 0.0, 0.0, 0.1]));
}

#[test]
fn a_load_at_the_end_of_the_hob_is_not_moved() {
    assert!(shifts(&thread(4), &at_tip(&[0.1, 0.1, 0.0, 0.0]), [9, 9]).is_none());
    assert!(shifts(&thread(4), &at_tip(&[0.0; 4]), [9, 9]).is_none());
}

/// Lives that no hob has do not run for ever.
#[test]
fn endless_lives_end() {
    assert_eq!(gears(&[&at_tip(&[1e-300])]), u64::MAX);
}

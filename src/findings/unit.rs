//! Units as they are written: plain in files, with signs on pages, and at the end of a name.
//!
//! In: a unit as a quantity states it, such as `um^2`, or the name of a coordinate, such as `work_angle_deg`. Out: the
//! same unit in the signs of a page, or name and unit apart. No value changes here: an angle is turned into degrees
//! where its quantity is made.

/// Units that end the names of coordinates.
const OF_COORDINATES: [&str; 3] = ["mm", "deg", "s"];

/// A unit in the signs of a page; none for a pure number.
pub fn signs(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => unit.replace("um", "µm").replace("deg", "°").replace("^2", "²").replace("^3", "³"),
    }
}

/// A number with its unit in the signs of a page; the sign of degrees follows its number at once.
pub fn with_signs(number: &str, unit: &str) -> String {
    let signs = signs(unit);
    let gap = if signs.is_empty() || signs == "°" { "" } else { " " };
    format!("{number}{gap}{signs}")
}

/// A sentence whose units are written as in files, in the signs of a page.
pub fn sentence_with_signs(text: &str) -> String {
    text.replace(" um", " µm").replace(" deg ", "° ").replace("^2", "²").replace("^3", "³")
}

/// Name and unit of a coordinate; the unit is empty where the name has none.
pub fn of_name(name: &str) -> (&str, &str) {
    let apart = |unit: &'static str| Some((name.strip_suffix(unit)?.strip_suffix('_')?, unit));
    OF_COORDINATES.into_iter().find_map(apart).unwrap_or((name, ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_write_signs() {
        assert_eq!(signs("deg/s^2"), "°/s²");
        assert_eq!(with_signs("2.00", "um^3/um^2"), "2.00 µm³/µm²");
        assert_eq!([with_signs("7", "deg"), with_signs("7", "1")], ["7°", "7"]);
        assert_eq!(sentence_with_signs("1 um at 3 deg of roll, 2 mm^2"), "1 µm at 3° of roll, 2 mm²");
    }

    #[test]
    fn names_end_with_their_unit() {
        assert_eq!(of_name("work_angle_deg"), ("work_angle", "deg"));
        assert_eq!(
            [of_name("u_mm"), of_name("teeth"), of_name("strokes")],
            [("u", "mm"), ("teeth", ""), ("strokes", "")]
        );
    }
}

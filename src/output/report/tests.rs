//! What a page must not do: run another's text, or ask for anything from elsewhere.

use super::*;
use crate::output::line_chart::LineChart;

const HOSTILE: &str = "</script><script>alert('x')</script><img src=x onerror=alert(1)>\"'&";

fn page() -> Page {
    let chart = |title: &str| LineChart {
        title: title.into(),
        x_name: title.into(),
        x_unit: title.into(),
        panels: vec![crate::output::line_chart::Panel {
            least_division: 0.0,
            value_name: title.into(),
            unit: title.into(),
            series: vec![crate::output::line_chart::LineSeries {
                name: title.into(),
                points: vec![(0.0, 0.0), (1.0, 1.0)],
            }],
            limits: vec![],
        }],
    };
    let axis = || crate::output::grid::MapAxis {
        name: HOSTILE.into(),
        meaning: HOSTILE.into(),
        start_mm: 0.0,
        step_mm: 1.0,
        count: 2,
    };
    Page {
        what: "cutting report",
        done: "all flanks cut",
        title: HOSTILE.into(),
        subtitle: HOSTILE.into(),
        operations: vec![HOSTILE.into()],
        complete: true,
        program: HOSTILE.into(),
        key_numbers: vec![KeyNumber {
            name: HOSTILE.into(),
            value: HOSTILE.into(),
            unit: HOSTILE.into(),
            definition: HOSTILE.into(),
            note: HOSTILE.into(),
            place: Some(Place::on_flank(1, HOSTILE, 1.0, -2.0)),
        }],
        warnings: vec![Notice::new("flank.made", Severity::Fault, HOSTILE)],
        viewer: Some(Viewer {
            flanks: vec![viewer::ViewerFlank {
                tooth: 1,
                side: HOSTILE.into(),
                grid: Some(crate::output::grid::MapGrid { u: axis(), v: axis() }),
                triangles: crate::surface::triangles::Triangles::default(),
                places_mm: vec![],
            }],
            quantities: vec![viewer::ViewerQuantity {
                name: HOSTILE.into(),
                definition: HOSTILE.into(),
                unit: HOSTILE.into(),
                scale: crate::colormap::ColourScale::Diverging { limit: 1.0 },
                thinning: viewer::Thinning::Mean,
                evaluated_mm: vec![[0.0, 1.0]],
                values: vec![vec![0.0, 1.0, f32::NAN, -1.0]],
            }],
            body: crate::surface::triangles::Triangles::default(),
            mate: None,
            strokes: None,
        }),
        sections: vec![PageSection::new(
            "all",
            HOSTILE,
            HOSTILE,
            vec![
                Block::Heading(HOSTILE.into()),
                Block::Note(HOSTILE.into()),
                Block::Lines(chart(HOSTILE)),
                Block::Table(PageTable {
                    caption: HOSTILE.into(),
                    columns: vec![HOSTILE.into()],
                    rows: vec![vec![HOSTILE.into()]],
                }),
                Block::Folded(HOSTILE.into(), vec![Block::Verbatim(HOSTILE.into())]),
            ],
        )],
    }
}

/// The only tags are the page's own, wherever hostile text is put.
#[test]
fn text_from_a_scene_stays_text() {
    let text = page().html();
    assert_eq!(
        text.matches("<script").count(),
        2 + 1 + SCRIPTS.len(),
        "two blocks of data, three.js, the page's scripts"
    );
    assert_eq!(text.matches("</script").count(), 2 + 1 + SCRIPTS.len());
    assert_eq!(text.matches("<img").count(), 0);
    assert!(!text.contains("onerror=alert(1)>\"'"), "an attribute is left open");
    assert!(text.contains("&lt;script&gt;alert"));
}

#[test]
fn the_same_page_has_the_same_bytes_and_names_its_scripts() {
    let text = page().html();
    assert_eq!(text, page().html());
    let hash = STANDARD.encode(Sha256::digest(SCRIPTS[2]));
    assert!(text.contains(&format!("'sha256-{hash}'")), "the policy lets the page's own scripts run");
    assert!(text.contains("default-src 'none'"));
}

/// What could make a browser ask the network for anything; names of XML dialects are no addresses.
#[test]
fn nothing_on_the_page_lies_elsewhere() {
    let text = page().html();
    for word in [
        "src=\"http",
        "href=\"http",
        "url(",
        "@import",
        "<link",
        "<iframe",
        "fetch(",
        "XMLHttpRequest(",
        "navigator.sendBeacon",
    ] {
        let own = if ["fetch(", "XMLHttpRequest("].contains(&word) { text.replace(THREE, "") } else { text.clone() };
        assert!(!own.contains(word), "{word}");
    }
}

#[test]
fn the_library_is_the_one_that_its_record_names() {
    let record = include_str!("../../../assets/three/README.md");
    let hash: String = Sha256::digest(THREE)
        .iter()
        .flat_map(|byte| [byte >> 4, byte & 15])
        .filter_map(|half| char::from_digit(half.into(), 16))
        .collect();
    assert!(record.contains(&hash), "assets/three/README.md does not name {hash}");
}

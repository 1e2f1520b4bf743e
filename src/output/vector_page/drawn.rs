//! The report's own drawings on a page: charts and nets, from the SVG that is their file.
//!
//! In: the text of an SVG file that this crate has written. Out: a [`VectorPage`] as large as its view box, a pixel as
//! a point; [`VectorPage::place`] gives it its size on paper.
//!
//! The law: a chart is laid out once, as SVG, and paper shows that. What charts use is known: lines, rectangles,
//! circles, polygons, paths of straight pieces, texts, groups that are moved; colours by attributes, or by rules of
//! single classes and elements. Anything else is an error that names it: no piece is lost without a word. What is
//! see-through becomes paler, since charts draw such areas on white.

use super::{Anchor, Ink, VectorPage};
use roxmltree::{Document, Node};
use std::f64::consts::TAU;

/// Corners of the polygon that a circle is drawn as: dots are smaller than a letter.
const CORNERS: u32 = 12;

/// How a piece looks: what it has from its parents, its attributes and its rules.
#[derive(Clone)]
struct Looks {
    colour: [u8; 3],
    fill: Paint,
    stroke: Paint,
    width: f64,
    dashed: bool,
    opacity: f64,
    anchor: Anchor,
    size: f64,
    moved: (f64, f64),
}

#[derive(Clone, Copy)]
enum Paint {
    None,
    Current,
    Rgb([u8; 3]),
}

/// A rule: a selector (an element's name, or a dot and a class) and its declarations.
type Rule<'a> = (&'a str, Vec<(&'a str, &'a str)>);

/// The drawing as a page.
///
/// # Errors
/// No SVG, or one with pieces that no chart has.
pub fn drawn(svg: &str) -> Result<VectorPage, String> {
    let document = Document::parse(svg).map_err(|error| format!("a drawing is no XML: {error}"))?;
    let root = document.root_element();
    let view = numbers(root.attribute("viewBox").unwrap_or_default())?;
    let [_, _, width, height] = view[..] else { return Err("a drawing has no view box".to_owned()) };
    let styles = root.descendants().filter(|node| node.has_tag_name("style")).filter_map(|node| node.text());
    let texts: Vec<String> = styles.map(without_comments).collect();
    let rules: Vec<Rule> = texts.iter().flat_map(|text| rules(text)).collect();
    let mut page = VectorPage::of_size("", [width, height]);
    let plain = Looks {
        colour: [0; 3],
        fill: Paint::Rgb([0; 3]),
        stroke: Paint::None,
        width: 1.0,
        dashed: false,
        opacity: 1.0,
        anchor: Anchor::Start,
        size: 16.0,
        moved: (0.0, 0.0),
    };
    draw(&mut page, root, &plain, &rules)?;
    Ok(page)
}

fn draw(page: &mut VectorPage, node: Node, parent: &Looks, rules: &[Rule]) -> Result<(), String> {
    let name = node.tag_name().name();
    if ["title", "desc", "style"].contains(&name) {
        return Ok(());
    }
    let looks = parent.clone().of(node, rules)?;
    let at = |x: f64, y: f64| (x + looks.moved.0, y + looks.moved.1);
    let number = |key: &str| match node.attribute(key) {
        None => Ok(0.0),
        Some(text) => text.parse::<f64>().map_err(|_| format!("{key} of a drawing is {text}")),
    };
    let pairs = |numbers: &[f64]| numbers.chunks_exact(2).map(|pair| at(pair[0], pair[1])).collect::<Vec<_>>();
    match name {
        "svg" | "g" => {
            for child in node.children().filter(Node::is_element) {
                draw(page, child, &looks, rules)?;
            }
        }
        "line" => {
            let ends = [at(number("x1")?, number("y1")?), at(number("x2")?, number("y2")?)];
            looks.draw(page, &ends, false);
        }
        "rect" => {
            let (x, y, width, height) = (number("x")?, number("y")?, number("width")?, number("height")?);
            let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)];
            looks.draw(page, &corners.map(|(x, y)| at(x, y)), true);
        }
        "circle" => {
            let (x, y, radius) = (number("cx")?, number("cy")?, number("r")?);
            let corner = |k: u32| (TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
            let round = (0..=CORNERS).map(corner).map(|(sin, cos)| at(x + radius * cos, y + radius * sin));
            looks.draw(page, &round.collect::<Vec<_>>(), true);
        }
        "polyline" | "polygon" => {
            let mut points = pairs(&numbers(node.attribute("points").unwrap_or_default())?);
            points.extend(points.first().copied().filter(|_| name == "polygon"));
            looks.draw(page, &points, true);
        }
        "path" => {
            for run in node.attribute("d").unwrap_or_default().split('M').filter(|run| !run.trim().is_empty()) {
                looks.draw(page, &pairs(&numbers(&run.replace('L', " "))?), true);
            }
        }
        "text" => {
            let ink = looks.ink(looks.fill).unwrap_or(Ink::Black);
            let words: String = node.descendants().filter_map(|node| node.is_text().then(|| node.text())?).collect();
            page.words(at(number("x")?, number("y")?), looks.size, ink, looks.anchor, words.trim());
        }
        other => return Err(format!("paper cannot show the piece {other} of a drawing")),
    }
    Ok(())
}

impl Looks {
    /// What a piece has: attributes first, then rules, the later the stronger.
    fn of(mut self, node: Node, rules: &[Rule]) -> Result<Self, String> {
        for attribute in node.attributes() {
            self.set(attribute.name(), attribute.value())?;
        }
        let name = node.tag_name().name();
        let classes: Vec<&str> = node.attribute("class").unwrap_or_default().split(' ').collect();
        let holds = |selector: &str| match selector.strip_prefix('.') {
            Some(class) => classes.contains(&class),
            None => selector == name,
        };
        // A rule of a class is stronger than one of an element.
        for class in [false, true] {
            let own = rules.iter().filter(|rule| rule.0.starts_with('.') == class && holds(rule.0));
            for (key, value) in own.flat_map(|rule| &rule.1) {
                self.set(key, value)?;
            }
        }
        Ok(self)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let number = || value.parse::<f64>().map_err(|_| format!("{key} of a drawing is {value}"));
        match key {
            "color" => self.colour = rgb(value)?,
            "fill" => self.fill = paint(value)?,
            "stroke" => self.stroke = paint(value)?,
            "stroke-width" => self.width = number()?,
            "stroke-dasharray" => self.dashed = true,
            "opacity" => self.opacity *= number()?,
            "font-size" => self.size = number()?,
            "text-anchor" => {
                self.anchor = match value {
                    "middle" => Anchor::Middle,
                    "end" => Anchor::End,
                    _ => Anchor::Start,
                }
            }
            "transform" => {
                let inside = value.strip_prefix("translate(").and_then(|rest| rest.strip_suffix(')'));
                let by = numbers(inside.ok_or_else(|| format!("a drawing is moved by {value}"))?)?;
                let [x, y] = by[..] else { return Err(format!("a drawing is moved by {value}")) };
                self.moved = (self.moved.0 + x, self.moved.1 + y);
            }
            _ => {}
        }
        Ok(())
    }

    fn ink(&self, paint: Paint) -> Option<Ink> {
        let rgb = match paint {
            Paint::None => return None,
            Paint::Current => self.colour,
            Paint::Rgb(rgb) => rgb,
        };
        Some(Ink::Rgb(rgb.map(|part| (255.0 + self.opacity * (f64::from(part) - 255.0)).round() as u8)))
    }

    /// Fills what can be filled, then draws its outline.
    fn draw(&self, page: &mut VectorPage, points: &[(f64, f64)], filled: bool) {
        if let Some(ink) = self.ink(self.fill).filter(|_| filled && points.len() > 2) {
            page.area(points, ink);
        }
        match self.ink(self.stroke) {
            Some(ink) if self.dashed => page.dashes(points, ink, self.width),
            Some(ink) => page.path(points, ink, self.width),
            None => {}
        }
    }
}

/// Numbers between blanks and commas.
fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split([' ', ',', '\n']).filter(|word| !word.is_empty());
    words.map(|word| word.parse().map_err(|_| format!("a number of a drawing is {word}"))).collect()
}

fn paint(value: &str) -> Result<Paint, String> {
    match value {
        "none" => Ok(Paint::None),
        "currentColor" => Ok(Paint::Current),
        value => rgb(value).map(Paint::Rgb),
    }
}

/// A colour written as `#rrggbb`.
fn rgb(value: &str) -> Result<[u8; 3], String> {
    let number = value.strip_prefix('#').filter(|digits| digits.len() == 6);
    let number = number.and_then(|digits| u32::from_str_radix(digits, 16).ok());
    let [_, r, g, b] = number.ok_or_else(|| format!("a colour of a drawing is {value}"))?.to_be_bytes();
    Ok([r, g, b])
}

fn without_comments(text: &str) -> String {
    let mut parts = text.split("/*");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once("*/").map_or("", |(_, rest)| rest))
}

/// The rules of a style sheet; a list of selectors makes as many rules.
fn rules(text: &str) -> Vec<Rule<'_>> {
    let blocks = text.split('}').filter_map(|block| block.split_once('{'));
    blocks
        .flat_map(|(selectors, body)| {
            let declarations: Vec<(&str, &str)> = body
                .split(';')
                .filter_map(|one| one.split_once(':'))
                .map(|(key, value)| (key.trim(), value.trim()))
                .collect();
            selectors.split(',').map(move |selector| (selector.trim(), declarations.clone()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::PagePiece;
    use super::*;

    #[test]
    fn a_drawing_keeps_places_colours_and_words() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100" font-size="10">
            <style>/* none */ text { fill: #112233; } .s1 { color: #ff0000; } .end { text-anchor: end; }
            .curve { fill: none; stroke: currentColor; stroke-width: 2; } .area { fill: currentColor; opacity: 0.5; }
            </style><title>not drawn</title>
            <g transform="translate(10 20)"><path class="curve s1" d="M0 0L5 5M7 7L9 9"/>
            <polygon class="area s1" points="0,0 4,0 4,4"/><text class="end" x="3" y="4">a &lt; b</text></g></svg>"#;
        let page = drawn(svg).expect("a drawing");
        assert_eq!(page.size_pt, [200.0, 100.0]);
        let red = Ink::Rgb([255, 0, 0]);
        let path =
            |points: [(f64, f64); 2]| PagePiece::Path { points: points.into(), ink: red, width: 2.0, dashed: false };
        let pale = Ink::Rgb([255, 128, 128]);
        let triangle = vec![(10.0, 20.0), (14.0, 20.0), (14.0, 24.0), (10.0, 20.0)];
        let words = PagePiece::Words {
            at: (13.0, 24.0),
            size: 10.0,
            ink: Ink::Rgb([0x11, 0x22, 0x33]),
            anchor: Anchor::End,
            words: "a < b".to_owned(),
        };
        let expected = [
            path([(10.0, 20.0), (15.0, 25.0)]),
            path([(17.0, 27.0), (19.0, 29.0)]),
            PagePiece::Area { points: triangle, ink: pale },
            words,
        ];
        assert_eq!(page.strokes, expected);
    }

    #[test]
    fn what_paper_cannot_show_is_said() {
        let with = |piece: &str| {
            drawn(&format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">{piece}</svg>"#)).map(|_| ())
        };
        assert_eq!(with("<ellipse/>"), Err("paper cannot show the piece ellipse of a drawing".to_owned()));
        assert_eq!(with(r#"<g transform="rotate(9)"/>"#), Err("a drawing is moved by rotate(9)".to_owned()));
        assert_eq!(with(r#"<path d="M0 0C1 1 2 2 3 3"/>"#), Err("a number of a drawing is 0C1".to_owned()));
        assert_eq!(with(r#"<line x1="0" stroke="red"/>"#), Err("a colour of a drawing is red".to_owned()));
    }
}

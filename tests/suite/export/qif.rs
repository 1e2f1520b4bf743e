//! QIF documents, read back with an XML parser.

use super::points::table;
use crate::fixtures::command::gearcut;
use roxmltree::{Document, Node};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// Elements of a name, in the order of the document.
fn all<'a>(document: &'a Document, name: &str) -> Vec<Node<'a, 'a>> {
    document.descendants().filter(|node| node.has_tag_name(name)).collect()
}

/// The only child of a name.
fn child<'a>(node: &Node<'a, 'a>, name: &str) -> Node<'a, 'a> {
    let children: Vec<_> = node.children().filter(|child| child.has_tag_name(name)).collect();
    assert_eq!(children.len(), 1, "{name} of {:?}", node.tag_name());
    children[0]
}

fn words<'a>(node: &Node<'a, 'a>) -> Vec<&'a str> {
    node.text().unwrap_or_default().split_whitespace().collect()
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// Every id is there once, the largest is that of the root, every reference has its element, every count is right.
fn assert_references_resolve(document: &Document) {
    let ids: Vec<u32> =
        document.descendants().filter_map(|node| node.attribute("id")).map(|id| id.parse().expect("an id")).collect();
    let known: BTreeSet<u32> = ids.iter().copied().collect();
    assert_eq!(known.len(), ids.len(), "an id is there twice");
    assert_eq!(document.root_element().attribute("idMax"), known.last().map(u32::to_string).as_deref());
    let by_id: HashMap<u32, Node> =
        document.descendants().filter_map(|node| Some((node.attribute("id")?.parse().ok()?, node))).collect();
    for (name, target) in [
        ("FeatureDefinitionId", "PointDefinedSurfaceFeatureDefinition"),
        ("FeatureNominalId", "PointDefinedSurfaceFeatureNominal"),
        ("FeatureItemId", "PointDefinedSurfaceFeatureItem"),
        ("CommonCoordinateSystemId", "CoordinateSystem"),
        ("Ids", "MeasurePoint"),
    ] {
        for id in all(document, name).iter().flat_map(words) {
            assert!(by_id[&id.parse().expect("an id")].has_tag_name(target), "{name} {id}");
        }
    }
    for node in document.descendants() {
        let elements = node.children().filter(Node::is_element).count();
        match node.attribute("n") {
            Some(n) if node.has_tag_name("MeasurePointNominalIds") => {
                assert_eq!(n, words(&child(&node, "Ids")).len().to_string());
            }
            Some(n) => assert_eq!(n, elements.to_string(), "{:?}", node.tag_name()),
            None => {}
        }
    }
}

/// Points, normals and deviations of a flank: those of the set that its nominal or measurement refers to.
fn point_set<'a>(document: &'a Document, of: &Node<'a, 'a>) -> Node<'a, 'a> {
    let id = words(&child(&child(of, "PointList"), "WholePointSetId"))[0];
    document.descendants().find(|node| node.attribute("id") == Some(id)).expect("a point set")
}

fn exported(scene: &str, file: &Path, more: &[&str]) -> String {
    let path = file.to_str().expect("UTF-8");
    gearcut(&[&["export", scene, "--quiet", "--qif", path], more].concat()).done();
    std::fs::read_to_string(file).expect("written")
}

/// The document has the points of the table, digit by digit; on each nominal point, along its normal, is the measured
/// one, as far off as the deviation says.
#[test]
fn a_document_has_the_points_of_the_table() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let [csv, qif] = ["cut.csv", "cut.qif"].map(|name| folder.path().join(name));
    let more = ["--points", csv.to_str().expect("UTF-8"), "--teeth", "2..3", "--grid", "3x2", "--as-cut"];
    let text = exported("scenes/shaping/circular_m3_z24.toml", &qif, &more);
    let document = Document::parse(&text).expect("XML");
    let root = document.root_element();
    assert_eq!(root.tag_name().namespace(), Some("http://qifstandards.org/xsd/qif3"));
    assert_eq!(root.attribute("versionQIF"), Some("3.0.0"));
    assert_references_resolve(&document);
    let units: Vec<&str> = all(&document, "UnitName").iter().flat_map(words).collect();
    assert_eq!(units, ["radian", "mm"]);
    assert_eq!(words(&all(&document, "Factor")[0]), ["0.001"]);

    let rows = table(&csv);
    let mut places = rows.iter();
    let measurements = all(&document, "PointDefinedSurfaceFeatureMeasurement");
    let nominals = all(&document, "PointDefinedSurfaceFeatureNominal");
    assert_eq!([measurements.len(), nominals.len(), rows.len()], [4, 4, 24]);
    for (nominal, measurement) in nominals.iter().zip(&measurements) {
        let [nominal_set, measured_set] = [nominal, measurement].map(|of| point_set(&document, of));
        let targets: Vec<Node> = nominal_set.children().filter(Node::is_element).collect();
        let defining: Vec<Node> = child(nominal, "DefiningPoints").children().filter(Node::is_element).collect();
        let of_set = |name: &str| words(&child(&measured_set, name));
        let [points, normals, deviations] = ["Points", "Normals", "Deviations"].map(of_set);
        let ids = words(&child(&child(&measured_set, "MeasurePointNominalIds"), "Ids"));
        assert_eq!(measured_set.attribute("count"), Some("6"));
        assert_eq!([points.len(), normals.len(), deviations.len(), ids.len()], [18, 18, 6, 6]);
        for (place, (target, defining)) in targets.iter().zip(&defining).enumerate() {
            let row = places.next().expect("a row");
            let [point, normal] = [&points, &normals].map(|list| &list[3 * place..3 * place + 3]);
            assert_eq!(point, ["x_mm", "y_mm", "z_mm"].map(|name| row[name].as_str()));
            assert_eq!(normal, ["nx", "ny", "nz"].map(|name| row[name].as_str()));
            assert_eq!(words(&child(target, "Normal")), normal);
            assert_eq!(target.attribute("id"), Some(ids[place]));
            let at = words(&child(target, "Point"));
            assert_eq!(words(&child(defining, "Point")), at);
            assert_eq!(words(&child(defining, "SequenceNumber")), [(place + 1).to_string()]);
            let deviation_mm = number(deviations[place]);
            assert!((1e3 * deviation_mm - number(&row["deviation_um"])).abs() <= 1.01e-4, "{row:?}");
            let off_mm = |i: usize| number(point[i]) - number(at[i]);
            let along_mm: f64 = (0..3).map(|i| off_mm(i) * number(normal[i])).sum();
            assert!((along_mm - deviation_mm).abs() < 2e-7, "{row:?}: {along_mm} mm");
            let name = format!("tooth {} {}", row["tooth"], row["flank"]);
            assert_eq!(child(nominal, "Name").text(), Some(name.as_str()));
        }
    }
    assert!(places.next().is_none());
    let largest_mm = all(&document, "Deviations").iter().flat_map(words).map(number).fold(0.0, f64::max);
    assert!(largest_mm > 1e-5, "{largest_mm} mm of marks");
    assert!(!all(&document, "InspectionStatusEnum").is_empty());
}

/// A target is nominal alone, of a bevel gear and in inches, too; the same scene gives the same bytes, another unit
/// another document.
#[test]
fn a_target_has_no_results() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let scene = "scenes/bevel/crown_gear.toml";
    let write = |name: &str, unit: &str| {
        exported(scene, &folder.path().join(name), &["--teeth", "1", "--grid", "2x2", "--units", unit])
    };
    let [mm, again, inches] = [("mm.qif", "mm"), ("again.qif", "mm"), ("inch.qif", "inch")].map(|(a, b)| write(a, b));
    assert_eq!(mm, again);
    let documents = [&mm, &inches].map(|text| Document::parse(text).expect("XML"));
    for document in &documents {
        assert_references_resolve(document);
        assert!(all(document, "Results").is_empty());
        assert_eq!(all(document, "MeasurePoint").len(), 8);
    }
    let [mm, inches] = documents
        .each_ref()
        .map(|document| all(document, "Point").iter().flat_map(words).map(number).collect::<Vec<f64>>());
    assert!(mm.iter().zip(&inches).all(|(mm, inch)| (mm - 25.4 * inch).abs() < 1e-7), "{mm:?}, {inches:?}");
    let [mm, inches] = documents.each_ref().map(|document| words(&all(document, "QPId")[0])[0]);
    assert!(mm != inches && mm.len() == 36 && mm.as_bytes()[14] == b'8', "{mm}, {inches}");
}

/// A document of a size that nobody opens is refused before anything is computed.
#[test]
fn too_many_points_are_refused() {
    let file = ["export", "scenes/shaping/circular_m3_z24.toml", "--qif", "points.qif", "--grid", "1000x1000"];
    gearcut(&file).failed(1, &["48000000 points are more than the 250000", "write a table with --points"]);
}

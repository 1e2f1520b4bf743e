//! STEP files read back as text: the shell is closed, and its walls are on the target; flanks of bevel gears are faces
//! with their material behind them.
//!
//! B-splines are computed here by the recursion that defines them.

use super::sections::target;
use super::{TOLERANCE_MM, distance_from_line_mm};
use crate::fixtures::command::gearcut;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// A spur gear with a bore, one without, a gear that is not round, a ring, helical gears, round and not; teeth, as few
/// as will do, and one of them.
const SCENES: [(&str, u32, u32); 6] = [
    ("scenes/shaping/circular_m3_z24.toml", 24, 3),
    ("scenes/hobbing/circular_spur.toml", 20, 3),
    ("scenes/shaping/elliptical_normal.toml", 42, 5),
    ("scenes/shaping/internal_ellipse.toml", 72, 7),
    ("scenes/hobbing/circular_helical.toml", 21, 6),
    ("scenes/hobbing/ellipse_six_schemes.toml", 21, 4),
];

/// Places of a wall between two knots that are compared with the target.
const PLACES: u32 = 60;

/// Instances of a file: name and contents of its brackets.
struct StepText(HashMap<usize, (String, String)>);

/// A B-spline of a file.
struct FileSpline {
    knots: Vec<f64>,
    controls: Vec<DVec3>,
}

impl StepText {
    fn read(text: &str) -> Self {
        let instance = |line: &str| {
            let (id, body) = line.strip_prefix('#')?.strip_suffix(';')?.split_once('=')?;
            let (name, rest) = body.split_once('(')?;
            Some((id.parse().expect("a number"), (name.to_owned(), rest.strip_suffix(')')?.to_owned())))
        };
        Self(text.lines().filter_map(instance).collect())
    }

    fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = usize> + 'a {
        self.0.iter().filter(move |(_, (of, _))| of == name).map(|(&id, _)| id)
    }

    /// Instances that one refers to.
    fn references(&self, id: usize) -> Vec<usize> {
        let number = |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>().parse().ok();
        self.0[&id].1.split('#').skip(1).filter_map(number).collect()
    }

    fn is_forward(&self, id: usize) -> bool {
        self.0[&id].1.ends_with(".T.")
    }

    /// Numbers of the lists in the brackets of an instance, list by list; lists of anything else are left out.
    fn lists(&self, id: usize) -> Vec<Vec<f64>> {
        let list = |text: &str| text.split(',').map(|word| word.trim().parse().ok()).collect::<Option<Vec<f64>>>();
        self.0[&id].1.split(['(', ')']).filter_map(list).collect()
    }

    fn point(&self, id: usize) -> DVec3 {
        DVec3::from_slice(&self.lists(id)[0])
    }

    /// Edges of a loop, each with whether it is run through from its start.
    fn edges(&self, bound: usize) -> Vec<(usize, bool)> {
        let oriented = self.references(self.references(bound)[0]);
        oriented.into_iter().map(|id| (self.references(id)[0], self.is_forward(id))).collect()
    }

    fn has_gap(&self, bound: usize) -> bool {
        let ends = |(edge, is_forward): (usize, bool)| {
            let edge = self.references(edge);
            if is_forward { [edge[0], edge[1]] } else { [edge[1], edge[0]] }
        };
        let ends: Vec<[usize; 2]> = self.edges(bound).into_iter().map(ends).collect();
        ends.iter().zip(ends.iter().cycle().skip(1)).any(|(own, next)| own[1] != next[0])
    }

    /// What is wrong with the shell: edges that are not used once in either sense, loops with gaps, faces that do not
    /// belong to it, another number of holes than one.
    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut uses: HashMap<(usize, bool), u32> = HashMap::new();
        let (mut loops, mut faces) = (0_i64, 0_i64);
        let shell = self.all("CLOSED_SHELL").next().expect("a shell");
        for face in self.references(shell) {
            faces += 1;
            let parts = self.references(face);
            for bound in &parts[..parts.len() - 1] {
                loops += 1;
                for used in self.edges(*bound) {
                    *uses.entry(used).or_default() += 1;
                }
                if self.has_gap(*bound) {
                    faults.push(format!("face {face}: a loop with a gap"));
                }
            }
        }
        for edge in self.all("EDGE_CURVE") {
            let of = [true, false].map(|sense| uses.get(&(edge, sense)).copied().unwrap_or_default());
            if of != [1, 1] {
                faults.push(format!("edge {edge} is used {of:?} times"));
            }
        }
        if faces != self.all("ADVANCED_FACE").count() as i64 || self.all("MANIFOLD_SOLID_BREP").count() != 1 {
            faults.push("faces beside the shell".to_owned());
        }
        // Euler and Poincare: V - E + F - (L - F) = 2 (shells - holes).
        let [vertices, edges] = ["VERTEX_POINT", "EDGE_CURVE"].map(|name| self.all(name).count() as i64);
        let holes = 1 - (vertices - edges + faces - (loops - faces)) / 2;
        let expected = i64::from(self.all("CYLINDRICAL_SURFACE").next().is_some());
        if holes != expected {
            faults.push(format!("{holes} holes"));
        }
        faults
    }

    fn spline(&self, id: usize) -> FileSpline {
        let [times, places]: [Vec<f64>; 2] = self.lists(id).try_into().expect("two lists of numbers");
        let controls = self.references(id).into_iter().map(|point| self.point(point)).collect();
        FileSpline { knots: knots(&times, &places), controls }
    }

    /// The curve along the profile of a surface at a parameter along the tooth.
    fn along_profile(&self, surface: usize, param: f64) -> FileSpline {
        let [times_u, times_v, places_u, places_v]: [Vec<f64>; 4] =
            self.lists(surface).try_into().expect("four lists of numbers");
        let (u, v) = (knots(&times_u, &places_u), knots(&times_v, &places_v));
        let rows = v.len() - 4;
        let controls: Vec<DVec3> = self.references(surface).into_iter().map(|point| self.point(point)).collect();
        let controls = controls.chunks(rows).map(|column| place(&v, column, param)).collect();
        FileSpline { knots: u, controls }
    }

    /// Walls of the profile in the section at `z_mm`.
    fn section(&self, z_mm: f64) -> Vec<FileSpline> {
        let swept = self.all("SURFACE_OF_LINEAR_EXTRUSION").map(|id| self.spline(self.references(id)[0]));
        let curved = self.all("B_SPLINE_SURFACE_WITH_KNOTS").map(|id| self.along_profile(id, z_mm));
        swept.chain(curved).collect()
    }
}

fn knots(times: &[f64], places: &[f64]) -> Vec<f64> {
    times.iter().zip(places).flat_map(|(&times, &place)| std::iter::repeat_n(place, times as usize)).collect()
}

fn basis(knots: &[f64], i: usize, degree: usize, t: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
    }
    let part = |from: f64, to: f64, value: f64| if to > from { value / (to - from) } else { 0.0 };
    part(knots[i], knots[i + degree], (t - knots[i]) * basis(knots, i, degree - 1, t))
        + part(knots[i + 1], knots[i + degree + 1], (knots[i + degree + 1] - t) * basis(knots, i + 1, degree - 1, t))
}

fn place(knots: &[f64], controls: &[DVec3], t: f64) -> DVec3 {
    controls.iter().enumerate().map(|(i, &control)| basis(knots, i, 3, t) * control).sum()
}

impl FileSpline {
    fn places(&self) -> Vec<DVec2> {
        let spans = self.knots.windows(2).filter(|ends| ends[1] > ends[0]);
        let inside = spans.flat_map(|ends| {
            (0..PLACES).map(|i| ends[0] + (ends[1] - ends[0]) * f64::from(i) / f64::from(PLACES)).collect::<Vec<_>>()
        });
        let end = self.controls.last().copied();
        inside.map(|t| place(&self.knots, &self.controls, t)).chain(end).map(DVec3::truncate).collect()
    }
}

/// Distances of the target round a tooth from the file at `z_mm`, and of the file's walls there from the target, mm.
fn off_mm(file: &StepText, target_mm: &[DVec2], z_mm: f64) -> [f64; 2] {
    let middle = target_mm[target_mm.len() / 2];
    let reach_mm = target_mm.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
    let walls: Vec<Vec<DVec2>> = file
        .section(z_mm)
        .iter()
        .filter(|wall| wall.controls.iter().any(|control| control.truncate().distance(middle) < reach_mm + 1.0))
        .map(FileSpline::places)
        .collect();
    assert!(walls.len() >= 4, "{} walls", walls.len());
    let chords = |chain: &[DVec2]| chain.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>();
    let far = |lines: &[[DVec2; 2]], p: DVec2| {
        lines.iter().map(|&line| distance_from_line_mm(line, p)).fold(f64::INFINITY, f64::min)
    };
    let lines: Vec<[DVec2; 2]> = walls.iter().flat_map(|wall| chords(wall)).collect();
    let from_file = target_mm.iter().map(|&p| far(&lines, p)).fold(0.0, f64::max);
    // Walls that lie wholly between the ends of the chain: those of the tooth itself.
    let target = chords(target_mm);
    let (first, last) = (target_mm[0], target_mm[target_mm.len() - 1]);
    let own = |wall: &&Vec<DVec2>| wall.iter().all(|&p| first.perp_dot(p) > 0.0 && p.perp_dot(last) > 0.0);
    let own: Vec<DVec2> = walls.iter().filter(own).flatten().copied().collect();
    assert!(own.len() > 3 * PLACES as usize, "{} places", own.len());
    [from_file, own.into_iter().map(|p| far(&target, p)).fold(0.0, f64::max)]
}

/// A file with what the command says of it.
fn step_file(scene: &str, arguments: &[&str]) -> (String, String) {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("gear.step");
    let file = path.to_str().expect("UTF-8");
    let outcome = gearcut(&[&["export", scene, "--quiet", "--step", file], arguments].concat()).done();
    (std::fs::read_to_string(&path).expect("it was written"), outcome.out.clone())
}

/// The number before `um at most`.
fn said_um(out: &str) -> f64 {
    out_um(out, "off the profile")
}

fn out_um(out: &str, words: &str) -> f64 {
    let line = out.lines().find(|line| line.contains(words)).expect("a distance");
    line.split_whitespace().nth_back(3).expect("a number").parse().expect("a number")
}

/// An edge that is turned round, a face that is missing, a place that is 5 um off.
#[test]
fn planted_faults_of_a_solid_are_seen() {
    let (scene, _, tooth) = SCENES[0];
    let (text, _) = step_file(scene, &[]);
    let line = text.lines().find(|line| line.contains("ORIENTED_EDGE") && line.ends_with(".T.);")).expect("an edge");
    let turned = text.replace(line, &line.replace(".T.", ".F."));
    assert!(StepText::read(&turned).faults().iter().any(|fault| fault.starts_with("edge")));
    let shell = text.lines().find(|line| line.contains("CLOSED_SHELL")).expect("a shell");
    let (kept, _) = shell.rsplit_once(',').expect("faces");
    assert!(!StepText::read(&text.replace(shell, &format!("{kept}));"))).faults().is_empty());
    let fine = target(scene, &[], tooth, 0.0, 5e-3);
    let mut file = StepText::read(&text);
    let of_the_tooth = file.section(0.0).into_iter().filter(|wall| {
        wall.controls.iter().all(|control| {
            let p = control.truncate();
            fine[0].perp_dot(p) > 0.0 && p.perp_dot(fine[fine.len() - 1]) > 0.0
        })
    });
    // A flank: along a tip or a root the displaced point would stay on the profile.
    let wall = of_the_tooth.max_by(|a, b| {
        let height_mm = [a, b].map(|wall| {
            let radii_mm = wall.controls.iter().map(|control| control.truncate().length());
            radii_mm.clone().fold(0.0, f64::max) - radii_mm.fold(f64::INFINITY, f64::min)
        });
        height_mm[0].total_cmp(&height_mm[1])
    });
    let control = wall.expect("a wall of the tooth").controls[1];
    let id = file.all("CARTESIAN_POINT").find(|&id| file.point(id) == control).expect("its point");
    let moved = file.point(id) + 5e-3 * control.truncate().perp().normalize().extend(0.0);
    file.0.insert(id, ("CARTESIAN_POINT".to_owned(), format!("'',({},{},{})", moved.x, moved.y, moved.z)));
    let [from_file, _] = off_mm(&file, &fine, 0.0);
    assert!(from_file > 1.2 * TOLERANCE_MM, "{from_file} mm");
}

/// As cut the solid is that of the section with its marks; the head says what it is.
#[test]
fn a_solid_as_cut_has_marks_and_what_is_none_is_refused() {
    let scene = SCENES[0].0;
    let folder = tempfile::tempdir().expect("a folder for the test");
    let named = folder.path().join("a 'gear' \u{e4}.toml");
    std::fs::copy(scene, &named).expect("copied");
    let named = named.to_str().expect("UTF-8");
    let sets = ["--set", "gear.teeth=10"];
    let (text, _) = step_file(named, &[&sets[..], &["--as-cut"]].concat());
    let file = StepText::read(&text);
    assert_eq!(file.faults(), Vec::<String>::new());
    assert!(text.contains("as cut 0 mm from the middle") && text.contains("PRODUCT('a ''gear'' \\X2\\00E4\\X0\\',"));
    let fine = target(scene, &["gear.teeth=10"], 3, 0.0, 5e-3);
    let [off_mm, _] = off_mm(&file, &fine, 0.0);
    assert!(off_mm > 2e-4 && off_mm < 0.02, "{off_mm} mm of marks");
    assert_eq!(step_file(scene, &sets).0, step_file(scene, &sets).0, "the same scene gives the same bytes");
    let refused = |arguments: &[&str], words: &[&str]| {
        gearcut(&[&["export"], arguments].concat()).failed(1, words);
    };
    gearcut(&["export", scene, "--step", "a.step", "--teeth", "3"]).failed(2, &["--teeth"]);
    refused(&[scene, "--step", "a.stp"], &["--step", "a.step"]);
    refused(&[scene, "--step", "no/such/a.step"], &["--step", "there is no folder no/such", "way out"]);
    refused(&[scene, "--step", "a.step", "--units", "inch"], &["--units", "STEP files are in mm"]);
    let bevel = "scenes/bevel/crown_gear.toml";
    refused(&[bevel, "--dxf", "a.dxf"], &["bevel", "--step", "way out"]);
    let fine = ["--as-cut", "--tolerance-um", "0.01"];
    refused(&[&[bevel, "--step", "a.step"], &fine[..]].concat(), &["--tolerance-um", "smooth faces are", "way out"]);
}

/// Tests of more than some ten seconds.
mod slow {
    use super::*;

    /// A helical gear whose blank sits 30 um off its spindle: cut flanks lie within the tolerance of the solid, and as
    /// far off its target's as they are off the target.
    #[test]
    fn a_helical_solid_as_cut_is_on_its_cut_flanks() {
        let scene = "scenes/shaping/helical.toml";
        let keys = ["gear.teeth=13", "gear.face_width_mm=2", "mounting.eccentricity_um=30"];
        let sets: Vec<&str> = keys.iter().flat_map(|key| ["--set", key]).collect();
        let (text, out) = step_file(scene, &[&sets[..], &["--as-cut", "--tolerance-um", "3"]].concat());
        assert!(text.contains("helical: as cut'"), "{text:.600}");
        let [tolerance_mm, roots_um] = [3.0 * TOLERANCE_MM, out_um(&out, "off the roots")];
        assert!(out_um(&out, "off the flanks and tips") <= 3.0 && (1.0..30.0).contains(&roots_um), "{out}");
        let [cut, target] = [text, step_file(scene, &sets).0].map(|text| StepText::read(&text));
        assert_eq!(cut.faults(), Vec::<String>::new());
        let folder = tempfile::tempdir().expect("a folder for the test");
        let table = folder.path().join("points.csv");
        let points = ["--points", table.to_str().expect("UTF-8"), "--as-cut", "--grid", "6x2", "--teeth", "2..5"];
        gearcut(&[&["export", scene, "--quiet"], &points[..], &sets].concat()).done();
        let rows = csv::Reader::from_path(&table).expect("CSV").into_records();
        let rows: Vec<Vec<f64>> = rows
            .map(|row| row.expect("a row").iter().skip(2).map(|cell| cell.parse().expect("a number")).collect())
            .collect();
        let mut largest_mm = 0.0_f64;
        for row in &rows {
            let (place, normal, deviation_mm) =
                (DVec2::new(row[2], row[3]), DVec3::from_slice(&row[5..8]), 1e-3 * row[8]);
            let lines_of = |file: &StepText| -> Vec<[DVec2; 2]> {
                let near = |wall: &FileSpline| wall.controls.iter().any(|p| p.truncate().distance(place) < 4.0);
                let walls: Vec<Vec<DVec2>> =
                    file.section(row[4]).iter().filter(|wall| near(wall)).map(FileSpline::places).collect();
                walls.iter().flat_map(|wall| wall.windows(2).map(|pair| [pair[0], pair[1]])).collect()
            };
            // The section's distance is that in space over the cosine between both normals.
            let off_mm = |file: &StepText| {
                let lines = lines_of(file);
                let off_mm = lines.iter().map(|&line| distance_from_line_mm(line, place)).fold(f64::INFINITY, f64::min);
                off_mm * normal.truncate().length()
            };
            assert!(off_mm(&cut) <= tolerance_mm, "{} mm at {row:?}", off_mm(&cut));
            // The foot on the target may lie beyond the tip.
            let off_target_mm = off_mm(&target);
            assert!(off_target_mm <= deviation_mm.abs() + tolerance_mm, "{off_target_mm} mm at {row:?}");
            largest_mm = largest_mm.max(off_target_mm);
        }
        assert!(largest_mm > 0.02 && rows.len() == 2 * 4 * 6 * 2, "{largest_mm} mm");
    }

    #[test]
    fn a_solid_is_closed_and_within_the_tolerance_of_the_target() {
        for (scene, teeth, tooth) in SCENES {
            // A narrow face: fitted sections are as far apart on a wide one, only more of them.
            let small = ["gear.face_width_mm=5", &format!("gear.teeth={teeth}")];
            let (text, out) = step_file(scene, &small.map(|setting| ["--set", setting]).concat());
            let file = StepText::read(&text);
            assert_eq!(file.faults(), Vec::<String>::new(), "{scene}");
            let faces = file.all("ADVANCED_FACE").count();
            assert!(out.contains(&format!("{faces} faces, ")), "{scene}: {faces} faces, {out}");
            // Between all sections that were fitted.
            let z_mm = 1.3;
            let fine = target(scene, &small, tooth, z_mm, 5e-3);
            let [from_file, from_target] = off_mm(&file, &fine, z_mm);
            let said_mm = 1e-3 * said_um(&out);
            // Said to a hundredth of a micrometre.
            assert!(from_file <= said_mm + 5e-6 && said_mm <= TOLERANCE_MM, "{scene}: {from_file}, said {said_mm} mm");
            assert!(from_target <= TOLERANCE_MM, "{scene}: {from_target} mm");
            assert!(said_mm > 0.05 * TOLERANCE_MM, "{scene}: far fewer knots would do: {said_mm} mm");
        }
    }

    /// Every flank of a bevel gear is a face whose material lies behind it, of the named tooth and side; its parameters
    /// are those of tables, so that the points for measuring machines are places of it. A flank that is off by three
    /// tolerances is seen.
    #[test]
    fn flanks_of_bevel_gears_are_faces_through_their_points() {
        for (scene, teeth, more) in [
            ("scenes/bevel/formate.toml", 41, &[][..]),
            ("scenes/bevel/hypoid.toml", 62, &[]),
            ("scenes/bevel/formate.toml", 41, &["--as-cut", "--tolerance-um", "5"]),
        ] {
            let (text, out) = step_file(scene, more);
            let file = StepText::read(&text);
            assert!(out.contains(&format!("{} faces, ", 2 * teeth)), "{out}");
            assert_eq!(file.all("OPEN_SHELL").count(), 2 * teeth);
            let model = file.all("SHELL_BASED_SURFACE_MODEL").next().expect("a model");
            assert_eq!(file.references(model).len(), 2 * teeth);
            let tolerance_mm = if more.is_empty() { TOLERANCE_MM } else { 5.0 * TOLERANCE_MM };
            let said_mm = 1e-3 * out_um(&out, "off the flanks");
            assert!(said_mm <= tolerance_mm, "{said_mm}");
            let folder = tempfile::tempdir().expect("a folder for the test");
            let table = folder.path().join("points.csv");
            let points = ["--points", table.to_str().expect("UTF-8"), "--teeth", "3..4", "--grid", "7x6"];
            let as_cut = &more[..more.len().min(1)];
            gearcut(&[&["export", scene, "--quiet"], &points[..], as_cut].concat()).done();
            let mut reader = csv::Reader::from_path(&table).expect("CSV");
            let mut count = 0;
            for row in reader.records().map(|row| row.expect("a row")) {
                let number = |i: usize| row[i].parse::<f64>().expect("a number");
                let shell = file.0.iter().find(|(_, (name, body))| {
                    name == "OPEN_SHELL" && body.starts_with(&format!("'tooth {}, {} flank'", &row[0], &row[1]))
                });
                let face = file.references(*shell.expect("its shell").0)[0];
                let [bound, surface] = file.references(face).try_into().expect("one loop");
                assert!(!file.has_gap(bound));
                let at = |u_mm: f64, v_mm: f64| {
                    let profile = file.along_profile(surface, v_mm);
                    place(&profile.knots, &profile.controls, u_mm)
                };
                let [u_mm, v_mm] = [2, 3].map(number);
                let [point, normal] = [4, 7].map(|i| DVec3::new(number(i), number(i + 1), number(i + 2)));
                let off_mm = at(u_mm, v_mm).distance(point);
                assert!(off_mm <= tolerance_mm, "{scene}: {off_mm} mm at {row:?}");
                let out = (at(u_mm + 1e-3, v_mm) - at(u_mm, v_mm)).cross(at(u_mm, v_mm + 1e-3) - at(u_mm, v_mm));
                assert_eq!(out.dot(normal) > 0.0, file.is_forward(face), "{row:?}");
                assert!(at(u_mm, v_mm).distance(point + 3.0 * tolerance_mm * normal) > tolerance_mm);
                count += 1;
            }
            assert_eq!(count, 2 * 2 * 7 * 6);
        }
    }
}

//! A hob whose teeth have two different edges: every dexel gets what the tooth that comes there would leave.

use crate::fixtures::face_mill::even;
use crate::fixtures::oracle_cases::{Case, data, number};
use crate::fixtures::two_edges::{Blades, Regrouped, turn_pass};
use gearcut::cut::Backend;
use gearcut::cut::cpu::Cpu;
use gearcut::dexel::{Layer, SpatialField};
use gearcut::passes::sections::swept_sections::{SweptSection, SweptSections};
use gearcut::passes::{MotionTable, SweepPlan, TurningPasses};
use gearcut::process::hobbing::Hob;
use gearcut::tool::CuttingTool;
use std::f64::consts::TAU;

/// A hob's case with a second edge, thicker by as much as facets are high, with rounded tips; and two fields: a flank,
/// coarse, and a fine patch.
pub struct TwoEdgedHob {
    case: Case,
    second: Hob,
    range_rad: [f64; 2],
    pub fields: [SpatialField; 2],
}

impl TwoEdgedHob {
    pub fn new(name: &str) -> Self {
        let file = data(name);
        let case = Case::new(&file["setup"]);
        let mut spec = Case::hob_spec(&file["setup"]);
        spec.thinning_mm = -0.005;
        spec.tip_radius_mm = 1.5;
        let second = Hob::new(&spec, case.normal_module_mm, case.pressure_angle_rad).expect("a hob");
        let (space, flank) = (file["space"].as_i64().expect("space"), number(&file, "flank"));
        let fields = [
            case.patch(space, flank, &even(-26.0, 24.0, 20), &even(-5.0, 5.0, 34)),
            case.patch(space, flank, &even(8.0, 8.8, 17), &even(-1.0, 0.55, 40)),
        ];
        let cycle = TAU * f64::from(case.teeth) / number(&file["setup"], "K");
        Self { case, second, range_rad: [-3.5 * cycle, 4.5 * cycle], fields }
    }

    pub fn tool(&self, blades: Blades) -> Regrouped<'_, Hob> {
        Regrouped::new(&self.case.hob, [self.case.hob.edge_of(0), self.second.edge_of(0)], blades)
    }

    pub fn passes(&self, tool: &Regrouped<Hob>) -> TurningPasses {
        let motion = MotionTable::new(self.range_rad, &[], |angle| self.case.linkage.head_from_work(angle));
        TurningPasses::new(0, tool, self.case.hob.hand, motion).expect("a hob")
    }
}

fn cut(field: &SpatialField, plan: &SweepPlan) -> Layer {
    let mut layer = field.blank_layer();
    Cpu::default().cut_spatial(field, plan, &mut layer).expect("native");
    layer
}

const CASES: [&str; 2] = ["p12_patch_spur", "p09_patch_s2_axial"];

#[test]
fn candidates_equal_brute_force_with_each_tooths_own_edge() {
    let hob = TwoEdgedHob::new(CASES[0]);
    let passes = hob.passes(&hob.tool(Blades::All));
    assert_eq!(passes.edges.edges().len(), 2);
    for field in &hob.fields {
        let (plan, brute) = (SweepPlan::new(field, &passes), SweepPlan::brute_force(field, &passes));
        assert!(brute.dexel_passes() > 50 * plan.dexel_passes());
        assert!(cut(field, &plan) == cut(field, &brute));
    }
}

#[test]
fn two_edges_leave_the_lower_of_what_each_leaves_alone() {
    let mut left = [0; 2];
    for name in CASES {
        let hob = TwoEdgedHob::new(name);
        let [both, first, second] = [Blades::All, Blades::Alone(0), Blades::Alone(1)].map(|blades| {
            let tool = hob.tool(blades);
            let passes = hob.passes(&tool);
            let cut_one = |field| {
                let layer = cut(field, &SweepPlan::new(field, &passes));
                let left_by = layer.passes.iter().map(|&p| (p != u32::MAX).then(|| turn_pass(&passes, &tool, p)));
                (left_by.collect::<Vec<_>>(), layer)
            };
            hob.fields.each_ref().map(cut_one)
        });
        for (field, (left_by, both)) in both.iter().enumerate() {
            let alone = [&first[field], &second[field]];
            for (dexel, left_by) in left_by.iter().enumerate() {
                let heights = alone.map(|(_, layer)| layer.heights_mm[dexel]);
                assert_eq!(both.heights_mm[dexel].to_bits(), heights[0].min(heights[1]).to_bits(), "{name}, {dexel}");
                if heights[0] != heights[1] {
                    let edge = usize::from(heights[1] < heights[0]);
                    assert_eq!(*left_by, alone[edge].0[dexel], "{name}, {dexel}");
                    left[edge] += 1;
                }
            }
        }
    }
    println!("dexels left by each edge: {left:?}");
    assert!(left.iter().all(|&dexels| dexels > 100), "{left:?}");
}

/// A sibling of the tests above: the same teeth with their edges exchanged leave another flank.
#[test]
fn exchanged_edges_are_noticed() {
    let hob = TwoEdgedHob::new(CASES[0]);
    for field in &hob.fields {
        let [given, exchanged] = [Blades::All, Blades::Exchanged]
            .map(|blades| cut(field, &SweepPlan::new(field, &hob.passes(&hob.tool(blades)))));
        let differ = given.heights_mm.iter().zip(&exchanged.heights_mm).filter(|(a, b)| a != b).count();
        assert!(2 * differ > field.len(), "{differ} of {} dexels", field.len());
    }
}

/// Every pass goes through a slice of the blank with the outline of its own tooth.
#[test]
fn sections_have_the_edge_of_their_tooth() {
    let hob = TwoEdgedHob::new(CASES[0]);
    let sections = |blades: Blades| {
        let tool = hob.tool(blades);
        let passes = hob.passes(&tool);
        let sections = SweptSections::new(|_| true, &passes, 1e3, 10.0, false).expect("a hob");
        let mut of_passes = Vec::new();
        for index in 0..sections.len() {
            let mut section = SweptSection::default();
            let found = sections.section(index, 1.7, &mut section);
            of_passes.push(found.then(|| (turn_pass(&passes, &tool, section.pass), format!("{section:?}"))));
        }
        of_passes
    };
    // The outline without the pass id, which counts other blades.
    let outline = |text: &str| text.split_once("pieces").map(|(_, rest)| rest.to_owned()).expect("an outline");
    let both = sections(Blades::All);
    let alone = [0, 1].map(|edge| sections(Blades::Alone(edge)));
    let mut compared = [0; 2];
    for (pass, text) in both.iter().flatten().step_by(97) {
        let own = |edge: usize| alone[edge].iter().flatten().find(|(other, _)| other == pass);
        let found = [0, 1].into_iter().filter_map(|edge: usize| own(edge).map(|(_, text)| (edge, text)));
        let found: Vec<(usize, &String)> = found.collect();
        assert!(found.len() == 1 && outline(text) == outline(found[0].1), "{pass:?}");
        compared[found[0].0] += 1;
    }
    println!("{compared:?} sections of each edge");
    assert!(compared.iter().all(|&count| count > 20));
    // Alive: exchanged edges have other outlines.
    let exchanged = sections(Blades::Exchanged);
    assert!(both.iter().zip(&exchanged).all(|(a, b)| a.as_ref().is_none_or(|a| Some(a) != b.as_ref())));
}

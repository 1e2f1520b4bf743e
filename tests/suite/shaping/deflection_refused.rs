//! Strokes of a machine that yields that have no deflection, and compliances that are none.

use super::deflection::{ROUND, SOFT, with};
use super::machine_errors::job;
use gearcut::process::shaping::cut::chips::deflections;
use std::path::Path;

#[test]
fn a_first_stroke_at_full_depth_is_refused_with_its_size() {
    let text =
        ROUND.split("[operation.infeed.spiral]").next().expect("a scene").to_owned() + "[operation.infeed.none]\n";
    let refusal = deflections(&job(&text, &SOFT), &|| true).expect_err("a plug of whole tooth spaces").to_string();
    println!("{refusal}");
    assert!(refusal.contains("operation finish, stroke 0") && refusal.contains("um away"), "{refusal}");
}

/// Much negative rake and no force on the edge's normal: flanks pull the cutter into the work, the more the thicker
/// their chips are. A stiff machine holds that, a soft one has no balance.
#[test]
fn flanks_that_pull_are_refused_where_the_machine_is_softer() {
    let pulling = [
        "tool.shaper_cutter.rake_angle_deg=-20",
        "material.normal_force_n_per_mm2=0",
        "material.normal_edge_force_n_per_mm=0",
    ];
    let found = |compliance: &str| deflections(&job(ROUND, &with(&pulling, &[compliance])), &|| true);
    let stiff = found("machine.compliance.tool_tangential_um_per_kn=2").expect("it settles").expect("not stopped");
    assert!(stiff[0].iter().any(|of| of.tangential_mm != 0.0));
    let refusal = found("machine.compliance.tool_tangential_um_per_kn=10000").expect_err("it pulls").to_string();
    assert!(refusal.contains("several balances or none") && refusal.contains("rake angle"), "{refusal}");
}

#[test]
fn compliances_are_checked_and_belong_to_shaping() {
    let refused = |text: &str, setting: &str| {
        let told = gearcut::process::parse(text, "scene.toml", Path::new(""), &[setting.to_owned()]);
        told.expect_err("refused").to_string()
    };
    for value in ["-1", "nan", "1e6", "\"soft\""] {
        let told = refused(ROUND, &format!("machine.compliance.tool_radial_um_per_kn={value}"));
        assert!(told.contains("machine.compliance.tool_radial_um_per_kn"), "{told}");
    }
    let hobbing = include_str!("../../../scenes/hobbing/machine_errors.toml");
    let bevel = include_str!("../../../scenes/bevel/machine_errors.toml");
    for text in [hobbing, bevel] {
        let told = refused(text, "machine.compliance.tool_radial_um_per_kn=8");
        println!("{told}");
        assert!(told.contains("machine.compliance") && told.contains("shaper_cutter"), "{told}");
    }
}

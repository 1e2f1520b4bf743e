//! When passes are made, against the speeds that scenes command.

use gearcut::job::GearJob;
use gearcut::process;
use std::path::Path;

/// Asks a shipped scene's gear.
fn of_gear<T>(scene: &str, settings: &[&str], ask: impl Fn(&dyn GearJob) -> T) -> T {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let loaded = process::load(Path::new(scene), &settings).expect("a scene");
    let mut found = None;
    let job = process::prepare(&loaded.scene).expect("a job");
    job.with_gear(&mut |gear| {
        found = Some(ask(gear));
        Ok(())
    })
    .expect("a gear");
    found.expect("a job shows its gear")
}

fn times_s(gear: &dyn GearJob, passes: impl IntoIterator<Item = u32>) -> Vec<f64> {
    passes.into_iter().map(|pass| gear.pass_time_s(pass)).collect()
}

fn assert_same_s(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} s, not {expected} s");
}

/// All 20 teeth of a cutter cut with the stroke that they are in; the second operation begins where the first ends.
#[test]
fn strokes_follow_each_other_by_the_speed_of_the_ram() {
    let settings = ["operation.rough.strokes_per_revolution=480", "machine.double_strokes_per_minute=400"];
    of_gear("scenes/shaping/noise.toml", &settings, |gear| {
        for (pass, time_s) in times_s(gear, 0..gear.passes()).into_iter().enumerate() {
            assert_same_s(time_s, 60.0 / 400.0 * (pass / 20) as f64);
        }
    });
}

/// Teeth of a hob come round once a turn, one after the other, from its first or second turn on.
#[test]
fn teeth_of_a_hob_come_back_after_a_turn() {
    let settings = ["operation.finish.hob_speed_per_minute=240", "tool.hob.gashes=15"];
    of_gear("scenes/hobbing/circular_spur.toml", &settings, |gear| {
        let times_s = times_s(gear, 0..gear.passes());
        assert!(times_s.windows(2).all(|of| of[1] - of[0] > -1e-9) && times_s[0] < 0.5, "from {} s", times_s[0]);
        let a_turn = times_s.partition_point(|time_s| time_s - times_s[0] < 0.25 - 1e-9);
        let moments = times_s[..=a_turn].windows(2).filter(|of| of[1] - of[0] > 1e-6).count();
        assert_eq!(moments, 15, "one for each gash; {a_turn} teeth in a turn");
        for (earlier, later) in times_s.iter().zip(&times_s[a_turn..]) {
            assert_same_s(later - earlier, 0.25);
        }
    });
}

/// Blades of a head that mills slot after slot: 16 in a turn of half a second, and a slot as the one before but for
/// the cycle, which is some whole number of blades longer or shorter where the head turns on.
#[test]
fn blades_of_a_head_pass_slot_after_slot() {
    let settings = ["operation.finish.idle_s=4.0", "operation.finish.head_speed_per_minute=120"];
    of_gear("scenes/bevel/formate.toml", &settings, |gear| {
        let times_s = times_s(gear, 0..gear.passes());
        let blade_s = 0.5 / 16.0;
        // Slots are four seconds apart, blades a 32nd of a second.
        let begins: Vec<usize> = (1..times_s.len()).filter(|&i| times_s[i] - times_s[i - 1] > 1.0).collect();
        assert_eq!(begins.len(), 40, "slots of 41 teeth");
        for pass in 1..times_s.len() {
            if !begins.contains(&pass) {
                assert_same_s(times_s[pass] - times_s[pass - 1], blade_s);
            }
        }
        let cycles: Vec<f64> = begins.windows(2).map(|of| times_s[of[1]] - times_s[of[0]]).collect();
        let mean_s = cycles.iter().sum::<f64>() / cycles.len() as f64;
        for cycle_s in cycles {
            assert!((cycle_s - mean_s).abs() < blade_s, "{cycle_s} s for {mean_s} s");
        }
    });
}

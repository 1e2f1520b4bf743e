//! Same scene, same software adapter, same bytes.

mod gpu_common;

use gearcut::dexel::Layer;
use gearcut::gear::generation::Side;
use gearcut::job::Job;
use gearcut::scene::load;
use gpu_common::*;
use std::path::Path;

/// FNV-1a over the bits of heights and passes: llvmpipe rounds alike in all its versions, widths and thread counts.
const GOLDEN: u64 = 0x95f2_78c8_524e_98a1;

fn hash(layers: &[Layer]) -> u64 {
    let bits = layers.iter().flat_map(|l| l.heights_mm.iter().map(|h| h.to_bits()).chain(l.passes.iter().copied()));
    bits.flat_map(u32::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn the_finishing_stock_scene_has_its_golden_bytes() {
    let mut scene = load(Path::new("scenes/shaping/elliptical_finishing_stock.toml"), &[]).expect("loads").scene;
    scene.fields.lead_spacing_mm = 0.5;
    let job = Job::new(scene).expect("a gear");
    let generation = job.target_generation();
    let gpu = software_gpu(strict());
    let mut layers = Vec::new();
    for (tooth, side) in [(1, Side::Left), (15, Side::Right)] {
        let flank = job.target_flank(&generation, tooth, side).expect("a flank");
        layers.extend(job.cut_rows(&gpu, &job.flank_field(&flank)).expect("cuts").0);
    }
    let dexels: usize = layers.iter().map(|l| l.passes.len()).sum();
    println!("{dexels} dexels, hash {:#018x}", hash(&layers));
    assert_eq!(hash(&layers), GOLDEN, "other bytes than before on {}", gearcut::cut::Backend::name(&gpu));
    // One bit is enough to change the hash.
    let last = layers.last_mut().expect("layers");
    last.heights_mm[0] = f32::from_bits(last.heights_mm[0].to_bits() ^ 1);
    assert_ne!(hash(&layers), GOLDEN);
}

//! The shaders as naga sees them: every file in every variant is valid, and both sides of the border agree.

use gearcut::gpu::pipeline::{QUADS_PER_THREAD, ROUND_RECORDS, STAGES, Stage};
use gearcut::gpu::{WORKGROUP_THREADS, records, sweep_records};
use naga::back::pipeline_constants::process_overrides;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Literal, Module, ShaderStage, TypeInner};
use std::collections::BTreeSet;
use std::mem::offset_of;

fn checked(stage: &Stage) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(stage.text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(stage.text, stage.name)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::default())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(stage.text, stage.name)));
    (module, info)
}

/// Text of every stage's file, found in the folder.
fn files() -> BTreeSet<String> {
    let folder = std::fs::read_dir("crates/gpu/shaders").expect("the folder of shaders");
    folder
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|name| name.strip_suffix(".wgsl").map(str::to_owned))
        .collect()
}

#[test]
fn every_shader_is_valid_in_every_variant() {
    let names: BTreeSet<String> = STAGES.iter().map(|stage| stage.name.to_owned()).collect();
    assert_eq!(files(), names, "files in shaders/ and stages differ");
    let mut variants = 0;
    for stage in STAGES {
        let (module, info) = checked(stage);
        for constants in stage.variants {
            let constants = constants.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
            let entry = Some((ShaderStage::Compute, stage.name));
            let (variant, _) = process_overrides(&module, &info, entry, &constants)
                .unwrap_or_else(|error| panic!("{} with {constants:?}: {error}", stage.name));
            Validator::new(ValidationFlags::all(), Capabilities::default())
                .validate(&variant)
                .unwrap_or_else(|error| panic!("{} with {constants:?}: {error:?}", stage.name));
            let entry = variant.entry_points.iter().find(|e| e.name == stage.name).expect("the stage's entry point");
            assert_eq!(entry.workgroup_size, [WORKGROUP_THREADS, 1, 1]);
            variants += 1;
        }
    }
    println!("{} shaders checked in {variants} variants, none skipped", STAGES.len());
    assert!(variants >= 2);
}

#[test]
fn bindings_stand_in_the_order_of_the_stage_and_fit_every_device() {
    for stage in STAGES {
        let (module, _) = checked(stage);
        let mut bound: Vec<(u32, &str, AddressSpace)> = module
            .global_variables
            .iter()
            .filter_map(|(_, v)| Some((v.binding?.binding, v.name.as_deref()?, v.space)))
            .collect();
        bound.sort_by_key(|b| b.0);
        let names: Vec<&str> = bound.iter().map(|b| b.1).collect();
        assert_eq!(names, stage.bindings, "{}", stage.name);
        assert!(bound.iter().enumerate().all(|(index, b)| b.0 == index as u32), "{}: a gap", stage.name);
        let storage = bound.iter().filter(|b| matches!(b.2, AddressSpace::Storage { .. })).count();
        assert!(storage <= 8, "{}: {storage} storage buffers; WebGPU promises 8", stage.name);
    }
}

/// Name, offset and size of every member of a Rust record.
macro_rules! layout {
    ($stage:literal, $home:ident::$record:ident { $($member:ident),* $(,)? }) => {{
        let record: $home::$record = bytemuck::Zeroable::zeroed();
        let members = vec![$((
            stringify!($member),
            offset_of!($home::$record, $member),
            size_of_val(&record.$member),
        )),*];
        ($stage, stringify!($record), members, size_of::<$home::$record>())
    }};
}

#[test]
fn records_have_the_same_members_on_both_sides() {
    let layouts = [
        layout!(0, records::Launch { rows, quads, threads_per_column }),
        layout!(0, records::FlankTile { first_column, column_count, first_record, record_count }),
        layout!(0, records::FlankColumn { offset_mm, normal, normal_change, low_mm, padding }),
        layout!(
            0,
            records::FlankPass {
                cos,
                sin,
                x_mm,
                y_mm,
                start_mm,
                y_from_mm,
                y_to_mm,
                pass_id,
                curve,
                curve_5,
                is_arc,
                padding_1,
                padding_2,
            }
        ),
        layout!(1, records::BlankLaunch { spacing_mm, units_per_mm, capacity, piece_room }),
        layout!(1, records::BlankTile { first_pass, pass_count, first_ray, ray_count }),
        layout!(1, records::BlankPass { first_part, part_count, pass_id, returns }),
        layout!(1, records::BlankPart { along, across, across_end_mm, padding_1, padding_2, padding_3 }),
        layout!(1, records::BlankSpan { low_mm, high_mm, low_pass, high_pass, low_normal, high_normal }),
        layout!(1, records::BlankPiece { span, ray, pass_id }),
        layout!(2, sweep_records::SpatialTile { middle, first_group, group_count, first_record, record_count }),
        layout!(
            2,
            sweep_records::SpatialPass {
                turn,
                place_3,
                radius_mm,
                twist_rad_per_mm,
                cos,
                sin,
                y_from_mm,
                y_to_mm,
                base_x_mm,
                base_y_mm,
                arc_excess_mm2,
                arc_half_curvature,
                cells_per_mm,
                cell_width_mm,
                first_cell,
                last_cell,
                base_cell,
                pass_id,
                t_from,
                t_to,
                unused,
            }
        ),
    ];
    for (stage, name, rust, size) in layouts {
        let stage: usize = stage;
        let (module, _) = checked(&STAGES[stage]);
        let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect(name);
        let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
        let wgsl: Vec<(&str, usize, usize)> = members
            .iter()
            .map(|m| {
                let size = module.types[m.ty].inner.size(module.to_ctx());
                (m.name.as_deref().unwrap_or(""), m.offset as usize, size as usize)
            })
            .collect();
        assert_eq!(wgsl, rust, "{name}");
        assert_eq!(*span as usize, size, "{name}");
        println!("{name}: {} members, {size} bytes", rust.len());
    }
}

#[test]
fn constants_agree() {
    let (module, _) = checked(&STAGES[0]);
    for (name, ours) in [("QUADS_PER_THREAD", QUADS_PER_THREAD), ("ROUND_RECORDS", ROUND_RECORDS)] {
        let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).expect(name);
        let naga::Expression::Literal(Literal::U32(theirs)) = module.global_expressions[constant.init] else {
            panic!("{name} is no literal")
        };
        assert_eq!(theirs, ours, "{name}");
    }
}

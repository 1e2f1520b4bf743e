//! The shaders as naga sees them: every file in every variant is valid, and both sides of the border agree.

use gearcut::gpu::shaders::{
    BLANK_RAYS, ROUND_RECORDS, Rows, STAGES, STORAGE_BUFFERS, Stage, WORKGROUP_THREADS, spatial_flank,
};
use gearcut::gpu::{blank_records, records, sweep_records};
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

/// The first stage of a name.
fn stage_of(name: &str) -> &'static Stage {
    STAGES.iter().find(|stage| stage.name == name).expect("a stage")
}

/// Text of every stage's file, found in the folder.
fn files() -> BTreeSet<String> {
    let folder = std::fs::read_dir("shaders").expect("the folder of shaders");
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
            let spatial = [Rows::Few, Rows::Many].into_iter().find(|&rows| *stage == spatial_flank(rows));
            let threads = spatial.map_or(WORKGROUP_THREADS, Rows::spatial_threads);
            assert_eq!(entry.workgroup_size, [threads, 1, 1], "{}", stage.name);
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
        assert!(storage <= STORAGE_BUFFERS as usize, "{}: {storage} storage buffers; WebGPU promises 8", stage.name);
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
        layout!(
            "planar_flank",
            records::FlankTile {
                first_column,
                column_count,
                first_record,
                record_count,
                first_quad,
                quads,
                rows,
                threads_per_column,
                first_phase,
                field,
            }
        ),
        layout!("planar_flank", records::FlankColumn { offset_mm, normal, normal_change, low_mm, padding }),
        layout!(
            "planar_flank",
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
        layout!(
            "flank_figures",
            records::FlankField { first_column, column_count, first_quad, quads, rows, profile_row }
        ),
        layout!(
            "flank_figures",
            records::FigureColumn {
                lowest_mm,
                lowest_row,
                reached_low_mm,
                reached_low_row,
                reached_high_mm,
                reached_high_row,
                untouched,
                at_bottom,
                stock_low_mm,
                stock_low_row,
                stock_high_mm,
                stock_high_row,
                stock_sum_mm,
                profile_mm,
                profile_pass,
            }
        ),
        layout!(
            "blank_rays",
            blank_records::BlankSpan { low_mm, high_mm, low_pass, high_pass, low_normal, high_normal }
        ),
        layout!("blank_rays", blank_records::BlankPiece { span, ray, pass_id }),
        layout!(
            "blank_rays",
            blank_records::BlankLaunch {
                rays,
                capacity,
                mm_per_unit,
                reach_mm,
                piece_room,
                padding_1,
                padding_2,
                padding_3,
            }
        ),
        layout!(
            "blank_rays",
            blank_records::BlankTile {
                first_visit,
                visit_count,
                first_ray,
                ray_count,
                family,
                units_per_mm,
                padding_1,
                padding_2,
            }
        ),
        layout!(
            "blank_rays",
            blank_records::BlankPass { cos, sin, center, first_piece, piece_count, pass_id, account }
        ),
        layout!("blank_rays", blank_records::OutlinePiece { node_mm, rate_start, rate_end, sagitta_mm, run }),
        layout!("blank_rays", blank_records::RayState { place, count, first }),
        layout!(
            "spatial_flank",
            sweep_records::SpatialTile {
                middle,
                first_group,
                group_count,
                first_visit,
                visit_count,
                first_record,
                field,
                rows,
                unused,
            }
        ),
        layout!(
            "spatial_flank",
            sweep_records::SpatialPass {
                turn,
                place_3,
                curve,
                radius_mm,
                twist_rad_per_mm,
                cos,
                sin,
                y_from_mm,
                y_to_mm,
                curve_5,
                is_arc,
                pass_id,
                t_from,
                t_to,
                unused,
            }
        ),
    ];
    for (stage, name, rust, size) in layouts {
        let (module, _) = checked(stage_of(stage));
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
    for (stage, name, ours) in [
        (BLANK_RAYS, "LEDGER_HEAD", blank_records::LEDGER_HEAD as u32),
        (BLANK_RAYS, "NO_ROOM", blank_records::NO_ROOM),
        (BLANK_RAYS, "NO_ACCOUNT", blank_records::NO_ACCOUNT),
        (spatial_flank(Rows::Few), "ROUND_RECORDS", ROUND_RECORDS),
    ] {
        let (module, _) = checked(&stage);
        let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).expect(name);
        let naga::Expression::Literal(Literal::U32(theirs)) = module.global_expressions[constant.init] else {
            panic!("{name} is no literal")
        };
        assert_eq!(theirs, ours, "{name}");
    }
}

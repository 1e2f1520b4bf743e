//! Sections that every process fills with its own: what cuts, the machine around the cut, and the operations.

use super::{Default, Group, Key, KeySection, Kind, Range, Role};

/// `[tool]`, `[machine]` and `[[operation]]`, with what all processes read of them.
pub(super) static SECTIONS: &[KeySection] = &[
    KeySection::new("tool", Role::Choice { default: None, what: "tool" }, &[], "What cuts."),
    KeySection { path: "machine", role: Role::Plain, keys: &[], groups: &[], teach: "The machine around the cut." },
    KeySection {
        path: "operation[]",
        role: Role::List { fewest: 1 },
        keys: &[
            Key {
                name: "name",
                kind: Kind::Name,
                unit: "",
                default: Default::Derived("operation_1, operation_2, ..."),
                example: "\"finish\"",
                teach: "Name of the operation, unique in the scene; folders of the output carry it.",
            },
            Key {
                name: "offset_mm",
                kind: Kind::Number(Range::closed(-5.0, 100.0)),
                unit: "mm",
                default: Default::Number(0.0),
                example: "0.0",
                teach: "delta_d: how far the tool stays back, along the direction that the linkage gives; 0 cuts to \
                    depth.",
            },
            Key::optional(
                "stock_per_flank_mm",
                "mm",
                Range::closed(-2.0, 30.0),
                "offset_mm holds",
                "0.2",
                "Stock to leave on each flank, normal to it. The offset is stock / sin(pressure angle): exact of the \
                    straight flanks of racks and hobs. In shaping it is that of a mesh without backlash from the \
                    depth of the last operation on: exact on round gears, rings and helical ones; on other gears, \
                    and with drawn teeth, it is stock / sin(working pressure angle of the round gear with as many \
                    teeth), which leaves some per cent more, more where the gear is curved more.",
            ),
            Key {
                name: "program",
                kind: Kind::Path,
                unit: "",
                default: Default::LeftOut("the linkage moves the axes"),
                example: "\"finish.ngc\"",
                teach: "Axis program (G-code, relative to the scene file) that is cut instead of the linkage's own \
                    positions; the linkage remains the target, so that maps show what the program does wrong. Hobbing \
                    reads the fully interpolated form.",
            },
        ],
        groups: &[Group { names: &["offset_mm", "stock_per_flank_mm"], required: false }],
        teach: "One run of the cutter over the work. Operations are cut in the order written; the last one is the \
            finishing cut and defines the target flanks. A scene without any finishes; one for shaping roughs before.",
    },
];

//! The kernels of gearcut in WGSL: what a program needs to run them, and nothing else.
//!
//! In: nothing. Out: for every [`Stage`] its text, its bindings in order, and the constants of each variant; the sizes
//! that both sides must agree on. What the bindings hold, byte for byte, is written in the shaders (`shared/`); the
//! crate `gearcut-gpu` has the same records in Rust, and a test compares the two.
//!
//! A stage's text is its file after the shared ones, joined as they are: no preprocessor stands between the files and
//! what the driver sees. Variants are `override` constants.

/// Threads of a workgroup: at least one wave on every GPU, and small enough for any.
pub const WORKGROUP_THREADS: u32 = 64;
/// Threads of the largest workgroup of any stage.
pub const LARGEST_WORKGROUP: u32 = 128;
/// Records of a tile in one launch at most: each takes up to 34 iterations of a thread's loops, of which llvmpipe ends
/// all after 65,535 without a word. Candidates are a few dozen; a tile with more goes through in rounds.
pub const ROUND_RECORDS: u32 = 1024;
/// Storage buffers that a stage binds at most: what WebGPU promises on every device.
pub const STORAGE_BUFFERS: u32 = 8;

/// How many rows of a flank a thread cuts. On a software adapter many rows hide the latency of divisions; on a GPU
/// other waves do, as long as a thread takes few registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rows {
    /// Few: a GPU.
    Few,
    /// Many: a software adapter.
    Many,
}

impl Rows {
    /// Quads of rows that one thread of the planar kernel cuts.
    pub const fn quads_per_thread(self) -> usize {
        match self {
            Self::Few => 1,
            Self::Many => 2,
        }
    }

    /// Rows that one thread of the spatial kernel cuts, as its lanes.
    pub const fn lanes(self) -> usize {
        match self {
            Self::Few => 1,
            Self::Many => 4,
        }
    }

    /// Threads of a workgroup of the spatial kernel: those of a patch's cell on a GPU; of a tile's cell where a workgroup
    /// that is not full takes as long as a full one.
    pub const fn spatial_threads(self) -> u32 {
        match self {
            Self::Few => LARGEST_WORKGROUP,
            Self::Many => 8,
        }
    }

    /// Threads of the planar kernel that share the rows of one column.
    pub fn threads_per_column(self, rows: usize) -> usize {
        rows.div_ceil(QUAD_ROWS).div_ceil(self.quads_per_thread())
    }
}

/// A stage: one shader file, one entry point of the same name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Name of the file, the entry point, the label and the row in the timings.
    pub name: &'static str,
    /// Whole text.
    pub text: &'static str,
    /// Its bindings in order, by the names that they have there.
    pub bindings: &'static [&'static str],
    /// Constants of every variant that is used.
    pub variants: &'static [&'static [(&'static str, f64)]],
}

/// Variants of the planar kernel: strokes that move or rest, edges with or without arcs.
macro_rules! planar_variants {
    ($quads:expr) => {
        &[
            &[("QUADS_PER_THREAD", $quads), ("FROZEN", 0.0), ("ARCS", 0.0)],
            &[("QUADS_PER_THREAD", $quads), ("FROZEN", 0.0), ("ARCS", 1.0)],
            &[("QUADS_PER_THREAD", $quads), ("FROZEN", 1.0), ("ARCS", 0.0)],
            &[("QUADS_PER_THREAD", $quads), ("FROZEN", 1.0), ("ARCS", 1.0)],
        ]
    };
}

/// The planar kernel: strokes that move or rest, edges with or without arcs; [`planar_variant`] finds the one that
/// serves.
pub const fn planar_flank(rows: Rows) -> Stage {
    Stage {
        name: "planar_flank",
        text: concat!(
            include_str!("../shared/records.wgsl"),
            include_str!("../shared/entry.wgsl"),
            include_str!("../planar_flank.wgsl"),
        ),
        bindings: &["tiles", "columns", "records", "row_phases", "heights_mm", "passes", "counts"],
        variants: match rows {
            Rows::Few => planar_variants!(1.0),
            Rows::Many => planar_variants!(2.0),
        },
    }
}

/// Dexels of fields that are uncut.
pub const PLANAR_UNCUT: Stage = Stage {
    name: "planar_uncut",
    text: concat!(include_str!("../shared/field_records.wgsl"), include_str!("../planar_uncut.wgsl")),
    bindings: &["fields", "blank_mm", "heights_mm", "passes"],
    variants: &[&[]],
};

/// Figures of the columns of fields.
pub const FLANK_FIGURES: Stage = Stage {
    name: "flank_figures",
    text: concat!(
        include_str!("../shared/field_records.wgsl"),
        include_str!("../shared/figure_records.wgsl"),
        include_str!("../flank_figures.wgsl"),
    ),
    bindings: &["fields", "low_mm", "heights_mm", "passes", "last_heights_mm", "last_passes", "figures"],
    variants: &[&[]],
};

/// Place in the variants of [`planar_flank`].
pub fn planar_variant(frozen: bool, arcs: bool) -> usize {
    2 * usize::from(frozen) + usize::from(arcs)
}

/// Rays through the blank, cut by closed outlines: strokes, and sections of sweeps.
pub const BLANK_RAYS: Stage = Stage {
    name: "blank_rays",
    text: concat!(
        include_str!("../shared/span_records.wgsl"),
        include_str!("../shared/blank_records.wgsl"),
        include_str!("../shared/blank_spans.wgsl"),
        include_str!("../blank_rays.wgsl"),
    ),
    bindings: &["launch", "tiles", "visits", "passes", "outline", "spans", "rays", "ledger", "pieces"],
    variants: &[&[]],
};

/// Lists of spans to the kernel's order, and back.
pub const BLANK_LISTS: Stage = Stage {
    name: "blank_lists",
    text: concat!(
        include_str!("../shared/span_records.wgsl"),
        include_str!("../shared/blank_records.wgsl"),
        include_str!("../blank_lists.wgsl"),
    ),
    bindings: &["launch", "spans", "rays", "packed", "ledger"],
    variants: &[&[("BACK", 0.0)], &[("BACK", 1.0)]],
};

/// The spatial kernel: rake faces that are planes, and helical ones; on GPUs with records that the host has listed, and
/// with those of patches, whose cells it searches. [`spatial_variant`] finds the one that serves.
pub const fn spatial_flank(rows: Rows) -> Stage {
    Stage {
        name: "spatial_flank",
        text: match rows {
            Rows::Few => concat!(
                include_str!("../shared/sweep_records.wgsl"),
                include_str!("../shared/lanes_1.wgsl"),
                include_str!("../shared/sweep_entry.wgsl"),
                include_str!("../shared/visits_searched.wgsl"),
                include_str!("../spatial_flank.wgsl"),
            ),
            Rows::Many => concat!(
                include_str!("../shared/sweep_records.wgsl"),
                include_str!("../shared/lanes_4.wgsl"),
                include_str!("../shared/sweep_entry.wgsl"),
                include_str!("../shared/visits_listed.wgsl"),
                include_str!("../spatial_flank.wgsl"),
            ),
        },
        bindings: &["tiles", "visits", "records", "rays", "heights_mm", "passes", "counts"],
        variants: match rows {
            Rows::Few => &[
                &[("SEARCHED", 0.0), ("TWISTED", 0.0)],
                &[("SEARCHED", 0.0), ("TWISTED", 1.0)],
                &[("SEARCHED", 1.0), ("TWISTED", 0.0)],
                &[("SEARCHED", 1.0), ("TWISTED", 1.0)],
            ],
            Rows::Many => &[&[("TWISTED", 0.0)], &[("TWISTED", 1.0)]],
        },
    }
}

/// Place in the variants of [`spatial_flank`]; software adapters search nothing.
pub fn spatial_variant(searched: bool, twisted: bool) -> usize {
    2 * usize::from(searched) + usize::from(twisted)
}

/// All stages.
pub const STAGES: &[Stage] = &[
    planar_flank(Rows::Many),
    planar_flank(Rows::Few),
    PLANAR_UNCUT,
    FLANK_FIGURES,
    spatial_flank(Rows::Many),
    spatial_flank(Rows::Few),
    BLANK_RAYS,
    BLANK_LISTS,
];

/// Rows of a quad, the lanes of the planar kernel's vectors.
pub const QUAD_ROWS: usize = 4;

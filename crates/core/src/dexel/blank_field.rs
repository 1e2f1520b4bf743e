//! The blank field: two families of rays through the whole blank, in transverse slices.
//!
//! In: the blank, its face width, a spacing. Out: for every ray the spans of material. Rays of family X run
//! along x and stand side by side in y, those of family Y the other way round; the rays of both families meet in the
//! nodes of one square grid, the same in all slices. Family X decides what is inside; family Y supplies crossings in
//! its own direction, so that no face of the work is seen only by rays that graze it.
//!
//! **Slices.** With the axes at rest during the strokes, the cutter's pose does not depend on the place along the
//! tooth: all transverse sections of the work are equal, and **one** slice stands for the whole face. Only where the
//! feed runs on during a stroke are there several, both end faces among them; between two slices the surface runs
//! straight.
//!
//! Nothing has a fixed capacity: lists grow. What a field will need is estimated beforehand, and one that does not fit
//! is refused with a spacing that does.

use super::intervals::{self, End, Span};
use crate::error::Refusal;
use crate::gear::GearKind;
use crate::gear::blank::Blank;
use crate::gear::blank_outline::BlankOutline;
use crate::math::planar_rays::{FAMILIES, Family, RayCrossings, RayRow};
use crate::parameter;
use glam::DVec2;

/// Largest field: 2 GB leave room for everything else on an ordinary machine.
pub const MOST_BYTES: f64 = 2e9;
/// Material on one ray.
pub type RayMaterial = Vec<Span>;

/// Where the rays stand.
#[derive(Debug, Clone, PartialEq)]
pub struct BlankGrid {
    /// Rays of family X (side by side in y) and of family Y (side by side in x).
    pub rows: [RayRow; 2],
    /// Places of the slices along the tooth from the middle of the face, mm, increasing; a single one stands for the
    /// whole face.
    pub slices_z_mm: Vec<f64>,
    /// Face width, mm.
    pub face_width_mm: f64,
}

/// All rays of one slice.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Rays of family X, then of family Y.
    pub rays: [Vec<RayMaterial>; 2],
}

/// Rays through the whole blank with what is left on them.
#[derive(Debug, Clone, PartialEq)]
pub struct BlankField {
    /// Where the rays stand.
    pub grid: BlankGrid,
    /// Slices in the order of [`BlankGrid::slices_z_mm`].
    pub slices: Vec<Slice>,
}

impl BlankGrid {
    /// Grid over a blank: nodes at odd half spacings from the gear axis, so that it is symmetric and none lies on the
    /// axis.
    ///
    /// `slice_spacing_mm` is the largest distance of slices, or `None` where all sections are equal.
    ///
    /// # Errors
    /// More memory than [`MOST_BYTES`], with the need and a spacing that fits.
    pub fn new(
        blank: &Blank,
        outline: &BlankOutline,
        face_width_mm: f64,
        spacing_mm: f64,
        slice_spacing_mm: Option<f64>,
    ) -> Result<Self, Refusal> {
        let [low, high] = outline.bounds_mm();
        let intervals = slice_spacing_mm.map(|s| (face_width_mm / s).ceil().max(1.0));
        let slices = intervals.map_or(1.0, |n| n + 1.0);
        let need = |spacing_mm: f64| slices * section_bytes(blank, high - low, spacing_mm);
        if need(spacing_mm) > MOST_BYTES {
            // The need falls with the spacing, a little slower than its inverse.
            let mut fits_mm = spacing_mm * need(spacing_mm) / MOST_BYTES;
            while need(fits_mm) > MOST_BYTES {
                fits_mm *= 1.05;
            }
            return Err(Refusal::new(
                parameter::RAY_SPACING,
                format!(
                    "the blank field at {spacing_mm} mm in {slices} slices needs about {:.2e} bytes; at most \
                    {MOST_BYTES:.0e} are taken",
                    need(spacing_mm)
                ),
                format!("put rays {:.4} mm apart or more, or slices further apart", (1e4 * fits_mm).ceil() * 1e-4),
            ));
        }
        let row = |from: f64, to: f64| {
            // One ray beyond the blank on either side: surfaces have grid all round them.
            let first = (from / spacing_mm - 0.5).floor() - 1.0;
            let last = (to / spacing_mm - 0.5).ceil() + 1.0;
            RayRow { first_mm: (first + 0.5) * spacing_mm, spacing_mm, count: (last - first) as usize + 1 }
        };
        let slices_z_mm = match intervals {
            None => vec![0.0],
            Some(n) => (0..=n as usize).map(|i| face_width_mm * (i as f64 / n - 0.5)).collect(),
        };
        Ok(Self { rows: [row(low.y, high.y), row(low.x, high.x)], slices_z_mm, face_width_mm })
    }

    /// Distance of neighbouring rays, mm.
    pub fn spacing_mm(&self) -> f64 {
        self.rows[0].spacing_mm
    }

    /// Distance of neighbouring slices, mm; the face's width where a single one stands for it.
    pub fn slice_spacing_mm(&self) -> f64 {
        self.slices_z_mm.get(1).map_or(self.face_width_mm, |second| second - self.slices_z_mm[0])
    }

    /// What all its slices are estimated to need once teeth are cut, bytes.
    pub fn estimated_bytes(&self, blank: &Blank) -> f64 {
        let [x, y] = [1, 0].map(|f: usize| self.rows[f].spacing_mm * self.rows[f].count as f64);
        self.slices_z_mm.len() as f64 * section_bytes(blank, DVec2::new(x, y), self.spacing_mm())
    }

    /// Share of the face that each slice stands for, mm: the trapezoidal rule.
    pub fn slice_widths_mm(&self) -> Vec<f64> {
        let z_mm = &self.slices_z_mm;
        if z_mm.len() == 1 {
            return vec![self.face_width_mm];
        }
        (0..z_mm.len()).map(|i| 0.5 * (z_mm[(i + 1).min(z_mm.len() - 1)] - z_mm[i.saturating_sub(1)])).collect()
    }
}

/// Bytes of one slice: spans of both families, twice the length of an outline with teeth all round, and the lists'
/// heads.
fn section_bytes(blank: &Blank, size: DVec2, spacing_mm: f64) -> f64 {
    let rays = (size.x + size.y) / spacing_mm;
    // Every tooth adds its two flanks to the outline; rays cross a closed curve twice per span, and lists grow in steps
    // of two.
    let outline_mm = blank.curve().perimeter_mm() * (1.0 + 2.0 * 4.5 / std::f64::consts::PI);
    let spans = 2.0 * rays + 2.0 * outline_mm / spacing_mm;
    2.0 * spans * size_of::<Span>() as f64 + rays * size_of::<RayMaterial>() as f64
}

impl BlankField {
    /// The uncut blank.
    pub fn new(grid: BlankGrid, outline: &BlankOutline) -> Self {
        let rays = [0, 1].map(|f| blank_rays(outline, FAMILIES[f], &grid.rows[f]));
        let slices = vec![Slice { rays }; grid.slices_z_mm.len()];
        Self { grid, slices }
    }

    /// Area of every section by each family, mm2: lengths times spacing.
    pub fn areas_mm2(&self) -> Vec<[f64; 2]> {
        let area = |rays: &Vec<RayMaterial>| rays.iter().map(|ray| intervals::length_mm(ray)).sum::<f64>();
        let spacing = self.grid.spacing_mm();
        self.slices.iter().map(|s| [area(&s.rays[0]) * spacing, area(&s.rays[1]) * spacing]).collect()
    }

    /// Volume by each family, mm3.
    pub fn volumes_mm3(&self) -> [f64; 2] {
        let widths = self.grid.slice_widths_mm();
        let sections = self.areas_mm2();
        [0, 1].map(|f| sections.iter().zip(&widths).map(|(area, width)| area[f] * width).sum())
    }

    /// Number of spans on all rays.
    pub fn spans(&self) -> usize {
        self.slices.iter().flat_map(|s| &s.rays).flatten().map(Vec::len).sum()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let lists = self.slices.iter().flat_map(|s| &s.rays).flatten();
        lists.map(|ray| ray.capacity() * size_of::<Span>() + size_of::<RayMaterial>()).sum()
    }
}

/// Material of the uncut stock: what the outline encloses less the bore, or the ring's disc less what the outline
/// encloses.
fn blank_rays(outline: &BlankOutline, family: Family, row: &RayRow) -> Vec<RayMaterial> {
    let mut crossings = RayCrossings::default();
    crossings.lay(outline, family, row, 0..row.count);
    let back = outline.back();
    let mut found = Vec::new();
    (0..row.count)
        .map(|ray| {
            let at_mm = row.at_mm(ray);
            crossings.solve(outline, family, ray, at_mm, &mut found);
            let enclosed = found.as_chunks::<2>().0.iter();
            let half_mm = back.half_chord_mm(at_mm);
            // A bore's surface faces the axis, a rim's looks away from it.
            let on_back =
                |along: f64| End::of_blank(along, -back.kind.tip_sign() * family.point(along, at_mm) / back.radius_mm);
            match back.kind {
                GearKind::External => {
                    let mut spans: RayMaterial = enclosed
                        .map(|[a, b]| Span {
                            low: End::of_blank(a.at_mm, a.outward()),
                            high: End::of_blank(b.at_mm, b.outward()),
                        })
                        .collect();
                    if half_mm > 0.0 {
                        intervals::subtract(&mut spans, on_back(-half_mm), on_back(half_mm));
                    }
                    spans
                }
                GearKind::Internal if half_mm > 0.0 => {
                    let mut spans = vec![Span { low: on_back(-half_mm), high: on_back(half_mm) }];
                    for [a, b] in enclosed {
                        let [from, to] = [a, b].map(|crossing| End::of_blank(crossing.at_mm, -crossing.outward()));
                        intervals::subtract(&mut spans, from, to);
                    }
                    spans
                }
                GearKind::Internal => Vec::new(),
            }
        })
        .collect()
}

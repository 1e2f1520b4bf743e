//! What is left on rays as the kernel reads and writes it: lists of spans in f32, normals in the frame of their rays.

use crate::blank_records::{BlankSpan, RayState};
use crate::problem::GpuProblem;
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::dexel::intervals::{End, Span};
use gearcut_core::math::planar_rays::Family;
use std::ops::Range;

/// Lists of spans, one after the other.
#[derive(Default)]
pub struct PackedRays {
    /// Rays, with the places of their lists.
    pub rays: Vec<RayState>,
    /// Spans of all rays.
    pub spans: Vec<BlankSpan>,
}

impl PackedRays {
    /// Adds what is left on a ray that stands at a place, units.
    pub fn push(&mut self, ray: &RayMaterial, family: Family, place: i32) {
        self.rays.push(RayState { place, count: ray.len() as u32, first: self.spans.len() as u32 });
        self.spans.extend(ray.iter().map(|span| to_record(span, family)));
    }

    /// Some of the rays, as they were added.
    pub fn part(&self, rays: Range<usize>) -> Self {
        let rays = &self.rays[rays];
        let first = rays.first().map_or(0, |ray| ray.first);
        let spans: u32 = rays.iter().map(|ray| ray.count).sum();
        Self {
            rays: rays.iter().map(|ray| RayState { first: ray.first - first, ..*ray }).collect(),
            spans: self.spans[first as usize..(first + spans) as usize].to_vec(),
        }
    }

    /// Spans of the longest list.
    pub fn longest(&self) -> usize {
        self.rays.iter().map(|ray| ray.count).max().unwrap_or(0) as usize
    }

    /// What is left on a ray.
    pub fn list(&self, ray: usize, family: Family) -> Result<RayMaterial, GpuProblem> {
        let RayState { first, count, .. } = self.rays[ray];
        let list = self.spans.get(first as usize..).and_then(|rest| rest.get(..count as usize));
        let list = list.ok_or_else(|| GpuProblem::Invalid {
            reason: format!("a ray of {count} spans from {first} on, of {}", self.spans.len()),
        })?;
        Ok(list.iter().map(|span| from_record(span, family)).collect())
    }
}

/// Components of a normal along and across the rays, as the kernel has them. Seen along and across them, rays along y
/// are a mirror image: there the kernel's normals point the other way.
fn turned(normal: [f32; 2], family: Family) -> [f32; 2] {
    match family {
        Family::X => normal,
        Family::Y => [-normal[1], -normal[0]],
    }
}

/// A span for the kernel.
fn to_record(span: &Span, family: Family) -> BlankSpan {
    BlankSpan {
        low_mm: span.low.at_mm as f32,
        high_mm: span.high.at_mm as f32,
        low_pass: span.low.pass,
        high_pass: span.high.pass,
        low_normal: turned(span.low.normal, family),
        high_normal: turned(span.high.normal, family),
    }
}

/// A span from the kernel.
pub fn from_record(span: &BlankSpan, family: Family) -> Span {
    let end = |at: f32, pass, normal| End { at_mm: f64::from(at), pass, normal: turned(normal, family) };
    Span {
        low: end(span.low_mm, span.low_pass, span.low_normal),
        high: end(span.high_mm, span.high_pass, span.high_normal),
    }
}

//! What is left on a ray as the kernel reads and writes it: spans in f32, normals in the frame of their rays.

use crate::records::BlankSpan;
use gearcut_core::dexel::intervals::{End, Span};
use gearcut_core::math::planar_rays::Family;

/// Components of a normal along and across the rays, as the kernel has them. Seen along and across them, rays along y
/// are a mirror image: there the kernel's normals point the other way.
fn turned(normal: [f32; 2], family: Family) -> [f32; 2] {
    match family {
        Family::X => normal,
        Family::Y => [-normal[1], -normal[0]],
    }
}

/// A span for the kernel.
pub fn to_record(span: &Span, family: Family) -> BlankSpan {
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

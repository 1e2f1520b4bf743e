//! The ground that gearcut stands on: from pitch curves and cutting edges to dexels that passes are subtracted from.
//!
//! In: a pitch curve, a tool with its blades, poses of the tool over time. Out: what is left on every dexel, and the
//! pass that left it. Nothing here knows files, scenes or the commands of a process of manufacture.
//!
//! The modules, from the ground up; each uses only those above it in this list:
//!
//! - [`terms`]: words of gear geometry: side of a tooth, hand of a helix
//! - [`units`]: factors between units
//! - [`frame`]: rigid motions in the plane and in space
//! - [`error`]: errors as values, with a way out
//! - [`parameter`]: names of what refusals blame
//! - [`math`]: Taylor series, roots, extrema, integrals, splines, rays against closed curves
//! - [`gear`]: the pitch curve, and the blank before cutting
//! - [`tool`]: cutting edges, and where the blades of a tool are
//! - [`dexel`]: rays with the material that is left on them
//! - [`passes`]: one blade's trip through the work, and which passes can matter to which dexels
//! - [`cut`]: backends, and the native one
//! - [`bevel`]: spiral bevel gears: blank, face-mill head, machines and the flank that they generate
//!
//! Lengths are in mm and angles in rad, in names as in values; points and directions say which frame they are in.
//!
//! # The law
//!
//! A field of dexels, passes of a blade, a cut, heights: a round blade of 5 mm makes eleven strokes 0.4 mm apart along
//! a plane. Between strokes scallops are left, f^2 / (8 R) high in the middle.
//!
//! ```
//! use gearcut_core::cut::{Backend, cpu::Cpu};
//! use gearcut_core::dexel::{Column, Field};
//! use gearcut_core::frame::Rigid2;
//! use gearcut_core::passes::CutPlan;
//! use gearcut_core::passes::planar::strokes::{StrokeLaw, StrokeSet};
//! use gearcut_core::tool::blade_edges::BladeEdges;
//! use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
//! use gearcut_core::tool::{CuttingTool, PlanarTool};
//! use glam::DVec2;
//! use std::f64::consts::FRAC_PI_2;
//!
//! /// One blade, an arc round the tool's axis that looks down.
//! struct RoundBlade(BladeEdges);
//!
//! impl CuttingTool for RoundBlade {
//!     fn blade_count(&self) -> u32 {
//!         1
//!     }
//!     fn edges(&self) -> &BladeEdges {
//!         &self.0
//!     }
//! }
//!
//! impl PlanarTool for RoundBlade {
//!     fn tool_from_blade(&self, _: u32) -> Rigid2 {
//!         Rigid2::new(0.0, DVec2::ZERO)
//!     }
//! }
//!
//! let (radius_mm, feed_mm) = (5.0, 0.4);
//! let angles_rad = [-FRAC_PI_2 - 0.8, -FRAC_PI_2 + 0.8];
//! let arc = Segment::arc(SegmentName::Tip, DVec2::ZERO, radius_mm, angles_rad);
//! let tool = RoundBlade(BladeEdges::shared(Edge::new(vec![arc])));
//!
//! // Rays of 1 mm stock up from the plane, 0.01 mm apart; each may record 0.1 mm below it.
//! let ray = |i: u32| Column {
//!     arc_mm: 0.01 * f64::from(i),
//!     origin_mm: DVec2::new(0.01 * f64::from(i), 0.0),
//!     normal: DVec2::Y,
//!     low_mm: -0.1,
//!     blank_mm: 1.0,
//! };
//! let field = Field { columns: (0..=400).map(ray).collect(), rows_z_mm: vec![0.0] };
//!
//! // Stroke k touches the plane at k times the feed.
//! let place = |stroke: f64| Rigid2::new(0.0, DVec2::new(feed_mm * stroke, radius_mm));
//! let strokes = StrokeSet::new(0, &tool, StrokeLaw::Frozen, 11, place);
//! let mut left = field.blank_layer();
//! Cpu::default().cut(&field, &CutPlan::new(&field, &strokes, &tool), &mut left)?;
//!
//! for (i, (&height_mm, &pass)) in left.heights_mm.iter().zip(&left.passes).enumerate() {
//!     let from_stroke_mm = 0.01 * i as f64 - feed_mm * f64::from(pass);
//!     let circle_mm = radius_mm - (radius_mm * radius_mm - from_stroke_mm * from_stroke_mm).sqrt();
//!     assert!((f64::from(height_mm) - circle_mm).abs() < 1e-7);
//! }
//! let highest_mm = left.heights_mm.iter().copied().fold(0.0_f32, f32::max);
//! assert!((f64::from(highest_mm) / (feed_mm * feed_mm / (8.0 * radius_mm)) - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Curves and edges
//!
//! The pitch curve of an elliptical gear of third order, and the place at which a ray enters a cutter tooth.
//!
//! ```
//! use gearcut_core::gear::{PitchCurve, PitchCurveShape};
//! use gearcut_core::tool::edge::{Edge, Segment, SegmentName};
//! use gearcut_core::tool::edge_table::TABLE_TOLERANCE_MM;
//! use gearcut_core::tool::involute::Involute;
//! use std::f64::consts::PI;
//!
//! // Module 3 mm, 42 teeth: the semi-major axis is left out, and follows from the perimeter.
//! let shape = PitchCurveShape::Ellipse { order: 3, eccentricity: 0.1348, semi_major_axis_mm: None };
//! let curve = PitchCurve::new(&shape, 3.0, 42)?;
//! assert!((curve.perimeter_mm() - PI * 3.0 * 42.0).abs() < 1e-9);
//! assert!((curve.size_mm() - 61.110_009_074).abs() < 1e-8);
//!
//! // The point at a polar angle of 60 degrees, in the gear frame. The curve is slightly hollow there.
//! let place = curve.frame(60_f64.to_radians());
//! assert!((place.radius_mm - 61.110_009_074 * (1.0 - 0.1348)).abs() < 1e-8);
//! assert!((place.point_mm.x - 0.5 * place.radius_mm).abs() < 1e-9);
//! assert!((1.0 / place.curvature_per_mm + 765.3).abs() < 0.1);
//!
//! // The left flank of a cutter tooth: an involute on a base circle of 28.19 mm radius, in the blade frame.
//! let involute = Involute { base_radius_mm: 28.19, half_angle_rad: 0.09, side: 1.0 };
//! let edge = Edge::new(vec![Segment::involute(SegmentName::FlankLeft, involute, [0.2, 0.5])?]);
//!
//! // A ray against the flank's normal, from 0.1 mm outside, enters the tooth after 0.1 mm.
//! let (roll, gap_mm) = (0.35, 0.1);
//! let segment = &edge.segments[0];
//! let segment_from_blade = segment.blade_from_segment.inverse();
//! let origin_mm = segment_from_blade.point(involute.point(roll) + gap_mm * involute.normal(roll));
//! let hit = segment.enter(origin_mm, segment_from_blade.direction(-involute.normal(roll))).expect("it enters");
//! assert!((hit.height_mm - gap_mm).abs() < TABLE_TOLERANCE_MM);
//! assert!((hit.curvature_per_mm * 28.19 * roll - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bevel;
pub mod cut;
pub mod dexel;
pub mod error;
pub mod frame;
pub mod gear;
pub mod math;
pub mod parameter;
pub mod passes;
pub mod terms;
pub mod tool;
pub mod units;

pub use error::{Error, Refusal, Result};

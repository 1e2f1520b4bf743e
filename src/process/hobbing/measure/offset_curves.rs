//! Tooth profiles as Liu et al. (2015, section 6.2) measured them: points in which five curves beside the pitch curve
//! cross every flank, as cut against as meant.
//!
//! In: the hobbing job, a backend, flanks. Out: per flank five [`CurvePoint`]s in the middle of the face, and over all
//! of them the frequencies of their errors with the fitted normal distribution.
//!
//! The curves run along the pitch curve at constant distances, at 3 and 6 mm to both sides on the paper's gear of
//! module 8; here at the same shares of the normal module, or lower where the tooth is lower ([`offsets_mm`]): a ray
//! along a curve beside the tooth meets what hob teeth leave elsewhere. Where the tip corner has undercut a flank, the
//! target is the corner's own path (`RackGeneration::crossing`): 20 of the paper's 350 points lie there.
//!
//! **As cut.** A ray along the curve's tangent, out of the tooth, through the target's point is cut by all passes,
//! moved to where the surface was found, and cut again if that was far, as the crossings of shaped flanks are found.
//! The rays share nothing with those of the maps, which stand along the flanks' normals.
//!
//! The paper measured with a coordinate measuring machine and found a spread of 38 um; what is found here is what the
//! process alone leaves: feed and generating marks.

use crate::measure::crossing::Crossing;
use crate::process::hobbing::rack_generation::{ProfileCrossing, ProfilePart};
use crate::process::hobbing::{HobCutter, HobbingJob};
use gearcut_core::cut::{Backend, CutLayers};
use gearcut_core::dexel::{Layer, NO_PASS, Ray, SpatialField};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Distance of the outermost curves from the pitch curve, normal modules.
const REACH_MODULES: f64 = 0.75;
/// Share of the tooth's height over the pitch curve, and of its depth under it, that the curves reach at most: the rest
/// keeps rays clear of the tip land and of the bottom of the root, which they would graze.
const REACH_SHARE: f64 = 0.85;
/// Places of the curves as shares of the reach on their side of the pitch curve.
const SHARES: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// A ray along the tangent leaves its curve by d^2 / (2 rho). Where the surface was found so far away that this is
/// more, mm, it is cut again there.
const BEND_MM: f64 = 1e-6;
/// Rounds at most: each leaves the square of the distance before it, so that more lead nowhere.
const ROUNDS: u32 = 4;
/// How far below the target a ray records cuts, modules.
const DEPTH_MODULES: f64 = 0.5;
/// Intervals of a histogram to either side of the middle one, at most: the last ones hold all that lies beyond.
const MOST_INTERVALS: usize = 20;

/// Where one curve crosses one flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Distance of the curve from the pitch curve, mm, positive outwards.
    pub offset_mm: f64,
    /// Where the target crosses it.
    pub target: ProfileCrossing,
    /// Where the surface as cut crosses it, gear frame, mm; `None` where no pass came near, or it is so far off that no
    /// ray leads to it.
    pub cut_mm: Option<DVec2>,
    /// Distance along the curve from the target to the surface, mm, positive where material is left.
    pub along_mm: Option<f64>,
}

impl CurvePoint {
    /// Error in x and y, gear frame, mm.
    pub fn error_mm(&self) -> Option<DVec2> {
        self.cut_mm.map(|cut| cut - self.target.point_mm)
    }

    /// Whether the target's point lies on the fillet.
    pub fn on_fillet(&self) -> bool {
        self.target.part == ProfilePart::Fillet
    }
}

/// Distances of the curves from the pitch curve that lie between the target's root and its tip, mm, positive outwards;
/// five but where the tooth lies on one side of its pitch curve.
pub fn offsets_mm(job: &HobbingJob) -> Vec<f64> {
    let [depth_mm, height_mm] = [job.target.rack.tip_height_mm, job.blank.addendum_mm];
    let reach_mm = |room_mm: f64| (REACH_MODULES * job.scene.gear.module_mm).min(REACH_SHARE * room_mm);
    let offset_mm = |share: f64| share * reach_mm(if share < 0.0 { depth_mm } else { height_mm });
    SHARES.into_iter().map(offset_mm).filter(|&mm| -depth_mm < mm && mm < height_mm).collect()
}

/// Points of some flanks, cut together; curves that do not cross a flank are left out. A point that is still far from
/// its ray after all rounds has no value: a flank as wrong as that does not cross the curve there.
///
/// # Errors
/// The backend's.
pub fn measure(cutter: &HobCutter, backend: &dyn Backend, flanks: &[(u32, Side)]) -> Result<Vec<Vec<CurvePoint>>> {
    let mut flanks: Vec<OpenPoints> =
        flanks.par_iter().map(|&(tooth, side)| OpenPoints::new(cutter, tooth, side)).collect();
    for _ in 0..ROUNDS {
        let mut open: Vec<&mut OpenPoints> = flanks.iter_mut().filter(|flank| !flank.open.is_empty()).collect();
        if open.is_empty() {
            break;
        }
        let cut: Vec<OnceLock<Layer>> = vec![OnceLock::new(); open.len()];
        let make = |index: usize| Ok(Some(cutter.swept(open[index].field(cutter))));
        let take = |index: usize, _, left: CutLayers| {
            let _is_first = cut[index].set(left.layers.into_iter().next_back().expect("at least one operation"));
            Ok(())
        };
        backend.cut_swept(open.len(), &make, &take)?;
        for (flank, finished) in open.iter_mut().zip(&cut) {
            flank.take(cutter, finished.get().expect("every field is taken"));
        }
    }
    Ok(flanks.into_iter().map(OpenPoints::settled).collect())
}

/// Points of a flank whose rays move to where the surface is found.
struct OpenPoints {
    side: Side,
    points: Vec<CurvePoint>,
    /// Where each point's ray stands, as arc of the pitch curve, mm.
    arcs_mm: Vec<f64>,
    /// What is still to be cut.
    open: Vec<usize>,
}

impl OpenPoints {
    fn new(cutter: &HobCutter, tooth: u32, side: Side) -> Self {
        let job = cutter.job;
        let space = i64::from(tooth) - i64::from(side == Side::Right);
        let sound_roll_mm = job.target.sound_roll_mm(space, side, 0.0);
        let point = |offset_mm| {
            let target = match &job.drawn {
                Some(rack) => rack.crossing(space, side, offset_mm)?,
                None => job.target.crossing_from(sound_roll_mm, &job.blank, space, side, offset_mm, 0.0)?,
            };
            Some(CurvePoint { offset_mm, target, cut_mm: None, along_mm: None })
        };
        let points: Vec<CurvePoint> = offsets_mm(job).into_iter().filter_map(point).collect();
        let arcs_mm = points.iter().map(|point| point.target.foot_arc_mm).collect();
        Self { side, open: (0..points.len()).collect(), points, arcs_mm }
    }

    /// Ray of a point, out of the tooth: towards larger arcs on the left flank.
    fn ray(&self, cutter: &HobCutter, point: usize) -> Ray {
        let curve = &cutter.job.curve;
        let frame = curve.frame(curve.phi_at_arc(self.arcs_mm[point]));
        Ray {
            origin_mm: (frame.point_mm + self.points[point].offset_mm * frame.normal).extend(0.0),
            normal: (self.side.sign() * frame.tangent).extend(0.0),
        }
    }

    /// Rays of the points that are open.
    fn field(&self, cutter: &HobCutter) -> SpatialField {
        let module_mm = cutter.job.scene.gear.module_mm;
        let reach_mm = 0.5 * PI * module_mm;
        SpatialField::new(self.open.len(), 1, -DEPTH_MODULES * module_mm, |column, _| {
            (self.ray(cutter, self.open[column]), reach_mm)
        })
    }

    /// Takes what is left on the rays over: those stay open that stood too far away.
    fn take(&mut self, cutter: &HobCutter, finished: &Layer) {
        let (curve, blank) = (&cutter.job.curve, &cutter.job.blank);
        let open = std::mem::take(&mut self.open);
        for (column, i) in open.into_iter().enumerate().filter(|&(column, _)| finished.passes[column] != NO_PASS) {
            let height_mm = f64::from(finished.heights_mm[column]);
            let cut_mm = self.ray(cutter, i).at(height_mm).truncate();
            let foot = blank.height(cut_mm, curve.phi_at_arc(self.arcs_mm[i])).1;
            let moved_mm = curve.arc_mm(foot) - self.arcs_mm[i];
            self.arcs_mm[i] += moved_mm;
            let frame = curve.frame(foot);
            let point = &mut self.points[i];
            point.cut_mm = Some(frame.point_mm + point.offset_mm * frame.normal);
            // Along the curve an arc of the pitch curve is 1 + offset / rho as long.
            let stretch = 1.0 + point.offset_mm * frame.curvature_per_mm;
            point.along_mm = Some(self.side.sign() * (self.arcs_mm[i] - point.target.foot_arc_mm) * stretch);
            let bend_per_mm = frame.curvature_per_mm / stretch;
            if 0.5 * height_mm * height_mm * bend_per_mm.abs() > BEND_MM {
                self.open.push(i);
            }
        }
    }

    /// The points; those that are still open have no value.
    fn settled(mut self) -> Vec<CurvePoint> {
        for i in self.open {
            (self.points[i].cut_mm, self.points[i].along_mm) = (None, None);
        }
        self.points
    }
}

/// Where the surface as cut crosses the pitch curve, among a flank's points.
pub fn pitch_crossing(points: &[CurvePoint], cutter: &HobCutter) -> Option<Crossing> {
    let point = points.iter().find(|point| point.offset_mm == 0.0)?;
    let curve = &cutter.job.curve;
    let (point_mm, arc_mm) = (point.cut_mm?, point.target.foot_arc_mm);
    let phi_rad = cutter.job.blank.height(point_mm, curve.phi_at_arc(arc_mm)).1;
    Some(Crossing { point_mm, phi_rad, arc_mm: curve.arc_mm(phi_rad) })
}

/// Frequencies of errors in intervals about zero, and the normal distribution fitted to the errors themselves.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorSpread {
    /// Number of errors.
    pub count: usize,
    /// Mean, um.
    pub mean_um: f64,
    /// Standard deviation about the mean, of the errors, not of the grouped ones; n - 1 in the denominator, um.
    pub sigma_um: f64,
    /// Width of an interval, um; the middle one is centred on zero.
    pub interval_um: f64,
    /// Errors in each interval.
    pub frequencies: Vec<usize>,
}

impl ErrorSpread {
    /// Of errors in um; `None` with fewer than two. As in the paper, intervals are about one standard deviation wide:
    /// 1, 2 or 4 times a power of ten, not less than it.
    pub fn of(errors_um: &[f64]) -> Option<Self> {
        let count = errors_um.len();
        if count < 2 {
            return None;
        }
        let mean_um = errors_um.iter().sum::<f64>() / count as f64;
        let squares: f64 = errors_um.iter().map(|e| (e - mean_um).powi(2)).sum();
        let sigma_um = (squares / (count - 1) as f64).sqrt();
        // Errors that do not spread at all still get a scale: a nanometre.
        let power = 10_f64.powf(sigma_um.max(1e-3).log10().floor());
        let widths = [1.0, 2.0, 4.0].map(|width| width * power);
        let interval_um = widths.into_iter().find(|width| *width >= sigma_um).unwrap_or(10.0 * power);
        let largest_um = errors_um.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        let beside = ((largest_um / interval_um - 0.5).ceil().max(1.0) as usize).min(MOST_INTERVALS);
        let mut frequencies = vec![0; 2 * beside + 1];
        for error in errors_um {
            let interval = (error / interval_um).round() + beside as f64;
            frequencies[(interval.max(0.0) as usize).min(2 * beside)] += 1;
        }
        Some(Self { count, mean_um, sigma_um, interval_um, frequencies })
    }

    /// Middles of the intervals, um.
    pub fn medians_um(&self) -> Vec<f64> {
        let beside = (self.frequencies.len() / 2) as f64;
        (0..self.frequencies.len()).map(|i| (i as f64 - beside) * self.interval_um).collect()
    }

    /// Errors that the fitted distribution has at `error_um` in an interval's width.
    pub fn expected(&self, error_um: f64) -> f64 {
        let z = (error_um - self.mean_um) / self.sigma_um;
        self.count as f64 * self.interval_um / self.sigma_um * (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's own table of errors in x (Liu et al. 2015, Table 2): grouped at the medians, its standard deviation
    /// is 0.03966 mm.
    #[test]
    fn the_papers_frequencies_come_back_with_their_spread() {
        let table = [(-120.0, 1), (-80.0, 19), (-40.0, 85), (0.0, 141), (40.0, 84), (80.0, 18), (120.0, 2)];
        let errors: Vec<f64> = table.iter().flat_map(|&(median, count)| vec![median; count]).collect();
        let spread = ErrorSpread::of(&errors).expect("350 errors");
        assert_eq!(spread.count, 350);
        assert_eq!(spread.interval_um, 40.0);
        assert_eq!(spread.frequencies, table.map(|(_, count)| count).to_vec());
        assert_eq!(spread.medians_um(), table.map(|(median, _)| median).to_vec());
        assert!((spread.sigma_um - 39.66).abs() < 0.06, "{}", spread.sigma_um);
        // The fitted distribution holds all errors.
        let all: f64 = (-400..=400).map(|e| spread.expected(f64::from(e)) / spread.interval_um).sum();
        assert!((all - 350.0).abs() < 1e-6, "{all}");
    }
}

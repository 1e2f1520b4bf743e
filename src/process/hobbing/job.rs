//! A hobbing scene made ready to cut: pitch curve, hob, blank, linkages with their feed plans, and the target that the
//! rack leaves.
//!
//! In: the checked scene. Out: [`HobbingJob`]. The last operation is the finishing one: the rack in its place is the
//! target's.

use crate::machine_errors::MachineErrors;
use crate::material::CuttingForce;
use crate::measure::round_gear::is_round;
use crate::process::hobbing::Hob;
use crate::process::hobbing::actual::ActualHobbing;
use crate::process::hobbing::commanded::{HobbingCommand, HobbingProgram, program_of};
use crate::process::hobbing::drawn_rack::DrawnRack;
use crate::process::hobbing::kept::{self, Kept, KeptTargets};
use crate::process::hobbing::linkage::{FeedPlan, HobbingGeometry, HobbingLaw, HobbingLinkage, feed_marks};
use crate::process::hobbing::rack_generation::{Rack, RackGeneration};
use crate::process::hobbing::scene::model::{
    self, EvenMotion, ExtraRotation, Hobbing, HobbingAxisLimits, HobbingKind, HobbingOperation, LinkageForm,
};
use crate::scene::Scene;
use crate::scene::model::Gear;
use crate::scene::tool_wear::WearSpec;
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// How far the hob's tips may come under the gear's root curve in a hollow of the pitch curve, mm.
const GOUGE_TOLERANCE_MM: f64 = 1e-3;
/// Places on the pitch curve and along the hob at which a hollow is looked at.
const HOLLOW_PLACES: [u32; 2] = [720, 41];

/// One operation with its motion.
#[derive(Debug)]
pub struct PreparedHobbing {
    /// What the scene says.
    pub spec: HobbingOperation,
    /// How far the hob stays back from rolling on the pitch curve: offset, profile shift and thickness allowance, mm.
    pub offset_mm: f64,
    /// How slide, shift and infeed run.
    pub plan: FeedPlan,
    /// The six axes.
    pub linkage: HobbingLinkage,
    /// The program that is cut in their place, if the scene names one.
    pub program: Option<HobbingProgram>,
    /// What the machine makes of them.
    pub actual: ActualHobbing,
}

impl PreparedHobbing {
    /// What the axes are told.
    pub fn commanded(&self) -> HobbingCommand<'_> {
        HobbingCommand { linkage: &self.linkage, program: self.program.as_ref() }
    }
}

/// Everything known before the first dexel is cut.
#[derive(Debug)]
pub struct HobbingJob {
    /// The scene.
    pub scene: Scene,
    /// The hob as the scene describes it.
    pub hob_spec: model::HobSpec,
    /// Limits of the axes.
    pub limits: HobbingAxisLimits,
    /// What is wrong with the machine and the work on it.
    pub errors: MachineErrors<6>,
    /// Whether axis programs are written.
    pub programs: bool,
    /// Cutting force of the work's material, where the scene names it.
    pub material: Option<CuttingForce>,
    /// How the hob wears, where the scene says.
    pub wear: Option<WearSpec>,
    /// The pitch curve.
    pub curve: Arc<PitchCurve>,
    /// The hob.
    pub hob: Hob,
    /// The stock.
    pub stock: Blank,
    /// The outline that the target's tips lie on: the stock's, or lower where the hob's roots top the gear.
    pub blank: Blank,
    /// Operations in order; the last one finishes.
    pub operations: Vec<PreparedHobbing>,
    /// Turn of the finished gear as a whole, rad, that the zero of the work spindle makes up for.
    pub turn_rad: f64,
    /// What the finishing operation leaves in the limit of many gashes and a fine feed.
    pub target: RackGeneration,
    /// The same where the hob's tooth is drawn, and the rack above has its heights and the nominal angle alone.
    pub drawn: Option<DrawnRack>,
    kept: OnceLock<Result<Kept, Refusal>>,
    pub(super) targets: KeptTargets,
}

impl HobbingJob {
    /// Makes a scene ready.
    ///
    /// # Errors
    /// Geometry that cannot be cut: see the parts; and a hollow of the pitch curve that the hob would hit.
    pub fn new(scene: &Scene) -> Result<Self> {
        let job = Self::past_hollows(scene)?;
        refuse_hollows(&job.curve, &job.hob)?;
        Ok(job)
    }

    /// The same where the hob hits the far sides of hollows as well: to see what it does there.
    ///
    /// # Errors
    /// Geometry that cannot be cut.
    pub fn past_hollows(scene: &Scene) -> Result<Self> {
        let gear = &scene.gear;
        let Some(Hobbing { tool, limits, errors, operations: specs, material, wear, programs }) = Hobbing::of(scene)
        else {
            return Err(Refusal::new("tool", "this tool does not hob gears", "write [tool.hob] for hobbing").into());
        };
        let curve = Arc::new(PitchCurve::new(&gear.pitch_curve, gear.transverse_module_mm(), gear.teeth)?);
        let hob = Hob::new(tool, gear.module_mm, gear.pressure_angle_rad)?;
        scene.gear.check_bore(&curve)?;
        let stock = gear.blank(curve.clone())?;
        // A hob pulled back by d leaves teeth 2 d tan(alpha_t) thicker on the pitch curve: by x m and the allowance.
        let shift_mm = gear.profile_shift_coefficient * gear.module_mm;
        let allowance_mm =
            shift_mm + gear.tooth_thickness_allowance_mm / (2.0 * gear.transverse_pressure_angle_rad().tan());
        let finishing_mm = specs.last().map_or(0.0, |spec| spec.offset_mm) + allowance_mm;
        let rack = rack(gear, &hob, tool.tip_radius_mm, tool.thinning_mm).pulled_back(finishing_mm);
        // The roots of the hob's teeth lie on a line that rolls along over the pitch curve, as its tips' does under it.
        let deepest_mm = specs.iter().map(|spec| spec.offset_mm).fold(f64::INFINITY, f64::min) + allowance_mm;
        let mut blank = stock.clone();
        if hob.drawn().is_none() {
            blank.addendum_mm = stock.addendum_mm.min(tool.dedendum_coefficient * gear.module_mm + deepest_mm);
        }
        let target = RackGeneration { curve: curve.clone(), rack };
        let drawn = hob
            .drawn()
            .map(|tooth| DrawnRack::new(tooth.clone(), target.clone(), finishing_mm, &blank, gear.teeth))
            .transpose()?;
        let contact_x_mm = match &drawn {
            Some(rack) => rack.contact_reach_mm(gear.teeth),
            None => {
                let height_mm =
                    (hob.tip_radius_mm - hob.pitch_radius_mm).max(rack.tip_height_mm).max(gear.addendum_mm());
                height_mm / gear.transverse_pressure_angle_rad().tan()
            }
        };
        let (mut operations, mut start_s) = (Vec::new(), 0.0);
        for spec in specs {
            let offset_mm = spec.offset_mm + allowance_mm;
            let mut geometry = HobbingGeometry::new(&hob, gear.helix_angle_rad, gear.hand.sign());
            geometry.head_angle_rad = spec.head_angle_rad.unwrap_or(geometry.head_angle_rad);
            let cycle_s = curve.perimeter_mm() / (geometry.arc_per_hob_rad_mm() * spec.hob_speed_rad_per_s);
            let plan = FeedPlan::new(spec, [offset_mm, contact_x_mm], &hob, &geometry, gear, &curve, cycle_s)?;
            let linkage =
                HobbingLinkage::new(curve.clone(), geometry, law(spec), spec.hob_speed_rad_per_s, &plan.path)?;
            let program = spec.program.as_deref().map(|path| program_of(path, &spec.name, &linkage)).transpose()?;
            let commanded = HobbingCommand { linkage: &linkage, program: program.as_ref() };
            let actual = ActualHobbing::new(errors, tool.mounting, commanded, start_s, 0.5 * gear.face_width_mm)?;
            start_s += commanded.end_s();
            operations.push(PreparedHobbing { spec: spec.clone(), offset_mm, plan, linkage, program, actual });
        }
        let finishing: Option<&PreparedHobbing> = operations.last().filter(|_| is_round(&curve));
        let turn_rad = finishing.map_or(0.0, |of| of.actual.turn_rad(of.commanded()));
        for operation in &mut operations {
            operation.actual.make_up_for(turn_rad);
        }
        Ok(Self {
            scene: scene.clone(),
            hob_spec: tool.clone(),
            limits: *limits,
            errors: errors.clone(),
            programs: *programs,
            material: *material,
            wear: *wear,
            curve,
            hob,
            stock,
            blank,
            operations,
            turn_rad,
            target,
            drawn,
            kept: OnceLock::new(),
            targets: KeptTargets::new(gear.teeth),
        })
    }

    /// Makes another scene ready, one with other errors. No error moves a target: where both scenes have the same gear
    /// and rack, they share the targets that anybody asks for.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn sharing_targets(&self, scene: &Scene) -> Result<Self> {
        let mut job = Self::new(scene)?;
        let is_same_tooth = match (&self.drawn, &job.drawn) {
            (None, None) => true,
            (Some(own), Some(other)) => own.generates_as(other),
            _ => false,
        };
        if self.scene.gear == job.scene.gear && self.target.rack == job.target.rack && is_same_tooth {
            job.targets = self.targets.clone();
        }
        Ok(job)
    }

    /// Whether the hob's roots cut the tips, so that the blank's outline is not the gear's.
    pub fn tops_the_gear(&self) -> bool {
        self.blank.addendum_mm < self.stock.addendum_mm
    }

    /// The finishing operation.
    pub fn finishing(&self) -> &PreparedHobbing {
        self.operations.last().expect("a checked scene has at least one operation")
    }

    /// Passes of an operation: every tooth in every turn of the hob.
    pub fn passes(&self, operation: &PreparedHobbing) -> f64 {
        kept::passes(&self.hob, operation.commanded())
    }

    /// Passes, made when somebody asks first and the same ever after.
    ///
    /// # Errors
    /// More passes than can be numbered.
    pub(super) fn kept(&self) -> Result<&Kept, Refusal> {
        let operations = || self.operations.iter().map(|of| (of.spec.name.as_str(), of.commanded(), &of.actual));
        let make = || Kept::new(&self.hob, operations());
        self.kept.get_or_init(make).as_ref().map_err(Clone::clone)
    }

    /// Height of the highest ridge that the slide's feed leaves in an operation, mm: at the pitch line or at the tip,
    /// on either flank, where the pitch curve bends most or least ([`feed_marks`]); none of a drawn tooth.
    pub fn feed_mark_mm(&self, operation: &PreparedHobbing) -> Option<f64> {
        let facts = self.curve.facts();
        let feed_mm = operation.plan.slide_feeds_mm.into_iter().fold(0.0, f64::max);
        let mut highest_mm = 0.0_f64;
        for side in [Side::Left, Side::Right].map(Side::sign) {
            for extremum in [facts.smallest_curvature, facts.largest_curvature] {
                for height_mm in [0.0, self.blank.addendum_mm] {
                    let contact = feed_marks::RidgePlace {
                        side,
                        pressure_angle_rad: self.scene.gear.pressure_angle_rad,
                        curvature_per_mm: extremum.curvature_per_mm,
                        height_mm,
                    };
                    let geometry = operation.linkage.geometry();
                    highest_mm = highest_mm.max(feed_marks::ridge_mm(&self.hob, geometry, &contact, feed_mm)?);
                }
            }
        }
        Some(highest_mm)
    }

    /// Height of the generating marks at the pitch line where the curve bends by `curvature_per_mm`: consecutive gashes
    /// leave facets of the arc ds = K pi m_n / (gashes cos beta), ridges ds^2 sin(alpha_t) cos(beta_b) / (8 rho) normal
    /// to the flank, mm; none of a drawn tooth, whose flank has its own pressure angle everywhere.
    pub fn generating_mark_mm(&self, curvature_per_mm: f64) -> Option<f64> {
        if self.drawn.is_some() {
            return None;
        }
        let gear = &self.scene.gear;
        let arc_mm = self.gash_arc_mm();
        let ridges_per_mm = gear.transverse_pressure_angle_rad().sin() * gear.base_helix_cosine() / 8.0;
        Some(arc_mm * arc_mm * ridges_per_mm * curvature_per_mm)
    }

    /// Arc of the pitch curve from one gash to the next, mm; the same for every linkage, because hob and work are
    /// geared.
    pub fn gash_arc_mm(&self) -> f64 {
        f64::from(self.hob.starts) * PI * self.scene.gear.transverse_module_mm() / f64::from(self.hob.gashes)
    }
}

/// The law that a linkage table asks for; diagonal hobbing keeps the arc even and lets the work carry the extra
/// rotation.
fn law(spec: &HobbingOperation) -> HobbingLaw {
    match spec.kind {
        HobbingKind::Plain { even, extra, form } => HobbingLaw { even, extra, form },
        HobbingKind::Diagonal { form, .. } => {
            HobbingLaw { even: EvenMotion::ArcLength, extra: ExtraRotation::Work, form }
        }
    }
}

impl HobbingLaw {
    /// Number of the papers' scheme, I to VI.
    pub fn scheme(self) -> &'static str {
        match (self.even, self.extra) {
            (EvenMotion::ArcLength, ExtraRotation::Work) => "I",
            (EvenMotion::ArcLength, ExtraRotation::Hob) => "II",
            (EvenMotion::RotationAngle, ExtraRotation::Work) => "III",
            (EvenMotion::RotationAngle, ExtraRotation::Hob) => "IV",
            (EvenMotion::PolarAngle, ExtraRotation::Work) => "V",
            (EvenMotion::PolarAngle, ExtraRotation::Hob) => "VI",
        }
    }

    /// Whether this is the printed form where it differs from the exact one.
    pub fn is_as_printed(self) -> bool {
        self.form == LinkageForm::AsPrinted && self.extra == ExtraRotation::Work
    }
}

/// The rack that the hob stands for at full depth.
fn rack(gear: &Gear, hob: &Hob, tip_radius_mm: f64, thinning_mm: f64) -> Rack {
    let cos_helix = gear.helix_angle_rad.cos();
    Rack {
        transverse_module_mm: gear.transverse_module_mm(),
        pressure_angle_rad: gear.transverse_pressure_angle_rad(),
        half_thickness_mm: 0.5 * (0.5 * PI * gear.module_mm - thinning_mm) / cos_helix,
        tip_height_mm: hob.tip_radius_mm - hob.pitch_radius_mm,
        tip_radius_mm,
        helix_angle_rad: gear.helix_angle_rad,
        hand: gear.hand.sign(),
    }
}

/// How far a hob's tips go under the gear's root in hollows of the pitch curve, mm; none where it is convex.
///
/// The tips lie on a straight line in the transverse plane, h under the pitch line. While the rack touches the curve at
/// s, the root under another place s' stands at -(P(s') - h n(s') - P(s)) . n(s) under that line's pitch line; where
/// that is less than h the tooth that runs there cuts the difference out of it, as far as the hob reaches: both sides
/// of s by half its length.
pub fn cut_under_hollows_mm(curve: &PitchCurve, hob: &Hob) -> Option<f64> {
    if curve.facts().smallest_curvature.curvature_per_mm >= 0.0 {
        return None;
    }
    let [places, along] = HOLLOW_PLACES;
    let mut deepest_mm = 0.0_f64;
    for i in 0..places {
        let at = curve.frame(TURN_RAD * f64::from(i) / f64::from(places));
        if at.curvature_per_mm >= 0.0 {
            continue;
        }
        let arc_mm = curve.arc_mm(TURN_RAD * f64::from(i) / f64::from(places));
        for j in 0..along {
            let ahead = hob.length_mm * (f64::from(j) / f64::from(along - 1) - 0.5);
            let there = curve.frame(curve.phi_at_arc(arc_mm + ahead));
            // Both root curves lie one hob addendum under their pitch points; what stands over the tip line is hit.
            let tip_mm = hob.tip_radius_mm - hob.pitch_radius_mm;
            let root = there.point_mm - tip_mm * there.normal - at.point_mm;
            if root.dot(at.tangent).abs() <= 0.5 * hob.length_mm {
                deepest_mm = deepest_mm.max(root.dot(at.normal) + tip_mm);
            }
        }
    }
    Some(deepest_mm)
}

/// Refuses curves whose hollows the hob would cut under.
fn refuse_hollows(curve: &PitchCurve, hob: &Hob) -> Result<(), Refusal> {
    let Some(deepest_mm) = cut_under_hollows_mm(curve, hob).filter(|&deepest_mm| deepest_mm > GOUGE_TOLERANCE_MM)
    else {
        return Ok(());
    };
    let hollow = curve.facts().smallest_curvature;
    Err(Refusal::new(
        "gear.pitch_curve",
        format!(
            "the pitch curve is hollow at polar angle {:.2} deg (radius {:.1} mm): a hob {} mm long would cut {:.3} mm \
            under the root on both sides of the tooth it cuts, because \
             its tips lie on a straight line; hobbing needs a convex pitch curve",
            hollow.phi_rad.to_degrees(),
            -1.0 / hollow.curvature_per_mm,
            hob.length_mm,
            deepest_mm
        ),
        "make the variation of the radius smaller (an ellipse of order n is convex up to eccentricity 1 / (n^2 - 1)), \
        or shape the gear with [tool.shaper_cutter]",
    ))
}

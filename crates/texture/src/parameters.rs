//! The full sets of parameters with symbol, unit, definition, and a reason where one is undefined.
//!
//! One list serves `results.json`, the `texture` command and the report, so that none of them can lack a definition.

use super::core::Core;
use super::features::Features;
use super::height::Heights;
use super::hybrid::Hybrid;
use super::probability::Probability;
use super::profile::Profile;
use super::profile_chain::{ProfileKind, Profiles};
use super::ratio::MaterialRatio;
use super::spatial::Spatial;
use super::surface::Surface;
use crate::error::TextureError;

/// Ratios p at which Smc, Vm and Vv are always given, per cent.
pub const RATIOS_PERCENT: [f64; 3] = [10.0, 50.0, 80.0];

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Symbol of the standard, such as `Sq` or `Smc(10)`.
    pub symbol: String,
    /// The value, or why there is none.
    pub value: Result<f64, TextureError>,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub definition: String,
    /// Family, for grouping.
    pub family: &'static str,
}

/// Everything about one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// All parameters in the order of the standard.
    pub parameters: Vec<Parameter>,
    /// The material ratio curve, about the mean.
    pub curve: MaterialRatio,
    /// The construction of Sk on it.
    pub core: Core,
}

/// Arguments of parameters that are functions, beyond those always given.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arguments {
    /// Heights c over the mean for Smr(c), um.
    pub heights_um: Vec<f64>,
    /// Ratios p for Smc(p), Vm(p), Vv(p), per cent.
    pub ratios_percent: Vec<f64>,
}

impl Evaluation {
    /// The full areal set of a surface after its chain.
    pub fn of(surface: &Surface, arguments: &Arguments) -> Self {
        let heights = Heights::of(surface);
        let sz = heights.sp + heights.sv;
        // One after the other: each is shared out over the cores by itself, and what it needs of memory is given back
        // before the next one begins.
        let hybrid = Hybrid::of(surface);
        let spatial = Spatial::of(surface, sz == 0.0);
        let features = Features::of(surface, sz);
        let curve = MaterialRatio::of(surface);
        let core = Core::of(&curve);
        let mut list = List::default();
        list.heights(&heights);
        list.spatial(&spatial);
        list.hybrid(hybrid);
        list.core(&core, sz == 0.0);
        list.strata(Probability::of(&curve));
        list.functions(&curve, arguments);
        list.volumes(&curve);
        list.features(&features);
        Self { parameters: list.0, curve, core }
    }

    /// Value of a parameter, if it is defined.
    pub fn value(&self, symbol: &str) -> Option<f64> {
        self.parameters.iter().find(|p| p.symbol == symbol).and_then(|p| p.value.clone().ok())
    }
}

/// All parameters that a surface can have, and those of a line, with the values of a wave.
///
/// # Errors
/// None: the wave is a surface.
pub fn all() -> Result<[Vec<Parameter>; 2], TextureError> {
    let heights_um: Vec<f64> =
        (0..1024).map(|i| (0.7 * f64::from(i % 32)).sin() + (0.3 * f64::from(i / 32)).cos()).collect();
    let line = of_profile(ProfileKind::Roughness, &Profile::of(&heights_um, 1.0, 5), &[]);
    let surface = Surface::new(32, 32, 1.0, 1.0, heights_um)?;
    Ok([Evaluation::of(&surface, &Arguments::default()).parameters, line])
}

/// The profile set of one line as parameters, with Rmr at the mean line and at further heights over it (um).
pub fn of_profile(kind: ProfileKind, profile: &Profile, heights_um: &[f64]) -> Vec<Parameter> {
    let mut list = List::default();
    let (family, letter) = ("profile", kind.letter());
    let mut add = |symbol: &str, value: Result<f64, TextureError>, unit: &'static str, definition: &str| {
        list.add(family, format!("{letter}{symbol}"), value, unit, definition);
    };
    let moment = |value: f64| if value.is_nan() { Err(TextureError::FlatLine) } else { Ok(value) };
    add("a", Ok(profile.a), "um", "arithmetical mean height of the profile");
    add("q", Ok(profile.q), "um", "root mean square height of the profile");
    if kind != ProfileKind::Primary {
        add("z", Ok(profile.z), "um", "mean of the heights of the sections");
    }
    add("t", Ok(profile.t), "um", "height of the whole profile");
    let of_sections =
        |whole: &'static str, sections: &'static str| if kind == ProfileKind::Primary { whole } else { sections };
    add(
        "p",
        Ok(profile.p),
        "um",
        of_sections("height of the highest peak", "mean of the highest peaks of the sections"),
    );
    add("v", Ok(profile.v), "um", of_sections("depth of the deepest pit", "mean of the deepest pits of the sections"));
    if kind != ProfileKind::Primary {
        add("zx", Ok(profile.zx), "um", "largest height within one section's length anywhere on the profile");
    }
    add("sk", moment(profile.sk), "1", "skewness of the profile");
    add("ku", moment(profile.ku), "1", "kurtosis of the profile; 3 for Gaussian heights");
    add("dq", Ok(profile.dq), "1", "root mean square slope of the profile, by seven points");
    add(
        "Sm",
        profile.sm.clone(),
        "um",
        "mean spacing of profile elements, crossing-the-line segmentation, mean of both directions of the trace",
    );
    let core = &profile.core;
    add("k", Ok(core.sk), "um", "core height of the material ratio curve, least-squares line in the 40 % window");
    add("pk", Ok(core.spk), "um", "reduced peak height of the profile");
    add("vk", Ok(core.svk), "um", "reduced pit depth of the profile");
    add("mrk1", Ok(core.smr1), "%", "material ratio of the profile's peaks above the core");
    add("mrk2", Ok(core.smr2), "%", "material ratio of the profile above its pits");
    for c in [0.0].iter().chain(heights_um) {
        let definition = format!("material ratio at {c} um over the mean line");
        add(&format!("mr({c})"), Ok(profile.curve.smr_percent(*c)), "%", &definition);
    }
    list.0
}

/// One parameter over several lines.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterRange {
    /// The parameter; its value is the mean over the lines that have one.
    pub mean: Parameter,
    /// Least and largest value; none where no line has one.
    pub range: Option<[f64; 2]>,
    /// Lines that have one.
    pub lines: usize,
}

/// The profile set of several lines: mean, least and largest of every parameter.
pub fn of_profiles(profiles: &Profiles, heights_um: &[f64]) -> Vec<ParameterRange> {
    let of_lines: Vec<Vec<Parameter>> =
        profiles.lines.iter().flatten().map(|line| of_profile(profiles.kind, line, heights_um)).collect();
    let Some(first) = of_lines.first() else { return Vec::new() };
    let spread = |k: usize| {
        let values: Vec<f64> = of_lines.iter().filter_map(|line| line[k].value.clone().ok()).collect();
        let mut mean = first[k].clone();
        if !values.is_empty() {
            mean.value = Ok(values.iter().sum::<f64>() / values.len() as f64);
        }
        let least = values.iter().copied().reduce(f64::min);
        let range = least.zip(values.iter().copied().reduce(f64::max)).map(<[f64; 2]>::from);
        ParameterRange { mean, range, lines: values.len() }
    };
    (0..first.len()).map(spread).collect()
}

#[derive(Default)]
struct List(Vec<Parameter>);

impl List {
    fn add(
        &mut self,
        family: &'static str,
        symbol: impl Into<String>,
        value: Result<f64, TextureError>,
        unit: &'static str,
        definition: impl Into<String>,
    ) {
        let value =
            value.and_then(|value| if value.is_finite() { Ok(value) } else { Err(TextureError::FewNeighbours) });
        self.0.push(Parameter { symbol: symbol.into(), value, unit, definition: definition.into(), family });
    }

    fn um(&mut self, family: &'static str, symbol: impl Into<String>, value: f64, definition: impl Into<String>) {
        self.add(family, symbol, Ok(value), "um", definition);
    }

    fn moment(&mut self, family: &'static str, symbol: &str, value: f64, definition: &str) {
        let value = if value.is_nan() { Err(TextureError::FlatSurface) } else { Ok(value) };
        self.add(family, symbol, value, "1", definition);
    }

    fn heights(&mut self, h: &Heights) {
        let family = "height";
        self.um(family, "Sa", h.sa, "arithmetical mean height");
        self.um(family, "Sq", h.sq, "root mean square height");
        self.moment(family, "Ssk", h.ssk, "skewness of the heights");
        self.moment(family, "Sku", h.sku, "kurtosis of the heights; 3 for Gaussian ones, nothing subtracted");
        self.um(family, "Sp", h.sp, "largest peak height over the mean plane");
        self.um(family, "Sv", h.sv, "largest pit depth under the mean plane");
        self.um(family, "Sz", h.sp + h.sv, "maximum height, Sp + Sv");
    }

    fn spatial(&mut self, s: &Spatial) {
        let family = "spatial";
        let correlation = "of the unbiased linear autocorrelation";
        self.add(
            family,
            "Sal",
            s.sal.clone(),
            "um",
            format!("autocorrelation length: shortest decay to 0.2 {correlation}"),
        );
        self.add(
            family,
            "Str",
            s.str.clone(),
            "1",
            format!("texture aspect ratio: shortest over longest decay to 0.2 {correlation}"),
        );
        self.add(
            family,
            "Std",
            s.std.clone(),
            "deg",
            "direction of the wave vector with the largest power per angle, \
             counter-clockwise from +x towards +y, 0 to 180; the lay runs across it",
        );
        self.add(family, "Ssw", s.ssw.clone(), "um", "wavelength of the largest Fourier component of the window");
    }

    fn hybrid(&mut self, h: Hybrid) {
        self.add("hybrid", "Sdq", Ok(h.sdq), "1", "root mean square gradient, forward differences");
        self.add(
            "hybrid",
            "Sdr",
            Ok(h.sdr),
            "%",
            "developed interfacial area ratio, mean of both diagonal splits of each cell",
        );
    }

    fn core(&mut self, c: &Core, flat: bool) {
        let family = "core";
        let guarded = |value: f64| if flat { Err(TextureError::FlatSurface) } else { Ok(value) };
        self.um(
            family,
            "Sk",
            c.sk,
            "core height: least-squares line in the 40 % window of the flattest secant, from 0 to 100 %",
        );
        self.um(
            family,
            "Spk",
            c.spk,
            "reduced peak height: triangle on Smrk1 with the area of the hills above the core",
        );
        self.um(
            family,
            "Svk",
            c.svk,
            "reduced dale height: triangle on 100 - Smrk2 with the area of the dales below the core",
        );
        self.add(family, "Smrk1", guarded(c.smr1), "%", "material ratio at the upper end of the core");
        self.add(family, "Smrk2", guarded(c.smr2), "%", "material ratio at the lower end of the core");
        self.um(family, "Spkx", c.spkx, "height of the highest point over the core");
        self.um(family, "Svkx", c.svkx, "depth of the lowest point under the core");
        self.add(
            family,
            "Sak1",
            Ok(c.sak1),
            "um^3/um^2",
            "hills above the core, volume per unit area: Spk Smrk1 / 200",
        );
        self.add(
            family,
            "Sak2",
            Ok(c.sak2),
            "um^3/um^2",
            "dales below the core, volume per unit area: Svk (100 - Smrk2) / 200",
        );
    }

    fn strata(&mut self, found: Result<Probability, TextureError>) {
        let way = "material probability curve, hyperbola whose asymptotes' angle is halved three times (ISO 13565-3)";
        for (symbol, value, unit, what) in [
            ("Spq", found.clone().map(|of| of.spq), "um", "root mean square height of the plateau"),
            ("Svq", found.clone().map(|of| of.svq), "um", "root mean square height of the dales"),
            ("Smq", found.map(|of| of.smq), "%", "material ratio where plateau and dales meet"),
        ] {
            self.add("probability", symbol, value, unit, format!("{what}: {way}"));
        }
    }

    fn functions(&mut self, curve: &MaterialRatio, arguments: &Arguments) {
        let family = "function";
        for c in [0.0].iter().chain(&arguments.heights_um) {
            let definition = format!("material ratio at {c} um over the mean plane");
            self.add(family, format!("Smr({c})"), Ok(curve.smr_percent(*c)), "%", definition);
        }
        let ratios = || RATIOS_PERCENT.iter().chain(&arguments.ratios_percent);
        for p in ratios() {
            let definition = format!("height over the mean plane at a material ratio of {p} %");
            self.um(family, format!("Smc({p})"), curve.smc_um(*p), definition);
        }
        let between = |p: f64, q: f64| curve.smc_um(p) - curve.smc_um(q);
        self.um(family, "Sdc(10,80)", between(10.0, 80.0), "difference of heights Smc(10) - Smc(80)");
        self.um(family, "Sxp", between(2.5, 50.0), "extreme peak height Smc(2.5) - Smc(50)");
        for p in ratios() {
            let (above, below) =
                (format!("material above Smc({p}) per unit area"), format!("void below Smc({p}) per unit area"));
            self.add(family, format!("Vm({p})"), Ok(curve.material_um(*p)), "um^3/um^2", above);
            self.add(family, format!("Vv({p})"), Ok(curve.void_um(*p)), "um^3/um^2", below);
        }
    }

    fn volumes(&mut self, curve: &MaterialRatio) {
        let family = "volume";
        let (m10, m80) = (curve.material_um(10.0), curve.material_um(80.0));
        let (v10, v80) = (curve.void_um(10.0), curve.void_um(80.0));
        let unit = "um^3/um^2";
        self.add(family, "Vmp", Ok(m10), unit, "peak material volume Vm(10)");
        self.add(family, "Vmc", Ok(m80 - m10), unit, "core material volume Vm(80) - Vm(10)");
        self.add(family, "Vvc", Ok(v10 - v80), unit, "core void volume Vv(10) - Vv(80)");
        self.add(family, "Vvv", Ok(v80), unit, "dale void volume Vv(80)");
    }

    fn features(&mut self, f: &Features) {
        let family = "feature";
        let hills = "hills that rise 5 % of Sz (Wolf pruning) and lie wholly inside the window";
        self.add(family, "Spd", f.spd.clone(), "1/um^2", format!("density of peaks: {hills}"));
        self.add(family, "Spc", f.spc.clone(), "1/um", format!("mean curvature of the peaks of {hills}"));
        self.add(family, "Sha", f.sha.clone(), "um^2", format!("mean area of {hills}"));
        let dales = "dales that fall 5 % of Sz (Wolf pruning) and lie wholly inside the window";
        self.add(family, "Svd", f.svd.clone(), "1/um^2", format!("density of pits: {dales}"));
        self.add(family, "Svc", f.svc.clone(), "1/um", format!("mean curvature of the pits of {dales}"));
        self.add(family, "Sda", f.sda.clone(), "um^2", format!("mean area of {dales}"));
        self.add(family, "S10z", f.s10z.clone(), "um", "ten point height S5p + S5v");
        self.add(family, "S5p", f.s5p.clone(), "um", format!("mean height of the five highest peaks of {hills}"));
        self.add(family, "S5v", f.s5v.clone(), "um", "mean depth of the five deepest pits of dales of the same kind");
    }
}

//! How `gearcut texture` reads its file, what it does to the surface first, and where it saves it.

use crate::measure::topography::prepare::{MirrorAxis, Preparation, RectangleUm, Turn};
use crate::measure::topography::{ProfileTrace, Surface};
use crate::output::surface_files::{Format, Given, MeasuredContent, read};
use gearcut_core::Refusal;
use std::path::{Path, PathBuf};

use crate::cli::args::{AxisChoice, ReadingArguments, TextureArguments};
use crate::cli::failure::Failure;

/// A file that was read and made ready.
pub enum FileFound {
    Surface(Reading<Surface>),
    Profile(Reading<ProfileTrace>),
}

/// A surface or a profile.
pub struct Reading<T> {
    pub surface: T,
    pub notes: Vec<(String, String)>,
    /// How it was read and what was done to it.
    pub remarks: Vec<String>,
    /// What is hardly right about it.
    pub doubts: Vec<String>,
}

/// Reads the file and makes its surface ready.
pub fn reading(arguments: &TextureArguments) -> Result<FileFound, Failure> {
    let reading = &arguments.reading;
    let preparation = preparation(reading)?;
    let given = Given {
        spacing_um: match reading.spacing_um[..] {
            [both] => Some([both, both]),
            [x, y] => Some([x, y]),
            _ => None,
        },
        height_unit: reading.height_unit,
        spacing_unit: reading.spacing_unit,
        use_mask: reading.use_mask,
    };
    let measured = read(&arguments.file, &given)?;
    let doubts = measured.doubt().into_iter().collect();
    let (notes, mut remarks) = (measured.notes, measured.remarks);
    match measured.content {
        MeasuredContent::Surface(surface) => {
            let prepared = preparation.apply(&surface).map_err(|why| unsuited(&arguments.file, &why.to_string()));
            let (surface, words) = prepared?;
            remarks.extend(words);
            Ok(FileFound::Surface(Reading { surface, notes, remarks, doubts }))
        }
        MeasuredContent::Trace(surface) => {
            if preparation != Preparation::default() || !arguments.save.is_empty() {
                let reason = "it is a profile, and masks, outliers, turns, crops and --save are for surfaces";
                return Err(unsuited(&arguments.file, reason).into());
            }
            if !arguments.lines.line.is_empty() || !arguments.lines.lines.is_empty() {
                return Err(unsuited(&arguments.file, "it is a profile, which has no lines to choose from").into());
            }
            Ok(FileFound::Profile(Reading { surface, notes, remarks, doubts }))
        }
    }
}

fn unsuited(path: &Path, reason: &str) -> Refusal {
    let way_out = "see `gearcut texture --help` for what can be done to a surface before it is evaluated";
    Refusal::new("gearcut texture", format!("{}: {reason}", path.display()), way_out)
}

fn preparation(reading: &ReadingArguments) -> Result<Preparation, Refusal> {
    if let Some(sigmas) = reading.outliers.filter(|sigmas| !(sigmas.is_finite() && *sigmas > 0.0)) {
        let problem = format!("{sigmas} is no number of standard deviations");
        return Err(Refusal::new("--outliers", problem, "give a number above 0; 6 removes spikes and keeps textures"));
    }
    let rotate = reading.rotate.as_deref().map(|wish| match (wish, wish.parse::<f64>()) {
        ("lay", _) => Ok(Turn::Lay),
        (_, Ok(degrees)) if degrees.is_finite() => Ok(Turn::Degrees(degrees)),
        _ => Err(Refusal::new("--rotate", format!("`{wish}` is no angle"), "give degrees, or `lay`")),
    });
    Ok(Preparation {
        masks_um: rectangles("--mask-um", &reading.mask_um)?,
        outliers: reading.outliers,
        fill: reading.fill,
        invert: reading.invert,
        mirror: reading.mirror.map(|axis| match axis {
            AxisChoice::X => MirrorAxis::X,
            AxisChoice::Y => MirrorAxis::Y,
        }),
        crop_um: rectangles("--crop-to-um", &reading.crop_to_um)?.pop(),
        rotate: rotate.transpose()?,
    })
}

fn rectangles(option: &str, numbers: &[f64]) -> Result<Vec<RectangleUm>, Refusal> {
    let rectangle = |four: &[f64]| {
        let sound = four.iter().all(|edge| edge.is_finite()) && four[0] < four[1] && four[2] < four[3];
        let problem = || format!("{four:?} is no rectangle");
        let way_out = "give four numbers of um: first and last x, first and last y; the first point is 0 0";
        sound.then(|| [[four[0], four[1]], [four[2], four[3]]]).ok_or_else(|| Refusal::new(option, problem(), way_out))
    };
    numbers.chunks_exact(4).map(rectangle).collect()
}

/// Where the surface is to be saved, and how. Said before anything is read: an ending that names no format, a file that
/// exists, and the measured file itself, which is never replaced.
pub fn saves<'a>(arguments: &'a TextureArguments) -> Result<Vec<(&'a Path, Format)>, Refusal> {
    let read_at = arguments.file.canonicalize().ok();
    let save = |path: &'a PathBuf| {
        let refuse = |problem: &str, way_out: &str| {
            Err(Refusal::new("--save", format!("{} {problem}", path.display()), way_out))
        };
        let format = format_of(path)?;
        if path.canonicalize().is_ok_and(|there| read_at.as_ref() == Some(&there)) {
            return refuse("is the file that is read, and is never replaced", "choose another name");
        }
        let beside = (format == Format::Npy).then(|| PathBuf::from(format!("{}.json", path.display())));
        if !arguments.force && [Some(path.clone()), beside].into_iter().flatten().any(|path| path.exists()) {
            return refuse("exists", "choose another name, or let it be replaced with --force");
        }
        Ok((path.as_path(), format))
    };
    arguments.save.iter().map(save).collect()
}

fn format_of(path: &Path) -> Result<Format, Refusal> {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    let endings = [
        ("ascii.sdf", Format::SdfAscii),
        (".sdf", Format::SdfBinary),
        (".x3p", Format::X3p),
        (".sur", Format::Sur),
        (".npy", Format::Npy),
        (".csv", Format::Csv),
    ];
    endings.into_iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, format)| format).ok_or_else(|| {
        Refusal::new(
            "--save",
            format!("{} has no ending that names a format", path.display()),
            "use .x3p, .sdf, ascii.sdf, .sur, .npy or .csv",
        )
    })
}

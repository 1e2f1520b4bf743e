//! The report on paper: `report.pdf`, four to six pages of the same [`Page`].
//!
//! In: the page; what its head says ([`PaperHead`]); the drawn gear and the inspector's sheet, where there are. Out:
//! pages for a PDF file, in the order in which a drawing office reads: verdicts and warnings, key numbers, the gear;
//! maps of all flanks; inspection; axes; texture.
//!
//! The law: paper shows what the page shows, drawn by the same charts, and nothing else. What can be turned, unfolded
//! or looked up has its place on the page: of several operations paper has the axes of the last; notes are counted,
//! tables tooth by tooth left out. The head is on every page, so that a sheet that got lost finds back: part, drawing,
//! customer, date, SHA-256 of the scene, number of the page.

mod flow;

use super::texture::{self, TextureBlock};
use super::viewer::{Viewer, ViewerQuantity};
use super::{Block, KeyNumber, Page, PageSection, Tone, fixed, heading};
use crate::findings::Place;
use crate::findings::notice::{Notice, Severity, count_words};
use crate::output::contact_sheet::{ContactSheet, PrintedSheet, Thumbnail, contact_sheet_png};
use crate::output::figure::Figure;
use crate::output::vector_page::{Anchor, Ink, VectorPage, drawn};
use flow::{EDGE, Flow, fitting, png_size, wrapped_pt};
use std::sync::Arc;

/// What is at the head of every page; an empty field is left to a pen.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperHead {
    /// Name of the part.
    pub part: String,
    /// Number of the drawing.
    pub drawing: String,
    /// For whom the gear is.
    pub customer: String,
    /// Date, as the scene says it.
    pub date: String,
    /// SHA-256 of the scene with every value written out, hexadecimal.
    pub scene_sha256: String,
    /// Size of the paper, points.
    pub size_pt: [f64; 2],
}

/// What paper has beside the page.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperParts {
    /// Of every page.
    pub head: PaperHead,
    /// The drawn gear, PNG.
    pub gear: Option<Vec<u8>>,
    /// The inspector's sheet.
    pub inspection: Option<VectorPage>,
}

/// Digits of the scene's SHA-256 at the head: run.json has all.
const HASH_DIGITS: usize = 16;
/// Faults and warnings that are printed, and lines of each.
const WARNINGS: usize = 12;
const LINES_OF_A_WARNING: usize = 4;
/// Maps that are printed: what the last operation found, and what it left.
const MAPS: usize = 2;
/// Sheets of maps: words of their 15 px can be read on paper, and two sheets fill a page.
const SHEET: PrintedSheet = PrintedSheet { width_px: 1500, proportion: 1.9 };
/// Key numbers beside each other.
const CARDS: usize = 4;
/// A chart is not drawn larger, points for a pixel.
const CHART: f64 = 0.62;
/// A sheet of few tiles is not drawn larger, points for a pixel.
const PICTURE: f64 = 0.36;
const AMBER: Ink = Ink::Rgb([0x8a, 0x4b, 0x00]);

type Said<T> = Result<T, String>;

impl Page {
    /// The page on paper.
    ///
    /// # Errors
    /// A chart or a picture that paper cannot show; the embedded font cannot be read.
    pub fn paper(&self, parts: &PaperParts) -> Said<Vec<VectorPage>> {
        let mut flow = Flow::new(&format!("{}: {}", self.title, self.what), parts.head.size_pt);
        self.front(&mut flow, parts.gear.as_deref())?;
        if let Some(viewer) = &self.viewer {
            flow.new_page();
            maps(&mut flow, viewer)?;
        }
        let section = |id: &str| self.sections.iter().find(|section| section.id == id);
        flow.new_page();
        match &parts.inspection {
            Some(sheet) => {
                // Its own edge is above the head.
                let height = sheet.lowest_pt() - EDGE + 8.0;
                let scale = (flow.room() / height).min(1.0);
                let left = 0.5 * (parts.head.size_pt[0] - scale * sheet.size_pt[0]);
                let (page, top) = flow.take(scale * height);
                page.place(sheet, (left, top - scale * (EDGE - 8.0)), scale);
            }
            None => section("deviations").map_or(Ok(()), |of| of.on_paper(&mut flow, &of.blocks))?,
        }
        if let Some(motion) = section("motion") {
            flow.new_page();
            let last = motion.blocks.iter().rposition(|block| matches!(block, Block::Heading(_))).unwrap_or(0);
            motion.on_paper(&mut flow, &motion.blocks[last..])?;
        }
        if let Some(texture) = section("texture") {
            flow.new_page();
            texture.on_paper(&mut flow, &texture.blocks)?;
        }
        let mut pages = flow.pages;
        let count = pages.len();
        for (index, page) in pages.iter_mut().enumerate() {
            parts.head.draw(page, [index + 1, count])?;
            let below = (EDGE, page.size_pt[1] - 18.0);
            let words = format!(
                "{}. Every number with unit and definition: results.json. The gear to turn: report.html.",
                self.program
            );
            page.words(below, 6.0, Ink::Grey, Anchor::Start, &words);
        }
        Ok(pages)
    }

    /// Verdicts, warnings, key numbers, the gear.
    fn front(&self, flow: &mut Flow, gear: Option<&[u8]>) -> Said<()> {
        flow.line(16.0, Ink::Black, &self.title)?;
        flow.paragraph(8.0, Ink::Grey, &self.subtitle, 3)?;
        for operation in &self.operations {
            flow.paragraph(8.0, Ink::Grey, operation, 2)?;
        }
        flow.heading("Verdict")?;
        let done = if self.complete { self.done } else { "stopped before all flanks were cut" };
        let worst = self.warnings.iter().map(|warning| warning.severity).max();
        let ink = match worst {
            _ if !self.complete || worst == Some(Severity::Fault) => Ink::Red,
            Some(Severity::Warning) => AMBER,
            _ => Ink::Green,
        };
        flow.line(9.0, ink, &format!("{done}; {}", count_words(&self.warnings)))?;
        for section in &self.sections {
            let Some(verdict) = section.verdict.as_ref().filter(|of| of.tone != Tone::Aside) else { continue };
            let ink = match verdict.tone {
                Tone::Fine => Ink::Green,
                Tone::Wrong => Ink::Red,
                Tone::Open | Tone::Aside => Ink::Black,
            };
            flow.paragraph(8.0, ink, &format!("{}: {}", section.title, verdict.words), 2)?;
        }
        let grave: Vec<&Notice> = self.warnings.iter().filter(|of| of.severity > Severity::Note).collect();
        if !grave.is_empty() {
            flow.heading("What must be known")?;
        }
        for warning in grave.iter().take(WARNINGS) {
            let ink = if warning.severity == Severity::Fault { Ink::Red } else { AMBER };
            let words = format!("{}. {}", heading(warning.severity), warning.text);
            flow.paragraph(7.4, ink, &words, LINES_OF_A_WARNING)?;
        }
        if grave.len() > WARNINGS {
            flow.line(7.4, AMBER, &format!("and {} more in report.html", grave.len() - WARNINGS))?;
        }
        flow.heading("Key numbers")?;
        let known: Vec<&KeyNumber> = self.key_numbers.iter().filter(|number| number.value != "–").collect();
        for row in known.chunks(CARDS) {
            cards(flow, row)?;
        }
        flow.space(6.0);
        match gear {
            Some(png) => flow.picture(png.into(), 150.0, f64::INFINITY),
            None => flow.line(7.0, Ink::Grey, "No picture of the gear was drawn."),
        }
    }
}

/// Key numbers beside each other.
fn cards(flow: &mut Flow, numbers: &[&KeyNumber]) -> Said<()> {
    let width = flow.width() / CARDS as f64;
    let (page, top) = flow.take(38.0);
    for (index, number) in numbers.iter().enumerate() {
        let x = EDGE + width * index as f64;
        page.frame((x, top), (width, 38.0), Ink::Pale);
        let mut write = |y: f64, size: f64, ink: Ink, words: &str| -> Said<()> {
            page.words((x + 5.0, top + y), fitting(words, size, width - 10.0)?, ink, Anchor::Start, words);
            Ok(())
        };
        write(9.0, 6.6, Ink::Grey, &number.name)?;
        write(22.5, 11.0, Ink::Black, format!("{} {}", number.value, number.unit).trim())?;
        let place =
            number.place.as_ref().and_then(Place::flank).map(|at| {
                format!("tooth {} {}, u {}, v {} mm", at.tooth, at.flank, fixed(at.u_mm, 2), fixed(at.v_mm, 1))
            });
        let below = [place.unwrap_or_default(), number.note.clone()];
        let below: Vec<&str> = below.iter().map(String::as_str).filter(|words| !words.is_empty()).collect();
        let lines = wrapped_pt(&below.join("; "), 5.8, width - 10.0)?;
        for (k, line) in lines.iter().take(2).filter(|line| !line.is_empty()).enumerate() {
            write(29.5 + 6.4 * k as f64, 5.8, Ink::Grey, line)?;
        }
    }
    Ok(())
}

/// All flanks, quantity by quantity, each on one scale.
fn maps(flow: &mut Flow, viewer: &Viewer) -> Said<()> {
    let flanks: Vec<_> = viewer.flanks.iter().filter_map(|flank| Some((flank, flank.grid.as_ref()?))).collect();
    if flanks.is_empty() {
        return Ok(());
    }
    let shown = &viewer.quantities[..MAPS.min(viewer.quantities.len())];
    // Less heading and definition.
    let half = flow.room() / shown.len() as f64 - 54.0;
    for quantity in shown {
        flow.heading(&quantity.name)?;
        flow.paragraph(6.6, Ink::Grey, &quantity.definition, 3)?;
        let labels: Vec<String> = flanks.iter().map(|(flank, _)| format!("{} {}", flank.tooth, flank.side)).collect();
        let maps: Vec<Thumbnail> = (flanks.iter().zip(&labels).zip(&quantity.values))
            .map(|(((_, grid), label), values)| Thumbnail { label, grid, values })
            .collect();
        let sheet = sheet(quantity, &maps);
        let png: Arc<[u8]> = contact_sheet_png(&sheet, Some(SHEET))?.into();
        let (width, height) = png_size(&png)?;
        let scale = (flow.width() / width).min(half / height);
        let (page, top) = flow.take(scale * height);
        page.picture((EDGE, top), (scale * width, scale * height), png);
    }
    Ok(())
}

fn sheet<'a>(quantity: &'a ViewerQuantity, maps: &'a [Thumbnail<'a>]) -> ContactSheet<'a> {
    ContactSheet {
        title: &quantity.name,
        quantity: &quantity.name,
        unit: &quantity.unit,
        scale: quantity.scale,
        missing: "no value",
        maps,
    }
}

impl PageSection {
    /// Heading, verdict and these blocks.
    fn on_paper(&self, flow: &mut Flow, blocks: &[Block]) -> Said<()> {
        flow.heading(&self.title)?;
        if let Some(verdict) = &self.verdict {
            flow.paragraph(8.0, Ink::Black, &verdict.words, 2)?;
        }
        flow.paragraph(7.0, Ink::Grey, &self.lead, 4)?;
        blocks.iter().try_for_each(|block| block.on_paper(flow))
    }
}

impl Block {
    /// The piece on paper; what is folded away, and what is read from a screen only, is left out.
    fn on_paper(&self, flow: &mut Flow) -> Said<()> {
        let mut chart = |figure: &Figure| {
            flow.space(4.0);
            flow.drawing(&drawn(&figure.svg()?)?, CHART);
            Ok(())
        };
        match self {
            Self::Lines(of) => chart(&of.figure()),
            Self::Bars(of) => chart(&of.figure()),
            Self::Panels(of) => chart(&of.figure()),
            Self::Dots(of) => chart(&of.figure()),
            Self::Heat(of) => chart(&of.figure()),
            Self::Strips(of) => chart(&of.figure()),
            Self::Ranges(of) => chart(&of.figure()),
            Self::Drawing(_, svg) => {
                flow.drawing(&drawn(svg)?, CHART);
                Ok(())
            }
            Self::Heading(words) => flow.line(9.0, Ink::Black, words),
            Self::Note(words) => flow.paragraph(6.8, Ink::Grey, words, 6),
            Self::Table(table) => flow.table(table),
            Self::Picture(words, png) => {
                flow.line(8.0, Ink::Black, words)?;
                flow.picture(png.as_slice().into(), 100.0, PICTURE)
            }
            Self::Texture(window) => window.on_paper(flow),
            Self::Traces(_) | Self::Folded(..) | Self::Verbatim(_) | Self::Files(_) => Ok(()),
        }
    }
}

impl TextureBlock {
    /// The relief beside the material ratio, the parameters below.
    fn on_paper(&self, flow: &mut Flow) -> Said<()> {
        flow.space(6.0);
        flow.line(9.0, Ink::Black, &self.title)?;
        flow.paragraph(6.6, Ink::Grey, &self.chain, 3)?;
        for warning in &self.warnings {
            flow.paragraph(6.8, AMBER, warning, 3)?;
        }
        let relief = self.png.as_ref().map(|png| Ok::<_, String>((Arc::<[u8]>::from(png.as_slice()), png_size(png)?)));
        let relief = relief.transpose()?;
        let ratio = self.material_ratio.as_ref().map(|chart| drawn(&chart.figure().svg()?)).transpose()?;
        let (left, right) = (0.58 * flow.width(), 0.4 * flow.width());
        let relief = relief.map(|(png, (width, height))| (png, left / width * height));
        let ratio = ratio.map(|chart| (right / chart.size_pt[0], chart));
        let height =
            relief.as_ref().map_or(0.0, |of| of.1).max(ratio.as_ref().map_or(0.0, |of| of.0 * of.1.size_pt[1]));
        let beside = EDGE + flow.width() - right;
        let (page, top) = flow.take(height + 4.0);
        if let Some((png, height)) = relief {
            page.picture((EDGE, top), (left, height), png);
        }
        if let Some((scale, chart)) = ratio {
            page.place(&chart, (beside, top), scale);
        }
        let known = texture::first(self)
            .into_iter()
            .filter_map(|of| Some(format!("{} {}", of.symbol, of.value.as_ref().ok()?)));
        flow.paragraph(7.4, Ink::Black, &known.collect::<Vec<_>>().join(",  "), 4)
    }
}

impl PaperHead {
    /// Fields over a page; `number` is the page's and how many there are.
    fn draw(&self, page: &mut VectorPage, [number, count]: [usize; 2]) -> Said<()> {
        let width = page.size_pt[0] - 2.0 * EDGE;
        let hash: String = self.scene_sha256.chars().take(HASH_DIGITS).collect();
        let numbered = format!("{number} of {count}");
        // Shares of the width.
        let fields = [
            ("Part", self.part.as_str(), 0.25),
            ("Drawing", &self.drawing, 0.17),
            ("Customer", &self.customer, 0.2),
            ("Date", &self.date, 0.12),
            ("SHA-256 of the scene", &hash, 0.17),
            ("Page", &numbered, 0.09),
        ];
        let mut x = EDGE;
        for (label, value, share) in fields {
            let field = share * width;
            page.frame((x, 28.0), (field, 32.0), Ink::Grey);
            page.words((x + 4.0, 37.0), 5.8, Ink::Grey, Anchor::Start, label);
            page.words((x + 4.0, 52.0), fitting(value, 9.0, field - 8.0)?, Ink::Black, Anchor::Start, value);
            x += field;
        }
        Ok(())
    }
}

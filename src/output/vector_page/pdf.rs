//! The page as PDF 1.7, its letters from the embedded font.
//!
//! In: the strokes. Out: the bytes of one page. Glyphs are numbered as in the font (Identity-H), their widths are its
//! own, and a table leads back to letters, so that words can be searched and copied. No date and no name of a machine
//! is in the file: the same page has the same bytes.

use super::{A4_PT, Anchor, PagePiece, VectorPage, words_pt};
use crate::output::font;
use ab_glyph::{Font, FontRef};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use std::collections::BTreeMap;
use std::io::Write as _;

const FONT_NAME: Name<'static> = Name(b"NotoSans-Regular");
const IDENTITY: SystemInfo<'static> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

impl VectorPage {
    /// The page as PDF.
    ///
    /// # Errors
    /// The embedded font cannot be read.
    pub fn pdf(&self) -> Result<Vec<u8>, String> {
        let font = FontRef::try_from_slice(font::NOTO_SANS).map_err(|error| error.to_string())?;
        let mut glyphs: BTreeMap<u16, char> = BTreeMap::new();
        let content = self.content(&font, &mut glyphs)?;
        let [catalog, pages, page, type0, cid, descriptor, file, unicode, drawn, info] =
            std::array::from_fn(|i| Ref::new(i as i32 + 1));
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut leaf = pdf.page(page);
        leaf.parent(pages).media_box(Rect::new(0.0, 0.0, A4_PT[0] as f32, A4_PT[1] as f32)).contents(drawn);
        leaf.resources().fonts().pair(Name(b"F"), type0);
        leaf.finish();
        pdf.type0_font(type0)
            .base_font(FONT_NAME)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid)
            .to_unicode(unicode);
        embed(&mut pdf, &font, &glyphs, [cid, descriptor, file, unicode])?;
        let packed = deflated(&content)?;
        pdf.stream(drawn, &packed).filter(Filter::FlateDecode);
        pdf.document_info(info).title(TextStr(&self.title)).producer(TextStr("gearcut"));
        Ok(pdf.finish())
    }

    /// What is drawn, and the letters of every glyph that is.
    fn content(&self, font: &FontRef, glyphs: &mut BTreeMap<u16, char>) -> Result<Vec<u8>, String> {
        let mut content = Content::new();
        let up = |y: f64| (A4_PT[1] - y) as f32;
        for stroke in &self.strokes {
            match stroke {
                PagePiece::Path { points, ink, width, dashed } => {
                    let [r, g, b] = ink.rgb().map(|part| f32::from(part) / 255.0);
                    content.set_stroke_rgb(r, g, b).set_line_width(*width as f32);
                    let dashes: &[f32] = if *dashed { &[3.0, 2.4] } else { &[] };
                    content.set_dash_pattern(dashes.iter().copied(), 0.0);
                    let runs = points.split(|(x, y)| !(x.is_finite() && y.is_finite()));
                    for run in runs.filter(|run| run.len() > 1) {
                        content.move_to(run[0].0 as f32, up(run[0].1));
                        run[1..].iter().for_each(|&(x, y)| {
                            content.line_to(x as f32, up(y));
                        });
                        content.stroke();
                    }
                }
                PagePiece::Block { corner, size, ink } => {
                    let [r, g, b] = ink.rgb().map(|part| f32::from(part) / 255.0);
                    content.set_fill_rgb(r, g, b);
                    content.rect(corner.0 as f32, up(corner.1 + size.1), size.0 as f32, size.1 as f32).fill_nonzero();
                }
                PagePiece::Words { at, size, ink, anchor, words } => {
                    let width = words_pt(words, *size)?;
                    let x = match anchor {
                        Anchor::Start => at.0,
                        Anchor::Middle => at.0 - 0.5 * width,
                        Anchor::End => at.0 - width,
                    };
                    let [r, g, b] = ink.rgb().map(|part| f32::from(part) / 255.0);
                    let mut shown = Vec::new();
                    for letter in words.chars() {
                        let glyph = font.glyph_id(letter).0;
                        glyphs.entry(glyph).or_insert(letter);
                        shown.extend(glyph.to_be_bytes());
                    }
                    content.set_fill_rgb(r, g, b).begin_text().set_font(Name(b"F"), *size as f32);
                    content.set_text_matrix([1.0, 0.0, 0.0, 1.0, x as f32, up(at.1)]).show(Str(&shown)).end_text();
                }
            }
        }
        Ok(content.finish())
    }
}

/// The font's program, its widths, and letters of its glyphs.
fn embed(
    pdf: &mut Pdf,
    font: &FontRef,
    glyphs: &BTreeMap<u16, char>,
    [cid, descriptor, file, unicode]: [Ref; 4],
) -> Result<(), String> {
    let units = font.units_per_em().ok_or("the embedded font names no units")?;
    let thousandth = |value: f32| 1000.0 * value / units;
    let mut cid_font = pdf.cid_font(cid);
    cid_font.subtype(CidFontType::Type2).base_font(FONT_NAME).system_info(IDENTITY).font_descriptor(descriptor);
    cid_font.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = cid_font.widths();
    for &glyph in glyphs.keys() {
        widths.consecutive(glyph, [thousandth(font.h_advance_unscaled(ab_glyph::GlyphId(glyph)))]);
    }
    widths.finish();
    cid_font.finish();
    let (ascent, descent) = (thousandth(font.ascent_unscaled()), thousandth(font.descent_unscaled()));
    pdf.font_descriptor(descriptor)
        .name(FONT_NAME)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(-600.0, descent, 3000.0, ascent))
        .italic_angle(0.0)
        .ascent(ascent)
        .descent(descent)
        .cap_height(1000.0 * font::CAPITAL_HEIGHT_EM as f32)
        .stem_v(80.0)
        .font_file2(file);
    let packed = deflated(font::NOTO_SANS)?;
    pdf.stream(file, &packed).filter(Filter::FlateDecode).pair(Name(b"Length1"), font::NOTO_SANS.len() as i32);
    let mut letters = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
    for (&glyph, &letter) in glyphs {
        letters.pair(glyph, letter);
    }
    pdf.cmap(unicode, &letters.finish());
    Ok(())
}

fn deflated(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).map_err(|error| error.to_string())?;
    encoder.finish().map_err(|error| error.to_string())
}

//! Pages as PDF 1.7, their letters from the embedded font, their pictures as they are in PNG files.
//!
//! In: the strokes. Out: the bytes of the file. Glyphs are numbered as in the font (Identity-H), their widths are its
//! own, and a table leads back to letters, so that words can be searched and copied. PDF knows the filters of PNG:
//! the packed rows of a picture are taken over, none is unpacked. No date and no name of a machine is in the file: the
//! same pages have the same bytes.

use super::{Anchor, Ink, PagePiece, VectorPage, words_pt};
use crate::output::font;
use ab_glyph::{Font, FontRef};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, Predictor, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::sync::Arc;

const FONT_NAME: Name<'static> = Name(b"NotoSans-Regular");
const IDENTITY: SystemInfo<'static> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// What a PNG file begins with.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The file; its title is that of the first page.
///
/// # Errors
/// The embedded font cannot be read; a picture is no PNG of 8 bits, in colours or numbers of colours.
pub(super) fn pdf(pages: &[VectorPage]) -> Result<Vec<u8>, String> {
    let font = FontRef::try_from_slice(font::NOTO_SANS).map_err(|error| error.to_string())?;
    let mut glyphs: BTreeMap<u16, char> = BTreeMap::new();
    let mut numbers = 1..;
    let mut next = || Ref::new(numbers.next().unwrap_or_default());
    let [catalog, tree, type0, cid, descriptor, file, unicode, info] = std::array::from_fn(|_| next());
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    let mut leaves = Vec::with_capacity(pages.len());
    for page in pages {
        let [leaf, drawn] = [next(), next()];
        leaves.push(leaf);
        let mut pictures: Vec<(String, Ref, &Arc<[u8]>)> = Vec::new();
        let packed = deflated(&content(page, &font, &mut glyphs, |png| {
            let name = format!("P{}", pictures.len());
            pictures.push((name.clone(), next(), png));
            name
        })?)?;
        let mut written = pdf.page(leaf);
        let [width, height] = page.size_pt;
        written.parent(tree).media_box(Rect::new(0.0, 0.0, width as f32, height as f32)).contents(drawn);
        let mut resources = written.resources();
        resources.fonts().pair(Name(b"F"), type0);
        resources.x_objects().pairs(pictures.iter().map(|(name, place, _)| (Name(name.as_bytes()), *place)));
        resources.finish();
        written.finish();
        pdf.stream(drawn, &packed).filter(Filter::FlateDecode);
        for (_, place, png) in pictures {
            embed_picture(&mut pdf, place, png)?;
        }
    }
    pdf.pages(tree).count(leaves.len() as i32).kids(leaves);
    pdf.type0_font(type0)
        .base_font(FONT_NAME)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(cid)
        .to_unicode(unicode);
    embed(&mut pdf, &font, &glyphs, [cid, descriptor, file, unicode])?;
    let title = pages.first().map_or("", |page| &page.title);
    pdf.document_info(info).title(TextStr(title)).producer(TextStr("gearcut"));
    Ok(pdf.finish())
}

/// What is drawn, and the letters of every glyph that is; `named` gives a picture its name on the page.
fn content<'a>(
    page: &'a VectorPage,
    font: &FontRef,
    glyphs: &mut BTreeMap<u16, char>,
    mut named: impl FnMut(&'a Arc<[u8]>) -> String,
) -> Result<Vec<u8>, String> {
    let mut content = Content::new();
    let up = |y: f64| (page.size_pt[1] - y) as f32;
    let parts = |ink: Ink| ink.rgb().map(|part| f32::from(part) / 255.0);
    let line = |content: &mut Content, points: &[(f64, f64)]| {
        content.move_to(points[0].0 as f32, up(points[0].1));
        points[1..].iter().for_each(|&(x, y)| {
            content.line_to(x as f32, up(y));
        });
    };
    for stroke in &page.strokes {
        match stroke {
            PagePiece::Path { points, ink, width, dashed } => {
                let [r, g, b] = parts(*ink);
                content.set_stroke_rgb(r, g, b).set_line_width(*width as f32);
                let dashes: &[f32] = if *dashed { &[3.0, 2.4] } else { &[] };
                content.set_dash_pattern(dashes.iter().copied(), 0.0);
                let runs = points.split(|(x, y)| !(x.is_finite() && y.is_finite()));
                for run in runs.filter(|run| run.len() > 1) {
                    line(&mut content, run);
                    content.stroke();
                }
            }
            PagePiece::Block { corner, size, ink } => {
                let [r, g, b] = parts(*ink);
                content.set_fill_rgb(r, g, b);
                content.rect(corner.0 as f32, up(corner.1 + size.1), size.0 as f32, size.1 as f32).fill_nonzero();
            }
            PagePiece::Area { points, ink } if points.len() > 2 => {
                let [r, g, b] = parts(*ink);
                content.set_fill_rgb(r, g, b);
                line(&mut content, points);
                content.fill_nonzero();
            }
            PagePiece::Area { .. } => {}
            PagePiece::Picture { corner, size, png } => {
                let name = named(png);
                let [width, height] = [size.0 as f32, size.1 as f32];
                content.save_state();
                content.transform([width, 0.0, 0.0, height, corner.0 as f32, up(corner.1 + size.1)]);
                content.x_object(Name(name.as_bytes())).restore_state();
            }
            PagePiece::Words { at, size, ink, anchor, words } => {
                let width = words_pt(words, *size)?;
                let x = match anchor {
                    Anchor::Start => at.0,
                    Anchor::Middle => at.0 - 0.5 * width,
                    Anchor::End => at.0 - width,
                };
                let [r, g, b] = parts(*ink);
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

/// Puts a picture in: the packed rows of its file, with the filter that they went through.
fn embed_picture(pdf: &mut Pdf, place: Ref, png: &[u8]) -> Result<(), String> {
    let mut rest = png.strip_prefix(SIGNATURE).ok_or("a picture is no PNG")?;
    let (mut head, mut palette, mut rows) = (None, &[][..], Vec::new());
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let length = u32::from_be_bytes(*length) as usize;
        let (kind, body) = after.split_at_checked(4).ok_or("a picture ends early")?;
        let (body, after) = body.split_at_checked(length).ok_or("a picture ends early")?;
        match kind {
            b"IHDR" => head = body.first_chunk::<13>().copied(),
            b"PLTE" => palette = body,
            b"IDAT" => rows.extend_from_slice(body),
            _ => {}
        }
        // The checksum of the chunk.
        rest = after.get(4..).unwrap_or_default();
    }
    let head = head.ok_or("a picture has no head")?;
    let number = |at: usize| i32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    let (width, height) = (number(0), number(4));
    // Bits, kind of colours (red, green and blue, or numbers of them), compression, filter, interlacing.
    let parts = match head[8..] {
        [8, 2, 0, 0, 0] => 3,
        [8, 3, 0, 0, 0] => 1,
        _ => {
            return Err(format!(
                "a picture has the head {head:?}: no plain colours of 8 bits each, nor numbers of such"
            ));
        }
    };
    let mut image = pdf.image_xobject(place, &rows);
    image.width(width).height(height).bits_per_component(8);
    image.filter(Filter::FlateDecode);
    if parts == 1 {
        image.color_space().indexed(Name(b"DeviceRGB"), (palette.len() / 3) as i32 - 1, palette);
    } else {
        image.color_space().device_rgb();
    }
    let parameters = &mut image.decode_parms();
    parameters.predictor(Predictor::PngOptimum).colors(parts).bits_per_component(8).columns(width);
    Ok(())
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

//! Light on bodies, and the picture it makes.
//!
//! In: bodies, camera, lights. Out: [`Rendered`]: sRGB pixels; and [`Seen`]: depth, normal, value and pass id at every
//! pixel's middle.
//!
//! A point is lit by one lamp (with shadows, a little soft) and by the sky, of which it sees as much as rays over its
//! hemisphere say (ambient occlusion), weighted by the cosine. Four rays per pixel, stratified; two of them ask the sky
//! in directions of their own (a golden-ratio sequence, started by a hash of the pixel), and the share of the sky is
//! then averaged over neighbours on the same smooth surface: several hundred pixels, so that four rays each showed
//! nothing that two do not. Nothing is random: the same bodies give the same bytes.
//!
//! Colours stand for values, so that light changes their brightness and hardly their hue.

use super::bodies::{BARE, Bodies};
use super::camera::Camera;
use super::visible::{BandHits, Visible};
use crate::interrupt::Interrupt;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::{Error, Result};
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

/// Rays per pixel along one side.
const SIDE: u32 = 2;
/// Rounds over which the sky's share is averaged: squares of 7 by 7 pixels that lie this many pixels apart (the à-trous
/// scheme of Dammertz et al., 2010).
const SMOOTH_STEPS_PX: [i64; 2] = [1, 4];
/// A pixel whose surface shows in fewer sky rays than this, as at the rim of a flank seen edge on, takes the sky's
/// share of all that is round it: its own few rays would make it black or white.
const LEAST_SKY_RAYS: f32 = 16.0;
/// Radius of the lamp at unit distance: shadows grow soft by a fiftieth of their length.
const LAMP_RADIUS: f64 = 0.02;
/// Rays start this share of the bodies' size off the surface, so that they do not meet it again.
const OFF_SURFACE: f64 = 2e-6;

/// Light of the open sky on a white surface that faces up, before its share: with the studio's lamp beside it, clay in
/// the open comes out at the middle of the grey scale.
const SKY_GAIN: f64 = 1.7;
/// Share by which faces that look down get less of the sky than faces that look up, as in a room: faces turned away
/// from the lamp keep their shape.
const SKY_FROM_ABOVE: f64 = 0.25;
/// How narrow highlights are (the exponent of Blinn, 1977), and how bright at full gloss.
const HIGHLIGHT_POWER: i32 = 40;
const HIGHLIGHT: f64 = 0.5;
/// Light up to here comes out as it is; more is bent towards white and never reaches it, so that the brightest marks
/// keep their shape.
const KNEE: f64 = 0.6;
/// The studio's lamp: so much towards the viewer, up, and to the left; its share of the light; how far bodies take the
/// sky from each other, as a share of their size; and its brightness.
const STUDIO_LAMP: [f64; 3] = [0.9, 0.65, 0.75];
const STUDIO_LAMP_SHARE: f64 = 0.48;
const STUDIO_SKY_REACH: f64 = 0.25;
const STUDIO_GAIN: f64 = 1.55;

/// How bodies are lit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lights {
    /// Unit direction from the object to the lamp.
    pub lamp: DVec3,
    /// Share of the lamp; the rest comes from the sky.
    pub lamp_share: f64,
    /// How far surfaces take the sky from each other, as a share of the bodies' size.
    pub sky_reach: f64,
    /// Brightness of a white surface that faces the lamp, before the shares: above 1 where the lamp grazes.
    pub gain: f64,
}

impl Lights {
    /// A lamp over the viewer's left shoulder and a wide sky: for whole bodies.
    pub fn studio(camera: &Camera) -> Self {
        let [towards, up, left] = STUDIO_LAMP;
        let lamp = (towards * camera.towards + up * camera.up - left * camera.right).normalize();
        Self { lamp, lamp_share: STUDIO_LAMP_SHARE, sky_reach: STUDIO_SKY_REACH, gain: STUDIO_GAIN }
    }
}

/// A finished picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// Width and height, pixels.
    pub size_px: (u32, u32),
    /// sRGB, rows from the top.
    pub rgb: Vec<[u8; 3]>,
    /// Smallest and largest value that colours show; infinite and turned round where they show none.
    pub shown: (f32, f32),
    /// Whether a place has no value, and so the grey of [`BARE`].
    pub bare: bool,
}

/// What stands at every pixel's middle, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Width and height, pixels.
    pub size_px: (u32, u32),
    /// Distance from the picture plane through the camera's target, mm, away from the viewer; infinite where nothing
    /// stands.
    pub depth_mm: Vec<f32>,
    /// Smooth unit normal in the frame of the bodies; zero where nothing stands.
    pub normal: Vec<[f32; 3]>,
    /// Value that the colour shows; NaN where there is none.
    pub value: Vec<f32>,
    /// Pass id; [`NO_PASS`] where none is known.
    pub pass: Vec<u32>,
}

/// What one pixel gathers.
#[derive(Clone, Copy, Default)]
struct Pixel {
    /// Light of the lamp, summed over the rays.
    lamp: DVec3,
    /// Colour that the sky lights, summed over the rays.
    sky: DVec3,
    /// Rays that met something.
    met: u32,
    /// Sky rays sent and free.
    asked: u32,
    free: u32,
    /// Found at the first ray that met something: to tell neighbours on the same surface.
    normal: Vec3,
    depth_mm: f32,
    value: f32,
}

/// Draws bodies; bands of pixels in parallel.
///
/// # Errors
/// Ctrl-C.
pub fn render(bodies: &Bodies, camera: &Camera, lights: &Lights, interrupt: &Interrupt) -> Result<Rendered> {
    let pixels = of_pixels(bodies, camera, SIDE, interrupt, |hits, x, y| pixel(bodies, camera, lights, hits, [x, y]))?;
    let open = smoothed(&pixels, camera);
    let rgb = pixels
        .par_iter()
        .zip(&open)
        .map(|(here, open)| {
            let empty = f64::from(SIDE * SIDE - here.met);
            let met = f64::from(here.met.max(1));
            let light = ((here.lamp + here.sky * f64::from(*open)) / met).map(shouldered);
            ((light * f64::from(here.met) + DVec3::splat(empty)) / f64::from(SIDE * SIDE)).to_array().map(srgb)
        })
        .collect();
    let values = pixels.iter().filter(|pixel| pixel.met > 0 && pixel.value.is_finite()).map(|pixel| pixel.value);
    let shown = values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let bare = pixels.iter().any(|pixel| pixel.met > 0 && pixel.value.is_nan());
    Ok(Rendered { size_px: camera.size_px, rgb, shown, bare })
}

/// What stands at every pixel's middle.
///
/// # Errors
/// Ctrl-C.
pub fn seen(bodies: &Bodies, camera: &Camera, interrupt: &Interrupt) -> Result<Seen> {
    let found = of_pixels(bodies, camera, 1, interrupt, |hits, x, y| {
        hits.hit(x, y).map(|(_, hit)| bodies.found(&hit, -camera.towards))
    })?;
    let found = || found.iter().map(Option::as_ref);
    let far_mm = far_mm(bodies, camera);
    Ok(Seen {
        size_px: camera.size_px,
        depth_mm: found().map(|f| f.map_or(f32::INFINITY, |f| (f.distance_mm - far_mm) as f32)).collect(),
        normal: found().map(|f| f.map_or([0.0; 3], |f| f.normal.as_vec3().to_array())).collect(),
        value: found().map(|f| f.map_or(f32::NAN, |f| f.value)).collect(),
        pass: found().map(|f| f.and_then(|f| f.pass).unwrap_or(NO_PASS)).collect(),
    })
}

/// Something of every pixel, rows from the top: `side` by `side` rays for each, bands of pixels in parallel.
fn of_pixels<T: Send>(
    bodies: &Bodies,
    camera: &Camera,
    side: u32,
    interrupt: &Interrupt,
    of_pixel: impl Fn(&BandHits, u32, u32) -> T + Sync,
) -> Result<Vec<T>> {
    let rays = Visible::new(bodies.tree(), camera, side, far_mm(bodies, camera));
    let of_band = |band| {
        interrupt.check()?;
        let hits = rays.first(band);
        let places = hits.pixel_rows.clone().flat_map(|y| (0..camera.size_px.0).map(move |x| (x, y)));
        Ok(places.map(|(x, y)| of_pixel(&hits, x, y)).collect())
    };
    let bands: Vec<Vec<T>> = (0..rays.bands()).into_par_iter().map(of_band).collect::<Result<_, Error>>()?;
    Ok(bands.into_iter().flatten().collect())
}

/// How far before the camera's target rays start: clear of the bodies, mm.
fn far_mm(bodies: &Bodies, camera: &Camera) -> f64 {
    2.0 * bodies.size_mm() + camera.extent_mm
}

/// Share of the sky that every pixel sees, averaged over neighbours on the same smooth surface.
fn smoothed(pixels: &[Pixel], camera: &Camera) -> Vec<f32> {
    let (width, height) = (i64::from(camera.size_px.0), i64::from(camera.size_px.1));
    // Close together in memory: every pixel asks 98 neighbours.
    let places: Vec<(Vec3, f32)> = pixels.iter().map(|p| (p.normal, p.depth_mm)).collect();
    let mut sums: Vec<[f32; 2]> = pixels.iter().map(|p| [p.free as f32, p.asked as f32]).collect();
    for step in SMOOTH_STEPS_PX {
        // Neighbours further away in depth than twice as far as in the picture lie on another surface.
        let reach_mm = 6.0 * step as f32 * camera.pixel_mm() as f32;
        sums = (0..pixels.len() as i64)
            .into_par_iter()
            .map(|i| {
                let (x, y) = (i % width, i / width);
                let (normal, depth_mm) = places[i as usize];
                let (mut free, mut asked) = (0.0, 0.0);
                let columns = || (-3..=3).map(|k| x + step * k).filter(|x| (0..width).contains(x));
                for row in (-3..=3).map(|k| y + step * k).filter(|y| (0..height).contains(y)) {
                    for index in columns().map(|column| (row * width + column) as usize) {
                        let other = places[index];
                        if other.0.dot(normal) > 0.9 && (other.1 - depth_mm).abs() < reach_mm {
                            free += sums[index][0];
                            asked += sums[index][1];
                        }
                    }
                }
                [free, asked]
            })
            .collect();
    }
    let round = |i: usize| {
        let (x, y) = (i as i64 % width, i as i64 / width);
        let near = |(dx, dy): (i64, i64)| (0..width).contains(&(x + dx)) && (0..height).contains(&(y + dy));
        let places = (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (dx, dy))).filter(|d| near(*d));
        places
            .map(|(dx, dy)| &pixels[((y + dy) * width + x + dx) as usize])
            .fold([0.0; 2], |[free, asked], p| [free + p.free as f32, asked + p.asked as f32])
    };
    let share = |(i, &[free, asked]): (usize, &[f32; 2])| {
        let [free, asked] = if asked < LEAST_SKY_RAYS { round(i) } else { [free, asked] };
        if asked > 0.0 { free / asked } else { 0.0 }
    };
    sums.iter().enumerate().map(share).collect()
}

fn pixel(bodies: &Bodies, camera: &Camera, lights: &Lights, hits: &BandHits, [x, y]: [u32; 2]) -> Pixel {
    let mut gathered = Pixel::default();
    let mut seed = hash(x, y);
    for (i, j) in (0..SIDE * SIDE).map(|ray| (ray % SIDE, ray / SIDE)) {
        let Some((origin_mm, hit)) = hits.hit(SIDE * x + i, SIDE * y + j) else { continue };
        let found = bodies.found(&hit, -camera.towards);
        let off_mm = OFF_SURFACE * bodies.size_mm();
        let place_mm = origin_mm - camera.towards * found.distance_mm + found.flat * off_mm;
        if gathered.met == 0 {
            (gathered.normal, gathered.depth_mm) = (found.normal.as_vec3(), found.distance_mm as f32);
            gathered.value = found.value;
        }
        gathered.met += 1;
        let colour = DVec3::from_array(found.colour);
        let side = lights.lamp.any_orthonormal_vector();
        let across = lights.lamp.cross(side);
        let [a, b] = next_pair(&mut seed);
        let offset = DVec2::from_angle(std::f64::consts::TAU * a) * (LAMP_RADIUS * b.sqrt());
        let lamp = (lights.lamp + offset.x * side + offset.y * across).normalize();
        let cosine = found.normal.dot(lamp);
        if cosine > 0.0 && found.flat.dot(lamp) > 0.0 && !bodies.is_blocked(place_mm, lamp, 2.0 * bodies.size_mm()) {
            let half = (lamp + camera.towards).normalize();
            let highlight = found.gloss * found.normal.dot(half).max(0.0).powi(HIGHLIGHT_POWER);
            gathered.lamp += lights.lamp_share * (lights.gain * cosine * colour + DVec3::splat(HIGHLIGHT * highlight));
        }
        let sky = 1.0 - SKY_FROM_ABOVE + SKY_FROM_ABOVE * found.normal.dot(camera.up);
        gathered.sky += (1.0 - lights.lamp_share) * SKY_GAIN * sky * colour;
        // Rays on the pixel's diagonal ask the sky.
        if i == j {
            // Cosine-weighted (Malley): a disc lifted onto the hemisphere.
            let tangent = found.normal.any_orthonormal_vector();
            let bitangent = found.normal.cross(tangent);
            let [a, b] = next_pair(&mut seed);
            let disc = DVec2::from_angle(std::f64::consts::TAU * a) * b.sqrt();
            let direction = disc.x * tangent + disc.y * bitangent + (1.0 - b).sqrt() * found.normal;
            gathered.asked += 1;
            let open = found.flat.dot(direction) > 0.0
                && !bodies.is_blocked(place_mm, direction, lights.sky_reach * bodies.size_mm());
            gathered.free += u32::from(open);
        }
    }
    gathered
}

/// Two numbers in [0, 1) of the plane's golden-ratio sequence (M. Roberts, 2018).
fn next_pair(seed: &mut u32) -> [f64; 2] {
    *seed = seed.wrapping_add(1);
    let n = f64::from(*seed);
    [(n * 0.754_877_666_246_692_7).fract(), (n * 0.569_840_290_998_053_2).fract()]
}

/// Scrambles a pixel's place (the finaliser of `MurmurHash3`), kept small so that products with it stay exact to 1e-9.
fn hash(x: u32, y: u32) -> u32 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
    h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
    (h ^ (h >> 16)) >> 12
}

/// Light with its bright end bent towards white.
fn shouldered(light: f64) -> f64 {
    let (over, room) = (light - KNEE, 1.0 - KNEE);
    if over > 0.0 { KNEE + room * (1.0 - (-over / room).exp()) } else { light }
}

/// The grey of places without a value, as drawings show colours.
pub fn bare_srgb() -> [u8; 3] {
    BARE.map(srgb)
}

/// Linear light to an sRGB component (IEC 61966-2-1).
fn srgb(light: f64) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let c = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (c * 255.0).round() as u8
}

//! Light and colour of a picture's parts. Colours are linear light, 0 to 1; depths and places in m.

use super::super::coater::{IdRaster, Lens, PanelIds, View};
use super::SprayZone;
use nalgebra::Vector3;

type Rgb = [f32; 3];

/// Film colours from none to twice the mean, of even steps in lightness: a white core to a blue coat. sRGB.
const FILM: [u32; 6] = [0x00f6_f1e6, 0x00c9_e4e0, 0x008c_c9d8, 0x004f_a3c9, 0x0028_74ab, 0x0017_477f];
const BACK: u32 = 0x0046_4d57;
const STEEL: u32 = 0x00a9_b0b8;
const RIM: u32 = 0x008d_959e;
const SPRAY: u32 = 0x00ff_9d3c;
/// Towards the lamp: above, left, in front. Screen axes (right, down, away).
const LAMP: [f32; 3] = [-0.45, -0.65, -0.61];
/// How far around a point its neighbours shade it, m.
const SHADE_REACH: f32 = 0.007;
const SHADE_SAMPLES: usize = 20;

/// What is painted.
pub(super) struct Scene<'a> {
    pub(super) raster: &'a IdRaster,
    pub(super) lens: &'a Lens,
    /// From the camera to the front of the drum, m.
    pub(super) distance: f32,
    pub(super) ids: &'a PanelIds,
    /// Film of each body, 0 to 1.
    pub(super) film: Vec<f32>,
    /// At the front of the drum.
    pub(super) pixels_per_metre: f32,
    /// Width and height of the raster.
    pub(super) side: usize,
    pub(super) radius: f32,
    pub(super) rim: f32,
    pub(super) spray: Option<Spray>,
}

/// The spray on the screen: a fan from the nozzle to the two ends of the zone.
pub(super) struct Spray {
    nozzle: [f32; 2],
    ends: [[f32; 2]; 2],
}

impl Spray {
    pub(super) fn new(zone: &SprayZone, view: &View) -> Self {
        let screen = |point: Vector3<f64>| {
            let [x, y, _] = view.screen(&point);
            [x, y]
        };
        let half = zone.streamwise * (zone.extent[1] / 2.0);
        Self {
            nozzle: screen(zone.center + zone.normal * zone.distance),
            ends: [-half, half].map(|end| screen(zone.center + end)),
        }
    }
}

impl Scene<'_> {
    /// Light and opacity at a point of the raster.
    pub(super) fn light(&self, x: usize, y: usize) -> [f32; 4] {
        let middle = self.side as f32 / 2.0 - 0.5;
        let [right, down] = [x, y].map(|v| (v as f32 - middle) / self.pixels_per_metre);
        let from_axis = right.hypot(down);
        if from_axis > self.radius + self.rim {
            return [0.0; 4];
        }
        let mut light = if from_axis > self.radius {
            self.rim_light(right, down, from_axis)
        } else {
            self.surface_light(x, y)
        };
        if let Some(spray) = &self.spray {
            light = spray.over(light, [x as f32, y as f32], self.pixels_per_metre);
        }
        [light[0], light[1], light[2], 1.0]
    }

    fn rim_light(&self, right: f32, down: f32, from_axis: f32) -> Rgb {
        // A rounded ring: its section turns from facing outwards to facing inwards.
        let across = 2.0 * (from_axis - self.radius) / self.rim - 1.0;
        let towards = (1.0 - 0.8 * across * across).max(0.0).sqrt();
        let out = 0.9 * across / from_axis;
        lit(decode(RIM), [right * out, down * out, -towards], 0.25, 1.0)
    }

    fn surface_light(&self, x: usize, y: usize) -> Rgb {
        let (id, _) = self.raster.at(x, y);
        let normal = self.normal(x, y);
        let open = self.openness(x, y);
        match self.ids.body(id) {
            Some(body) => lit(film_color(self.film[body]), normal, 0.35, open),
            None => match id - self.ids.panels() {
                PanelIds::WALL => lit(decode(STEEL), normal, 0.1, open),
                PanelIds::END => lit(decode(BACK), normal, 0.0, open),
                PanelIds::BAFFLE => lit(decode(STEEL), normal, 0.2, open),
                _ => decode(BACK),
            },
        }
    }

    /// Where the surface seen at a point of the raster is: right, down and away from the camera, m. Infinitely far away
    /// where nothing is.
    fn point(&self, x: usize, y: usize) -> [f32; 3] {
        let away = self.lens.metres(self.raster.at(x, y).1);
        let middle = self.side as f32 / 2.0 - 0.5;
        let across = |v: usize| (v as f32 - middle) / self.pixels_per_metre * away / self.distance;
        [across(x), across(y), away]
    }

    /// Unit normal of the surface, from points next to the point: the nearer one where the surface breaks off.
    fn normal(&self, x: usize, y: usize) -> [f32; 3] {
        let here = self.point(x, y);
        let last = self.side - 1;
        let along = |before: [usize; 2], after: [usize; 2]| {
            let [back, forth] = [before, after].map(|[x, y]| self.point(x, y));
            let [back, forth] = [minus(here, back), minus(forth, here)];
            if (back[2].abs() < forth[2].abs() && dot(back, back) > 0.0) || dot(forth, forth) == 0.0 {
                back
            } else {
                forth
            }
        };
        let across = along([x.saturating_sub(1), y], [(x + 1).min(last), y]);
        let down = along([x, y.saturating_sub(1)], [x, (y + 1).min(last)]);
        unit(cross(down, across))
    }

    /// Share of the light from all around that reaches the point past what stands before it.
    fn openness(&self, x: usize, y: usize) -> f32 {
        let here = self.point(x, y)[2];
        let reach = SHADE_REACH * self.pixels_per_metre * self.distance / here;
        let mut shade = 0.0;
        for k in 0..SHADE_SAMPLES {
            // Points of a sunflower: evenly over the disc, denser towards its middle.
            let along = (k as f32 + 0.5) / SHADE_SAMPLES as f32;
            let (sin, cos) = (k as f32 * 2.399_963).sin_cos();
            let seen = |v: usize, step: f32| {
                (v as f32 + step * along * reach).clamp(0.0, self.side as f32 - 1.0) as usize
            };
            let before = here - self.point(seen(x, cos), seen(y, sin))[2];
            if before.is_finite() {
                let steep = (before / (along * SHADE_REACH)).clamp(0.0, 1.5) / 1.5;
                shade += steep * smooth(2.0 - before / (8.0 * SHADE_REACH));
            }
        }
        1.0 - 0.85 * shade / SHADE_SAMPLES as f32
    }
}

impl Spray {
    /// The spray painted over what is behind it.
    fn over(&self, behind: Rgb, at: [f32; 2], pixels_per_metre: f32) -> Rgb {
        let color = decode(SPRAY);
        let [a, b] = self.ends;
        let n = self.nozzle;
        let fine = 0.0011 * pixels_per_metre;
        let inside = [[n, a, b], [a, b, n], [b, n, a]]
            .iter()
            .all(|[p, q, third]| side(*p, *q, at) * side(*p, *q, *third) >= 0.0);
        let mut light = behind;
        if inside {
            light = mixed(light, color, 0.2);
        }
        for end in self.ends {
            light = mixed(light, color, 0.75 * (distance(n, end, at) < 0.35 * fine) as u8 as f32);
        }
        if distance(a, b, at) < fine {
            light = mixed(light, color, 0.95);
        }
        if (at[0] - n[0]).hypot(at[1] - n[1]) < 3.2 * fine {
            light = color;
        }
        light
    }
}

/// Light from a surface of the given colour: lamp, sky and a gloss, dimmed by what stands around.
fn lit(color: Rgb, normal: [f32; 3], gloss: f32, open: f32) -> Rgb {
    let lamp = unit(LAMP);
    let facing = dot(normal, lamp).max(0.0);
    let sky = 0.5 - 0.5 * normal[1];
    let half = unit([lamp[0], lamp[1], lamp[2] - 1.0]);
    let shine = gloss * dot(normal, half).max(0.0).powi(40);
    let strength = (0.3 + 0.25 * sky + 0.6 * facing) * open;
    color.map(|c| c * strength + shine * open * 0.6)
}

/// Colour of a tablet with `film` of twice the mean.
fn film_color(film: f32) -> Rgb {
    let place = film.clamp(0.0, 1.0) * (FILM.len() - 1) as f32;
    let k = (place as usize).min(FILM.len() - 2);
    mixed(decode(FILM[k]), decode(FILM[k + 1]), place - k as f32)
}

/// Red, green, blue and opacity of light that has been multiplied by its opacity, as sRGB.
pub(super) fn encode([red, green, blue, opacity]: [f32; 4]) -> [u8; 4] {
    let byte = |value: f32| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let srgb = |light: f32| {
        let light = if opacity > 0.0 { light / opacity } else { 0.0 };
        byte(if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 })
    };
    [srgb(red), srgb(green), srgb(blue), byte(opacity)]
}

/// Linear light of an sRGB colour `0xRRGGBB`.
fn decode(srgb: u32) -> Rgb {
    [16, 8, 0].map(|shift| {
        let value = (srgb >> shift & 255) as f32 / 255.0;
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}

fn mixed(a: Rgb, b: Rgb, share: f32) -> Rgb {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}

fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn cross([a, b, c]: [f32; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

/// Which side of the line from `a` to `b` a point is on.
fn side(a: [f32; 2], b: [f32; 2], at: [f32; 2]) -> f32 {
    (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0])
}

/// Distance of a point from the line between `a` and `b`.
fn distance(a: [f32; 2], b: [f32; 2], at: [f32; 2]) -> f32 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = (((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (at[0] - a[0] - along * dx).hypot(at[1] - a[1] - along * dy)
}

//! The bed picture: the open front of the drum as it turns, tablets coloured by the film they carry.
//!
//! The raster of the coater looks along −z instead of along the spray and says which tablet is seen at each pixel and
//! how far away; light, film colour, drum and spray zone are painted on that.

mod paint;

use super::SprayZone;
use super::coater::{Bed, Canvas, CoaterError, View};
use crate::scene::Rays;
use crate::shapes::{Part, SurfaceMesh, TabletShape};
use crate::stepping::Frame;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::borrow::Borrow;
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// Raster pixels along each side of a picture's pixel.
const SUPERSAMPLING: u32 = 2;
/// Thickness of the drum's rim, of its radius.
const RIM: f64 = 0.035;
/// From the camera to the front of the drum, of its radius.
const CAMERA: f64 = 4.0;
/// Free space around the rim, of the radius.
const MARGIN: f64 = 0.02;

/// Draws frames of a drum seen from the front (+z), which is open.
#[derive(Debug, Clone)]
pub struct BedPicture {
    bed: Bed,
    canvas: Canvas,
    camera: SprayZone,
    radius: f64,
    size: u32,
}

/// An image of red, green, blue and opacity, with nothing around the drum.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    size: u32,
    rgba: Vec<u8>,
}

impl BedPicture {
    /// Pictures of `size` × `size` pixels of bodies of shapes `body_shape[body]` in `drum`.
    ///
    /// # Errors
    /// [`CoaterError::NoPanels`], [`CoaterError::TooManyPanels`].
    pub fn new(
        shapes: &[impl Borrow<TabletShape>],
        body_shape: &[usize],
        drum: &SurfaceMesh,
        size: u32,
    ) -> Result<Self, CoaterError> {
        let wall = drum.triangles.iter().zip(&drum.parts).filter(|(_, part)| **part == Part::Wall);
        let (radius, front) = wall
            .flat_map(|(t, _)| t.map(|v| drum.vertices[v as usize]))
            .fold((0.0, 0.0), |(radius, front): (f64, f64), v| (radius.max(v.x.hypot(v.y)), front.max(v.z)));
        let side = 2.0 * radius * (1.0 + RIM + MARGIN);
        let camera = SprayZone {
            center: Vector3::new(0.0, 0.0, front),
            spanwise: Vector3::x(),
            streamwise: -Vector3::y(),
            normal: Vector3::z(),
            extent: [side, side],
            distance: CAMERA * radius,
        };
        Ok(Self {
            bed: Bed::new(shapes, body_shape, Some(&open_front(drum, front)))?,
            canvas: Canvas::new([SUPERSAMPLING * size; 2]),
            camera,
            radius,
            size,
        })
    }

    /// Draws a frame. `film` is what each body carries, in any unit: the lightest colour is none, the darkest twice the
    /// mean or more. The spray `zone` is outlined where one is given.
    pub fn draw(&mut self, frame: &Frame<'_>, film: &[f64], zone: Option<&SprayZone>) -> Image {
        let fine = SUPERSAMPLING * self.size;
        let view = View::new(&self.camera, Rays::Diverging, [fine; 2], [0.0; 2]);
        self.bed.draw(&view, frame, &mut self.canvas);
        let mean = film.iter().sum::<f64>() / film.len().max(1) as f64;
        let scale = if mean > 0.0 { 0.5 / mean } else { 0.0 };
        let scene = paint::Scene {
            raster: &self.canvas.raster,
            lens: view.lens(),
            distance: self.camera.distance as f32,
            ids: self.bed.ids(),
            film: film.iter().map(|film| (film * scale) as f32).collect(),
            pixels_per_metre: (f64::from(fine) / self.camera.extent[0]) as f32,
            side: fine as usize,
            radius: self.radius as f32,
            rim: (self.radius * RIM) as f32,
            spray: zone.map(|zone| paint::Spray::new(zone, &view)),
        };
        let rows: Vec<Vec<u8>> =
            (0..self.size as usize).into_par_iter().map(|row| self.row(&scene, row)).collect();
        Image { size: self.size, rgba: rows.concat() }
    }

    /// A row of the picture: the mean light of each pixel's parts.
    fn row(&self, scene: &paint::Scene<'_>, row: usize) -> Vec<u8> {
        let parts = SUPERSAMPLING as usize;
        (0..self.size as usize)
            .flat_map(|column| {
                let mut light = [0.0; 4];
                for part in 0..parts * parts {
                    let [red, green, blue, opacity] =
                        scene.light(column * parts + part % parts, row * parts + part / parts);
                    for (sum, value) in
                        light.iter_mut().zip([red * opacity, green * opacity, blue * opacity, opacity])
                    {
                        *sum += value / (parts * parts) as f32;
                    }
                }
                paint::encode(light)
            })
            .collect()
    }
}

impl Image {
    /// Width and height, pixels.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// Red, green, blue and opacity of each pixel, row by row.
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    /// Writes the image as a PNG file.
    ///
    /// # Errors
    /// Whatever the system says when the file cannot be written.
    pub fn write_png(&self, path: &Path) -> io::Result<()> {
        let mut encoder =
            png::Encoder::new(io::BufWriter::new(std::fs::File::create(path)?), self.size, self.size);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgba)?;
        Ok(writer.finish()?)
    }
}

/// The drum without its front end wall, and with a lid on the front of each baffle, which is hollow.
fn open_front(drum: &SurfaceMesh, front: f64) -> SurfaceMesh {
    let of_part =
        |part: Part| drum.triangles.iter().zip(&drum.parts).filter(move |(_, p)| **p == part).map(|(t, _)| t);
    let mut open = SurfaceMesh { vertices: drum.vertices.clone(), triangles: Vec::new(), parts: Vec::new() };
    for part in drum.parts.iter().copied().collect::<BTreeSet<_>>() {
        if part == Part::End(1) {
            continue;
        }
        open.triangles.extend(of_part(part));
        if let Part::Baffle(_) = part {
            // The vertices of a baffle's outline follow each other in the mesh.
            let at_front = |&vertex: &u32| drum.vertices[vertex as usize].z > front - 1e-9;
            let outline: Vec<u32> = of_part(part)
                .flatten()
                .copied()
                .filter(at_front)
                .collect::<BTreeSet<_>>()
                .into_iter()
                .collect();
            open.triangles.extend(outline.windows(2).skip(1).map(|pair| [outline[0], pair[0], pair[1]]));
        }
        open.parts.resize(open.triangles.len(), part);
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observers::coater::tests::{cube, tumbled};

    /// A square tube with a back wall.
    fn drum() -> SurfaceMesh {
        let corner = |k: usize| {
            let [x, y] = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]][k % 4].map(|c: f64| 0.07 * c);
            Vector3::new(x, y, if k < 4 { -0.03 } else { 0.03 })
        };
        let mut mesh = SurfaceMesh {
            vertices: (0..8).map(corner).collect(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            parts: vec![Part::End(0); 2],
        };
        for k in 0..4 {
            mesh.triangles.extend([[k, (k + 1) % 4, k + 4], [(k + 1) % 4, (k + 1) % 4 + 4, k + 4]]);
            mesh.parts.extend([Part::Wall; 2]);
        }
        mesh
    }

    #[test]
    fn film_darkens_tablets_and_nothing_is_outside_the_drum() {
        let cubes = [cube(0.02)];
        let mut bodies = tumbled(2, [0.0; 3], 1);
        bodies[0].position.x = -0.03;
        bodies[1].position.x = 0.03;
        bodies[1].orientation = bodies[0].orientation;
        let mut picture = BedPicture::new(&cubes, &[0, 0], &drum(), 64).unwrap();
        let frame = Frame { index: 0, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
        let image = picture.draw(&frame, &[0.0, 1.0], None);
        let at = |x: usize, y: usize| image.rgba()[4 * (64 * y + x)..][..4].to_vec();
        // 0.03 m of a half width of 0.104 m.
        let sum = |pixel: Vec<u8>| pixel[..3].iter().map(|&c| u32::from(c)).sum::<u32>();
        assert!(sum(at(23, 32)) > 2 * sum(at(41, 32)));
        assert_eq!((at(0, 0)[3], at(32, 32)[3], at(32, 20)[3]), (0, 255, 255));
        // No film at all is no reason to fail.
        let bare = picture.draw(&frame, &[0.0, 0.0], None);
        assert_eq!(bare.rgba()[4 * (64 * 32 + 23)..][..4], at(23, 32));
    }

    #[test]
    fn a_written_image_is_read_back() {
        let image = Image { size: 2, rgba: (0..16).collect() };
        let file = tempfile::NamedTempFile::new().unwrap();
        image.write_png(file.path()).unwrap();
        let mut reader = png::Decoder::new(io::BufReader::new(std::fs::File::open(file.path()).unwrap()))
            .read_info()
            .unwrap();
        let mut rgba = vec![0; 16];
        reader.next_frame(&mut rgba).unwrap();
        assert_eq!(rgba, image.rgba);
    }
}

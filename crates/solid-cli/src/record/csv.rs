//! Collisions as CSV: a row for each, and one for each pair that is nearer than its clearance.

use std::cell::Cell;
use std::io::{self, Write};

use anyhow::Result;
use csv::Writer;
use solid_scene::Scene;
use solid3d::glam::DVec3;

use super::{Frame, Recorder, Summary};

const HEADER: [&str; 10] = ["frame", "time", "a", "b", "px", "py", "pz", "nx", "ny", "nz"];
/// What there is of clearances and depths.
const DISTANCES: [&str; 8] = ["distance", "depth", "ax", "ay", "az", "bx", "by", "bz"];
/// What there is of rays.
const RAYS: [&str; 2] = ["ray", "primitive"];
/// What there is of tests between frames.
const CONTACT_TIME: [&str; 1] = ["contact_time"];

/// What rows tell beside what every response may tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CsvColumns {
    /// Distances and depths, with the points of each object.
    pub distances: bool,
    /// Rays, and the primitives that they meet; with the distances.
    pub rays: bool,
    /// When the two first touch.
    pub contact_time: bool,
}

/// Writes `frame,time,a,b,px,py,pz,nx,ny,nz`, perhaps also `distance,depth,ax,ay,az,bx,by,bz`, `ray,primitive` and
/// `contact_time`, with empty fields for what is not known. Rows with a ray tell of an object that it meets, `a`; others with a
/// distance are pairs that are near, the rest collisions.
pub struct CsvRecorder<W: Write> {
    writer: Writer<FlushedAtEnd<W>>,
    columns: CsvColumns,
}

/// Is flushed only where all is written: a [`Writer`] flushes also when it is dropped, as where a run fails on the way.
struct FlushedAtEnd<W> {
    output: W,
    is_finished: Cell<bool>,
}

impl<W: Write> Write for FlushedAtEnd<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.output.write(buffer)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.is_finished.get() { self.output.flush() } else { Ok(()) }
    }
}

/// What a row may tell beside the frame and the names.
#[derive(Default)]
struct Known<'a> {
    point: Option<DVec3>,
    normal: Option<DVec3>,
    distance: Option<f64>,
    depth: Option<f64>,
    points: Option<[DVec3; 2]>,
    contact_time: Option<f64>,
    /// A ray and the primitive that it meets.
    ray: Option<(&'a str, Option<u32>)>,
}

impl<W: Write> CsvRecorder<W> {
    pub fn new(output: W, columns: CsvColumns) -> Result<Self> {
        let writer = FlushedAtEnd { output, is_finished: Cell::new(false) };
        let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(writer);
        let distances: &[&str] = if columns.distances { &DISTANCES } else { &[] };
        let rays: &[&str] = if columns.rays { &RAYS } else { &[] };
        let contact_time: &[&str] = if columns.contact_time { &CONTACT_TIME } else { &[] };
        writer.write_record(HEADER.iter().chain(distances).chain(rays).chain(contact_time))?;
        Ok(CsvRecorder { writer, columns })
    }

    fn row(&mut self, frame: &Frame, [a, b]: [&str; 2], known: &Known) -> Result<()> {
        let [point, normal] = [known.point, known.normal].map(coordinates);
        let (mut distances, mut rays, mut contact_time) = (Vec::new(), Vec::new(), Vec::new());
        if self.columns.distances {
            distances.extend([known.distance, known.depth]);
            distances.extend(of_each(known.points).as_flattened());
        }
        if self.columns.rays {
            let word =
                |primitive: Option<u32>| primitive.map(|primitive| primitive.to_string()).unwrap_or_default();
            let ray = known.ray.map(|(ray, primitive)| [ray.to_owned(), word(primitive)]);
            rays.extend(ray.unwrap_or_default());
        }
        if self.columns.contact_time {
            contact_time.push(known.contact_time);
        }
        let row = (frame.number, frame.time, a, b, point, normal, distances, rays, contact_time);
        Ok(self.writer.serialize(row)?)
    }
}

impl<W: Write> Recorder for CsvRecorder<W> {
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()> {
        let names = |a: usize, b: usize| [a, b].map(|object| scene.objects()[object].name());
        for hit in frame.hits {
            let known = Known {
                point: hit.point,
                normal: hit.normal,
                depth: hit.depth.map(|depth| depth.depth),
                points: hit.depth.map(|depth| depth.points),
                contact_time: hit.contact_time,
                ..Known::default()
            };
            self.row(frame, names(hit.a, hit.b), &known)?;
        }
        for pass in frame.near.unwrap_or_default() {
            let known = Known {
                normal: Some(pass.normal),
                distance: Some(pass.distance),
                points: Some(pass.points),
                ..Known::default()
            };
            self.row(frame, names(pass.a, pass.b), &known)?;
        }
        for sighting in frame.sightings {
            let known = Known {
                point: Some(sighting.point),
                normal: sighting.normal,
                distance: Some(sighting.distance),
                ray: Some((&frame.rays[sighting.ray].name, sighting.primitive)),
                ..Known::default()
            };
            self.row(frame, [scene.objects()[sighting.object].name(), ""], &known)?;
        }
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        self.writer.get_ref().is_finished.set(true);
        Ok(self.writer.flush()?)
    }
}

fn coordinates(v: Option<DVec3>) -> [Option<f64>; 3] {
    v.map_or([None; 3], |v| v.to_array().map(Some))
}

fn of_each(points: Option<[DVec3; 2]>) -> [[Option<f64>; 3]; 2] {
    points.map_or([[None; 3]; 2], |points| points.map(|point| coordinates(Some(point))))
}

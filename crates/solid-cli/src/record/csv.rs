//! Collisions as CSV: a row for each, and one for each pair that is nearer than its clearance.

use std::io::Write;

use anyhow::Result;
use csv::Writer;
use solid_scene::Scene;
use solid3d::glam::DVec3;

use super::{Frame, Recorder, Summary};

const HEADER: [&str; 10] = ["frame", "time", "a", "b", "px", "py", "pz", "nx", "ny", "nz"];
/// What there is of clearances and depths.
const DISTANCES: [&str; 8] = ["distance", "depth", "ax", "ay", "az", "bx", "by", "bz"];

/// Whether rows tell of distances and depths, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsvColumns {
    /// Only what every response may tell.
    Basic,
    /// Also distances and depths, with the points of each object.
    Distances,
}

/// Writes `frame,time,a,b,px,py,pz,nx,ny,nz`, perhaps also `distance,depth,ax,ay,az,bx,by,bz`, with empty fields for what is not
/// known. Rows with a distance are pairs that are near, the others collisions.
pub struct CsvRecorder<W: Write> {
    writer: Writer<W>,
    columns: CsvColumns,
}

/// What a row tells of distances.
type Distances = (Option<f64>, Option<f64>, [[Option<f64>; 3]; 2]);

impl<W: Write> CsvRecorder<W> {
    pub fn new(writer: W, columns: CsvColumns) -> Result<Self> {
        let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(writer);
        match columns {
            CsvColumns::Basic => writer.write_record(HEADER)?,
            CsvColumns::Distances => writer.write_record(HEADER.iter().chain(&DISTANCES))?,
        }
        Ok(CsvRecorder { writer, columns })
    }

    fn row(
        &mut self,
        frame: &Frame,
        names: [&str; 2],
        place: [Option<DVec3>; 2],
        distances: Distances,
    ) -> Result<()> {
        let ([a, b], [point, normal]) = (names, place.map(coordinates));
        let basic = (frame.number, frame.time, a, b, point, normal);
        Ok(match self.columns {
            CsvColumns::Basic => self.writer.serialize(basic)?,
            CsvColumns::Distances => self.writer.serialize((basic, distances))?,
        })
    }
}

impl<W: Write> Recorder for CsvRecorder<W> {
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()> {
        let names = |a: usize, b: usize| [a, b].map(|object| scene.objects()[object].name());
        for hit in frame.hits {
            let points = hit.depth.map(|depth| depth.points);
            let distances = (None, hit.depth.map(|depth| depth.depth), of_each(points));
            self.row(frame, names(hit.a, hit.b), [hit.point, hit.normal], distances)?;
        }
        for pass in frame.near.unwrap_or_default() {
            let distances = (Some(pass.distance), None, of_each(Some(pass.points)));
            self.row(frame, names(pass.a, pass.b), [None, Some(pass.normal)], distances)?;
        }
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(self.writer.flush()?)
    }
}

fn coordinates(v: Option<DVec3>) -> [Option<f64>; 3] {
    v.map_or([None; 3], |v| v.to_array().map(Some))
}

fn of_each(points: Option<[DVec3; 2]>) -> [[Option<f64>; 3]; 2] {
    points.map_or([[None; 3]; 2], |points| points.map(|point| coordinates(Some(point))))
}

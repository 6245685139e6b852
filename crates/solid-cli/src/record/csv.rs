//! Collisions as CSV: a row for each.

use std::io::Write;

use anyhow::Result;
use csv::Writer;
use solid_scene::Scene;

use super::{Frame, Recorder, Summary};

const HEADER: [&str; 10] = ["frame", "time", "a", "b", "px", "py", "pz", "nx", "ny", "nz"];

/// Writes `frame,time,a,b,px,py,pz,nx,ny,nz`, with empty fields for what is not known.
pub struct CsvRecorder<W: Write> {
    writer: Writer<W>,
}

impl<W: Write> CsvRecorder<W> {
    pub fn new(writer: W) -> Result<Self> {
        let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(writer);
        writer.write_record(HEADER)?;
        Ok(CsvRecorder { writer })
    }
}

impl<W: Write> Recorder for CsvRecorder<W> {
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()> {
        for hit in frame.hits {
            let [a, b] = [hit.a, hit.b].map(|object| scene.objects()[object].name());
            let [point, normal] =
                [hit.point, hit.normal].map(|v| v.map_or([None; 3], |v| v.to_array().map(Some)));
            self.writer.serialize((frame.number, frame.time, a, b, point, normal))?;
        }
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(self.writer.flush()?)
    }
}

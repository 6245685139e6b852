//! Collisions as CSV: a row for each.

use std::io::Write;

use anyhow::Result;
use csv::Writer;
use solid_scene::Scene;

use super::{Frame, Recorder, Summary};

const HEADER: [&str; 11] = ["frame", "time", "a", "b", "px", "py", "pz", "nx", "ny", "nz", "contact_time"];

/// Which columns there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// All but the last.
    Plain,
    /// All: what is tested between frames has a time of contact.
    WithContactTime,
}

/// Writes `frame,time,a,b,px,py,pz,nx,ny,nz` and perhaps `contact_time`, with empty fields for what is not known.
pub struct CsvRecorder<W: Write> {
    writer: Writer<W>,
    columns: Columns,
}

impl<W: Write> CsvRecorder<W> {
    pub fn new(writer: W, columns: Columns) -> Result<Self> {
        let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(writer);
        let plain = HEADER.len() - 1;
        writer.write_record(match columns {
            Columns::Plain => &HEADER[..plain],
            Columns::WithContactTime => &HEADER,
        })?;
        Ok(CsvRecorder { writer, columns })
    }
}

impl<W: Write> Recorder for CsvRecorder<W> {
    fn frame(&mut self, scene: &Scene, frame: &Frame) -> Result<()> {
        for hit in frame.hits {
            let [a, b] = [hit.a, hit.b].map(|object| scene.objects()[object].name());
            let [point, normal] =
                [hit.point, hit.normal].map(|v| v.map_or([None; 3], |v| v.to_array().map(Some)));
            let row = (frame.number, frame.time, a, b, point, normal);
            match self.columns {
                Columns::Plain => self.writer.serialize(row)?,
                Columns::WithContactTime => self.writer.serialize((row, hit.contact_time))?,
            }
        }
        Ok(())
    }

    fn finish(&mut self, _summary: &Summary) -> Result<()> {
        Ok(self.writer.flush()?)
    }
}

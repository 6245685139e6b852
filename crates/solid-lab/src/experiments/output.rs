use anyhow::{Context, Result};
use serde::Serialize;

use super::Settings;

/// Writes rows as CSV, a header from their fields.
pub fn write_csv<R: Serialize>(settings: &Settings, name: &str, rows: &[R]) -> Result<()> {
    let path = settings.out_dir.join(format!("{name}.csv"));
    let context = || format!("cannot write {}", path.display());
    let mut writer = csv::Writer::from_path(&path).with_context(context)?;
    for row in rows {
        writer.serialize(row).with_context(context)?;
    }
    writer.flush().with_context(context)
}

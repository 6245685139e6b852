//! ElevationGrid.

use glam::DVec3;

use super::{Builder, Geometry};
use crate::error::SceneError;
use crate::soup::Soup;
use crate::text::counted;
use crate::vrml::graph::Node;

/// How many points a grid has along x and z, and how far they are apart.
struct Grid {
    columns: usize,
    rows: usize,
    x_spacing: f64,
    z_spacing: f64,
}

impl Builder<'_> {
    pub(super) fn elevation_grid(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let grid = self.grid(node)?;
        if grid.columns < 2 || grid.rows < 2 {
            return self.empty(node);
        }
        let heights = self.graph.numbers(node, "height")?;
        self.count(node, heights.len())?;
        let soup = Soup { vertices: grid.points(&heights), triangles: grid.triangles(), ..Soup::default() };
        self.soup(node, soup, None)
    }

    fn grid(&self, node: Node) -> Result<Grid, SceneError> {
        let graph = self.graph;
        let dimension = |name| {
            let value = graph.integer(node, name);
            usize::try_from(value)
                .map_err(|_| graph.error(node, format!("{name} is {value}; expected 0 or more")))
        };
        let spacing = |name| match graph.number(node, name)? {
            value if value > 0.0 => Ok(value),
            value => Err(graph.error(node, format!("{name} is {value}; expected more than 0"))),
        };
        let (columns, rows) = (dimension("xDimension")?, dimension("zDimension")?);
        let count = graph.count(node, "height");
        if columns.checked_mul(rows) != Some(count) {
            let message = format!("height holds {}; expected {columns} by {rows}", counted(count, "number"));
            return Err(graph.error(node, message));
        }
        Ok(Grid { columns, rows, x_spacing: spacing("xSpacing")?, z_spacing: spacing("zSpacing")? })
    }
}

impl Grid {
    fn points(&self, heights: &[f64]) -> Vec<DVec3> {
        let point = |(i, &height): (usize, &f64)| {
            let (row, column) = (i / self.columns, i % self.columns);
            DVec3::new(column as f64 * self.x_spacing, height, row as f64 * self.z_spacing)
        };
        heights.iter().enumerate().map(point).collect()
    }

    /// Two for each quadrilateral, counter-clockwise from above.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for row in 0..self.rows - 1 {
            for column in 0..self.columns - 1 {
                let corner = (row * self.columns + column) as u32;
                let below = corner + self.columns as u32;
                triangles.push([corner, below, below + 1]);
                triangles.push([corner, below + 1, corner + 1]);
            }
        }
        triangles
    }
}

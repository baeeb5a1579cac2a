//! Regions: which cells are made of what. Every cell is in one, region 0 unless said otherwise; regions may have names.

use super::{Cell, Mesh, MeshError};

impl Mesh {
    /// The same mesh with its cells in these regions, one number per cell. Names of regions that are left are kept.
    ///
    /// ```
    /// # use foil2d::fe::mesh::{CellKind, generate::rectangle};
    /// let strip = rectangle([4.0, 0.2], [20, 2], CellKind::Quad4)?
    ///     .with_regions_by(|[_, y]| u32::from(y > 0.1))
    ///     .with_region_name(1, "upper layer")?;
    /// assert_eq!(strip.regions(), [0, 1]);
    /// assert_eq!(strip.region_named("upper layer"), Some(1));
    /// # Ok::<(), foil2d::fe::mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError::RegionCount`] if there is not one per cell.
    pub fn with_regions(mut self, regions: Vec<u32>) -> Result<Self, MeshError> {
        let (found, expected) = (regions.len(), self.n_cells());
        if found != expected {
            return Err(MeshError::RegionCount { found, expected });
        }
        self.set_regions(regions);
        Ok(self)
    }

    /// The same mesh with the region of every cell chosen by the mean of its corners (m).
    pub fn with_regions_by(mut self, choose: impl Fn([f64; 2]) -> u32) -> Self {
        let regions = self.cells().map(|cell| choose(self.centre_of(&cell)));
        let regions = regions.collect();
        self.set_regions(regions);
        self
    }

    fn set_regions(&mut self, regions: Vec<u32>) {
        let is_plain = regions.iter().all(|&region| region == 0);
        self.cells.regions = if is_plain { Vec::new() } else { regions };
        let left = self.regions();
        let names = &mut self.region_names;
        names.retain(|(region, _)| left.binary_search(region).is_ok());
    }

    /// Names a region, such as by the physical group of a file; a later name of the same region replaces it.
    ///
    /// # Errors
    /// [`MeshError::NoRegion`] if no cell is in it, [`MeshError::RegionName`] if another region has this name.
    pub fn with_region_name(
        mut self,
        region: u32,
        name: impl Into<String>,
    ) -> Result<Self, MeshError> {
        let name = name.into();
        if self.regions().binary_search(&region).is_err() {
            return Err(MeshError::NoRegion { region });
        }
        let names = &mut self.region_names;
        names.retain(|(other, _)| *other != region);
        if let Some(&(other, _)) = names.iter().find(|(_, own)| *own == name) {
            return Err(MeshError::RegionName {
                name,
                regions: [other, region],
            });
        }
        names.push((region, name));
        names.sort_unstable();
        Ok(self)
    }

    /// The regions that have cells, ascending.
    pub fn regions(&self) -> Vec<u32> {
        let mut all = self.cells.regions.clone();
        all.sort_unstable();
        all.dedup();
        if all.is_empty() { vec![0] } else { all }
    }

    /// The region of this name.
    pub fn region_named(&self, name: &str) -> Option<u32> {
        let named = self.region_names.iter().find(|(_, own)| own == name);
        named.map(|(region, _)| *region)
    }

    /// Regions with names, ascending.
    pub fn region_names(&self) -> impl Iterator<Item = (u32, &str)> {
        let names = self.region_names.iter();
        names.map(|(region, name)| (*region, name.as_str()))
    }

    /// Mean of the corners of a cell (m).
    fn centre_of(&self, cell: &Cell<'_>) -> [f64; 2] {
        let corners = cell.corners();
        let sum = corners.iter().fold([0.0; 2], |[x, y], &node| {
            [x + self.nodes[node][0], y + self.nodes[node][1]]
        });
        sum.map(|part| part / corners.len() as f64)
    }
}

//! Files of many steps, with an index of their times.

use super::{VtuEncoding, pieces, xml};
use crate::io::output::{OutputError, write};
use crate::io::scene::Scene;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes a scene step by step; see the table of what stands in which file above.
///
/// ```
/// use foil2d::io::{Scene, VtuSeries};
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut world = PhysicsWorld::new();
/// let mut bodies = FlexBodySet::new();
/// let beam = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 1]).material(LinearElastic::plane_stress(1e7, 0.3).density(1e3));
/// bodies.insert(beam, &mut world)?;
/// let mut pipeline = FlexPipeline::new();
/// # let folder = std::env::temp_dir().join(format!("foil2d-series-{}", std::process::id()));
/// let mut series = VtuSeries::new(folder.join("fall"));
/// for step in 1..=2 {
///     pipeline.step(&mut world, &mut bodies)?;
///     series.record(f64::from(step) / 60.0, &Scene::of(&world, &bodies, pipeline.report()))?;
/// }
/// let index = series.finish()?;
/// assert!(index.ends_with("fall.pvd"));
/// # std::fs::remove_dir_all(folder)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct VtuSeries {
    stem: PathBuf,
    encoding: VtuEncoding,
    /// Time (s), part and name of every file.
    files: Vec<(f64, usize, String)>,
    n_recorded: usize,
}

/// What the names of files say is in them, in the order of their parts.
const PARTS: [&str; 3] = ["flexible", "rigid", "contacts"];

impl VtuSeries {
    /// A series of files whose names begin with `stem`, such as `out/run`; the folder is made where it is missing.
    pub fn new(stem: impl AsRef<Path>) -> Self {
        Self {
            stem: stem.as_ref().to_owned(),
            encoding: VtuEncoding::default(),
            files: Vec::new(),
            n_recorded: 0,
        }
    }

    /// Chooses how numbers are written; [`VtuEncoding::Appended`] if not called.
    pub fn with_encoding(mut self, encoding: VtuEncoding) -> Self {
        self.encoding = encoding;
        self
    }

    /// Writes the three files of a scene at a time (s).
    ///
    /// # Errors
    /// If a file cannot be written, or an element cannot evaluate its strain.
    pub fn record(&mut self, time: f64, scene: &Scene<'_>) -> Result<(), OutputError> {
        let mut flexible = Vec::with_capacity(scene.flex_bodies.len());
        for (handle, body) in scene.flex_bodies.iter() {
            flexible.push(pieces::flexible(body, handle.into_raw_parts().0)?);
        }
        let rigid = scene.rigid_shapes().iter().map(pieces::rigid).collect();
        let contacts = vec![pieces::contacts(scene.report.contacts())];
        let parts = [flexible, rigid, contacts];
        for (part, (what, pieces)) in PARTS.iter().zip(parts).enumerate() {
            let ending = format!("_{what}_{:06}.vtu", self.n_recorded);
            let path = self.path(&ending);
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            write(path, &xml::document(&pieces, self.encoding))?;
            self.files.push((time, part, name));
        }
        self.n_recorded += 1;
        Ok(())
    }

    /// Writes the index of all recorded files, and returns its path. More may be recorded afterwards.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(&self) -> Result<PathBuf, OutputError> {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        );
        for (time, part, name) in &self.files {
            let _ = writeln!(
                text,
                "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" name=\"{}\" file=\"{}\"/>",
                PARTS[*part],
                escaped(name)
            );
        }
        text.push_str("</Collection>\n</VTKFile>\n");
        let path = self.path(".pvd");
        write(path.clone(), text.as_bytes())?;
        Ok(path)
    }

    fn path(&self, ending: &str) -> PathBuf {
        let mut name = self.stem.file_name().unwrap_or_default().to_owned();
        name.push(ending);
        self.stem.with_file_name(name)
    }
}

/// A text as the value of an attribute.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

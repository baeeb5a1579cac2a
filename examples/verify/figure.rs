//! Figures as an engineer would put them in a report: labelled axes with units, the exact solution beside ours.

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// A named curve.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// Exact solutions are drawn black and first.
    pub is_exact: bool,
    /// Drawn as dots, not as a line.
    pub is_dotted: bool,
}

/// A line chart.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of the file without its ending.
    pub name: &'static str,
    pub title: String,
    /// Quantity and unit of the axes.
    pub axes: [&'static str; 2],
    pub curves: Vec<Curve>,
    /// Both axes are logarithmic.
    pub is_log: bool,
    /// Values on the upright axis beyond this are cut, where it is given.
    pub range: Option<[f64; 2]>,
}

impl Figure {
    pub fn new(name: &'static str, title: impl Into<String>, axes: [&'static str; 2]) -> Self {
        Self {
            name,
            title: title.into(),
            axes,
            curves: Vec::new(),
            is_log: false,
            range: None,
        }
    }

    pub fn log(mut self) -> Self {
        self.is_log = true;
        self
    }

    pub fn within(mut self, range: [f64; 2]) -> Self {
        self.range = Some(range);
        self
    }

    pub fn exact(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, true, false);
        self
    }

    pub fn line(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, false, false);
        self
    }

    pub fn dots(mut self, name: &str, points: Vec<[f64; 2]>) -> Self {
        self.push(name, points, false, true);
        self
    }

    fn push(&mut self, name: &str, points: Vec<[f64; 2]>, is_exact: bool, is_dotted: bool) {
        self.curves.push(Curve {
            name: name.into(),
            points,
            is_exact,
            is_dotted,
        });
    }

    /// Smallest and largest value on an axis, with room around; zero to one without points.
    fn bounds(&self, axis: usize) -> [f64; 2] {
        if let (1, Some(range)) = (axis, self.range) {
            return range;
        }
        let values = self.curves.iter().flat_map(|curve| &curve.points);
        let values = values.map(|point| point[axis]).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        if low > high {
            [0.1, 1.0]
        } else if self.is_log {
            [0.7 * low.max(1e-300), 1.4 * high.max(1e-299)]
        } else {
            let room = (0.05 * (high - low)).max(1e-12 + 1e-6 * high.abs());
            [
                low - if axis == 1 { room } else { 0.0 },
                high + if axis == 1 { room } else { 0.0 },
            ]
        }
    }

    /// Writes the figure as an SVG file into a folder.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        let path = folder.join(format!("{}.svg", self.name));
        let root = SVGBackend::new(&path, (760, 460)).into_drawing_area();
        root.fill(&WHITE)?;
        let [[x0, x1], [y0, y1]] = [self.bounds(0), self.bounds(1)];
        let mut builder = ChartBuilder::on(&root);
        builder
            .caption(&self.title, ("sans-serif", 17))
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(70);
        macro_rules! draw {
            ($chart:expr) => {{
                let mut chart = $chart;
                let [x, y] = self.axes;
                chart
                    .configure_mesh()
                    .x_desc(x)
                    .y_desc(y)
                    .light_line_style(WHITE)
                    .draw()?;
                for (index, curve) in self.curves.iter().enumerate() {
                    let colour = if curve.is_exact {
                        BLACK.to_rgba()
                    } else {
                        Palette99::pick(index).to_rgba()
                    };
                    // Far outside the chart a renderer may lose precision.
                    let (reach, low, high) = (y1 - y0, y0, y1);
                    let points = curve
                        .points
                        .iter()
                        .filter(|p| p[0].is_finite() && p[1].is_finite());
                    let points = points.map(|&[x, y]| (x, y.clamp(low - reach, high + reach)));
                    let shown = if curve.is_dotted {
                        chart.draw_series(points.map(|at| Circle::new(at, 3, colour.filled())))?
                    } else {
                        chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?
                    };
                    shown.label(&curve.name).legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2))
                    });
                }
                chart
                    .configure_series_labels()
                    .background_style(WHITE.mix(0.85))
                    .border_style(BLACK)
                    .draw()?;
            }};
        }
        if self.is_log {
            draw!(builder.build_cartesian_2d((x0..x1).log_scale(), (y0..y1).log_scale())?);
        } else {
            draw!(builder.build_cartesian_2d(x0..x1, y0..y1)?);
        }
        root.present()?;
        Ok(())
    }
}
